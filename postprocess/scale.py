"""What stresses are measured against: what a relative error of theirs is relative to."""

from collections.abc import Iterable
from functools import reduce
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.contact import from_edge

#: Distance over a from a punch edge within which stresses, infinite there, stand for themselves only.
NEAR = 1e-2

#: Distance over a from a tip of the punch, where stresses are infinite, within which none is measured.
NEAR_TIP = 0.02

#: Share of the largest below which the smooth factor of a pressure, which may vanish, is not measured
#: against itself.
_VANISHING = 0.1


def of_in_plane(σ_XX: NDArray, X: NDArray) -> NDArray[np.float64]:
    """The larger of each value and a state's largest further than ``NEAR`` from the edges.

    Args:
        σ_XX: on the surface, (states, n).
        X: positions over a, (n,).

    Returns:
        (states, n).
    """
    return _at_least_far(np.abs(σ_XX), from_edge(X) >= NEAR)


def off_tips(X: NDArray, tips: NDArray, Y: Any = 0.0) -> NDArray[np.bool_]:
    """Which places are further than ``NEAR_TIP`` from all tips.

    Args:
        X, Y: of the places over a, (n,).
        tips: their positions over a on the surface, (k,) for all states, or (states, k).

    Returns:
        (n,), or (states, n).
    """
    from_tips = np.hypot(X[:, None] - np.asarray(tips)[..., None, :], np.reshape(Y, (-1, 1)))
    return np.all(from_tips >= NEAR_TIP, axis=-1)


def of_inside(σ: Iterable[NDArray], X: NDArray, Y: NDArray) -> NDArray[np.float64]:
    """The same of stresses inside, the largest component at a point taken for all: (states, m).

    Args:
        σ: components, each (states, m).
        X, Y: positions over a, (m,).
    """
    return _at_least_far(largest(σ), np.hypot(from_edge(X), Y) >= NEAR)


def of_interfaces(σ: NDArray) -> NDArray[np.float64]:
    """The largest along each interface of tractions, and of these or the in-plane stress on each side.

    Args:
        σ: σ_YY, σ_XY, σ_XX above and below, (4, states, interfaces, n).

    Returns:
        (4, states, interfaces, 1).
    """
    size = np.abs(σ).max(axis=3, keepdims=True)
    tractions = np.maximum(size[0], size[1])
    return np.maximum(size, tractions)


def largest(components: Iterable[NDArray]) -> NDArray[np.float64]:
    """Largest absolute value of some arrays of one shape, element by element."""
    return reduce(np.maximum, map(np.abs, components))


def of_factor(f: NDArray) -> NDArray[np.float64]:
    """The larger of each value of a smooth factor and a tenth of a state's largest, (states, n)."""
    return np.maximum(np.abs(f), _VANISHING * np.abs(f).max(axis=1, keepdims=True))


def _at_least_far(size: NDArray, far: NDArray) -> NDArray[np.float64]:
    return np.maximum(size, np.where(far, size, 0.0).max(axis=1, keepdims=True, initial=0.0))
