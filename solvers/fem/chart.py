"""What the finite element room asks of the chart in which a mesh lives, and what speed does to it."""

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray


class Chart(Protocol):
    """What forms and postprocessing ask of a chart: the coordinates a mesh is drawn in."""

    @property
    def name(self) -> str:
        """Name of the chart in archives."""

    @property
    def contracts(self) -> bool:
        """Is a mesh drawn for what the solid makes of the plane, see :class:`Contracted`?"""

    @property
    def similar(self) -> bool:
        """Have cells that are alike in the chart, moved and scaled, the same matrix?"""

    def rotation(self, x: Any, of: Any = np) -> tuple[Any, Any]:
        """cos and sin of the rotation R = [[cos, -sin], [sin, cos]] at points x (2, n).

        Args:
            x: points, or UFL's coordinates.
            of: what has their functions, NumPy or UFL.
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

    def from_edges(self, x: Any) -> tuple[Any, Any]:
        """Distances in s of points of the contact, (2, n) or UFL's coordinates, from both punch edges."""

    def under_punch(self, from_left: Any, from_right: Any, of: Any = np) -> tuple[Any, Any, Any]:
        """1 + X/a, 1 - X/a and dX/ds at given distances in s from the two punch edges.

        Next to an edge X/a itself no longer tells the distance, so this does.

        Args:
            from_left, from_right: numbers, or UFL's expressions.
            of: what has their functions, NumPy or UFL.
        """


@dataclass(frozen=True)
class Contracted:
    """A chart of the plane X' = X + Re(p) Y, Y' = Im(p) Y instead of the physical one.

    A solid's fields live in two such planes, where their parts are analytic; isotropic ones at rest
    in the physical plane. Speed contracts them, and a mesh that follows sees fields like those at rest.
    The surface stays where it is.

    Attributes:
        chart: the chart.
        p: of the contraction, Im p > 0; 1j for none.
    """

    chart: Chart
    p: complex

    def to_physical(self, x: NDArray) -> NDArray[np.float64]:
        """Physical coordinates over a of points (..., 2) of the chart."""
        drawn = self.chart.to_physical(x)
        Y = drawn[..., 1] / self.p.imag
        return np.stack([drawn[..., 0] - self.p.real * Y, Y], axis=-1)

    def from_physical(self, X: NDArray) -> NDArray[np.float64]:
        """Points of the chart, (..., 2), of physical coordinates over a with Y <= 0."""
        X = np.asarray(X, dtype=float)
        return self.chart.from_physical(
            np.stack([X[..., 0] + self.p.real * X[..., 1], self.p.imag * X[..., 1]], axis=-1)
        )

    def physical_gradients(self, x: NDArray, gradients: NDArray) -> NDArray[np.float64]:
        """Derivatives along X and Y from those along the chart's axes, at its points x (n, 2).

        Args:
            x: where; not at a punch edge of a chart whose stretch vanishes there.
            gradients: array (n, component, axis, fields).
        """
        axes = self.axes(x) / self.chart.stretch(x)[:, None, None]
        return np.einsum("ncxf,nxX->ncXf", gradients, axes, optimize=True)

    def axes(self, x: NDArray) -> NDArray[np.float64]:
        """What makes the same of them but for the chart's stretch: Rᵀ·M at points x (n, 2), (n, 2, 2)."""
        cos, sin = (value * np.ones(len(x)) for value in self.chart.rotation(x.T))
        M = np.array([[1.0, self.p.real], [0.0, self.p.imag]])
        return np.array([[cos, sin], [-sin, cos]]).transpose(2, 0, 1) @ M
