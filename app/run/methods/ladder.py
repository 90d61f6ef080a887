"""Solutions of rising degree at one speed: what the error is measured on."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

from numpy.typing import NDArray

from galinx.app.plan.fem import FemPlan
from galinx.app.plan.task import Task
from galinx.app.run.methods.gauge import Gauge
from galinx.solvers.fem.space import Space

#: Levels that are held at once: two differences measure the error.
_HELD = 3


class Spaces(Protocol):
    """What gives the spaces of a ladder."""

    @property
    def plan(self) -> FemPlan: ...

    def space(self, degree: int, cuts: int = 1) -> Space: ...

    def warn(self, text: str) -> None:
        """What the user should know."""


class Level(Protocol):
    """A solution at one degree; what it measures can be asked for after its release."""

    @property
    def space(self) -> Space: ...
    @property
    def factor(self) -> Any:
        """Of the linear system, with numbers of its work."""

    @property
    def mirrored(self) -> bool:
        """Does ``rounding`` say what mirror images show, and not only what rounding might do?"""

    def measured(self, g: NDArray, load: Any = None) -> list[Gauge]:
        """What the error is measured on of states with these values of σ_XY/σ_YY.

        Args:
            g: σ_XY/σ_YY, (states,).
            load: of each state [N/m], (states,); that of the task if not given.
        """

    def rounding(self, g: NDArray) -> list[float]:
        """What rounding alone is seen to do to each of these, relative."""

    def release(self) -> None:
        """Free factor and fields."""

    def destroy(self) -> None:
        """Free everything."""


class Ladder:
    """Solutions of rising degree, or on meshes cut more and more finely, at one speed.

    Args:
        work: gives spaces.
        task: the speed.
        solved: solves on a space for all values of g.
        degree: to begin with; the plan's if not given.

    Attributes:
        degree: of the last level.
        levels: the last ones.
        changes: largest change from the degree before of what the error is measured on, by degree and by
            word of output.quantities.
    """

    def __init__(
        self, work: Spaces, task: Task, solved: Callable[[Space, NDArray], Any],
        degree: int | None = None,
    ) -> None:  # fmt: skip
        self.work, self.task = work, task
        self.degree = degree or work.plan.degrees[task.number]
        self.levels: list[Any] = []
        self.changes: dict[int, dict[str, float]] = {}
        self._solved = solved
        self._work = WorkDone()

    def add(self, g: NDArray, degree: int, cuts: int = 1) -> None:
        """Solve at a degree for all values of g; the factor before makes room."""
        for level in self.levels[-1:]:
            level.release()
        self.levels.append(self._solved(self.work.space(degree, cuts), g))
        self.degree = degree
        if len(self.levels) > _HELD:
            old = self.levels.pop(0)
            self._work.count(old)
            old.destroy()

    def record(self) -> dict[str, Any]:
        """Numbers of the work on all levels, and the size of the last."""
        space = self.levels[-1].space
        return {"cells": space.cells, "unknowns": space.size, "degree": space.degree} | vars(self.done)

    @property
    def done(self) -> "WorkDone":
        """Numbers of the work on all levels."""
        total = WorkDone(**vars(self._work))
        for level in self.levels:
            total.count(level)
        return total

    def destroy(self) -> None:
        for level in self.levels:
            level.destroy()


@dataclass
class WorkDone:
    """Numbers of linear algebra, as they are archived."""

    factorisations: int = 0
    back_substitutions: int = 0
    iterations: int = 0
    largest_residual: float = 0.0
    largest_condition: float = 0.0

    def count(self, level: Any) -> None:
        """Count the work of what has a factor."""
        factor = level.factor
        self.add(WorkDone(1, factor.solves, factor.iterations, factor.largest_residual, factor.condition))

    def add(self, other: "WorkDone") -> None:
        """Count other work, too."""
        self.factorisations += other.factorisations
        self.back_substitutions += other.back_substitutions
        self.iterations = max(self.iterations, other.iterations)
        self.largest_residual = max(self.largest_residual, other.largest_residual)
        self.largest_condition = max(self.largest_condition, other.largest_condition)
