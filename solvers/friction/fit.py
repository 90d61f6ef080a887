"""A law's parameters from measured friction: least squares with bounds."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..parameters import Parameter, Range, build_model, fields, parameters
from .integrate import exactly
from .law import FrictionLaw, MeasuredFriction

#: Starts of the search, the first from the guess, and how far the others lie from it, as a factor.
_STARTS, _AWAY = 6, 3.0
#: Relative difference of sums of squares below which two starts led to one law: the search ends.
_AGAIN = 1e-6
#: Residual where a law rejects its parameters.
_REJECTED = 1e3
#: Relative difference of speeds below which they count as one.
_SAME = 1e-6
#: Distance from the bounds of an open range that a fit keeps.
_INSIDE = 1e-6


@dataclass(frozen=True)
class Move:
    """Samples in one direction and, where a law depends on it, at one speed.

    Attributes:
        s: direction, ±1.
        V: speed [m/s].
        rest: time at rest before it [s].
        slip: slip since the move began, (n,) [m].
        samples: numbers of the samples, (n,).
    """

    s: int
    V: float
    rest: float
    slip: NDArray[np.float64]
    samples: NDArray[np.int64]


@dataclass(frozen=True)
class FittedLaw:
    """Fitted law, with the covariance of its parameters.

    Attributes:
        law: the law.
        values: its parameters by key.
        names: names of the fitted numbers, as ``"mu_c"`` and ``"elements[2, 1]"``, (m,).
        best: fitted numbers, (m,).
        covariance: covariance of the fitted numbers, (m, m); NaN where the data do not determine them.
        f: friction of the law at the samples, NaN before the first motion, (samples,).
    """

    law: FrictionLaw
    values: dict[str, Any]
    names: tuple[str, ...]
    best: NDArray[np.float64]
    covariance: NDArray[np.float64]
    f: NDArray[np.float64]

    @property
    def deviations(self) -> NDArray[np.float64]:
        """Standard deviations of the fitted numbers, (m,)."""
        return np.sqrt(np.diag(self.covariance))


def moves(t: NDArray, X: NDArray, by_speed: bool) -> list[Move]:
    """Moves of a measured motion, from rest at the first sample.

    Args:
        t, X: time [s] and position [m] of the samples.
        by_speed: True if the law depends on the speed: a change of speed begins a new move.
    """
    steps, seconds = np.diff(X), np.diff(t)
    pieces: list[tuple[int, float, float, list[float], list[int]]] = []
    rest = 0.0
    for n, (step, time) in enumerate(zip(steps.tolist(), seconds.tolist()), 1):
        if step == 0.0:
            rest += time
            continue
        s, V = (1 if step > 0.0 else -1), abs(step) / time
        last = pieces[-1] if pieces and rest == 0.0 else None
        if last and last[0] == s and (not by_speed or abs(V / last[1] - 1.0) < _SAME):
            last[3].append(last[3][-1] + abs(step))
            last[4].append(n)
        else:
            pieces.append((s, V, rest, [abs(step)], [n]))
            rest = 0.0
    return [Move(s, V, at, np.array(slip), np.array(rows)) for s, V, at, slip, rows in pieces]


def friction(law: FrictionLaw, motion: Sequence[Move], samples: int) -> NDArray[np.float64]:
    """Friction coefficient of a law at the samples of a motion, NaN before the first move, (samples,)."""
    f, z = np.full(samples, np.nan), law.rest()
    for move in motion:
        z = law.pause(z, move.rest)
        states = exactly(law, z, move.s, move.V, float(move.slip[-1]), move.slip)
        f[move.samples] = law.friction(states, move.s, move.V)
        z = states[-1]
    return f


def measured_friction(motion: Sequence[Move], f: NDArray, rows: int) -> MeasuredFriction:
    """Summary of measured friction f, (samples,), for a guess of parameters with tables of ``rows``."""
    sliding = np.abs(np.concatenate([f[move.samples] for move in motion]))
    first = motion[0]
    longest = max(move.slip[-1] for move in motion)
    near = first.slip <= 0.1 * first.slip[-1]
    near[: min(2, len(near))] = True
    slope = float(
        np.sum(np.abs(f[first.samples[near]]) * first.slip[near]) / np.sum(first.slip[near] ** 2)
    )
    level = float(np.quantile(sliding, 0.95)) or 1.0
    speed = float(np.exp(np.mean(np.log([max(move.V, 1e-12) for move in motion]))))
    least = float(np.quantile(sliding, 0.3)) or level
    return MeasuredFriction(level, least, slope or level / longest, float(longest), speed, rows)


def fit(
    kind: type[FrictionLaw],
    motion: Sequence[Move],
    f: NDArray,
    fixed: dict[str, Any],
    start: dict[str, Any],
    rows: int = 3,
) -> FittedLaw:
    """Law nearest to measured friction, by least squares over its parameters.

    Args:
        kind: class of the law.
        motion: measured motion.
        f: friction coefficient at the samples, (samples,).
        fixed: values by key of parameters that are not fitted.
        start: values by key of other parameters with which the search begins.
        rows: number of rows of tables that are fitted.

    Raises:
        ValueError: a parameter has no start, there are fewer samples than numbers, or no start leads
            anywhere.
    """
    search = _Search(kind, measured_friction(motion, f, rows), fixed, start)
    used = np.concatenate([move.samples for move in motion])
    if len(used) <= len(search.names):
        raise ValueError(
            f"found {len(used)} samples in motion for {len(search.names)} parameters, expected more"
        )

    def residuals(θ: NDArray) -> NDArray:
        try:
            with np.errstate(all="ignore"):
                difference = friction(search.law(θ), motion, len(f))[used] - f[used]
        except ValueError:  # rejected by the law
            difference = np.full(len(used), np.inf)
        return np.where(np.isfinite(difference), difference, _REJECTED)

    best = _least(residuals, search)
    if best is None or best.cost >= 0.4 * _REJECTED**2 * len(used):
        raise ValueError("no start of the search leads to a law; fix or start other parameters")
    law, values = search.law(best.x), search.values(best.x)
    stretch = search.stretch(best.x)
    spread = 2.0 * best.cost / (len(used) - len(best.x))
    covariance = spread * _inverse(best.jac) * np.outer(stretch, stretch)
    numbers = search.numbers(best.x)
    return FittedLaw(law, values, search.names, numbers, covariance, friction(law, motion, len(f)))


def _least(residuals: Callable[[NDArray], NDArray], search: "_Search") -> Any:
    """Best of SciPy's results from several starts; None where no number is fitted."""
    from scipy.optimize import least_squares  # slow to import

    rng, best = np.random.default_rng(0), None
    for n in range(_STARTS if search.names else 0):
        θ = search.begin + (n > 0) * search.reach * rng.uniform(-1.0, 1.0, len(search.begin))
        θ = np.clip(θ, search.low, search.high)
        result = least_squares(
            residuals, θ, bounds=(search.low, search.high), x_scale="jac", xtol=1e-12, ftol=1e-12,
            gtol=1e-12, max_nfev=200,
        )  # fmt: skip
        again = best is not None and abs(result.cost - best.cost) <= _AGAIN * best.cost
        if best is None or result.cost < best.cost:
            best = result
        if again:
            break
    return best


def _inverse(J: NDArray) -> NDArray[np.float64]:
    """Inverse of JᵀJ, (m, m); NaN in rows and columns that J does not determine."""
    size = np.linalg.norm(J, axis=0)
    blind = size == 0.0
    scaled = J / np.where(blind, 1.0, size)
    _, singular, V = np.linalg.svd(scaled, full_matrices=False)
    weak = singular < 1e-10 * singular.max(initial=1e-300)
    inverse = (V.T / np.where(weak, 1.0, singular) ** 2) @ V
    lost = blind | (np.abs(V[weak]) > 1e-6).any(axis=0)
    inverse[lost], inverse[:, lost] = np.nan, np.nan
    return inverse / np.outer(np.where(blind, 1.0, size), np.where(blind, 1.0, size))


class _Search:
    """Fitted numbers of a law as unknowns θ: θ = ln p of a positive number p, else θ = p.

    Attributes:
        names: names of the numbers, (m,).
        begin, low, high: start and bounds of θ, (m,).
        reach: largest distance of other starts from the first, (m,).
    """

    def __init__(
        self,
        kind: type[FrictionLaw],
        look: MeasuredFriction,
        fixed: dict[str, Any],
        start: dict[str, Any],
    ) -> None:
        self._kind = kind
        described, defaults, guess = parameters(kind), fields(kind), kind.guess(look)
        unexpected = [key for key in (*fixed, *start) if key not in described]
        if unexpected:
            raise ValueError(f"found the parameter {unexpected[0]!r}, expected {', '.join(described)}")
        self._values: dict[str, Any] = {}
        self._places: list[tuple[str, int, int]] = []
        ranges: list[Range] = []
        for key, parameter in described.items():
            default = None if parameter.columns else defaults[key].default
            value = {key: default, **guess, **start, **fixed}[key]
            if parameter.optional and value is None:
                continue
            if value is None or not isinstance(value, (int, float, str, tuple)):
                raise ValueError(f"found no start for {key}, expected --start {key}=… or --fix {key}=…")
            self._values[key] = value
            if key in fixed or parameter.options or (key in kind.conventions and key not in start):
                continue
            places = _places(key, parameter, value)
            self._places += places
            positive = Range(above=0.0) if len(parameter.measured) > 1 else Range()
            ranges += [parameter.range if parameter.single else positive] * len(places)
        self.names = tuple(_name(*place) for place in self._places)
        self._logs = np.array([r.above == 0.0 and r.below is None for r in ranges], dtype=bool)
        p = self._numbers()
        if (self._logs & (p <= 0.0)).any():
            name = self.names[int(np.argmax(self._logs & (p <= 0.0)))]
            raise ValueError(f"found a start of {name} that is not above 0")
        self.begin = np.where(self._logs, np.log(np.where(self._logs, p, 1.0)), p)
        self.low, self.high = np.array([_ends(r) for r in ranges]).reshape(-1, 2).T
        self.low[self._logs], self.high[self._logs] = -np.inf, np.inf
        whole = np.isfinite(self.high - self.low)
        width = np.where(whole, np.where(whole, self.high, 0.0) - np.where(whole, self.low, 0.0), 1.0)
        far = np.where(whole, 0.5 * width, np.maximum(np.abs(p), look.level / max(look.speed, 1e-12)))
        dimensionless = np.array([described[place[0]].unit == "" for place in self._places], dtype=bool)
        far = np.where(dimensionless & ~whole, np.maximum(np.abs(p), 1.0), far)
        self.reach = np.where(self._logs, np.log(_AWAY), far)

    def _numbers(self) -> NDArray[np.float64]:
        return np.array([
            self._values[key] if row < 0 else self._values[key][row][column]
            for key, row, column in self._places
        ], dtype=float)  # fmt: skip

    def numbers(self, θ: NDArray) -> NDArray[np.float64]:
        """Fitted numbers p at θ, (m,)."""
        return np.where(self._logs, np.exp(np.where(self._logs, θ, 0.0)), θ)

    def stretch(self, θ: NDArray) -> NDArray[np.float64]:
        """Derivatives dp/dθ, (m,)."""
        return np.where(self._logs, self.numbers(θ), 1.0)

    def values(self, θ: NDArray) -> dict[str, Any]:
        """All parameters by key at θ."""
        values = {
            key: [list(row) for row in value] if isinstance(value, tuple) else value
            for key, value in self._values.items()
        }
        for (key, row, column), number in zip(self._places, self.numbers(θ).tolist()):
            if row < 0:
                values[key] = number
            else:
                values[key][row][column] = number
        return {
            key: tuple(map(tuple, value)) if isinstance(value, list) else value
            for key, value in values.items()
        }

    def law(self, θ: NDArray) -> FrictionLaw:
        """Law at θ.

        Raises:
            ValueError: the law rejects its parameters.
        """
        return build_model(self._kind, self.values(θ))


def _places(key: str, parameter: Parameter, value: Any) -> list[tuple[str, int, int]]:
    """Key, row and column of the numbers of a parameter; row -1 for a single one."""
    if parameter.single:
        return [(key, -1, 0)]
    if not parameter.columns:
        return []
    return [(key, row, column) for row in range(len(value)) for column in parameter.measured]


def _name(key: str, row: int, column: int) -> str:
    return key if row < 0 else f"{key}[{row}, {column}]"


def _ends(bounds: Range) -> tuple[float, float]:
    """Lowest and highest number of a range; a little inside of open bounds."""
    low, high = -np.inf, np.inf
    if bounds.at_least is not None:
        low = bounds.at_least
    if bounds.above is not None:
        low = bounds.above + _INSIDE
    if bounds.at_most is not None:
        high = bounds.at_most
    if bounds.below is not None:
        high = bounds.below - _INSIDE
    return low, high
