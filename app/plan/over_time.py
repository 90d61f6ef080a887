"""Motions in time: which there are, and meshes, degrees and steps that reach a tolerance."""

from dataclasses import dataclass
from math import ceil, log10, sqrt

import numpy as np
from numpy.typing import NDArray

from galinx.app.plan.driving import Drive, Load, Way, taken
from galinx.app.plan.judged_over_time import rules
from galinx.meshes.reached import Reached
from galinx.postprocess.quantities.quantity import FEM, SIE
from galinx.solvers.layers.in_cells import LayersInCells
from galinx.solvers.layers.layered import Layered
from galinx.solvers.solids.solid import Response, Solid
from galinx.solvers.transient.sides import fastest
from galinx.texts import counted

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
