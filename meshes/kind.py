"""Kinds of meshes of the half-plane that scenes name, with the refinement that a tolerance needs.

Confocal ones are drawn in the rectangle of elliptic coordinates, where edge singularities are nearly
smooth; cells of graded ones and of the study's block have straight sides in the physical half-plane. A
kind is a row of numbers, a :class:`MeshKind`, which turns the requirements on a mesh into rings, sectors,
columns and a polynomial degree, by measured laws, see docs/verification.md.

The far boundary follows moments of the forces at the contact, see :mod:`galinx.solvers.fem.boundary`:
:func:`radius` and :func:`moments` are its distance and their number. Distances are over a, in the plane
where the boundary is nearest.

:func:`check_cells` refuses degenerate cells; :func:`edges` and :func:`nodes` are for drawings.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import ceil, exp, log, log10, pi, sqrt
from typing import NamedTuple

import numpy as np
from numpy.polynomial import Legendre
from numpy.typing import NDArray

from galinx.registry import Registry

from .charts import Chart, Confocal, Physical
from .rings import QuadMesh, Refinement, rectangle, sides_of

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


#: Lowest and highest polynomial degree used.
DEGREES = (4, 12)


def image(points: NDArray, _: Refinement) -> NDArray[np.float64]:
    """Vertices of straight-sided cells, whose pattern is drawn in elliptic coordinates."""
    return Confocal().to_physical(points)


#: Width and depth of the study's block over the half-width: l_p/W = 0.01, l_p/H = 0.02, l_p = 2a.
BOX_WIDTH, BOX_DEPTH = 200.0, 100.0


def box(points: NDArray, refinement: Refinement) -> NDArray[np.float64]:
    """The graded mesh, drawn out from ellipses to the study's block in its last columns."""
    ξ, η = points.T
    of_columns = np.pi / 2.0 + np.concatenate([[0.0], np.cumsum(refinement.columns)])
    # Three columns change shape, so that none is distorted much.
    inner, outer = of_columns[-4], of_columns[-1]
    share = np.clip((ξ - inner) / (outer - inner), 0.0, 1.0)[:, None]
    ray = np.column_stack([np.cos(η), np.sin(η)])
    sides = np.array([BOX_WIDTH / 2.0, BOX_DEPTH])
    wall = ray / np.max(np.abs(ray) / sides, axis=1, keepdims=True)
    scaled = wall * (np.cosh(ξ) / np.cosh(outer))[:, None]
    X = image(points, refinement)
    X = np.where(share > 0.0, (1.0 - share) * X + share * scaled, X)
    X[np.abs(X[:, 1]) < 1e-12, 1] = 0.0
    return X


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
        margin: of the solid's response, the least of all speeds, in (0, 1].
    """

    tolerance: float
    nearest: float | None = None
    farthest: float = 0.0
    exponent: float = -0.5
    around: bool = False
    inside: bool = False
    spread: float = 0.0
    bends: bool = False
    margin: float = 1.0


class _Needs(NamedTuple):
    """Numbers that requirements set for rings and sectors.

    Attributes:
        apart: spread of the planes of the solid's fields, scaled by the digits to reach, 1 at six digits.
        gentler: True where stresses need gentler rings, and more cells in angle.
        own_rings: True where rings for stresses have the ratio ``stressed``, and none gentler still.
        in_angle: True where stresses need cells fine in angle: off the surface, or on it without rings
            of their own.
        finer: additional sectors for planes far apart. The large cells around the punch cannot resolve
            both fields, whatever the degree is; cells within them can, whose outermost ring is cut
            before that.
    """

    apart: float
    gentler: bool
    own_rings: bool
    in_angle: bool
    finer: int


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
        place: maps points (n, 2) of the pattern with a refinement into that chart; None where it is drawn
            there.
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
    place: Callable[[NDArray, Refinement], NDArray] | None = None
    fan: bool = False
    rings: bool = True
    innermost: float = 1.0 / 3.0
    beside: float = 35.0
    gentle: float = 3e-7
    smallest: float = 1e-6
    sectors: int = 2
    walls: float | None = None

    def build(self, refinement: Refinement, cuts: int = 1) -> QuadMesh:
        """The mesh.

        Args:
            refinement: of the pattern.
            cuts: number of cells along each side of a cell of the pattern.
        """
        pattern = rectangle(refinement, self.fan, cuts)
        if self.place is None:
            return pattern
        return QuadMesh(self.place(pattern.points, refinement), pattern.cells, pattern.edges)

    def refinement(self, required: Requirements) -> Refinement:
        """Refinement that meets the requirements with :meth:`degree`."""
        needs, alone = self._needs(required), required.nearest is None
        ratio, sectors, finer = self.ratio, self.sectors, needs.finer
        if needs.gentler:
            # An even number puts a vertex into the corners of walls.
            ratio, sectors = ratio**_GENTLER, sectors + (2 if self.walls else 1)
            if not needs.in_angle and needs.apart > _HIGHER:
                ratio = max(ratio, self.tight)
        elif needs.own_rings:
            ratio = self.stressed
        if finer and alone:
            ratio **= _STEEPER
        levels = ceil(log(pi / 2.0 / self._innermost(required)) / -log(ratio))
        columns = self._columns(self._outer_ξ(required) - pi / 2.0)
        if not self.rings:
            levels, columns = 0, (sum(columns) / len(columns),) * len(columns)
        parts = (finer + 3) // 2 if finer else int(needs.apart > _TURNED)
        pieces = 1 + parts + self._cuts_middle(required)
        crowding = _CROWDING if finer and alone else 0.0
        return Refinement(levels, ratio, sectors + finer, columns, pieces, crowding)

    def _columns(self, reach: float) -> tuple[float, ...]:
        """Widths in ξ of the columns from the rings to the far boundary."""
        if reach <= self.alone:
            return (reach,)
        # The column next to the rings is narrow: the field still turns there.
        first = min(self.column, 1.0)
        count = ceil((reach - first) / self.column)
        return (first, *((reach - first) / count,) * count)

    def _needs(self, required: Requirements) -> "_Needs":
        """Rings and sectors that the requirements ask for, measured, see docs/verification.md."""
        stresses, tolerance = required.nearest is not None, self._of_cells(required)
        digits = -log10(tolerance) * (_OF_STRESSES if stresses else 1.0)
        apart, tight = required.spread * digits / 6.0, tolerance < _LOOSE
        gentler = stresses and (required.around or tolerance < self.gentle)
        turned = not required.inside or apart > _TURNED
        own_rings = stresses and self.stressed > 0.0 and not gentler and turned and tight
        in_angle = required.inside or required.around or not self.stressed
        if not stresses:
            least, start, step = _ALONE
        elif not in_angle and tight:
            least, start, step = _BESIDE
        else:
            least, start, step = _INSIDE if required.inside and own_rings else _AROUND
        finer = ceil((apart - start) / step) if apart > least else 0
        return _Needs(apart, gentler, own_rings, in_angle, finer + finer % 2 if self.walls else finer)

    def _cuts_middle(self, required: Requirements) -> bool:
        """True where the outermost ring is cut, which meets in the middle of the contact.

        A curved surface is not resolved there otherwise. With the cut the degree may be lower: K_I and
        moments of a parabola were 1e3 times as exact at a degree, for 8 cells more in 108.
        """
        return required.bends and self.rings

    def _innermost(self, required: Requirements) -> float:
        """Size of the innermost cells in the chart that meets the requirements."""
        tolerance = self._of_cells(required)
        size = float((self.innermost * tolerance) ** (1.0 / self._decay(required)))
        if required.nearest is not None:
            # The innermost cells cannot resolve the singularity. Beside them that shows in the stresses,
            # like the square of their size over the distance, both in this chart. Near the limit fields
            # are much larger than the stresses that are left of them.
            near = required.nearest * sqrt(required.margin)
            beside = self.beside * (_CLOSER if self._needs(required).own_rings else 1.0)
            size = min(size, sqrt(2.0 * near) * min(0.5, beside * sqrt(tolerance)))
        return max(size, self.smallest)

    def degree(self, required: Requirements, margin: float) -> int:
        """Polynomial degree that should meet the requirements; the measured error may raise it.

        Args:
            required: requirements on the mesh.
            margin: of the solid's response, in (0, 1]; errors grow as it falls.
        """
        digits, lost = -log10(self._of_cells(required)), -log10(margin)
        needs, more = self._needs(required), 0.0
        if required.nearest is not None:
            more = 1.0 if needs.gentler else 0.6 + 0.15 * digits
        degree = ceil(3.4 + 0.7 * digits + lost * max(0.16 * digits - 0.75, 0.0) + more)
        spared = 0 < needs.finer <= _SPARING
        if needs.own_rings and not required.inside:
            spared = needs.finer == 1 or needs.apart <= _HIGHER
        degree -= spared or self._cuts_middle(required)
        return min(max(degree, DEGREES[0]), DEGREES[1])

    def terms(self, required: Requirements) -> int:
        """Number of moments of the contact forces that the far boundary follows; 0 where it is held."""
        if self.walls:
            return 0
        return moments(radius(required.farthest), required.tolerance * required.margin)

    def reach(self, required: Requirements) -> float:
        """Distance of the far boundary over a, the least one where it is no circle."""
        return exp(self._outer_ξ(required)) / 2.0

    def truncation(self, required: Requirements, margin: float = 1.0) -> float:
        """Estimated relative error of K_I by the far boundary; over σ_XY/σ_YY where it is held.

        A boundary held at a distance R costs a/R at rest, over the cubic root of the response's margin
        at a speed; measured. For one that follows moments it is over |σ_XY/σ_YY| and a tenth: every other
        moment needs no friction. Measured on 60 solids, frictions to 5, speeds to 0.99 of the limit and 1
        to 6 moments; it is 1 to 5 times the largest of these.
        """
        if self.walls:
            return 1.0 / (self.walls * margin ** (1.0 / 3.0))
        R, terms = radius(required.farthest), self.terms(required)
        return 2.0 ** (2 - terms) / (R ** (terms + 1) * margin)

    def drawn(self, required: Requirements) -> QuadMesh | None:
        """The mesh where it is drawn for its places; None where it is built by a refinement."""
        return None

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
        degree. At free ends it falls with a higher power of the size, as the energy there does.

        Args:
            required: requirements on the mesh.
            degree, cuts: of the cells.
            margin: of the solid's response.
        """
        if self.fan:
            share = 0.3 / margin**0.4
        else:
            share = 6.0 / (cuts**2 * degree**4 * margin ** (2.0 / 3.0))
        return share * self._innermost(required) ** max(self._decay(required), 2.0)

    def _decay(self, required: Requirements) -> float:
        """Power of the size of a ring with which the energy in it falls."""
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


#: Meshes by the name that scenes use.
MESHES: Registry[MeshKind] = Registry("mesh", {
    "confocal": MeshKind(
        "confocal, graded towards the edges", Confocal(), ratio=0.35, column=3.0, alone=2.2, stressed=0.5,
        tight=0.6,
    ),
    "uniform": MeshKind(
        "confocal, squares all over", Confocal(), ratio=0.5, column=pi / 4.0, rings=False
    ),
    "graded": MeshKind(
        "straight-sided, graded towards the edges", Physical(contracts=True), ratio=0.5, column=1.0,
        place=image, fan=True, innermost=1.0 / 150.0, beside=6.0, gentle=1.0, smallest=1e-5,
    ),
    "box": MeshKind(
        "the block of the study, with walls at 100 a", Physical(), ratio=0.5, column=0.7, place=box,
        fan=True, beside=6.0, gentle=1.0, smallest=1e-5, walls=BOX_DEPTH,
    ),
}, MeshKind)  # fmt: skip


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
    first, last = np.unique(np.sort(sides_of(mesh.cells), axis=1), axis=0).T
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
