"""Stresses of a contact with free ends, those next to the ends from a little farther away."""

from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.plan.task import Task
from galinx.app.run.methods.displacement import Displacement
from galinx.postprocess.near_ends import slopes_towards_ends
from galinx.solvers.fem.space import Space
from galinx.solvers.fem.surface import SurfaceSlopes


class KinkedDisplacement(Displacement):
    """See :class:`Displacement`.

    Args:
        task: the speed, and the places.
        space: the finite element space.
        field: displacement over N/(2μ).
        gaps: distances of the left and the right end from the nearest kink, over a.
        exponents: of the pressure at the left and at the right end.
    """

    def __init__(
        self,
        task: Task,
        space: Space,
        field: Any,
        gaps: tuple[float, float],
        exponents: tuple[float, float],
    ) -> None:
        super().__init__(task, space, [field])
        self._gaps, self._exponents = gaps, exponents

    def at_places_of(self, task: Task) -> "KinkedDisplacement":
        """The same, asked at other places."""
        return KinkedDisplacement(task, self._space, self._fields[0], self._gaps, self._exponents)

    def strain(self, X: NDArray) -> NDArray[np.float64]:
        """μ u,X over N/(2a) at positions on the surface, (n,), as the polynomials have it."""
        return SurfaceSlopes(self._space, self._fields, X).of(np.ones((1, 1)))[0][0]

    @cached_property
    def _slopes(self) -> Any:
        places, of_places = slopes_towards_ends(self._task.places.X, self._gaps, self._exponents)
        return _Slopes(SurfaceSlopes(self._space, self._fields, places), of_places)


class _Slopes:
    """Combinations of slopes at some places; see :class:`SurfaceSlopes`.

    Args:
        slopes: at some places.
        of_places: what multiplies these, (wanted, places).
    """

    def __init__(self, slopes: SurfaceSlopes, of_places: NDArray) -> None:
        self._slopes, self._of_places = slopes, of_places

    def of(self, weights: NDArray) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        u_X, v_X = self._slopes.of(weights)
        return u_X @ self._of_places.T, v_X @ self._of_places.T

    def rounding(self, weights: NDArray) -> NDArray[np.float64]:
        return self._slopes.rounding(weights) @ np.abs(self._of_places).T
