"""Singular integral equation of a uniform half-plane as a method, in closed form or by collocation.

Flat punches and prescribed pressures have closed forms; punches with a profile and two sharp edges are
solved by collocation; a contact with free ends ends where the pressure vanishes.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .closed_form import FlatPunch
from .edges import Exponents
from .free_contact import Contacts, contacts
from .free_ends import turns_at_knots
from .method import Solver
from .prescribed_pressure import LinearPressure, PrescribedPressureSolution
from .residual import of_contact, of_field
from .solution import Surface, Task, Turns
from .yielding import Strength

#: Jacobi polynomials under a punch that is not flat: smooth profiles need a dozen for the last digits.
TERMS = 40

#: Most points inside whose potentials are held in memory at a time.
_TOGETHER = 20_000


@dataclass(frozen=True)
class ClosedForm:
    """Method that answers every task directly, without a mesh.

    Attributes:
        solution: makes the solution of a task and values of σ_XY/σ_YY, (states,).
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


def with_fixed_ends(task: Task, g: NDArray) -> Any:
    """Solution of punches whose contact has fixed ends, or of a prescribed pressure."""
    if task.body.pressure:
        return PrescribedPressures(task, g)
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
        """Local analysis of the edges, at which every sharp punch has the exponents of a flat one."""
        return FlatPunch(self.task.response, self.g)

    def _pressure_at(self, r: NDArray) -> NDArray[np.float64]:
        """σ_YY over N/(2a) at positions (n,) under the punch, (states, n)."""
        raise NotImplementedError

    @cached_property
    def residual(self) -> NDArray[np.float64]:
        """Residual of the integral equation under the pressure, relative, (states,)."""
        task = self.task
        return of_contact(task.response, self.g, self.local, task.body, self._pressure_at)

    @cached_property
    def residual_inside(self) -> NDArray[np.float64]:
        """Residual of stresses inside against line loads and equilibrium, relative, (states,)."""
        task, local = self.task, self.local
        return of_field(
            task.response, self.g, (local.α, local.β), self._pressure_at, self._stresses_at,
            task.places.points,
        )  # fmt: skip

    def _stresses_at(self, X: NDArray, Y: NDArray) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY over N/(2a) at points inside, (3, states, n)."""
        raise NotImplementedError

    def _strength(self, exact: FlatPunch | PrescribedPressureSolution) -> Strength:
        """Yield of the states, by exact stresses at all points."""
        task = self.task

        def field(points: NDArray) -> NDArray[np.float64]:
            return exact.stresses(points[..., 0], points[..., 1])

        return Strength(field, task.body, task.response, self.g, self.local)

    def _by_batches(self, inside: Callable[[NDArray, NDArray], NDArray]) -> NDArray[np.float64]:
        """Stresses inside, (3, states, m), by batches of points: potentials take much memory."""
        points = self.task.places.points
        σ = np.empty((3, len(self.g), len(points)))
        for first in range(0, len(points), _TOGETHER):
            batch = slice(first, first + _TOGETHER)
            σ[:, :, batch] = inside(*points[batch].T)
        return σ


class FlatPunches(Punches):
    """Flat punches, exact."""

    def _pressure_at(self, r: NDArray) -> NDArray[np.float64]:
        return self._over_places.σ_YY(r)

    def _stresses_at(self, X: NDArray, Y: NDArray) -> NDArray[np.float64]:
        return self._over_places.inside(X, Y)

    @property
    def K_I(self) -> NDArray[np.float64]:
        """K_I at X = -a and X = a, equal at both ends, (states, 2)."""
        return np.column_stack([self.local.K_I] * 2)

    def strained_within(self, strain: float) -> NDArray[np.float64]:
        """Distances over a from X = -a and X = a within which -u,X exceeds a strain, (states, 2)."""
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
        """Yield of the states."""
        return self._strength(self._over_places)


class PrescribedPressures(Punches):
    """Prescribed pressures, exact."""

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
        """Normal force over N/2, (states,)."""
        return np.full(len(self.g), self._pressure.resultant)

    @cached_property
    def _over_places(self) -> PrescribedPressureSolution:
        return PrescribedPressureSolution(self.task.response, self.g[:, None], self._pressure)

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
        """Yield of the states."""
        return self._strength(self._over_places)


class ShapedPunches(Punches):
    """Punches with a profile and two sharp edges, by collocation."""

    @cached_property
    def _expansions(self) -> list[Any]:
        from .collocation import solve  # SciPy's special functions, a slow import

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
        """K_I at X = -a and X = a, (states, 2)."""
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
        """Unavailable: stresses below a profile come from finite elements only."""
        raise NotImplementedError("stresses inside below a profile come from finite elements only")


#: Least distance over a from an end or a kink at which stresses are evaluated.
_NEAREST = 1e-7


class FreePunches(Punches):
    """Contacts with free ends, with several frictions, each with its own half-width and middle."""

    @cached_property
    def _contacts(self) -> Contacts:
        body = self.task.body
        return contacts(self.task.response, self.g, body.profile, body.compression)

    @cached_property
    def local(self) -> Any:
        """Exponents of the pressure at the ends."""
        return Exponents(self._contacts.of("α"), self._contacts.of("β"))

    @property
    def half_width(self) -> NDArray[np.float64]:
        """Half-width of the contact [m], (states,)."""
        return self._contacts.of("half_width")

    @property
    def centre(self) -> NDArray[np.float64]:
        """Middle of the contact from the punch's axis [m], (states,)."""
        return self._contacts.of("centre")

    @property
    def K_I(self) -> NDArray[np.float64]:
        """K_I at the left and the right end, 0 at a free end, (states, 2)."""
        return self._contacts.of("K_I")

    @cached_property
    def largest(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Largest pressure over N/(2a), and its place over a, NaN where it is infinite, (states,)."""
        return self._contacts.largest()

    @cached_property
    def residual(self) -> NDArray[np.float64]:
        residuals, body, load = np.empty(len(self.g)), self.task.body, self.task.body.load
        for rows, group, kinks in self._contacts.alike():
            loaded = body.loaded(load[rows] if np.ndim(load) else load)
            exponents = Exponents(group.of("α"), group.of("β"))
            lengths = group.of("centre"), group.of("half_width")
            residuals[rows] = of_contact(
                self.task.response, group.g, exponents, loaded, group.pressure, lengths, kinks
            )
        return residuals

    @cached_property
    def residual_inside(self) -> NDArray[np.float64]:
        residuals = np.empty(len(self.g))
        for rows, group, kinks in self._contacts.alike():
            residuals[rows] = of_field(
                self.task.response, group.g, (group.of("α"), group.of("β")), group.pressure, group.inside,
                self.task.places.points, kinks,
            )  # fmt: skip
        return residuals

    @cached_property
    def surface(self) -> Surface:
        places = self.task.places
        σ_YY = np.full((len(self.g), len(places.X)), np.nan)
        σ_YY[:, places.under] = self._contacts.σ_YY(places.X[places.under])
        return Surface(places, σ_YY, self._contacts.σ_XX(places.X), turns=self._turns)

    @cached_property
    def _turns(self) -> Turns | None:
        """Exact stresses at free ends and under kinks, wherever they are finite; None where nowhere."""
        states = self._contacts
        X = states.turns
        if not X.shape[1]:
            return None
        on_surface = states.stresses(np.nan_to_num(X), np.zeros_like(X))
        return Turns(X, np.where(np.isnan(X), np.nan, on_surface))

    @cached_property
    def inside(self) -> NDArray[np.float64]:
        return self._by_batches(self._contacts.inside)

    @cached_property
    def strength(self) -> Strength:
        """Yield of the states."""
        states, task = self._contacts, self.task

        def field(points: NDArray) -> NDArray[np.float64]:
            return states.stresses(points[..., 0], points[..., 1])

        return Strength(
            field, task.body, task.response, self.g, self.local, self.half_width, self._turns, _NEAREST
        )
