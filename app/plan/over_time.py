"""Motions in time: which there are, and meshes, degrees and steps that reach a tolerance.

What is done to a punch over time: how its load comes on, which way it goes, what its friction is.

Of which scenes motions in time are known.

Which motions in time a scene asks for.

Rules by which motions in time are judged.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import groupby, pairwise
from math import ceil, log10, sqrt

import numpy as np
from numpy.polynomial.legendre import leggauss
from numpy.typing import ArrayLike, NDArray

from galinx.meshes.waves import Reached
from galinx.postprocess.over_time import BOTH, OF_FEM
from galinx.postprocess.quantities.quantity import FEM, SIE
from galinx.postprocess.surface_over_time import ALONG, AT_ENDS, BALANCE, WORKS
from galinx.postprocess.surface_over_time import OF_FEM as OF_SURFACE
from galinx.solvers.friction.integrate import INTEGRATORS
from galinx.solvers.friction.motion import follow
from galinx.solvers.layers.in_cells import LayersInCells
from galinx.solvers.layers.layered import Layered
from galinx.solvers.profiles.flat import Flat
from galinx.solvers.solids.solid import Response, Solid
from galinx.solvers.transient.admittance import InPlane
from galinx.solvers.transient.line_load import fastest
from galinx.solvers.transient.punch import smooth
from galinx.texts import counted

from ..errors import BadInput
from ..scene.scene import Scene
from .states import States

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


#: Tolerances that can be reached.
_TIGHTEST, _COARSEST = 1e-5, 1e-2
#: Least thickness of a layer over a.
_THINNEST = 0.1


def check_in_time(scene: Scene, methods: tuple[str, ...]) -> None:
    """Refuse scenes whose motions are not known.

    Args:
        scene: the scene.
        methods: those of its methods that follow motions in time.

    Raises:
        BadInput: it says why.
    """
    solid, tolerance = scene.solid, scene.solve.tolerance
    faults = []
    if not methods:
        faults.append("solve.methods has neither fem nor sie, which follow a start from rest")
    if not _TIGHTEST <= tolerance <= _COARSEST:
        faults.append(
            f"solve.tolerance: found {tolerance:g}, expected {_TIGHTEST:g} to {_COARSEST:g}, as in 1e-3"
        )
    if isinstance(solid, Layered):
        faults += _of_layers(scene, solid)
    elif not isinstance(solid.response(0.0), InPlane):
        faults.append("a start from rest is known of galinx's own solids, not of your own")
    if solid.nearly_incompressible:
        faults.append("a start from rest is known where ν is not near 1/2: pressure waves are too fast")
    if not isinstance(scene.punch.profile, Flat):
        faults.append("a start from rest is known of flat punches")
    if scene.time and scene.time.by_law and any(leg.speed is not None or leg.rest for leg in scene.legs):
        faults.append("strokes with a speed or a rest of their own are not followed in time")
    if scene.solve.mode != "contact":
        faults.append('a start from rest needs solve.mode = "contact"')
    if faults:
        raise BadInput("time: " + "; ".join(faults))


def _of_layers(scene: Scene, solid: Layered) -> list[str]:
    """What of layers is not known."""
    faults = []
    if any(layer.bottom for layer in solid.layers):
        faults.append("layers: found a graded one, expected uniform ones for motions in time")
    thinnest = min(layer.thickness for layer in solid.layers) / scene.body.half_width
    if thinnest < _THINNEST:
        faults.append(
            f"layers: found a thickness of {thinnest:.4g} a, expected at least {_THINNEST:g} a, the "
            "punch's half-width, for motions in time"
        )
    if not all(isinstance(one.response(0.0), InPlane) for one in solid.solids):
        faults.append("layers: found a solid of your own, expected galinx's for motions in time")
    if scene.time and scene.time.steady:
        faults.append('time.start: found "steady" over layers, expected "rest"')
    return faults


#: All of them.
IN_TIME = frozenset({BOTH, OF_FEM, WORKS, BALANCE, AT_ENDS, ALONG, OF_SURFACE})


def rules(both: bool, steady: bool, surface: bool, sharp: bool) -> frozenset[str]:
    """Names of those for finite elements.

    Args:
        both: does the integral equation follow these motions, too?
        steady: do they begin in steady motion?
        surface: is the surface looked at?
        sharp: are there waves that no cell holds? Of these the estimate is told, and nothing promised.
    """
    found = {OF_FEM, *(BOTH,) * both, *(WORKS, AT_ENDS) * (both and not steady)}
    if surface:
        found |= {BALANCE, *(ALONG,) * both, *(OF_SURFACE,) * (not sharp)}
    return frozenset(found)


#: Shortest time over a/c_s of friction that changes along a stroke for which steps and cells are made.
_QUICK = 1.0
#: Seconds measured on cores of 3 GHz, by unknowns to a power and by symbols of the integral equation.
_SET_UP, _STAGE, _SYMBOL = 3e-6, 3.5e-7, 0.12
#: Lowest degree that tells the moments from which K_I is read, highest one, and largest innermost cell
#: over a.
_LOWEST, _HIGHEST, _INNERMOST = 7, 12, 1e-4
#: Time over a/c_s within which waves cross the contact.
_CROSSED = 2.0
#: Distance over a times tolerance at which steady motion is held.
_HELD = 5.0
#: Size of a ring of cells at the edges over that of the ring outside it; where waves are sharp.
_RATIO, _SHARP_RATIO = 0.25, 0.5
#: Distance over a from the punch along the surface, and depth, up to which it may be looked at.
_SEEN = 2.0, 2.0
#: Side of cells over a then: waves ahead of the punch are short.
_SEEN_SIZE = 2.0 / 3.0
#: The same over the uppermost layer's thickness at most.
_OF_LAYER = 2.0
#: Steps by which the end is later for waves.
_EARLIER = 8
#: How much longer a cell further out may be at a tolerance of 1e-3, over its distance from the innermost
#: ones; so much less at a tenth of the tolerance; how much more where the error is measured.
_GROWTH, _FINER, _GROWN = 0.15, 0.4, 1.75
#: Side of cells next to the punch over a where things change within so many a/c_s, at a tolerance of
#: 1e-3, and so many more at each tenth of it; how much slower than the Rayleigh wave a punch has to be
#: for that: the wave ahead of a faster one is shorter. Within the last of these a degree more is taken.
_SIZE, _LONG, _LONGER, _SLOW, _SHORT = 2.0, 2.0, 1.5, 0.25, 0.15


@dataclass(frozen=True)
class Level:
    """What a solution in time is computed with.

    Attributes:
        mesh: as far as waves come that are back at the end, if they are not too short for its cells.
        degree: polynomial degree.
        every: how many steps of the finest level are one of this one.
    """

    mesh: Reached
    degree: int
    every: int

    @property
    def unknowns(self) -> int:
        """About as many as there are."""
        return 2 * self.degree**2 * len(self.mesh.drawn().cells)


@dataclass(frozen=True)
class Starts:
    """All starts of a scene.

    Attributes:
        drives: of the punch by speed over c_s.
        methods: that follow them.
        ways: from one turn to the next; the integral equation follows the first.
        load: over time.
        steady: do they begin in steady motion?
        tolerance: wanted, relative to the largest.
        every: time between those at which the surface is told over a/c_s, None for none.
        a: half-width of the punch [m].
    """

    drives: dict[float, tuple[Drive, ...]]
    methods: tuple[str, ...]
    ways: tuple[Way, ...]
    load: Load
    steady: bool
    tolerance: float
    every: float | None = None
    a: float = 1.0

    @property
    def steps(self) -> int:
        """Steps of the finite elements, an even number."""
        return sum(way.steps for way in self.ways)

    @property
    def end(self) -> float:
        """Last time over a/c_s."""
        return sum(way.duration for way in self.ways)

    def times(self, every: int = 1) -> NDArray[np.float64]:
        """Ends of the finite elements' steps over a/c_s, or of so many together."""
        h = [np.full(way.steps // every, every * way.duration / way.steps) for way in self.ways]
        return np.asarray(np.cumsum(np.concatenate(h)))

    @property
    def outputs(self) -> NDArray[np.int64]:
        """How many steps are done when the surface is told, an even number each."""
        wanted = np.arange(1.0, self.end / (every := self.every or np.inf) + 1e-6) * every
        return np.unique(2 * np.abs(np.subtract.outer(wanted, self.times(2))).argmin(axis=1) + 2)

    def dissipated(self, c: float, drive: Drive) -> NDArray[np.float64]:
        """∫ f V N dt after each step over N a: what friction takes, but for its second order."""
        return taken(self.ways, self.load, drive) * c

    def directions(self, drive: Drive) -> NDArray[np.float64]:
        """Ways ±1 along X in which the punch goes in each step, (steps,)."""
        return drive.way * np.repeat(
            [float(way.direction) for way in self.ways], [way.steps for way in self.ways]
        )

    @property
    def shortest(self) -> float:
        """Shortest time within which something changes over a/c_s."""
        ways = [way.stroke for way in self.ways if self.changing]
        frictions = [max(one.shortest, _QUICK) for many in self.drives.values() for one in many]
        return min(self.load.shortest, *ways, *frictions)

    @property
    def changing(self) -> bool:
        """Does friction change?"""
        return any(one.constant is None for many in self.drives.values() for one in many)

    @property
    def turns(self) -> bool:
        """Does the punch turn round?"""
        return len({way.direction for way in self.ways}) > 1

    @property
    def sharp(self) -> bool:
        """Are there waves that no cell holds? They begin at the edges, suddenly."""
        return self.turns or not self.tells_K_I

    @property
    def tells_K_I(self) -> bool:
        """Is the pressure smooth enough but for its exponents?

        What begins at an edge of the punch, suddenly, has to have crossed the contact before.
        """
        return not self.changing or self.shortest >= _CROSSED

    @property
    def count(self) -> int:
        """How many."""
        return sum(map(len, self.drives.values()))

    @property
    def rules(self) -> frozenset[str]:
        """Names of the rules by which what is found is judged."""
        if FEM not in self.methods:
            return frozenset()
        return rules(SIE in self.methods, self.steady, bool(self.every), self.sharp)

    def words(self, solid: Solid) -> list[str]:
        """What is done, one line a method."""
        begin = "from steady motion on" if self.steady else "from rest"
        what = f"{counted(self.count, 'start')} {begin}, to t = {self.end:g} a/c_s"
        turns = "" if len(self.ways) == 1 else (
            f"; only to t = {self.ways[0].duration:.6g} a/c_s, where the punch turns round"
        )  # fmt: skip
        lines = [f"integral equation in time: {what}{turns}"] if SIE in self.methods else []
        lines += ["no K_I over time: strokes are over before waves cross the contact"] * (
            not self.tells_K_I
        )
        if FEM in self.methods:
            for c in self.drives:
                _, level = self.levels(solid, c)
                lines.append(
                    f"finite elements in time at c = {c:g} (over c_s): {what}, {self.steps} steps, "
                    f"degree {level.degree}, about {level.unknowns} unknowns; one of a degree less and "
                    "twice the step, on larger cells, measures the error"
                )
        return lines

    def seconds(self, solid: Solid) -> float:
        """About how long all of it takes."""
        total = 0.0
        for c, of_speed in self.drives.items():
            if FEM in self.methods:
                for level in self.levels(solid, c):
                    n = level.unknowns
                    total += (
                        _SET_UP * n**1.5 + len(of_speed) * _STAGE * 5 * self.steps / level.every * n**1.1
                    )
            if SIE in self.methods:
                total += _SYMBOL * max(3.0 * self.ways[0].duration, self.ways[0].steps)
        return total

    def response(self, solid: Solid, c: float) -> Response:
        """Of a half-plane at a speed over c_s; of layers with lengths over a."""
        return LayersInCells(solid, c, self.a) if isinstance(solid, Layered) else solid.response(c)

    def levels(self, solid: Solid, c: float) -> tuple[Level, Level]:
        """A coarser level, which tells the error, and that which is archived.

        The coarser one has half as many steps, a degree less, and cells that grow faster, so that
        waves are taken for too short at little more than half the distance.
        """
        digits, gap = -log10(self.tolerance), solid.limit() - c
        degree = min(max(ceil(2.0 * digits + 1.75), _LOWEST), _HIGHEST)
        degree += (gap < _SHORT or isinstance(solid, Layered)) and degree < _HIGHEST
        innermost = min(10.0 ** -(1.2 * digits + 1.0), _INNERMOST)
        slow = min(1.0, gap / _SLOW) ** 0.5
        long = _LONG + _LONGER * max(digits - 3.0, 0.0)
        size = _SIZE * slow * min(1.0, self.shortest / long)
        size = min(size, _SEEN_SIZE * slow) if self.every else size
        growth = _GROWTH * _FINER ** (digits - 3.0)
        beyond = _HELD / self.tolerance if self.steady else 0.0
        ratio = _SHARP_RATIO if self.sharp else _RATIO
        width, depth = self._reach(fastest(self.response(solid, c)), c)
        depths: tuple[float, ...] = ()
        if isinstance(solid, Layered):
            depths = tuple((solid.depths / self.a).tolist())
            size = min(size * min(1.0, solid.slowest / solid.c_s), _OF_LAYER * depths[0])
        coarse, fine = (
            Reached(max(width, 3.0), max(depth, 2.0), size, of, innermost, beyond, ratio, depths)
            for of in (_GROWN * growth, growth)
        )
        return Level(coarse, degree - 1, 2), Level(fine, degree, 1)

    def _reach(self, fast: float, c: float) -> tuple[float, float]:
        """Half-width and depth from which the fastest wave is not back before the end.

        It comes back to a punch that has moved, or to what is looked at round it. Implicit steps let it
        be felt a little earlier.
        """
        T = self.end * (1.0 + _EARLIER / self.steps)
        beside, below = _SEEN if self.every else (0.0, 0.0)
        if self.turns:
            farthest = c * max(way.stroke for way in self.ways)
            return 1.0 + beside + fast * T / 2.0 + farthest, (fast * T + below) / 2.0
        ahead = 1.0 + T * (fast**2 - c**2) / (2.0 * fast)
        # On the way down and up the punch goes ahead by c T, but for what is looked at.
        down = sqrt((fast * T) ** 2 - max(c * T - 2.0 - 2.0 * beside, 0.0) ** 2) / 2.0
        return ahead + beside, down + below / 2.0


#: Starts of a scene at most, and unknowns of a mesh.
MOST, LARGEST = 24, 300_000
#: Largest step at a tolerance of 1e-3, of order four; and steps within which the load comes on.
_STEP, _OF_RAMP = 0.4, 8
#: Over layers steps are so much shorter: what echoes do to the centre of the pressure.
_OF_LAYERS = 3.5


def starts(scene: Scene, states: States) -> Starts | None:
    """The starts of a scene by its friction states, None where it asks for none.

    Raises:
        BadInput: they are known of other scenes only.
    """
    if scene.time is None:
        return None
    methods = tuple(name for name in (FEM, SIE) if name in scene.solve.methods)
    tolerance = scene.solve.tolerance
    check_in_time(scene, methods)
    load = load_of(scene)
    largest = min(_STEP, load.shortest / _OF_RAMP) / (_OF_LAYERS if scene.layers else 1.0)
    step = scene.time.step or largest * min(tolerance / 1e-3, 1.0) ** 0.3
    drives = _drives(scene, states)
    ways = ways_at(scene, next(iter(drives)), step)
    if methods == (SIE,) and len(ways) > 1:
        raise BadInput(
            f"solve.methods: found sie only, which knows no way back, and the punch turns round at "
            f"{ways[0].duration:.6g} a/c_s: expected fem, too, or time.end no later than that"
        )
    found = Starts(
        drives, methods, ways, load, scene.time.steady, tolerance, scene.time.every,
        scene.body.half_width,
    )  # fmt: skip
    if FEM in methods:
        _check_size(found, scene)
    return found


def _drives(scene: Scene, states: States) -> dict[float, tuple[Drive, ...]]:
    """Drives of all starts by speed.

    Raises:
        BadInput: there are too many, or their speed has no answer.
    """
    assert scene.time
    c = states.columns["c"]
    found: dict[float, tuple[Drive, ...]] = {}
    if scene.time.by_law:
        speeds = np.unique(c).tolist()
        if len(speeds) > 1 or speeds[0] == 0.0:
            raise BadInput(
                f'time.friction = "law": found {len(speeds)} speeds, the first {speeds[0]:g} over c_s; '
                "expected one that is not 0, for strokes of another take another time"
            )
        found[speeds[0]] = drives_at(scene, speeds[0])
    else:
        different = np.unique(np.column_stack([c, states.g, headings(scene, states.directions)]), axis=0)
        for speed, ratio, way in different.tolist():
            found[speed] = (*found.get(speed, ()), constant(round(way), ratio))
    if (many := sum(map(len, found.values()))) > MOST:
        raise BadInput(
            f"time: the scene has {many} states of different speed or friction, expected at most "
            f"{MOST}, each of which is followed in time: shorten its lists"
        )
    limit = scene.solid.limit()
    if fast := [f"{speed:g}" for speed in found if speed >= limit]:
        raise BadInput(
            f"time: c = {', '.join(fast)} is not below the Rayleigh speed {limit:.6g} (over c_s)"
        )
    return found


def _check_size(found: Starts, scene: Scene) -> None:
    for c in found.drives:
        _, level = found.levels(scene.solid, c)
        if level.unknowns > LARGEST:
            raise BadInput(
                f"time.end = {found.end:g} needs {level.unknowns} unknowns at c = {c:g}, as far "
                f"as waves come that are back by then, expected at most {LARGEST}: take an earlier "
                "end, a larger solve.tolerance, or a smaller Poisson's ratio"
            )
