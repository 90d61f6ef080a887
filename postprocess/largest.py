"""The largest contact pressure, and where it is."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

#: Positions at which it is looked for, rounds nearer to it, by how much nearer in each, and how near.
_LOOKED_AT = np.sin(np.linspace(-np.pi / 2.0, np.pi / 2.0, 201))[1:-1]
_ROUNDS, _NEARER, _NEAREST = 6, 8.0, 1e-4
#: Most tops that are looked at more nearly, and three places around each.
_TOPS, _THREE = 3, np.array([-1.0, 0.0, 1.0])


def largest(
    pressure: Callable[[NDArray], NDArray], of_state: Callable[[int, NDArray], NDArray]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Largest value and its place over a, (states,) each, of a pressure that is smooth.

    Args:
        pressure: of all states at positions (n,), (states, n).
        of_state: of one, by its number.
    """
    p = pressure(_LOOKED_AT)
    inner = p[:, 1:-1]
    top = (inner >= p[:, :-2]) & (inner >= p[:, 2:])
    best = 1 + np.argsort(np.where(top, -inner, np.inf), axis=1, kind="stable")[:, :_TOPS]
    values, places = zip(*(_nearer(of_state, i) for i in best.T))
    first, rows = np.argmax(values, axis=0), np.arange(len(p))
    return np.array(values)[first, rows], np.array(places)[first, rows]


def _nearer(
    of_state: Callable[[int, NDArray], NDArray], i: NDArray
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Largest value and its place between the neighbours of a position of each state, (states,) each."""
    places = _LOOKED_AT[i[:, None] + [-1, 0, 1]]
    for _ in range(_ROUNDS):
        three = np.stack([of_state(k, x) for k, x in enumerate(places)])
        half = (places[:, 2] - places[:, 0]) / 2.0
        divided = (three[:, 1:] - three[:, :-1]) / np.diff(places)
        bend = (divided[:, 1] - divided[:, 0]) / (places[:, 2] - places[:, 0])
        with np.errstate(divide="ignore", invalid="ignore"):
            top = (places[:, 0] + places[:, 1]) / 2.0 - divided[:, 0] / (2.0 * bend)
        round_ = (bend < 0.0) & (top > places[:, 0]) & (top < places[:, 2])
        top = np.where(round_, top, places[np.arange(len(i)), three.argmax(axis=1)])
        to_left, to_middle = top - places[:, 0], top - places[:, 1]
        value = three[:, 0] + divided[:, 0] * to_left + bend * to_left * to_middle
        half = np.maximum(half / _NEARER, _NEAREST)
        places = np.clip(top, -1.0 + 2.0 * half, 1.0 - 2.0 * half)[:, None] + half[:, None] * _THREE
    return value, top
