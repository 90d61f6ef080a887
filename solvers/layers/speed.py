"""The highest speed over layers, and how fast waves along them run.

Below it the stiffness against every wave, on the surface and inside, is positive; it falls with speed, so
that the speed at which the smallest of all vanishes is found by bracketing.
"""

from collections.abc import Callable
from functools import partial

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.errors import SolveError
from galinx.solvers.layers.stack import Stack

#: Wavenumbers an octave at which stiffness is looked at, and over which range: kH of the whole, of the
#: thinnest layer.
_DENSITY, _LONGEST, _SHORTEST = 6, 1e-3, 30.0
#: Times that the neighbourhood of the smallest one is looked at again, and wavenumbers there.
_CLOSER, _THERE = 4, 9
#: Steps at most; those below waves inside grow so much, from the second on.
_STEPS, _STRIDE, _FIRST_STEP = 90, 2.0, 1e-4


def weakest(stack: Stack) -> tuple[float, float]:
    """Smallest stiffness against any wave, and its wavenumber times a."""
    H = [layer.H for layer in stack.layers]
    k = wavenumbers(sum(H), min(H))
    for _ in range(_CLOSER):
        values = stack.stands(k)
        i = int(np.argmin(values))
        lowest, at = float(values[i]), float(k[i])
        if not lowest > 0.0 or i in (0, len(k) - 1):
            break
        if lowest > np.ptp(values[i - 1 : i + 2]):  # between these a smooth one stays positive
            break
        k = np.geomspace(k[i - 1], k[i + 1], _THERE)
    return lowest, at


def wavenumbers(whole: float, thinnest: float) -> NDArray[np.float64]:
    """From waves much longer than all layers to some much shorter than the thinnest."""
    first, last = _LONGEST / whole, _SHORTEST / thinnest
    return np.geomspace(first, last, int(_DENSITY * np.log2(last / first)) + 1)


def highest(stack: Callable[[float], Stack], most: float, accuracy: float) -> float:
    """Highest speed at which nothing gives way.

    Where something does, one wave says how much slower it has to be; that is asked again for the wave
    that is weakest there.

    Args:
        stack: of a speed; raises ValueError where some wave inside is not faster.
        most: a speed that is no lower.
        accuracy: relative.

    Raises:
        SolveError: nothing was found.
    """
    speed, step = most, accuracy
    for _ in range(_STEPS):
        try:
            value, k = weakest(stack(speed))
        except (ValueError, SolveError):
            # Beyond waves inside, or too near to them to be followed.
            value, k = -np.inf, np.nan
        if value > 0.0:
            return speed
        if np.isfinite(value):
            speed = (1.0 - accuracy) * _where_it_falls(stack, k, speed, accuracy)
        else:
            speed, step = speed * (1.0 - step), max(_STRIDE * step, _FIRST_STEP)
        if not 0.0 < step < 1.0:
            break
    raise SolveError("no speed was found at which the layers stand; are their constants as meant?")


def _where_it_falls(stack: Callable[[float], Stack], k: float, high: float, accuracy: float) -> float:
    """Speed at which one wave's stiffness vanishes, below one at which it is negative."""

    def stands(speed: float) -> float:
        try:
            return float(stack(speed).stands(np.array([k]))[0])
        except (ValueError, SolveError):
            return -np.inf

    low, f_low, f_high, side = 0.0, stands(0.0), stands(high), 0
    for _ in range(_STEPS):
        if high - low <= accuracy * high:
            break
        middle = (low + high) / 2.0
        if np.isfinite(f_high) and f_high < 0.0:  # Illinois
            guess = (low * f_high - high * f_low) / (f_high - f_low)
            middle = guess if low < guess < high else middle
        value = stands(middle)
        if value > 0.0:
            low, f_low = middle, value
            f_high = f_high / 2.0 if side == 1 else f_high
            side = 1
        else:
            high, f_high = middle, value
            f_low = f_low / 2.0 if side == -1 else f_low
            side = -1
    return low


#: Speeds over the highest at which each wave's stiffness is looked at first, and steps from there.
_SPEEDS = np.concatenate([[0.0], 1.0 - np.geomspace(1.0, 1e-9, 40)[1:]])
_CLOSE = 60


def dispersion(
    stack: Callable[[float], Stack], most: float, k: NDArray, accuracy: float
) -> NDArray[np.float64]:
    """Speed of the slowest wave with each wavenumber; NaN where it is no slower than waves inside.

    Args:
        stack: of a speed; raises ValueError where some wave inside is not faster.
        most: a speed at which one is not.
        k: wavenumbers times a, (n,).
        accuracy: relative.
    """

    def stands(speed: float, some: NDArray) -> NDArray[np.float64]:
        try:
            return stack(speed).stands(some)
        except (ValueError, SolveError):
            return np.full(len(some), -np.inf)

    slowest_inside = bisected(lambda c: bool(np.isfinite(stands(c, k[:1]))[0]), most)
    speeds = slowest_inside * _SPEEDS
    values = np.array([stands(speed, k) for speed in speeds.tolist()])
    found = np.full(len(k), np.nan)
    for i, column in enumerate(values.T):
        if (column <= 0.0).any():
            j = int(np.argmax(column <= 0.0))
            holds = partial(_one_stands, stands, k[i : i + 1])
            found[i] = bisected(holds, speeds[j], speeds[j - 1], accuracy)
    return found


def _one_stands(stands: Callable[[float, NDArray], NDArray], k: NDArray, speed: float) -> bool:
    return bool(stands(speed, k)[0] > 0.0)


def bisected(
    holds: Callable[[float], bool], high: float, low: float = 0.0, accuracy: float = 1e-13
) -> float:
    """Highest number at which something holds that holds up to it."""
    if holds(high):
        return high
    for _ in range(_CLOSE):
        if high - low <= accuracy * high:
            break
        middle = (low + high) / 2.0
        low, high = (middle, high) if holds(middle) else (low, middle)
    return low
