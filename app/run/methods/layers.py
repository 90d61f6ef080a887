"""The singular integral equation of layered and graded half-planes."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.plan.task import Task
from galinx.app.run.methods.method import Solver
from galinx.solvers.layers.states import Frictions, Speed
from galinx.solvers.sie.closed_form import FlatPunch
from galinx.solvers.sie.collocation import weights_hilbert
from galinx.solvers.solution import Surface


@dataclass(frozen=True)
class Layers:
    """Kernels are found once a speed, pressures for some frictions, from which all others follow.

    Attributes:
        tolerance: relative.
    """

    tolerance: float

    @contextmanager
    def at(self, task: Task, g: NDArray) -> Iterator[Solver]:
        body, response = task.body, task.response
        stack = response.stack(body.half_width)  # type: ignore[attr-defined]
        speed = Speed(response, stack, body.slope, self.tolerance)
        yield AtSpeed(task, speed, *speed.solved(g))


@dataclass(frozen=True)
class AtSpeed:
    """Punches at one speed.

    Attributes:
        task: the speed.
        speed: kernels.
        nodes: pressures.
        interpolated: error that interpolation over frictions leaves, relative.
    """

    task: Task
    speed: Speed
    nodes: Frictions
    interpolated: NDArray[np.float64]

    def states(self, g: NDArray) -> Any:
        return Punches(self, g)

    def record(self) -> dict[str, Any]:
        return {}

    @cached_property
    def estimate(self) -> float:
        """Of the pressure, relative."""
        return float(self.nodes.change + self.interpolated.max() + self.speed.rounding)

    @cached_property
    def near(self) -> NDArray[np.bool_]:
        """Positions on the surface at which the pressure without its weight is known."""
        return np.abs(self.task.places.X) <= self.nodes.each[0].pressure.near

    @cached_property
    def series(self) -> NDArray[np.float64]:
        """Pressures without their weights there, (nodes, n)."""
        X = self.task.places.X[self.near]
        return self.nodes.read(lambda pressure: pressure.series(X))

    @cached_property
    def rest(self) -> NDArray[np.float64]:
        """What is regular of their Hilbert transforms, (nodes, n)."""
        return self.nodes.read(lambda pressure: pressure.rest(self.task.places.X))

    @cached_property
    def regular(self) -> NDArray[np.float64]:
        """Strains μ u,X that the layers add, (nodes, n)."""
        X, kernel = self.task.places.X, self.speed.kernel
        by_kernel = self.nodes.read(lambda pressure: pressure.integral(kernel, X))
        return np.asarray(by_kernel[..., 1] + self.nodes.g[:, None] * by_kernel[..., 0])


@dataclass(frozen=True)
class Punches:
    """Punches with several frictions.

    Attributes:
        at: their speed.
        g: σ_XY/σ_YY, (states,).
    """

    at: AtSpeed
    g: NDArray[np.float64]

    @cached_property
    def local(self) -> FlatPunch:
        """The edges, like those on a half-plane of the surface's solid."""
        return FlatPunch(self.at.task.response, self.g)

    @cached_property
    def _by_nodes(self) -> NDArray[np.float64]:
        return self.at.nodes.at(self.g)

    @cached_property
    def K_I(self) -> NDArray[np.float64]:
        """At X = -a and X = a, (states, 2)."""
        ends = self.at.nodes.read(lambda pressure: pressure.series(np.array([-1.0, 1.0])))
        return -0.5 * self._by_nodes @ ends

    @cached_property
    def estimates(self) -> NDArray[np.float64]:
        """Relative errors, (states,)."""
        return np.full(len(self.g), self.at.estimate)

    @cached_property
    def surface(self) -> Surface:
        at, places, response = self.at, self.at.task.places, self.at.task.response
        X, g, local = places.X, self.g[:, None], self.local
        α, β = local.α[:, None], local.β[:, None]
        p = np.zeros((len(self.g), len(X)))
        p[:, at.near] = self._by_nodes @ at.series
        with np.errstate(invalid="ignore"):
            σ = np.where(places.under, (1.0 - X) ** α * (1.0 + X) ** β * p, 0.0)
        H = p * np.where(at.near, weights_hilbert(α, β, X), 0.0) + self._by_nodes @ at.rest
        u_X = response.q * σ + (response.n12 + response.m * g) * H + self._by_nodes @ at.regular
        σ_YY = np.where(places.under, σ, np.nan)
        return Surface(places, σ_YY, response.σ_XX(u_X, σ, g * σ))
