"""The singular integral equation: closed forms, or its collocation where the punch is not flat.

The singular integral equation of punches whose contact ends where the pressure says.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.free_ends import turns_at_knots
from galinx.postprocess.yielding import Strength
from galinx.solvers.sie.closed_form import FlatPunch
from galinx.solvers.sie.free_contact import Contacts, Exponents, contacts
from galinx.solvers.sie.prescribed_pressure import GivenPressure, LinearPressure
from galinx.solvers.sie.residual import of_contact, of_field
from galinx.solvers.solution import Surface, Turns

from ...plan.task import Task
from .method import Solver

#: Jacobi polynomials under a punch that is not flat: smooth profiles need a dozen for the last digits.
TERMS = 40

#: Points inside whose potentials are held at once.
_TOGETHER = 20_000


@dataclass(frozen=True)
class ClosedForm:
    """Every task has its solution at once.

    Attributes:
        solution: of a task and values of σ_XY/σ_YY.
    """

    solution: Callable[[Task, NDArray], Any]

    @contextmanager
    def at(self, task: Task, g: NDArray) -> Iterator[Solver]:
        yield _AtSpeed(task, self.solution)


@dataclass(frozen=True)
class _AtSpeed:
    task: Task
    solution: Callable[[Task, NDArray], Any]

    def states(self, g: NDArray, load: NDArray | None = None) -> Any:
        return self.solution(replace(self.task, body=self.task.body.loaded(load)), g)

    def record(self) -> dict[str, Any]:
        return {}


def with_given_ends(task: Task, g: NDArray) -> Any:
    """Punches whose contact has its ends, and pressures of one's own."""
    if task.body.pressure:
        return OwnPressures(task, g)
    return (FlatPunches if task.body.flat else ShapedPunches)(task, g)


@dataclass(frozen=True)
class Punches:
    """Punches with several frictions.

    Attributes:
        task: their speed.
        g: σ_XY/σ_YY, (states,).
    """

    task: Task
    g: NDArray[np.float64]

    @cached_property
    def local(self) -> FlatPunch:
        """The edges, where every sharp punch is like a flat one."""
        return FlatPunch(self.task.response, self.g)

    def _pressure_at(self, r: NDArray) -> NDArray[np.float64]:
        """σ_YY over N/(2a) at positions (n,) under the punch, (states, n)."""
        raise NotImplementedError

    @cached_property
    def residual(self) -> NDArray[np.float64]:
        """What the pressure leaves of the integral equation, relative, (states,)."""
        task = self.task
        return of_contact(task.response, self.g, self.local, task.body, self._pressure_at)

    @cached_property
    def residual_inside(self) -> NDArray[np.float64]:
        """How far stresses inside are from line loads and equilibrium, relative, (states,)."""
        task, local = self.task, self.local
        return of_field(
            task.response, self.g, (local.α, local.β), self._pressure_at, self._stresses_at,
            task.places.points,
        )  # fmt: skip

    def _stresses_at(self, X: NDArray, Y: NDArray) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY inside, (3, states, n)."""
        raise NotImplementedError

    def _strength(self, exact: FlatPunch | GivenPressure) -> Strength:
        """Yield, where stresses are known at all points."""
        task = self.task

        def field(points: NDArray) -> NDArray[np.float64]:
            return exact.stresses(points[..., 0], points[..., 1])

        return Strength(field, task.body, task.response, self.g, self.local)

    def _by_batches(self, inside: Callable[[NDArray, NDArray], NDArray]) -> NDArray[np.float64]:
        """Stresses inside, (3, states, m), some points after the others: potentials take much room."""
        points = self.task.places.points
        found = np.empty((3, len(self.g), len(points)))
        for first in range(0, len(points), _TOGETHER):
            some = slice(first, first + _TOGETHER)
            found[:, :, some] = inside(*points[some].T)
        return found


class FlatPunches(Punches):
    """Flat punches, exact."""

    def _pressure_at(self, r: NDArray) -> NDArray[np.float64]:
        return self._over_places.σ_YY(r)

    def _stresses_at(self, X: NDArray, Y: NDArray) -> NDArray[np.float64]:
        return self._over_places.inside(X, Y)

    @property
    def K_I(self) -> NDArray[np.float64]:
        """At X = -a and X = a, the same number, (states, 2)."""
        return np.column_stack([self.local.K_I] * 2)

    def strained_within(self, strain: float) -> NDArray[np.float64]:
        """How far from X = -a and X = a, under the punch, -u,X exceeds a strain, over a, (states, 2)."""
        return np.column_stack(self.local.strained_within(strain / self.task.body.strain))

    @cached_property
    def _over_places(self) -> FlatPunch:
        return FlatPunch(self.task.response, self.g[:, None])

    @cached_property
    def surface(self) -> Surface:
        places = self.task.places
        σ_YY = np.where(places.under, self._over_places.σ_YY(places.X), np.nan)
        return Surface(places, σ_YY, self._over_places.σ_XX(places.X))

    @cached_property
    def inside(self) -> NDArray[np.float64]:
        return self._by_batches(self._over_places.inside)

    @cached_property
    def strength(self) -> Strength:
        """Yield."""
        return self._strength(self._over_places)


class OwnPressures(Punches):
    """A pressure of the user's own, exact."""

    @cached_property
    def residual_inside(self) -> NDArray[np.float64]:
        none = np.zeros(len(self.g))
        return of_field(
            self.task.response, self.g, (none, none), self._pressure_at, self._over_places.inside,
            self.task.places.points, self._pressure.knots,
        )  # fmt: skip

    def _pressure_at(self, r: NDArray) -> NDArray[np.float64]:
        return np.tile(self._pressure(r), (len(self.g), 1))

    @property
    def _pressure(self) -> LinearPressure:
        assert self.task.body.pressure
        return self.task.body.pressure

    @property
    def normal_force(self) -> NDArray[np.float64]:
        """Resultant over N/2, (states,)."""
        return np.full(len(self.g), self._pressure.resultant)

    @cached_property
    def _over_places(self) -> GivenPressure:
        return GivenPressure(self.task.response, self.g[:, None], self._pressure)

    @cached_property
    def surface(self) -> Surface:
        places = self.task.places
        σ_YY = np.where(places.under, self._pressure(places.X), np.nan)
        σ_XX = self._over_places.σ_XX
        turns = turns_at_knots(self._pressure, self.g, σ_XX)
        return Surface(places, np.tile(σ_YY, (len(self.g), 1)), σ_XX(places.X), turns=turns)

    @cached_property
    def inside(self) -> NDArray[np.float64]:
        return self._by_batches(self._over_places.inside)

    @cached_property
    def strength(self) -> Strength:
        """Yield."""
        return self._strength(self._over_places)


class ShapedPunches(Punches):
    """Punches with a profile and two sharp edges, by collocation."""

    @cached_property
    def _expansions(self) -> list[Any]:
        from galinx.solvers.sie.collocation import solve  # SciPy's special functions, a slow import

        body, response = self.task.body, self.task.response
        loads = np.broadcast_to(body.load, self.g.shape).tolist()
        return [
            solve(response, value, TERMS, body.loaded(load).slope)
            for value, load in zip(self.g.tolist(), loads)
        ]

    def _pressure_at(self, r: NDArray) -> NDArray[np.float64]:
        return np.array([expansion.σ_YY(r) for expansion in self._expansions])

    @cached_property
    def K_I(self) -> NDArray[np.float64]:
        """At X = -a and X = a, (states, 2)."""
        return np.array([expansion.K_I for expansion in self._expansions])

    @cached_property
    def surface(self) -> Surface:
        places, response, g = self.task.places, self.task.response, self.g[:, None]
        σ_YY = np.full((len(self.g), len(places.X)), np.nan)
        σ_YY[:, places.under] = [e.σ_YY(places.X[places.under]) for e in self._expansions]
        σ, H = np.nan_to_num(σ_YY), np.array([e.hilbert(places.X) for e in self._expansions])
        u_X = response.q * σ + (response.n12 + response.m * g) * H
        return Surface(places, σ_YY, response.σ_XX(u_X, σ, g * σ))

    @property
    def inside(self) -> NDArray[np.float64]:
        """Not known: finite elements are."""
        raise NotImplementedError("stresses inside below a profile come from finite elements only")


#: Distance over a from an end or a kink from which on stresses are looked at.
_NEAREST = 1e-7


class FoundPunches(Punches):
    """Punches with several frictions, each with its own half-width and middle."""

    @cached_property
    def _contacts(self) -> Contacts:
        body = self.task.body
        return contacts(self.task.response, self.g, body.profile, body.compression)

    @cached_property
    def local(self) -> Any:
        """Exponents at the ends."""
        return Exponents(self._contacts.of("α"), self._contacts.of("β"))

    @property
    def half_width(self) -> NDArray[np.float64]:
        """Of the contact [m], (states,)."""
        return self._contacts.of("half_width")

    @property
    def centre(self) -> NDArray[np.float64]:
        """Middle of the contact from the punch's axis [m], (states,)."""
        return self._contacts.of("centre")

    @property
    def K_I(self) -> NDArray[np.float64]:
        """At the left and the right end, 0 at one that is found, (states, 2)."""
        return self._contacts.of("K_I")

    @cached_property
    def largest(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Largest pressure over N/(2a), and its place over a, NaN where it is infinite, (states,)."""
        return self._contacts.largest()

    @cached_property
    def residual(self) -> NDArray[np.float64]:
        found, body, load = np.empty(len(self.g)), self.task.body, self.task.body.load
        for rows, some, kinks in self._contacts.alike():
            loaded = body.loaded(load[rows] if np.ndim(load) else load)
            exponents = Exponents(some.of("α"), some.of("β"))
            lengths = some.of("centre"), some.of("half_width")
            found[rows] = of_contact(
                self.task.response, some.g, exponents, loaded, some.pressure, lengths, kinks
            )
        return found

    @cached_property
    def residual_inside(self) -> NDArray[np.float64]:
        found = np.empty(len(self.g))
        for rows, some, kinks in self._contacts.alike():
            found[rows] = of_field(
                self.task.response, some.g, (some.of("α"), some.of("β")), some.pressure, some.inside,
                self.task.places.points, kinks,
            )  # fmt: skip
        return found

    @cached_property
    def surface(self) -> Surface:
        places = self.task.places
        σ_YY = np.full((len(self.g), len(places.X)), np.nan)
        σ_YY[:, places.under] = self._contacts.σ_YY(places.X[places.under])
        return Surface(places, σ_YY, self._contacts.σ_XX(places.X), turns=self._turns)

    @cached_property
    def _turns(self) -> Turns | None:
        """Exact; at ends that are free, and under kinks, wherever stresses are finite."""
        found = self._contacts
        X = found.turns
        if not X.shape[1]:
            return None
        on_surface = found.stresses(np.nan_to_num(X), np.zeros_like(X))
        return Turns(X, np.where(np.isnan(X), np.nan, on_surface))

    @cached_property
    def inside(self) -> NDArray[np.float64]:
        return self._by_batches(self._contacts.inside)

    @cached_property
    def strength(self) -> Strength:
        """Yield."""
        found, task = self._contacts, self.task

        def field(points: NDArray) -> NDArray[np.float64]:
            return found.stresses(points[..., 0], points[..., 1])

        return Strength(
            field, task.body, task.response, self.g, self.local, self.half_width, self._turns, _NEAREST
        )
