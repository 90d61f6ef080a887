"""Plan of motions in time: loads, ways and friction over time, meshes, degrees and steps for a tolerance.

:func:`starts` lists the motions of a scene, and refuses what they do not cover; :class:`Starts` plans
their finite elements.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import groupby
from math import ceil, lcm, log10, sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.meshes.waves import Reached
from galinx.postprocess.over_time import IN_TIME, OF_SURFACE
from galinx.postprocess.quantities.quantity import FEM, SIE
from galinx.solvers.approximation import gauss_in_panels
from galinx.solvers.friction.integrate import INTEGRATORS
from galinx.solvers.friction.motion import Leg, Stroke, follow
from galinx.solvers.profiles.punches import is_level
from galinx.solvers.solids.half_plane import HalfPlane
from galinx.solvers.transient.history import Drive, Load, Way
from galinx.solvers.transient.line_load import fastest
from galinx.solvers.transient.punch import BOX
from galinx.texts import counted

from ..errors import BadInput
from ..scene.scene import Scene
from ..scene.sections import Time
from .states import States, headings

#: Least number of steps of a stroke, and of a motion whose step is not given.
_LEAST_STEPS = 12
#: Most parts of the time between outputs of which ends of strokes are multiples.
_PARTS = 12


def _ways(scene: Scene, c: float, largest: float) -> tuple[Way, ...]:
    """Steps of the punch at a speed over c_s, at most so long, up to the motion's end.

    The number of steps between turns is even. The first way has the direction 1. After a turn the first
    two steps are divided.

    Raises:
        BadInput: the strokes are over before the end.
    """
    assert scene.time
    end, every, t = scene.time.end, scene.time.every, 0.0
    strokes = [(1, [end], largest if scene.time.step else min(largest, end / _LEAST_STEPS))]
    if scene.time.by_law:
        strokes = []
        for direction, legs in groupby(scene.legs, lambda leg: leg.s * scene.legs[0].s):
            durations = _durations(scene, legs, c)
            strokes.append((direction, durations, min(largest, min(durations) / _LEAST_STEPS)))
    if every:
        turns = np.minimum(np.cumsum([sum(durations) for _, durations, _ in strokes]), end)
        part = _common_part(every, turns)
        # Steps that outputs and turns are multiples of do not double their number.
        every = part if part >= min(longest for _, _, longest in strokes) else every
    ways: list[Way] = []
    for direction, durations, longest in strokes:
        # A step less than a millionth of a stroke is rounding.
        if (duration := min(sum(durations), end - t)) <= 1e-6 * durations[0]:
            continue
        if every:  # an even number of steps is the time between outputs
            longest = every / (2.0 * ceil(every / longest / 2.0 - 1e-9))
        steps, finely = 2 * ceil(duration / longest / 2.0 - 1e-9), 0.0
        if ways and steps > 2:
            # In place of each of two steps 8 short ones: the pressure changes with the root of time.
            finely, steps = 2.0 * duration / steps, steps - 2
            ways.append(Way(direction, finely, 2 * 8))
        ways.append(Way(direction, duration - finely, steps))
        t += duration
    if end - t > 1e-6 * end:
        raise BadInput(
            f"time.end = {end:g} a/c_s: the strokes are over at {t:.6g} a/c_s at c = {c:g}, expected no "
            'later end, more strokes, or time.friction = "constant"'
        )
    return tuple(ways)


def _common_part(every: float, times: NDArray) -> float:
    """Largest part of a time of which it and other times are multiples; 0 where there is none."""
    shares = [Fraction(share).limit_denominator(_PARTS) for share in (times / every).tolist()]
    exact = np.allclose(np.array(shares, dtype=float) * every, times, rtol=1e-9, atol=0.0)
    return every / lcm(*(share.denominator for share in shares)) if exact else 0.0


def _durations(scene: Scene, legs: Iterable[Leg], c: float) -> list[float]:
    """Durations over a/c_s of strokes at a speed over c_s."""
    return [leg.length * scene.friction.pre_sliding / scene.body.half_width / c for leg in legs]


def _drives_by_law(scene: Scene, c: float) -> tuple[Drive, ...]:
    """Drives under each law of a scene along its strokes at a speed over c_s, from rest at X = 0.

    Raises:
        BadInput: the law refuses its parameters.
    """
    assert scene.time
    friction, V = scene.friction, c * scene.solid.c_s
    durations = np.array(_durations(scene, scene.legs, c))
    starts = np.concatenate([[0.0], np.cumsum(durations)[:-1]])
    # A stroke is followed as long as the motion lasts; later ones have no part in it.
    lasting = np.clip(scene.time.end - starts, _LEAST_LASTING * durations, durations)
    (way,) = headings(scene, [scene.legs[0].s]).tolist()
    drives = []
    try:
        for law in friction.laws():

            def over_time(times: list[NDArray]) -> list[Stroke]:
                shares = (t / duration for t, duration in zip(times, durations))
                places = [leg.start + (leg.end - leg.start) * of for leg, of in zip(scene.legs, shares)]
                integrator = INTEGRATORS[friction.integrator]
                return follow(law, scene.legs, friction.pre_sliding, places, V, integrator)  # noqa: B023

            begun, times = over_time([np.zeros(1)] * len(lasting)), list[NDArray]()
            for leg, stroke, end in zip(scene.legs, begun, lasting.tolist()):
                kinks = law.kinks(stroke.z[0], leg.s, V) / (c * scene.body.half_width)
                within = kinks[(kinks > 0.0) & (kinks < end)]
                times.append(np.union1d(np.linspace(0.0, end, 1 + _INTERVALS), within))
            along = _interpolated(
                lambda times: [friction.stress_ratio * stroke.f for stroke in over_time(times)],
                times,
            )
            drives.append(Drive(way, None, tuple(starts.tolist()), along))
    except ValueError as error:
        raise BadInput(f"friction: {error}") from None
    return tuple(drives)


#: Least part of a stroke that is followed; intervals of time at first, and where they are cut: in their
#: middle a polynomial between two kinks would meet a straight line.
_LEAST_LASTING, _INTERVALS, _CUT = 1e-6, 128, 0.382
#: Accuracy of friction between two times, most cuts of an interval, and most times of a stroke.
_FOLLOWED, _CUTS, _TIMES = 1e-7, 40, 20_000


def _interpolated(
    over_time: Callable[[list[NDArray]], list[NDArray]], times: list[NDArray]
) -> tuple[Any, ...]:
    """Friction of each stroke over the time since its beginning, SciPy's polynomials by pieces.

    Intervals of time are cut until a place in each is what its neighbours say.

    Args:
        over_time: friction of all strokes at rising times of each, (n,) each.
        times: rising times of each stroke to begin with, from 0 on, kinks of friction among them.
    """
    from scipy.interpolate import PchipInterpolator  # a slow import

    along = [PchipInterpolator(*of) for of in zip(times, over_time(times))]
    rough = [np.ones(len(t) - 1, dtype=bool) for t in times]
    for _ in range(_CUTS):
        places = [(t[:-1] + _CUT * np.diff(t))[of_drive] for t, of_drive in zip(times, rough)]
        expected = [g(t) for g, t in zip(along, places)]
        times = [np.union1d(t, more) for t, more in zip(times, places)]
        g = over_time(times)
        along = [PchipInterpolator(*of) for of in zip(times, g)]
        rough = []
        for t, of, place, was in zip(times, g, places, expected):
            at = np.searchsorted(t, place)
            off = at[np.abs(of[at] - was) > _FOLLOWED]
            around = np.clip(np.add.outer(off, [-2, -1, 0, 1]).ravel(), 0, len(t) - 2)
            rough.append(np.isin(np.arange(len(t) - 1), around) & (len(t) < _TIMES))
        if not any(of_drive.any() for of_drive in rough):
            break
    return tuple(along)


#: Tightest and loosest tolerance of motions in time.
_TIGHTEST, _COARSEST = 1e-5, 1e-2
#: Least thickness over a of a layer under motions in time.
_THINNEST = 0.1


def _check(scene: Scene, methods: tuple[str, ...]) -> None:
    """Refuse scenes whose motions in time cannot be computed, by these of their methods.

    Raises:
        BadInput: the message lists all reasons.
    """
    assert scene.time
    tolerance, layers = scene.solve.tolerance, scene.layers
    thinnest = min((layer.thickness for layer in layers), default=np.inf) / scene.body.half_width
    by_law = scene.time.by_law
    faults = {
        f"found a {scene.punch.profile.words()}; a start from rest is computed for level flat punches":
            not is_level(scene.punch.profile),
        "solve.methods has neither fem nor sie, which follow a start from rest": not methods,
        f"solve.tolerance: found {tolerance:g}, expected {_TIGHTEST:g} to {_COARSEST:g}, as in 1e-3":
            not _TIGHTEST <= tolerance <= _COARSEST,
        "layers: found a graded one, expected uniform ones for motions in time":
            any(layer.bottom for layer in layers),
        f"layers: found a thickness of {thinnest:.4g} a, expected at least {_THINNEST:g} a, the "
        "punch's half-width, for motions in time": thinnest < _THINNEST,
        'time.start: found "steady" over layers, expected "rest"': bool(layers) and scene.time.steady,
        "a start from rest is computed where ν is not near 1/2: pressure waves are too fast":
            scene.solid.nearly_incompressible,
        "strokes with a speed or a rest of their own are not computed in time":
            by_law and any(leg.speed is not None or leg.rest for leg in scene.legs),
        'a start from rest needs solve.mode = "contact"': scene.solve.mode != "contact",
    }  # fmt: skip
    if any(faults.values()):
        raise BadInput("time: " + "; ".join(fault for fault, holds in faults.items() if holds))


#: Highest degree.
_HIGHEST = 12


@dataclass(frozen=True)
class Level:
    """Discretisation of a solution in time.

    Attributes:
        mesh: reaches as far as waves that are back at the end, if they are not too short for its cells.
        degree: polynomial degree.
        every: number of steps of the finest level in one of this level.
    """

    mesh: Reached
    degree: int
    every: int

    @property
    def unknowns(self) -> int:
        """Estimated number of unknowns."""
        return 2 * self.degree**2 * len(self.mesh.drawn().cells)


@dataclass(frozen=True)
class Starts:
    """All motions in time of a scene.

    Attributes:
        scene: the scene, whose tolerance is relative to the largest value over time.
        time: its section [time].
        drives: of the punch by speed over c_s.
        methods: names of the methods that compute them.
        ways: steps of the finite elements, an even number of each; directions from that of the first
            stroke, 1, on. The integral equation computes the first way.
        load: over time.
    """

    scene: Scene
    time: Time
    drives: dict[float, tuple[Drive, ...]]
    methods: tuple[str, ...]
    ways: tuple[Way, ...]
    load: Load

    @property
    def steps(self) -> int:
        """Number of steps of the finite elements, even."""
        return sum(way.steps for way in self.ways)

    @property
    def end(self) -> float:
        """Last time over a/c_s."""
        return sum(way.duration for way in self.ways)

    def times(self, every: int = 1) -> NDArray[np.float64]:
        """Ends over a/c_s of the finite elements' steps, or of every ``every`` steps together."""
        h = [np.full(way.steps // every, every * way.h) for way in self.ways]
        return np.asarray(np.cumsum(np.concatenate(h)))

    @property
    def outputs(self) -> NDArray[np.int64]:
        """Numbers of steps that precede each output of the surface, all even; (outputs,)."""
        times = np.arange(1.0, self.end / (every := self.time.every or np.inf) + 1e-6) * every
        return np.unique(2 * np.abs(np.subtract.outer(times, self.times(2))).argmin(axis=1) + 2)

    def directions(self, drive: Drive) -> NDArray[np.float64]:
        """Direction ±1 of the punch along X in each step, (steps,)."""
        ways = [float(drive.way * way.direction) for way in self.ways]
        return np.repeat(ways, [way.steps for way in self.ways])

    def dissipated(self, c: float, drive: Drive) -> NDArray[np.float64]:
        """Work ∫ f V N dt of friction after each step over N a, but for its second order; (steps,)."""
        t, w = gauss_in_panels(np.append(0.0, self.times()), 4)
        power = np.reshape(-drive(t) * self.load(t) * w, (self.steps, -1)).sum(axis=1)
        return np.asarray(c * np.cumsum(self.directions(drive) * power))

    @property
    def strokes(self) -> list[float]:
        """Durations over a/c_s from turn to turn, as far as the motion lasts."""
        return [
            sum(way.duration for way in ways) for _, ways in groupby(self.ways, lambda way: way.direction)
        ]

    @cached_property
    def shortest(self) -> float:
        """Shortest time over a/c_s within which load, direction or friction changes."""
        # Steps and cells are made for a friction that changes within 1 a/c_s, and for no faster one.
        strokes = self.strokes if self.changing else ()
        return min(self.load.shortest, *strokes, max(self.shortest_of_friction, 1.0))

    @property
    def shortest_of_friction(self) -> float:
        """Shortest time over a/c_s of a change of friction by 1, infinite where it is constant."""
        return min(drive.shortest for drives in self.drives.values() for drive in drives)

    @property
    def changing(self) -> bool:
        """True where the friction of a drive changes over time."""
        return any(drive.constant is None for drives in self.drives.values() for drive in drives)

    @property
    def sharp(self) -> bool:
        """True where waves are too sharp for cells: they begin at the edges, suddenly."""
        return len(self.strokes) > 1 or not self.smooth

    @property
    def smooth(self) -> bool:
        """True where the pressure is smooth enough for K_I, but for its exponents at the edges.

        A wave that begins at an edge of the punch, suddenly, has to cross the contact before, which
        takes it 2 a/c_s.
        """
        return not self.changing or self.shortest >= 2.0

    @property
    def count(self) -> int:
        """Number of motions."""
        return sum(map(len, self.drives.values()))

    @property
    def rules(self) -> frozenset[str]:
        """Names of the rules by which results are checked, where these have what the rules need."""
        # Waves that are too sharp for cells have an estimate without a bound.
        return IN_TIME - {OF_SURFACE} if self.sharp else IN_TIME

    @property
    def until_turn(self) -> str:
        """Time up to which the integral equation follows the motion, in words; "" for all of it."""
        if SIE not in self.methods or len(self.strokes) == 1:
            return ""
        return (
            f"only to t = {self.strokes[0]:.6g} a/c_s, where the punch turns round: the equation is of a "
            "constant velocity"
        )

    def words(self) -> list[str]:
        """Plan in words, one line for each method."""
        begin = "from steady motion on" if self.time.steady else "from rest"
        what = f"{counted(self.count, 'start')} {begin}, to t = {self.end:g} a/c_s"
        turn = f"; {self.until_turn}" * bool(self.until_turn)
        lines = [f"integral equation in time: {what}{turn}"] if SIE in self.methods else []
        if not self.smooth:
            lines.append("no K_I over time: load, friction or direction changes within 2 a/c_s")
        for c in self.drives if FEM in self.methods else ():
            _, level = self.levels(c)
            lines.append(
                f"finite elements in time at c = {c:g} (over c_s): {what}, {self.steps} steps, "
                f"degree {level.degree}, about {level.unknowns} unknowns; one of a degree less and "
                "twice the step, on larger cells, measures the error"
            )
        return lines

    def response(self, c: float) -> HalfPlane:
        """HalfPlane of the solid at a speed over c_s; of layers with lengths over a."""
        return self.scene.solid.response(c, self.scene.body.half_width)

    def levels(self, c: float) -> tuple[Level, Level]:
        """Two levels: a coarser one, which measures the error, and the one that is archived.

        The coarser one has half as many steps, a degree less, and cells that grow faster, so that
        waves are too short for cells from little more than half the distance on. Steady motion is held at
        less than half the distance, to whose inverse its error is proportional.
        """
        digits, gap = -log10(self.scene.solve.tolerance), self.scene.solid.limit() - c
        depths = tuple((self.scene.solid.depths / self.scene.body.half_width).tolist())
        # No lower degree than 7 resolves the moments from which K_I is recovered. Near the Rayleigh
        # speed waves ahead of the punch are short, and take a degree more, as fast changes of load do.
        degree = min(max(ceil(2.0 * digits + 1.75), 7), _HIGHEST)
        fast = self.load.shortest < 1.25
        degree += (gap < 0.15 or bool(depths) or fast) and degree < _HIGHEST
        innermost = min(10.0 ** -(1.2 * digits + 1.0), 1e-4)
        # Cells next to the punch have a side of 2 a where nothing changes within 2 a/c_s at a tolerance
        # of 1e-3, within 1.5 a/c_s more at each tenth of it, and the speed is 0.25 c_s below Rayleigh's.
        slow = min(1.0, gap / 0.25) ** 0.5
        long = 2.0 + 1.5 * max(digits - 3.0, 0.0)
        size = 2.0 * slow * min(1.0, self.shortest / long)
        ahead = min(size, 2.0 / 3.0 * slow) if self.time.every else size  # short waves ahead are output
        # A cell further out is longer by a share of its distance from the innermost ones, 1.75 times as
        # much where the error is measured; all the less where short waves follow a faster change.
        growth = 0.15 * 0.4 ** (digits - 3.0) * min(1.0, self.shortest / 2.0) ** 2
        # Distance over a of the boundary at which steady motion is held.
        beyond = 5.0 / self.scene.solve.tolerance if self.time.steady else 0.0
        ratio = 0.5 if self.sharp else 0.25  # of a ring of cells at the edges over the one outside it
        width, depth = self._reach(fastest(self.response(c)), c)
        if depths:
            slower = min(1.0, self.scene.solid.slowest / self.scene.solid.c_s)
            size, ahead = (min(side * slower, 2.0 * depths[0]) for side in (size, ahead))
        coarse, fine = (
            Reached(
                max(width, 3.0), max(depth, 2.0), size, of, innermost, held, ratio, depths, ahead,
                (BOX[0] + 1.0, BOX[1]),
            )
            for of, held in ((1.75 * growth, 0.4 * beyond), (growth, beyond))
        )  # fmt: skip
        return Level(coarse, degree - 1, 2), Level(fine, degree, 1)

    def _reach(self, fast: float, c: float) -> tuple[float, float]:
        """Half-width and depth over a from which the fastest wave is not back before the end.

        It comes back to a punch that has moved, or to the output places around it. With implicit steps
        it arrives a little earlier, by 8 steps at most.
        """
        T = self.end * (1.0 + 8 / self.steps)
        beside, below = (BOX[0] - 1.0, BOX[1]) if self.time.every else (0.0, 0.0)
        if len(self.strokes) > 1:
            farthest = c * max(self.strokes)
            return 1.0 + beside + fast * T / 2.0 + farthest, (fast * T + below) / 2.0
        ahead = 1.0 + T * (fast**2 - c**2) / (2.0 * fast)
        # On the way down and up the punch goes ahead by c T, but for the places of outputs.
        down = sqrt((fast * T) ** 2 - max(c * T - 2.0 - 2.0 * beside, 0.0) ** 2) / 2.0
        return ahead + beside, down + below / 2.0


#: Most motions in time of a scene, and most unknowns of a mesh.
MOST, LARGEST = 24, 300_000


def starts(scene: Scene, states: States) -> Starts | None:
    """The motions in time of a scene, None without section [time].

    Args:
        scene: the scene.
        states: its friction.

    Raises:
        BadInput: motions in time of this scene cannot be computed.
    """
    if scene.time is None:
        return None
    methods = tuple(name for name in (FEM, SIE) if name in scene.solve.methods)
    tolerance, steady = scene.solve.tolerance, scene.time.steady
    _check(scene, methods)
    comes_on = ((0.0, 1.0),) if steady else ((0.0, 0.0), (scene.time.load_ramp, 1.0))
    load = Load(scene.time.load or comes_on)
    # At a tolerance of 1e-3 steps, of order four, are at most 0.4 a/c_s and 1/9.5 of a ramp; shorter
    # over layers, whose echoes move the centre of the pressure.
    largest = min(0.4, load.shortest / 9.5) / (3.5 if scene.layers else 1.0)
    step = scene.time.step or largest * min(tolerance / 1e-3, 1.0) ** 0.3
    drives = _drives(scene, states)
    ways = _ways(scene, next(iter(drives)), step)
    if methods == (SIE,) and len(ways) > 1:
        raise BadInput(
            f"solve.methods: found sie only, which computes no way back, and the punch turns round at "
            f"{ways[0].duration:.6g} a/c_s: expected fem, too, or time.end no later than that"
        )
    planned = Starts(scene, scene.time, drives, methods, ways, load)
    for c in drives if FEM in methods else ():
        if (unknowns := planned.levels(c)[1].unknowns) > LARGEST:
            raise BadInput(
                f"time.end = {planned.end:g} needs {unknowns} unknowns at c = {c:g}, as far "
                f"as waves come that are back by then, expected at most {LARGEST}: take an earlier "
                "end, a larger solve.tolerance, or a smaller Poisson's ratio"
            )
    _check_flutter(planned, states)
    return planned


def _check_flutter(planned: Starts, states: States) -> None:
    """Refuse frictions under which short waves grow without bound: no motion in time exists.

    Raises:
        BadInput: a friction reaches the flutter threshold of its sign.
    """
    columns = states.columns
    for c, drives in planned.drives.items():
        g = np.concatenate([drive(planned.times()) for drive in drives])
        for sign, way in (("positive", 1.0), ("negative", -1.0)):
            threshold = np.nan_to_num(columns[f"flutter_{sign}"], nan=np.inf)[columns["c"] == c].min()
            if (largest := float((way * g).max())) >= threshold:
                raise BadInput(
                    f"time: |σ_XY/σ_YY| reaches {largest:.4g} at c = {c:g} (over c_s), and from "
                    f"{threshold:.4g} on, the flutter threshold, short waves along the interface grow "
                    "without bound: no motion in time exists; expected less friction"
                )


def _drives(scene: Scene, states: States) -> dict[float, tuple[Drive, ...]]:
    """Drives of all motions by speed over c_s.

    Raises:
        BadInput: there are too many, or a speed is not below the Rayleigh speed.
    """
    assert scene.time
    c = states.columns["c"]
    drives: dict[float, tuple[Drive, ...]] = {}
    if scene.time.by_law:
        speeds = np.unique(c).tolist()
        if len(speeds) > 1 or speeds[0] == 0.0:
            raise BadInput(
                f'time.friction = "law": found {len(speeds)} speeds, the first {speeds[0]:g} over c_s; '
                "expected one that is not 0, for strokes of another take another time"
            )
        drives[speeds[0]] = _drives_by_law(scene, speeds[0])
    else:
        each = zip(c.tolist(), states.g.tolist(), headings(scene, states.directions).tolist())
        for speed, ratio, way in dict.fromkeys(each):
            drives[speed] = (*drives.get(speed, ()), Drive(way, ratio))
    if (many := sum(map(len, drives.values()))) > MOST:
        raise BadInput(
            f"time: the scene has {many} states of different speed or friction, expected at most "
            f"{MOST}, each of which is computed in time: shorten its lists"
        )
    limit = scene.solid.limit()
    if fast := [f"{speed:g}" for speed in drives if speed >= limit]:
        raise BadInput(
            f"time: c = {', '.join(fast)} is not below the Rayleigh speed {limit:.6g} (over c_s)"
        )
    return drives
