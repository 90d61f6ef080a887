"""What is done to a punch over time: how its load comes on, which way it goes, what its friction is."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import groupby, pairwise
from math import ceil

import numpy as np
from numpy.polynomial.legendre import leggauss
from numpy.typing import ArrayLike, NDArray

from galinx.app.errors import BadInput
from galinx.app.scene.scene import Scene
from galinx.solvers.friction.integrate import INTEGRATORS
from galinx.solvers.friction.strokes import follow
from galinx.solvers.transient.punch import smooth

#: Places of a stroke between which friction is interpolated; steps of a stroke at least.
_PLACES, _OF_STROKE = 801, 12
#: Points of the rule that tells work in a step.
_RULE = 4
#: Steps instead of one after a turn.
_FINELY = 8


@dataclass(frozen=True)
class Load:
    """The load over time, smooth from each point to the next.

    Attributes:
        points: time over a/c_s and share of N, from t = 0 on.
    """

    points: tuple[tuple[float, float], ...]

    def __call__(self, t: ArrayLike) -> NDArray[np.float64]:
        """Share of N at times t."""
        t = np.asarray(t, dtype=float)
        found = np.full(t.shape, self.points[0][1])
        for (before, low), (after, high) in pairwise(self.points):
            found = found + (high - low) * smooth(t - before, after - before)
        return found

    @property
    def shortest(self) -> float:
        """Shortest time within which it changes, infinite if it does not."""
        return min((after[0] - before[0] for before, after in pairwise(self.points)), default=np.inf)


@dataclass(frozen=True)
class Way:
    """Strokes in one direction, or what there is time for of them.

    Attributes:
        direction: 1 as the first of all strokes, -1 the other way.
        duration: over a/c_s.
        steps: of the finite elements, an even number.
        part_of: duration of the whole where this is a part of it, else 0.
    """

    direction: int
    duration: float
    steps: int
    part_of: float = 0.0

    @property
    def stroke(self) -> float:
        """Duration of the whole."""
        return self.part_of or self.duration

    @property
    def begun_finely(self) -> "tuple[Way, ...]":
        """In two parts, the first two steps in shorter ones.

        Where the punch has turned round the pressure changes with the root of time.
        """
        if self.steps <= 2:
            return (self,)
        first = 2.0 * self.duration / self.steps
        return (
            Way(self.direction, first, 2 * _FINELY, self.duration),
            Way(self.direction, self.duration - first, self.steps - 2, self.duration),
        )


@dataclass(frozen=True)
class Drive:
    """Which way a punch goes, and σ_XY/σ_YY under it over time.

    Attributes:
        way: ±1, in which the first stroke goes along X.
        starts: times at which strokes begin over a/c_s.
        along: σ_XY/σ_YY of each stroke, by the time since then.
    """

    way: int
    starts: tuple[float, ...]
    along: tuple[Callable[[float], float], ...]

    def __call__(self, t: float) -> float:
        """σ_XY/σ_YY at a time over a/c_s; where a stroke ends, that at its end."""
        at = max(int(np.searchsorted(self.starts, t - 1e-9 * (1.0 + t), side="left")) - 1, 0)
        return float(self.along[at](t - self.starts[at]))

    @cached_property
    def constant(self) -> float | None:
        """Its value, None where it changes."""
        return self.along[0](0.0) if isinstance(self.along[0], _Constant) else None

    @cached_property
    def shortest(self) -> float:
        """Time over a/c_s in which it would change by 1 where it changes fastest."""
        from scipy.interpolate import PchipInterpolator  # a slow import

        slopes = [
            float(np.abs(one(one.x, 1)).max()) for one in self.along if isinstance(one, PchipInterpolator)
        ]
        return 1.0 / max(*slopes, 0.0) if any(slopes) else np.inf


@dataclass(frozen=True)
class _Constant:
    value: float

    def __call__(self, _: float) -> float:
        return self.value


def constant(way: int, g: float) -> Drive:
    """One way under friction that does not change."""
    return Drive(way, (0.0,), (_Constant(g),))


def headings(scene: Scene, directions: ArrayLike) -> NDArray[np.int64]:
    """Ways ±1 along X in which strokes go.

    By the study's Eq 25 friction under a forward stroke is that of a punch that goes towards -X.

    Args:
        scene: says which sign friction has.
        directions: of the strokes, 1 forward, -1 backward.
    """
    return np.asarray(directions, dtype=np.int64) * round(-scene.friction.stress_ratio)


def load_of(scene: Scene) -> Load:
    """The load that a scene asks for."""
    assert scene.time
    if scene.time.load:
        return Load(scene.time.load)
    return Load(((0.0, 1.0),) if scene.time.steady else ((0.0, 0.0), (scene.time.load_ramp, 1.0)))


def ways_at(scene: Scene, c: float, largest: float) -> tuple[Way, ...]:
    """From one turn to the next at a speed until the end, in steps of at most so much.

    Raises:
        BadInput: they are over before.
    """
    assert scene.time
    end = scene.time.end
    if not scene.time.by_law:
        return (_way(1, end, _dividing(scene, largest)),)
    first = scene.legs[0].s
    ways: list[Way] = []
    t = 0.0
    for direction, legs in groupby(scene.legs, lambda leg: leg.s):
        durations = [leg.length * _whole(scene) / c for leg in legs]
        # A step less than a millionth of a stroke is rounding.
        if (left := min(sum(durations), end - t)) > 1e-6 * durations[0]:
            way = _way(
                direction * first, left, _dividing(scene, min(largest, min(durations) / _OF_STROKE))
            )
            ways += way.begun_finely if ways else (way,)
            t += left
    if end - t > 1e-6 * end:
        raise BadInput(
            f"time.end = {end:g} a/c_s: the strokes are over at {t:.6g} a/c_s at c = {c:g}, expected no "
            'later end, more strokes, or time.friction = "constant"'
        )
    return tuple(ways)


def _dividing(scene: Scene, largest: float) -> float:
    """A step of which an even number is the time from one look at the surface to the next, if any."""
    assert scene.time
    if scene.time.every is None or scene.time.step:
        return largest
    return scene.time.every / (2.0 * ceil(scene.time.every / largest / 2.0 - 1e-9))


def _way(direction: int, duration: float, largest: float) -> Way:
    return Way(direction, duration, 2 * ceil(duration / largest / 2.0 - 1e-9))


def _whole(scene: Scene) -> float:
    """Length of a stroke over a."""
    return scene.friction.pre_sliding / scene.body.half_width


def drives_at(scene: Scene, c: float) -> tuple[Drive, ...]:
    """Drives under each law of a scene along its strokes at a speed, from rest at X = 0.

    Raises:
        BadInput: the law refuses its parameters.
    """
    from scipy.interpolate import PchipInterpolator

    friction, length, V = scene.friction, scene.friction.pre_sliding, c * scene.solid.c_s
    shares = np.linspace(0.0, 1.0, _PLACES)
    places = [leg.start + (leg.end - leg.start) * shares for leg in scene.legs]
    durations = np.array([leg.length * _whole(scene) / c for leg in scene.legs])
    starts = (0.0, *np.cumsum(durations)[:-1].tolist())
    (way,) = headings(scene, [scene.legs[0].s]).tolist()
    found = []
    try:
        for law in friction.laws():
            strokes = follow(law, scene.legs, length, places, V, INTEGRATORS[friction.integrator])
            along = [
                PchipInterpolator(shares * duration, friction.stress_ratio * stroke.f)
                for stroke, duration in zip(strokes, durations)
            ]
            found.append(Drive(way, starts, tuple(along)))
    except ValueError as error:
        raise BadInput(f"friction: {error}") from None
    return tuple(found)


def taken(ways: tuple[Way, ...], load: Load, drive: Drive) -> NDArray[np.float64]:
    """∫ -σ_XY/σ_YY ±N dt after each step over N a/c_s, + towards +X: what friction takes at unit speed.

    Args:
        ways: of the punch.
        load: share of N.
        drive: of the punch.
    """
    x, w = leggauss(_RULE)
    found, t0 = [], 0.0
    for way in ways:
        h = way.duration / way.steps
        for n in range(way.steps):
            t = t0 + h * (n + (1.0 + x) / 2.0)
            power = drive.way * way.direction * -np.array(list(map(drive, t))) * load(t)
            found.append(h / 2.0 * float(w @ power))
        t0 += way.duration
    return np.cumsum(found)
