"""Where the contact is: the one place that decides it."""

import numpy as np
from numpy.typing import ArrayLike, NDArray


def under_punch(X: ArrayLike) -> NDArray[np.bool_]:
    """Is a position X over a on the surface under the punch? Its edges are not."""
    return np.abs(np.asarray(X, dtype=float)) < 1.0


def from_edge(X: ArrayLike) -> NDArray[np.float64]:
    """Distance over a from the nearer edge of the punch."""
    return np.abs(1.0 - np.abs(np.asarray(X, dtype=float)))
