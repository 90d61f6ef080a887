"""Charts in which meshes are drawn, with their maps to the physical half-plane.

A chart gives the weak forms its gradient: in a conformal chart ∇u·Rᵀ with a rotation R and no Jacobian.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Chart:
    """Coordinates in which a mesh is drawn, those of the half-plane itself over a unless overridden.

    Attributes:
        name: name of the chart in archives.
        contracts: True where a mesh is drawn in the plane as the solid contracts it, see
            :class:`galinx.solvers.fem.cells.Contracted`.
        similar: True where cells that are congruent in the chart, but for their size, have the same
            matrix.
    """

    name: str = "physical"
    contracts: bool = False
    similar: bool = True

    def rotation(self, x: Any, of: Any = np) -> tuple[Any, Any]:
        """cos and sin of the rotation R = [[cos, -sin], [sin, cos]] at points x (2, n).

        Args:
            x: points, or UFL's coordinates.
            of: module of cos and the like for x, NumPy or UFL.
        """
        return 1.0, 0.0

    def stretch(self, x: NDArray) -> NDArray:
        """Length of a step in physical coordinates over that in the chart, at points (n, 2)."""
        return np.ones(len(x))

    def to_physical(self, x: NDArray) -> NDArray:
        """Physical coordinates over a of points (..., 2) of the chart."""
        return np.asarray(x, dtype=float)

    def from_physical(self, X: NDArray) -> NDArray:
        """Points of the chart, (..., 2), of physical coordinates over a with Y <= 0."""
        return np.asarray(X, dtype=float)

    def along_surface(self, x: NDArray) -> NDArray:
        """Surface coordinate s of points (..., 2) of the chart on Y = 0; it grows with X."""
        return np.asarray(x)[..., 0]

    def surface_coordinate(self, X: NDArray) -> NDArray:
        """Surface coordinate s at positions X over a."""
        return np.asarray(X, dtype=float)

    def surface_position(self, s: NDArray) -> NDArray:
        """Positions X over a at surface coordinates s."""
        return np.asarray(s, dtype=float)

    def surface_stretch(self, s: NDArray) -> NDArray:
        """dX/ds along the surface."""
        return np.ones_like(s)

    def from_edges(self, x: Any) -> tuple[Any, Any]:
        """Distances in s of points of the contact, (2, n) or UFL's coordinates, from both punch edges."""
        return x[0] + 1.0, 1.0 - x[0]

    def under_punch(self, from_left: Any, from_right: Any, of: Any = np) -> tuple[Any, Any, Any]:
        """1 + X/a, 1 - X/a and dX/ds at given distances in s from the two punch edges.

        Next to an edge the distance has lost its digits in X/a itself.

        Args:
            from_left, from_right: numbers, or UFL's expressions.
            of: module of their functions, NumPy or UFL.
        """
        return from_left, from_right, 1.0 + 0.0 * from_left


class Physical(Chart):
    """The physical half-plane itself."""


@dataclass(frozen=True)
class Confocal(Chart):
    """The rectangle of elliptic coordinates, X + iY = a cosh(ξ + iη).

    With sinh(ξ + iη) = A + iB the rotation is [[A, -B], [B, A]]/√(A² + B²); both are divided by
    cosh ξ here, so that nothing overflows however far the mesh reaches.
    """

    name: str = "confocal"
    contracts: bool = True
    similar: bool = False

    def rotation(self, x: Any, of: Any = np) -> tuple[Any, Any]:
        A = of.tanh(x[0]) * of.cos(x[1])
        B = of.sin(x[1])
        length = of.sqrt(A * A + B * B)
        return A / length, B / length

    def stretch(self, x: NDArray) -> NDArray:
        return np.hypot(np.sinh(x[:, 0]), np.sin(x[:, 1]))

    def to_physical(self, x: NDArray) -> NDArray:
        w = np.asarray(x[..., 0]) + 1j * np.asarray(x[..., 1])
        z = np.cosh(w)
        return np.stack([z.real, np.minimum(z.imag, 0.0)], axis=-1)

    def from_physical(self, X: NDArray) -> NDArray:
        X = np.asarray(X, dtype=float)
        # The branch with η in [-π, 0]: arccosh of the conjugate, conjugated.
        w = np.conj(np.arccosh(X[..., 0] - 1j * np.minimum(X[..., 1], -0.0)))
        return np.stack([np.abs(w.real), -np.abs(w.imag)], axis=-1)

    # Along the surface X = sin s under the punch and |X| = cosh(|s| - π/2) beside it.

    def along_surface(self, x: NDArray) -> NDArray:
        side = np.asarray(x)[..., 1] + np.pi / 2.0
        return side + np.sign(side) * np.asarray(x)[..., 0]

    def surface_coordinate(self, X: NDArray) -> NDArray:
        X = np.asarray(X, dtype=float)
        inside = np.arcsin(np.clip(X, -1.0, 1.0))
        return inside + np.sign(X) * np.arccosh(np.maximum(np.abs(X), 1.0))

    def surface_position(self, s: NDArray) -> NDArray:
        beyond = np.maximum(np.abs(s) - np.pi / 2.0, 0.0)
        return np.where(beyond > 0.0, np.sign(s) * np.cosh(beyond), np.sin(s))

    def surface_stretch(self, s: NDArray) -> NDArray:
        beyond = np.abs(s) - np.pi / 2.0
        return np.where(beyond < 0.0, np.cos(s), np.sinh(np.maximum(beyond, 0.0)))

    def from_edges(self, x: Any) -> tuple[Any, Any]:
        return x[1] + np.pi, -x[1]

    def under_punch(self, from_left: Any, from_right: Any, of: Any = np) -> tuple[Any, Any, Any]:
        # The distances in η add up to π: the sine of half of either has all digits next to both edges.
        s_left, s_right = of.sin(from_left / 2.0), of.sin(from_right / 2.0)
        return 2.0 * s_left**2, 2.0 * s_right**2, 2.0 * s_left * s_right
