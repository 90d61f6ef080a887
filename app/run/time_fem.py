"""Motions in time by finite elements at one level of mesh, degree and steps.

Besides the contact they give works, energies, and stresses on the surface.
"""

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
from galinx.solvers.fem.in_time import SlidingInTime, Steps, SurfaceInTime, Watch
from galinx.solvers.fem.space import Space, distribute
from galinx.solvers.solids.half_plane import HalfPlane
from galinx.solvers.solids.solid import Solid
from galinx.solvers.transient.history import Drive, Way
from galinx.solvers.transient.punch import BESIDE, ON_SURFACE

from ..plan.over_time import Level, Starts

_Datasets = dict[str, NDArray[np.float64]]

#: Places beside both ends of the punch, X over a.
_ENDS = np.array([-1.0 - BESIDE, 1.0 + BESIDE])


def at_level(
    level: Level, starts: Starts, solid: Solid, c: float, clock: Clock
) -> list[tuple[tuple[NDArray, ...], _Datasets]]:
    """Motions at a speed: v₀, centre and K_I left and right over time, and other datasets by path."""
    response = starts.response(solid, c)
    with clock("mesh"):
        mesh = distribute(level.mesh.drawn(), MPI.COMM_SELF)
    space = Space(*mesh, TAGS, Physical(), level.degree, solid.form, clock=clock)
    motion, motions = Motion(space, response, starts.sharp), []
    solver = SlidingInTime(motion, clock)
    surface = SurfaceInTime(motion, np.append(_ENDS, ON_SURFACE) if starts.every else _ENDS)
    watching: list[Watch] = [lambda u, w, way: surface.strain(u)]
    if starts.every and level.every == 1:
        watching.append(Energies(motion))
    with clock("steps in time"):
        for drive in starts.drives[c]:
            ways = [
                Way(drive.way * way.direction, way.duration, way.steps // level.every)
                for way in starts.ways
            ]
            run = solver.run(ways, drive, starts.load, starts.steady, watching)
            datasets = _beside(run, response)
            if starts.every:
                at = starts.outputs // level.every
                datasets |= _on_surface(surface, run, at, response, drive)
            if len(run.watched) > 1:
                datasets |= _energies(run, response.c * starts.directions(drive))
            motions.append((_contact(run, drive, motion, level.degree, starts.smooth), datasets))
    solver.destroy()
    return motions


def _contact(run: Steps, drive: Drive, motion: Motion, degree: int, smooth: bool) -> tuple[NDArray, ...]:
    """v₀, centre, and K_I at both ends by the exponents of each time; NaN for no smooth pressure."""
    ratios, read = drive(run.t), np.empty((3, len(run.t)))
    for ratio in np.unique(ratios):
        at, steady = ratios == ratio, FlatPunch(motion.response, ratio)
        numbers = contact_numbers(motion.X, run.forces[at], steady.α, steady.β, degree)
        read[:, at] = numbers.centre, numbers.K_left, numbers.K_right
    return run.v0, read[0], *(read[1:] if smooth else np.nan * read[1:])


def _beside(run: Steps, response: HalfPlane) -> _Datasets:
    """Works, energy seen from the punch, and σ_XX on the free surface beside both ends."""
    u_X = run.watched[0][1:, : len(_ENDS)]
    left, right = response.σ_XX(u_X, 0.0 * u_X, 0.0 * u_X).T
    return {
        rows.WORK.path: run.work, rows.ENERGY.path: run.energy,
        rows.ABSORBED.path: run.absorbed, rows.OF_LOAD[FEM].path: run.work_of_load,
        rows.OF_FRICTION[FEM].path: run.work_of_friction, rows.LEFT[FEM].path: left,
        rows.RIGHT[FEM].path: right,
    }  # fmt: skip


def _on_surface(
    surface: SurfaceInTime, run: Steps, at: NDArray, response: HalfPlane, drive: Drive
) -> _Datasets:
    """Stresses along the surface after steps of these numbers."""
    ratios = drive(run.t[at - 1])
    steady = [FlatPunch(response, ratio) for ratio in ratios]
    σ_YY = np.array([
        surface.pressure(forces, punch.α, punch.β) for forces, punch in zip(run.forces[at - 1], steady)
    ])  # fmt: skip
    σ_XY = ratios[:, None] * σ_YY
    stresses = np.array([response.σ_XX(run.watched[0][at], σ_YY, σ_XY), σ_YY, σ_XY])
    return stress_datasets(FEM, stresses[..., len(_ENDS) :])


def _energies(run: Steps, velocity: NDArray) -> _Datasets:
    """Energies as changes since t = 0, by the punch's velocity in each step.

    The work of carrying the solid along is added up step by step.
    """
    strain, kinetic, all_strain, all_kinetic, momentum = (run.watched[1] - run.watched[1][0])[1:].T
    return {
        rows.CARRIED.path: np.cumsum(velocity * np.diff(momentum, prepend=0.0)),
        rows.STRAIN.path: strain, rows.KINETIC.path: kinetic,
        rows.RADIATED.path: all_strain - strain + all_kinetic - kinetic + run.absorbed,
    }  # fmt: skip
