"""Singular integral equation of layered and graded half-planes as a method.

Kernels are computed once a speed and pressures for a few frictions, from which those of all states are
interpolated. A punch has two sharp edges (:class:`AtSpeed`), or a contact with free ends
(:class:`FreeAtSpeed`): then every friction has a contact of its own, and lengths are over its half-width,
while kernels and depths are those of all contacts, over a common length. A prescribed pressure needs no
equation (:class:`PrescribedAtSpeed`): stresses follow from transforms of its tractions, and are linear in
σ_XY/σ_YY, so that two frictions give those of all states.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..layers.kernel import Kernel, Level
from ..layers.layered import LayersAtSpeed
from ..layers.stiffness import Medium
from ..profiles import cusp, jumps, kinks
from . import AT_INTERFACES, BELOW, INTENSITIES, ON_SURFACE, stresses
from .closed_form import FlatPunch
from .collocation import weights_hilbert
from .edges import Exponents
from .equation import (
    COARSE,
    FINE,
    ContactsAtSpeed,
    ConvergedPressure,
    PrescribedPressure,
    PressuresByFriction,
)
from .free_contact import largest as largest_next_to_kinks
from .free_ends import turns_at_ends, turns_at_knots
from .free_on_layers import Contacts, FreeContactsAtSpeed, Punch
from .method import Solver
from .prescribed_pressure import LinearPressure
from .recovery import largest
from .solution import Places, Surface, Task, Turns, together


def sharp_at_speed(task: Task, stack: LayersAtSpeed, tolerance: float, g: NDArray) -> "AtSpeed":
    """Punches with two sharp edges at one speed, with frictions from which all others follow.

    Args:
        task: the speed.
        stack: layers with lengths over the body's half-width.
        tolerance: relative tolerance.
        g: all values of σ_XY/σ_YY that will be solved, sorted.
    """
    speed = ContactsAtSpeed(task.response, stack, task.body.slope, tolerance)
    return AtSpeed(task, speed, *speed.solved(g))


@dataclass(frozen=True)
class AtSpeed:
    """Punches at one speed.

    Attributes:
        task: the speed.
        speed: kernels at the speed.
        nodes: pressures at the frictions that were solved.
        interpolated: error of the interpolation over frictions, relative.
    """

    task: Task
    speed: ContactsAtSpeed
    nodes: PressuresByFriction
    interpolated: NDArray[np.float64]

    def states(self, g: NDArray) -> Any:
        return Punches(self, g)

    def record(self) -> dict[str, Any]:
        return {}

    @cached_property
    def estimate(self) -> float:
        """Estimated error of the pressure, relative."""
        return float(self.nodes.change + self.interpolated.max() + self.speed.rounding)

    @cached_property
    def near(self) -> NDArray[np.bool_]:
        """True for positions on the surface at which pressures without weights are evaluated, (n,)."""
        return np.abs(self.task.places.X) <= self.nodes.near

    # All is evaluated for the pressures and for those with fewer unknowns: (2, nodes, ...).

    @cached_property
    def series(self) -> NDArray[np.float64]:
        """Pressures without their weights at the positions of ``near``, (2, nodes, n)."""
        X = self.task.places.X[self.near]
        return self.nodes.both(lambda pressure: pressure.series(X))

    @cached_property
    def rest(self) -> NDArray[np.float64]:
        """Regular part of the Hilbert transforms of the pressures, (2, nodes, n)."""
        return self.nodes.both(lambda pressure: pressure.rest(self.task.places.X, self.nodes.near))

    def level(self, depth: float, X: NDArray) -> tuple[Level, NDArray[np.float64]]:
        """Tables of a depth, and u,X, σ_YY and σ_XY at X there, (3, 2, nodes, n)."""
        reach = 1.0 + float(np.abs(X).max())
        tables = Level(self.speed.stack, depth, reach, self.speed.tolerance)
        g = iter(np.tile(self.nodes.g, 2).tolist())

        def read(pressure: Any) -> NDArray[np.float64]:
            t, σ = pressure.points(depth)
            return tables.read(t, σ, next(g), X)

        return tables, np.moveaxis(self.nodes.both(read), 2, 0)

    @cached_property
    def interfaces(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """σ_YY, σ_XY, σ_XX above and below along every interface, and the tables' error.

        Arrays (4, 2, nodes, interfaces, n) and (interfaces,).
        """
        places, σ, errors = self.task.places, [], []
        for depth in places.interfaces.tolist():
            level, (u_X, σ_YY, σ_XY) = self.level(depth, places.along)
            both = [in_plane(medium, u_X, σ_YY, σ_XY) for medium in level.media]
            σ.append([σ_YY, σ_XY, *both])
            errors.append(level.error * max(1.0, *(medium.modulus for medium in level.media)))
        return np.moveaxis(np.array(σ), 0, 3), np.array(errors)

    @cached_property
    def inside(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """σ_XX, σ_YY, σ_XY at points inside, and the tables' error; at an interface those above it.

        Arrays (3, 2, nodes, m) and (m,).
        """
        points = self.task.places.points
        σ, errors = np.empty((3, 2, len(self.nodes.g), len(points))), np.empty(len(points))
        for Y in np.unique(points[:, 1]).tolist():
            at_depth = points[:, 1] == Y
            level, (u_X, σ_YY, σ_XY) = self.level(-Y, points[at_depth, 0])
            σ[..., at_depth] = in_plane(level.media[0], u_X, σ_YY, σ_XY), σ_YY, σ_XY
            errors[at_depth] = level.error * max(1.0, level.media[0].modulus)
        return σ, errors

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
        """Exponents of the pressure at the ends."""
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
        """K_I at X = -a and X = a, (states, 2)."""
        ends = self.at.nodes.read(lambda pressure: pressure.series(np.array([-1.0, 1.0])))
        return -0.5 * self._by_nodes @ ends

    @cached_property
    def estimates(self) -> "Estimates":
        """Estimated relative errors, (states,), by word of output.quantities."""
        return Estimates(self)

    @property
    def places(self) -> Places:
        """Places at which stresses are evaluated."""
        return self.at.task.places

    def _of_both(self, by_nodes: NDArray) -> NDArray[np.float64]:
        """Values of states, (..., 2, states, n), interpolated from those of nodes, (..., 2, nodes, n)."""
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
        """Normal stress out of the plane at points inside, (states, m)."""
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
    """Estimated relative errors of the integral equation, (states,), by word of output.quantities.

    They add the change with the number of unknowns, the effect of the kernels' and the tables' errors,
    and the error of the interpolation over frictions.
    """

    of: Punches

    def __getitem__(self, word: str) -> NDArray[np.float64]:
        return _ESTIMATES[word](self)

    @property
    def _pressure(self) -> NDArray[np.float64]:
        return np.full(len(self.of.g), self.of.at.estimate)

    def _on_surface(self) -> NDArray[np.float64]:
        _, (now, before) = self.of.both_on_surface
        size = stresses.of_in_plane(now, self.of.places.X)
        kernel = 2.0 * self.of.at.speed.kernel.error
        # Next to a tip stresses are infinite, and their error is that of the distance to it.
        off_tips = stresses.off_tips(self.of.places.X, self.of.tips)
        return self._changed(np.where(off_tips, now, 0.0), np.where(off_tips, before, 0.0), size, kernel)

    def _at_interfaces(self) -> NDArray[np.float64]:
        now, before = np.moveaxis(self.of.both_interfaces, 1, 0)
        size = np.broadcast_to(stresses.of_interfaces(now), now.shape)
        tables = np.broadcast_to(self.of.at.interfaces[1][:, None], now.shape)
        parts = (
            np.moveaxis(part, 1, 0).reshape(len(self.of.g), -1) for part in (now, before, size, tables)
        )
        now, before, size, tables = parts
        return self._changed(now, before, size, tables)

    def _inside(self) -> NDArray[np.float64]:
        now, before = np.moveaxis(self.of.both_inside, 1, 0)
        size = stresses.of_inside(now, *self.of.places.points.T)
        change = stresses.largest(fine - coarse for fine, coarse in zip(now, before))
        return self._changed(change, 0.0, size, self.of.at.inside[1])

    def _changed(self, now: NDArray, before: Any, size: NDArray, tables: Any) -> NDArray[np.float64]:
        """Change and error of the tables over the sizes of stresses, plus shared errors, (states,)."""
        at = self.of.at
        shared = at.interpolated.max() + at.speed.rounding
        return ((np.abs(now - before) + tables) / size).max(axis=1) + shared


#: Estimates by word of output.quantities.
_ESTIMATES: dict[str, Callable[[Estimates], NDArray[np.float64]]] = {
    INTENSITIES: lambda estimates: estimates._pressure,
    ON_SURFACE: Estimates._on_surface,
    AT_INTERFACES: Estimates._at_interfaces,
    BELOW: Estimates._inside,
}


def in_plane(medium: Medium, u_X: NDArray, σ_YY: NDArray, σ_XY: NDArray) -> NDArray[np.float64]:
    """σ_XX in a solid, from strain and tractions that both sides of an interface share."""
    M = medium.modulus
    return np.asarray(M * medium.response.σ_XX(u_X, σ_YY / M, σ_XY / M))


def free_at_speed(task: Task, stack: LayersAtSpeed, tolerance: float, g: NDArray) -> "FreeAtSpeed":
    """Contacts at one speed, with frictions from which all others follow.

    Args:
        task: the speed.
        stack: layers with lengths over the body's half-width.
        tolerance: relative tolerance.
        g: all values of σ_XY/σ_YY that will be solved, sorted.
    """
    body = task.body
    punch = Punch(body.profile, body.half_width, body.compression)
    # A place inside is in one layer with one friction and in another with the next.
    every = bool(len(task.places.points))
    speed = FreeContactsAtSpeed(task.response, stack, np.zeros_like, tolerance, punch, every)
    nodes, interpolated = speed.solved(g)
    assert isinstance(nodes, Contacts)
    return FreeAtSpeed(task, speed, nodes, interpolated)


@dataclass(frozen=True)
class FreeAtSpeed(AtSpeed):
    """Contacts with free ends at one speed; positions are over each half-width, from its middle."""

    nodes: Contacts
    speed: FreeContactsAtSpeed

    def states(self, g: NDArray) -> Any:
        return FreePunches(self, g)

    def _level(self, depth: float, farthest: float) -> Level:
        """Tables of a depth over the common length."""
        return Level(self.speed.stack, depth, farthest, self.speed.tolerance)

    @cached_property
    def interfaces(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        X, σ_of_depths, errors = self.task.places.along, [], []
        largest = float(self.nodes.half_width.max())
        for depth in self.speed.stack.depths.tolist():
            level = self._level(depth, largest * (1.0 + float(np.abs(X).max())))

            def read(pressure: Any, g: float, h: float) -> NDArray[np.float64]:
                t, σ = pressure.points(depth / h)  # noqa: B023
                u_X, σ_YY, σ_XY = level.read(t, σ, g, X, h)  # noqa: B023
                return np.array([σ_YY, σ_XY, *(in_plane(side, u_X, σ_YY, σ_XY) for side in level.media)])  # noqa: B023

            σ_of_depths.append(self.nodes.of_each(read))
            errors.append(largest * _error(level))
        return np.moveaxis(np.array(σ_of_depths), (3, 0), (0, 3)), np.array(errors)

    @cached_property
    def inside(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        points, sizes = self.task.places.points, self.nodes.half_width
        σ_inside, errors = np.empty((3, 2, len(sizes), len(points))), np.zeros(len(points))
        for Y in np.unique(points[:, 1]).tolist():
            at_depth = points[:, 1] == Y
            X = points[at_depth, 0]
            for i, (contact, h) in enumerate(zip(self.nodes.each, sizes.tolist())):
                level = self._level(-Y * h, h * (1.0 + float(np.abs(X).max())))
                for j, pressure in enumerate((contact.pressure, contact.before)):
                    g = float(self.nodes.g[i])
                    t, σ = pressure.points(-Y)
                    u_X, σ_YY, σ_XY = level.read(t, σ, g, X, h)
                    σ_inside[:, j, i, at_depth] = in_plane(level.media[0], u_X, σ_YY, σ_XY), σ_YY, σ_XY
                errors[at_depth] = np.maximum(errors[at_depth], h * _error(level))
        return σ_inside, errors

    @cached_property
    def regular(self) -> NDArray[np.float64]:
        X = self.task.places.X
        return self.nodes.of_each(lambda pressure, g, h: self.strain(pressure, g, h, X))

    def strain(self, pressure: Any, g: float, h: float, X: NDArray) -> NDArray[np.float64]:
        """Strain μ u,X that the layers add at positions (n,) on the surface, (n,).

        Args:
            pressure: of a contact.
            g: σ_XY/σ_YY.
            h: half-width of the contact over the length of all.
            X: positions over the half-width.
        """
        by_kernel = pressure.integral(self.speed.scaled(h), X)
        return np.asarray(by_kernel[:, 1] + g * by_kernel[:, 0])


def _error(level: Level) -> float:
    """Absolute error of stresses at a level, over those of a contact as wide as the common length."""
    return level.error * max(1.0, *(medium.modulus for medium in level.media))


@dataclass(frozen=True)
class FreePunches(Punches):
    """Contacts with free ends, with several frictions, each with its own half-width and middle."""

    at: FreeAtSpeed

    @cached_property
    def free(self) -> NDArray[np.bool_]:
        """True where the left and the right end are free, (states, 2)."""
        return self._by_nodes @ self.at.nodes.free > 0.5

    @property
    def local(self) -> Exponents:
        """Exponents of the pressure at the ends."""
        free_left, free_right = self.free.T
        return Exponents(self.edges.α + free_right, self.edges.β + free_left)

    @property
    def tips(self) -> NDArray[np.float64]:
        """Places at which the pressure is infinite inside the contact, (states, k)."""
        tips = self.at.nodes.tips
        # They are those of one node each: with kinks each friction is solved.
        return tips[self._by_nodes.argmax(axis=1)] if tips.shape[1] else np.empty((len(self.g), 0))

    @property
    def half_width(self) -> NDArray[np.float64]:
        """Half-width of the contact [m], (states,)."""
        return self.at.task.body.half_width * (self._by_nodes @ self.at.nodes.half_width)

    @property
    def centre(self) -> NDArray[np.float64]:
        """Middle of the contact from the punch's axis [m], (states,)."""
        return self.at.task.body.half_width * (self._by_nodes @ self.at.nodes.centre)

    @cached_property
    def surface(self) -> Surface:
        profile, found = self.at.task.body.profile, super().surface
        if jumps(profile) or not len(kinks(profile)):
            return found
        ends = turns_at_ends(found, self.local)
        each = [ends.of(np.array([i])).joined(self._at_kinks(i)) for i in range(len(self.g))]
        return replace(found, turns=together(each))

    def _at_kinks(self, i: int) -> Turns:
        """Stresses of one state under the punch's kinks.

        They are those of its node: with kinks each friction is solved.
        """
        node, response, g = int(self._by_nodes[i].argmax()), self.at.task.response, float(self.g[i])
        pressure, h = self.at.nodes.each[node].pressure, float(self.at.nodes.half_width[node])
        X, α, β = self._kinks(i), self.edges.α[i], self.edges.β[i]
        p = pressure.series(X)
        σ_YY = (1.0 - X) ** α * (1.0 + X) ** β * p
        H = p * weights_hilbert(α, β, X) + pressure.rest(X, self.at.nodes.near)
        u_X = response.q * σ_YY + (response.n12 + response.m * g) * H + self.at.strain(pressure, g, h, X)
        σ = np.array([response.σ_XX(u_X, σ_YY, g * σ_YY), σ_YY, g * σ_YY])
        return Turns(X[None], σ[:, None])

    def _kinks(self, i: int) -> NDArray[np.float64]:
        """Positions of the punch's kinks over a in the contact of one state."""
        at = (np.array(kinks(self.at.task.body.profile)) - self.centre[i]) / self.half_width[i]
        return np.asarray(at[np.abs(at) < 1.0])

    @cached_property
    def K_I(self) -> NDArray[np.float64]:
        """K_I at the left and the right end, 0 at a free end, (states, 2)."""
        return np.where(self.free, 0.0, super().K_I)

    @cached_property
    def largest(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Largest pressure over N/(2a), and its place over a, NaN where it is infinite, (states,)."""
        profile = self.at.task.body.profile
        if self.tips.shape[1] or not self.free.all():
            finite = np.asarray(self.free.all(axis=1) & np.isinf(self.tips).all(axis=1))
            value, place = self._largest if finite.any() else np.zeros((2, len(finite)))
            return np.where(finite, value, np.nan), np.where(finite, place, np.nan)
        if not len(kinks(profile)):
            return self._largest
        each = []
        for i in range(len(self.g)):
            at = self._kinks(i).tolist(), cusp(profile)
            each.append(largest_next_to_kinks(lambda r: self._pressure(r, i)[0], at))  # noqa: B023
        value, place = np.array(each).T
        return value, place

    @property
    def _largest(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Largest pressure over N/(2a), and its place over a, of smooth pressures, (states,)."""
        return largest(self._pressure, lambda i, r: self._pressure(r, i)[0])

    def _pressure(self, r: NDArray, i: int | None = None) -> NDArray[np.float64]:
        """Pressure over N/(2a) at r over a, (states, n), of state ``i`` alone or of all states."""
        rows = slice(None) if i is None else slice(i, i + 1)
        p = self._by_nodes[rows] @ self.at.nodes.read(lambda pressure: pressure.series(r))
        α, β = self.edges.α[rows, None], self.edges.β[rows, None]
        return np.asarray(-p * (1.0 - r) ** α * (1.0 + r) ** β)

    @cached_property
    def σ_ZZ(self) -> NDArray[np.float64]:
        body, Y = self.at.task.body, self.places.points[:, 1]
        shares = self.half_width / body.half_width
        return np.array([body.σ_ZZ(self.inside[:, i], h * Y) for i, h in enumerate(shares.tolist())])


#: The two frictions solved for a prescribed pressure.
_NODES = np.array([0.0, 1.0])


def prescribed_at_speed(
    task: Task, stack: LayersAtSpeed, tolerance: float, g: NDArray
) -> "PrescribedAtSpeed":
    """Prescribed pressure at one speed.

    Args:
        task: the speed.
        stack: layers with lengths over the body's half-width.
        tolerance: relative tolerance.
        g: σ_XY/σ_YY, in which all stresses are linear.
    """
    pressure = task.body.pressure
    assert pressure
    speed = ContactsAtSpeed(task.response, stack, np.zeros_like, tolerance)
    kernel: Kernel = speed.kernel
    length = float(stack.layers[0].H)
    fine, coarse = (PrescribedPressure(pressure, nodes, length, kernel.rough) for nodes in (FINE, COARSE))
    at_node = ConvergedPressure(fine, coarse, 0.0)  # type: ignore[arg-type]
    return PrescribedAtSpeed(
        task, speed, PressuresByFriction(_NODES, [at_node] * len(_NODES)), np.zeros(1)
    )


@dataclass(frozen=True)
class PrescribedAtSpeed(AtSpeed):
    """Prescribed pressure at one speed."""

    def states(self, g: NDArray) -> Any:
        return PrescribedPressures(self, g)


@dataclass(frozen=True)
class PrescribedPressures(Punches):
    """States under a prescribed pressure."""

    at: PrescribedAtSpeed

    @property
    def _pressure(self) -> LinearPressure:
        pressure = self.at.task.body.pressure
        assert pressure
        return pressure

    @property
    def normal_force(self) -> NDArray[np.float64]:
        """Normal force over N/2, (states,)."""
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


@dataclass(frozen=True)
class Layers:
    """Method by the integral equation of layers, with kernels once a speed.

    Attributes:
        tolerance: relative tolerance.
    """

    tolerance: float

    @contextmanager
    def at(self, task: Task, g: NDArray) -> Iterator[Solver]:
        body = task.body
        stack = task.response.stack(body.half_width)  # type: ignore[attr-defined]
        at_speed = (
            prescribed_at_speed if body.pressure else free_at_speed if body.found else sharp_at_speed
        )
        yield at_speed(task, stack, self.tolerance, g)
