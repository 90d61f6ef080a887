"""Stresses from the displacement fields of a speed, on the surface and inside."""

from collections.abc import Collection, Sequence
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.plan.task import Task
from galinx.postprocess.quantities.stresses import BELOW, YIELD
from galinx.solvers.fem.fitted import FittedSlopes
from galinx.solvers.fem.interior import InteriorGradients, KeptValues
from galinx.solvers.fem.space import Space
from galinx.solvers.fem.surface import SurfaceSlopes
from galinx.solvers.solution import Surface


class Displacement:
    """What is read off combinations of some fields; derivatives are taken once, where they are asked for.

    Args:
        task: the speed, and the places.
        space: the finite element space.
        fields: displacements over N/(2μ).
        slopes: theirs along X on the surface, where they are known.
    """

    def __init__(
        self, task: Task, space: Space, fields: Sequence[Any], slopes: FittedSlopes | None = None
    ) -> None:
        self._task, self._space, self._fields = task, space, fields
        self._known = slopes

    def prepare(self, words: Collection[str]) -> None:
        """Take the derivatives that words of output.quantities ask for, before the fields are freed."""
        if words:
            self._slopes  # noqa: B018 - cached
        if BELOW in words:
            self._gradients  # noqa: B018
        if YIELD in words:
            self._around  # noqa: B018

    @property
    def slopes(self) -> SurfaceSlopes | FittedSlopes:
        """Slopes of the fields along X at the places on the surface."""
        return self._slopes

    @cached_property
    def _slopes(self) -> SurfaceSlopes | FittedSlopes:
        if self._known is not None:
            return self._known
        return SurfaceSlopes(self._space, self._fields, self._task.places.X)

    @cached_property
    def _gradients(self) -> InteriorGradients:
        return self._at(self._task.places.points)

    @cached_property
    def _around(self) -> InteriorGradients:
        return self._at(self._task.places.around)

    @cached_property
    def _values(self) -> KeptValues:
        return KeptValues(self._space, self._task.response, self._fields)

    def _at(self, points: NDArray) -> InteriorGradients:
        return InteriorGradients(self._space, self._task.response, self._fields, points, self._values)

    def surface(self, g: NDArray, weights: NDArray, σ_YY: NDArray, raw: NDArray | None = None) -> Surface:
        """The surface of states with these weights and contact stress, NaN beside the punch."""
        u_X, v_X = self._slopes.of(weights)
        σ = np.nan_to_num(σ_YY)
        σ_XX = self._task.response.σ_XX(u_X, σ, g[:, None] * σ)
        return Surface(self._task.places, σ_YY, σ_XX, raw, v_X)

    def around(self, weights: NDArray) -> NDArray[np.float64]:
        """The same where stresses are looked at for yield, (3, states, k)."""
        return self._task.response.stresses(self._around.of(weights))

    def at(self, points: NDArray, weights: NDArray) -> NDArray[np.float64]:
        """The same at points of all states, (1, n, 2), or of each, (states, n, 2): (3, states, n)."""
        found = self._at(points.reshape(-1, 2))
        together = len(points) == 1
        return self._task.response.stresses((found.of if together else found.of_each)(weights))

    def rounding(self, weights: NDArray) -> NDArray[np.float64]:
        """What the last digits of the fields can do to σ_XX on the surface, (states, n)."""
        noise = self._slopes.rounding(weights)
        return np.abs(self._task.response.σ_XX(noise, 0.0 * noise, 0.0 * noise))

    def inside(self, weights: NDArray) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY inside of states with these weights, (3, states, m)."""
        found = np.empty((3, len(weights), len(self._task.places.points)))
        for some, gradients in self._gradients.by_batches(weights):
            found[:, :, some] = self._task.response.stresses(gradients)
        return found
