"""Solution by finite elements: states of contacts and of prescribed pressures, on one mesh or many.

States that were solved on one mesh are sums of its displacement fields (:class:`SolvedStates`). A
:class:`Solution` joins those of one mesh for all, or of a mesh for each contact. Where contacts under all
loads are similar, a friction is solved once, and its states differ in their lengths alone.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..contact import solution
from ..contact.edges import Exponents
from ..contact.pressure import Contacts, between_ends
from ..contact.recovery import on_panels
from ..contact.residual import of_contact
from ..contact.solution import Contact, Task, solved_once
from ..contact.stresses import PLACES, Surface, Turns, together
from ..contact.yielding import InSolid
from .fields import Displacement
from .punch import ContactStates

#: Least distance over a from an end or a kink at which stresses of an elastic punch are evaluated.
_NEAREST = 1e-7
#: Distance over a from an end at which stresses of the end itself are evaluated.
_AT_END = 1e-15


@dataclass(frozen=True)
class SolvedStates:
    """States solved on one mesh; lengths over each contact's half-width, from its middle.

    Attributes:
        level: the solved degree, a :class:`galinx.solvers.fem.ladder.Level`.
        body: the sliding contact, under the load of each state.
        contact: nodal forces, weights of the displacement fields, and ends.
        pressure: contact pressure, a :class:`galinx.solvers.contact.pressure.Pressure`.
        errors: estimated relative errors, (states,), by word of output.quantities.
        fitted: True where the speed was fitted through others.
        deeper: half-width over that of the mesh, which is drawn for a contact near by: points keep their
            depths, and so the layer that they are in.
    """

    level: Any
    body: Contact
    contact: ContactStates
    pressure: Any
    errors: dict[str, NDArray[np.float64]] = field(default_factory=dict)
    fitted: bool = False
    deeper: float = 1.0

    @property
    def task(self) -> Task:
        """The speed, and places of stresses; with lengths over the half-width of a mesh drawn for it."""
        return self.level.task

    @property
    def displacement(self) -> Displacement:
        """Stresses by the fields."""
        return self.level.displacement

    def ratio(self, X: NDArray) -> NDArray[np.float64]:
        """σ_XY/σ_YY at X over a, (states, n) or (states, 1)."""
        return np.asarray(self.body.ratio(self.contact.g, X, self.contact.half_width))

    @property
    def frictions(self) -> list[Any]:
        """σ_XY/σ_YY over the contact of each state, objects of :class:`.along.Along`."""
        each = zip(self.contact.g.tolist(), self.contact.half_width.tolist())
        return [self.body.friction(g, a) for g, a in each]

    def in_plane(self, X: NDArray) -> NDArray[np.float64]:
        """σ_XX under the punch at X over a, off its ends, (states, n)."""
        σ_YY, u_X = self.pressure.σ_YY(X), self.displacement.strains(X, self.contact.weights)
        return np.asarray(self.task.response.σ_XX(u_X, σ_YY, self.ratio(X) * σ_YY))

    @property
    def local(self) -> Exponents:
        """Exponents of the pressure at the right and the left end."""
        contact = self.contact
        return self.body.edges(self.task.response, contact.g, contact.half_width, contact.free)

    @cached_property
    def on_surface(self) -> Surface:
        """Stresses on the surface, with limits at ends and kinks."""
        contact, recovery = self.contact, self.level.recovery
        raw = contact.tested(recovery.raw) if recovery else None
        σ_YY = self.pressure.σ_YY(self.task.places.X)
        surface = self.displacement.surface(self.ratio(self.task.places.X), contact.weights, σ_YY, raw)
        return replace(surface, turns=self.level.turns(self, surface))

    @cached_property
    def below(self) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY at points inside, (3, states, m)."""
        if self.deeper != 1.0:
            return self.at(self.task.places.points[None])
        return self.displacement.inside(self.contact.weights)

    def at(self, points: NDArray, rows: Any = slice(None)) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY of some states, (3, rows, n), at points (1, n, 2) of all or (rows, n, 2)."""
        return self.displacement.at(points * [1.0, self.deeper], self.contact.weights[rows])

    @property
    def centre_of_pressure(self) -> NDArray[np.float64]:
        """Centre of pressure over the half-width, from the middle, (states,)."""
        r = self.level.r
        load, moment = self.contact.tested(np.column_stack([np.ones_like(r), r])).T
        return np.asarray(moment / load)

    @property
    def off_equation(self) -> NDArray[np.float64]:
        """Residual of the integral equation under the pressure, relative, (states,)."""
        return of_contact(
            self.task.response, self.contact.g, self.local, self.body, self.pressure.σ_YY,
            (self.contact.centre, self.contact.half_width), self.pressure.kinks, self.pressure.breaks,
        )  # fmt: skip


def _of_all(values: Callable[[SolvedStates], Any], axis: int = 0) -> Any:
    """Property of a solution that joins values of its solved states along an axis of states."""
    return cached_property(lambda solution: solution._joined(values, axis))


@dataclass(frozen=True)
class Solution(solution.Solution):
    """Contacts with several frictions and loads, or a prescribed pressure.

    Attributes:
        task: their speed.
        solved: solved states, mesh by mesh.
        rows: number of each state among all solved states, (states,).
        body: the sliding contact, under the load of each state.
        growth: half-width of each state over that of its solved state, (states,), or a number of all.
    """

    task: Task
    solved: Sequence[SolvedStates]
    rows: NDArray[np.int64]
    body: Contact
    growth: Any

    def _joined(self, of: Callable[[SolvedStates], NDArray], axis: int = 0) -> NDArray[Any]:
        """Values of all states by those of the solved states on each mesh, along an axis of states."""
        return np.concatenate([of(states) for states in self.solved], axis=axis).take(self.rows, axis)

    #: σ_XY/σ_YY, (states,).
    g = _of_all(lambda of: of.contact.g)
    #: Indentation of the punch's lowest point over N/(2μ), (states,).
    v0 = _of_all(lambda of: of.contact.v0)
    #: K_I at the left and the right end, 0 at a free end, (states, 2).
    K_I = _of_all(lambda of: of.pressure.K_I)
    #: Normal force over N/2, (states,).
    normal_force = _of_all(lambda of: of.contact.load)
    #: Tangential force over N/2, (states,).
    tangential_force = _of_all(lambda of: of.contact.friction)
    #: Centre of pressure over a, from the middle, (states,).
    pressure_centre = _of_all(lambda of: of.centre_of_pressure)
    #: Residual of the integral equation under the pressure, relative, (states,).
    residual = _of_all(lambda of: of.off_equation)
    #: Exponents at X = a and X = -a, fitted from the raw pressure, (states, 2).
    exponents = _of_all(lambda of: of.level.recovery.exponents(of.contact.normal))
    #: 1 where the state was fitted through other speeds, 0 where it was solved, (states,).
    fitted = _of_all(lambda of: np.full(len(of.contact.g), float(of.fitted)))
    #: σ_XX, σ_YY, σ_XY at points inside, (3, states, m).
    inside = _of_all(lambda of: of.below, 1)
    #: σ_YY, σ_XY, σ_XX above and below along every interface, (4, states, interfaces, n).
    interfaces = _of_all(lambda of: of.displacement.interfaces(of.contact.weights), 1)
    #: Normal stress out of the plane at points inside, (states, m).
    σ_ZZ = _of_all(lambda of: of.task.body.σ_ZZ(of.below, of.task.places.points[:, 1]))
    #: Largest pressure over N/(2a), and its place over a, NaN where it is infinite, (2, states).
    largest = _of_all(lambda of: np.array(of.pressure.largest()), 1)

    @cached_property
    def local(self) -> Exponents:
        """Exponents of the pressure at the right and the left end."""
        α, β = self._joined(lambda states: np.array([states.local.α, states.local.β]), 1)
        return Exponents(α, β)

    @cached_property
    def half_width(self) -> NDArray[np.float64]:
        """Half-width of the contact [m], (states,)."""
        return self.growth * self._joined(lambda states: states.contact.half_width)

    @cached_property
    def centre(self) -> NDArray[np.float64]:
        """Middle of the contact from the punch's axis [m], (states,)."""
        return self.growth * self._joined(lambda states: states.contact.centre)

    @property
    def resultant_ratio(self) -> NDArray[np.float64]:
        """Resultant of σ_XY over that of σ_YY, (states,)."""
        return np.asarray(self.tangential_force / self.normal_force)

    @cached_property
    def estimates(self) -> dict[str, NDArray[np.float64]]:
        """Estimated relative errors, (states,), by word of output.quantities."""
        return {word: self._joined(lambda of: of.errors[word]) for word in self.solved[0].errors}  # noqa: B023

    @cached_property
    def surface(self) -> Surface:
        """Stresses on the surface, and their limits at free ends, kinks and knots."""
        each = [states.on_surface for states in self.solved]
        if len(each) == 1:
            return each[0].of(self.rows)
        σ_YY, σ_XX, v_X = (
            np.concatenate([getattr(surface, name) for surface in each])
            for name in ("σ_YY", "σ_XX", "v_X")
        )
        turns = together([surface.turns for surface in each if surface.turns])
        return Surface(self.task.places, σ_YY, σ_XX, None, v_X, turns).of(self.rows)

    @cached_property
    def pressed(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Positions X over a under the punch, and contact stress over N/(2a) there, (states, n)."""
        output = self.task.places
        X = output.X[output.under] if output.under.any() else PLACES
        σ_YY = self._joined(lambda of: np.broadcast_to(of.pressure.σ_YY(X), (len(of.contact.g), len(X))))
        return X, σ_YY

    @cached_property
    def yield_turns(self) -> Turns | None:
        """Limits of stresses at ends and kinks, where an end is free."""
        turns, X = self.surface.turns, np.array(self.body.friction_kinks)
        if not turns or not any(states.contact.free.any() for states in self.solved):
            return None
        states = range(len(self.rows))
        σ_XX, σ_YY = np.stack([self.at_surface(state, X) for state in states], axis=1)
        σ = np.array([σ_XX, σ_YY, self.body.ratio(self.g, X, self.half_width) * σ_YY])
        return turns.joined(Turns(np.tile(X, (len(states), 1)), σ))

    @property
    def nearest(self) -> float:
        """Least distance over a from an end or a kink at which stresses are accurate."""
        return max(states.level.nearest(states) for states in self.solved)

    @cached_property
    def _in_punch(self) -> Contacts:
        """Contacts on an elastic punch, mirrored at Y = 0."""
        pressures = [
            on_panels(states.pressure, i, α, β, friction)
            for states in self.solved
            for i, (α, β, friction) in enumerate(zip(states.local.α, states.local.β, states.frictions))
        ]
        each = [pressures[row] for row in self.rows]
        return between_ends(self.task.response, self.g, each, 1.0).in_punch

    def _stresses_of_punch(self, points: NDArray) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY, (3, states, n), at points (1, n, 2) of all states or (states, n, 2)."""
        X, Y = np.moveaxis(points, 2, 0)
        X = np.where(np.abs(np.abs(X) - 1.0) < _AT_END, np.sign(X) * (1.0 - _AT_END), X)
        return self._in_punch.stresses(X, Y) * [[[1.0]], [[1.0]], [[-1.0]]]

    @cached_property
    def inside_punch(self) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY in an elastic punch, at X and -Y of the points inside, (3, states, m)."""
        return self._stresses_of_punch(self.places.points[None])

    @cached_property
    def strength_of_punch(self) -> Any:
        """Yield of an elastic punch, whose heights Y have the other sign."""
        each = np.tile([-1.0, *self.body.friction_kinks, 1.0], (len(self.rows), 1))
        response = self.task.response.punch  # type: ignore[attr-defined]
        turns = Turns(each, self._stresses_of_punch(np.stack([each, 0.0 * each], axis=2)))
        punch = InSolid(
            response, -self.g, self.local, self.half_width, self._stresses_of_punch, turns, _NEAREST,
            self.kinks_of_friction,
        )  # fmt: skip
        return self.body.of_punch.strength(punch)

    def inside_of(self, state: int, points: NDArray) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY at points inside, (n, 2), of one state, (3, n)."""
        states, row = self._of(state)
        return states.at(points[None], [row])[:, 0]

    def at_surface(self, state: int, X: NDArray) -> NDArray[np.float64]:
        """σ_XX and σ_YY of one state at positions X (n,) under the punch, (2, n)."""
        states, row = self._of(state)
        X = np.where(np.abs(np.abs(X) - 1.0) < _AT_END, np.sign(X) * (1.0 - _AT_END), X)
        return np.array([states.in_plane(X)[row], states.pressure.σ_YY(X)[row]])

    def at_interface(self, state: int, interface: int, X: NDArray) -> NDArray[np.float64]:
        """σ_YY, σ_XY, σ_XX above and below an interface at X (n,) of one state, (4, n)."""
        states, row = self._of(state)
        return states.displacement.at_interface(interface, X, states.contact.weights[[row]])[:, 0]

    @cached_property
    def kinks(self) -> list[Sequence[float] | NDArray]:
        """Positions over a at which each state's pressure is not smooth."""
        return [self._of(state)[0].pressure.kinks for state in range(len(self.rows))]

    def _of(self, state: int) -> tuple[SolvedStates, int]:
        """Solved states that a state is among, and its number there."""
        row = int(self.rows[state])
        for states in self.solved:
            if row < len(states.contact.g):
                return states, row
            row -= len(states.contact.g)
        raise IndexError(state)

    def stresses(self, points: NDArray) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY, (3, states, n), at points (1, n, 2) of all states or (states, n, 2)."""
        if len(self.solved) == 1:
            return self.solved[0].at(points, self.rows)
        each = np.broadcast_to(points, (len(self.rows), *points.shape[1:]))
        return np.stack([self.inside_of(state, own) for state, own in enumerate(each)], axis=1)


def solution_of(
    task: Task, solve: Callable[[NDArray, Any], Sequence[SolvedStates]], g: NDArray, load: Any = None
) -> Solution:
    """Solution for states of a speed; where contacts are similar under all loads, once for a friction.

    Args:
        task: the speed.
        solve: solves for values of σ_XY/σ_YY, (n,), under the task's load, None, or others [N/m], (n,).
        g: σ_XY/σ_YY, (states,).
        load: load of each state [N/m], (states,); the task's if None.
    """
    g, of_solved, rows, growth = solved_once(task, g, load)
    rows = np.arange(len(g))[rows]
    return Solution(task, solve(g, of_solved), rows, task.body.loaded(load), growth)
