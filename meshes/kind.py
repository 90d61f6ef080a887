"""Kinds of meshes of the half-plane, with the refinement that a tolerance needs.

A :class:`MeshKind` turns the requirements on a mesh into rings, sectors, columns and a polynomial degree,
by measured laws, see docs/verification.md.

The far boundary follows moments of the forces at the contact, see :mod:`galinx.solvers.fem.boundary`:
:func:`radius` and :func:`moments` are its distance and their number. Distances are over a, in the plane
where the boundary is nearest.

Under a punch whose slope has kinks, cells are graded towards these, too, see :func:`with_kinks`. Between
neighbouring places, both ends of the contact among them, the strip along the contact is cut in the
middle; each half is a corner of :mod:`galinx.meshes.rings`, stretched. Where two places are near each
other the strip is as narrow as they are near, and blocks without rings grow from there to the middle of
the longer neighbour. Columns go on outwards.

:func:`check_cells` refuses degenerate cells; :func:`edges` and :func:`nodes` are for drawings.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise
from math import ceil, exp, log, log2, log10, pi, sqrt

import numpy as np
from numpy.polynomial import Legendre
from numpy.typing import NDArray

from galinx.registry import Registry

from .charts import Chart
from .rings import QuadMesh, Refinement, corner, cut, joined, rectangle

#: Least distance of the far boundary over a, and over that of the farthest point of stresses.
_LEAST, _BEYOND = 17.0, 1.7

#: Error of the first omitted moment at unit distance, and share of the tolerance that it may take.
_LEFT_OUT, _SHARE = 0.02, 1e-4


def radius(farthest: float) -> float:
    """Distance of the far boundary over a, by that of the farthest point where stresses are output."""
    return max(_LEAST, _BEYOND * farthest)


def moments(R: float, tolerance: float) -> int:
    """Number of moments that a boundary at a distance R over a follows at a tolerance."""
    return max(ceil(log(_LEFT_OUT / (_SHARE * tolerance)) / log(R)) - 1, 1)


def boundary_error(R: float, moments: int, margin: float) -> float:
    """Estimated relative error of K_I by a boundary at a distance R over a that follows moments.

    Over |σ_XY/σ_YY| and a tenth: every other moment needs no friction. Measured on 60 solids, frictions
    to 5, speeds to 0.99 of the limit and 1 to 6 moments; it is 1 to 5 times the largest of these.
    """
    return 2.0 ** (2 - moments) / (R ** (moments + 1) * margin)


#: Width of the strip over the mean height of its halves, and factor by which columns grow outwards.
_WIDE, _GROWTH = 1.3, 1.6
#: Most width of the strip, over that times the height where places are near each other; factor up to
#: which halves next to a place are alike, and by which blocks between such a place and the middle grow.
_SLENDER, _ALIKE = 2.0, 3.0
#: Elliptic coordinate, some 4 000 a, beyond which a field is that of a line load to all digits of the
#: results, linear in this coordinate, and columns need no largest width.
_FAR = 9.0


def rings_at_kinks(refinement: Refinement, size: float) -> int:
    """Number of rings around kinks beyond those around ends, by the size of innermost cells."""
    return ceil(log(size) / log(refinement.ratio)) - refinement.levels


def with_kinks(refinement: Refinement, places: NDArray, more: int = 0) -> QuadMesh:
    """The rectangle in the (ξ, η) plane of a confocal mesh, graded towards kinks of the punch.

    Args:
        refinement: of the mesh without kinks.
        places: X over a of the kinks, in (-1, 1).
        more: number of additional rings around the kinks.
    """
    η = np.concatenate([[-np.pi], np.sort(-np.arccos(places)), [0.0]])
    half, legs = np.diff(η) / 2.0, refinement.legs
    least = np.minimum(np.append(half, np.inf), np.append(np.inf, half))
    widest = min(_WIDE * np.pi / (2.0 * len(half)), np.pi / 2.0)
    of_end, of_kink = (
        corner(1.0, replace(refinement, levels=refinement.levels + levels), False)[0]
        for levels in (0, more)
    )
    blocks, of_ends, of_widths = [], list[float](), list[float]()
    for i, h in enumerate(half):
        for node, side in ((i, 1), (i + 1, -1)):
            steps = ceil(log(h / least[node]) / log(_ALIKE))
            sizes = h * (least[node] / h) ** (
                np.arange(steps, -1, -1) / steps if steps > 1 else np.zeros(1)
            )
            corners = of_end if node in (0, len(half)) else of_kink
            blocks.append((corners * [1.0, -side * sizes[0]] + [0.0, η[node]])[:, ::-side])
            for low, high in pairwise(sizes):
                blocks.append(_grid(legs, η[node] + side * (low + (high - low) * legs))[:, ::side])
            of_ends += [η[node], *(η[node] + side * sizes[:-1]), η[i] + h]
            of_widths += [least[node], *sizes]
    order = np.argsort(of_ends, kind="stable")
    ends = np.array(of_ends)[order]
    widths = np.minimum(_SLENDER * _WIDE * np.array(of_widths)[order], widest)
    for block in blocks:
        block[..., 0] *= np.interp(block[..., 1], ends, widths)
    rows = np.unique([low + (high - low) * legs for low, high in pairwise(np.unique(ends))])
    ξ = np.array(_columns(widest, np.pi / 2.0 + sum(refinement.columns), max(refinement.columns)))
    count = 1 + round(log2(widest / widths.min()))
    beside = _grid(np.arange(count + 1) / count, rows)
    share, width = beside[..., 0], np.interp(beside[..., 1], ends, widths)
    beside[..., 0] = width ** (1.0 - share) * ξ[1] ** share
    return joined(np.concatenate([*blocks, beside, _grid(ξ[1:], rows)]).reshape(-1, 2), ξ[-1])


def _grid(x: NDArray, y: NDArray) -> NDArray[np.float64]:
    """Quadrilaterals between coordinates x and y, (cells, 4, 2)."""
    x, y = np.meshgrid(x, y, indexing="ij")
    xy = np.stack([x, y], axis=-1)
    return np.stack([xy[:-1, :-1], xy[1:, :-1], xy[1:, 1:], xy[:-1, 1:]], axis=2).reshape(-1, 4, 2)


def _columns(first: float, last: float, widest: float) -> list[float]:
    """Ends of columns in ξ from the strip to the far boundary; near the punch at most ``widest`` wide."""
    ends, step = [first], first
    while last - ends[-1] > 1.5 * step:
        ends.append(ends[-1] + step)
        step = min(_GROWTH * step, widest if ends[-1] < _FAR else np.inf)
    return [*ends, last]


#: Lowest and highest polynomial degree used.
DEGREES = (4, 12)


def as_drawn(points: NDArray, _: Refinement) -> NDArray:
    """Vertices of the pattern, unchanged."""
    return points


#: Strongest exponent of a pressure that rings resolve: with a stronger one they would never end.
_STRONGEST = -0.95

#: Additional sectors by the spread of the planes of a solid's fields: spread up to which none is added,
#: start and step of one sector each. For K_I and moments alone, for stresses on the surface that rings of
#: their own resolve, for stresses inside, and for all others.
_ALONE, _BESIDE, _INSIDE, _AROUND = (1.0, 0.65, 0.8), (1.9, 1.9, 0.8), (0.5, 0.55, 0.65), (1.2, 0.9, 0.8)

#: Spread up to which the outermost ring is not cut, and up to which stresses on the surface need neither
#: a degree more nor, at a tight tolerance, gentler rings.
_TURNED, _HIGHER = 0.5, 0.7

#: Factor of the size of innermost cells where rings resolve stresses at lower degrees.
_CLOSER = 0.5

#: Tolerance below which rings for stresses have a ratio of their own.
_LOOSE = 2e-4

#: Most additional sectors with which a degree less is enough.
_SPARING = 3

#: Relative error of stresses at the nearest place by confocal cells, over their size squared over its
#: distance, both in ξ and η, times the degree's third power; measured.
_LEFT_BESIDE = 0.05

#: Crowding of additional sectors: planes apart turn fields along the axes, where legs end.
_CROWDING = 0.3

#: Digits of moments that go with a digit of stresses.
_OF_STRESSES = 1.5

#: Power of the rings' ratio by which they are gentler for stresses, and steeper where cells are finer in
#: angle for the sake of the large ones: rings then have more of them than the edges ask for.
_GENTLER, _STEEPER = 0.6, 1.5


@dataclass(frozen=True)
class Requirements:
    """Requirements on a mesh.

    Attributes:
        tolerance: relative accuracy.
        nearest: least distance over a from a punch edge of a point where stresses are output; None for
            K_I and the pressure's moments alone.
        farthest: largest coordinate over a of such a point.
        exponent: of the strongest singularity of the pressure, in (-1, -1/2]; 1/2 where it has none.
        around: True where such points are all round the edges.
        inside: True where such points are below the surface.
        spread: distance between the planes in which the solid's fields are analytic, see
            :class:`galinx.solvers.solids.half_plane.HalfPlane`.
        bends: True where the surface under the punch is not straight, nor the pressure that of a flat
            punch.
    """

    tolerance: float
    nearest: float | None = None
    farthest: float = 0.0
    exponent: float = -0.5
    around: bool = False
    inside: bool = False
    spread: float = 0.0
    bends: bool = False


@dataclass(frozen=True)
class MeshKind:
    """A kind of meshes of the half-plane.

    Attributes:
        about: description, for messages and pages.
        chart: in which the mesh is drawn.
        ratio: size of a ring over that of the ring outside it. Straight cells in the physical plane need
            gentler rings than confocal ones: a ratio t there is t² in distance.
        column: largest width in ξ of a column outside the rings.
        alone: width in ξ up to which there is one column outside the rings, and no other.
        stressed: ratio of rings for stresses, at a degree less on the surface; 0 for ``ratio``.
        tight: least ratio of rings for stresses on the surface below the tolerance ``gentle``, of solids
            whose fields live in planes far apart.
        place: maps points (n, 2) of the pattern with a refinement into that chart.
        fan: filling of the innermost squares of the pattern, see :func:`galinx.meshes.rings.rectangle`.
        rings: grading towards the edges; without, squares all over, and the degree or cuts do the rest.
        innermost: share of the tolerance that is left to the innermost cells. Where these cannot follow
            the singularity it hardly falls with the degree, so that no estimate sees it.
        beside: size of the innermost cells over the distance of the nearest place, in the chart and over
            the root of the tolerance.
        gentle: tolerance below which stresses need gentler rings and more cells in angle: derivatives
            converge half as fast as moments of the pressure, and degrees are not high enough. All round
            the edges they always do.
        smallest: least size of the innermost cells, of whose square, a distance over a, rounding of
            positions leaves enough digits.
        sectors: cells along each leg of an L.
        walls: distance over a of a far boundary that is held; None where it follows the contact.
    """

    about: str
    chart: Chart
    ratio: float
    column: float
    alone: float = 0.0
    stressed: float = 0.0
    tight: float = 0.0
    place: Callable[[NDArray, Refinement], NDArray] = as_drawn
    fan: bool = False
    rings: bool = True
    innermost: float = 1.0 / 3.0
    beside: float = 35.0
    gentle: float = 3e-7
    smallest: float = 1e-6
    sectors: int = 2
    walls: float | None = None

    def build(self, refinement: Refinement, cuts: int = 1, part: int = 0, parts: int = 1) -> QuadMesh:
        """The mesh, or a piece of it.

        Args:
            refinement: of the pattern.
            cuts: number of cells along each side of a cell of the pattern.
            part, parts: number of the piece, from 0, and of all pieces.
        """
        piece = cut(rectangle(refinement, self.fan), cuts, part, parts)
        return QuadMesh(self.place(piece.points, refinement), piece.cells, piece.edges)

    def refinement(self, required: Requirements) -> Refinement:
        """Refinement that meets the requirements with :meth:`degree`."""
        ratio, sectors = self.ratio, self.sectors
        if self._gentler(required):
            # An even number puts a vertex into the corners of walls.
            ratio, sectors = ratio**_GENTLER, sectors + (2 if self.walls else 1)
            if not self._in_angle(required) and self._apart(required) > _HIGHER:
                ratio = max(ratio, self.tight)
        elif self._own_rings(required):
            ratio = self.stressed
        finer = self._finer(required)
        sectors += finer
        if finer and required.nearest is None:
            ratio **= _STEEPER
        levels = ceil(log(pi / 2.0 / self._innermost(required)) / -log(ratio))
        columns = self._columns(self._outer_ξ(required) - pi / 2.0)
        if not self.rings:
            levels, columns = 0, (sum(columns) / len(columns),) * len(columns)
        parts = (finer + 3) // 2 if finer else int(self._apart(required) > _TURNED)
        pieces = 1 + parts + self._cuts_middle(required)
        crowding = _CROWDING if finer and required.nearest is None else 0.0
        return Refinement(levels, ratio, sectors, columns, pieces, crowding)

    def _columns(self, reach: float) -> tuple[float, ...]:
        """Widths in ξ of the columns from the rings to the far boundary."""
        if reach <= self.alone:
            return (reach,)
        # The column next to the rings is narrow: the field still turns there.
        first = min(self.column, 1.0)
        count = ceil((reach - first) / self.column)
        return (first, *((reach - first) / count,) * count)

    def _gentler(self, required: Requirements) -> bool:
        """True where stresses need gentler rings, and more cells in angle."""
        tight = required.around or self._of_cells(required) < self.gentle
        return required.nearest is not None and tight

    def _own_rings(self, required: Requirements) -> bool:
        """True where rings for stresses have the ratio ``stressed``, and none gentler still."""
        if not self.stressed or required.nearest is None or self._gentler(required):
            return False
        turned = not required.inside or self._apart(required) > _TURNED
        return turned and self._of_cells(required) < _LOOSE

    def _in_angle(self, required: Requirements) -> bool:
        """True where stresses need cells fine in angle: off the surface, or on it without own rings."""
        return required.inside or required.around or not self.stressed

    def _turning(self, required: Requirements) -> tuple[float, float, float]:
        """Limits of the spread of a solid's fields: one of ``_ALONE``, ``_BESIDE``, …, see there."""
        if required.nearest is None:
            return _ALONE
        if not self._in_angle(required) and self._of_cells(required) < _LOOSE:
            return _BESIDE
        return _INSIDE if required.inside and self._own_rings(required) else _AROUND

    def _cuts_middle(self, required: Requirements) -> bool:
        """True where the outermost ring is cut, which meets in the middle of the contact.

        A curved surface is not resolved there otherwise. With the cut the degree may be lower: K_I and
        moments of a parabola were 1e3 times as exact at a degree, for 8 cells more in 108.
        """
        return required.bends and self.rings

    def _apart(self, required: Requirements) -> float:
        """Spread of the planes of the solid's fields, scaled by the digits to reach, 1 at six digits."""
        digits = -log10(self._of_cells(required)) * (1.0 if required.nearest is None else _OF_STRESSES)
        return required.spread * digits / 6.0

    def _finer(self, required: Requirements) -> int:
        """Number of additional sectors for a solid whose fields live in planes far apart.

        The large cells around the punch cannot resolve both fields, whatever the degree is; cells within
        them can, whose outermost ring is cut before that. Measured, see docs/verification.md.
        """
        apart = self._apart(required)
        least, start, step = self._turning(required)
        more = ceil((apart - start) / step) if apart > least else 0
        return more + more % 2 if self.walls else more

    def _innermost(self, required: Requirements) -> float:
        """Size of the innermost cells in the chart that meets the requirements."""
        tolerance = self._of_cells(required)
        size = float((self.innermost * tolerance) ** (1.0 / self._power(required)))
        if required.nearest is not None:
            # The innermost cells cannot resolve the singularity. Beside them that shows in the stresses,
            # like the square of their size over the distance, both in this chart.
            beside = self.beside * (_CLOSER if self._own_rings(required) else 1.0)
            size = min(size, sqrt(2.0 * required.nearest) * min(0.5, beside * sqrt(tolerance)))
        return max(size, self.smallest)

    def degree(self, required: Requirements, margin: float) -> int:
        """Polynomial degree that should meet the requirements; the measured error may raise it.

        Args:
            required: requirements on the mesh.
            margin: of the solid's response, in (0, 1]; errors grow as it falls.
        """
        digits = -log10(self._of_cells(required))
        lost = -log10(margin)
        more = 0.0
        if required.nearest is not None:
            more = 1.0 if self._gentler(required) else 0.6 + 0.15 * digits
        degree = ceil(3.4 - 0.75 * lost + (0.7 + 0.16 * lost) * digits + more)
        spared = 0 < self._finer(required) <= _SPARING
        if self._own_rings(required) and not required.inside:
            spared = self._finer(required) == 1 or self._apart(required) <= _HIGHER
        degree -= spared or self._cuts_middle(required)
        return min(max(degree, DEGREES[0]), DEGREES[1])

    def terms(self, required: Requirements) -> int:
        """Number of moments of the contact forces that the far boundary follows; 0 where it is held."""
        if self.walls:
            return 0
        return moments(radius(required.farthest), required.tolerance)

    def reach(self, required: Requirements) -> float:
        """Distance of the far boundary over a, the least one where it is no circle."""
        return exp(self._outer_ξ(required)) / 2.0

    def truncation(self, required: Requirements, margin: float = 1.0) -> float:
        """Estimated relative error of K_I by the far boundary; over σ_XY/σ_YY where it is held.

        A boundary held at a distance R costs a/R at rest, over the cubic root of the response's margin
        at a speed; measured.
        """
        if self.walls:
            return 1.0 / (self.walls * margin ** (1.0 / 3.0))
        return boundary_error(radius(required.farthest), self.terms(required), margin)

    def drawn(self, required: Requirements) -> QuadMesh | None:
        """The mesh where it is drawn for its places; None where it is built by a refinement."""
        return None

    def moved_edges(self, required: Requirements, degree: int, margin: float) -> float:
        """Apparent shift over a of the contact's edges, by the singularity in the innermost cells.

        Args:
            required: requirements on the mesh.
            degree: of the cells.
            margin: of the solid's response.
        """
        return 0.0

    def unseen_beside(self, required: Requirements, degree: int, cuts: int) -> float:
        """Estimated relative error of the stresses nearest to an edge by the innermost cells.

        With straight cells it does not depend on the degree; with others it falls with the degree's third
        power only; measured.

        Args:
            required: requirements on the mesh.
            degree, cuts: of the cells.
        """
        if required.nearest is None:
            return 0.0
        if self.fan:
            return (self._innermost(required) / (2.0 * self.beside)) ** 2 / required.nearest
        return (
            _LEFT_BESIDE * self._innermost(required) ** 2 / (2.0 * required.nearest * cuts**2 * degree**3)
        )

    def unseen(self, required: Requirements, degree: int, cuts: int, margin: float) -> float:
        """Estimated relative error of K_I by the innermost cells, which no comparison of levels shows.

        In a chart with smooth fields the remainder of a singularity is linear in the distance but not in
        the cell's coordinates: it falls with the degree's fourth power only. Measured at degree 12, over
        all κ and speeds: 0.2 to 6 at rest, ten times as much at 0.99 of the Rayleigh speed. Straight
        cells have an error of 0.1 to 0.2 of their size squared at rest, 0.6 to 0.9 at that speed, at any
        degree.

        Args:
            required: requirements on the mesh.
            degree, cuts: of the cells.
            margin: of the solid's response.
        """
        if self.fan:
            share = 0.3 / margin**0.4
        else:
            share = 6.0 / (cuts**2 * degree**4 * margin ** (2.0 / 3.0))
        return share * self._innermost(required) ** 2

    def _power(self, required: Requirements) -> float:
        """Power of a ring's size with which the energy in it falls."""
        return 4.0 * (1.0 + max(required.exponent, _STRONGEST))

    def _outer_ξ(self, required: Requirements) -> float:
        """Elliptic coordinate of the far boundary; its radius is a e^ξ/2."""
        if self.walls:
            return log(2.0 * self.walls)
        # For fields in other planes the boundary is nearer by half the distance of the planes.
        return log(2.0 * radius(required.farthest)) + required.spread / 2.0

    def _of_cells(self, required: Requirements) -> float:
        """Relative accuracy of the cells; with walls a thousandth of the error by these, if less."""
        if self.walls:
            return min(required.tolerance, self.truncation(required) / 1000.0)
        return required.tolerance


#: Meshes by the name that scenes use; every mesh adds itself.
MESHES: Registry[MeshKind] = Registry("mesh", kind=MeshKind)


def check_cells(mesh: QuadMesh) -> None:
    """Refuse a mesh with a degenerate or turned cell.

    Raises:
        ValueError: a corner of a quadrilateral has no positive area; the message says where.
    """
    corners = mesh.points[mesh.cells]
    ahead = np.roll(corners, -1, axis=1) - corners
    behind = np.roll(corners, 1, axis=1) - corners
    area = ahead[..., 0] * behind[..., 1] - ahead[..., 1] * behind[..., 0]
    size = np.linalg.norm(ahead, axis=-1) * np.linalg.norm(behind, axis=-1)
    worst = np.argmin((area / size).min(axis=1))
    if not (area[worst] / size[worst]).min() > 1e-3:
        raise ValueError(
            f"cell {worst} at {corners[worst].mean(axis=0)} (over a) is degenerate; "
            "choose more sectors or a ratio nearer to 1"
        )


def edges(kind: MeshKind, mesh: QuadMesh, points: int = 17) -> NDArray[np.float64]:
    """Polylines along the cells' edges in the half-plane over a, each edge once, (edges, points, 2)."""
    sides = np.stack([mesh.cells, np.roll(mesh.cells, -1, axis=1)], axis=-1).reshape(-1, 2)
    first, last = np.unique(np.sort(sides, axis=1), axis=0).T
    t = np.linspace(0.0, 1.0, points)[:, None]
    lines = (1.0 - t) * mesh.points[first][:, None] + t * mesh.points[last][:, None]
    return kind.chart.to_physical(lines.reshape(-1, 2)).reshape(-1, points, 2)


def nodes(kind: MeshKind, mesh: QuadMesh, degree: int) -> NDArray[np.float64]:
    """Nodes of a degree in the half-plane over a, (n, 2), cell by cell: those on common edges twice.

    Args:
        kind, mesh: the mesh.
        degree: polynomial degree; nodes are those of Gauss, Lobatto and Legendre.
    """
    inner = Legendre.basis(degree).deriv().roots().real
    t = (1.0 + np.array([-1.0, *inner, 1.0])) / 2.0
    s, t = (z.ravel()[:, None] for z in np.meshgrid(t, t))
    corners = mesh.points[mesh.cells][:, :, None]
    shapes = (1.0 - s) * (1.0 - t), s * (1.0 - t), s * t, (1.0 - s) * t
    points = sum(shape * corners[:, n] for n, shape in enumerate(shapes))
    return kind.chart.to_physical(np.reshape(points, (-1, 2)))
