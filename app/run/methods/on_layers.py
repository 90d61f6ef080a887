"""The singular integral equation of layered and graded half-planes as a method."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from numpy.typing import NDArray

from galinx.app.plan.task import Task
from galinx.app.run.methods import found_layers, given_layers, layers
from galinx.app.run.methods.method import Solver


@dataclass(frozen=True)
class Layers:
    """Kernels are found once a speed, pressures for some frictions, from which all others follow.

    Attributes:
        tolerance: relative.
    """

    tolerance: float

    @contextmanager
    def at(self, task: Task, g: NDArray) -> Iterator[Solver]:
        body = task.body
        stack = task.response.stack(body.half_width)  # type: ignore[attr-defined]
        of = given_layers if body.pressure else found_layers if body.found else layers
        yield of.at_speed(task, stack, self.tolerance, g)
