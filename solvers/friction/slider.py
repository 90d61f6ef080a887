"""A mass that is pulled through a spring over a surface with friction: stick-slip."""

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from math import ceil
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..parameters import parameter
from .integrate import event
from .law import FrictionLaw

#: Rise of friction with speed, over the damper that is critical, from which on a motion is stiff, and
#: speeds at which it is evaluated.
_STIFF, _SPEEDS = 30.0, 200
#: Schemes, in the order in which they are tried, with their relative tolerance and absolute ones over the
#: scales of the motion. The first is for laws without memory, the second for others, both for motions
#: that are not stiff: where LSODA fails, as it may in stiff ones, its Fortran writes so on the screen.
_EXPLICIT, _EITHER = ("DOP853", 1e-12, 1e-14), ("LSODA", 1e-11, 1e-13)
_IMPLICIT = *(("BDF", of, 1e-2 * of) for of in (1e-10, 1e-8, 1e-6)), ("Radau", 1e-10, 1e-12)
#: Evaluations after which a piece of more periods is tried in a shorter one; how often a piece in which
#: no scheme succeeds is tried in a shorter one yet.
_PATIENCE, _TRIALS = 20_000, 5
#: Scheme, relative tolerance, and absolute ones.
_Scheme = tuple[str, float, float]
#: Stops, starts and switches of a law after which a motion is given up.
PIECES = 20_000
#: Share of the drive's speed below which the mass is at rest; friction at rest is evaluated at this
#: speed, for laws of the logarithm of the speed.
_AT_REST = 1e-9
#: Periods of the mass on its spring after which the integration begins anew, and progress is reported;
#: evaluations up to which a piece without stops makes the next twice as long; by how much one is shorter
#: that takes too many. Derivatives by differences in a piece, besides a tenth of its steps, from which a
#: scheme is given up: where friction follows the slightest change of a slow creep, it follows rounding.
_PERIODS, _FEW, _SHORTER, _STEPS = 10, 2_000, 8.0, 100
#: Unit of time of the integration over the length of a piece: SciPy locates events to an absolute time.
_INSTANT = 1e-16
#: Equal cycles after which a motion is periodic, and their largest difference over the sizes of the
#: motion: the tolerance leaves about as much in a cycle. Most crossings of the drive's speed in a cycle.
_CYCLES, _SAME, _MOST_CROSSINGS = 8, 1e-8, 32
#: Differences of the spring between the ends of a cycle, over its swing, up to which it is one: of the
#: last cycle of any motion, and of a periodic one; and what it may still lose or gain in all.
_ALIKE, _CLOSE, _LEFT = 1e-2, 1e-5, 0.1
#: Share of the largest velocity from which on a mass slips.
_SLIPS = 1e-3
#: Shares of the drive's speed: difference of a speed from it in steady sliding, and speed of a mass that
#: sticks; under laws of the logarithm of the speed it creeps, and never stops.
_STEADY, _STOPPED = 1e-3, 1e-2
#: Growth of a swing about steady sliding over its frequency from which on it counts, and differences,
#: over the sizes of the motion, by which that is measured.
_GROWS, _DIFFERENCE = 1e-4, 1e-6
#: Outcomes of a slider's motion.
STICK_SLIP, SWINGS, STEADY, ONE_SLIP, STAYS, SHORT = (
    "stick-slip", "swings about the drive", "slides steadily", "one slip only", "has not broken away yet",
    "not settled yet",
)  # fmt: skip


@dataclass(frozen=True)
class Slider:
    """A mass on a driven spring: m dv/dt = k e + d (V - v) - N f, de/dt = V - v, from rest, e = 0."""

    mass: float = parameter("mass", "mass of the slider, per depth", "kg/m", above=0.0)
    stiffness: float = parameter("stiffness", "stiffness of the spring, per depth", "N/m^2", above=0.0)
    damping: float = parameter("damping", "dashpot beside the spring, per depth", "N*s/m^2", at_least=0.0)
    drive_speed: float = parameter(
        "drive_speed", "speed at which the spring's other end is pulled", "m/s", above=0.0
    )
    duration: float = parameter("duration", "duration of the motion", "s", above=0.0)


@dataclass(frozen=True)
class _Piece:
    """A piece of a motion in one direction s = ±1, or at rest, s = 0.

    Attributes:
        start, end: times [s].
        s: its direction.
        t: steps and extremes of the velocity since its start, growing, (times,) [s].
        y: spring, velocity and state of the law at times since its start, (2 + n, times).
    """

    start: float
    end: float
    s: int
    t: NDArray[np.float64]
    y: Callable[[NDArray], NDArray]


class Ride:
    """Motion of a slider, at the steps of the integration, (n,).

    The integration ends where the motion is periodic; :meth:`at` repeats its last cycle.

    Args:
        motion: the motion at its end.

    Attributes:
        t: time [s].
        x, v: its position [m] and velocity [m/s].
        f: friction coefficient, that of the spring's pull where it sticks.
        crossings: times at which the slider became faster than the drive [s], (m,).
        x_crossings: positions at these times [m], (m,).
        period, slip: duration [s] of the last cycle of stick-slip, from a crossing to the next like it,
            and slip of the mass in it [m]; NaN where there is none.
        peak, least: largest and smallest velocity in it [m/s].
    """

    def __init__(self, motion: "_Motion") -> None:
        self._motion, self._drive = motion, motion.slider.drive_speed
        self.t = np.concatenate([piece.start + piece.t for piece in motion.pieces])
        self.x, self.v, self.f = np.vstack([motion.rows(piece, piece.t) for piece in motion.pieces]).T
        self.crossings = np.array([t for t, _ in motion.crossings])
        self.x_crossings = self._drive * self.crossings - [state[0] for _, state in motion.crossings]
        #: Crossings in a cycle that repeats, 0 for none, and in the last cycle.
        self._repeats = motion.repeats
        self._in_cycle = self._alike(_CLOSE if self._repeats else _ALIKE) or self._repeats
        self.period = self.slip = self.peak = self.least = np.nan
        if (steps := self.cycle) and self.v[steps].max() >= (1.0 + _STEADY) * self._drive:
            self.period, self.slip = self._since(self._in_cycle)
            self.peak, self.least = float(self.v[steps].max()), float(self.v[steps].min())

    def at(self, times: NDArray) -> NDArray[np.float64]:
        """Position [m], velocity [m/s] and friction coefficient at times [s], (3, times).

        Between its steps the scheme's own polynomials are evaluated, as accurate as the steps.
        """
        t, cycles = np.array(times, dtype=float), np.zeros(np.shape(times))
        if self._repeats:
            period, slip = self._since(self._repeats)
            cycles = np.maximum(np.floor((t - self.crossings[-1]) / period) + 1.0, 0.0)
            t = t - cycles * period
        starts = np.array([piece.start for piece in self._motion.pieces])
        which = np.clip(np.searchsorted(starts, t, side="right") - 1, 0, len(starts) - 1)
        values = np.empty((3, len(t)))
        for n in np.unique(which):
            piece, in_piece = self._motion.pieces[n], which == n
            since = np.clip(t[in_piece], piece.start, piece.end) - piece.start
            values[:, in_piece] = self._motion.rows(piece, since).T
        if self._repeats:
            values[0] += cycles * slip
        return values

    def _alike(self, closely: float) -> int:
        """Crossings from the last one back to the one like it, a cycle earlier; 0 for none.

        The spring is as long there, but for a share of its swing; so it is at the ones before both.
        """
        e, E = self._drive * self.crossings - self.x_crossings, self._drive * self.t - self.x
        # Of two crossings one ends a cycle; of more there are two cycles.
        for k in range(1, min(len(e), max((len(e) + 1) // 2, 2))):
            swing = np.ptp(E[np.searchsorted(self.t, self.crossings[-1 - k]) :])
            changes = np.abs(e[k:] - e[: len(e) - k])
            if (changes[-2:] > closely * swing).any():
                continue
            # A swing that dies out changes little in a cycle, too: by a share of what is left of it.
            falls = 1.0 - changes[-1] / changes[-1 - k] if len(changes) > k and changes[-1 - k] else 1.0
            return k if changes[-1] <= max(_LEFT * falls, _CLOSE) * swing else 0
        return 0

    def _since(self, crossings: int) -> tuple[float, float]:
        """Time since so many crossings before the last one [s], and slip since [m]."""
        t, x = self.crossings, self.x_crossings
        return float(t[-1] - t[-1 - crossings]), float(x[-1] - x[-1 - crossings])

    def slips(self, end: float, most: int) -> NDArray[np.float64]:
        """Times in the slips up to an end [s], rising: fast slips are over between times far apart.

        These are steps of the integration: first where slips begin, are fastest and end, then others.

        Args:
            end: last time [s].
            most: most times; of more so many are picked.
        """
        if self.v.max() < (1.0 + _STEADY) * self._drive:
            return np.empty(0)
        fast, rises = self.v > _SLIPS * self.v.max(), np.diff(self.v) > 0.0
        first = np.zeros_like(fast)
        first[1:-1] = (fast[1:-1] != fast[:-2]) | (fast[1:-1] != fast[2:]) | (rises[:-1] & ~rises[1:])
        times = self._again(self.t[first & fast], end, most)
        others = self._again(self.t[fast & ~first], end, most)
        others = _thinned(others, most - len(times))
        return np.unique(np.concatenate([times, others])[:most])

    def _again(self, times: NDArray, end: float, most: int) -> NDArray[np.float64]:
        """Times up to an end, and those of the last cycle in the cycles after it, or in some of many."""
        if self._repeats and end > self.crossings[-1]:
            (period, _), last = self._since(self._repeats), self.crossings[-1]
            times = times[times <= last]
            cycle = times[times > last - period]
            count = ceil((end - last) / period)
            # Of slips that repeat there may be more than fit into memory.
            cycles = np.arange(1, count + 1, ceil(count * max(len(cycle), 1) / most))
            times = np.concatenate([times, np.add.outer(cycles * period, cycle).ravel()])
        return _thinned(times[times <= end], most)

    @property
    def cycle(self) -> slice | None:
        """Steps of the last cycle of stick-slip; None where there is no whole cycle."""
        if not self._in_cycle:
            return None
        first, last = np.searchsorted(self.t, self.crossings[[-1 - self._in_cycle, -1]])
        return slice(int(first), int(last) + 1)

    @property
    def outcome(self) -> str:
        """Outcome of the motion in words."""
        if np.isfinite(self.period):
            return STICK_SLIP if self.least <= _STOPPED * self._drive else SWINGS
        if self._motion.slides_steadily:
            return STEADY
        if len(self.crossings) > 1 or self.v[-1] > _STOPPED * self._drive:
            return SHORT
        return ONE_SLIP if len(self.crossings) else STAYS


def _thinned(times: NDArray, most: int) -> NDArray[np.float64]:
    """Every so manyth of some times, that they are no more than ``most``, or one."""
    return times[:: max(ceil(len(times) / max(most, 1)), 1)]


def pull(
    slider: Slider, law: FrictionLaw, load: float, done: Callable[[float], None] = lambda share: None
) -> Ride:
    """Move a slider under a law, by SciPy between stops, starts and switches of the law.

    Args:
        slider: mass, spring and drive.
        law: its friction.
        load: normal force per depth [N/m].
        done: called now and then with the share of the duration that is done.

    Raises:
        ValueError: the integration failed, the motion has too many pieces, or friction drives it.
    """
    motion = _Motion(slider, law, load)
    for _ in range(PIECES):
        if motion.t >= slider.duration or motion.repeats:
            done(1.0)
            return Ride(motion)
        motion.go_on()
        done(min(motion.t / slider.duration, 1.0))
    raise ValueError(
        f"the mass has stopped, started and switched {PIECES} times in {motion.t:.3g} s: it rings in the "
        "law's own springs; give damping, or a larger mass"
    )


class _Tired(ValueError):
    """A long piece takes more evaluations than short ones would."""


class _Motion:
    """A motion as far as it has come: e, v and the law's state z at the time t."""

    def __init__(self, slider: Slider, law: FrictionLaw, load: float) -> None:
        self.slider, self.law, self.load = slider, law, load
        self.t, self.e, self.v, self.z, self.s = 0.0, 0.0, 0.0, law.rest(), 0
        self.pieces: list[_Piece] = []
        # Times at which the drive's speed was crossed, with spring and state of the law.
        self.crossings: list[tuple[float, NDArray[np.float64]]] = []
        self._longest = self._usual = _PERIODS * 2.0 * np.pi * np.sqrt(slider.mass / slider.stiffness)
        self._slow = _AT_REST * slider.drive_speed
        f = float(law.friction(law.settle(self.z, 1, self._slow), 1, self._slow))
        if f < 0.0:
            raise ValueError(
                f"found the friction coefficient {f:g} where motion starts, expected 0 or more: such a "
                "friction drives the mass; let a table begin with the first slip, not with a reversal"
            )
        # Size of the spring's extension [m].
        self._length = max(load / slider.stiffness, 1e-3 * slider.drive_speed * slider.duration)
        # Over such rates a mass on its spring hardly moves before friction has slowed it down.
        V = slider.drive_speed * np.geomspace(_AT_REST, 1.0 / _AT_REST, _SPEEDS)
        rises = np.diff([float(law.friction(self.z, 1, speed)) for speed in V]) / np.diff(V)
        rate = load * rises.max() / np.sqrt(slider.mass * slider.stiffness)
        self._stiff = bool(rate > _STIFF)
        # Schemes that are at odds with rounding.
        self._given_up = set[_Scheme]()
        # Rates that are smooth enough need no stop.
        self._stops = type(law).settle is not FrictionLaw.settle

    @property
    def repeats(self) -> int:
        """Crossings in a cycle of which the last ones are equal to rounding of the integration; or 0."""
        if len(self.crossings) <= _CYCLES:
            return 0
        last = self.crossings[-_CYCLES * _MOST_CROSSINGS - 1 :]
        times, states = (np.array(of) for of in zip(*last))
        sizes = np.abs(states).max(axis=0)
        sizes[0] = max(sizes[0], self._length)
        for k in range(1, (len(times) - 1) // _CYCLES + 1):
            ends = slice(-1 - _CYCLES * k, None, k)
            unchanged, periods = np.ptp(states[ends], axis=0) <= _SAME * sizes, np.diff(times[ends])
            if unchanged.all() and np.ptp(periods) <= _SAME * periods.max():
                return k
        return 0

    @property
    def slides_steadily(self) -> bool:
        """True where the mass moves with the drive and goes on so: what is left of its swing falls."""
        drive = self.slider.drive_speed
        y = np.array([self.e, self.v, *self.z])
        ω = np.sqrt(self.slider.stiffness / self.slider.mass)
        if self.s != 1 or np.hypot(self.v - drive, self._acceleration(y) / ω) > _STEADY * drive:
            return False
        steps = _DIFFERENCE * np.diag([self._length, drive, *np.ones_like(self.z)])
        J = [(self._rates(y + step) - self._rates(y - step)) / (2.0 * step.sum()) for step in steps]
        λ = np.linalg.eigvals(np.array(J))
        return bool((λ.real <= _GROWS * np.abs(λ)).all())

    def rows(self, piece: _Piece, since: NDArray) -> NDArray[np.float64]:
        """Position [m], velocity [m/s] and friction coefficient at times since a piece began, (n, 3)."""
        drive, rows = self.slider.drive_speed, []
        for t, y in zip(since, piece.y(since).T):
            f = self._friction(y, piece.s) if piece.s else self._pull(y[0], 0.0) / self.load
            rows.append((drive * (piece.start + t) - y[0], y[1], f))
        return np.array(rows)

    def _pull(self, e: float, v: float) -> float:
        """Force of spring and dashpot [N/m] at the extension e [m] and the velocity v [m/s]."""
        return self.slider.stiffness * e + self.slider.damping * (self.slider.drive_speed - v)

    def go_on(self) -> None:
        """Advance to the next stop, start or switch."""
        if self.v == 0.0:
            self._start()
        if self.t < self.slider.duration:
            self._slide()

    def _start(self) -> None:
        """Start from rest, after a while, in the direction in which the pull exceeds friction."""
        force, self.z = self._pull(self.e, 0.0), self.law.pause(self.z, 1e-300)  # an instant
        bears = {
            s: self.load * float(self.law.friction(self.law.settle(self.z, s, self._slow), s, self._slow))
            for s in (1, -1)
        }
        self.s = -1 if force < bears[-1] and force <= bears[1] else 1
        if bears[-1] <= force <= bears[1]:
            # It sticks, if it does, until the spring pulls it forward.
            longer = (bears[1] - force) / (self.slider.stiffness * self.slider.drive_speed)
            self._stick(min(longer, self.slider.duration - self.t))
        self.z, self.v = self.law.settle(self.z, self.s, self._slow), self.s * self._slow

    def _stick(self, seconds: float) -> None:
        if seconds <= 0.0:
            return
        begun, drive, z = self.e, self.slider.drive_speed, self.z
        self.pieces.append(_Piece(
            self.t, self.t + seconds, 0, np.linspace(0.0, seconds, 20),
            lambda t: np.vstack([begun + drive * t, 0.0 * t, np.outer(z, np.ones_like(t))]),
        ))  # fmt: skip
        self.t, self.e = self.t + seconds, begun + drive * seconds
        self.z = self.law.pause(z, seconds)

    def _slide(self) -> None:
        """Slide in one direction, as long as the law does not switch."""
        piece = self._integrated()
        t = np.sort(np.append(piece.t, piece.t_events[2]))
        self.pieces.append(_Piece(self.t, self.t + piece.t[-1], self.s, t, piece.sol))
        self.crossings += [
            (self.t + t, np.delete(y, 1)) for t, y in zip(piece.t_events[1], piece.y_events[1])
        ]
        self.t, (self.e, self.v, *z) = self.t + piece.t[-1], piece.y[:, -1]
        self.z = np.array(z)
        if piece.status == 0 and piece.nfev <= _FEW:  # a slow creep needs no step a period
            self._longest *= 2.0
        if len(piece.t_events[0]):
            self.v = 0.0
        elif piece.status == 1:
            self.z = self.law.settle(self.z, self.s, abs(self.v))

    def _integrated(self) -> Any:
        """SciPy's result by the first scheme that succeeds, up to the next stop or switch.

        Raises:
            ValueError: no scheme succeeds.
        """
        remembers = self.law.flow(self.z, self.s, self.slider.drive_speed).any()
        first = () if self._stiff else (_EITHER,) if remembers else (_EXPLICIT,)
        reason, shortest = "", self._usual / _SHORTER**_TRIALS
        while self._longest > shortest:
            for scheme in (*first, *_IMPLICIT):
                if scheme in self._given_up:
                    continue
                try:
                    result = self._by(scheme)
                except _Tired as error:
                    reason = str(error)
                    break
                except ValueError as error:  # an event could not be located
                    reason = str(error)
                    continue
                if result.success:
                    if result.njev > _STEPS + 0.1 * len(result.t) and scheme != _IMPLICIT[-1]:
                        self._given_up.add(scheme)
                    return result
                reason = result.message
            self._longest /= _SHORTER
        raise ValueError(f"the slider's motion could not be integrated at {self.t:g} s: {reason}")

    def _by(self, scheme: _Scheme) -> Any:
        """SciPy's result by a scheme, with times since the start of the piece [s].

        Raises:
            ValueError: an event could not be located; :class:`_Tired`: it takes too many steps.
        """
        from scipy.integrate import solve_ivp  # slow to import, and friction alone does without

        s, drive, (method, relative, absolute) = self.s, self.slider.drive_speed, scheme
        ahead = np.flatnonzero(self.law.switches(self.z, s, abs(self.v)) < 0.0) if self._stops else ()
        events = [
            event(lambda _, y: s * y[1] - 0.5 * self._slow, -1.0, True),
            event(lambda _, y: y[1] - drive, 1.0, False),
            event(lambda _, y: self._acceleration(y), 0.0, False),
            *(
                event(lambda _, y, n=n: self.law.switches(y[2:], s, max(s * y[1], 0.0))[n], 1.0, True)
                for n in ahead
            ),
        ]
        unit, left = _INSTANT * self._longest, iter(range(_PATIENCE))

        def rates(_: float, y: NDArray) -> NDArray[np.float64]:
            if self._longest > self._usual and next(left, None) is None:
                raise _Tired("it takes too many steps")
            return unit * self._rates(y)

        start = np.array([self.e, self.v, *self.z])
        solve = partial(
            solve_ivp, rates, y0=start, method=method, events=events, rtol=relative, dense_output=True,
            atol=absolute * np.array([self._length, drive, *np.ones_like(self.z)]),
        )  # fmt: skip
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of a scheme that gives up: the next is tried
            result = solve((0.0, min(self.slider.duration - self.t, self._longest) / unit))
            # Between two steps it may have stopped and been drawn on: a minimum of v shows that.
            slow = s * np.reshape(result.y_events[2], (-1, len(start)))[:, 1] < 0.5 * self._slow
            if slow.any():
                result = solve((0.0, float(result.t_events[2][np.argmax(slow)])))
        result.t, of_units = result.t * unit, result.sol
        result.t_events = [t * unit for t in result.t_events]
        result.sol = lambda t: of_units(t / unit)
        return result

    def _friction(self, y: NDArray, s: int) -> float:
        return float(self.law.friction(y[2:], s, max(s * y[1], 0.0)))

    def _acceleration(self, y: NDArray) -> float:
        return (self._pull(y[0], y[1]) - self.load * self._friction(y, self.s)) / self.slider.mass

    def _rates(self, y: NDArray) -> NDArray[np.float64]:
        turned = self.law.flow(y[2:], self.s, max(self.s * y[1], 0.0))
        return np.array([self.slider.drive_speed - y[1], self._acceleration(y), *turned])
