"""Plan of motions in time: loads, ways and friction over time, meshes, degrees and steps for a tolerance.

:class:`Load`, :class:`Way` and :class:`Drive` are the history of a punch: its load, its direction and
σ_XY/σ_YY under it. :func:`check_in_time` refuses scenes that motions in time do not cover. :func:`starts`
lists the motions of a scene, and :class:`Starts` plans their finite elements.
"""

from dataclasses import dataclass
from functools import cached_property
from itertools import groupby, pairwise
from math import ceil, log10, sqrt
from typing import Any

import numpy as np
from numpy.polynomial.legendre import leggauss
from numpy.typing import ArrayLike, NDArray

from galinx.meshes.waves import Reached
from galinx.postprocess.over_time import OF_SIE, rules
from galinx.postprocess.quantities.quantity import FEM, SIE
from galinx.solvers.friction.integrate import INTEGRATORS
from galinx.solvers.friction.motion import follow
from galinx.solvers.profiles.punches import Flat
from galinx.solvers.solids.half_plane import HalfPlane
from galinx.solvers.solids.solid import Solid
from galinx.solvers.transient.line_load import fastest
from galinx.solvers.transient.punch import smooth
from galinx.texts import counted

from ..errors import BadInput
from ..scene.scene import Scene
from .states import States

#: Positions on a stroke between which friction is interpolated; fewest steps of a stroke.
_PLACES, _OF_STROKE = 801, 12
#: Number of short steps in place of one after a turn.
_FINELY = 8


@dataclass(frozen=True)
class Load:
    """The load over time, smooth from each point to the next.

    Attributes:
        points: times over a/c_s and loads over N, from t = 0 on.
    """

    points: tuple[tuple[float, float], ...]

    def __call__(self, t: ArrayLike) -> NDArray[np.float64]:
        """Load over N at times t over a/c_s, in the shape of t."""
        t = np.asarray(t, dtype=float)
        share = np.full(t.shape, self.points[0][1])
        for (before, low), (after, high) in pairwise(self.points):
            share = share + (high - low) * smooth(t - before, after - before)
        return share

    @property
    def shortest(self) -> float:
        """Shortest time over a/c_s from a point to the next, infinite where the load is constant."""
        return min((after[0] - before[0] for before, after in pairwise(self.points)), default=np.inf)


@dataclass(frozen=True)
class Way:
    """Strokes in one direction from one turn to the next, as far as the motion lasts.

    Attributes:
        direction: 1 as the first of all strokes, -1 the other way.
        duration: over a/c_s.
        steps: number of steps of the finite elements, even.
        part_of: duration over a/c_s of the whole way where this is a part of it, else 0.
    """

    direction: int
    duration: float
    steps: int
    part_of: float = 0.0

    @property
    def stroke(self) -> float:
        """Duration of the whole way over a/c_s."""
        return self.part_of or self.duration

    @property
    def begun_finely(self) -> "tuple[Way, ...]":
        """The way in two parts, with shorter steps in place of the first two.

        After a turn of the punch the pressure changes with the root of time.
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
    """Direction of a punch, and σ_XY/σ_YY under it over time.

    Attributes:
        way: ±1, direction of the first stroke along X.
        constant: σ_XY/σ_YY where it is constant, None where it changes.
        starts: times at which strokes begin over a/c_s.
        along: σ_XY/σ_YY of each stroke where it changes, a polynomial by pieces of the time since its
            beginning over a/c_s.
    """

    way: int
    constant: float | None = None
    starts: tuple[float, ...] = ()
    along: tuple[Any, ...] = ()

    def __call__(self, t: float) -> float:
        """σ_XY/σ_YY at a time over a/c_s; where a stroke ends, that at its end."""
        if self.constant is not None:
            return self.constant
        at = max(int(np.searchsorted(self.starts, t - 1e-9 * (1.0 + t), side="left")) - 1, 0)
        return float(self.along[at](t - self.starts[at]))

    @cached_property
    def shortest(self) -> float:
        """Inverse of the largest rate of σ_XY/σ_YY, a time over a/c_s; infinite where it is constant."""
        slopes = [float(np.abs(g(g.x, 1)).max()) for g in self.along]
        return 1.0 / max(*slopes, 0.0) if any(slopes) else np.inf


def headings(scene: Scene, directions: ArrayLike) -> NDArray[np.int64]:
    """Directions ±1 of strokes along X.

    By the study's Eq 25 friction under a forward stroke is that of a punch that moves towards -X.

    Args:
        scene: gives the sign of friction.
        directions: of the strokes, 1 forward, -1 backward.
    """
    return np.asarray(directions, dtype=np.int64) * round(-scene.friction.stress_ratio)


def load_of(scene: Scene) -> Load:
    """The load of a scene over time."""
    assert scene.time
    if scene.time.load:
        return Load(scene.time.load)
    return Load(((0.0, 1.0),) if scene.time.steady else ((0.0, 0.0), (scene.time.load_ramp, 1.0)))


def ways_at(scene: Scene, c: float, largest: float) -> tuple[Way, ...]:
    """Ways of the punch from turn to turn at a speed, until the motion's end.

    Args:
        scene: the scene.
        c: speed over c_s.
        largest: longest step over a/c_s.

    Raises:
        BadInput: the strokes are over before the end.
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
        if (duration := min(sum(durations), end - t)) > 1e-6 * durations[0]:
            way = _way(
                direction * first, duration, _dividing(scene, min(largest, min(durations) / _OF_STROKE))
            )
            ways += way.begun_finely if ways else (way,)
            t += duration
    if end - t > 1e-6 * end:
        raise BadInput(
            f"time.end = {end:g} a/c_s: the strokes are over at {t:.6g} a/c_s at c = {c:g}, expected no "
            'later end, more strokes, or time.friction = "constant"'
        )
    return tuple(ways)


def _dividing(scene: Scene, largest: float) -> float:
    """Longest step over a/c_s of which an even number is the time between outputs of the surface."""
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
    """Drives under each law of a scene along its strokes at a speed over c_s, from rest at X = 0.

    Raises:
        BadInput: the law refuses its parameters.
    """
    from scipy.interpolate import PchipInterpolator  # a slow import

    friction, length, V = scene.friction, scene.friction.pre_sliding, c * scene.solid.c_s
    shares = np.linspace(0.0, 1.0, _PLACES)
    places = [leg.start + (leg.end - leg.start) * shares for leg in scene.legs]
    durations = np.array([leg.length * _whole(scene) / c for leg in scene.legs])
    starts = (0.0, *np.cumsum(durations)[:-1].tolist())
    (way,) = headings(scene, [scene.legs[0].s]).tolist()
    drives = []
    try:
        for law in friction.laws():
            strokes = follow(law, scene.legs, length, places, V, INTEGRATORS[friction.integrator])
            along = [
                PchipInterpolator(shares * duration, friction.stress_ratio * stroke.f)
                for stroke, duration in zip(strokes, durations)
            ]
            drives.append(Drive(way, None, starts, tuple(along)))
    except ValueError as error:
        raise BadInput(f"friction: {error}") from None
    return tuple(drives)


def work_of_friction(ways: tuple[Way, ...], load: Load, drive: Drive) -> NDArray[np.float64]:
    """Work ∫ -σ_XY/σ_YY ±N dt that friction takes at unit speed, over N a/c_s, + towards +X; (steps,).

    Args:
        ways: of the punch.
        load: of the punch over time.
        drive: of the punch.
    """
    x, w = leggauss(4)
    work, t0 = [], 0.0
    for way in ways:
        h = way.duration / way.steps
        for n in range(way.steps):
            t = t0 + h * (n + (1.0 + x) / 2.0)
            power = drive.way * way.direction * -np.array(list(map(drive, t))) * load(t)
            work.append(h / 2.0 * float(w @ power))
        t0 += way.duration
    return np.cumsum(work)


#: Tightest and loosest tolerance of motions in time.
_TIGHTEST, _COARSEST = 1e-5, 1e-2
#: Least thickness over a of a layer under motions in time.
_THINNEST = 0.1


def check_in_time(scene: Scene, methods: tuple[str, ...]) -> None:
    """Refuse scenes whose motions in time cannot be computed.

    Args:
        scene: the scene.
        methods: the scene's methods that compute motions in time.

    Raises:
        BadInput: the message lists all reasons.
    """
    solid, tolerance = scene.solid, scene.solve.tolerance
    faults = []
    if not isinstance(scene.punch.profile, Flat):
        words = scene.punch.profile.words()
        faults.append(f"found a {words}; a start from rest is computed for flat punches")
    if not methods:
        faults.append("solve.methods has neither fem nor sie, which follow a start from rest")
    if not _TIGHTEST <= tolerance <= _COARSEST:
        faults.append(
            f"solve.tolerance: found {tolerance:g}, expected {_TIGHTEST:g} to {_COARSEST:g}, as in 1e-3"
        )
    if scene.layers:
        faults += _of_layers(scene)
    if solid.nearly_incompressible:
        faults.append(
            "a start from rest is computed where ν is not near 1/2: pressure waves are too fast"
        )
    if scene.time and scene.time.by_law and any(leg.speed is not None or leg.rest for leg in scene.legs):
        faults.append("strokes with a speed or a rest of their own are not computed in time")
    if scene.solve.mode != "contact":
        faults.append('a start from rest needs solve.mode = "contact"')
    if faults:
        raise BadInput("time: " + "; ".join(faults))


def _of_layers(scene: Scene) -> list[str]:
    """Reasons why motions in time over these layers cannot be computed."""
    faults = []
    if any(layer.bottom for layer in scene.layers):
        faults.append("layers: found a graded one, expected uniform ones for motions in time")
    thinnest = min(layer.thickness for layer in scene.layers) / scene.body.half_width
    if thinnest < _THINNEST:
        faults.append(
            f"layers: found a thickness of {thinnest:.4g} a, expected at least {_THINNEST:g} a, the "
            "punch's half-width, for motions in time"
        )
    if scene.time and scene.time.steady:
        faults.append('time.start: found "steady" over layers, expected "rest"')
    return faults


#: Shortest time over a/c_s of changing friction for which steps and cells are made.
_QUICK = 1.0
#: Lowest degree that resolves the moments from which K_I is recovered, highest degree, and largest
#: innermost cell over a.
_LOWEST, _HIGHEST, _INNERMOST = 7, 12, 1e-4
#: Time over a/c_s in which waves cross the contact.
_CROSSED = 2.0
#: Distance over a, times the tolerance, of the boundary at which steady motion is held.
_HELD = 5.0
#: Size of a ring of cells at the edges over that of the ring outside it; where waves are sharp.
_RATIO, _SHARP_RATIO = 0.25, 0.5
#: Largest distance over a from the punch along the surface, and depth over a, of outputs.
_SEEN = 2.0, 2.0
#: Side of cells over a where the surface is output, where waves ahead of the punch are short, and
#: half-width and depth over a of these cells.
_SEEN_SIZE, _SEEN_CELLS = 2.0 / 3.0, (4.0, 2.0)
#: Largest side of cells over the uppermost layer's thickness.
_OF_LAYER = 2.0
#: Steps by which the mesh's end is later than the motion's, for implicit steps.
_EARLIER = 8
#: How much longer a cell further out may be at a tolerance of 1e-3, over its distance from the innermost
#: ones; so much less at a tenth of the tolerance; how much more where the error is measured.
_GROWTH, _FINER, _GROWN = 0.15, 0.4, 1.75
#: Side of cells next to the punch over a; shortest time of changes over a/c_s for it at a tolerance of
#: 1e-3, and by how much longer at each tenth of that; distance over c_s below the Rayleigh speed that a
#: punch has to keep for it, since the wave ahead of a faster one is shorter. Within the last of these
#: distances a degree more is taken.
_SIZE, _LONG, _LONGER, _SLOW, _SHORT = 2.0, 2.0, 1.5, 0.25, 0.15


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
        drives: of the punch by speed over c_s.
        methods: names of the methods that compute them.
        ways: of the punch from turn to turn; the integral equation computes the first.
        load: over time.
        steady: True where they begin in steady motion, False where they begin at rest.
        tolerance: accuracy, relative to the largest value over time.
        every: time over a/c_s from one output of the surface to the next, None for none.
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
        """Number of steps of the finite elements, even."""
        return sum(way.steps for way in self.ways)

    @property
    def end(self) -> float:
        """Last time over a/c_s."""
        return sum(way.duration for way in self.ways)

    def times(self, every: int = 1) -> NDArray[np.float64]:
        """Ends over a/c_s of the finite elements' steps, or of every ``every`` steps together."""
        h = [np.full(way.steps // every, every * way.duration / way.steps) for way in self.ways]
        return np.asarray(np.cumsum(np.concatenate(h)))

    @property
    def outputs(self) -> NDArray[np.int64]:
        """Numbers of steps that precede each output of the surface, all even; (outputs,)."""
        times = np.arange(1.0, self.end / (every := self.every or np.inf) + 1e-6) * every
        return np.unique(2 * np.abs(np.subtract.outer(times, self.times(2))).argmin(axis=1) + 2)

    def dissipated(self, c: float, drive: Drive) -> NDArray[np.float64]:
        """Work ∫ f V N dt of friction after each step over N a, but for its second order; (steps,)."""
        return work_of_friction(self.ways, self.load, drive) * c

    def directions(self, drive: Drive) -> NDArray[np.float64]:
        """Direction ±1 of the punch along X in each step, (steps,)."""
        return drive.way * np.repeat(
            [float(way.direction) for way in self.ways], [way.steps for way in self.ways]
        )

    @property
    def shortest(self) -> float:
        """Shortest time over a/c_s within which load, direction or friction changes."""
        ways = [way.stroke for way in self.ways if self.changing]
        frictions = [max(drive.shortest, _QUICK) for drives in self.drives.values() for drive in drives]
        return min(self.load.shortest, *ways, *frictions)

    @property
    def changing(self) -> bool:
        """True where the friction of a drive changes over time."""
        return any(drive.constant is None for drives in self.drives.values() for drive in drives)

    @property
    def turns(self) -> bool:
        """True where the punch turns round."""
        return len({way.direction for way in self.ways}) > 1

    @property
    def sharp(self) -> bool:
        """True where waves are too sharp for cells: they begin at the edges, suddenly."""
        return self.turns or not self.tells_K_I

    @property
    def tells_K_I(self) -> bool:
        """True where the pressure is smooth enough for K_I, but for its exponents at the edges.

        A wave that begins at an edge of the punch, suddenly, has to cross the contact before.
        """
        return not self.changing or self.shortest >= _CROSSED

    @property
    def count(self) -> int:
        """Number of motions."""
        return sum(map(len, self.drives.values()))

    @property
    def rules(self) -> frozenset[str]:
        """Names of the rules by which results are checked."""
        if FEM not in self.methods:
            return frozenset({OF_SIE})
        return rules(SIE in self.methods, self.steady, bool(self.every), self.sharp)

    def words(self, solid: Solid) -> list[str]:
        """Plan in words, one line for each method."""
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

    def response(self, solid: Solid, c: float) -> HalfPlane:
        """HalfPlane of the solid at a speed over c_s; of layers with lengths over a."""
        return solid.response(c, self.a)

    def levels(self, solid: Solid, c: float) -> tuple[Level, Level]:
        """Two levels: a coarser one, which measures the error, and the one that is archived.

        The coarser one has half as many steps, a degree less, and cells that grow faster, so that
        waves are too short for cells from little more than half the distance on.
        """
        digits, gap = -log10(self.tolerance), solid.limit() - c
        degree = min(max(ceil(2.0 * digits + 1.75), _LOWEST), _HIGHEST)
        depths = tuple((solid.depths / self.a).tolist())
        degree += (gap < _SHORT or bool(depths)) and degree < _HIGHEST
        innermost = min(10.0 ** -(1.2 * digits + 1.0), _INNERMOST)
        slow = min(1.0, gap / _SLOW) ** 0.5
        long = _LONG + _LONGER * max(digits - 3.0, 0.0)
        size = _SIZE * slow * min(1.0, self.shortest / long)
        seen = min(size, _SEEN_SIZE * slow) if self.every else size
        growth = _GROWTH * _FINER ** (digits - 3.0)
        beyond = _HELD / self.tolerance if self.steady else 0.0
        ratio = _SHARP_RATIO if self.sharp else _RATIO
        width, depth = self._reach(fastest(self.response(solid, c)), c)
        if depths:
            slower = min(1.0, solid.slowest / solid.c_s)
            size, seen = (min(side * slower, _OF_LAYER * depths[0]) for side in (size, seen))
        coarse, fine = (
            Reached(
                max(width, 3.0), max(depth, 2.0), size, of, innermost, beyond, ratio, depths, seen,
                _SEEN_CELLS,
            )
            for of in (_GROWN * growth, growth)
        )  # fmt: skip
        return Level(coarse, degree - 1, 2), Level(fine, degree, 1)

    def _reach(self, fast: float, c: float) -> tuple[float, float]:
        """Half-width and depth over a from which the fastest wave is not back before the end.

        It comes back to a punch that has moved, or to the output places around it. With implicit steps
        it arrives a little earlier.
        """
        T = self.end * (1.0 + _EARLIER / self.steps)
        beside, below = _SEEN if self.every else (0.0, 0.0)
        if self.turns:
            farthest = c * max(way.stroke for way in self.ways)
            return 1.0 + beside + fast * T / 2.0 + farthest, (fast * T + below) / 2.0
        ahead = 1.0 + T * (fast**2 - c**2) / (2.0 * fast)
        # On the way down and up the punch goes ahead by c T, but for the places of outputs.
        down = sqrt((fast * T) ** 2 - max(c * T - 2.0 - 2.0 * beside, 0.0) ** 2) / 2.0
        return ahead + beside, down + below / 2.0


#: Most motions in time of a scene, and most unknowns of a mesh.
MOST, LARGEST = 24, 300_000
#: Longest step over a/c_s at a tolerance of 1e-3, of order four; fewest steps of a load's ramp.
_STEP, _OF_RAMP = 0.4, 8
#: Factor by which steps are shorter over layers, whose echoes move the centre of the pressure.
_OF_LAYERS = 3.5


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
    tolerance = scene.solve.tolerance
    check_in_time(scene, methods)
    load = load_of(scene)
    largest = min(_STEP, load.shortest / _OF_RAMP) / (_OF_LAYERS if scene.layers else 1.0)
    step = scene.time.step or largest * min(tolerance / 1e-3, 1.0) ** 0.3
    drives = _drives(scene, states)
    ways = ways_at(scene, next(iter(drives)), step)
    if methods == (SIE,) and len(ways) > 1:
        raise BadInput(
            f"solve.methods: found sie only, which computes no way back, and the punch turns round at "
            f"{ways[0].duration:.6g} a/c_s: expected fem, too, or time.end no later than that"
        )
    planned = Starts(
        drives, methods, ways, load, scene.time.steady, tolerance, scene.time.every,
        scene.body.half_width,
    )  # fmt: skip
    if FEM in methods:
        _check_size(planned, scene)
    return planned


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
        drives[speeds[0]] = drives_at(scene, speeds[0])
    else:
        different = np.unique(np.column_stack([c, states.g, headings(scene, states.directions)]), axis=0)
        for speed, ratio, way in different.tolist():
            drives[speed] = (*drives.get(speed, ()), Drive(round(way), ratio))
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


def _check_size(planned: Starts, scene: Scene) -> None:
    """Refuse meshes with too many unknowns.

    Raises:
        BadInput: a mesh has more than ``LARGEST``.
    """
    for c in planned.drives:
        _, level = planned.levels(scene.solid, c)
        if level.unknowns > LARGEST:
            raise BadInput(
                f"time.end = {planned.end:g} needs {level.unknowns} unknowns at c = {c:g}, as far "
                f"as waves come that are back by then, expected at most {LARGEST}: take an earlier "
                "end, a larger solve.tolerance, or a smaller Poisson's ratio"
            )
