"""What the error of finite elements is measured on: numbers of states, and what they are relative to."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.plan.task import Task
from galinx.app.run.methods.discretisation import Discretisation
from galinx.app.run.methods.displacement import Displacement
from galinx.postprocess import scale
from galinx.postprocess.pressure import JacobiPressure
from galinx.postprocess.quantities.quantity import INTENSITIES
from galinx.postprocess.quantities.strata import AT_INTERFACES
from galinx.postprocess.quantities.stresses import BELOW, ON_SURFACE, YIELD

#: Points inside on which the error is measured; of more, so many are picked.
_POINTS = 400

#: Positions r under the punch at which the pressure's smooth factor is measured, both edges among them.
_ACROSS = np.cos(np.pi * np.arange(9) / 8.0)


#: What rounding does to stresses over what the last digits of the displacements alone can, times the root
#: of the response's margin: 0.2 to 2.8 times what breaks mirror images where solids have them.
_SOLVED = 100.0


@dataclass(frozen=True)
class Gauge:
    """Numbers of some states that stand for a word of output.quantities.

    Attributes:
        word: the word.
        values: (states, n).
        scale: what they are relative to, (states, n).
        left: relative error that a level knows of itself, (states,) or 0.
    """

    word: str
    values: NDArray[np.float64]
    scale: NDArray[np.float64]
    left: Any = 0.0

    def change(self, coarse: "Gauge") -> NDArray[np.float64]:
        """Largest relative difference of each state from the same gauge of another level, (states,)."""
        return np.max(np.abs(self.values - coarse.values) / self.scale, axis=1)


def of_pressure(pressure: JacobiPressure, moments: NDArray) -> Gauge:
    """K_I, the pressure all over the contact, and its moments 1 to 5 over the load."""
    factor = pressure.factor(_ACROSS)
    values = np.concatenate([factor, moments[:, 1:6]], axis=1)
    return Gauge(
        INTENSITIES,
        values,
        np.concatenate([scale.of_factor(factor), 2.0 + 0.0 * moments[:, 1:6]], axis=1),
        pressure.unresolved,
    )


def of_intensities(K_I: NDArray) -> Gauge:
    """K_I at both ends, (states, 2)."""
    return Gauge(INTENSITIES, K_I, np.abs(K_I))


def of_in_plane(σ_XX: NDArray, X: NDArray) -> Gauge:
    """σ_XX on the surface, (states, n)."""
    return Gauge(ON_SURFACE, σ_XX, scale.of_in_plane(σ_XX, X))


def of_inside(σ: NDArray, points: NDArray, word: str = BELOW) -> Gauge:
    """Stresses inside, (3, states, m), and the word that asks for them."""
    size = scale.of_inside(σ, *points.T)
    return Gauge(word, np.concatenate(list(σ), axis=1), np.tile(size, (1, 3)))


def of_interfaces(σ: NDArray) -> Gauge:
    """Stresses along interfaces, (4, states, interfaces, n)."""
    size = np.broadcast_to(scale.of_interfaces(σ), σ.shape)
    values, of = (np.moveaxis(part, 1, 0).reshape(σ.shape[1], -1) for part in (σ, size))
    return Gauge(AT_INTERFACES, values, of)


class StressGauges:
    """Stresses that are asked for, of combinations of some fields; derivatives are taken at once.

    Args:
        work: knows what is asked for.
        task: the speed, and the places.
        displaced: gives the displacement at a task's places.
    """

    def __init__(
        self, work: Discretisation, task: Task, displaced: Callable[[Task], Displacement]
    ) -> None:
        self._words, self._task = work.stresses, gauged(task)
        self._displacement = displaced(self._task)
        self._displacement.prepare(self._words)

    @property
    def wanted(self) -> bool:
        """Are there any?"""
        return bool(self._words)

    @property
    def slopes(self) -> Any:
        """Slopes of the fields on the surface, None where no stress is asked for."""
        return self._displacement.slopes if self._words else None

    def of(self, g: NDArray, weights: NDArray, σ_YY: NDArray) -> list[Gauge]:
        """Of states with these weights, and the contact stress on the surface, NaN beside the punch."""
        found, places = [], self._task.places
        if ON_SURFACE in self._words:
            surface = self._displacement.surface(g, weights, σ_YY)
            found.append(of_in_plane(surface.σ_XX, places.X))
        if BELOW in self._words:
            found.append(of_inside(self._displacement.inside(weights), places.points))
        if YIELD in self._words:
            found.append(of_inside(self._displacement.around(weights), places.around, YIELD))
        if AT_INTERFACES in self._words:
            found.append(of_interfaces(self._displacement.interfaces(weights)))
        return found

    def mirrored(self, sign: float, g: NDArray, weights: NDArray, σ_YY: NDArray) -> list[Gauge]:
        """The same, seen from the other side where the sign is negative.

        Points inside have no mirror image, those on the surface have: σ_XX there stands for both.
        """
        if not self._words:
            return []  # no derivative is taken that nobody asks for
        surface = self._displacement.surface(g, weights, σ_YY).σ_XX[:, :: int(sign)]
        return [replace(of_in_plane(surface, self._task.places.X), word=word) for word in self._words]

    def rounding(self, g: NDArray, weights: NDArray, σ_YY: NDArray) -> list[float]:
        """What the fields' last digits can do to stresses, relative; those on the surface for all."""
        if not self._words:
            return []
        σ_XX = self._displacement.surface(g, weights, σ_YY).σ_XX
        noise = self._displacement.rounding(weights) / scale.of_in_plane(σ_XX, self._task.places.X)
        solved = _SOLVED / self._task.response.margin**0.5
        return [solved * float(noise.max())] * len(self._words)


def gauged(task: Task) -> Task:
    """The task at fewer points inside: some at all distances from the edges, from nearest to farthest."""
    points, around = (_some(all_) for all_ in (task.places.points, task.places.around))
    if points is task.places.points and around is task.places.around:
        return task
    return replace(task, places=replace(task.places, points=points, around=around))


def _some(points: NDArray) -> NDArray[np.float64]:
    if len(points) <= _POINTS:
        return points
    X, Y = points.T
    order = np.argsort(np.hypot(np.abs(X) - 1.0, Y), kind="stable")
    picked = order[np.unique(np.linspace(0, len(order) - 1, _POINTS).astype(int))]
    return points[np.sort(picked)]
