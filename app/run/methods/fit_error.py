"""How far punches are off that other speeds tell of: by their discretisation, and by the fit."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.run.methods.gauge import Gauge


def largest_changes(gauges: Sequence[Gauge], others: Sequence[Gauge]) -> dict[str, float]:
    """Largest relative difference of two lists of gauges, by word of output.quantities."""
    return {one.word: float(one.change(other).max()) for one, other in zip(gauges, others)}


class Estimates:
    """Estimated errors of the discretisation at some speeds and frictions.

    Args:
        g: the frictions, rising, (frictions,).

    Attributes:
        numbers: of the speeds.
    """

    def __init__(self, g: NDArray) -> None:
        self._g, self.numbers = g, list[int]()
        self._z: list[float] = []
        self._errors: dict[str, list[NDArray]] = {}

    def add(self, number: int, z: float, errors: dict[str, NDArray]) -> None:
        """Those at a speed: its number, its place in the variable of the fit.

        Args:
            number, z: the speed.
            errors: by word, (n frictions,), those of some loads one after the other.
        """
        self.numbers.append(number)
        self._z.append(z)
        for word, values in errors.items():
            of_loads = values.reshape(-1, len(self._g)).max(axis=0)
            self._errors.setdefault(word, []).append(of_loads)

    def least(self, word: str) -> float:
        """The smallest of all."""
        return float(np.min(self._errors[word]))

    def covers(self, z: float) -> bool:
        """Were errors measured there, or on both sides of it?"""
        return min(self._z) <= z <= max(self._z)

    def beyond(self, tolerance: float) -> bool:
        """Are all of a word beyond it? Then no speed can be told to the tolerance."""
        return any(self.least(word) > tolerance for word in self._errors)

    def around(self, z: float, g: NDArray) -> dict[str, NDArray[np.float64]]:
        """The largest of those around a speed and frictions, (len(g),), by word.

        Of the solved speeds on both sides, and of the frictions: an error that falls from one to the
        other is not told smaller than it may be.
        """
        order = np.argsort(self._z, kind="stable")
        places = np.array(self._z)[order]
        beside = order[_around(places, np.array([z]))[0]]
        frictions = _around(self._g, g)
        return {
            word: np.array(errors)[beside][:, frictions].max(axis=(0, 2))
            for word, errors in self._errors.items()
        }


def _around(places: NDArray, x: NDArray) -> NDArray[np.int64]:
    """Numbers of the places on both sides of each x, twice the same where it is one, (len(x), 2)."""
    last = len(places) - 1
    right = np.clip(np.searchsorted(places, x), 0, last)
    left = np.where(places[right] > x, right - 1, right)
    return np.column_stack([np.clip(left, 0, last), right])


class FitError:
    """Errors at a speed that others tell of, as of :class:`.error.MeasuredError`.

    Args:
        estimates: of the discretisation.
        z: the speed in the variable of the fit.
        fit: error of the fit, by word of output.quantities; none where the speed was solved.
    """

    def __init__(self, estimates: Estimates, z: float, fit: dict[str, float]) -> None:
        self._estimates, self._z, self._fit = estimates, z, fit

    def of(self, g: NDArray, load: Any = None, last: Any = None) -> dict[str, NDArray[np.float64]]:
        """Estimated relative errors, (states,), by the word of output.quantities that asks for them."""
        around = self._estimates.around(self._z, g)
        return {word: values + self._fit.get(word, 0.0) for word, values in around.items()}

    def record(self) -> dict[str, Any]:
        """None: what was measured is in the records of the speeds that were solved."""
        return {}
