"""Finite elements: the meshes and spaces that all speeds of a plan share."""

import logging
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import ModuleType
from typing import Any

from mpi4py import MPI
from numpy.typing import NDArray

from galinx.app.console.progress import Progress
from galinx.app.plan.fem import FemPlan
from galinx.app.plan.task import Plan, Task
from galinx.app.run.methods import Solver
from galinx.clock import Clock
from galinx.meshes.cells import check_cells
from galinx.meshes.rings import TAGS
from galinx.meshes.store import obtain
from galinx.solvers.fem.distributed import distribute
from galinx.solvers.fem.space import Space


def _punch() -> ModuleType:
    from galinx.app.run.methods import punch

    return punch


def _given() -> ModuleType:
    from galinx.app.run.methods import given

    return given


#: What solves at one speed, by the scene's mode: a module with functions ``solver`` and ``one_state``.
MODES: dict[str, Callable[[], ModuleType]] = {"contact": _punch, "traction": _given}


class FiniteElements:
    """Finite elements for a plan; collective over the ranks that share a mesh.

    Args:
        plan: the plan, with finite elements.
        progress: is told about the work.
        clock: takes wall time by step.

    Attributes:
        plan: the finite elements' part.
        comm: the ranks that share a mesh.
    """

    def __init__(self, plan: Plan, progress: Progress, clock: Clock) -> None:
        assert plan.fem
        self.plan: FemPlan = plan.fem
        self.chunk, self.clock = plan.chunk, clock
        self.comm = MPI.COMM_SELF if plan.fem.shared_speeds else MPI.COMM_WORLD
        self._progress, self._speeds = progress, len(plan.tasks)
        self._meshes: dict[int, tuple[Any, Any]] = {}
        self._spaces: dict[tuple[int, int], Space] = {}

    @contextmanager
    def at(self, task: Task, g: NDArray) -> Iterator[Solver]:
        self._mesh(self.plan.cuts)
        self._progress.say(
            f"finite elements at c = {task.response.c:g} ({task.number + 1} of {self._speeds})"
        )
        with quiet_compiler(), MODES[self.plan.mode]().solver(self, task, g) as solver:
            yield solver

    @contextmanager
    def one_state(self, task: Task, g: float, degree: int) -> Iterator[tuple[Space, Any, NDArray]]:
        """Space, displacement fields and their weights of one state at a degree, no error measured."""
        with quiet_compiler(), MODES[self.plan.mode]().one_state(self, task, g, degree) as found:
            yield found

    def space(self, degree: int, cuts: int = 1) -> Space:
        """The space of a degree on a mesh; speeds share it, its form and its numbering."""
        if (degree, cuts) not in self._spaces:
            with quiet_compiler():
                self._spaces[degree, cuts] = Space(
                    *self._mesh(cuts), TAGS, self.plan.kind.chart, degree, self.plan.form, self.clock
                )
        return self._spaces[degree, cuts]

    def _mesh(self, cuts: int) -> tuple[Any, Any]:
        """The mesh with every cell cut, shared out over ranks, and its facet tags."""
        if cuts not in self._meshes:
            self._progress.say(f"mesh: {self.plan.mesh}")
            with self.clock("mesh"):
                self._meshes[cuts] = self._made(cuts)
        return self._meshes[cuts]

    def _made(self, cuts: int) -> tuple[Any, Any]:
        comm, kind, pattern = self.comm, self.plan.kind, self.plan.pattern
        check_cells(pattern)
        if cuts > 1:  # gmsh's copy of a cut mesh would only be large
            return distribute(kind.build(self.plan.refinement, cuts, comm.rank, comm.size), comm)
        return distribute(obtain(pattern) if comm.rank == 0 else None, comm)


@contextmanager
def quiet_compiler() -> Iterator[None]:
    """FFCx's build tools announce compilations on the root logger, whose level they set themselves."""
    disabled, warnings = logging.root.manager.disable, logging.getLogger("py.warnings")
    level = warnings.level
    logging.disable(logging.INFO)
    warnings.setLevel(logging.ERROR)
    try:
        yield
    finally:
        logging.disable(disabled)
        warnings.setLevel(level)
