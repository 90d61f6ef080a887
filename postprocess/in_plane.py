"""The highest and the lowest in-plane stress on the surface, free ends and kinks included.

The curve is known at samples. Between those next to its tops it is a polynomial of the confocal
coordinate, in which it is smooth up to a free end; at the end itself, and at kinks, it is a limit. Places
next to sharp edges and tips, where it is infinite, do not count.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.near_ends import in_plane_at_ends
from galinx.postprocess.scale import NEAR, NEAR_TIP
from galinx.solvers.profiles import jumps, kinks

#: Tops of the samples that are looked at more nearly; samples that a polynomial goes through; places
#: between the neighbours of a top.
_TOPS, _THROUGH, _BETWEEN = 3, 8, 65


def extreme(solution: Any, body: Any, sign: float) -> NDArray[np.float64]:
    """The highest (1) or lowest (-1) in-plane stress of states over N/(2a), (states,).

    Args:
        solution: of one method, see :class:`galinx.solvers.solution.Solution`.
        body: what slides over what.
        sign: which of the two.
    """
    surface = solution.surface
    X, σ_XX = surface.places.X, surface.σ_XX
    at, limits = _limits(solution, body)
    infinite = _infinite(solution, body, len(σ_XX))
    values = np.where(_finite(X, infinite), sign * σ_XX, -np.inf)
    limits = np.where(np.isnan(limits) | ~_finite(at, infinite), -np.inf, sign * limits)
    pieces = (X[:, None] > np.nan_to_num(at, nan=np.inf)[:, None, :]).sum(axis=-1)
    best = np.maximum(values.max(axis=1), limits.max(axis=1, initial=-np.inf))
    u = np.where(np.abs(X) > 1.0, np.sign(X) * np.arccosh(np.maximum(np.abs(X), 1.0)), 0.0)
    u = u + np.arcsin(np.clip(X, -1.0, 1.0))
    between = surface.turns and surface.turns.between
    if not between:
        return sign * np.maximum(best, _largest(u, values, pieces))
    best = np.maximum(best, _largest(u, np.where(np.abs(X) < 1.0, -np.inf, values), pieces))
    for i, X in enumerate(between.X):
        values = np.where(_finite(X, infinite), sign * between.σ_XX[:, i], -np.inf)
        best = np.maximum(best, _largest(between.x, values, np.zeros(values.shape)))
    return sign * best


def _finite(X: NDArray, infinite: list[tuple[NDArray, float]]) -> NDArray[np.bool_]:
    """Which positions, (n,) or (states, n), are off all places of :func:`_infinite`, (states, n)."""
    each = [~(np.abs(X - place[:, None]) <= reach) for place, reach in infinite]
    return np.logical_and.reduce(each)


def _limits(solution: Any, body: Any) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Both ends and kinks, where the curve may turn, and its limits there or NaN, (states, k) each."""
    surface, ends = solution.surface, np.tile([-1.0, 1.0], (len(solution.g), 1))
    if surface.turns is not None:
        at = np.concatenate([ends, surface.turns.X], axis=1)
        return at, np.concatenate([np.full_like(ends, np.nan), surface.turns.σ[0]], axis=1)
    exponents = np.column_stack([solution.local.β, solution.local.α])
    return ends, in_plane_at_ends(surface.places.X, surface.σ_XX, exponents)


def _infinite(solution: Any, body: Any, states: int) -> list[tuple[NDArray[np.float64], float]]:
    """Where stresses are infinite, NaN for nowhere, (states,) each; and within which distance of it."""
    if body.pressure:
        sharp = np.tile(body.pressure.values[[0, -1]] != 0.0, (states, 1))
    else:
        sharp = np.column_stack([solution.local.β, solution.local.α]) < 0.0
    found = [(np.where(sharp[:, i], side, np.nan), NEAR) for i, side in enumerate((-1.0, 1.0))]
    if body.found and jumps(body.profile):
        for kink in kinks(body.profile):
            found.append(((kink - solution.centre) / solution.half_width, NEAR_TIP))
    return found


def _largest(u: NDArray, values: NDArray, pieces: NDArray) -> NDArray[np.float64]:
    """Largest of curves, by polynomials through the samples around their highest tops, (states,).

    Args:
        u: coordinate in which they are smooth, growing, (n,).
        values: there, -inf where the curve is not told, (states, n).
        pieces: which smooth piece of the curve a sample belongs to, (states, n).
    """
    rows, best = np.arange(len(values))[:, None], values.max(axis=1)
    inner = values[:, 1:-1]
    top = (inner >= values[:, :-2]) & (inner >= values[:, 2:]) & np.isfinite(inner)
    order = np.argsort(np.where(top, -inner, np.inf), axis=1, kind="stable")[:, :_TOPS]
    for column in order.T:
        i = column + 1
        window = np.clip(i - _THROUGH // 2, 0, len(u) - _THROUGH)[:, None] + np.arange(_THROUGH)
        # A window that reaches into the next piece is moved back.
        other = pieces[rows, window] != pieces[rows, i[:, None]]
        shift = (other & (window < i[:, None])).sum(axis=1) - (other & (window > i[:, None])).sum(axis=1)
        window = np.clip(window + shift[:, None], 0, len(u) - 1)
        same = (pieces[rows, window] == pieces[rows, i[:, None]]).all(axis=1)
        usable = same & np.isfinite(values[rows, window]).all(axis=1) & (np.diff(window) == 1).all(axis=1)
        usable &= top[rows[:, 0], column]
        if usable.any():
            some = usable.nonzero()[0]
            found = _between(u, values[some[:, None], window[some]], window[some], i[some])
            best[some] = np.maximum(best[some], found)
    return best


def _between(u: NDArray, values: NDArray, window: NDArray, i: NDArray) -> NDArray[np.float64]:
    """Largest value of polynomials between the neighbours of the samples ``i``, (m,)."""
    nodes = u[window]
    low, high = (np.clip(u[np.clip(i + k, 0, len(u) - 1)], nodes[:, 0], nodes[:, -1]) for k in (-1, 1))
    at = low[:, None] + (high - low)[:, None] * np.linspace(0.0, 1.0, _BETWEEN)
    curve = np.zeros_like(at)
    for k in range(nodes.shape[1]):
        others = np.delete(nodes, k, axis=1)
        factors = (at[:, :, None] - others[:, None]) / (nodes[:, k, None, None] - others[:, None])
        curve += values[:, k, None] * factors.prod(axis=-1)
    k = np.clip(curve.argmax(axis=1), 1, _BETWEEN - 2)[:, None]
    left, middle, right = (np.take_along_axis(curve, k + step, 1)[:, 0] for step in (-1, 0, 1))
    bend = left - 2.0 * middle + right
    with np.errstate(divide="ignore", invalid="ignore"):
        vertex = middle - (right - left) ** 2 / (8.0 * bend)
    inside = (bend < 0.0) & (np.abs(right - left) <= -2.0 * bend)
    return np.where(inside, vertex, curve.max(axis=1))
