"""What the finite element room asks of the chart in which a mesh lives."""

from types import ModuleType
from typing import Any, Protocol

from numpy.typing import NDArray


class Chart(Protocol):
    """What forms and postprocessing ask of a chart: the coordinates a mesh is drawn in."""

    @property
    def name(self) -> str:
        """Name of the chart in archives and form caches."""

    def rotation(self, x: Any, functions: ModuleType) -> tuple[Any, Any]:
        """cos and sin of the rotation R = [[cos, -sin], [sin, cos]] at x.

        ``functions`` is the module whose sin, cos, tanh and sqrt suit x: numpy or ufl.
        """

    def stretch(self, x: NDArray) -> NDArray:
        """Length of a step in physical coordinates over that in the chart, at points (n, 2)."""

    def to_physical(self, x: NDArray) -> NDArray:
        """Physical coordinates over a of points (..., 2) of the chart."""

    def from_physical(self, X: NDArray) -> NDArray:
        """Points of the chart, (..., 2), of physical coordinates over a with Y <= 0."""

    def along_surface(self, x: NDArray) -> NDArray:
        """Surface coordinate s of points (..., 2) of the chart on Y = 0; it grows with X."""

    def surface_coordinate(self, X: NDArray) -> NDArray:
        """Surface coordinate s at positions X over a."""

    def surface_position(self, s: NDArray) -> NDArray:
        """Positions X over a at surface coordinates s."""

    def surface_stretch(self, s: NDArray) -> NDArray:
        """dX/ds along the surface."""

    def under_punch(self, from_left: NDArray, from_right: NDArray) -> tuple[NDArray, NDArray, NDArray]:
        """1 + X/a, 1 - X/a and dX/ds at given distances in s from the two punch edges.

        Next to an edge X/a itself no longer tells the distance, so this does.
        """
