"""Closed form as a method: exact solutions of contacts on uniform half-planes, and collocated ones.

Contacts differ by their pressure alone, see :mod:`galinx.solvers.contact.uniform`.
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
from .method import Solver
from .pressure import ENDS
from .residual import of_contact, of_field
from .solution import Task, solved_once
from .stresses import Surface, Turns, at_and_between, together, turns_at_knots
from .uniform import Contacts, Group, contacts_of
from .yielding import Strength

#: Most points inside whose potentials are held in memory at a time.
_TOGETHER = 20_000
#: Least distance over a from an end or a kink at which stresses are evaluated.
_NEAREST = 1e-7


@dataclass(frozen=True)
class ClosedForm:
    """Method that answers every task directly, without a mesh.

    Attributes:
        solution: makes the solution of a task, of values of σ_XY/σ_YY and, or None, of loads, (states,).
    """

    solution: Callable[[Task, NDArray, NDArray | None], Any]

    @contextmanager
    def at(self, task: Task, g: NDArray) -> Iterator[Solver]:
        yield _AtSpeed(task, self.solution)


@dataclass(frozen=True)
class _AtSpeed:
    task: Task
    solution: Callable[[Task, NDArray, NDArray | None], Any]

    def states(self, g: NDArray, load: NDArray | None = None) -> Any:
        return self.solution(self.task, g, load)

    def record(self) -> dict[str, Any]:
        return {}


class ExactSolution:
    """States of contacts on a uniform half-plane; similar ones are solved once.

    Args:
        task: their speed.
        g: σ_XY/σ_YY, (states,).
        load: load of each state [N/m], (states,); the task's if None.
    """

    def __init__(self, task: Task, g: NDArray, load: NDArray | None = None) -> None:
        self.task, self.g = replace(task, body=task.body.loaded(load)), g
        self._g, of_solved, self._rows, self._growth = solved_once(task, g, load)
        self._body = task.body.loaded(of_solved)

    @cached_property
    def contacts(self) -> Contacts:
        """Pressures, half-widths and middles of all solved states."""
        return contacts_of(self._body, self.task.response, self._g)

    def _of(self, name: str) -> NDArray[np.float64]:
        return self.contacts.of(name)[self._rows]

    @cached_property
    def local(self) -> Exponents:
        """Exponents at the ends of punches: those of a flat punch, one more where they are free."""
        flat = self.task.body.edges(self.task.response, self.g)
        α, β = map(self._of, "αβ")
        return Exponents(flat.α + (α > 0.0), flat.β + (β > 0.0))

    @property
    def half_width(self) -> NDArray[np.float64]:
        """Half-width of the contact [m], (states,)."""
        return self._of("half_width") * self._growth

    @property
    def centre(self) -> NDArray[np.float64]:
        """Middle of the contact from the punch's axis [m], (states,)."""
        return self._of("centre") * self._growth

    @property
    def K_I(self) -> NDArray[np.float64]:
        """K_I at the left and the right end, 0 at a free end, (states, 2)."""
        return self._of("K_I")

    @property
    def resultant_ratio(self) -> NDArray[np.float64]:
        """Resultant of σ_XY over that of σ_YY, of friction that varies along the contact, (states,)."""
        return np.array([group.pressure.resultant_ratio for group in self.contacts.groups])[self._rows]

    @property
    def pressure_centre(self) -> NDArray[np.float64]:
        """Centre of pressure over a, of friction that varies along the contact, (states,)."""
        return np.array([group.pressure.pressure_centre for group in self.contacts.groups])[self._rows]

    @property
    def normal_force(self) -> NDArray[np.float64]:
        """Normal force of a prescribed pressure over N/2, (states,)."""
        return np.full(len(self.g), self.contacts.groups[0].pressure.resultant)

    def strained_within(self, strain: float) -> NDArray[np.float64]:
        """Distances over a from X = -a and X = a within which -u,X exceeds a strain, (states, 2).

        Under flat punches only.
        """
        flat = FlatPunch(self.task.response, self.g)
        return np.column_stack(flat.strained_within(strain / self.task.body.strain))

    @cached_property
    def largest(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Largest pressure over N/(2a), and its place over a, NaN where it is infinite, (states,)."""
        value, place = self.contacts.largest()
        return value[self._rows], place[self._rows]

    @cached_property
    def residual(self) -> NDArray[np.float64]:
        """Residual of the integral equation under the pressure, relative, (states,)."""
        body, load = self._body, self._body.load

        def of_group(group: Group) -> NDArray[np.float64]:
            loaded = body.loaded(load[group.rows] if np.ndim(load) else load)
            return of_contact(
                self.task.response, self._g[group.rows], group, loaded, group.contact_stress,
                (group.centre, group.half_width), group.pressure.kinks,
            )  # fmt: skip

        return self.contacts.joined(of_group)[self._rows]

    @cached_property
    def residual_inside(self) -> NDArray[np.float64]:
        """Residual of stresses inside against line loads and equilibrium, relative, (states,)."""

        def of_group(group: Group) -> NDArray[np.float64]:
            kinks = np.append(group.pressure.kinks, group.pressure.breaks)
            return of_field(
                self.task.response, self._g[group.rows], (group.α, group.β), group.contact_stress,
                lambda X, Y: self.contacts.stresses_of(group, X[None], Y[None]),
                self.task.places.points, kinks,
            )  # fmt: skip

        return self.contacts.joined(of_group)[self._rows]

    @cached_property
    def surface(self) -> Surface:
        """Stresses on the surface."""
        places = self.task.places
        σ_XX, σ_YY = self.contacts.on_surface(places.X)
        turns = self._turns
        if self._body.knots:  # a prescribed pressure is that of all states
            turns = turns_at_knots(
                self.contacts.groups[0].pressure, self._g, lambda X: self.contacts.on_surface(X)[0]
            )
        return Surface(places, np.where(places.under, σ_YY, np.nan), σ_XX, turns=turns).of(self._rows)

    @cached_property
    def _turns(self) -> Turns | None:
        """Exact stresses at free ends and under kinks, wherever they are finite; None where nowhere."""
        turns = together([self._turns_of(group) for group in self.contacts.groups])
        return turns.of(self.contacts.order) if turns and turns.X.size else None

    def _turns_of(self, group: Group) -> Turns:
        kinks, ends = sorted(group.pressure.bends), np.array([group.β[0], group.α[0]]) > 0.0
        X = np.concatenate([ENDS[ends], kinks])
        σ_XX, σ_YY = self.contacts.surface_of(group, X)
        between = None
        if kinks:
            places = np.array([-1.0, *kinks, 1.0])
            infinite = np.append([not ends[0]], [*[False] * len(kinks), not ends[1]])
            _, between = at_and_between(places, lambda r: self.contacts.surface_of(group, r)[0], infinite)
        σ = np.array([σ_XX, σ_YY, self._g[group.rows, None] * σ_YY])
        return Turns(np.tile(X, (len(group.rows), 1)), σ, between)

    @cached_property
    def inside(self) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY at points inside, (3, states, m)."""
        points = self.task.places.points
        σ = np.empty((3, len(self._g), len(points)))
        for first in range(0, len(points), _TOGETHER):
            batch = slice(first, first + _TOGETHER)
            σ[:, :, batch] = self.contacts.stresses(*points[batch].T)
        return σ[:, self._rows]

    @cached_property
    def strength(self) -> Strength:
        """Yield of the states, which is searched for at places of each."""
        task, solved_each = self.task, isinstance(self._rows, slice)
        each = self if solved_each else ExactSolution(task, self.g)

        def field(points: NDArray) -> NDArray[np.float64]:
            return each.contacts.stresses(points[..., 0], points[..., 1])

        return Strength(
            field, task.body, task.response, self.g, self.local, self.half_width, each._turns,
            _NEAREST,
        )  # fmt: skip
