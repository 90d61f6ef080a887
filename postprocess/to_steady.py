"""How far a start from rest is from steady motion, and when it is near."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.quantities import over_time as rows
from galinx.postprocess.quantities import to_steady as of
from galinx.postprocess.quantities.to_steady import SHARES

#: How much the distance times the time may change over the second half of a motion that comes to steady
#: motion like 1/t.
_ALIKE = 0.1


def from_steady(data: Mapping[str, Any], method: str) -> NDArray[np.float64]:
    """Largest difference of K_I over that of steady motion, and of the centre over a, (starts, times).

    Args:
        data: datasets of starts from rest by path.
        method: of solution.
    """
    K, centre = data[rows.STEADY_K_I.path][:, None], data[rows.STEADY_CENTRE.path][:, None]
    of_K = [np.abs(data[row[method].path] / K - 1.0) for row in (rows.K_I_LEFT, rows.K_I_RIGHT)]
    return np.asarray(np.max([*of_K, np.abs(data[rows.CENTRE[method].path] - centre)], axis=0))


def within(t: NDArray, load: NDArray, off: NDArray) -> NDArray[np.float64]:
    """Times from which on starts are within ``SHARES`` of steady motion, (starts, shares).

    Where that is later than the last time what is left is taken to fall like 1/t from there on, t from
    when the load was half, if it does so to a tenth in the second half of that time; else it is NaN:
    too little of the motion is known.

    Args:
        t: times over a/c_s, (times,).
        load: over N, (times,).
        off: how far they are, (starts, times).
    """
    lacks, steps = np.concatenate([[1.0], 1.0 - load]), np.diff(t, prepend=0.0)
    begun = float(steps @ (lacks[1:] + lacks[:-1])) / 2.0
    found = np.empty((len(off), len(SHARES)))
    tail, since = t >= (begun + t[-1]) / 2.0, t - begun
    for i, one in enumerate(off):
        left = since[tail] * one[tail]
        like = np.isfinite(left).all() and np.ptp(left) <= _ALIKE * left[-1]
        for n, share in enumerate(SHARES):
            far = np.flatnonzero(one > share)
            last = int(far[-1]) if len(far) else -1
            if last == len(t) - 1:
                found[i, n] = begun + left[-1] / share if like else np.nan
            elif last < 0:
                found[i, n] = t[0]
            else:
                a, b = one[last], one[last + 1]
                found[i, n] = t[last] + (t[last + 1] - t[last]) * (a - share) / (a - b)
    return found


def told(data: Mapping[str, Any], method: str) -> dict[str, NDArray[np.float64]]:
    """Datasets of a method by path: how far at the end, and when near."""
    off = from_steady(data, method)
    off = np.where(np.isnan(off), np.inf, off)  # where K_I cannot be told, nothing is known to be near
    times, load = data[rows.TIMES.path], data[rows.LOAD.path]
    found = {of.OFF[method].path: off[:, -1], of.WITHIN[method].path: within(times, load, off)}
    return {path: np.where(np.isfinite(values), values, np.nan) for path, values in found.items()}
