"""A way to mesh the half-plane, and how fine it has to be; measured, see docs/verification.md.

How far away a boundary is that follows the forces at the contact, and how many of their moments.

See :mod:`galinx.solvers.fem.boundary`; distances are over a, in the plane where the boundary is nearest.

Cells graded towards places inside the contact, too, where the slope of a punch has a kink.

Between neighbouring places, both ends of the contact among them, the strip along the contact is cut in
the middle; each half is a corner of :mod:`galinx.meshes.rings`, stretched. Columns go on outwards.

What is asked of a mesh's cells: are they sound, and where are their edges?
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise
from math import ceil, exp, log, log10, pi, sqrt

import numpy as np
from numpy.polynomial import Legendre
from numpy.typing import NDArray

from galinx.registry import Registry

from .charts import Confocal, Physical
from .rings import QuadMesh, Refinement, corner, cut, joined, rectangle

#: Distance at least, and over that of the farthest place where stresses are wanted.
_LEAST, _BEYOND = 17.0, 1.7

#: How many moments there are: what their error is of, and the share of the tolerance that is left to it.
_LEFT_OUT, _SHARE = 0.02, 1e-4


def radius(farthest: float) -> float:
    """Of the boundary, by the distance of the farthest place where stresses are wanted."""
    return max(_LEAST, _BEYOND * farthest)


def moments(R: float, tolerance: float) -> int:
    """How many a boundary at a distance R follows."""
    return max(ceil(log(_LEFT_OUT / (_SHARE * tolerance)) / log(R)) - 1, 1)


def left(R: float, moments: int, margin: float) -> float:
    """Estimated relative error of K_I by a boundary at a distance R that follows so many.

    Over |σ_XY/σ_YY| and a tenth: every other moment needs no friction. Measured on 60 solids, frictions
    to 5, speeds to 0.99 of the limit and 1 to 6 moments; it is 1 to 5 times the largest of these.
    """
    return 2.0 ** (2 - moments) / (R ** (moments + 1) * margin)


#: Width of the strip over the mean height of its halves, and what a column grows by outwards.
_WIDE, _GROWTH = 1.3, 1.6
#: Elliptic coordinate, some 4 000 a, beyond which a field is that of a line load to all digits that are
#: told, linear in this coordinate, and columns need no largest width.
_FAR = 9.0


def with_kinks(refinement: Refinement, places: NDArray, more: int = 0) -> QuadMesh:
    """The rectangle in the (ξ, η) plane of a confocal mesh.

    Args:
        refinement: of the mesh without kinks.
        places: X over a of the kinks, in (-1, 1).
        more: rings around these than around the ends.
    """
    η = np.concatenate([[-np.pi], np.sort(-np.arccos(places)), [0.0]])
    width = min(_WIDE * np.pi / (2.0 * (len(η) - 1)), np.pi / 2.0)
    of_end, of_kink = (
        corner(1.0, replace(refinement, levels=refinement.levels + levels), False)[0]
        for levels in (0, more)
    )
    quads, rows = [], [-np.pi]
    for low, high in pairwise(η):
        half = (high - low) / 2.0
        below = (of_end if high == η[-1] else of_kink) * [width, half] + [0.0, high]
        above = ((of_end if low == η[0] else of_kink) * [width, -half] + [0.0, low])[:, ::-1]
        quads += [above, below]
        for start in (low, low + half):
            rows += (start + half * refinement.legs[1:]).tolist()
    ξ = _columns(width, np.pi / 2.0 + sum(refinement.columns), max(refinement.columns))
    quads.append(
        np.reshape(
            [
                [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
                for x0, x1 in pairwise(ξ)
                for y0, y1 in pairwise(rows)
            ],
            (-1, 4, 2),
        )
    )
    return joined(np.concatenate(quads).reshape(-1, 2), ξ[-1])


def _columns(first: float, last: float, widest: float) -> list[float]:
    """Where columns end in ξ, from the strip's width to the far boundary; near by at most ``widest``."""
    found, step = [first], first
    while last - found[-1] > 1.5 * step:
        found.append(found[-1] + step)
        step = min(_GROWTH * step, widest if found[-1] < _FAR else np.inf)
    return [*found, last]


#: Lowest and highest polynomial degree used.
DEGREES = (4, 12)


def as_drawn(points: NDArray, _: Refinement) -> NDArray:
    """The pattern itself."""
    return points


#: Exponent of a pressure that is still resolved: with a stronger one rings would never end.
_STRONGEST = -0.95

#: How far apart fields may live before cells finer in angle are needed, from what on, and by how much, a
#: sector more stands for each step: for K_I and moments alone, for stresses on the surface that rings of
#: their own tell, for stresses inside, and for all others.
_ALONE, _BESIDE, _INSIDE, _AROUND = (1.0, 0.65, 0.8), (1.9, 1.9, 0.8), (0.5, 0.55, 0.65), (1.2, 0.9, 0.8)

#: How far apart they may live before the outermost ring is cut, and before stresses on the surface ask
#: for a degree more, or at a tight tolerance for gentler rings.
_TURNED, _HIGHER = 0.5, 0.7

#: Share of the size of innermost cells that is left where rings tell stresses at lower degrees.
_CLOSER = 0.5

#: Tolerance from which on rings of stresses have a ratio of their own.
_LOOSE = 2e-4

#: Sectors up to which, being more than isotropic solids need, they spare a degree.
_SPARING = 3

#: What confocal cells leave in stresses at the nearest place, over their size squared over its distance,
#: both in ξ and η, and over the degree's third power; measured.
_LEFT_BESIDE = 0.05

#: How far sectors crowd where they are more: planes apart turn fields along the axes, where legs end.
_CROWDING = 0.3

#: Digits of moments that go with a digit of stresses.
_OF_STRESSES = 1.5

#: Power of the rings' ratio by which they are gentler for stresses, and steeper where cells are finer in
#: angle for the sake of the large ones: rings then have more of them than the edges ask for.
_GENTLER, _STEEPER = 0.6, 1.5


@dataclass(frozen=True)
class Wanted:
    """What a mesh has to be good for.

    Attributes:
        tolerance: relative accuracy.
        nearest: least distance over a from a punch edge of a place where stresses are wanted; None where
            K_I and the pressure's moments are wanted alone.
        farthest: largest coordinate over a of such a place.
        exponent: of the strongest singularity of the pressure, in (-1, -1/2]; 1/2 where it has none.
        around: are such places all round the edges?
        inside: are some of them below the surface?
        spread: how far apart the planes are in which the solid's fields are analytic, see
            :class:`galinx.solvers.solids.solid.Response`.
        bends: is the surface under the punch not straight, nor the pressure that of a flat one?
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
    """A way to mesh the half-plane.

    Attributes:
        about: what it is.
        chart: where the mesh is drawn.
        ratio: size of a ring over that of the ring outside it. Straight cells in the physical plane need
            gentler rings than confocal ones: a ratio t there is t² in distance.
        column: largest width in ξ of a column outside the rings.
        alone: width in ξ up to which there is one column outside the rings, and no other.
        stressed: ratio of rings for stresses, at a degree less on the surface; 0 for ``ratio``.
        tight: the same on the surface below the tolerance ``gentle``, of solids that need more.
        place: puts points (n, 2) of the pattern with a refinement into that chart.
        fan: what fills the innermost squares of the pattern, see :func:`galinx.meshes.rings.rectangle`.
        rings: grading towards the edges; without, squares all over, and the degree or cuts do the rest.
        innermost: share of the tolerance that is left to the innermost cells. Where these cannot follow
            the singularity it hardly falls with the degree, so that no estimate sees it.
        beside: size of the innermost cells over the distance of the nearest place, in the chart and over
            the root of the tolerance.
        gentle: tolerance below which stresses ask for gentler rings and more cells in angle: derivatives
            converge half as fast as moments of the pressure, and degrees are not high enough. All round
            the edges they always do.
        smallest: least size of the innermost cells, of whose square, a distance over a, rounding of
            positions leaves enough digits.
        sectors: cells along each leg of an L.
        walls: distance over a of a far boundary that is held; None where it follows the contact.
    """

    about: str
    chart: Confocal | Physical
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
            cuts: every cell of it is cut into so many along each side.
            part, parts: which of how many pieces.
        """
        piece = cut(rectangle(refinement, self.fan), cuts, part, parts)
        return QuadMesh(self.place(piece.points, refinement), piece.cells, piece.edges)

    def refinement(self, wanted: Wanted) -> Refinement:
        """Refinement that reaches what is wanted with :meth:`degree`."""
        ratio, sectors = self.ratio, self.sectors
        if self._gentler(wanted):
            # An even number puts a vertex into the corners of walls.
            ratio, sectors = ratio**_GENTLER, sectors + (2 if self.walls else 1)
            if not self._in_angle(wanted) and self._apart(wanted) > _HIGHER:
                ratio = max(ratio, self.tight)
        elif self._own_rings(wanted):
            ratio = self.stressed
        finer = self._finer(wanted)
        sectors += finer
        if finer and wanted.nearest is None:
            ratio **= _STEEPER
        levels = ceil(log(pi / 2.0 / self._innermost(wanted)) / -log(ratio))
        columns = self._columns(self._outer_ξ(wanted) - pi / 2.0)
        if not self.rings:
            levels, columns = 0, (sum(columns) / len(columns),) * len(columns)
        parts = (finer + 3) // 2 if finer else int(self._apart(wanted) > _TURNED)
        pieces = 1 + parts + self._cuts_middle(wanted)
        crowding = _CROWDING if finer and wanted.nearest is None else 0.0
        return Refinement(levels, ratio, sectors, columns, pieces, crowding)

    def _columns(self, reach: float) -> tuple[float, ...]:
        """Widths in ξ of the columns from the rings to the far boundary."""
        if reach <= self.alone:
            return (reach,)
        # The column next to the rings is narrow: the field still turns there.
        first = min(self.column, 1.0)
        count = ceil((reach - first) / self.column)
        return (first, *((reach - first) / count,) * count)

    def _gentler(self, wanted: Wanted) -> bool:
        """Do stresses ask for gentler rings, and more cells in angle?"""
        tight = wanted.around or self._of_cells(wanted) < self.gentle
        return wanted.nearest is not None and tight

    def _own_rings(self, wanted: Wanted) -> bool:
        """Have stresses rings of a ratio of their own, that is not gentler still?"""
        if not self.stressed or wanted.nearest is None or self._gentler(wanted):
            return False
        turned = not wanted.inside or self._apart(wanted) > _TURNED
        return turned and self._of_cells(wanted) < _LOOSE

    def _in_angle(self, wanted: Wanted) -> bool:
        """Are stresses wanted off the surface, or is it a mesh whose rings do not tell those on it?"""
        return wanted.inside or wanted.around or not self.stressed

    def _turning(self, wanted: Wanted) -> tuple[float, float, float]:
        """How far apart fields may live, see ``_ALONE`` and those after it."""
        if wanted.nearest is None:
            return _ALONE
        if not self._in_angle(wanted) and self._of_cells(wanted) < _LOOSE:
            return _BESIDE
        return _INSIDE if wanted.inside and self._own_rings(wanted) else _AROUND

    def _cuts_middle(self, wanted: Wanted) -> bool:
        """Is the outermost ring cut, which meets in the middle of the contact?

        A curve is not resolved there otherwise. Where it is, the degree may be lower: of a parabola K_I
        and moments were seen to be 1e3 times as exact at a degree, for 8 cells more in 108.
        """
        return wanted.bends and self.rings

    def _apart(self, wanted: Wanted) -> float:
        """How much it matters that the solid's fields live in planes apart."""
        digits = -log10(self._of_cells(wanted)) * (1.0 if wanted.nearest is None else _OF_STRESSES)
        return wanted.spread * digits / 6.0

    def _finer(self, wanted: Wanted) -> int:
        """How many more sectors a solid asks for whose fields live in planes far apart.

        The large cells around the punch cannot follow both, whatever the degree is; those within them
        can, whose outermost ring is cut before that. Measured, see docs/verification.md.
        """
        apart = self._apart(wanted)
        least, start, step = self._turning(wanted)
        more = ceil((apart - start) / step) if apart > least else 0
        return more + more % 2 if self.walls else more

    def _innermost(self, wanted: Wanted) -> float:
        """Size of the innermost cells that is small enough."""
        tolerance = self._of_cells(wanted)
        size = float((self.innermost * tolerance) ** (1.0 / self._power(wanted)))
        if wanted.nearest is not None:
            # The innermost cells cannot follow the singularity. Beside them that shows in the stresses,
            # like the square of their size over the distance, both in this chart.
            beside = self.beside * (_CLOSER if self._own_rings(wanted) else 1.0)
            size = min(size, sqrt(2.0 * wanted.nearest) * min(0.5, beside * sqrt(tolerance)))
        return max(size, self.smallest)

    def degree(self, wanted: Wanted, margin: float) -> int:
        """Polynomial degree that should reach what is wanted; the measured error may ask for more.

        Args:
            wanted: what.
            margin: of the solid's response, in (0, 1]; errors grow as it falls.
        """
        digits = -log10(self._of_cells(wanted))
        lost = -log10(margin)
        more = 0.0
        if wanted.nearest is not None:
            more = 1.0 if self._gentler(wanted) else 0.6 + 0.15 * digits
        degree = ceil(3.4 - 0.75 * lost + (0.7 + 0.16 * lost) * digits + more)
        spared = 0 < self._finer(wanted) <= _SPARING
        if self._own_rings(wanted) and not wanted.inside:
            spared = self._finer(wanted) == 1 or self._apart(wanted) <= _HIGHER
        degree -= spared or self._cuts_middle(wanted)
        return min(max(degree, DEGREES[0]), DEGREES[1])

    def terms(self, wanted: Wanted) -> int:
        """Moments of the forces at the contact that the far boundary follows; 0 where it is held."""
        if self.walls:
            return 0
        return moments(radius(wanted.farthest), wanted.tolerance)

    def reach(self, wanted: Wanted) -> float:
        """Distance of the far boundary over a, the least where it is no circle."""
        return exp(self._outer_ξ(wanted)) / 2.0

    def truncation(self, wanted: Wanted, margin: float = 1.0) -> float:
        """Estimated relative error of K_I from the outer radius R; over σ_XY/σ_YY where it is held.

        Held it costs a/R at rest, seen to grow as the cubic root of the response's margin falls.
        """
        if self.walls:
            return 1.0 / (self.walls * margin ** (1.0 / 3.0))
        return left(radius(wanted.farthest), self.terms(wanted), margin)

    def unseen_beside(self, wanted: Wanted, degree: int, cuts: int) -> float:
        """Estimated relative error of the stresses nearest to an edge that these cells leave there.

        Straight cells leave it at any degree; of others it was seen to fall with the third power only.

        Args:
            wanted: what the mesh is for.
            degree, cuts: of the cells.
        """
        if wanted.nearest is None:
            return 0.0
        if self.fan:
            return (self._innermost(wanted) / (2.0 * self.beside)) ** 2 / wanted.nearest
        return _LEFT_BESIDE * self._innermost(wanted) ** 2 / (2.0 * wanted.nearest * cuts**2 * degree**3)

    def unseen(self, wanted: Wanted, degree: int, cuts: int, margin: float) -> float:
        """Estimated relative error of K_I that the innermost cells leave, and that no level sees.

        In a chart with smooth fields what is left of a singularity is linear in the distance but not in
        the cell's coordinates: it falls with the degree's fourth power only. Measured at degree 12, over
        all κ and speeds: 0.2 to 6 at rest, ten times as much at 0.99 of the Rayleigh speed. Straight
        cells leave 0.1 to 0.2 of their size squared at rest, 0.6 to 0.9 at that speed, at any degree.

        Args:
            wanted: what the mesh is for.
            degree, cuts: of the cells.
            margin: of the solid's response.
        """
        if self.fan:
            share = 0.3 / margin**0.4
        else:
            share = 6.0 / (cuts**2 * degree**4 * margin ** (2.0 / 3.0))
        return share * self._innermost(wanted) ** 2

    def _power(self, wanted: Wanted) -> float:
        """Of a ring's size, with which the energy in it falls."""
        return 4.0 * (1.0 + max(wanted.exponent, _STRONGEST))

    def _outer_ξ(self, wanted: Wanted) -> float:
        """Elliptic coordinate of the far boundary; its radius is a e^ξ/2."""
        if self.walls:
            return log(2.0 * self.walls)
        # What lives in other planes is nearer there by half their distance.
        return log(2.0 * radius(wanted.farthest)) + wanted.spread / 2.0

    def _of_cells(self, wanted: Wanted) -> float:
        """What the cells have to reach: beside walls, which set the error, nothing more."""
        if self.walls:
            return min(wanted.tolerance, self.truncation(wanted) / 1000.0)
        return wanted.tolerance


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
    """Where the unknowns of a degree are in the half-plane over a, those of neighbours twice, (n, 2).

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
