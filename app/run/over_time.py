"""Motions in time of a scene: both methods, speed by speed.

Beside each motion stands the steady motion with the friction of every moment.
Finite elements in time are in a module of their own, so that nothing else imports dolfinx.
"""

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.clock import Clock
from galinx.postprocess import over_time
from galinx.postprocess.over_time import COMPARED, largest_change
from galinx.postprocess.quantities import over_time as rows
from galinx.postprocess.quantities.over_time import APPROACH
from galinx.postprocess.quantities.quantity import FEM, SIE
from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.contact.ends import Punch
from galinx.solvers.contact.on_layers import LayersUnderPunch, weights_between
from galinx.solvers.contact.pressure import Pressure
from galinx.solvers.profiles.punches import Flat
from galinx.solvers.solids.half_plane import HalfPlane
from galinx.solvers.solids.solid import Solid
from galinx.solvers.transient.late_time import approach
from galinx.solvers.transient.punch import ON_SURFACE, PLACES, Course, StartingPunch

from .. import ranks
from ..errors import finite_elements_installed
from ..plan.over_time import Drive, Starts


def _steady_centres(starts: Starts, solid: Solid, c: float, ratios: NDArray) -> NDArray[np.float64]:
    """Centre of the pressure over a in steady motion at frictions σ_XY/σ_YY, (n,)."""
    different, which = np.unique(ratios, return_inverse=True)
    response: Any = starts.response(solid, c)
    if len(response.depths):
        stack, accuracy = response.stack(response.a), 0.1 * starts.tolerance
        punch = Punch(Flat(response.a), response.a, 1.0)
        solved, _ = LayersUnderPunch(response.surface, stack, accuracy, punch).solved(different)
        weights = weights_between(np.array([contact.g for contact in solved]), different)
        return np.asarray((weights @ [_centre(contact.pressure) for contact in solved])[which])
    punches = [FlatPunch(response, ratio) for ratio in different]
    return np.array([punch.β - punch.α for punch in punches])[which]


def _centre(pressure: Pressure) -> float:
    t, forces = pressure.points(0.5)  # the rule's length over a
    return float(forces @ t / forces.sum())


_Datasets = dict[str, NDArray[np.float64]]


#: Largest step of the integral equation's quadrature over a/c_s at a tolerance of 1e-3, of order five;
#: steps within which the load comes on; polynomials there, and more at each tenth of it.
_STEP, _OF_RAMP, _TERMS, _MORE = 0.5, 6, 24, 8

#: A method and a speed.
_Job = tuple[str, float]


def solve_motions(
    starts: Starts, solid: Solid, clock: Clock, done: Callable[[int, int], None] = lambda n, of: None
) -> _Datasets:
    """Motions of all starts over time: datasets by path.

    Under MPI this is collective, speeds and methods are shared out, and rank 0 alone has the datasets.

    Raises:
        SolveError: finite elements could not be solved.
    """
    if FEM in starts.methods:
        _import(clock)
    # Finite elements are the dearer ones, and the fastest of them.
    jobs = [
        (name, c) for name in (FEM, SIE) if name in starts.methods for c in sorted(starts.drives)[::-1]
    ]
    by_job: dict[_Job, list[_Datasets]] = {}
    of = len(starts.methods) * starts.count
    for job, courses in _computed(jobs, lambda job: _courses(job, starts, solid, clock)):
        by_job[job] = courses
        done(sum(map(len, by_job.values())), of)
    return _joined(starts, solid, by_job) if ranks.is_root() else {}


def _courses(job: _Job, starts: Starts, solid: Solid, clock: Clock) -> list[_Datasets]:
    method, c = job
    return (_finite_elements if method == FEM else _integral_equation)(starts, solid, c, clock)


def _computed(
    jobs: list[_Job], solve: Callable[[_Job], list[_Datasets]]
) -> Iterator[tuple[_Job, list[_Datasets]]]:
    """Results of each job, on rank 0."""
    if ranks.size() == 1:
        return ((job, solve(job)) for job in jobs)
    from .share import shared_out

    return shared_out(jobs, lambda job: iter([(job, solve(job))]))


def _joined(starts: Starts, solid: Solid, by_job: dict[_Job, list[_Datasets]]) -> _Datasets:
    """Datasets by path, one row for each start."""
    t = starts.times()
    every = []
    for c, of_speed in starts.drives.items():
        for i, drive in enumerate(of_speed):
            g = np.array([drive(at) for at in t])
            centres = _steady_centres(starts, solid, c, g)
            uniform = not len(solid.depths)
            datasets = {
                rows.SPEED.path: np.array(c), rows.RATIO.path: g[-1], rows.RATIOS.path: g,
                rows.STEADY_CENTRE.path: centres[-1],
                rows.STEADY_K_I.path: np.array(
                    FlatPunch(starts.response(solid, c), g[-1]).K_I if uniform else np.nan
                ),
                rows.CENTRES.path: centres,
                APPROACH.path: np.array(approach(solid, c, g[-1]).within(0.01) if uniform else np.nan),
                rows.DISSIPATED.path: starts.dissipated(c, drive),
                rows.DIRECTION.path: starts.directions(drive),
            }  # fmt: skip
            for method in (SIE, FEM):
                datasets |= by_job[method, c][i] if method in starts.methods else {}
            every.append(datasets)
    joined = {path: np.array([datasets[path] for datasets in every]) for path in every[0]}
    whole = {rows.TIMES.path: t, rows.LOAD.path: starts.load(t)} | joined
    if starts.every:
        whole |= {rows.SURFACE_TIMES.path: t[starts.outputs - 1], rows.SURFACE_PLACES.path: ON_SURFACE}
    if SIE in starts.methods and not starts.steady:
        whole[rows.PLACES.path] = PLACES
    for name in starts.methods:
        whole |= over_time.distances_from_steady(whole, name)
    return whole


def _integral_equation(starts: Starts, solid: Solid, c: float, clock: Clock) -> list[_Datasets]:
    first, response = starts.ways[0], starts.response(solid, c)
    shortest = min(starts.shortest, *(drive.shortest for drive in starts.drives[c]))
    largest = min(_STEP, shortest / _OF_RAMP) * min(starts.tolerance / 1e-3, 1.0) ** 0.2
    finer = int(np.ceil(first.duration / first.steps / largest - 1e-9))
    terms = _TERMS + round(_MORE * max(-3.0 - np.log10(starts.tolerance), 0.0))
    with clock("integral equation in time"):
        steps, whole, alone = first.steps * finer, bool(starts.every), starts.methods == (SIE,)
        punches = {
            way: StartingPunch(response, solid.limit(), first.duration, steps, terms, whole, way, alone)
            for way in {drive.way for drive in starts.drives[c]}
        }
        motions = []
        for drive in starts.drives[c]:
            punch = punches[drive.way]
            g = np.vectorize(drive, otypes=[float]) if drive.constant is None else drive.constant
            course = punch.course(g, starts.load, starts.steady)
            K_I = np.array([course.K_left, course.K_right])
            datasets = _named(
                SIE, (course.v0, course.centre, *(K_I if starts.tells_K_I else np.nan * K_I))
            )
            if not starts.steady:
                works = (
                    course.work_of_load, course.work_of_friction, course.σ_YY, course.σ_XX_left,
                    course.σ_XX_right,
                )  # fmt: skip
                datasets |= {row.path: value for row, value in zip(rows.ALL, works)}
            datasets = {
                path: _until_the_end(value[finer - 1 :: finer], starts)
                for path, value in datasets.items()
            }
            if alone:
                datasets[rows.RESIDUAL.path] = np.array(course.residual)
            if starts.every:
                datasets |= over_time.stress_datasets(
                    SIE, _along_surface(course, finer, response, drive, starts)
                )
            motions.append(datasets)
    return motions


def _along_surface(
    course: Course, finer: int, response: HalfPlane, drive: Drive, starts: Starts
) -> NDArray[np.float64]:
    """σ_XX, σ_YY and σ_XY along the surface at the outputs, (3, times, places); NaN after a turn."""
    assert course.surface is not None
    steady, first = FlatPunch(response, drive(0.0)), float(starts.load(0.0))
    σ_YY = steady.σ_YY(ON_SURFACE)
    before = np.array([steady.σ_XX(ON_SURFACE), σ_YY, steady.g * σ_YY])
    added = np.moveaxis(course.surface[:, finer - 1 :: finer], 0, 1)
    stresses = _until_the_end(added, starts)[starts.outputs - 1] + first * before
    return np.moveaxis(stresses, 0, 1)


def _until_the_end(values: NDArray, starts: Starts) -> NDArray[np.float64]:
    """Values padded to the number of steps by NaN, from where the punch turns round."""
    padded = np.full((starts.steps, *values.shape[1:]), np.nan)
    padded[: len(values)] = values
    return padded


def _named(method: str, values: Any) -> _Datasets:
    return {row[method].path: value for row, value in zip(COMPARED, values)}


def _finite_elements(starts: Starts, solid: Solid, c: float, clock: Clock) -> list[_Datasets]:
    from .time_fem import at_level

    coarse, fine = (at_level(level, starts, solid, c, clock) for level in starts.levels(solid, c))
    load = starts.load(starts.times(2))
    motions = []
    for drive, (before, probed_before), (values, probed) in zip(starts.drives[c], coarse, fine):
        every_other = [value[1::2] for value in values]
        # Friction that changes faster than waves run has a steady lean that the pressure never comes to.
        lean = np.zeros(1)
        if starts.changing:
            lean = _steady_centres(starts, solid, c, np.array([drive(at) for at in starts.times()]))
        motions.append(
            _named(FEM, values)
            | {
                rows.ESTIMATE.path: np.array(largest_change(before, every_other, load, lean)),
                **probed,
                **over_time.estimated(probed_before, probed),
            }
        )  # fmt: skip
    return motions


def _import(clock: Clock) -> None:
    """Import dolfinx on every rank: PETSc begins on all of them, or waits for the others for ever."""
    with clock("import of dolfinx"), finite_elements_installed():
        from . import time_fem  # noqa: F401
