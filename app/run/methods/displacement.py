"""Stresses from the displacement fields of a speed, on the surface and inside.

Stresses of a contact with free ends, those next to the ends from a little farther away.
"""

from collections.abc import Collection, Sequence
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.free_ends import slopes_towards_ends
from galinx.postprocess.quantities.layers import AT_INTERFACES
from galinx.postprocess.quantities.stresses import BELOW, YIELD
from galinx.solvers.fem.fields import InteriorGradients, KeptValues, SurfaceSlopes
from galinx.solvers.fem.punch import FittedSlopes
from galinx.solvers.fem.space import Space
from galinx.solvers.solids.solid import ByCells
from galinx.solvers.solution import Surface

from ...plan.task import Task


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
        if AT_INTERFACES in words:
            self._interfaces  # noqa: B018

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

    @cached_property
    def _interfaces(self) -> list[tuple[NDArray, InteriorGradients, InteriorGradients]]:
        """Points of each interface, and gradients above and below it."""
        places, found = self._task.places, []
        for depth in places.interfaces.tolist():
            points = np.column_stack([places.along, np.full_like(places.along, -depth)])
            found.append((points, self._at(points), self._at(points, -1)))
        return found

    def _at(self, points: NDArray, side: int = 1) -> InteriorGradients:
        """Gradients at points; at an interface above it (1) or below (-1)."""
        response = self._task.response
        return InteriorGradients(self._space, response, self._fields, points, self._values, side)

    def _stresses(self, points: NDArray, gradients: NDArray, side: int = 1) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY at points (n, 2) of gradients (states, n, 2, 2), as of ``_at``."""
        response = self._task.response
        if not isinstance(response, ByCells):
            return response.stresses(gradients)
        Y = points[:, 1]
        return response.stresses_at(response.solids(Y, side), Y, gradients)

    def surface(self, g: NDArray, weights: NDArray, σ_YY: NDArray, raw: NDArray | None = None) -> Surface:
        """The surface of states with these weights and contact stress, NaN beside the punch."""
        u_X, v_X = self._slopes.of(weights)
        σ = np.nan_to_num(σ_YY)
        σ_XX = self._task.response.σ_XX(u_X, σ, g[:, None] * σ)
        return Surface(self._task.places, σ_YY, σ_XX, raw, v_X)

    def around(self, weights: NDArray) -> NDArray[np.float64]:
        """The same where stresses are looked at for yield, (3, states, k)."""
        return self._stresses(self._task.places.around, self._around.of(weights))

    def at(self, points: NDArray, weights: NDArray) -> NDArray[np.float64]:
        """The same at points of all states, (1, n, 2), or of each, (states, n, 2): (3, states, n)."""
        flat = points.reshape(-1, 2)
        found = self._at(flat)
        if len(points) == 1:
            return self._stresses(flat, found.of(weights))
        each = found.of_each(weights)
        whole = self._stresses(flat, each.reshape(1, -1, 2, 2))
        return whole.reshape(3, *each.shape[:2])

    def interfaces(self, weights: NDArray) -> NDArray[np.float64]:
        """σ_YY, σ_XY, σ_XX above and below along every interface, (4, states, interfaces, n).

        Tractions, which both sides share, are told by the softer one rather than by the stiffer, whose
        other stresses may be large beside them: weights are as the other side's modulus.
        """
        found = []
        for i, (points, above, below) in enumerate(self._interfaces):
            one = self._stresses(points, above.of(weights))
            other = self._stresses(points, below.of(weights), -1)
            upper, lower = self._task.body.solid.beside(i)  # type: ignore[attr-defined]
            share = lower.μ / (upper.μ + lower.μ)
            tractions = share * one[1:] + (1.0 - share) * other[1:]
            found.append([*tractions, one[0], other[0]])
        return np.moveaxis(np.array(found), 0, 2)

    def rounding(self, weights: NDArray) -> NDArray[np.float64]:
        """What the last digits of the fields can do to σ_XX on the surface, (states, n)."""
        noise = self._slopes.rounding(weights)
        return np.abs(self._task.response.σ_XX(noise, 0.0 * noise, 0.0 * noise))

    def inside(self, weights: NDArray) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY inside of states with these weights, (3, states, m)."""
        found = np.empty((3, len(weights), len(self._task.places.points)))
        for some, gradients in self._gradients.by_batches(weights):
            found[:, :, some] = self._stresses(self._task.places.points[some], gradients)
        return found


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
