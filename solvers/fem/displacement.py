"""Stresses from the displacement fields of a speed, on the surface, inside and at interfaces.

Next to free ends of a contact, or to knots of a prescribed pressure, slopes may be continued from a
little farther away, where finite elements have more digits.
"""

from collections.abc import Callable, Sequence
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..contact.solution import Task
from ..contact.stresses import Surface
from .fields import Gradients, InteriorGradients, KeptValues, Slopes, surface_slopes
from .space import Space


class Displacement:
    """Stresses of combinations of displacement fields; each derivative is taken once, when first needed.

    Args:
        task: the speed, and the places.
        space: the finite element space.
        fields: displacements over N/(2μ).
        slopes: slopes of the fields along X on the surface, from a fit; computed if None.
        continuation: gives, for places X over a on the surface, the samples of slopes that are needed,
            and the map from slopes there to slopes at the places; None for slopes at the places.
    """

    def __init__(
        self, task: Task, space: Space, fields: Sequence[Any], slopes: Slopes | None = None,
        continuation: Callable[[NDArray], tuple[NDArray, NDArray]] | None = None,
    ) -> None:  # fmt: skip
        self._task, self._space, self._fields, self._continuation = task, space, fields, continuation
        self._kept: dict[tuple[int, int], Gradients] = {}
        if slopes is not None:
            self.slopes = slopes

    @cached_property
    def slopes(self) -> Slopes:
        """Slopes of the fields along X at the places on the surface."""
        X = self._task.places.X
        if self._continuation is None:
            return surface_slopes(self._space, self._fields, X)
        samples, of_samples = self._continuation(X)
        return surface_slopes(self._space, self._fields, samples).continued(of_samples)

    def strain(self, X: NDArray) -> NDArray[np.float64]:
        """Strain μ u,X of the first field over N/(2a) at positions on the surface, (n,)."""
        return surface_slopes(self._space, self._fields[:1], X).of(np.ones((1, 1)))[0][0]

    @cached_property
    def _values(self) -> KeptValues:
        return KeptValues(self._space, self._task.response, self._fields)

    @cached_property
    def _along(self) -> list[NDArray[np.float64]]:
        """Points along each interface, (n, 2)."""
        places = self._task.places
        return [
            np.column_stack([places.along, np.full_like(places.along, -depth)])
            for depth in places.interfaces
        ]

    def _at(self, points: NDArray, side: int = 1) -> Gradients:
        """Gradients at points (n, 2), above an interface (side 1) or below it (-1)."""
        return InteriorGradients(self._space, self._task.response, self._values, points, side)

    def _stresses(self, points: NDArray, weights: NDArray, side: int = 1) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY, (3, states, n), at points of the task, (n, 2); gradients are kept."""
        key = id(points), side
        if key not in self._kept:
            self._kept[key] = self._at(points, side)
        σ = np.empty((3, len(weights), len(points)))
        for batch, gradients in self._kept[key].by_batches(weights):
            σ[:, :, batch] = self._task.response.stresses_at(points[batch, 1], gradients, side)
        return σ

    def surface(
        self, ratio: NDArray, weights: NDArray, σ_YY: NDArray, raw: NDArray | None = None
    ) -> Surface:
        """Stresses on the surface, by weights (states, fields) and σ_YY, (states, n) or (n,).

        Args:
            ratio: σ_XY/σ_YY, (states, n) or (states, 1).
            weights, σ_YY, raw: of the states.
        """
        u_X, v_X = self.slopes.of(weights)
        places = self._task.places
        σ = np.where(places.under, σ_YY, 0.0)
        σ_XX = self._task.response.σ_XX(u_X, σ, ratio * σ)
        σ_YY = np.broadcast_to(np.where(places.under, σ_YY, np.nan), σ_XX.shape)
        return Surface(places, σ_YY, σ_XX, raw, v_X)

    def inside(self, weights: NDArray) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY inside by weights (states, fields), (3, states, m)."""
        return self._stresses(self._task.places.points, weights)

    def around(self, weights: NDArray) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY at the points checked for yield, (3, states, k)."""
        return self._stresses(self._task.places.around, weights)

    def at(self, points: NDArray, weights: NDArray) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY, (3, states, n), at points (1, n, 2) of all states or (states, n, 2)."""
        flat = points.reshape(-1, 2)
        gradients = self._at(flat)
        if len(points) == 1:
            return self._task.response.stresses_at(flat[:, 1], gradients.of(weights))
        each = gradients.of_each(weights)
        whole = self._task.response.stresses_at(flat[:, 1], each.reshape(1, -1, 2, 2))
        return whole.reshape(3, *each.shape[:2])

    def interfaces(self, weights: NDArray) -> NDArray[np.float64]:
        """σ_YY, σ_XY, σ_XX above and below along every interface, (4, states, interfaces, n).

        Tractions, which both sides share, are taken from the softer side rather than from the stiffer,
        whose other stresses may be large beside them: each side's weight goes with the other's modulus.
        """
        stresses = []
        for i, points in enumerate(self._along):
            σ_above, σ_below = (self._stresses(points, weights, side) for side in (1, -1))
            upper, lower = self._task.body.solid.beside(i)  # type: ignore[attr-defined]
            share = lower.μ / (upper.μ + lower.μ)
            tractions = share * σ_above[1:] + (1.0 - share) * σ_below[1:]
            stresses.append([*tractions, σ_above[0], σ_below[0]])
        return np.moveaxis(np.array(stresses), 0, 2)

    def rounding(self, weights: NDArray) -> NDArray[np.float64]:
        """Effect of rounding of the fields on σ_XX on the surface, (states, n)."""
        noise = self.slopes.rounding(weights)
        return np.abs(self._task.response.σ_XX(noise, 0.0 * noise, 0.0 * noise))
