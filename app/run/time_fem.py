"""Motions in time by finite elements at one level of mesh, degree and steps, and what is probed of them.

Works, energies and stresses on the surface are probed besides the contact (:class:`TimeProbes`).
"""

from typing import Any

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray

from galinx.clock import Clock
from galinx.meshes.charts import Physical
from galinx.meshes.rings import TAGS
from galinx.postprocess.over_time import contact_numbers, stress_datasets
from galinx.postprocess.quantities import over_time as rows
from galinx.postprocess.quantities.quantity import FEM
from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.fem.dynamic import Energies, Motion
from galinx.solvers.fem.in_time import Phase, SlidingInTime, Steps, SurfaceInTime, Watch
from galinx.solvers.fem.space import Space, distribute
from galinx.solvers.solids.solid import Solid
from galinx.solvers.transient.punch import BESIDE, ON_SURFACE

from ..plan.over_time import Drive, Level, Starts

_Datasets = dict[str, NDArray[np.float64]]


class TimeProbes:
    """Probes of all motions at a speed: beside the ends, along the surface, and of energies.

    Args:
        starts: the motions and the datasets requested.
        level: mesh, degree and steps.
        motion: the equations of motion.
    """

    def __init__(self, starts: Starts, level: Level, motion: Motion) -> None:
        self._starts, self._level, self._motion = starts, level, motion
        self._ends = SurfaceInTime(motion, np.array([-1.0 - BESIDE, 1.0 + BESIDE]))
        self._along = SurfaceInTime(motion, ON_SURFACE) if starts.every else None
        self._energies = Energies(motion) if starts.every and level.every == 1 else None

    @property
    def watching(self) -> tuple[Watch, ...]:
        """Functions that are evaluated at each step."""
        watches: list[Watch] = [lambda u, w, way: self._ends.strain(u)]
        if (along := self._along) is not None:
            watches.append(lambda u, w, way: along.strain(u))
        return (*watches, *filter(None, [self._energies]))

    def datasets(self, run: Steps, g: Drive) -> _Datasets:
        """Datasets of a motion by path."""
        ends, *rest = run.watched
        σ = self._motion.response.σ_XX(ends[1:], np.zeros_like(ends[1:]), np.zeros_like(ends[1:]))
        datasets = {
            rows.WORK.path: run.work, rows.ENERGY.path: run.energy, rows.ABSORBED.path: run.absorbed,
            rows.OF_LOAD[FEM].path: run.work_of_load,
            rows.OF_FRICTION[FEM].path: run.work_of_friction,
            rows.LEFT[FEM].path: σ[:, 0], rows.RIGHT[FEM].path: σ[:, 1],
        }  # fmt: skip
        if self._along is not None:
            datasets |= self._on_surface(rest[0], run, g)
        if self._energies is not None:
            datasets |= self._of_energies(rest[1], run, g)
        return datasets

    def _on_surface(self, strains: NDArray, run: Steps, g: Drive) -> _Datasets:
        assert self._along is not None
        σ_YY, ratios = [], []
        for n in (at := self._starts.outputs // self._level.every):
            steady = FlatPunch(self._motion.response, ratio := g(float(run.t[n - 1])))
            σ_YY.append(self._along.pressure(run.forces[n - 1], steady.α, steady.β))
            ratios.append(ratio)
        pressure = np.array(σ_YY)
        shear = np.array(ratios)[:, None] * pressure
        σ_XX = self._motion.response.σ_XX(strains[at], pressure, shear)
        return stress_datasets(FEM, np.array([σ_XX, pressure, shear]))

    def _of_energies(self, watched: NDArray, run: Steps, g: Drive) -> _Datasets:
        """Energies by path, as changes since t = 0; the energy carried along is added up step by step."""
        ways = self._starts.directions(g)
        strain, kinetic, all_strain, all_kinetic, momentum = (watched - watched[0])[1:].T
        steps = np.diff(momentum, prepend=0.0)
        return {
            rows.CARRIED.path: np.cumsum(self._motion.response.c * ways * steps),
            rows.STRAIN.path: strain, rows.KINETIC.path: kinetic,
            rows.RADIATED.path: all_strain - strain + all_kinetic - kinetic + run.absorbed,
        }  # fmt: skip


def at_level(level: Level, starts: Starts, solid: Solid, c: float, clock: Clock) -> list[Any]:
    """Contact values and datasets of the probes, a pair for each friction at a speed."""
    response = starts.response(solid, c)
    with clock("mesh"):
        mesh = distribute(level.mesh.drawn(), MPI.COMM_SELF)
    space = Space(*mesh, TAGS, Physical(), level.degree, solid.form, clock=clock)
    motion = Motion(space, response, starts.sharp)
    solver, probes = SlidingInTime(motion, clock), TimeProbes(starts, level, motion)
    motions = []
    with clock("steps in time"):
        for g in starts.drives[c]:
            phases = [
                Phase(g.way * way.direction, way.duration, way.steps // level.every)
                for way in starts.ways
            ]
            run = solver.run(phases, g, lambda t: float(starts.load(t)), starts.steady, probes.watching)
            values = _read(run, g, motion, level.degree, starts.tells_K_I)
            motions.append((values, probes.datasets(run, g)))
    solver.destroy()
    return motions


def _read(run: Any, g: Drive, motion: Any, degree: int, tells_K_I: bool) -> tuple[NDArray, ...]:
    """v₀, centre, and K_I at both ends, by the exponents of the friction at each time.

    K_I is NaN where the motion has none.
    """
    ratios = np.array([g(t) for t in run.t])
    read = np.empty((3, len(ratios)))
    for ratio in np.unique(ratios):
        at, steady = ratios == ratio, FlatPunch(motion.response, ratio)
        numbers = contact_numbers(motion.X, run.forces[at], steady.α, steady.β, degree)
        read[:, at] = numbers.centre, numbers.K_left, numbers.K_right
    if not tells_K_I:
        read[1:] = np.nan
    return run.v0, *read
