"""The singular integral equation of layers under punches whose contact ends where the pressure says.

Every friction has a contact of its own, and lengths are over its half-width; kernels and depths are
those of all of them, over one length.
"""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.plan.task import Task
from galinx.app.run.methods.layers import AtSpeed, Punches, in_plane
from galinx.app.run.methods.own_meshes import together
from galinx.postprocess.largest import largest
from galinx.postprocess.near_ends import turns_at_ends
from galinx.solvers.layers.ends import Punch
from galinx.solvers.layers.found import FoundSpeed
from galinx.solvers.layers.found_states import Contacts
from galinx.solvers.layers.inside import Level
from galinx.solvers.layers.stack import Stack
from galinx.solvers.profiles import cusp, jumps, kinks
from galinx.solvers.sie.collocation import weights_hilbert
from galinx.solvers.sie.found import Exponents
from galinx.solvers.sie.found import largest as largest_next_to_kinks
from galinx.solvers.solution import Surface, Turns


def at_speed(task: Task, stack: Stack, tolerance: float, g: NDArray) -> "FoundAtSpeed":
    """Contacts at one speed, with frictions from which all others follow.

    Args:
        task: the speed.
        stack: layers with lengths over the body's half-width.
        tolerance: relative.
        g: all values of σ_XY/σ_YY that will be asked for, sorted.
    """
    body = task.body
    punch = Punch(body.profile, body.half_width, body.compression)
    # A place inside is in one layer with one friction and in another with the next.
    every = bool(len(task.places.points))
    speed = FoundSpeed(task.response, stack, np.zeros_like, tolerance, punch, every)
    nodes, left = speed.solved(g)
    assert isinstance(nodes, Contacts)
    return FoundAtSpeed(task, speed, nodes, left)


@dataclass(frozen=True)
class FoundAtSpeed(AtSpeed):
    """Contacts at one speed; positions are over each one's half-width, from its middle."""

    nodes: Contacts
    speed: FoundSpeed

    def states(self, g: NDArray) -> Any:
        return FoundPunches(self, g)

    def _level(self, depth: float, farthest: float) -> Level:
        """A depth over the length of all."""
        return Level(self.speed.stack, depth, farthest, self.speed.tolerance)

    @cached_property
    def interfaces(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        X, found, errors = self.task.places.along, [], []
        largest = float(self.nodes.half_width.max())
        for depth in self.speed.stack.depths.tolist():
            level = self._level(depth, largest * (1.0 + float(np.abs(X).max())))

            def read(pressure: Any, g: float, h: float) -> NDArray[np.float64]:
                t, σ = pressure.points(depth / h)  # noqa: B023
                u_X, σ_YY, σ_XY = level.read(t, σ, g, X, h)  # noqa: B023
                return np.array([σ_YY, σ_XY, *(in_plane(one, u_X, σ_YY, σ_XY) for one in level.media)])  # noqa: B023

            found.append(self.nodes.of_each(read))
            errors.append(largest * _error(level))
        return np.moveaxis(np.array(found), (3, 0), (0, 3)), np.array(errors)

    @cached_property
    def inside(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        points, sizes = self.task.places.points, self.nodes.half_width
        found, errors = np.empty((3, 2, len(sizes), len(points))), np.zeros(len(points))
        for Y in np.unique(points[:, 1]).tolist():
            some = points[:, 1] == Y
            X = points[some, 0]
            for i, (one, h) in enumerate(zip(self.nodes.each, sizes.tolist())):
                level = self._level(-Y * h, h * (1.0 + float(np.abs(X).max())))
                for j, pressure in enumerate((one.pressure, one.before)):
                    g = float(self.nodes.g[i])
                    t, σ = pressure.points(-Y)
                    u_X, σ_YY, σ_XY = level.read(t, σ, g, X, h)
                    found[:, j, i, some] = in_plane(level.media[0], u_X, σ_YY, σ_XY), σ_YY, σ_XY
                errors[some] = np.maximum(errors[some], h * _error(level))
        return found, errors

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
    """Absolute, of stresses there over those of a contact whose half-width is the length of all."""
    return level.error * max(1.0, *(medium.modulus for medium in level.media))


@dataclass(frozen=True)
class FoundPunches(Punches):
    """Punches with several frictions, each with its own half-width and middle."""

    at: FoundAtSpeed

    @cached_property
    def free(self) -> NDArray[np.bool_]:
        """Were the left and the right end found? (states, 2)."""
        return self._by_nodes @ self.at.nodes.free > 0.5

    @property
    def local(self) -> Exponents:
        """Exponents at the ends."""
        left, right = self.free.T
        return Exponents(self.edges.α + right, self.edges.β + left)

    @property
    def tips(self) -> NDArray[np.float64]:
        """Places at which the pressure is infinite inside the contact, (states, k)."""
        tips = self.at.nodes.tips
        # They are those of one node each: with kinks each friction is solved.
        return tips[self._by_nodes.argmax(axis=1)] if tips.shape[1] else np.empty((len(self.g), 0))

    @property
    def half_width(self) -> NDArray[np.float64]:
        """Of the contact [m], (states,)."""
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
        """At the left and the right end: none at those that are found, by condition, (states, 2)."""
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
        """Of pressures that are smooth."""
        return largest(self._pressure, lambda i, r: self._pressure(r, i)[0])

    def _pressure(self, r: NDArray, i: int | None = None) -> NDArray[np.float64]:
        """Of one state or of all of them, (states, n)."""
        some = slice(None) if i is None else slice(i, i + 1)
        p = self._by_nodes[some] @ self.at.nodes.read(lambda pressure: pressure.series(r))
        α, β = self.edges.α[some, None], self.edges.β[some, None]
        return np.asarray(-p * (1.0 - r) ** α * (1.0 + r) ** β)

    @cached_property
    def σ_ZZ(self) -> NDArray[np.float64]:
        body, Y = self.at.task.body, self.places.points[:, 1]
        shares = self.half_width / body.half_width
        return np.array([body.σ_ZZ(self.inside[:, i], h * Y) for i, h in enumerate(shares.tolist())])
