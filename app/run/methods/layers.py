"""The singular integral equation of layered and graded half-planes."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.plan.task import Task
from galinx.postprocess import scale
from galinx.postprocess.quantities.quantity import INTENSITIES
from galinx.postprocess.quantities.strata import AT_INTERFACES
from galinx.postprocess.quantities.stresses import BELOW, ON_SURFACE
from galinx.solvers.layers.inside import Level
from galinx.solvers.layers.medium import Medium
from galinx.solvers.layers.stack import Stack
from galinx.solvers.layers.states import Frictions, Speed
from galinx.solvers.sie.closed_form import FlatPunch
from galinx.solvers.sie.collocation import weights_hilbert
from galinx.solvers.solution import Places, Surface


def at_speed(task: Task, stack: Stack, tolerance: float, g: NDArray) -> "AtSpeed":
    """Punches with two sharp edges at one speed, with frictions from which all others follow.

    Args:
        task: the speed.
        stack: layers with lengths over the body's half-width.
        tolerance: relative.
        g: all values of σ_XY/σ_YY that will be asked for, sorted.
    """
    speed = Speed(task.response, stack, task.body.slope, tolerance)
    return AtSpeed(task, speed, *speed.solved(g))


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
        return np.abs(self.task.places.X) <= self.nodes.near

    # Whatever is read off pressures is read off those with fewer unknowns as well: (2, nodes, ...).

    @cached_property
    def series(self) -> NDArray[np.float64]:
        """Pressures without their weights there, (2, nodes, n)."""
        X = self.task.places.X[self.near]
        return self.nodes.both(lambda pressure: pressure.series(X))

    @cached_property
    def rest(self) -> NDArray[np.float64]:
        """What is regular of their Hilbert transforms, (2, nodes, n)."""
        return self.nodes.both(lambda pressure: pressure.rest(self.task.places.X, self.nodes.near))

    def level(self, depth: float, X: NDArray) -> tuple[Level, NDArray[np.float64]]:
        """A depth, and u,X, σ_YY and σ_XY there, (3, 2, nodes, n)."""
        reach = 1.0 + float(np.abs(X).max())
        here = Level(self.speed.stack, depth, reach, self.speed.tolerance)
        g = iter(np.tile(self.nodes.g, 2).tolist())

        def read(pressure: Any) -> NDArray[np.float64]:
            t, σ = pressure.points(depth)
            return here.read(t, σ, next(g), X)

        return here, np.moveaxis(self.nodes.both(read), 2, 0)

    @cached_property
    def interfaces(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """σ_YY, σ_XY, σ_XX above and below along every interface, and the tables' error.

        Arrays (4, 2, nodes, interfaces, n) and (interfaces,).
        """
        places, found, errors = self.task.places, [], []
        for depth in places.interfaces.tolist():
            level, (u_X, σ_YY, σ_XY) = self.level(depth, places.along)
            both = [in_plane(medium, u_X, σ_YY, σ_XY) for medium in level.media]
            found.append([σ_YY, σ_XY, *both])
            errors.append(level.error * max(1.0, *(medium.modulus for medium in level.media)))
        return np.moveaxis(np.array(found), 0, 3), np.array(errors)

    @cached_property
    def inside(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """σ_XX, σ_YY, σ_XY at points inside, and the tables' error; at an interface those above it.

        Arrays (3, 2, nodes, m) and (m,).
        """
        points = self.task.places.points
        found, errors = np.empty((3, 2, len(self.nodes.g), len(points))), np.empty(len(points))
        for Y in np.unique(points[:, 1]).tolist():
            some = points[:, 1] == Y
            level, (u_X, σ_YY, σ_XY) = self.level(-Y, points[some, 0])
            found[..., some] = in_plane(level.media[0], u_X, σ_YY, σ_XY), σ_YY, σ_XY
            errors[some] = level.error * max(1.0, level.media[0].modulus)
        return found, errors

    @cached_property
    def regular(self) -> NDArray[np.float64]:
        """Strains μ u,X that the layers add, (2, nodes, n)."""
        return self.regular_at(self.task.places.X)

    def regular_at(self, X: NDArray) -> NDArray[np.float64]:
        """Strains μ u,X that the layers add at positions (n,) on the surface, (2, nodes, n)."""
        kernel = self.speed.kernel
        by_kernel = self.nodes.both(lambda pressure: pressure.integral(kernel, X))
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
    def edges(self) -> FlatPunch:
        """Sharp edges, like those on a half-plane of the surface's solid."""
        return FlatPunch(self.at.task.response, self.g)

    @property
    def local(self) -> Any:
        """Exponents at the ends."""
        return self.edges

    @property
    def tips(self) -> NDArray[np.float64]:
        """Places at which the pressure is infinite inside the contact, (states, k)."""
        return np.empty((len(self.g), 0))

    @cached_property
    def _by_nodes(self) -> NDArray[np.float64]:
        return self.at.nodes.at(self.g)

    @cached_property
    def K_I(self) -> NDArray[np.float64]:
        """At X = -a and X = a, (states, 2)."""
        ends = self.at.nodes.read(lambda pressure: pressure.series(np.array([-1.0, 1.0])))
        return -0.5 * self._by_nodes @ ends

    @cached_property
    def estimates(self) -> "Estimates":
        """Relative errors, (states,), by the word of output.quantities that asks for what they are of."""
        return Estimates(self)

    @property
    def places(self) -> Places:
        """Where stresses are."""
        return self.at.task.places

    def _of_both(self, by_nodes: NDArray) -> NDArray[np.float64]:
        """Of states, and with fewer unknowns, by what was read off nodes, (..., 2, nodes, n)."""
        return np.asarray(self._by_nodes @ by_nodes)

    @cached_property
    def both_interfaces(self) -> NDArray[np.float64]:
        """Stresses along interfaces, and with fewer unknowns, (4, 2, states, interfaces, n)."""
        return np.einsum("sg,cbgin->cbsin", self._by_nodes, self.at.interfaces[0])

    @property
    def interfaces(self) -> NDArray[np.float64]:
        """σ_YY, σ_XY, σ_XX above and below along every interface, (4, states, interfaces, n)."""
        return self.both_interfaces[:, 0]

    @cached_property
    def both_inside(self) -> NDArray[np.float64]:
        """Stresses inside, and with fewer unknowns, (3, 2, states, m)."""
        return self._of_both(self.at.inside[0])

    @property
    def inside(self) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY at points inside, (3, states, m)."""
        return self.both_inside[:, 0]

    @cached_property
    def σ_ZZ(self) -> NDArray[np.float64]:
        """Normal stress out of the plane there, (states, m)."""
        return self.at.task.body.σ_ZZ(self.inside, self.places.points[:, 1])

    @cached_property
    def both_on_surface(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """σ_YY, 0 beside the punch, and σ_XX; each with fewer unknowns besides, (2, states, n)."""
        at, places, response = self.at, self.at.task.places, self.at.task.response
        X, g, local = places.X, self.g[:, None], self.edges
        α, β = local.α[:, None], local.β[:, None]
        p = np.zeros((2, len(self.g), len(X)))
        p[..., at.near] = self._of_both(at.series)
        with np.errstate(invalid="ignore"):
            σ = np.where(places.under, (1.0 - X) ** α * (1.0 + X) ** β * p, 0.0)
        H = p * np.where(at.near, weights_hilbert(α, β, X), 0.0) + self._of_both(at.rest)
        u_X = response.q * σ + (response.n12 + response.m * g) * H + self._of_both(at.regular)
        return σ, response.σ_XX(u_X, σ, g * σ)

    @cached_property
    def surface(self) -> Surface:
        (σ, _), (σ_XX, _) = self.both_on_surface
        return Surface(self.places, np.where(self.places.under, σ, np.nan), σ_XX)


@dataclass(frozen=True)
class Estimates:
    """Relative errors of the integral equation, by the word of output.quantities they belong to.

    What changes with the number of unknowns, what the kernels' and the tables' errors do, and what is
    left of the interpolation over frictions.
    """

    of: Punches

    def __getitem__(self, word: str) -> NDArray[np.float64]:
        return _ESTIMATES[word](self)

    @property
    def _pressure(self) -> NDArray[np.float64]:
        return np.full(len(self.of.g), self.of.at.estimate)

    def _on_surface(self) -> NDArray[np.float64]:
        _, (now, before) = self.of.both_on_surface
        size = scale.of_in_plane(now, self.of.places.X)
        kernel = 2.0 * self.of.at.speed.kernel.error
        # Next to a tip stresses are infinite, and what they are is that of the distance to it.
        told = scale.off_tips(self.of.places.X, self.of.tips)
        return self._changed(np.where(told, now, 0.0), np.where(told, before, 0.0), size, kernel)

    def _at_interfaces(self) -> NDArray[np.float64]:
        now, before = np.moveaxis(self.of.both_interfaces, 1, 0)
        size = np.broadcast_to(scale.of_interfaces(now), now.shape)
        tables = np.broadcast_to(self.of.at.interfaces[1][:, None], now.shape)
        parts = (
            np.moveaxis(part, 1, 0).reshape(len(self.of.g), -1) for part in (now, before, size, tables)
        )
        now, before, size, tables = parts
        return self._changed(now, before, size, tables)

    def _inside(self) -> NDArray[np.float64]:
        now, before = np.moveaxis(self.of.both_inside, 1, 0)
        size = scale.of_inside(now, *self.of.places.points.T)
        change = scale.largest(one - other for one, other in zip(now, before))
        return self._changed(change, 0.0, size, self.of.at.inside[1])

    def _changed(self, now: NDArray, before: Any, size: NDArray, tables: Any) -> NDArray[np.float64]:
        """What changed, and what tables add, over the size of it, (states,)."""
        at = self.of.at
        shared = at.interpolated.max() + at.speed.rounding
        return ((np.abs(now - before) + tables) / size).max(axis=1) + shared


#: By word.
_ESTIMATES: dict[str, Callable[[Estimates], NDArray[np.float64]]] = {
    INTENSITIES: lambda one: one._pressure,
    ON_SURFACE: Estimates._on_surface,
    AT_INTERFACES: Estimates._at_interfaces,
    BELOW: Estimates._inside,
}


def in_plane(medium: Medium, u_X: NDArray, σ_YY: NDArray, σ_XY: NDArray) -> NDArray[np.float64]:
    """σ_XX in a solid, from strain and tractions that both sides of an interface share."""
    M = medium.modulus
    return np.asarray(M * medium.response.σ_XX(u_X, σ_YY / M, σ_XY / M))
