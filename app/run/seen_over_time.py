"""What finite elements in time tell besides the contact: works, energies, and stresses on the surface."""

import numpy as np
from numpy.typing import NDArray

from galinx.app.plan.driving import Drive
from galinx.app.plan.over_time import Level, Starts
from galinx.postprocess.quantities import energy_over_time as energy
from galinx.postprocess.quantities import over_time as rows
from galinx.postprocess.quantities import work_over_time as beside
from galinx.postprocess.quantities.quantity import FEM
from galinx.postprocess.surface_over_time import named
from galinx.solvers.fem.dynamic import Motion
from galinx.solvers.fem.energies import Energies
from galinx.solvers.fem.in_time import Steps, Watch
from galinx.solvers.fem.surface_in_time import SurfaceInTime
from galinx.solvers.sie.closed_form import FlatPunch
from galinx.solvers.transient.punch import BESIDE, ON_SURFACE

_Found = dict[str, NDArray[np.float64]]


class Seen:
    """What is watched of all motions at a speed.

    Args:
        starts: what is asked for.
        level: with which it is computed.
        motion: the equations.
    """

    def __init__(self, starts: Starts, level: Level, motion: Motion) -> None:
        self._starts, self._level, self._motion = starts, level, motion
        self._ends = SurfaceInTime(motion, np.array([-1.0 - BESIDE, 1.0 + BESIDE]))
        self._along = SurfaceInTime(motion, ON_SURFACE) if starts.every else None
        self._energies = Energies(motion) if starts.every and level.every == 1 else None

    @property
    def watching(self) -> tuple[Watch, ...]:
        """What looks at each step."""
        found: list[Watch] = [lambda u, w, way: self._ends.strain(u)]
        if (along := self._along) is not None:
            found.append(lambda u, w, way: along.strain(u))
        return (*found, *filter(None, [self._energies]))

    def told(self, run: Steps, g: Drive) -> _Found:
        """Datasets of a motion by path."""
        ends, *rest = run.watched
        σ = self._motion.response.σ_XX(ends[1:], np.zeros_like(ends[1:]), np.zeros_like(ends[1:]))
        found = {
            rows.WORK.path: run.work, rows.ENERGY.path: run.energy, rows.ABSORBED.path: run.absorbed,
            beside.OF_LOAD[FEM].path: run.work_of_load,
            beside.OF_FRICTION[FEM].path: run.work_of_friction,
            beside.LEFT[FEM].path: σ[:, 0], beside.RIGHT[FEM].path: σ[:, 1],
        }  # fmt: skip
        if self._along is not None:
            found |= self._on_surface(rest[0], run, g)
        if self._energies is not None:
            found |= self._of_energies(rest[1], run, g)
        return found

    def _on_surface(self, strains: NDArray, run: Steps, g: Drive) -> _Found:
        assert self._along is not None
        σ_YY, ratios = [], []
        for n in (at := self._starts.outputs // self._level.every):
            steady = FlatPunch(self._motion.response, ratio := g(float(run.t[n - 1])))
            σ_YY.append(self._along.pressure(run.forces[n - 1], steady.α, steady.β))
            ratios.append(ratio)
        pressure = np.array(σ_YY)
        shear = np.array(ratios)[:, None] * pressure
        σ_XX = self._motion.response.σ_XX(strains[at], pressure, shear)
        return named(FEM, np.array([σ_XX, pressure, shear]))

    def _of_energies(self, watched: NDArray, run: Steps, g: Drive) -> _Found:
        """By changes since t = 0; what is carried along while the punch goes one way."""
        ways = self._starts.directions(g)
        strain, kinetic, all_strain, all_kinetic, momentum = (watched - watched[0])[1:].T
        steps = np.diff(momentum, prepend=0.0)
        return {
            energy.CARRIED.path: np.cumsum(self._motion.response.c * ways * steps),
            energy.STRAIN.path: strain, energy.KINETIC.path: kinetic,
            energy.RADIATED.path: all_strain - strain + all_kinetic - kinetic + run.absorbed,
        }  # fmt: skip
