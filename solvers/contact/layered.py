"""Singular integral equation of layered and graded half-planes as a method.

Kernels are computed once a speed and pressures for a few frictions, from which those of all states are
interpolated. A punch has two sharp edges, and its contact then is that of all frictions; or the contact
has a free end, and every friction has a contact of its own. Lengths are over the half-width of a contact,
from its middle, while kernels and depths are those of all contacts, over a common length. A prescribed
pressure needs no equation: stresses follow from transforms of its tractions, and are linear in σ_XY/σ_YY,
so that two frictions give those of all states.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from ..layers.kernel import Level
from ..layers.layered import LayersAtSpeed
from ..layers.stiffness import Medium
from ..profiles import jumps, kinks
from . import AT_INTERFACES, BELOW, INTENSITIES, ON_SURFACE, stresses
from .closed_form import FlatPunch, in_plane
from .edges import Exponents, under_punch, weights_hilbert
from .equation import Contacts, ContactsAtSpeed, SolvedContact
from .free_on_layers import FreeContactsAtSpeed, Punch
from .method import Solver
from .prescribed_pressure import COARSE, FINE, LinearPressure
from .pressure import ENDS, Pressure, largest_of
from .solution import Task
from .stresses import Places, Surface, Turns, at_and_between, together, turns_at_ends, turns_at_knots
from .yielding import StrengthOfLayers

#: The two frictions solved for a prescribed pressure.
_NODES = np.array([0.0, 1.0])


def at_speed(task: Task, stack: LayersAtSpeed, tolerance: float, g: NDArray) -> "AtSpeed":
    """Contacts at one speed, with frictions from which all others follow.

    Args:
        task: the speed.
        stack: layers with lengths over the body's half-width.
        tolerance: relative tolerance.
        g: all values of σ_XY/σ_YY that will be solved, sorted.
    """
    body = task.body
    if body.knots:
        speed = ContactsAtSpeed(task.response, stack, np.zeros_like, tolerance)
        H, prescribed = float(stack.layers[0].H), cast(LinearPressure, body.pressure)
        fine, coarse = (
            replace(prescribed, nodes=nodes, length=H, rough=speed.kernel.rough)
            for nodes in (FINE, COARSE)
        )
        nodes = Contacts(_NODES, [SolvedContact(fine, coarse, 0.0)] * len(_NODES))
        return AtSpeed(task, speed, nodes, np.zeros(1))
    if body.found:
        punch = Punch(body.profile, body.half_width, body.compression)
        # A place inside is in one layer with one friction and in another with the next.
        every = bool(len(task.places.points) or len(task.places.around))
        speed = FreeContactsAtSpeed(task.response, stack, np.zeros_like, tolerance, punch, every)
    else:
        speed = ContactsAtSpeed(task.response, stack, body.slope, tolerance)
    return AtSpeed(task, speed, *speed.solved(g))


@dataclass(frozen=True)
class AtSpeed:
    """Contacts at one speed; positions are over each half-width, from its middle.

    Attributes:
        task: the speed.
        speed: kernels at the speed.
        nodes: contacts at the frictions that were solved.
        interpolated: error of the interpolation over frictions, relative.
    """

    task: Task
    speed: ContactsAtSpeed
    nodes: Contacts
    interpolated: NDArray[np.float64]

    def states(self, g: NDArray) -> "LayeredSolution":
        return LayeredSolution(self, g)

    def record(self) -> dict[str, Any]:
        return {}

    @cached_property
    def estimate(self) -> float:
        """Estimated error of the pressure, relative."""
        return float(self.nodes.change + self.interpolated.max() + self.speed.rounding)

    # All is evaluated for the pressures and for those with fewer unknowns: (2, nodes, ...).

    @cached_property
    def on_surface(self) -> "OnSurface":
        """Transforms of the pressures at the task's places on the surface."""
        return self.on_surface_at(self.task.places.X)

    def on_surface_at(self, X: NDArray) -> "OnSurface":
        """Transforms of the pressures at positions on the surface, (n,)."""
        nodes, near = self.nodes, self.nodes.near
        evaluated, p = np.abs(X) <= max(near, 1.0), np.zeros((2, len(self.nodes.g), len(X)))
        p[..., evaluated] = nodes.both(lambda pressure: pressure.series(X[evaluated]))
        rest = nodes.both(lambda pressure: pressure.rest(X, near))
        regular = nodes.of_each(lambda pressure, g, h: self.strain(pressure, g, h, X))
        return OnSurface(X, np.abs(X) <= near, p, rest, regular)

    def strain(self, pressure: Pressure, g: float, h: float, X: NDArray) -> NDArray[np.float64]:
        """Strain μ u,X that the layers add at positions (n,) on the surface, (n,).

        Args:
            pressure: of a contact.
            g: σ_XY/σ_YY.
            h: half-width of the contact over the length of all.
            X: positions over the half-width.
        """
        by_kernel = pressure.integral(self.speed.scaled(h), X)
        return np.asarray(by_kernel[:, 1] + g * by_kernel[:, 0])

    def _level(self, depth: float, farthest: float) -> Level:
        """Tables of a depth over the common length."""
        return Level(self.speed.stack, depth, farthest, self.speed.tolerance)

    @cached_property
    def interfaces(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """σ_YY, σ_XY, σ_XX above and below along every interface, and the tables' error.

        Arrays (4, 2, nodes, interfaces, n) and (interfaces,).
        """
        X, σ_of_depths, errors = self.task.places.along, [], []
        widest = float(self.nodes.half_width.max())
        for depth in self.speed.stack.depths[: len(self.task.places.interfaces)].tolist():
            level = self._level(depth, widest * (1.0 + float(np.abs(X).max())))

            def read(pressure: Any, g: float, h: float) -> NDArray[np.float64]:
                t, σ = pressure.points(depth / h)  # noqa: B023
                u_X, σ_YY, σ_XY = level.read(t, σ, g, X, h)  # noqa: B023
                each = (_in_plane(medium, u_X, σ_YY, σ_XY) for medium in level.media)  # noqa: B023
                return np.array([σ_YY, σ_XY, *each])

            σ_of_depths.append(self.nodes.of_each(read))
            errors.append(widest * _error(level))
        return np.moveaxis(np.array(σ_of_depths), (3, 0), (0, 3)), np.array(errors)

    @cached_property
    def inside(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """σ_XX, σ_YY, σ_XY at points inside, and the tables' error; at an interface those above it.

        Arrays (3, 2, nodes, m) and (m,).
        """
        points, errors = self.task.places.points, np.zeros(len(self.task.places.points))
        σ_inside = np.empty((3, 2, len(self.nodes.g), len(points)))
        for Y in np.unique(points[:, 1]).tolist():
            at_depth = points[:, 1] == Y
            X, levels = points[at_depth, 0], dict[float, Level]()

            def read(pressure: Any, g: float, h: float) -> NDArray[np.float64]:
                if h not in levels:  # noqa: B023
                    levels[h] = self._level(-Y * h, h * (1.0 + float(np.abs(X).max())))  # noqa: B023
                level, (t, σ) = levels[h], pressure.points(-Y)  # noqa: B023
                u_X, σ_YY, σ_XY = level.read(t, σ, g, X, h)  # noqa: B023
                return np.array([_in_plane(level.media[0], u_X, σ_YY, σ_XY), σ_YY, σ_XY])

            σ_inside[..., at_depth] = np.moveaxis(self.nodes.of_each(read), 2, 0)
            errors[at_depth] = max(h * _error(level, 1) for h, level in levels.items())
        return σ_inside, errors


def _error(level: Level, sides: int = 2) -> float:
    """Absolute error of stresses above a level, or on both sides, over those of a common half-width."""
    return level.error * max(1.0, *(medium.modulus for medium in level.media[:sides]))


def _in_plane(medium: Medium, u_X: NDArray, σ_YY: NDArray, σ_XY: NDArray) -> NDArray[np.float64]:
    """σ_XX in a solid, from strain and tractions that both sides of an interface share."""
    M = medium.modulus
    return np.asarray(M * medium.response.σ_XX(u_X, σ_YY / M, σ_XY / M))


@dataclass(frozen=True)
class OnSurface:
    """Transforms of the pressures, and of those with fewer unknowns, at positions on the surface.

    Attributes:
        X: positions over the half-width, (n,).
        near: True where Hilbert transforms are split into that of the weight and the rest, (n,).
        p: pressures without their weights, 0 where they are not evaluated, (2, nodes, n).
        rest: Hilbert transforms, less p times that of the weight where they are split, (2, nodes, n).
        regular: strains μ u,X that the layers add, (2, nodes, n).
    """

    X: NDArray[np.float64]
    near: NDArray[np.bool_]
    p: NDArray[np.float64]
    rest: NDArray[np.float64]
    regular: NDArray[np.float64]


class LayeredSolution:
    """States of contacts over layers.

    Args:
        at: their speed.
        g: σ_XY/σ_YY, (states,).
    """

    def __init__(self, at: AtSpeed, g: NDArray) -> None:
        self.at, self.g = at, g

    @cached_property
    def edges(self) -> FlatPunch:
        """Sharp edges, like those on a half-plane of the surface's solid."""
        return FlatPunch(self.at.task.response, self.g)

    @cached_property
    def _by_nodes(self) -> NDArray[np.float64]:
        return self.at.nodes.at(self.g)

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
        # They are those of one node each: with kinks each friction is solved.
        return self.at.nodes.tips[self._by_nodes.argmax(axis=1)]

    @property
    def _sizes(self) -> NDArray[np.float64]:
        """Half-width of each contact over the common length, (states,); exact where all have one."""
        half_width = self.at.nodes.half_width
        return half_width[0] + self._by_nodes @ (half_width - half_width[0])

    @property
    def half_width(self) -> NDArray[np.float64]:
        """Half-width of the contact [m], (states,)."""
        return self.at.task.body.half_width * self._sizes

    @property
    def centre(self) -> NDArray[np.float64]:
        """Middle of the contact from the punch's axis [m], (states,)."""
        return self.at.task.body.half_width * (self._by_nodes @ self.at.nodes.centre)

    @cached_property
    def K_I(self) -> NDArray[np.float64]:
        """K_I at the left and the right end, 0 at a free end, (states, 2)."""
        ends = self.at.nodes.read(lambda pressure: pressure.series(ENDS))
        return np.where(self.free, 0.0, -0.5 * self._by_nodes @ ends)

    @property
    def normal_force(self) -> NDArray[np.float64]:
        """Normal force of a prescribed pressure over N/2, (states,)."""
        return np.full(len(self.g), self.at.nodes.each[0].pressure.resultant)

    @cached_property
    def estimates(self) -> "Estimates":
        """Estimated relative errors, (states,), by word of output.quantities."""
        return Estimates(self)

    @property
    def places(self) -> Places:
        """Places at which stresses are evaluated."""
        return self.at.task.places

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
        return np.asarray(self._by_nodes @ self.at.inside[0])

    @property
    def inside(self) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY at points inside, (3, states, m)."""
        return self.both_inside[:, 0]

    @cached_property
    def σ_ZZ(self) -> NDArray[np.float64]:
        """Normal stress out of the plane at points inside, (states, m)."""
        σ_ZZ, sizes = np.empty(self.inside.shape[1:]), self._sizes
        for h in np.unique(sizes).tolist():
            rows = sizes == h
            σ_ZZ[rows] = self.at.task.body.σ_ZZ(self.inside[:, rows], h * self.places.points[:, 1])
        return σ_ZZ

    @cached_property
    def strength(self) -> StrengthOfLayers:
        """Largest von Mises stresses of all layers."""
        body = self.at.task.body
        return StrengthOfLayers(
            self._inside, self.surface, self.interfaces, self.places.along, self.g, self.local, body,
            self.half_width,
        )  # fmt: skip

    def _inside(self, state: int, points: NDArray) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY at points inside of one state, (3, n), all at one depth.

        They are those of its node: where places inside are asked for each friction is solved.
        """
        node = int(self._by_nodes[state].argmax())
        nodes, depth = self.at.nodes, -float(points[0, 1])
        h, pressure = float(nodes.half_width[node]), nodes.each[node].pressure
        level = self.at._level(depth * h, h * (1.0 + float(np.abs(points[:, 0]).max())))
        t, σ = pressure.points(depth)
        u_X, σ_YY, σ_XY = level.read(t, σ, float(nodes.g[node]), points[:, 0], h)
        return np.array([_in_plane(level.media[0], u_X, σ_YY, σ_XY), σ_YY, σ_XY])

    @cached_property
    def both_on_surface(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """σ_YY, 0 beside the punch, and σ_XX; each with fewer unknowns besides, (2, states, n)."""
        return self._stresses(self.at.on_surface)

    def _stresses(self, at: OnSurface) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """σ_YY and σ_XX from transforms, each with fewer unknowns besides, (2, states, n)."""
        p, rest, regular = (self._by_nodes @ part for part in (at.p, at.rest, at.regular))
        X, g, response = at.X, self.g[:, None], self.at.task.response
        α, β = self._exponents
        with np.errstate(invalid="ignore", divide="ignore"):
            σ = np.where(under_punch(X), (1.0 - X) ** α * (1.0 + X) ** β * p, 0.0)
            H = p * np.where(at.near, weights_hilbert(α, β, X), 0.0) + rest
        return σ, in_plane(response, g, σ, H, regular)

    @property
    def _exponents(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Exponents of the weight of the pressures at the right and the left end, (states, 1) each."""
        α, β = self.at.nodes.each[0].pressure.exponents(self.edges)
        return α[:, None], β[:, None]

    @cached_property
    def surface(self) -> Surface:
        """Stresses on the surface."""
        (σ, _), (σ_XX, _) = self.both_on_surface
        surface = Surface(self.places, np.where(self.places.under, σ, np.nan), σ_XX)
        return replace(surface, turns=self._turns(surface))

    def _turns(self, surface: Surface) -> Turns | None:
        """Limits of stresses at kinks, and at free ends of contacts that have kinks."""
        profile = self.at.task.body.profile
        pressure: Any = self.at.nodes.each[0].pressure
        if len(pressure.breaks):
            return turns_at_knots(pressure, self.g, self._σ_XX)
        if jumps(profile) or not len(kinks(profile)) or not self.free.any():
            return None
        ends = turns_at_ends(surface, self.local)
        each = [ends.of(np.array([i])).joined(self._at_kinks(i)) for i in range(len(self.g))]
        return together(each)

    def _σ_XX(self, X: NDArray) -> NDArray[np.float64]:
        """In-plane stress over N/(2a) at X over a, (states, n)."""
        return self._stresses(self.at.on_surface_at(X))[1][0]

    def _at_kinks(self, i: int) -> Turns:
        """Stresses of one state under the punch's kinks.

        They are those of its node: with kinks each friction is solved.
        """
        node, g, X = int(self._by_nodes[i].argmax()), float(self.g[i]), self._kinks(i)
        pressure, h = self.at.nodes.each[node].pressure, float(self.at.nodes.half_width[node])

        def σ_XX(r: NDArray) -> NDArray[np.float64]:
            with np.errstate(invalid="ignore", divide="ignore"):
                σ_YY, H = pressure.σ_YY(r), pressure.hilbert(r)
                return in_plane(self.at.task.response, g, σ_YY, H, self.at.strain(pressure, g, h, r))[
                    None
                ]

        σ_YY = pressure.σ_YY(X)
        between = None
        if len(X):
            _, between = at_and_between(np.array([-1.0, *np.sort(X), 1.0]), σ_XX)
        return Turns(X[None], np.array([σ_XX(X)[0], σ_YY, g * σ_YY])[:, None], between)

    def _kinks(self, i: int) -> NDArray[np.float64]:
        """Positions of the punch's kinks over a in the contact of one state."""
        at = (np.array(kinks(self.at.task.body.profile)) - self.centre[i]) / self.half_width[i]
        return np.asarray(at[np.abs(at) < 1.0])

    @cached_property
    def largest(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Largest pressure over N/(2a), and its place over a, NaN where it is infinite, (states,)."""
        finite = self.free.all(axis=1) & np.isinf(self.tips).all(axis=1)
        value, place = np.full((2, len(self.g)), np.nan)
        for i in np.flatnonzero(finite).tolist():
            of_state = partial(self._pressure, i)
            value[i], place[i] = largest_of(of_state, self._kinks(i))
        return value, place

    def _pressure(self, i: int, r: NDArray) -> NDArray[np.float64]:
        """Pressure of a state over N/(2a) at r over a, (n,)."""
        p = self._by_nodes[i] @ self.at.nodes.read(lambda pressure: pressure.series(r))
        α, β = (exponent[i] for exponent in self._exponents)
        return np.asarray(-p * (1.0 - r) ** α * (1.0 + r) ** β)


@dataclass(frozen=True)
class Estimates:
    """Estimated relative errors of the integral equation, (states,), by word of output.quantities.

    They add the change with the number of unknowns, the effect of the kernels' and the tables' errors,
    and the error of the interpolation over frictions.
    """

    of: LayeredSolution

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
        yield at_speed(task, stack, self.tolerance, g)
