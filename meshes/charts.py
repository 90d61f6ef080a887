"""Charts in which meshes are drawn, with their maps to the physical half-plane.

A chart gives the weak forms its gradient: in a conformal chart ∇u·Rᵀ with a rotation R and no Jacobian.
The protocol :class:`galinx.solvers.fem.cells.Chart` describes its members.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Physical:
    """The physical half-plane itself, lengths over a."""

    name: str = "physical"
    contracts: bool = False
    similar: bool = True

    def rotation(self, x: Any, of: Any = np) -> tuple[Any, Any]:
        return 1.0, 0.0

    def stretch(self, x: NDArray) -> NDArray:
        return np.ones(len(x))

    def to_physical(self, x: NDArray) -> NDArray:
        return np.asarray(x, dtype=float)

    def from_physical(self, X: NDArray) -> NDArray:
        return np.asarray(X, dtype=float)

    def along_surface(self, x: NDArray) -> NDArray:
        return np.asarray(x)[..., 0]

    def surface_coordinate(self, X: NDArray) -> NDArray:
        return np.asarray(X, dtype=float)

    def surface_position(self, s: NDArray) -> NDArray:
        return np.asarray(s, dtype=float)

    def surface_stretch(self, s: NDArray) -> NDArray:
        return np.ones_like(s)

    def from_edges(self, x: Any) -> tuple[Any, Any]:
        return x[0] + 1.0, 1.0 - x[0]

    def under_punch(self, from_left: Any, from_right: Any, of: Any = np) -> tuple[Any, Any, Any]:
        return from_left, from_right, 1.0 + 0.0 * from_left


@dataclass(frozen=True)
class Confocal:
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
