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
from galinx.solvers.layers.inside import Level
from galinx.solvers.layers.medium import Medium
from galinx.solvers.layers.states import Frictions, Speed
from galinx.solvers.sie.closed_form import FlatPunch
from galinx.solvers.sie.collocation import weights_hilbert
from galinx.solvers.solution import Places, Surface


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

    def level(self, depth: float, X: NDArray) -> tuple[Level, NDArray[np.float64]]:
        """A depth, and u,X, σ_YY and σ_XY there, (nodes, 3, n)."""
        reach = 1.0 + float(np.abs(X).max())
        here = Level(self.speed.stack, depth, reach, self.speed.tolerance)
        rules = [one.pressure.points(depth) for one in self.nodes.each]
        return here, np.array([here.read(*rule, g, X) for rule, g in zip(rules, self.nodes.g.tolist())])

    @cached_property
    def interfaces(self) -> NDArray[np.float64]:
        """σ_YY, σ_XY, σ_XX above and below along every interface, (4, nodes, interfaces, n)."""
        places, found = self.task.places, []
        for depth in places.interfaces.tolist():
            level, (u_X, σ_YY, σ_XY) = _split(self.level(depth, places.along))
            both = [_in_plane(medium, u_X, σ_YY, σ_XY) for medium in level.media]
            found.append([σ_YY, σ_XY, *both])
        return np.moveaxis(np.array(found), 0, 2)

    @cached_property
    def inside(self) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY at points inside, (3, nodes, m); those at an interface are above it."""
        points = self.task.places.points
        found = np.empty((3, len(self.nodes.g), len(points)))
        for Y in np.unique(points[:, 1]).tolist():
            some = points[:, 1] == Y
            level, (u_X, σ_YY, σ_XY) = _split(self.level(-Y, points[some, 0]))
            found[:, :, some] = _in_plane(level.media[0], u_X, σ_YY, σ_XY), σ_YY, σ_XY
        return found

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

    @property
    def places(self) -> Places:
        """Where stresses are."""
        return self.at.task.places

    @cached_property
    def interfaces(self) -> NDArray[np.float64]:
        """σ_YY, σ_XY, σ_XX above and below along every interface, (4, states, interfaces, n)."""
        return np.einsum("sg,cgin->csin", self._by_nodes, self.at.interfaces)

    @cached_property
    def inside(self) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY at points inside, (3, states, m)."""
        return np.einsum("sg,cgm->csm", self._by_nodes, self.at.inside)

    @cached_property
    def σ_ZZ(self) -> NDArray[np.float64]:
        """Normal stress out of the plane there, (states, m)."""
        body, points = self.at.task.body, self.places.points
        found = np.empty(self.inside.shape[1:])
        for Y in np.unique(points[:, 1]).tolist():
            some = points[:, 1] == Y
            solid = body.solid.at(-Y * body.half_width)  # type: ignore[attr-defined]
            found[:, some] = solid.σ_ZZ(*self.inside[:, :, some])
        return found

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


def _split(read: tuple[Level, NDArray]) -> tuple[Level, NDArray]:
    return read[0], np.moveaxis(read[1], 1, 0)


def _in_plane(medium: Medium, u_X: NDArray, σ_YY: NDArray, σ_XY: NDArray) -> NDArray[np.float64]:
    """σ_XX in a solid, from strain and tractions that both sides of an interface share."""
    M = medium.modulus
    return np.asarray(M * medium.response.σ_XX(u_X, σ_YY / M, σ_XY / M))
