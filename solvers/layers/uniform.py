"""A uniform layer: how it changes the stiffness of what is below it, and the field inside it.

With E = e^(ik G H), Z_b the stiffness of what is below and

    r = (Z₊ - Z_b)⁻¹ (Z_b - Z₋),   W = E r conj(E),

the stiffness on top is Z₋ + δ, δ = (Z₊ - Z₋) W (1 + W)⁻¹: exponentials that decay, and no other.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.layers.medium import Medium, inverse, least

_ONE = np.eye(2)


@dataclass(frozen=True)
class Uniform:
    """A layer at a speed.

    Attributes:
        medium: its solid.
        H: thickness over a.
    """

    medium: Medium
    H: float

    @property
    def top(self) -> Medium:
        """The solid at its upper face."""
        return self.medium

    @property
    def bottom(self) -> Medium:
        """The solid at its lower face."""
        return self.medium

    def check(self) -> None:
        """There is nothing in it that could not be followed."""

    def _reflected(self, below: NDArray) -> NDArray:
        """r, (n, 2, 2)."""
        return inverse(self.medium.up - below) @ (below - self.medium.down)

    def excess(self, k: NDArray, below: NDArray) -> NDArray:
        """δ: stiffness on top less that of a half-plane of the solid there, (n, 2, 2).

        Args:
            k: wavenumbers times a, (n,).
            below: stiffness Z of what is below, (n, 2, 2).
        """
        E = self.medium.upwards(k * self.H)
        W = E @ self._reflected(below) @ E.conj()
        return np.asarray((self.medium.up - self.medium.down) @ W @ inverse(_ONE + W))

    def stands(self, k: NDArray, below: NDArray) -> NDArray[np.float64]:
        """Smaller eigenvalue of what holds its lower face where the upper one is held, (n,).

        Not positive: some wave with this wavenumber runs inside, slower than the load.
        """
        E = self.medium.upwards(k * self.H)
        back = E.conj() @ E
        with np.errstate(all="ignore"):
            own = -(self.medium.up - self.medium.down @ back) @ inverse(_ONE - back)
        return least(below + own)

    def carried(self, k: NDArray, below: NDArray) -> NDArray[Any]:
        """Displacement of the lower face by that of the upper one, (n, 2, 2).

        Args:
            k, below: as before.
        """
        E, r = self.medium.upwards(k * self.H), self._reflected(below)
        return np.asarray((_ONE + r) @ E.conj() @ inverse(_ONE + E @ r @ E.conj()))

    def cut(self, depth: float) -> tuple["Uniform", "Uniform"]:
        """What is above and below a depth."""
        return Uniform(self.medium, depth), Uniform(self.medium, self.H - depth)

    def first_order(self) -> NDArray[Any]:
        """What k δ tends to for large k, (2, 2): δ falls exponentially."""
        return np.zeros((2, 2), dtype=complex)
