"""Measures of stresses and slopes: invariants, extremes, tension, flatness under the punch.

Relative errors of stresses are relative to the sizes that :func:`of_in_plane`, :func:`of_inside`,
:func:`of_interfaces` and :func:`of_factor` give.
"""

from collections.abc import Iterable
from functools import reduce
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .edges import from_edge


def flatness(surface: Any) -> NDArray[np.float64]:
    """Largest |v,X| for |X| <= 0.9a over the largest for |X| >= 1.1a, dimensionless, (states,).

    Args:
        surface: of finite elements, :class:`galinx.solvers.contact.solution.Surface`.
    """
    X = np.abs(surface.places.X)
    under, beside = (np.abs(surface.v_X[:, part]).max(axis=1) for part in (X <= 0.9, X >= 1.1))
    return under / beside


def von_mises(σ_XX: NDArray, σ_YY: NDArray, σ_XY: NDArray, σ_ZZ: NDArray) -> NDArray[np.float64]:
    """Von Mises stress in the unit and the shape of the stresses.

    √(½[(σ_XX - σ_YY)² + (σ_YY - σ_ZZ)² + (σ_ZZ - σ_XX)²] + 3σ_XY²).
    """
    normal = (σ_XX - σ_YY) ** 2 + (σ_YY - σ_ZZ) ** 2 + (σ_ZZ - σ_XX) ** 2
    return np.sqrt(normal / 2.0 + 3.0 * σ_XY**2)


def maximum_shear(σ_XX: NDArray, σ_YY: NDArray, σ_XY: NDArray) -> NDArray[np.float64]:
    """Largest shear stress in the plane, √(¼(σ_XX - σ_YY)² + σ_XY²), in the unit of the stresses."""
    return np.hypot((σ_XX - σ_YY) / 2.0, σ_XY)


def principal(σ_XX: NDArray, σ_YY: NDArray, σ_XY: NDArray) -> NDArray[np.float64]:
    """Principal stresses in the plane, the larger first, (2, ...), in the unit of the stresses."""
    middle, radius = (σ_XX + σ_YY) / 2.0, maximum_shear(σ_XX, σ_YY, σ_XY)
    return np.array([middle + radius, middle - radius])


def extreme(values: NDArray, X: NDArray, sign: float) -> tuple[NDArray, NDArray]:
    """Largest (sign 1) or smallest (-1) value along X and its place, by parabolas, (...) each.

    Args:
        values: (..., n).
        X: rising positions, (n,).
    """
    i = np.clip((sign * values).argmax(axis=-1), 1, len(X) - 2)
    x = X[i[..., None] + [-1, 0, 1]]
    y = np.take_along_axis(values, i[..., None] + [-1, 0, 1], axis=-1)
    slopes = np.diff(y, axis=-1) / np.diff(x, axis=-1)
    bend = (slopes[..., 1] - slopes[..., 0]) / (x[..., 2] - x[..., 0])
    with np.errstate(divide="ignore", invalid="ignore"):
        top = (x[..., 0] + x[..., 1]) / 2.0 - slopes[..., 0] / (2.0 * bend)
    inside = np.isfinite(top) & (top > x[..., 0]) & (top < x[..., 2]) & (sign * bend < 0.0)
    top = np.where(inside, top, x[..., 1])
    value = y[..., 0] + (top - x[..., 0]) * (slopes[..., 0] + bend * (top - x[..., 1]))
    best = np.take_along_axis(values, (sign * values).argmax(axis=-1)[..., None], axis=-1)[..., 0]
    return np.where(inside, value, best), top


def tension(surface: Any) -> NDArray[np.float64]:
    """Largest tension under the punch over N/(2a), and its X over a; 0 and NaN for none, (2, states).

    Args:
        surface: :class:`galinx.solvers.contact.solution.Surface`.
    """
    places = surface.places
    under, X = surface.σ_YY[:, places.under], places.X[places.under]
    size = np.maximum(under.max(axis=1), 0.0)
    return np.array([size, np.where(size > 0.0, X[under.argmax(axis=1)], np.nan)])


#: Distance over a from an edge of the punch, where stresses are infinite; nearer stresses are no measure
#: for the size of others.
NEAR = 1e-2

#: Distance over a from a tip of the punch, where stresses are infinite, within which none is compared.
NEAR_TIP = 0.02

#: Share of the largest smooth factor of a pressure; where the factor is smaller, its error is relative to
#: this share instead, since it may vanish.
_VANISHING = 0.1


def of_in_plane(σ_XX: NDArray, X: NDArray) -> NDArray[np.float64]:
    """Size of in-plane stresses on the surface: the larger of each and the largest far from the edges.

    Far from the edges is further than ``NEAR``.

    Args:
        σ_XX: in-plane stress on the surface, (states, n).
        X: positions over a, (n,).

    Returns:
        Sizes in the unit of the stress, (states, n).
    """
    return _at_least_far(np.abs(σ_XX), from_edge(X) >= NEAR)


def off_tips(X: NDArray, tips: NDArray, Y: Any = 0.0) -> NDArray[np.bool_]:
    """Mask of places further than ``NEAR_TIP`` from all tips of the punch.

    Args:
        X, Y: coordinates of the places over a, (n,).
        tips: positions X of the tips over a, (k,) for all states, or (states, k).

    Returns:
        True far from all tips, (n,), or (states, n).
    """
    from_tips = np.hypot(X[:, None] - np.asarray(tips)[..., None, :], np.reshape(Y, (-1, 1)))
    return np.all(from_tips >= NEAR_TIP, axis=-1)


def of_inside(σ: Iterable[NDArray], X: NDArray, Y: NDArray) -> NDArray[np.float64]:
    """Size of stresses inside: the larger of each point's largest component and that far from the edges.

    Far from the edges is further than ``NEAR``; the result has the shape (states, m).

    Args:
        σ: components of the stress, each (states, m).
        X, Y: positions over a, (m,).
    """
    return _at_least_far(largest(σ), np.hypot(from_edge(X), Y) >= NEAR)


def of_interfaces(σ: NDArray) -> NDArray[np.float64]:
    """Size of stresses at interfaces: the largest along each interface of the component or a traction.

    Args:
        σ: σ_YY, σ_XY, σ_XX above and σ_XX below, (4, states, interfaces, n).

    Returns:
        Sizes in the unit of the stresses, (4, states, interfaces, 1).
    """
    size = np.abs(σ).max(axis=3, keepdims=True)
    tractions = np.maximum(size[0], size[1])
    return np.maximum(size, tractions)


def largest(components: Iterable[NDArray]) -> NDArray[np.float64]:
    """Largest absolute value, element by element, of arrays of equal shape."""
    return reduce(np.maximum, map(np.abs, components))


def of_factor(f: NDArray) -> NDArray[np.float64]:
    """Size of a smooth factor: the larger of each value and a tenth of a state's largest, (states, n)."""
    return np.maximum(np.abs(f), _VANISHING * np.abs(f).max(axis=1, keepdims=True))


def _at_least_far(size: NDArray, far: NDArray) -> NDArray[np.float64]:
    return np.maximum(size, np.where(far, size, 0.0).max(axis=1, keepdims=True, initial=0.0))
