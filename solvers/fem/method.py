"""Finite elements as a method: the solvers of both modes."""

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from functools import cached_property
from typing import Any

from numpy.typing import NDArray

from galinx.clock import Clock

from ..contact import FREE_ENDS, OWN_PRESSURE
from ..contact.fem_plan import FREE_ON_LAYERS, OWN_MESHES, PRESCRIBED_ON_LAYERS, Messages, Planned
from ..contact.method import Mode, Pressure, Solver
from ..contact.solution import Task
from . import contact as punch
from . import followed, kinked, prescribed_pressure
from .discretisation import Discretisation, quiet_compiler
from .space import Space
from .sweep import Trained, train

#: By the plan's mode.
MODES = {
    "contact": Mode(punch.solver, punch.one_state, punch.PunchLevel, punch.PunchesAtSpeed),
    "traction": Mode(prescribed_pressure.formula_solver, prescribed_pressure.formula_state),
    OWN_PRESSURE: Mode(prescribed_pressure.solver, prescribed_pressure.one_state),
    FREE_ENDS: Mode(punch.free_solver, punch.free_state, punch.FreeLevel, punch.FreeAtSpeed),
    OWN_MESHES: Mode(kinked.solver),
    FREE_ON_LAYERS: Mode(followed.solver),
    PRESCRIBED_ON_LAYERS: Mode(prescribed_pressure.layered_solver),
}


class FiniteElements:
    """Finite elements for a plan; collective over the ranks that share a mesh.

    Args:
        plan: the plan, with finite elements.
        progress: shows the work.
        clock: takes wall time by step.

    Attributes:
        work: meshes and spaces.
    """

    def __init__(self, plan: Planned, progress: Messages, clock: Clock) -> None:
        self.work = Discretisation(plan, progress, clock)
        self._mode = MODES[self.work.plan.mode]
        self._progress, self._tasks = progress, plan.tasks

    @cached_property
    def _trained(self) -> Trained | None:
        """Fit through solved speeds for all others, made when first needed; None without one."""
        if self.work.plan.sweep is None:
            return None
        return train(self.work, list(self._tasks), self._mode, self._progress.say)

    def begin(self) -> None:
        """Make the mesh and the fit of all speeds; collective, before speeds are shared out."""
        self.work.mesh(self.work.plan.cuts)
        with quiet_compiler():
            self._trained  # noqa: B018 - cached

    @contextmanager
    def at(self, task: Task, g: NDArray) -> Iterator[Solver]:
        self.work.mesh(self.work.plan.cuts)
        with quiet_compiler(), ExitStack() as stack:
            solver = stack.enter_context(self._trained.at(task, g)) if self._trained else None
            self._progress.say(
                f"finite elements at c = {task.response.c:g} ({task.number + 1} of {len(self._tasks)})"
            )
            yield solver or stack.enter_context(self._mode.solver(self.work, task, g))

    @contextmanager
    def one_state(
        self, task: Task, g: float, degree: int
    ) -> Iterator[tuple[Space, Any, NDArray, Pressure]]:
        """Space, displacement fields, their weights and the pressure of one state, without estimates."""
        with quiet_compiler(), self._mode.one_state(self.work, task, g, degree) as state:
            yield state
