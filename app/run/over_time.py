"""Starts from rest of a scene: both methods, one speed after the other."""

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app import ranks
from galinx.app.errors import finite_elements_installed
from galinx.app.plan.over_time import Level, Starts
from galinx.clock import Clock
from galinx.meshes.charts import Physical
from galinx.meshes.rings import TAGS
from galinx.postprocess.compare_over_time import TOLD, largest_change
from galinx.postprocess.over_time import told
from galinx.postprocess.quantities import over_time as rows
from galinx.postprocess.quantities.quantity import FEM, SIE
from galinx.solvers.sie.closed_form import FlatPunch
from galinx.solvers.solids.isotropic import Isotropic
from galinx.solvers.solids.solid import Solid
from galinx.solvers.transient.punch import StartingPunch, smooth

#: Largest step of the integral equation's quadrature over a/c_s at a tolerance of 1e-3, of order five; steps
#: within which the load comes on; polynomials.
_STEP, _OF_RAMP, _TERMS = 0.5, 6, 24

_Found = dict[str, NDArray[np.float64]]
#: A method and a speed.
_Job = tuple[str, float]


def follow(
    starts: Starts, solid: Solid, clock: Clock, done: Callable[[int, int], None] = lambda n, of: None
) -> _Found:
    """What happens over time in each start: datasets by path.

    Under MPI this is collective, speeds and methods are shared out, and rank 0 alone has what is found.

    Raises:
        SolveError: finite elements could not be solved.
    """
    assert isinstance(solid, Isotropic)  # what the plan has made sure of
    if FEM in starts.methods:
        _import(clock)
    # Finite elements are the dearer ones, and the fastest of them.
    jobs = [(name, c) for name in (FEM, SIE) if name in starts.methods for c in sorted(starts.g)[::-1]]
    found: dict[_Job, list[_Found]] = {}
    of = len(starts.methods) * starts.count
    for job, courses in _computed(jobs, lambda job: _courses(job, starts, solid, clock)):
        found[job] = courses
        done(sum(map(len, found.values())), of)
    return _joined(starts, solid, found) if ranks.is_root() else {}


def _courses(job: _Job, starts: Starts, solid: Isotropic, clock: Clock) -> list[_Found]:
    method, c = job
    return (_finite_elements if method == FEM else _integral_equation)(starts, solid, c, clock)


def _computed(
    jobs: list[_Job], solve: Callable[[_Job], list[_Found]]
) -> Iterator[tuple[_Job, list[_Found]]]:
    """What each job gives, on rank 0."""
    if ranks.size() == 1:
        return ((job, solve(job)) for job in jobs)
    from galinx.app.run.share import shared_out

    return shared_out(jobs, lambda job: iter([(job, solve(job))]))


def _joined(starts: Starts, solid: Isotropic, found: dict[_Job, list[_Found]]) -> _Found:
    """Each start a row."""
    t = starts.end / starts.steps * np.arange(1, starts.steps + 1)
    every = []
    for c, of_speed in starts.g.items():
        for i, g in enumerate(of_speed):
            steady = FlatPunch(solid.response(c), g)
            one = {
                rows.SPEED.path: np.array(c), rows.RATIO.path: np.array(g),
                rows.STEADY_CENTRE.path: np.array(steady.β - steady.α),
                rows.STEADY_K_I.path: np.array(steady.K_I),
            }  # fmt: skip
            for method in (SIE, FEM):
                one |= found[method, c][i] if method in starts.methods else {}
            every.append(one)
    joined = {path: np.array([one[path] for one in every]) for path in every[0]}
    return {rows.TIMES.path: t, rows.LOAD.path: smooth(t, starts.ramp)} | joined


def _integral_equation(starts: Starts, solid: Isotropic, c: float, clock: Clock) -> list[_Found]:
    steps = starts.steps
    largest = min(_STEP, starts.ramp / _OF_RAMP) * min(starts.tolerance / 1e-3, 1.0) ** 0.2
    finer = int(np.ceil(starts.end / steps / largest - 1e-9))
    response = solid.response(c)
    with clock("integral equation in time"):
        punch = StartingPunch(response.k, solid.limit(), response, starts.end, steps * finer, _TERMS)
        found = []
        for g in starts.g[c]:
            course = punch.course(g, lambda t: smooth(t, starts.ramp))
            values = course.v0, course.centre, course.K_left, course.K_right
            found.append(_named(SIE, [value[finer - 1 :: finer] for value in values]))
    return found


def _named(method: str, values: Any) -> _Found:
    return {row[method].path: value for row, value in zip(TOLD, values)}


def _finite_elements(starts: Starts, solid: Isotropic, c: float, clock: Clock) -> list[_Found]:
    coarse, fine = (_at_level(level, starts, solid, c, clock) for level in starts.levels(solid, c))
    load = smooth(coarse[0][1], starts.ramp)
    found = []
    for (before, _, _), (values, _, energies) in zip(coarse, fine):
        every_other = [value[1::2] for value in values]
        found.append(
            _named(FEM, values)
            | {
                rows.ESTIMATE.path: np.array(largest_change(before, every_other, load)),
                **dict(zip((row.path for row in (rows.WORK, rows.ENERGY, rows.ABSORBED)), energies)),
            }
        )  # fmt: skip
    return found


def _constant(g: float, _: float) -> float:
    return g


def _share(ramp: float, t: float) -> float:
    return float(smooth(np.array(t), ramp))


def _import(clock: Clock) -> None:
    """On every rank, for PETSc begins on all of them or waits for the others for ever."""
    with clock("import of dolfinx"), finite_elements_installed():
        import galinx.solvers.fem.start  # noqa: F401


def _at_level(level: Level, starts: Starts, solid: Isotropic, c: float, clock: Clock) -> list[Any]:
    """Values, times, and work with energies of each friction at a speed."""
    from mpi4py import MPI

    from galinx.solvers.fem.distributed import distribute
    from galinx.solvers.fem.dynamic import Motion
    from galinx.solvers.fem.space import Space
    from galinx.solvers.fem.start import StartFromRest

    response = solid.response(c)
    with clock("mesh"):
        mesh = distribute(level.mesh.drawn(), MPI.COMM_SELF)
    motion = Motion(Space(*mesh, TAGS, Physical(), level.degree, solid.form, clock), response)
    solver = StartFromRest(motion, starts.end / level.steps, clock)
    found = []
    with clock("steps in time"):
        for g in starts.g[c]:
            run = solver.run(level.steps, partial(_constant, g), partial(_share, starts.ramp))
            steady = FlatPunch(response, g)
            read = told(motion.X, run.forces, steady.α, steady.β)
            values = run.v0, read.centre, read.K_left, read.K_right
            found.append((values, run.t, (run.work, run.energy, run.absorbed)))
    solver.destroy()
    return found
