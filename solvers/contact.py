"""Positions under a punch with two edges, and the contact stress that is singular at them."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray


def under_punch(X: ArrayLike) -> NDArray[np.bool_]:
    """True where a position X over a on the surface is under the punch; False at its edges."""
    return np.abs(np.asarray(X, dtype=float)) < 1.0


def from_edge(X: ArrayLike) -> NDArray[np.float64]:
    """Distance over a from the nearer edge of the punch."""
    return np.abs(1.0 - np.abs(np.asarray(X, dtype=float)))


@dataclass(frozen=True)
class EdgeTraction:
    """Stress on the contact of a flat punch over N/(2a) (Eq 55); numbers, arrays, or symbols of a form.

    Attributes:
        amplitude: of the stress, negative.
        α, β: exponents at X = a and X = -a.
    """

    amplitude: Any
    α: Any
    β: Any

    def __call__(self, left: Any, right: Any) -> Any:
        """The stress at the distances 1 + X/a and 1 - X/a from the two edges."""
        return self.amplitude * right**self.α * left**self.β
