"""Finite elements as a method: solvers by the mode of their plan."""

from collections.abc import Iterator
from contextlib import ExitStack, closing, contextmanager
from functools import cached_property, partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.clock import Clock

from ..contact import AT_INTERFACES, BELOW, FEM, ON_SURFACE, OWN_PRESSURE, YIELD
from ..contact.fem_plan import FREE_ON_LAYERS, OWN_MESHES, PRESCRIBED_ON_LAYERS, Messages, Planned
from ..contact.solution import ONE_FREE, ContactStress, Solver, Task
from .contact import PUNCHES
from .discretisation import Discretisation, quiet_compiler
from .ladder import to_tolerance
from .own_meshes import BetweenKinks, Followed, LiftedOff
from .space import Space
from .sweep import Fit, train
from .traction import FormulaLevel, PiecesLevel, WholeLevel

#: Levels of states that share a mesh, by the plan's mode.
LEVELS: dict[str, Any] = PUNCHES | {
    "traction": FormulaLevel,
    OWN_PRESSURE: PiecesLevel,
    PRESCRIBED_ON_LAYERS: WholeLevel,
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
        assert plan.fem
        words = (ON_SURFACE, BELOW, YIELD, AT_INTERFACES)
        stresses = frozenset(word for word in words if plan.asks(word, FEM))
        self.work = Discretisation(plan.fem, [*plan.tasks], stresses, progress, clock)

    @cached_property
    def _trained(self) -> Fit | None:
        """Fit through solved speeds for all others, made when first needed; None without one."""
        if self.work.plan.sweep is None:
            return None
        return train(self.work)

    def begin(self) -> None:
        """Make the mesh and the fit of all speeds; collective, before speeds are shared out."""
        self.work.progress.say(f"mesh: {self.work.plan.mesh}")
        self.work.mesh(self.work.plan.cuts)
        with quiet_compiler():
            self._trained  # noqa: B018 - cached

    @contextmanager
    def at(self, task: Task, g: NDArray) -> Iterator[Solver]:
        work = self.work
        work.mesh(work.plan.cuts)
        with quiet_compiler(), ExitStack() as stack:
            solver = stack.enter_context(self._trained.solved_at(task, g)) if self._trained else None
            of = f"{task.number + 1} of {len(work.tasks)}"
            work.progress.say(f"finite elements at c = {task.response.c:g} ({of})")
            if not solver:
                solver = stack.enter_context(closing(self._solved(task, g)))
            yield solver

    def _solved(self, task: Task, g: NDArray) -> Any:
        work, mode = self.work, self.work.plan.mode
        if mode == OWN_MESHES and not task.body.along:
            return BetweenKinks(work, task, g)
        if mode in (OWN_MESHES, FREE_ON_LAYERS):
            return (LiftedOff if task.body.ends == ONE_FREE else Followed)(work, task, g)
        return to_tolerance(work, task, g, partial(LEVELS[mode], work, task))

    @contextmanager
    def one_state(
        self, task: Task, g: float, degree: int
    ) -> Iterator[tuple[Space, Any, NDArray, ContactStress]]:
        """Space, displacement fields, their weights and the pressure of one state, without estimates.

        A prescribed pressure acts as a whole, not piece by piece.
        """
        mode, cuts, of_one = self.work.plan.mode, self.work.plan.cuts, np.array([g])
        # A kink inside a cell spoils that and its neighbours: halved, they reach less far.
        whole = mode == OWN_PRESSURE
        with quiet_compiler():
            space = self.work.space(degree, 2 if whole else cuts)
            kind = WholeLevel if whole else LEVELS[mode]
            with closing(kind(self.work, task, space, of_one)) as level:
                states = level.states(of_one)
                yield space, level.fields, states.contact.weights[0], lambda X: states.pressure.σ_YY(X)[0]
