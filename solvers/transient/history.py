"""History of a punch: its load, its direction, and the friction under it over time.

Times are over a/c_s, loads over N.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

#: Function of time: values at times of any shape.
History = Callable[[Any], Any]

#: Difference of times, relative to 1 + t, below which they are one.
_SAME = 1e-9


def smooth(t: ArrayLike, length: float) -> NDArray[np.float64]:
    """Share of the load at times t: 10s³ - 15s⁴ + 6s⁵, s = t/length, up to 1."""
    s = np.clip(np.asarray(t, dtype=float) / length, 0.0, 1.0)
    return s**3 * (10.0 - 15.0 * s + 6.0 * s * s)


@dataclass(frozen=True)
class Load:
    """The load over time, smooth from each point to the next.

    Attributes:
        points: times and loads, from t = 0 on.
    """

    points: tuple[tuple[float, float], ...]

    def __call__(self, t: ArrayLike) -> NDArray[np.float64]:
        """Load at times t, in the shape of t."""
        t = np.asarray(t, dtype=float)
        share = np.full(t.shape, self.points[0][1])
        for (before, low), (after, high) in pairwise(self.points):
            share = share + (high - low) * smooth(t - before, after - before)
        return share

    @property
    def shortest(self) -> float:
        """Shortest time from a point to the next, infinite where the load is constant."""
        return min((after[0] - before[0] for before, after in pairwise(self.points)), default=np.inf)


@dataclass(frozen=True)
class Drive:
    """Direction of a punch, and σ_XY/σ_YY under it over time.

    Attributes:
        way: ±1, direction of the first stroke along X.
        constant: σ_XY/σ_YY where it is constant, None where it changes.
        starts: times at which strokes begin.
        along: σ_XY/σ_YY of each stroke where it changes, SciPy's polynomial by pieces of the time since
            its beginning.
    """

    way: int
    constant: float | None = None
    starts: tuple[float, ...] = ()
    along: tuple[Any, ...] = ()

    def __call__(self, t: ArrayLike) -> NDArray[np.float64]:
        """σ_XY/σ_YY at times t, in the shape of t; where a stroke ends, that at its end."""
        t = np.asarray(t, dtype=float)
        if self.constant is not None:
            return np.full(t.shape, self.constant)
        stroke, g = np.searchsorted(self.starts, t - _SAME * (1.0 + t)) - 1, np.empty(t.shape)
        for n, along in enumerate(self.along):
            now = np.maximum(stroke, 0) == n
            g[now] = along(t[now] - self.starts[n])
        return g

    @cached_property
    def shortest(self) -> float:
        """Inverse of the largest rate of σ_XY/σ_YY, a time; infinite where it is constant."""
        fastest = max((float(np.abs(g(g.x, 1)).max()) for g in self.along), default=0.0)
        return 1.0 / fastest if fastest else np.inf


@dataclass(frozen=True)
class Way:
    """Equal steps in one direction.

    Attributes:
        direction: ±1.
        duration: of all.
        steps: number of steps.
    """

    direction: int
    duration: float
    steps: int

    @property
    def h(self) -> float:
        """Length of a step."""
        return self.duration / self.steps
