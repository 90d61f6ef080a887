"""Motions in time of a scene: both methods, speed by speed.

Beside each motion stands the steady motion with the friction of every moment. dolfinx is imported where
finite elements begin.
"""

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.clock import Clock
from galinx.meshes.charts import Physical
from galinx.postprocess import over_time
from galinx.postprocess.over_time import COMPARED, contact_numbers, largest_change
from galinx.postprocess.quantities import over_time as rows
from galinx.postprocess.quantities.quantity import FEM, SIE
from galinx.solvers.approximation import polynomial_through
from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.contact.ends import Punch
from galinx.solvers.contact.equation import LayersUnderPunch
from galinx.solvers.contact.stresses import PLACES
from galinx.solvers.profiles.punches import Flat
from galinx.solvers.solids.half_plane import HalfPlane
from galinx.solvers.transient.history import Drive, Way
from galinx.solvers.transient.late_time import approach
from galinx.solvers.transient.punch import BESIDE, ON_SURFACE, Course, StartingPunch

from .. import ranks
from ..errors import finite_elements_installed
from ..plan.over_time import Level, Starts

_Datasets = dict[str, NDArray[np.float64]]
#: A method and a speed.
_Job = tuple[str, float]


def solve_motions(
    starts: Starts, clock: Clock, done: Callable[[int, int], None] = lambda n, of: None
) -> _Datasets:
    """Motions of all starts over time: datasets by path.

    Under MPI this is collective, speeds and methods are shared out, and rank 0 alone has the datasets.

    Raises:
        SolveError: finite elements could not be solved.
    """
    if FEM in starts.methods:  # PETSc begins on all ranks, or waits for the others for ever
        with clock("import of dolfinx"), finite_elements_installed():
            import galinx.solvers.fem.in_time  # noqa: F401

    def solve(job: _Job) -> Iterator[tuple[_Job, list[_Datasets]]]:
        of_method = _finite_elements if job[0] == FEM else _integral_equation
        yield job, of_method(starts, job[1], clock)

    # Finite elements are the dearer ones, and the fastest of them.
    jobs = [(name, c) for name in (FEM, SIE) if name in starts.methods
            for c in sorted(starts.drives, reverse=True)]  # fmt: skip
    by_job: dict[_Job, list[_Datasets]] = {}
    for job, motions in ranks.shared_out(jobs, solve):
        by_job[job] = motions
        done(sum(map(len, by_job.values())), len(starts.methods) * starts.count)
    return _joined(starts, by_job) if ranks.is_root() else {}


def _joined(starts: Starts, by_job: dict[_Job, list[_Datasets]]) -> _Datasets:
    """Datasets by path, one row for each start."""
    t, every = starts.times(), list[_Datasets]()
    for c, drives in starts.drives.items():
        for i, drive in enumerate(drives):
            g = drive(t)
            centres = _steady_centres(starts, c, g)
            K_I = late = np.array(np.nan)  # over layers there is no formula
            if not len(starts.scene.solid.depths):
                K_I = np.array(FlatPunch(starts.response(c), g[-1]).K_I)
                late = np.array(approach(starts.scene.solid, c, g[-1]).within(0.01))
            every.append({
                rows.SPEED.path: np.array(c), rows.RATIO.path: g[-1], rows.RATIOS.path: g,
                rows.STEADY_CENTRE.path: centres[-1], rows.CENTRES.path: centres,
                rows.STEADY_K_I.path: K_I, rows.APPROACH.path: late,
                rows.DISSIPATED.path: starts.dissipated(c, drive),
                rows.DIRECTION.path: starts.directions(drive),
            })  # fmt: skip
            for name in sorted(starts.methods, reverse=True):
                every[-1] |= by_job[name, c][i]
    whole = {path: np.array([datasets[path] for datasets in every]) for path in every[0]}
    whole |= {rows.TIMES.path: t, rows.LOAD.path: starts.load(t)}
    if starts.time.every:
        whole |= {rows.SURFACE_TIMES.path: t[starts.outputs - 1], rows.SURFACE_PLACES.path: ON_SURFACE}
    if SIE in starts.methods and not starts.time.steady:
        whole[rows.PLACES.path] = PLACES
    for name in starts.methods:
        whole |= over_time.distances_from_steady(whole, name)
    return whole


def _steady_centres(starts: Starts, c: float, ratios: NDArray) -> NDArray[np.float64]:
    """Centre of the pressure over a in steady motion at frictions σ_XY/σ_YY, (n,)."""
    different, which = np.unique(ratios, return_inverse=True)
    response: Any = starts.response(c)
    if len(response.depths):
        stack, accuracy = response.stack(response.a), 0.1 * starts.scene.solve.tolerance
        punch = Punch(Flat(response.a), response.a, 1.0)
        solved, _ = LayersUnderPunch(response.surface, stack, accuracy, punch).solved(different)
        weights = polynomial_through(np.array([contact.g for contact in solved])).shares(different)
        each = [contact.pressure.points(0.5) for contact in solved]  # the rule's length over a
        centres = [float(forces @ t / forces.sum()) for t, forces in each]
        return np.asarray((weights @ centres)[which])
    punches = [FlatPunch(response, ratio) for ratio in different]
    return np.array([punch.β - punch.α for punch in punches])[which]


#: Least number of steps of the quadrature.
_LEAST_STEPS = 8


def _integral_equation(starts: Starts, c: float, clock: Clock) -> list[_Datasets]:
    """Motions at a speed up to the first turn, NaN after it."""
    first, response, drives = starts.ways[0], starts.response(c), starts.drives[c]
    shortest = min(starts.shortest, *(drive.shortest for drive in drives))
    # At a tolerance of 1e-3 steps of the quadrature, of order five, are at most 0.5 a/c_s, and 6 in which
    # the load comes on; and there are 24 polynomials, 16 more where waves have passed half a half-width
    # by then. K_I converges with the fourth power of their number, later near the Rayleigh speed. Works
    # are sums over all steps.
    tolerance = starts.scene.solve.tolerance
    largest = min(0.5, shortest / 6) * min(tolerance / 1e-3, 1.0) ** 0.2
    finer = int(np.ceil(max(first.h / largest - 1e-9, _LEAST_STEPS / first.steps)))
    digits, halvings = max(-3.0 - np.log10(tolerance), 0.0), max(-np.log2(starts.load.shortest), 0.0)
    near = max(0.25 / (starts.scene.solid.limit() - c), 1.0)
    terms = round((24 + 16 * halvings) * 1.5**digits * near**0.15)
    surface, alone = bool(starts.time.every), starts.methods == (SIE,)

    def at_steps(values: NDArray) -> NDArray[np.float64]:
        padded = np.full((starts.steps, *values.shape[1:]), np.nan)
        padded[: first.steps] = values[finer - 1 :: finer]
        return padded

    motions = []
    with clock("integral equation in time"):
        limit, steps = starts.scene.solid.limit(), first.steps * finer
        punches = {
            way: StartingPunch(response, limit, first.duration, steps, terms, surface, way, alone)
            for way in {drive.way for drive in drives}
        }
        for drive in drives:
            course = punches[drive.way].course(drive, starts.load, starts.time.steady)
            K_I = np.array([course.K_left, course.K_right]) * (1.0 if starts.smooth else np.nan)
            datasets = _contact(SIE, course.v0, course.centre, *K_I)
            datasets[rows.TENSION[SIE].path] = over_time.largest_tension(course.σ_YY)
            if not starts.time.steady:
                datasets |= {
                    rows.OF_LOAD[SIE].path: course.work_of_load,
                    rows.OF_FRICTION[SIE].path: course.work_of_friction,
                    rows.PRESSURE.path: course.σ_YY,
                    rows.LEFT[SIE].path: course.σ_XX_left, rows.RIGHT[SIE].path: course.σ_XX_right,
                }  # fmt: skip
            datasets = {path: at_steps(values) for path, values in datasets.items()}
            if alone:
                error = course.error_of_K_I if starts.smooth else 0.0
                datasets[rows.RESIDUAL.path] = np.array(max(course.residual, error))
            if surface:
                datasets |= _on_surface(course, at_steps, response, drive, starts)
            motions.append(datasets)
    return motions


def _on_surface(
    course: Course, at_steps: Callable[[NDArray], NDArray], response: HalfPlane, drive: Drive,
    starts: Starts,
) -> _Datasets:  # fmt: skip
    """Stresses along the surface at the outputs: those before t = 0 and what has changed since."""
    assert course.surface is not None
    steady = FlatPunch(response, float(drive(0.0)))
    σ_YY = steady.σ_YY(ON_SURFACE)
    before = np.array([steady.σ_XX(ON_SURFACE), σ_YY, steady.g * σ_YY]) * float(starts.load(0.0))
    added = at_steps(np.moveaxis(course.surface, 0, 1))[starts.outputs - 1]
    return over_time.stress_datasets(SIE, np.moveaxis(added + before, 0, 1))


def _contact(method: str, *values: NDArray) -> _Datasets:
    return {row[method].path: of for row, of in zip(COMPARED, values, strict=True)}


#: Places beside both ends of the punch, X over a.
_ENDS = np.array([-1.0 - BESIDE, 1.0 + BESIDE])


def _finite_elements(starts: Starts, c: float, clock: Clock) -> list[_Datasets]:
    """Motions at a speed, with the changes from a coarser level as estimates."""
    coarse, fine = (_at_level(level, starts, c, clock) for level in starts.levels(c))
    load, motions = starts.load(starts.times(2)), []
    for drive, (before, coarse_datasets), (values, datasets) in zip(starts.drives[c], coarse, fine):
        # Friction that changes faster than waves run has a steady lean that the pressure never comes to.
        lean = np.zeros(1)
        if starts.changing:
            lean = _steady_centres(starts, c, drive(starts.times()))
        change = largest_change(before, [value[1::2] for value in values], load, lean)
        motions.append(
            _contact(FEM, *values) | {rows.ESTIMATE.path: np.array(change)} | datasets
            | over_time.estimated(coarse_datasets, datasets)
        )  # fmt: skip
    return motions


def _at_level(
    level: Level, starts: Starts, c: float, clock: Clock
) -> list[tuple[tuple[NDArray, ...], _Datasets]]:
    """Motions at a speed at one level of mesh, degree and steps.

    Each has v₀, centre and K_I left and right over time, NaN where the pressure is not smooth; and other
    datasets by path: works, energies, and stresses on the surface.
    """
    from mpi4py import MPI

    from galinx.solvers.fem.dynamic import Energies, Motion
    from galinx.solvers.fem.in_time import SlidingInTime, SurfaceInTime, Watch
    from galinx.solvers.fem.space import Space, distribute

    response = starts.response(c)
    with clock("mesh"):
        mesh = distribute(level.mesh.drawn(), MPI.COMM_SELF)
    space = Space(*mesh, Physical(), level.degree, starts.scene.solid.form, clock=clock)
    motion, motions = Motion(space, response, starts.sharp), []
    solver = SlidingInTime(motion, clock)
    surface = SurfaceInTime(motion, np.append(_ENDS, ON_SURFACE) if starts.time.every else _ENDS)
    watching: list[Watch] = [lambda u, w, way: surface.strain(u)]
    if starts.time.every and level.every == 1:
        watching.append(Energies(motion))
    with clock("steps in time"):
        for drive in starts.drives[c]:
            ways = [
                Way(drive.way * way.direction, way.duration, way.steps // level.every)
                for way in starts.ways
            ]
            run = solver.run(ways, drive, starts.load, starts.time.steady, watching)
            u_X = run.watched[0][1:, : len(_ENDS)]  # on the free surface beside both ends
            left, right = response.σ_XX(u_X, 0.0 * u_X, 0.0 * u_X).T
            datasets = {
                rows.WORK.path: run.work, rows.ENERGY.path: run.energy,
                rows.ABSORBED.path: run.absorbed, rows.OF_LOAD[FEM].path: run.work_of_load,
                rows.OF_FRICTION[FEM].path: run.work_of_friction, rows.LEFT[FEM].path: left,
                rows.RIGHT[FEM].path: right,
            }  # fmt: skip
            if starts.time.every:
                datasets |= _after_steps(surface, run, starts.outputs // level.every, response, drive)
            if len(run.watched) > 1:  # changes since t = 0; the work of carrying adds up step by step
                strain, kinetic, all_strain, all_kinetic, momentum = (
                    run.watched[1] - run.watched[1][0]
                )[1:].T  # fmt: skip
                velocity = response.c * starts.directions(drive)
                datasets |= {
                    rows.CARRIED.path: np.cumsum(velocity * np.diff(momentum, prepend=0.0)),
                    rows.STRAIN.path: strain, rows.KINETIC.path: kinetic,
                    rows.RADIATED.path: all_strain - strain + all_kinetic - kinetic + run.absorbed,
                }  # fmt: skip
            ratios, read = drive(run.t), np.empty((4, len(run.t)))  # by the exponents of each time
            for ratio in np.unique(ratios):
                at, steady = ratios == ratio, FlatPunch(response, ratio)
                of_nodes = motion.X, run.forces[at]
                read[:, at] = contact_numbers(*of_nodes, steady.α, steady.β, level.degree)
            K_left, K_right, tension = read[1:] if starts.smooth else np.nan * read[1:]
            datasets[rows.TENSION[FEM].path] = tension
            motions.append(((run.v0, read[0], K_left, K_right), datasets))
    solver.destroy()
    return motions


def _after_steps(
    surface: Any, run: Any, at: NDArray, response: HalfPlane, drive: Drive
) -> _Datasets:  # fmt: skip
    """Stresses along the surface after steps of these numbers."""
    ratios = drive(run.t[at - 1])
    steady = [FlatPunch(response, ratio) for ratio in ratios]
    σ_YY = np.array([
        surface.pressure(forces, punch.α, punch.β) for forces, punch in zip(run.forces[at - 1], steady)
    ])  # fmt: skip
    σ_XY = ratios[:, None] * σ_YY
    stresses = np.array([response.σ_XX(run.watched[0][at], σ_YY, σ_XY), σ_YY, σ_XY])
    return over_time.stress_datasets(FEM, stresses[..., len(_ENDS) :])
