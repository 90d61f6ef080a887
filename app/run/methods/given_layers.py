"""A pressure of the user's own over layers: what transforms of its tractions say, without an equation.

All is linear in σ_XY/σ_YY: two frictions tell those of all states.
"""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.plan.task import Task
from galinx.app.run.methods.layers import AtSpeed, Punches
from galinx.postprocess.near_ends import turns_at_knots
from galinx.solvers.layers.contact import Found
from galinx.solvers.layers.given import COARSE, FINE, Given
from galinx.solvers.layers.kernel import Kernel
from galinx.solvers.layers.stack import Stack
from galinx.solvers.layers.states import Frictions, Speed
from galinx.solvers.sie.linear import LinearPressure
from galinx.solvers.solution import Surface

#: The frictions.
_NODES = np.array([0.0, 1.0])


def at_speed(task: Task, stack: Stack, tolerance: float, g: NDArray) -> "GivenAtSpeed":
    """The pressure at one speed.

    Args:
        task: the speed.
        stack: layers with lengths over the body's half-width.
        tolerance: relative.
        g: σ_XY/σ_YY, of which all is a linear function.
    """
    pressure = task.body.pressure
    assert pressure
    speed = Speed(task.response, stack, np.zeros_like, tolerance)
    kernel: Kernel = speed.kernel
    length = float(stack.layers[0].H)
    one, other = (Given(pressure, nodes, length, kernel.rough) for nodes in (FINE, COARSE))
    found = Found(one, other, 0.0)  # type: ignore[arg-type]
    return GivenAtSpeed(task, speed, Frictions(_NODES, [found] * len(_NODES)), np.zeros(1))


@dataclass(frozen=True)
class GivenAtSpeed(AtSpeed):
    """A pressure put in at one speed."""

    def states(self, g: NDArray) -> Any:
        return GivenPressures(self, g)


@dataclass(frozen=True)
class GivenPressures(Punches):
    """States with a pressure of the user's own."""

    at: GivenAtSpeed

    @property
    def _pressure(self) -> LinearPressure:
        pressure = self.at.task.body.pressure
        assert pressure
        return pressure

    @property
    def normal_force(self) -> NDArray[np.float64]:
        """Resultant over N/2, (states,)."""
        return np.full(len(self.g), self._pressure.resultant)

    @cached_property
    def both_on_surface(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        return self._on_surface(self.places.X, self.at.regular)

    def _on_surface(
        self, X: NDArray, regular: NDArray
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """σ_YY and σ_XX at X, by strains that the layers add there."""
        response, g = self.at.task.response, self.g[:, None]
        σ = np.tile(self._pressure(X), (2, len(self.g), 1))
        u_X = response.q * σ + (response.n12 + response.m * g) * self._pressure.hilbert(X)
        u_X = u_X + self._of_both(regular)
        return σ, response.σ_XX(u_X, σ, g * σ)

    @cached_property
    def surface(self) -> Surface:
        def σ_XX(X: NDArray) -> NDArray[np.float64]:
            _, (now, _) = self._on_surface(X, self.at.regular_at(X))
            return now

        return replace(super().surface, turns=turns_at_knots(self._pressure, self.g, σ_XX))
