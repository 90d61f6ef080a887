"""Motions in time: which there are, and meshes, degrees and steps that reach a tolerance."""

from dataclasses import dataclass
from math import ceil, log10, sqrt

import numpy as np

from galinx.app.errors import BadInput
from galinx.app.plan.driving import (
    Friction,
    Load,
    Way,
    constant,
    frictions_at,
    load_of,
    ways_at,
)
from galinx.app.plan.states import enumerate_states
from galinx.app.scene.scene import Scene
from galinx.meshes.reached import Reached
from galinx.postprocess.compare_over_time import BOTH, OF_FEM
from galinx.postprocess.quantities.quantity import FEM, SIE
from galinx.solvers.profiles.flat import Flat
from galinx.solvers.solids.solid import Solid
from galinx.solvers.transient.admittance import Admittance, InPlane

#: Starts of a scene at most, and unknowns of a mesh.
MOST, LARGEST = 24, 300_000
#: Tolerances that can be reached.
_TIGHTEST, _COARSEST = 1e-5, 1e-2
#: Largest step at a tolerance of 1e-3, of order four; and steps within which the load comes on.
_STEP, _OF_RAMP = 0.4, 8
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
#: Steps by which the end is later for waves.
_EARLIER = 8
#: How much longer a cell further out may be at a tolerance of 1e-3, over its distance from the innermost
#: ones; so much less at a tenth of the tolerance; how much more where the error is measured.
_GROWTH, _FINER, _GROWN = 0.15, 0.4, 1.75
#: Side of cells next to the punch over a where things change within so many a/c_s, at a tolerance of
#: 1e-3, and so many more at each tenth of it; how much slower than the Rayleigh wave a punch has to be
#: for that: the wave ahead of a faster one is shorter. Within the last of these one asks for a degree
#: more.
_SIZE, _LONG, _LONGER, _SLOW, _SHORT = 2.0, 2.0, 1.5, 0.25, 0.15


#: Rules by which starts are judged.
IN_TIME = frozenset({BOTH, OF_FEM})


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
        frictions: by speed over c_s.
        methods: that follow them.
        ways: from one turn to the next; the integral equation follows the first.
        load: over time.
        steady: do they begin in steady motion?
        tolerance: wanted, relative to the largest.
    """

    frictions: dict[float, tuple[Friction, ...]]
    methods: tuple[str, ...]
    ways: tuple[Way, ...]
    load: Load
    steady: bool
    tolerance: float

    @property
    def steps(self) -> int:
        """Steps of the finite elements, an even number."""
        return sum(way.steps for way in self.ways)

    @property
    def end(self) -> float:
        """Last time over a/c_s."""
        return sum(way.duration for way in self.ways)

    @property
    def shortest(self) -> float:
        """Shortest time within which something changes over a/c_s."""
        ways = [way.duration for way in self.ways if self.changing]
        frictions = [max(one.shortest, _QUICK) for many in self.frictions.values() for one in many]
        return min(self.load.shortest, *ways, *frictions)

    @property
    def changing(self) -> bool:
        """Does friction change?"""
        return any(one.constant is None for many in self.frictions.values() for one in many)

    @property
    def tells_K_I(self) -> bool:
        """Is the pressure smooth enough but for its exponents?

        What begins at an edge of the punch, suddenly, has to have crossed the contact before.
        """
        return not self.changing or self.shortest >= _CROSSED

    @property
    def count(self) -> int:
        """How many."""
        return sum(map(len, self.frictions.values()))

    @property
    def rules(self) -> frozenset[str]:
        """Names of the rules by which what is found is judged."""
        of_fem = {OF_FEM} if FEM in self.methods else set()
        return frozenset(of_fem | ({BOTH} if of_fem and SIE in self.methods else set()))

    def words(self, solid: Solid) -> list[str]:
        """What is done, one line a method."""
        begin = "from steady motion on" if self.steady else "from rest"
        what = f"{self.count} starts {begin}, to t = {self.end:g} a/c_s"
        turns = "" if len(self.ways) == 1 else (
            f"; only to t = {self.ways[0].duration:.6g} a/c_s, where the punch turns round"
        )  # fmt: skip
        lines = [f"integral equation in time: {what}{turns}"] if SIE in self.methods else []
        lines += ["no K_I over time: strokes are over before waves cross the contact"] * (
            not self.tells_K_I
        )
        if FEM in self.methods:
            for c in self.frictions:
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
        for c, of_speed in self.frictions.items():
            if FEM in self.methods:
                for level in self.levels(solid, c):
                    n = level.unknowns
                    total += (
                        _SET_UP * n**1.5 + len(of_speed) * _STAGE * 5 * self.steps / level.every * n**1.1
                    )
            if SIE in self.methods:
                total += _SYMBOL * max(3.0 * self.ways[0].duration, self.ways[0].steps)
        return total

    def levels(self, solid: Solid, c: float) -> tuple[Level, Level]:
        """A coarser level, which tells the error, and that which is archived.

        The coarser one has half as many steps, a degree less, and cells that grow faster, so that
        waves are taken for too short at little more than half the distance.
        """
        digits, gap = -log10(self.tolerance), solid.limit() - c
        degree = min(max(ceil(2.0 * digits + 1.75), _LOWEST), _HIGHEST)
        degree += gap < _SHORT and degree < _HIGHEST
        innermost = min(10.0 ** -(1.2 * digits + 1.0), _INNERMOST)
        long = _LONG + _LONGER * max(digits - 3.0, 0.0)
        size = _SIZE * min(1.0, gap / _SLOW) ** 0.5 * min(1.0, self.shortest / long)
        growth = _GROWTH * _FINER ** (digits - 3.0)
        beyond = _HELD / self.tolerance if self.steady else 0.0
        width, depth = self._reach(Admittance.of(solid.response(c)).fastest, c)
        coarse, fine = (
            Reached(max(width, 3.0), max(depth, 2.0), size, of, innermost, beyond)
            for of in (_GROWN * growth, growth)
        )
        return Level(coarse, degree - 1, 2), Level(fine, degree, 1)

    def _reach(self, fast: float, c: float) -> tuple[float, float]:
        """Half-width and depth from which the fastest wave is not back before the end.

        It comes back to a punch that has moved. Implicit steps let it be felt a little earlier.
        """
        T = self.end * (1.0 + _EARLIER / self.steps)
        if len({way.direction for way in self.ways}) > 1:
            return 1.0 + fast * T / 2.0 + c * max(way.duration for way in self.ways), fast * T / 2.0
        ahead = 1.0 + T * (fast**2 - c**2) / (2.0 * fast)
        return ahead, sqrt((fast * T) ** 2 - max(c * T - 2.0, 0.0) ** 2) / 2.0


def starts(scene: Scene) -> Starts | None:
    """The starts of a scene, None where it asks for none.

    Raises:
        BadInput: they are known of other scenes only.
    """
    if scene.time is None:
        return None
    methods = tuple(name for name in (FEM, SIE) if name in scene.solve.methods)
    tolerance = scene.solve.tolerance
    _check(scene, methods)
    load = load_of(scene)
    largest = min(_STEP, load.shortest / _OF_RAMP)
    step = scene.time.step or largest * min(tolerance / 1e-3, 1.0) ** 0.3
    frictions = _frictions(scene)
    ways = ways_at(scene, next(iter(frictions)), step)
    if methods == (SIE,) and len(ways) > 1:
        raise BadInput(
            f"solve.methods: found sie only, which knows no way back, and the punch turns round at "
            f"{ways[0].duration:.6g} a/c_s: expected fem, too, or time.end no later than that"
        )
    found = Starts(frictions, methods, ways, load, scene.time.steady, tolerance)
    if FEM in methods:
        _check_size(found, scene)
    return found


def _frictions(scene: Scene) -> dict[float, tuple[Friction, ...]]:
    """Friction of all starts by speed.

    Raises:
        BadInput: there are too many, or their speed has no answer.
    """
    assert scene.time
    states = enumerate_states(scene)
    c = states.columns["c"]
    pairs = np.unique(np.column_stack([c, states.g]), axis=0)
    found: dict[float, tuple[Friction, ...]] = {}
    if scene.time.by_law:
        speeds = np.unique(c).tolist()
        if len(speeds) > 1 or speeds[0] == 0.0:
            raise BadInput(
                f'time.friction = "law": found {len(speeds)} speeds, the first {speeds[0]:g} over c_s; '
                "expected one that is not 0, for strokes of another take another time"
            )
        found[speeds[0]] = frictions_at(scene, speeds[0])
    else:
        for speed, ratio in pairs.tolist():
            found[speed] = (*found.get(speed, ()), constant(ratio))
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
    for c in found.frictions:
        _, level = found.levels(scene.solid, c)
        if level.unknowns > LARGEST:
            raise BadInput(
                f"time.end = {found.end:g} needs {level.unknowns} unknowns at c = {c:g}, as far "
                f"as waves come that are back by then, expected at most {LARGEST}: take an earlier "
                "end, a larger solve.tolerance, or a smaller Poisson's ratio"
            )


def _check(scene: Scene, methods: tuple[str, ...]) -> None:
    solid, tolerance = scene.solid, scene.solve.tolerance
    faults = []
    if not methods:
        faults.append("solve.methods has neither fem nor sie, which follow a start from rest")
    if not _TIGHTEST <= tolerance <= _COARSEST:
        faults.append(
            f"solve.tolerance: found {tolerance:g}, expected {_TIGHTEST:g} to {_COARSEST:g}, as in 1e-3"
        )
    if not isinstance(solid.response(0.0), InPlane):
        faults.append("a start from rest is known of uniform solids, without layers")
    elif solid.nearly_incompressible:
        faults.append("a start from rest is known where ν is not near 1/2: pressure waves are too fast")
    if not isinstance(scene.punch.profile, Flat):
        faults.append("a start from rest is known of flat punches")
    if scene.time and scene.time.by_law and any(leg.speed is not None or leg.rest for leg in scene.legs):
        faults.append("strokes with a speed or a rest of their own are not followed in time")
    if scene.solve.mode != "contact":
        faults.append('a start from rest needs solve.mode = "contact"')
    if faults:
        raise BadInput("time: " + "; ".join(faults))
