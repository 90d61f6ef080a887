"""Starts from rest: which there are, and meshes, degrees and steps that reach a tolerance."""

from dataclasses import dataclass
from math import ceil, log10, sqrt

import numpy as np

from galinx.app.errors import BadInput
from galinx.app.plan.states import enumerate_states
from galinx.app.scene.scene import Scene
from galinx.meshes.reached import Reached
from galinx.postprocess.compare_over_time import BOTH, OF_FEM
from galinx.postprocess.quantities.quantity import FEM, SIE
from galinx.solvers.profiles.flat import Flat
from galinx.solvers.solids.isotropic import Isotropic

#: Starts of a scene at most, and unknowns of a mesh.
MOST, LARGEST = 24, 300_000
#: Tolerances that can be reached.
_TIGHTEST, _COARSEST = 1e-5, 1e-2
#: Largest step at a tolerance of 1e-3, of order four; and steps within which the load comes on.
_STEP, _OF_RAMP = 0.4, 6
#: Seconds measured on cores of 3 GHz, by unknowns to a power and by symbols of the integral equation.
_SET_UP, _STAGE, _SYMBOL = 3e-6, 3.5e-7, 0.12
#: Lowest degree that tells the moments from which K_I is read, highest one, and largest innermost cell
#: over a.
_LOWEST, _HIGHEST, _INNERMOST = 7, 12, 1e-4
#: Steps by which the end is later for waves.
_EARLIER = 8
#: How much longer a cell further out may be at a tolerance of 1e-3, over its distance from the innermost
#: ones; half of it at a tenth of the tolerance. And how much more where the error is measured.
_GROWTH, _GROWN = 0.15, 1.75
#: Side of cells next to the punch over a; and how much slower than the Rayleigh wave a punch has to be for that:
#: the wave ahead of a faster one is shorter.
_SIZE, _SLOW = 2.0, 0.25


#: Rules by which starts are judged.
IN_TIME = frozenset({BOTH, OF_FEM})


@dataclass(frozen=True)
class Level:
    """What a solution in time is computed with.

    Attributes:
        mesh: as far as waves come that are back at the end, if they are not too short for its cells.
        degree: polynomial degree.
        steps: their number.
    """

    mesh: Reached
    degree: int
    steps: int

    @property
    def unknowns(self) -> int:
        """About as many as there are."""
        return 2 * self.degree**2 * len(self.mesh.drawn().cells)


@dataclass(frozen=True)
class Starts:
    """All starts of a scene.

    Attributes:
        g: σ_XY/σ_YY by speed over c_s, each pair once.
        methods: that follow them.
        end, ramp: last time, and that in which the load comes on, over a/c_s.
        tolerance: wanted, relative to the largest.
        steps: of the finite elements, an even number.
    """

    g: dict[float, tuple[float, ...]]
    methods: tuple[str, ...]
    end: float
    ramp: float
    tolerance: float
    steps: int

    @property
    def count(self) -> int:
        """How many."""
        return sum(map(len, self.g.values()))

    @property
    def rules(self) -> frozenset[str]:
        """Names of the rules by which what is found is judged."""
        of_fem = {OF_FEM} if FEM in self.methods else set()
        return frozenset(of_fem | ({BOTH} if of_fem and SIE in self.methods else set()))

    def words(self, solid: Isotropic) -> list[str]:
        """What is done, one line a method."""
        what = f"{self.count} starts from rest, to t = {self.end:g} a/c_s"
        lines = [f"integral equation in time: {what}"] if SIE in self.methods else []
        if FEM in self.methods:
            for c in self.g:
                _, level = self.levels(solid, c)
                lines.append(
                    f"finite elements in time at c = {c:g} (over c_s): {what}, {level.steps} steps, "
                    f"degree {level.degree}, about {level.unknowns} unknowns; one of a degree less and "
                    "twice the step, on larger cells, measures the error"
                )
        return lines

    def seconds(self, solid: Isotropic) -> float:
        """About how long all of it takes."""
        total = 0.0
        for c, of_speed in self.g.items():
            if FEM in self.methods:
                for level in self.levels(solid, c):
                    n = level.unknowns
                    total += _SET_UP * n**1.5 + len(of_speed) * _STAGE * 5 * level.steps * n**1.1
            if SIE in self.methods:
                total += _SYMBOL * max(self.end / 0.2, self.steps / 2)
        return total

    def levels(self, solid: Isotropic, c: float) -> tuple[Level, Level]:
        """A coarser level, which tells the error, and that which is archived.

        The coarser one has half as many steps, a degree less, and cells that grow faster, so that waves are
        taken for too short at little more than half the distance.
        """
        digits = -log10(self.tolerance)
        degree = min(max(ceil(2.0 * digits + 1.75), _LOWEST), _HIGHEST)
        fast = 1.0 / sqrt(solid.response(c).k)
        # A wave that goes out to the far boundary comes back to a punch that has moved. Implicit steps
        # let it be felt a little earlier.
        T = self.end * (1.0 + _EARLIER / self.steps)
        ahead = 1.0 + T * (fast**2 - c**2) / (2.0 * fast)
        depth = sqrt((fast * T) ** 2 - max(c * T - 2.0, 0.0) ** 2) / 2.0
        innermost = min(10.0 ** -(1.2 * digits + 1.0), _INNERMOST)
        size = _SIZE * min(1.0, (solid.limit() - c) / _SLOW) ** 0.5
        growth = _GROWTH * 0.5 ** (digits - 3.0)
        coarse, fine = (
            Reached(max(ahead, 3.0), max(depth, 2.0), size, of, innermost)
            for of in (_GROWN * growth, growth)
        )
        return Level(coarse, degree - 1, self.steps // 2), Level(fine, degree, self.steps)


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
    states = enumerate_states(scene)
    pairs = np.unique(np.column_stack([states.columns["c"], states.g]), axis=0)
    if len(pairs) > MOST:
        raise BadInput(
            f"time: the scene has {len(pairs)} states of different speed or friction, expected at most "
            f"{MOST}, each of which starts from rest: shorten its lists"
        )
    limit = scene.solid.limit()
    if fast := [f"{c:g}" for c, _ in pairs if c >= limit]:
        raise BadInput(
            f"time: c = {', '.join(fast)} is not below the Rayleigh speed {limit:.6g} (over c_s)"
        )
    g: dict[float, tuple[float, ...]] = {}
    for c, ratio in pairs.tolist():
        g[c] = (*g.get(c, ()), ratio)
    largest = min(_STEP, scene.time.load_ramp / _OF_RAMP)
    step = scene.time.step or largest * min(tolerance / 1e-3, 1.0) ** 0.25
    steps = 2 * ceil(scene.time.end / step / 2.0 - 1e-9)
    found = Starts(g, methods, scene.time.end, scene.time.load_ramp, tolerance, steps)
    if FEM in methods:
        assert isinstance(scene.solid, Isotropic)
        for c in g:
            _, level = found.levels(scene.solid, c)
            if level.unknowns > LARGEST:
                raise BadInput(
                    f"time.end = {scene.time.end:g} needs {level.unknowns} unknowns at c = {c:g}, as far "
                    f"as waves come that are back by then, expected at most {LARGEST}: take an earlier "
                    "end, a larger solve.tolerance, or a smaller Poisson's ratio"
                )
    return found


def _check(scene: Scene, methods: tuple[str, ...]) -> None:
    solid, tolerance = scene.solid, scene.solve.tolerance
    faults = []
    if not methods:
        faults.append("solve.methods has neither fem nor sie, which follow a start from rest")
    if not _TIGHTEST <= tolerance <= _COARSEST:
        faults.append(
            f"solve.tolerance: found {tolerance:g}, expected {_TIGHTEST:g} to {_COARSEST:g}, as in 1e-3"
        )
    if not isinstance(solid, Isotropic):
        faults.append("a start from rest is known of isotropic solids without layers")
    elif solid.nearly_incompressible:
        faults.append("a start from rest is known where ν is not near 1/2: pressure waves are too fast")
    if not isinstance(scene.punch.profile, Flat):
        faults.append("a start from rest is known of flat punches")
    if scene.solve.mode != "contact":
        faults.append('a start from rest needs solve.mode = "contact"')
    if faults:
        raise BadInput("time: " + "; ".join(faults))
