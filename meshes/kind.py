"""A way to mesh the half-plane, and how fine it has to be; measured, see docs/verification.md."""

from collections.abc import Callable
from dataclasses import dataclass
from math import atanh, ceil, exp, log, log10, pi, sqrt

from numpy.typing import NDArray

from galinx.meshes.charts import Confocal, Physical
from galinx.meshes.pieces import cut
from galinx.meshes.rings import QuadMesh, Refinement, rectangle
from galinx.registry import Registry

#: Lowest and highest polynomial degree used.
DEGREES = (4, 12)

#: Size in ξ of the innermost ring of a mesh for pieces: 4e-10 of their half-width, far below the distance
#: at which stresses next to an end are looked at.
_PIECE_INNERMOST = 3e-5

#: Most cells along each leg of an L in a mesh for pieces.
_MOST_SECTORS = 8


def as_drawn(points: NDArray, _: Refinement) -> NDArray:
    """The pattern itself."""
    return points


def by_turning(β_s: float) -> int:
    """Cells along each leg of an L: fields turn within an angle of β_s = √(1 - c²)."""
    return 2 if β_s > 0.5 else 3


@dataclass(frozen=True)
class MeshKind:
    """A way to mesh the half-plane.

    Attributes:
        about: what it is.
        chart: where the mesh is drawn.
        ratio: size of a ring over that of the ring outside it. Straight cells in the physical plane need
            gentler rings than confocal ones: a ratio t there is t² in distance.
        column: largest width in ξ of a column outside the rings.
        place: puts points (n, 2) of the pattern with a refinement into that chart.
        fan: what fills the innermost squares of the pattern, see :func:`galinx.meshes.rings.rectangle`.
        rings: grading towards the edges; without, squares all over, and the degree or cuts do the rest.
        sectors: cells along each leg of an L, by √(1 - c²) at the highest speed.
        walls: distance of the far boundary over a; None where the tolerance sets it.
    """

    about: str
    chart: Confocal | Physical
    ratio: float
    column: float
    place: Callable[[NDArray, Refinement], NDArray] = as_drawn
    fan: bool = False
    rings: bool = True
    sectors: Callable[[float], int] = by_turning
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

    def refinement(self, tolerance: float, β_s: float) -> Refinement:
        """Refinement that reaches ``tolerance`` with :meth:`degree`.

        Args:
            tolerance: wanted relative accuracy of K_I and of the pressure's moments.
            β_s: √(1 - c²) at the highest speed.
        """
        # The energy in a ring falls with its size squared.
        innermost = (self._of_cells(tolerance) / 3.0) ** 0.5
        sectors = self.sectors(β_s)
        return self._refinement(innermost, self.ratio, self._outer_ξ(tolerance), self.column, sectors)

    def for_pieces(self, tolerance: float, β_s: float, view: float) -> Refinement:
        """Refinement for an interval whose stresses are wanted, at its ends and far away.

        Stresses there are infinite like logarithms, and those of intervals that meet have to cancel.

        Args:
            tolerance: wanted relative accuracy of stresses.
            β_s: √(1 - c²) at the highest speed.
            view: how far from it, over the half-width.
        """
        outer = log(2.0 * 100.0 / tolerance * view)
        # Fields have poles at the angles ±i artanh β_s. Where they come near a cell, twice the cells gain
        # more than a higher degree.
        sectors = ceil(-log10(tolerance) / (2.2 * min(atanh(min(β_s, 0.9)), 1.5)))
        sectors = min(max(sectors, self.sectors(β_s)), _MOST_SECTORS)
        return self._refinement(_PIECE_INNERMOST, sqrt(self.ratio), outer, self.column / 1.5, sectors)

    def _refinement(
        self, innermost: float, ratio: float, outer: float, column: float, sectors: int
    ) -> Refinement:
        """Rings down to ``innermost`` and columns to ξ = ``outer``."""
        levels = ceil(log(pi / 2.0 / innermost) / -log(ratio))
        reach = outer - pi / 2.0
        # The column next to the rings is narrow: the field still turns there.
        first = min(column, 1.0)
        count = ceil((reach - first) / column)
        columns = (first, *((reach - first) / count,) * count)
        if not self.rings:
            levels, columns = 0, (reach / (count + 1),) * (count + 1)
        return Refinement(levels, ratio, sectors, columns)

    def degree(self, tolerance: float, margin: float) -> int:
        """Polynomial degree that should reach ``tolerance``; the measured error may ask for more.

        Args:
            tolerance: wanted relative accuracy.
            margin: of the solid's response, in (0, 1]; errors grow as it falls.
        """
        digits = -log10(self._of_cells(tolerance))
        lost = -log10(margin)
        wanted = ceil(3.4 - 0.4 * lost + (0.7 + 0.23 * lost) * digits)
        return min(max(wanted, DEGREES[0]), DEGREES[1])

    def reach(self, tolerance: float) -> float:
        """Distance of the far boundary over a, the least where it is no circle."""
        return exp(self._outer_ξ(tolerance)) / 2.0

    def truncation(self, tolerance: float, margin: float = 1.0) -> float:
        """Estimated relative error of K_I from the finite outer radius R, times σ_XY/σ_YY.

        a/R at rest; it was seen to grow as the root of the response's margin falls.
        """
        return 1.0 / (self.reach(tolerance) * sqrt(margin))

    def _outer_ξ(self, tolerance: float) -> float:
        """Elliptic coordinate of the far boundary; its radius is a e^ξ/2."""
        if self.walls:
            return log(2.0 * self.walls)
        # Truncation at radius R costs about a/R in K_I; a hundredth of the tolerance is left to it.
        return log(2.0 * 100.0 / tolerance)

    def _of_cells(self, tolerance: float) -> float:
        """What the cells have to reach: beside walls, which set the error, nothing more."""
        return min(tolerance, self.truncation(tolerance) / 1000.0) if self.walls else tolerance


#: Meshes by the name that scenes use; every mesh adds itself.
MESHES: Registry[MeshKind] = Registry("mesh")
