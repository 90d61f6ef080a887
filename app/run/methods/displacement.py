"""Stresses from the displacement fields of a speed, on the surface and inside."""

from collections.abc import Collection, Sequence
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.plan.task import Task
from galinx.postprocess.quantities.stresses import BELOW
from galinx.solvers.fem.interior import InteriorGradients
from galinx.solvers.fem.space import Space
from galinx.solvers.fem.surface import SurfaceSlopes
from galinx.solvers.solution import Surface


class Displacement:
    """What is read off combinations of some fields; derivatives are taken once, where they are asked for.

    Args:
        task: the speed, and the places.
        space: the finite element space.
        fields: displacements over N/(2μ).
    """

    def __init__(self, task: Task, space: Space, fields: Sequence[Any]) -> None:
        self._task, self._space, self._fields = task, space, fields

    def prepare(self, words: Collection[str]) -> None:
        """Take the derivatives that words of output.quantities ask for, before the fields are freed."""
        if words:
            self._slopes  # noqa: B018 - cached
        if BELOW in words:
            self._gradients  # noqa: B018

    @cached_property
    def _slopes(self) -> SurfaceSlopes:
        return SurfaceSlopes(self._space, self._fields, self._task.places.X)

    @cached_property
    def _gradients(self) -> InteriorGradients:
        task = self._task
        return InteriorGradients(self._space, task.response, self._fields, task.places.points)

    def surface(self, g: NDArray, weights: NDArray, σ_YY: NDArray, raw: NDArray | None = None) -> Surface:
        """The surface of states with these weights and contact stress, NaN beside the punch."""
        u_X, v_X = self._slopes.of(weights)
        σ = np.nan_to_num(σ_YY)
        σ_XX = self._task.response.σ_XX(u_X, σ, g[:, None] * σ)
        return Surface(self._task.places, σ_YY, σ_XX, raw, v_X)

    def inside(self, weights: NDArray) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY inside of states with these weights, (3, states, m)."""
        found = np.empty((3, len(weights), len(self._task.places.points)))
        for some, gradients in self._gradients.by_batches(weights):
            found[:, :, some] = self._task.response.stresses(gradients)
        return found
