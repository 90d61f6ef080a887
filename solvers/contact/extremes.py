"""Largest values of functions and of sampled curves that are smooth in pieces.

A curve is sampled at places that lie close together next to its turns, as free ends and kinks, where it
changes with a power or the logarithm of the distance. Between the neighbours of each of its highest
samples the polynomial through a few more gives the largest value. At a turn itself, which no polynomial
follows, the limit of the curve is a candidate of its own.
"""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.polynomial.polynomial import polyder, polyval, polyvander
from numpy.typing import NDArray

#: Places at which a function is evaluated about a top; samples of a curve that a polynomial goes through;
#: places at which the polynomial is compared first; most tops of a curve that are refined.
NODES, _THROUGH, _COMPARED, _TOPS = np.cos(np.pi * (np.arange(12) + 0.5) / 12.0), 8, 65, 3
#: Samples that a polynomial goes through along an interface, where they are an eighth of its depth apart,
#: and in log(d/d') of two turns, where they are a quarter apart; fewer, which show the error of these.
ALONG, FEWER = 14, 12
#: log(d/d') between two turns at the distances d and d', at which a curve between them is known.
GRADED, FINER = np.linspace(-14.0, 14.0, 113), np.linspace(-18.0, 18.0, 109)
#: Distance of a sample of a curve from the one on its left, over that from the one on its right, below
#: which it is left out.
_COINCIDE = 0.1
#: Distance of two places over the size of any below which no polynomial is taken between them: its nodes
#: would coincide by rounding.
_CLOSEST = 1e4 * np.finfo(float).eps
#: Relative difference of heights, and distance over a of places, up to which they are the same.
_SAME_HEIGHT, _SAME_TOP = 1e-10, 0.05
#: Samples that may be next to the largest value lie below the highest by at most so many times what fewer
#: samples are off, and twice what the largest is above.
_NEARLY = 100.0


def summit(u: NDArray, values: NDArray, low: NDArray, high: NDArray) -> tuple[NDArray, NDArray]:
    """Largest values of polynomials between ``low`` and ``high``, and their places, (m,) each.

    Args:
        u, values: places, and values there, through which the polynomials go, (m, n).
        low, high: bounds, (m,).
    """
    middle, half = (low + high) / 2.0, (high - low) / 2.0
    powers = polyvander((u - middle[:, None]) / half[:, None], u.shape[1] - 1)
    c = np.linalg.solve(powers, values[..., None])[..., 0].T
    grid = np.linspace(-1.0, 1.0, _COMPARED)
    t = grid[polyval(grid, c).argmax(axis=1)]
    first, second = polyder(c), polyder(c, 2)
    for _ in range(3):
        slope, bend = (polyval(t, of, tensor=False) for of in (first, second))
        step = np.divide(slope, bend, out=np.zeros_like(t), where=bend < 0.0)
        t = np.clip(t - step, -1.0, 1.0)
    return polyval(t, c, tensor=False), middle + half * t


def between(turns: NDArray, x: NDArray = GRADED) -> NDArray[np.float64]:
    """Places between turns, from x = log(d/d') of their distances from both, (turns - 1, n)."""
    return np.asarray(turns[:-1, None] + np.diff(turns)[:, None] / (1.0 + np.exp(-x)))


def largest(
    function: Callable[[NDArray], NDArray], pieces: Sequence[NDArray], ends: bool = True, refined: int = 5
) -> tuple[float, float]:
    """Largest value of a function of one variable, and its place, of two as large the one on the left.

    Args:
        function: of places, (n,).
        pieces: rising places at which each smooth piece is sampled, close enough for a polynomial
            between the neighbours of any.
        ends: False where the first and the last sample of a piece are next to a turn, and are no top.
        refined: most tops between the neighbours of which a polynomial is taken.
    """
    values = np.split(function(np.concatenate(pieces)), np.cumsum([len(x) for x in pieces])[:-1])
    tops: list[tuple[float, ...]] = []
    for x, y in zip(pieces, values):
        padded = np.pad(y, 1, constant_values=-np.inf if ends else np.inf)
        i = np.flatnonzero((y >= padded[:-2]) & (y >= padded[2:]))
        tops += zip(y[i], x[i], x[np.maximum(i - 1, 0)], x[np.minimum(i + 1, len(x) - 1)])
    best = [max([(value, place) for value, place, *_ in tops], default=(-np.inf, np.nan))]
    for _, _, low, high in sorted(tops, reverse=True)[:refined]:
        if high - low <= _CLOSEST * max(abs(low), abs(high)):
            continue
        u = (low + high) / 2.0 + (high - low) / 2.0 * NODES
        height, place = summit(u[None], function(u)[None], np.array([low]), np.array([high]))
        best.append((height[0], place[0]))
    (value,), (place,) = highest(*np.array(best).T[:, None])
    return float(value), float(place)


def tops(
    u: NDArray, curves: NDArray, pieces: Any = 0, through: int = _THROUGH
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Highest tops of curves by their samples, and their places in u, (curves, tops) each.

    Tops that a curve has not are -inf; its first and its last sample are none.

    Args:
        u: rising coordinate in which the curves are smooth, (n,).
        curves: their values, -inf where they do not count, (curves, n).
        pieces: rising number of the smooth piece of its curve to which a sample belongs, (curves, n); 0
            where all are one.
        through: number of samples that a polynomial goes through.
    """
    finite = np.isfinite(curves)
    pieces = 2 * np.broadcast_to(pieces, curves.shape) + np.diff(finite, axis=1, prepend=False).cumsum(1)
    rows = np.arange(len(curves))
    padded = np.pad(curves, ((0, 0), (1, 1)), constant_values=np.inf)
    top = finite & (curves >= padded[:, :-2]) & (curves >= padded[:, 2:])
    heights, places = [], []
    for i in np.argsort(np.where(top, -curves, np.inf), axis=1, kind="stable")[:, :_TOPS].T:
        own = pieces == pieces[rows, i][:, None]
        first, count = own.argmax(axis=1), own.sum(axis=1)
        height, place = np.full(len(curves), -np.inf), u[i]
        # Far from the middle of many samples a polynomial would raise their noise.
        shifted = np.abs(np.clip(i - through // 2, first, first + count - through) - i + through // 2)
        many = shifted <= _THROUGH // 2
        for number, chosen in ((through, many), (_THROUGH, ~many)):
            usable = top[rows, i] & (count >= number) & chosen
            if not usable.any():
                continue
            k, start = i[usable], np.clip(i - number // 2, first, first + count - number)[usable]
            window = start[:, None] + np.arange(number)
            nodes = u[window]
            low, high = (
                np.clip(u[np.clip(k + s, 0, len(u) - 1)], nodes[:, 0], nodes[:, -1]) for s in (-1, 1)
            )
            height[usable], place[usable] = summit(
                nodes, curves[usable][np.arange(len(k))[:, None], window], low, high
            )
        heights.append(height)
        places.append(place)
    return np.column_stack(heights), np.column_stack(places)


def highest(heights: NDArray, places: NDArray) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Highest of several tops and its place, of those as high the one on the left, (curves,) each.

    Args:
        heights, places: (curves, tops); -inf, and any place, for none.
    """
    top = heights.max(axis=1, keepdims=True)
    as_high = heights >= top - _SAME_HEIGHT * np.abs(top)
    left = np.where(as_high, places, np.inf).min(axis=1, keepdims=True)
    best = np.where(places <= left + _SAME_TOP, heights, -np.inf).argmax(axis=1)[:, None]
    height, place = (np.take_along_axis(of, best, 1)[:, 0] for of in (heights, places))
    return height, place


def extreme(
    values: NDArray, X: NDArray, sign: float, through: int = ALONG
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Largest (sign 1) or smallest (-1) value of smooth curves along X, and its place, (...) each.

    Args:
        values: (..., n).
        X: rising positions, (n,).
        through: number of samples that a polynomial goes through.
    """
    curves, apart = sign * values.reshape(-1, len(X)), _apart(X)
    heights, places = tops(X[apart], curves[:, apart], through=through)
    heights = np.column_stack([curves.max(axis=1), heights])
    places = np.column_stack([X[curves.argmax(axis=1)], places])
    height, place = (of.reshape(values.shape[:-1]) for of in highest(heights, places))
    return sign * height, place


def _apart(X: NDArray) -> NDArray[np.bool_]:
    """True at rising positions but one of any that all but coincide: no polynomial goes through both."""
    apart = np.append(True, np.diff(X) > _CLOSEST * np.abs(X).max())
    gaps = np.diff(X[apart])
    apart[apart] = np.concatenate([[True], gaps[:-1] >= _COINCIDE * gaps[1:], [True]])
    return apart


def settled(
    function: Callable[[NDArray], NDArray], X: NDArray, values: NDArray, ends: NDArray, accuracy: float
) -> NDArray[np.float64]:
    """Largest and smallest values of curves, where samples do not settle them by the function itself.

    Args:
        function: of positions, (n,): (curves, n).
        X, values: rising positions, and its values there, (n,) and (curves, n).
        ends: largest and smallest value, each with its place, by samples, and by fewer of them,
            (2, 2, 2, curves): largest or smallest, value or place, by more or fewer; or the largest
            alone, (1, 2, 2, curves).
        accuracy: difference by fewer samples, over the largest of all, up to which these settle it.

    Returns:
        The values, each with its place, (2, 2, curves) or (1, 2, curves).
    """
    apart = _apart(X)
    X, values = X[apart], values[:, apart]
    best, off = ends[:, :, 0].copy(), np.abs(ends[:, 0, 0] - ends[:, 0, 1])
    windows: list[tuple[int, int, float, float]] = []
    for end, curve in np.argwhere(off > accuracy * np.abs(values).max(axis=1)).tolist():
        y = np.pad((1 - 2 * end) * values[curve], 1, constant_values=-np.inf)
        above = (1 - 2 * end) * best[end, 0, curve] - y.max()
        high = y[1:-1] >= y.max() - 2.0 * above - _NEARLY * off[end, curve]
        for i in np.flatnonzero(high & (y[1:-1] >= y[:-2]) & (y[1:-1] >= y[2:])).tolist():
            windows.append((end, curve, X[max(i - 1, 0)], X[min(i + 1, len(X) - 1)]))
    if not windows:
        return best
    end, curve, low, high = map(np.array, zip(*windows))
    u = ((low + high) / 2.0)[:, None] + ((high - low) / 2.0)[:, None] * NODES
    of_windows = function(u.ravel()).reshape(len(values), *u.shape)[curve, np.arange(len(u))]
    heights, places = summit(u, (1 - 2 * end)[:, None] * of_windows, low, high)
    for key in {*zip(end.tolist(), curve.tolist())}:
        own = (end == key[0]) & (curve == key[1])
        top = np.where(own, heights, -np.inf).argmax()
        best[key[0], :, key[1]] = (1 - 2 * key[0]) * heights[top], places[top]
    return best
