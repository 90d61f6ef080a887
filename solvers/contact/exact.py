"""Methods without a mesh: closed form on uniform half-planes, integral equation over layered ones.

Contacts differ by their pressure alone, see :class:`galinx.solvers.contact.pressure.Contacts`.
"""

from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, replace
from functools import cached_property, partial
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..approximation import polynomial_through
from ..layers.kernel import Level
from ..profiles import jumps, kinks
from . import AT_INTERFACES, BELOW, INTENSITIES, ON_SURFACE, stresses
from .edges import EdgeExponents, Exponents
from .equation import OF_ENDS, LayersUnderPunch, SolvedContact, under_punch
from .prescribed_pressure import COARSE, FINE
from .pressure import ENDS, Contacts, Group, Pressure
from .residual import indentation, of_contact, of_field, places
from .solution import Solution, Task, solved_once
from .stresses import Places, Surface, Turns, at_and_between, together, turns_at_ends, turns_at_knots
from .yielding import InSolid

#: Most points inside whose potentials are held in memory at a time.
_TOGETHER = 20_000
#: Signs of σ_XX, σ_YY, σ_XY of a field mirrored at Y = 0.
_MIRROR = np.array([1.0, 1.0, -1.0])[:, None, None]


class ClosedForm:
    """Method that answers every task directly, without a mesh."""

    def at(self, task: Task, g: NDArray) -> AbstractContextManager[Any]:
        return nullcontext(SimpleNamespace(states=partial(ExactSolution, task), record=dict))


class ExactSolution(Solution):
    """States of contacts on a uniform half-plane; similar ones are solved once.

    Args:
        task: their speed.
        g: σ_XY/σ_YY, (states,).
        load: load of each state [N/m], (states,); the task's if None.
    """

    def __init__(self, task: Task, g: NDArray, load: NDArray | None = None) -> None:
        self.task, self.g = replace(task, body=task.body.loaded(load)), g
        self.body = self.task.body
        self._g, of_solved, self._rows, self._growth = solved_once(task, g, load)
        self._body = task.body.loaded(of_solved)

    @cached_property
    def contacts(self) -> Contacts:
        """Pressures, half-widths and middles of all solved states."""
        return self._body.contacts(self.task.response, self._g)

    def _of(self, name: str) -> NDArray[np.float64]:
        return self.contacts.of(name)[self._rows]

    def _of_pressures(self, name: str) -> NDArray[np.float64]:
        """Attribute of the pressure of every state, (states,)."""
        return self.contacts.joined(
            lambda group: np.full(len(group.rows), getattr(group.pressure, name))
        )[self._rows]

    @cached_property
    def local(self) -> Exponents:
        """Exponents at the ends of punches: those of a flat punch, one more where they are free."""
        return self.task.body.edges(self.task.response, self.g, self.half_width, self._of("free"))

    @property
    def half_width(self) -> NDArray[np.float64]:
        """Half-width of the contact [m], (states,)."""
        return self._of("half_width") * self._growth

    @property
    def centre(self) -> NDArray[np.float64]:
        """Middle of the contact from the punch's axis [m], (states,)."""
        return self._of("centre") * self._growth

    #: K_I at the left and the right end, 0 at a free end, (states, 2).
    K_I = property(lambda self: self._of("K_I"))
    #: Normal force of a prescribed pressure over N/2, (states,).
    normal_force = property(lambda self: self._of_pressures("resultant"))
    #: Of friction that varies along the contact: resultant of σ_XY over that of σ_YY, (states,).
    resultant_ratio = property(lambda self: self._of_pressures("resultant_ratio"))
    #: Of friction that varies along the contact: centre of pressure over a, (states,).
    pressure_centre = property(lambda self: self._of_pressures("pressure_centre"))

    @property
    def v0(self) -> NDArray[np.float64]:
        """Indentation over N/(2μ) of the solid, uniform, by :func:`residual.indentation`; (states,)."""
        X, body = places()[0], self.body
        σ_YY = self.contacts.on_surface(X)[1][self._rows]
        height = body.profile.height(self.centre - self.half_width) / body.displacement
        return indentation(self.task.response, body.ratio(self.g, X), σ_YY, height)

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
                self.task.response, group.g, group, loaded, group.contact_stress,
                (group.centre, group.half_width), group.pressure.kinks,
            )  # fmt: skip

        return self.contacts.joined(of_group)[self._rows]

    @cached_property
    def residual_inside(self) -> NDArray[np.float64]:
        """Residual of stresses inside against line loads and equilibrium, relative, (states,)."""

        def of_group(group: Group) -> NDArray[np.float64]:
            pressure = group.pressure
            kinks = np.array([*pressure.kinks, *pressure.breaks, *self.body.jumps_of_friction])
            return of_field(
                self.task.response, group.ratio, (group.α, group.β), group.contact_stress,
                lambda X, Y: group.stresses(X[None], Y[None]),
                self.places.points, kinks,
            )  # fmt: skip

        return self.contacts.joined(of_group)[self._rows]

    @cached_property
    def surface(self) -> Surface:
        """Stresses on the surface."""
        places = self.places
        σ_XX, σ_YY = self.contacts.on_surface(places.X)
        surface = Surface(places, np.where(places.under, σ_YY, np.nan), σ_XX)
        return replace(surface, turns=self._limits(surface)).of(self._rows)

    @cached_property
    def pressed(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Positions X over a under the punch, and contact stress over N/(2a) there, (states, n).

        None for a punch that presses everywhere.
        """
        X = np.empty(0) if self._body.presses else self.places.X[self.places.under]
        return X, self.contacts.joined(lambda group: group.contact_stress(X))[self._rows]

    def _limits(self, surface: Surface) -> Turns | None:
        """Limits of the stresses at ends, kinks and knots, wherever they are finite."""
        if self._body.knots:  # a prescribed pressure is that of all states
            pressure: Any = self.contacts.groups[0].pressure
            return turns_at_knots(pressure, self._g, lambda X: self.contacts.on_surface(X)[0])
        return self._turns

    @cached_property
    def _turns(self) -> Turns | None:
        return _turns_of(self.contacts)

    def at_surface(self, state: int, X: NDArray) -> NDArray[np.float64]:
        """σ_XX and σ_YY of one state at positions X (n,) on the surface, (2, n)."""
        return np.asarray(self._alone(state).surface(X)[:, 0])

    @cached_property
    def kinks(self) -> list[Sequence[float] | NDArray]:
        """Positions over a at which each state's pressure is not smooth."""
        each: list[Sequence[float] | NDArray] = [()] * len(self._g)
        for group in self.contacts.groups:
            for row in group.rows.tolist():
                each[row] = group.pressure.kinks
        return [each[row] for row in np.arange(len(self._g))[self._rows].tolist()]

    def _alone(self, state: int) -> Any:
        """Group of one state, which was solved."""
        number = np.arange(len(self._g))[self._rows][state]
        (group,) = (group for group in self.contacts.groups if number in group.rows)
        first = slice(0, 1)
        return replace(
            group, rows=group.rows[first], g=self.g[[state]], half_width=group.half_width[first],
            centre=group.centre[first],
        )  # fmt: skip

    @cached_property
    def inside(self) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY at points inside, (3, states, m)."""
        return self._stresses_of(self.contacts)

    @cached_property
    def inside_punch(self) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY in an elastic punch, at X and -Y of the points inside, (3, states, m)."""
        return _MIRROR * self._stresses_of(self.contacts.in_punch)

    def _stresses_of(self, contacts: Contacts) -> NDArray[np.float64]:
        points = self.places.points
        σ = np.empty((3, len(self._g), len(points)))
        for first in range(0, len(points), _TOGETHER):
            batch = slice(first, first + _TOGETHER)
            σ[:, :, batch] = contacts.stresses(*points[batch].T)
        return σ[:, self._rows]

    @property
    def σ_ZZ(self) -> NDArray[np.float64]:
        """Normal stress out of the plane at points inside, over N/(2a), (states, m)."""
        return self._body.σ_ZZ(self.inside, self.places.points[:, 1])

    @cached_property
    def strength_of_punch(self) -> Any:
        """Yield of an elastic punch, whose heights Y have the other sign."""
        contacts = self._each.contacts.in_punch
        turns, response = _turns_of(contacts), contacts.groups[0].response

        def stresses(points: NDArray) -> NDArray[np.float64]:
            return _MIRROR * contacts.stresses(points[..., 0], points[..., 1])

        mirrored = turns and replace(turns, σ=_MIRROR * turns.σ)
        punch = InSolid(
            response, contacts.of("g"), self.local, self.half_width, stresses, mirrored, self.nearest,
            self.kinks_of_friction,
        )  # fmt: skip
        return self.task.body.of_punch.strength(punch)

    #: Least distance over a from an end or a kink at which stresses are evaluated.
    nearest = 1e-7

    @cached_property
    def _each(self) -> "ExactSolution":
        """The states, of which none shares its contact with a similar one."""
        return self if isinstance(self._rows, slice) else ExactSolution(self.task, self.g)

    @property
    def yield_turns(self) -> Turns | None:
        """Limits of stresses at free ends and under kinks; None where there are none."""
        return self._each._turns

    def stresses(self, points: NDArray) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY, (3, states, n), at points with Y <= 0, (1 or states, n, 2)."""
        return self._each.contacts.stresses(points[..., 0], points[..., 1])


#: Positions over a beside a contact from which stresses at its free ends are extrapolated.
_BESIDE_ENDS = np.multiply.outer(ENDS, 1.0 + np.geomspace(1e-8, 2e-4, 24)).ravel()


def _turns_of(contacts: Contacts) -> Turns | None:
    """Exact stresses at free ends and under kinks, wherever they are finite; None where nowhere."""
    each = []
    for group in contacts.groups:
        kinks = sorted(group.pressure.bends)
        # A weight that is infinite at a free end, times 0 there, has no value at that end.
        exponents = np.column_stack([group.β, group.α])
        finite = exponents[0] > 0.0
        X = np.concatenate([ENDS[finite], kinks])
        σ_XX, σ_YY = group.surface(X)
        between = None
        if kinks:
            places = np.array([-1.0, *kinks, 1.0])
            left, right = ~group.free[0]
            infinite = np.array([left, *[False] * len(kinks), right])
            _, between = at_and_between(places, lambda r: group.surface(r)[0], infinite)  # noqa: B023
        σ = np.array([σ_XX, σ_YY, group.ratio(X) * σ_YY])
        turns = Turns(np.tile(X, (len(group.rows), 1)), σ, between)
        hidden = np.where(group.free & ~finite, exponents + 1.0, np.nan)
        if np.isfinite(hidden).any():
            in_plane, contact = group.surface(_BESIDE_ENDS)
            beside = Surface(Places(_BESIDE_ENDS, np.empty((0, 2))), contact, in_plane)
            turns = turns_at_ends(beside, Exponents(hidden[:, 1], hidden[:, 0])).joined(turns)
        each.append(turns)
    all_turns = together(each)
    return all_turns.of(contacts.order) if all_turns and all_turns.X.size else None


@dataclass(frozen=True)
class Layers:
    """Method by the integral equation of layers, with kernels once a speed.

    Attributes:
        tolerance: relative tolerance.
    """

    tolerance: float

    def at(self, task: Task, g: NDArray) -> AbstractContextManager[Any]:
        body = task.body
        # A place inside is in one layer with one friction and in another with the next.
        every = bool(len(task.places.points) or len(task.places.around)) and body.found
        layers = under_punch(body, task.response, self.tolerance, every or bool(body.along))
        if body.knots:  # a prescribed pressure needs no equation
            pressure: Any = body.pressure
            fine, coarse = (
                replace(pressure, nodes=nodes, rough=layers.kernel.rough) for nodes in (FINE, COARSE)
            )
            prepared: Any = [SolvedContact(0.0, fine, before=coarse)], [], 0.0
        elif layers.interpolates(g):
            solved, interpolated = layers.solved(g)
            each = zip(*(groups_of(layers, of, np.array([of.g]), np.zeros(1, int)) for of in solved))
            prepared = solved, [Nodes(groups) for groups in each], interpolated
        else:
            prepared = None

        def states(own: NDArray) -> LayeredSolution:
            if prepared:
                solved, nodes, error = prepared
                return LayeredSolution(task, layers, solved, nodes, error, own)
            solved, _ = layers.solved(np.unique(own))
            if self.tolerance <= OF_ENDS:
                body.keep(task.response.c, layers.punch.unit, solved)
            return LayeredSolution(task, layers, solved, [], 0.0, own)

        return nullcontext(SimpleNamespace(states=states, record=dict))


@dataclass(frozen=True)
class OnLayers(Group):
    """States over layers whose pressure is of one kind, and their stresses.

    Attributes:
        layers: the layers, with kernels.
    """

    layers: LayersUnderPunch

    @property
    def size(self) -> float:
        """Half-width of the contacts over the unit of the layers."""
        return float(self.half_width[0]) / self.layers.punch.unit

    def strain(self, r: NDArray) -> NDArray[np.float64]:
        name = "strain", r.tobytes()
        reach = 1.0 + float(np.abs(r).max(initial=0.0))
        return self.pressure.read(
            self, name, lambda of: of.pressure.strain(of.g, self.layers.scaled(of.size, reach), r)
        )

    def inside(self, X: NDArray, Y: NDArray) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY at points (1, n), at an interface those above it: (3, rows, n)."""
        X, Y = X[0], Y[0]
        σ = np.empty((3, len(self.rows), len(X)))
        for height in np.unique(Y).tolist():
            there = height == Y
            at_height = partial(OnLayers._at_height, X=X[there], height=height)
            σ[..., there] = self.pressure.read(self, ("inside", height, X[there].tobytes()), at_height)
        return σ

    def _at_height(self, X: NDArray, height: float) -> NDArray[np.float64]:
        h, errors = self.size, self.layers.errors
        level = self.layers.level(-height * h, h * (1.0 + float(np.abs(X).max())))
        errors[height] = max(errors.get(height, 0.0), h * level.error)
        return self._along(X, level, 1)[[2, 0, 1]]

    def at_interface(self, X: NDArray, level: Level) -> NDArray[np.float64]:
        """σ_YY, σ_XY, σ_XX above and below an interface at X (n,): (4, rows, n)."""
        return self.pressure.read(
            self, ("interface", level.depth, X.tobytes()), lambda of: of._along(X, level, 2)
        )

    def _along(self, X: NDArray, level: Level, sides: int) -> NDArray[np.float64]:
        """σ_YY, σ_XY and σ_XX above a depth, or on both sides: (2 + sides, rows, n)."""
        t, forces = self.pressure.points(level.length / self.size)
        g, ratios = self.pressure.ratios(self.g, t)
        u_X, σ_YY, σ_XY = level.read(t, forces, g, X, self.size, ratios)
        media = [(medium.modulus, medium.response) for medium in level.media[:sides]]
        return np.array([σ_YY, σ_XY, *(M * solid.σ_XX(u_X, σ_YY / M, σ_XY / M) for M, solid in media)])


def groups_of(layers: LayersUnderPunch, of: SolvedContact, g: NDArray, rows: NDArray) -> tuple[Any, Any]:
    """States ``rows`` of a contact that was solved, and with fewer unknowns; g of all states."""
    kind: Any = partial(OnLayers, layers=layers) if layers.stack else Group
    h, m = (np.full(len(rows), length * layers.punch.unit) for length in (of.half_width, of.centre))
    fine = kind(layers.response, rows, g[rows], of.pressure, h, m)
    return fine, replace(fine, pressure=of.before)


#: Values of all nodes that are kept.
_KEPT = 64


class Nodes:
    """Contacts at Chebyshev's points in g, between which all states of a speed are interpolated.

    Args:
        groups: contacts, one state each.
    """

    def __init__(self, groups: Sequence[OnLayers]) -> None:
        self.groups = groups
        self._read: dict[Any, NDArray] = {}

    def read(self, what: Any, values: Callable[[OnLayers], NDArray]) -> NDArray[np.float64]:
        """Values of all nodes, (..., nodes, n); the last ones are kept, for other states."""
        if what not in self._read:
            if len(self._read) >= _KEPT:
                self._read.clear()
            self._read[what] = np.concatenate([values(group) for group in self.groups], axis=-2)
        return self._read[what]

    def between(self, g: NDArray) -> Contacts:
        """States with frictions between those of the nodes, (states,)."""
        first = self.groups[0]
        g_nodes, h, m = (
            np.concatenate([getattr(node, name) for node in self.groups])
            for name in ("g", "half_width", "centre")
        )
        weights, edges = polynomial_through(g_nodes).shares(g), EdgeExponents(first.response, g[:, None])
        pressure = Interpolated(self, weights, edges.α, edges.β)
        # Exact where all nodes have one half-width.
        half_width = h[0] + weights @ (h - h[0])
        group = replace(
            first,
            rows=np.arange(len(g)),
            g=g,
            pressure=pressure,
            half_width=half_width,
            centre=weights @ m,
        )
        return Contacts((group,))


@dataclass(frozen=True)
class Interpolated(Pressure):
    """Pressures of states whose smooth factors are interpolated between those of nodes.

    Attributes:
        nodes: contacts at some frictions.
        weights: of the nodes in each state, (states, nodes).
        α, β: exponents at the right and the left end, (states, 1).
    """

    nodes: Nodes
    weights: NDArray[np.float64]
    α: Any
    β: Any

    def read(self, group: Any, what: Any, values: Callable[[Any], NDArray]) -> NDArray[np.float64]:
        """Values of all states by those of the nodes, (..., 1, n) each; see :meth:`Pressure.read`."""
        return np.asarray(self.weights @ self.nodes.read(what, values))

    @property
    def free(self) -> NDArray[np.bool_]:
        return np.asarray(self.nodes.groups[0].pressure.free)

    @property
    def near(self) -> float:  # type: ignore[override]
        return float(min(node.pressure.near for node in self.nodes.groups))

    def series(self, r: NDArray) -> NDArray[np.float64]:
        return self.read(None, ("p", r.tobytes()), lambda node: node.pressure.series(r)[None])

    def rest(self, r: NDArray, near: float) -> NDArray[np.float64]:
        return self.read(
            None, ("rest", r.tobytes(), near), lambda node: node.pressure.rest(r, near)[None]
        )

    def at(self, z: NDArray) -> NDArray[np.complex128]:
        return self.read(None, ("at", z.tobytes()), lambda node: np.atleast_2d(node.pressure.at(z)))

    def states(self) -> Iterator[Pressure]:
        rows = zip(self.weights, self.α[:, 0].tolist(), self.β[:, 0].tolist())
        return (replace(self, weights=row, α=α, β=β) for row, α, β in rows)


class LayeredSolution(ExactSolution):
    """States of contacts over layers.

    Args:
        task: their speed.
        layers: the layers under the punch.
        solved: contacts at the frictions that were solved; one under a prescribed pressure.
        nodes: contacts between which states are interpolated, and those with fewer unknowns; or none.
        interpolation: relative error of that.
        g: σ_XY/σ_YY, (states,).
    """

    contacts: Contacts

    def __init__(
        self, task: Task, layers: LayersUnderPunch, solved: list[SolvedContact], nodes: Sequence[Nodes],
        interpolation: float, g: NDArray,
    ) -> None:  # fmt: skip
        super().__init__(task, g)
        self._layers, self._solved, self._interpolation = layers, solved, interpolation
        changes = np.array([of.change for of in solved])
        if nodes:
            self._both = tuple(each.between(g) for each in nodes)
            self._change = np.full(len(g), changes.max())
        else:
            which = np.searchsorted([of.g for of in solved], g)
            which = np.minimum(which, len(solved) - 1)  # one pressure is prescribed for all
            self._change = changes[which]
            rows = [(solved[i], g, np.flatnonzero(which == i)) for i in np.unique(which)]
            self._both = tuple(Contacts(of) for of in zip(*(groups_of(layers, *each) for each in rows)))
        #: Contacts of the states, and those with fewer unknowns.
        self.contacts, self._coarse = self._both

    @property
    def _shared(self) -> float:
        """Relative error of all that is linear in the pressure by interpolation and by the kernel."""
        of_kernel = 2.0 * np.pi * self._layers.kernel.error / abs(self._layers.response.n)
        return float(self._interpolation + of_kernel)

    def _limits(self, surface: Surface) -> Turns | None:
        """Limits of stresses at kinks, and at free ends of contacts that have kinks."""
        profile = self._body.profile
        if self._body.knots:
            return super()._limits(surface)
        if jumps(profile) or not len(kinks(profile)) or not self.contacts.of("free").any():
            return None
        ends = turns_at_ends(surface, self.local)
        return ends.joined(self._turns) if self._turns else ends

    @cached_property
    def both_interfaces(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Stresses along interfaces, and with fewer unknowns, and the tables' errors.

        Arrays (2, 4, states, interfaces, n) and (interfaces,).
        """
        X, σ, errors = self.places.along, [], []
        for level in self._levels:
            σ.append([each.joined(lambda group: group.at_interface(X, level), 1) for each in self._both])  # noqa: B023
            errors.append(self._widest * level.error)
        return np.stack(σ, axis=3), np.array(errors)

    @property
    def _widest(self) -> float:
        """Largest half-width of the contacts that were solved, in the unit of the punch."""
        return max(contact.half_width for contact in self._solved)

    @cached_property
    def _levels(self) -> list[Level]:
        """Stresses along every interface under a line load."""
        layers, reach = self._layers, 1.0 + float(np.abs(self.places.along).max())
        assert layers.stack
        depths = layers.stack.depths[: len(self.places.interfaces)].tolist()
        return [layers.level(depth, self._widest * reach) for depth in depths]

    def at_interface(self, state: int, interface: int, X: NDArray) -> NDArray[np.float64]:
        """σ_YY, σ_XY, σ_XX above and below an interface at X (n,) of one state, (4, n)."""
        return np.asarray(self._alone(state).at_interface(X, self._levels[interface])[:, 0])

    @property
    def interfaces(self) -> NDArray[np.float64]:
        """σ_YY, σ_XY, σ_XX above and below along every interface, (4, states, interfaces, n)."""
        return self.both_interfaces[0][0]

    @cached_property
    def both_inside(self) -> NDArray[np.float64]:
        """Stresses inside, and with fewer unknowns, (2, 3, states, m)."""
        X, Y = self.places.points.T[:, None]
        return np.array([each.joined(lambda group: group.inside(X, Y), 1) for each in self._both])

    @property
    def inside(self) -> NDArray[np.float64]:  # type: ignore[override]
        """σ_XX, σ_YY, σ_XY at points inside, (3, states, m)."""
        return self.both_inside[0]

    @cached_property
    def σ_ZZ(self) -> NDArray[np.float64]:  # type: ignore[override]
        """Normal stress out of the plane at points inside, over N/(2a), (states, m)."""
        Y = self.places.points[:, 1]
        sizes = self.half_width / self._layers.punch.unit
        σ_ZZ = np.empty(self.inside.shape[1:])
        for h in np.unique(sizes).tolist():
            rows = sizes == h
            σ_ZZ[rows] = self._body.σ_ZZ(self.inside[:, rows], h * Y)
        return σ_ZZ

    def inside_of(self, state: int, points: NDArray) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY at points inside, all at one depth, of one state, which was solved: (3, n)."""
        return self._alone(state).inside(*points.T[:, None])[:, 0]

    @property
    def estimates(self) -> "_Evaluated":
        """Estimated relative errors, (states,), by word of output.quantities.

        They add the change with the number of unknowns, the effect of the kernels' and the tables'
        errors, and the error of the interpolation over frictions.
        """
        return _Evaluated(
            {
                INTENSITIES: lambda: self._change + self._shared,
                ON_SURFACE: self._on_surface,
                AT_INTERFACES: self._at_interfaces,
                BELOW: self._below,
            }
        )

    def _on_surface(self) -> NDArray[np.float64]:
        X = self.places.X
        now, before = (contacts.on_surface(X)[0] for contacts in (self.contacts, self._coarse))
        size = stresses.of_in_plane(now, X)
        # Next to a tip stresses are infinite, and their error is that of the distance to it.
        tips = self.contacts.joined(
            lambda group: np.full((len(group.rows), 1), (*group.pressure.tips, np.inf)[0])
        )
        change = np.where(stresses.off_tips(X, tips), np.abs(now - before), 0.0)
        return self._relative(change, 2.0 * self._layers.kernel.error, size)

    def _at_interfaces(self) -> NDArray[np.float64]:
        (now, before), errors = self.both_interfaces
        size = np.broadcast_to(stresses.of_interfaces(now), now.shape)
        return self._relative(np.abs(now - before), errors[:, None], size)

    def _below(self) -> NDArray[np.float64]:
        now, before = self.both_inside
        X, Y = self.places.points.T
        tables = np.array([self._layers.errors.get(height, 0.0) for height in Y.tolist()])
        size = stresses.of_inside(now, X, Y)
        return self._relative(stresses.largest(now - before), tables, size)

    def _relative(self, change: NDArray, tables: Any, size: NDArray) -> NDArray[np.float64]:
        """Change and error of the tables over the sizes of stresses, plus shared errors, (states,)."""
        relative = (change + tables) / size
        if relative.ndim == 4:
            relative = np.moveaxis(relative, 1, 0)
        return relative.reshape(len(self.g), -1).max(axis=1) + self._shared


class _Evaluated(dict[str, Callable[[], NDArray[np.float64]]]):
    """Values by name, each computed when it is read."""

    def __getitem__(self, name: str) -> Any:
        return super().__getitem__(name)()
