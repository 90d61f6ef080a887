"""A law's parameters from measured friction: least squares with bounds."""

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property
from math import inf, isfinite, log
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..parameters import Range, build_model, fields, parameters
from .integrate import exactly
from .law import FrictionLaw, MeasuredFriction

#: Most starts of the search, the first from the guess, and how far the others lie from it, as a factor.
_STARTS, _AWAY = 48, 3.0
#: Moves that laws follow in the search, all starts together, from which on no other start begins.
_SEARCHED = 25_000
#: Samples of all measurements through which starts search, and most that the best of them is fitted to.
_FEW, _MOST = 150, 3000
#: Step over the range of an unknown by which deviations are computed.
_WIDE = 1e-3
#: Tolerance and most steps of the search from a start, and of the fit from the best of them.
_SEARCH, _FIT = (1e-4, 30), (1e-7, 40)
#: Relative difference of sums of squares below which two starts led to one law, and times that starts
#: lead to the best one again until the search ends.
_AGAIN, _ENOUGH = 1e-4, 8
#: Residual where a law rejects its parameters.
_REJECTED = 1e3
#: Distance from the bounds of an open range that a fit keeps.
_INSIDE = 1e-6
#: Factor from its start within which a positive number is sought.
_FARTHEST = 1e5
#: Change of speed over those before and after from which on it is a jump.
_JUMPS = 3.0
#: Speed at a sample over its change since the one before below which neither its sign nor its logarithm
#: are known, as at a smooth turn; and least speed at the end of a move over the mean one.
_TURNS, _SLOWEST = 0.5, 0.1


@dataclass(frozen=True)
class Measured:
    """Friction measured along a motion that begins at rest, (samples,) each.

    Attributes:
        t: time [s], growing.
        X: position [m].
        f: friction coefficient, positive in forward motion.
    """

    t: NDArray[np.float64]
    X: NDArray[np.float64]
    f: NDArray[np.float64]


@dataclass
class Move:
    """Samples in one direction and, where a law depends on it, at one speed.

    Attributes:
        s: direction, ±1.
        V: mean speed [m/s].
        end: speed at its end [m/s].
        rest: time at rest before it [s].
        way: length [m].
        slip: slip since the move began, (n,) [m].
        samples: numbers of the samples, (n,); none where it lies between two.
        turns: those among them that lie at a smooth turn.
        first: True if a measurement begins with it, and the law at rest.
    """

    s: int
    V: float
    end: float
    rest: float
    way: float
    slip: list[float]
    samples: list[int]
    turns: list[int]
    first: bool = False

    @cached_property
    def places(self) -> NDArray[np.float64]:
        """Slips at the samples and at its end, (n + 1,) [m]; of a move that is complete."""
        return np.append(self.slip, self.way)

    @cached_property
    def rows(self) -> NDArray[np.int64]:
        """Numbers of the samples as an array, (n,); of a move that is complete."""
        return np.array(self.samples, dtype=int)


@dataclass(frozen=True, repr=False)
class FittedLaw:
    """Fitted law, with the deviations of its parameters.

    Attributes:
        law: the law.
        parameters: its parameters by key, in SI, those that the data do not determine among them: with
            other values of these the rest would be others, too.
        names: names of the fitted numbers, as ``"mu_c"`` and ``"elements[2, 1]"``, (m,).
        best: fitted numbers, (m,).
        deviations: standard deviations in SI by the names of the fitted numbers; NaN, or larger than the
            number, where the data do not determine it.
        not_determined: names of numbers that the data do not determine.
        f: friction of the law at the samples of each measurement, NaN before the first motion.
        samples: number of samples in motion.
        rms: root mean square of measured less fitted f at these, dimensionless.
        every: step between the samples that it is fitted to, 1 unless there are too many.
    """

    law: FrictionLaw
    parameters: dict[str, Any]
    names: tuple[str, ...]
    best: NDArray[np.float64]
    deviations: dict[str, float]
    not_determined: tuple[str, ...]
    f: list[NDArray[np.float64]]
    samples: int
    rms: float
    every: int

    @property
    def aic(self) -> float:
        """Akaike's criterion, up to a constant of the data: n ln(Σr²/n) + 2 (m + 1); of laws fitted to
        the same data that with a smaller one describes them better.

        (H. Akaike, IEEE Transactions on Automatic Control 19 (1974) 716.) The noise is a parameter, too.
        """
        return 2.0 * self.samples * log(max(self.rms, 1e-300)) + 2.0 * (len(self.names) + 1)


def moves(t: NDArray, X: NDArray, by_speed: bool, before: int = 0) -> list[Move]:
    """Moves of a measured motion, from rest at the first sample.

    Args:
        t, X: time [s] and position [m] of the samples.
        by_speed: True if the law depends on the speed: a change of speed begins a new move.
        before: number of the first sample.
    """
    result: list[Move] = []
    rest = 0.0
    for number, parts in enumerate(_parts(X, t), before + 1):
        for n, (v, end, seconds, change) in enumerate(parts, 1):
            if v == 0.0:
                rest += seconds
                continue
            s, V, way = (1 if v > 0.0 else -1), abs(v), abs(v) * seconds
            last = result[-1] if result and rest == 0.0 else None
            if last and last.s == s and (not by_speed or abs(V / last.V - 1.0) < 1e-6):
                way += last.way
            else:
                last = Move(s, V, max(abs(end), _SLOWEST * V), rest, 0.0, [], [], [], not result)
                result.append(last)
                rest = 0.0
            last.way = way
            if n == len(parts):
                last.slip.append(way)
                last.samples.append(number)
                last.turns += [number] * (abs(end) < _TURNS * abs(change))
    return result


def thinned(motion: Sequence[Move], n: int) -> list[Move]:
    """Moves with every n-th sample, and the last one, of each way in one direction.

    Between these samples the speed is the mean one; at them it is that of the motion.
    """
    result: list[Move] = []
    for move in motion:
        last = result[-1] if result and move.samples and move.rest == 0.0 and not move.first else None
        if last and last.s == move.s and len(last.samples) < n:
            seconds, before = last.way / last.V + move.way / move.V, last.way
            last.way, last.end = before + move.way, move.end
            last.V = last.way / seconds
            last.slip += [before + slip for slip in move.slip]
            last.samples += move.samples
            last.turns += move.turns
        else:
            own = replace(move, slip=[*move.slip], samples=[*move.samples], turns=[*move.turns])
            result.append(own)
    for move in result:
        kept = sorted({*range(n - 1, len(move.samples), n), len(move.samples) - 1} - {-1})
        move.slip = [move.slip[k] for k in kept]
        move.samples = [move.samples[k] for k in kept]
    return result


def _parts(X: NDArray, t: NDArray) -> list[list[tuple[float, float, float, float]]]:
    """Parts of the way to each sample after the first.

    Each has its mean speed and that at its end [m/s], its time [s], and the smooth change of speed along
    the whole way [m/s].

    From sample to sample the speed is linear, with the smaller one of the slopes to the neighbours, and
    none where these have two signs (B. van Leer, J. Comput. Phys. 32 (1979) 101). Where it changes by far
    more than before and after, and than usually, it jumps between two samples, as in strokes at constant
    speeds.
    """
    seconds = np.diff(t)
    v = np.diff(X) / seconds
    change = np.diff(v) / (0.5 * (seconds[1:] + seconds[:-1]))
    left, right = change[:-1], change[1:]
    slope = np.zeros(len(v))
    slope[1:-1] = np.where(left * right > 0.0, np.sign(left) * np.fmin(np.abs(left), np.abs(right)), 0.0)
    usual = 2.0 * float(np.median(np.abs(change))) if len(change) else 0.0
    for at, beside in ((0, 1), (-1, -2)):  # the first and the last one as those beside, without a turn
        most = 2.0 * abs(v[at]) / seconds[at]
        slope[at] = np.clip(slope[beside], -most, most) if len(v) > 2 else 0.0
    parts, v, change, seconds = [], v.tolist(), change.tolist(), seconds.tolist()
    for n, (mean, Δ, bend) in enumerate(zip(v, seconds, slope.tolist())):
        begin, end = mean - 0.5 * bend * Δ, mean + 0.5 * bend * Δ
        smooth = end - begin
        part = [(mean, end, Δ, smooth)]
        if begin * end < 0.0:
            turn = begin / (begin - end)
            part = [(0.5 * begin, 0.0, turn * Δ, smooth), (0.5 * end, end, (1.0 - turn) * Δ, smooth)]
        if 2 <= n < len(v) - 2:
            begin = v[n - 1] + 0.5 * change[n - 2] * seconds[n - 1]
            end = v[n + 1] - 0.5 * change[n + 1] * seconds[n + 1]
            noise = max(abs(change[n - 2]), abs(change[n + 1]), usual) * Δ
            if abs(end - begin) > _JUMPS * noise and min(abs(mean - begin), abs(mean - end)) > noise:
                at = (mean - end) / (begin - end)
                if 1e-3 < at < 1.0 - 1e-3:
                    part = [(begin, begin, at * Δ, 0.0), (end, end, (1.0 - at) * Δ, 0.0)]
        parts.append(part)
    return parts


def friction(
    law: FrictionLaw, motion: Sequence[Move], samples: int, laws: int = 0
) -> NDArray[np.float64]:
    """Friction coefficient of a law at the samples of a motion, NaN before the first move, (samples,).

    Of a law that stands for many, their number ``laws``, (laws, samples).
    """
    f = np.full((laws, samples) if laws else samples, np.nan)
    rest = np.broadcast_to(law.rest(), (laws, 1, law.rest().shape[-1])) if laws else law.rest()
    z = rest
    for move in motion:
        z = law.pause(rest if move.first else z, move.rest)
        states = exactly(law, z, move.s, move.V, move.way, move.places)
        f[..., move.rows] = law.friction(states, move.s, move.end)[..., :-1]
        z = states[..., -1:, :] if laws else states[-1]
    return f


def measured_friction(
    motion: Sequence[Move], f: NDArray, rows: int, fitted: Callable[[type[FrictionLaw]], dict[str, Any]]
) -> MeasuredFriction:
    """Summary of measured friction f, (samples,), for a guess of parameters with tables of ``rows``."""
    sliding = np.abs(np.concatenate([f[move.samples] for move in motion if move.samples]))
    first = next(move for move in motion if move.samples)
    longest = max(move.way for move in motion)
    slip, f_first = np.array(first.slip), np.abs(f[first.samples])
    near = slip <= 0.1 * slip[-1]
    near[:2] = True
    slope = float(np.sum(f_first[near] * slip[near]) / np.sum(slip[near] ** 2))
    level = float(np.quantile(sliding, 0.95)) or 1.0
    speed = float(np.exp(np.mean(np.log([max(move.V, 1e-12) for move in motion]))))
    least = float(np.quantile(sliding, 0.3)) or level
    return MeasuredFriction(level, least, slope or level / longest, longest, speed, rows, fitted)


def fit(
    kind: type[FrictionLaw],
    measured: Sequence[Measured],
    fixed: dict[str, Any],
    start: dict[str, Any],
    rows: int = 3,
    step: Callable[[int, int], None] = lambda done, of: None,
) -> FittedLaw:
    """Law nearest to measured friction, by least squares over its parameters.

    Several starts search through some 150 samples; from the best of them all samples are fitted, or every
    n-th of more than 3000.

    Args:
        kind: class of the law.
        measured: measurements of one law, each of which begins at rest.
        fixed: values by key of parameters that are not fitted.
        start: values by key of other parameters with which the search begins.
        rows: number of rows of tables that are fitted.
        step: called with the number of starts that are done, and of all, while it works.

    Raises:
        ValueError: a parameter has no start, there are fewer samples than numbers, or no start leads
            anywhere.
    """
    whole = _Fitted.of(kind, measured)
    look = measured_friction(
        whole.motion, whole.f, rows, lambda kind: fit(kind, measured, {}, {}, rows).parameters
    )
    search = _Search(kind, look, fixed, start)
    used = len(whole.used)
    if used <= len(search.names):
        raise ValueError(
            f"found {used} samples in motion for {len(search.names)} parameters, expected more"
        )
    every = -(-used // _MOST)
    fitted = whole.thinned(every)
    if search.names:
        few = whole.thinned(-(-used // _FEW))
        θ = _best_start(few if len(few.used) > 2 * len(search.names) else fitted, search, step)
        θ = _least(fitted, search, θ, *_FIT).x
    else:
        θ = search.begin
    residuals = fitted.residuals(search, θ[None])[0]
    if np.abs(residuals).max() >= _REJECTED:
        search.law(search.begin)  # says what is wrong with what is fixed
        raise ValueError("no start of the search leads to a law; fix or start other parameters")
    law, names = search.law(θ), search.names
    spread = float(residuals @ residuals) / (len(residuals) - len(θ))
    deviations = search.stretch(θ) * np.sqrt(spread * _variances(_slopes(fitted, search, θ)))
    vague = tuple(np.array(names)[~(deviations < search.sizes(θ))].tolist())
    with np.errstate(all="ignore"):
        f = friction(law, whole.motion, len(whole.f))
    rms = float(np.sqrt(np.mean((f - whole.f)[whole.used] ** 2)))
    return FittedLaw(
        law, search.values(θ), names, search.numbers(θ), dict(zip(names, deviations.tolist())), vague,
        np.split(f, np.cumsum([len(record.t) for record in measured])[:-1]), used, rms, every,
    )  # fmt: skip


@dataclass(frozen=True)
class _Fitted:
    """Measurements one after the other, as a law sees them, and its residuals there.

    Attributes:
        motion: moves of all.
        f: measured friction coefficient, (samples,).
        at_once: True for laws of which one object can stand for many.
    """

    motion: Sequence[Move]
    f: NDArray[np.float64]
    at_once: bool

    @classmethod
    def of(cls, kind: type[FrictionLaw], measured: Sequence[Measured]) -> "_Fitted":
        """Measurements as laws of a kind see them."""
        motion, before = list[Move](), 0
        for record in measured:
            motion += moves(record.t, record.X, kind.depends_on_speed, before)
            before += len(record.t)
        return cls(
            motion,
            np.concatenate([record.f for record in measured]),
            kind.broadcasts or kind.batched,
        )

    @cached_property
    def used(self) -> NDArray[np.int64]:
        """Numbers of the samples in motion, but for those at a smooth turn."""
        each = [n for move in self.motion for n in move.samples if n not in move.turns]
        return np.array(each, dtype=int)

    def thinned(self, n: int) -> "_Fitted":
        """Measurements with every n-th sample alone."""
        return replace(self, motion=thinned(self.motion, n)) if n > 1 else self

    def residuals(self, search: "_Search", θ: NDArray) -> NDArray[np.float64]:
        """Friction of laws less the measured one, (laws, used), at unknowns θ (laws, unknowns)."""
        with np.errstate(all="ignore"):
            f = self._friction(search, θ)[:, self.used]
            difference = f - self.f[self.used]
        return np.where(np.isfinite(difference), difference, _REJECTED)

    def _friction(self, search: "_Search", θ: NDArray) -> NDArray[np.float64]:
        samples = len(self.f)
        if self.at_once and len(θ) > 1:
            with suppress(ValueError):  # one of them is rejected
                return friction(search.law(θ), self.motion, samples, len(θ))
        f = np.full((len(θ), samples), np.nan)
        for n, row in enumerate(θ):
            with suppress(ValueError):  # rejected by the law
                f[n] = friction(search.law(row), self.motion, samples)
        return f


def _best_start(
    data: _Fitted, search: "_Search", step: Callable[[int, int], None]
) -> NDArray[np.float64]:
    """Unknowns at which the best of several starts ends."""
    rng = np.random.default_rng(0)
    best = _least(data, search, np.clip(search.begin, search.low, search.high), *_SEARCH)
    steps, again = best.nfev, 0
    for n in range(1, _STARTS):
        step(n, _STARTS)
        θ = search.begin + search.reach * rng.uniform(-1.0, 1.0, len(search.begin))
        if n % 2:  # some unknowns alone, as of one spring: others are right already
            θ = np.where(rng.random(len(θ)) < 0.4, θ, best.x)
        result = _least(data, search, np.clip(θ, search.low, search.high), *_SEARCH)
        if result.cost < (1.0 - _AGAIN) * best.cost:
            best, again = result, 0
        else:
            again += result.cost <= (1.0 + _AGAIN) * best.cost
        steps += result.nfev
        if again == _ENOUGH or steps * len(data.motion) > _SEARCHED:
            break
    return best.x


def _least(data: _Fitted, search: "_Search", θ: NDArray, tolerance: float, steps: int) -> Any:
    """SciPy's result from a start; a step and all its differences are one pass through the motion."""
    from scipy.optimize import least_squares  # slow to import

    last: dict[bytes, tuple[NDArray, NDArray]] = {}

    def both(θ: NDArray) -> tuple[NDArray, NDArray]:
        """Residuals and their derivatives."""
        if θ.tobytes() not in last:
            h = 1e-6 * np.maximum(search.reach, np.abs(θ))
            h = np.where(θ + h > search.high, -h, h)
            residuals = data.residuals(search, np.concatenate([θ[None], θ + np.diag(h)]))
            last.clear()
            last[θ.tobytes()] = residuals[0], ((residuals[1:] - residuals[0]) / h[:, None]).T
        return last[θ.tobytes()]

    return least_squares(
        lambda θ: both(θ)[0], θ, lambda θ: both(θ)[1], bounds=(search.low, search.high),
        x_scale="jac", xtol=1e-10, ftol=tolerance, gtol=1e-12, max_nfev=steps,
    )  # fmt: skip


def _slopes(data: _Fitted, search: "_Search", θ: NDArray) -> NDArray[np.float64]:
    """Derivatives of residuals by θ, (used, m), by steps over which a law's kinks are smooth."""
    h = np.diag(_WIDE * np.maximum(search.reach, np.abs(θ)))
    low, high = np.maximum(θ - h, search.low), np.minimum(θ + h, search.high)
    below, above = data.residuals(search, np.concatenate([low, high])).reshape(2, len(θ), len(data.used))
    return np.asarray(((above - below) / np.diag(high - low)[:, None]).T)


def _variances(J: NDArray) -> NDArray[np.float64]:
    """Diagonal of the inverse of JᵀJ, (m,); NaN for what J does not determine."""
    size = np.linalg.norm(J, axis=0)
    scale = np.where(size == 0.0, 1.0, size)
    _, singular, V = np.linalg.svd(J / scale, full_matrices=False)
    weak = singular < 1e-10 * singular.max(initial=1e-300)
    diagonal = ((V / np.where(weak, 1.0, singular)[:, None]) ** 2).sum(axis=0)
    lost = (size == 0.0) | (np.abs(V[weak]) > 1e-6).any(axis=0)
    return np.where(lost, np.nan, diagonal / scale**2)


def _unknown(
    name: str, bounds: Range, start: float, usual: float
) -> tuple[bool, float, float, float, float]:
    """Unknown θ of a number p of a law: ln p where p has to be positive, else p.

    Args:
        name: of p, for messages.
        bounds: range of p.
        start: p with which the search begins.
        usual: size of such a number, where it has no bounds.

    Returns:
        True where θ = ln p; θ at the start; its lowest and highest value, a little inside of open bounds;
        and the largest distance of other starts from the first.

    Raises:
        ValueError: p has to be positive, and its start is not.
    """
    if bounds.above == 0.0 and bounds.below is None:
        if start <= 0.0:
            raise ValueError(f"found a start of {name} that is not above 0")
        θ = log(start)
        return True, θ, θ - log(_FARTHEST), θ + log(_FARTHEST), log(_AWAY)
    low = -inf if bounds.at_least is None else bounds.at_least
    low = low if bounds.above is None else bounds.above + _INSIDE
    high = inf if bounds.at_most is None else bounds.at_most
    high = high if bounds.below is None else bounds.below - _INSIDE
    reach = 0.5 * (high - low) if isfinite(high - low) else max(abs(start), usual)
    return False, start, low, high, reach


class _Search:
    """Fitted numbers of a law, and their unknowns θ.

    Attributes:
        names: names of the numbers, (m,).
        begin, low, high: start and bounds of θ, (m,).
        reach: largest distance of other starts from the first, (m,).

    Raises:
        ValueError: a parameter is unknown, or has no start.
    """

    def __init__(
        self, kind: type[FrictionLaw], look: MeasuredFriction, fixed: dict[str, Any],
        start: dict[str, Any],
    ) -> None:  # fmt: skip
        self._kind, self._values, described = kind, dict[str, Any](), parameters(kind)
        if unexpected := [key for key in (*fixed, *start) if key not in described]:
            raise ValueError(f"found the parameter {unexpected[0]!r}, expected {', '.join(described)}")
        given, defaults = kind.guess(look) | start | fixed, fields(kind)
        # Of each fitted number its name, parameter and place in that, () for one number.
        self._fitted: list[tuple[str, str, tuple[int, ...]]] = []
        unknowns = []
        for key, parameter in described.items():
            value = given.get(key, None if parameter.columns else defaults[key].default)
            if parameter.optional and value is None:
                continue
            if value is None or not isinstance(value, (int, float, str, tuple)):
                raise ValueError(f"found no start for {key}, expected --start {key}=… or --fix {key}=…")
            self._values[key] = value
            bounds = Range(above=0.0) if len(parameter.measured) > 1 else parameter.range
            usual = look.level / max(look.speed, 1e-12) if parameter.unit else 1.0
            chosen = key in fixed or parameter.options or parameter.count
            for place, number in np.ndenumerate(() if chosen else np.array(value, dtype=float)):
                name = f"{key}[{place[0]}, {place[1]}]" if place else key
                if name in kind.conventions or (place and place[1] not in parameter.measured):
                    continue
                self._fitted.append((name, key, place))
                unknowns.append(_unknown(name, bounds, float(number), usual))
        self.names = tuple(name for name, *_ in self._fitted)
        logs, self.begin, self.low, self.high, self.reach = np.reshape(unknowns, (-1, 5)).T
        self._logs = logs.astype(bool)

    def numbers(self, θ: NDArray) -> NDArray[np.float64]:
        """Fitted numbers p at θ, (m,)."""
        return np.where(self._logs, np.exp(np.where(self._logs, θ, 0.0)), θ)

    def stretch(self, θ: NDArray) -> NDArray[np.float64]:
        """Derivatives dp/dθ, (m,)."""
        return np.where(self._logs, self.numbers(θ), 1.0)

    def sizes(self, θ: NDArray) -> NDArray[np.float64]:
        """Deviations of the numbers at θ from which on data do not determine them, (m,).

        That of a number without sign is its own size, else the largest of its key.
        """
        size, keys = np.abs(self.numbers(θ)), np.array([key for _, key, _ in self._fitted])
        return np.where(np.isinf(self.low), [size[keys == key].max() for key in keys], size)

    def values(self, θ: NDArray) -> dict[str, Any]:
        """All parameters by key at θ."""
        values = {
            key: np.array(value, dtype=None if isinstance(value, str) else float)
            for key, value in self._values.items()
        }
        for (_, key, place), number in zip(self._fitted, self.numbers(θ)):
            values[key][place] = number
        return {
            key: tuple(map(tuple, value.tolist())) if value.ndim > 1 else value.tolist()
            for key, value in values.items()
        }

    def law(self, θ: NDArray) -> FrictionLaw:
        """Law at θ (m,), or a law that stands for those at θ (laws, m).

        Raises:
            ValueError: a law rejects its parameters.
        """
        if θ.ndim == 1:
            return build_model(self._kind, self.values(θ))
        each = [self.values(row) for row in θ]
        return build_model(self._kind, {
            key: value if isinstance(value, str)
            else np.reshape([values[key] for values in each], (len(θ), 1, *np.shape(value)))
            for key, value in each[0].items()
        })  # fmt: skip
