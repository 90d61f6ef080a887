"""A mass that is pulled through a spring over a surface with friction: stick-slip."""

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.friction.law import FrictionLaw

#: Relative tolerance of the integration, and absolute ones over the scales of the motion.
TOLERANCES = 1e-10, 1e-12
#: Stops, starts and switches of a law after which nothing more is to be expected of a motion.
PIECES = 20_000
#: How far beyond the speed of the drive an oscillation has to go, over that speed.
_SEEN = 1e-6
#: Below this share of the drive's speed the mass is at rest: what laws of the logarithm of the speed bear
#: is asked for there.
_AT_REST = 1e-9
#: Schemes, in the order in which they are tried.
_SCHEMES = ("BDF", "Radau")
#: An instant at rest [s].
_INSTANT = 1e-300


@dataclass(frozen=True)
class Slider:
    """m dv/dt = k e + d (V - v) - N f,   de/dt = V - v: from rest, the spring relaxed.

    Attributes:
        mass: m per depth [kg/m].
        stiffness: k per depth [N/m²].
        damping: d of a dashpot beside the spring, per depth [N s/m²].
        drive_speed: V at which the spring's other end is pulled [m/s].
        duration: of the motion [s].
    """

    mass: float
    stiffness: float
    damping: float
    drive_speed: float
    duration: float


@dataclass(frozen=True)
class Ride:
    """How a slider moved, at the steps of the integration, (n,).

    Attributes:
        t: time [s].
        x, v: its position [m] and velocity [m/s].
        f: friction coefficient, that of the spring's pull where it sticks.
        crossings: times at which it became faster than the drive [s], (m,).
        x_crossings: its positions then [m], (m,).
    """

    t: NDArray[np.float64]
    x: NDArray[np.float64]
    v: NDArray[np.float64]
    f: NDArray[np.float64]
    crossings: NDArray[np.float64]
    x_crossings: NDArray[np.float64]

    @property
    def cycle(self) -> slice | None:
        """Steps of the last cycle of stick-slip; None where there is no whole one."""
        if len(self.crossings) < 2:
            return None
        first, last = np.searchsorted(self.t, self.crossings[-2:])
        return slice(int(first), int(last) + 1)


@dataclass(frozen=True)
class Cycle:
    """The last cycle of stick-slip; NaN where there is none.

    Attributes:
        period: [s].
        slip: of the mass in a cycle [m].
        peak, least: largest and smallest velocity [m/s].
    """

    period: float
    slip: float
    peak: float
    least: float


def cycle(ride: Ride, drive_speed: float) -> Cycle:
    """The last cycle of a motion, from one crossing of the drive's speed [m/s] to the next."""
    steps = ride.cycle
    if steps is None or ride.v[steps].max() < (1.0 + _SEEN) * drive_speed:
        return Cycle(*[np.nan] * 4)
    (period,), (slip,), v = np.diff(ride.crossings[-2:]), np.diff(ride.x_crossings[-2:]), ride.v[steps]
    return Cycle(float(period), float(slip), float(v.max()), float(v.min()))


def pull(slider: Slider, law: FrictionLaw, load: float) -> Ride:
    """Move a slider under a law, by SciPy's BDF between stops, starts and switches of the law.

    Args:
        slider: mass, spring and drive.
        law: its friction.
        load: normal force per depth [N/m].

    Raises:
        ValueError: the integration failed, or came to no end.
    """
    motion = _Motion(slider, law, load)
    for _ in range(PIECES):
        if motion.t >= slider.duration:
            return motion.ride()
        motion.go_on()
    raise ValueError(
        f"the mass has stopped, started and switched {PIECES} times in {motion.t:.3g} s: it rings in the "
        "law's own springs; give damping, or a larger mass"
    )


class _Motion:
    """A motion as far as it has come: e, v and the law's state z at the time t."""

    def __init__(self, slider: Slider, law: FrictionLaw, load: float) -> None:
        self.slider, self.law, self.load = slider, law, load
        self.t, self.e, self.v, self.z, self.s = 0.0, 0.0, 0.0, law.rest(), 0
        self._rows: list[tuple[float, float, float, float]] = []
        self._crossings: list[tuple[float, float]] = []
        self._slow = _AT_REST * slider.drive_speed
        # Rates that are smooth enough need no stop.
        self._stops = type(law).settle is not FrictionLaw.settle

    def ride(self) -> Ride:
        t, e, v, f = np.array(self._rows).T
        at, e_at = np.reshape(self._crossings, (-1, 2)).T
        drive = self.slider.drive_speed
        return Ride(t, drive * t - e, v, f, at, drive * at - e_at)

    def pull(self, e: float, v: float) -> float:
        """Of spring and dashpot [N/m]."""
        return self.slider.stiffness * e + self.slider.damping * (self.slider.drive_speed - v)

    def go_on(self) -> None:
        """To the next stop, start or switch."""
        if self.v == 0.0:
            self._start()
        if self.t < self.slider.duration:
            self._slide()

    def _start(self) -> None:
        """From rest: in the direction in which it is pulled over what friction bears, after a while."""
        force, self.z = self.pull(self.e, 0.0), self.law.pause(self.z, _INSTANT)
        bears = {s: self.load * self._at_once(s) for s in (1, -1)}
        self.s = -1
        if force > bears[1]:
            self.s = 1
        elif force >= bears[-1]:
            # It sticks, if it does, until the spring pulls it forward.
            longer = (bears[1] - force) / (self.slider.stiffness * self.slider.drive_speed)
            self._stick(min(longer, self.slider.duration - self.t))
            self.s = 1
        self.z, self.v = self.law.settle(self.z, self.s, self._slow), self.s * self._slow

    def _at_once(self, s: int) -> float:
        return float(self.law.friction(self.law.settle(self.z, s, self._slow), s, self._slow))

    def _stick(self, seconds: float) -> None:
        if seconds <= 0.0:
            return
        for t in np.linspace(0.0, seconds, 20):
            e = self.e + self.slider.drive_speed * t
            self._rows.append((self.t + t, e, 0.0, self.pull(e, 0.0) / self.load))
        self.t, self.e = self.t + seconds, e
        self.z = self.law.pause(self.z, seconds)

    def _slide(self) -> None:
        """In one direction, as long as the law does not switch."""
        s, found = self.s, self._integrated()
        self._keep(found)
        self.t, (self.e, self.v, *z) = self.t + found.t[-1], found.y[:, -1]
        self.z = np.array(z)
        if len(found.t_events[0]):
            self.v = 0.0
        elif found.status == 1:
            self.z = self.law.settle(self.z, s, abs(self.v))

    def _integrated(self) -> Any:
        """By the first scheme that can.

        Raises:
            ValueError: none can.
        """
        from scipy.integrate import solve_ivp  # slow to import, and friction alone does without

        s, drive = self.s, self.slider.drive_speed
        ahead = np.flatnonzero(self.law.switches(self.z, s, abs(self.v)) < 0.0) if self._stops else ()
        events = [
            _event(lambda _, y: s * y[1] - 0.5 * self._slow, -1.0, True),
            _event(lambda _, y: y[1] - drive, 1.0, False),
            _event(lambda _, y: self._acceleration(y), -1.0, False),
            *(_event(lambda _, y, n=n: self._switch(y, int(n)), 1.0, True) for n in ahead),
        ]
        length = max(self.load / self.slider.stiffness, 1e-3 * drive * self.slider.duration)
        relative, absolute = TOLERANCES
        accurate = [absolute * length, absolute * drive, *[absolute] * len(self.z)]
        said = ""
        for scheme in _SCHEMES:
            try:
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore")  # of a scheme that gives up: the next is tried
                    found = solve_ivp(
                        self._rates, (0.0, self.slider.duration - self.t),
                        np.array([self.e, self.v, *self.z]), method=scheme, events=events, rtol=relative,
                        atol=accurate,
                    )  # fmt: skip
            except ValueError as error:  # an event could not be located
                said = str(error)
                continue
            if found.success:
                return found
            said = found.message
        raise ValueError(f"the slider's motion could not be integrated at {self.t:g} s: {said}")

    def _keep(self, found: Any) -> None:
        """The steps of a piece, and the fastest moments among them."""
        self._crossings += [(self.t + t, y[0]) for t, y in zip(found.t_events[1], found.y_events[1])]
        t = np.append(found.t, found.t_events[2])
        fastest = np.reshape(found.y_events[2], (-1, len(found.y)))
        y = np.concatenate([found.y.T, fastest])
        for n in np.argsort(t, kind="stable"):
            self._rows.append((self.t + t[n], y[n, 0], y[n, 1], self._friction(y[n])))

    def _friction(self, y: NDArray) -> float:
        return float(self.law.friction(y[2:], self.s, max(self.s * y[1], 0.0)))

    def _acceleration(self, y: NDArray) -> float:
        return (self.pull(y[0], y[1]) - self.load * self._friction(y)) / self.slider.mass

    def _switch(self, y: NDArray, n: int) -> float:
        return float(self.law.switches(y[2:], self.s, max(self.s * y[1], 0.0))[n])

    def _rates(self, _: float, y: NDArray) -> list[float]:
        V = max(self.s * y[1], 0.0)
        turned = self.law.flow(y[2:], self.s, V)
        return [self.slider.drive_speed - y[1], self._acceleration(y), *turned]


def _event(of: Callable[..., float], direction: float, terminal: bool) -> Callable[..., float]:
    of.direction, of.terminal = direction, terminal  # type: ignore[attr-defined]
    return of
