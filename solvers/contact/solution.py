"""Contact of a punch and a half-plane, and its solutions by any method: friction states at one speed.

Lengths are over the contact's half-width a, stresses over N/(2a), N the load per depth. A
:class:`Contact` has the units of both in SI.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, suppress
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, ClassVar, Protocol, Self

import numpy as np
from numpy.typing import NDArray

from ..errors import SolveError
from ..friction.along import Along, constant
from ..profiles import Profile, exponent, has_free_end, jumps, kinks, kinks_between
from ..solids import Solid
from ..solids.half_plane import HalfPlane
from . import FREE_ENDS, OWN_PRESSURE, VARYING, VARYING_FREE, YIELD
from .edges import EdgeExponents, Exponents
from .extremes import ALONG, FEWER, extreme, settled
from .prescribed_pressure import LinearPressure
from .stresses import BESIDE_TIP, Places, at_and_between, distances, extreme_in_plane, off_tips
from .yielding import SMOOTH, Levels, Strength, StrengthOfLayers, places_in_layers, places_on_rays

#: Ends of a contact: sharp corners of the punch, both free, one that may lift off beside a sharp corner,
#: those of a prescribed pressure.
SHARP, FREE, ONE_FREE, PRESCRIBED = "sharp", "free", "one free", "prescribed"

#: Modes of a punch, and of stresses that are finite everywhere.
PUNCH, FINITE = "punch", "finite stresses"

#: What a quantity may require of a contact: a flat punch, ends that are given, a pressure that is solved
#: for, a height that is a power of |X|, a known stress out of the plane.
FLAT, GIVEN_ENDS, SOLVED, POWER, OUT_OF_PLANE = "flat", "given ends", "solved", "power of |X|", "σ_ZZ"
#: The strength at which a solid yields.
STRENGTH = "yield strength"
#: Stresses of an elastic punch, that out of the plane, and the strength at which it yields.
IN_PUNCH, ZZ_IN_PUNCH = "elastic punch", "σ_ZZ of the punch"
PUNCH_STRENGTH = "yield strength of the punch"
#: A solid without layers, or with some; one that a closed form solves, and a punch whose surface rests.
UNIFORM, LAYERED = "uniform solid", "layers"
CLOSED, RESTING = "closed form", "surface of the punch at rest"

_BOTH_ENDS = np.array([-1.0, 1.0])
#: Jacobi polynomials under a punch that is not flat: smooth profiles need a dozen for the last digits.
_TERMS = 40


@dataclass(frozen=True)
class Contact:
    """Contact between two sharp corners of a punch, in SI; :func:`make_contact` makes other kinds, too.

    The units of results are numbers for a single load, and arrays (states,) for a load of each state.

    Attributes:
        solid: elastic solid of the half-plane.
        profile: shape of the punch.
        load: N per depth [N/m], a number, or that of each state, (states,).
        pressure: prescribed pressure; None where the punch determines it.
        yield_strength: uniaxial yield strength of the solid [Pa]; None where it is not given.
        along: σ_XY/σ_YY over X/a by the number g that stands for it in a state, its mean; empty where it
            is that number all along the contact.
        ends: ``SHARP``, ``FREE``, ``ONE_FREE`` or ``PRESCRIBED``.
        found: True if an end of the contact is free: the half-width then depends on the state.
        knots: positions X/a between which a prescribed pressure is linear; none under a punch.
        yield_knots: positions X/a that stand for a finite pressure where the largest stress below it is
            searched for; none where stresses are infinite.
        tips: positions from the punch's axis [m] at which stresses inside the contact are infinite.
    """

    solid: Solid
    profile: Profile
    load: Any
    pressure: LinearPressure | None = None
    yield_strength: float | None = None
    along: Mapping[float, Along] = field(default_factory=dict)

    ends: ClassVar[Any] = SHARP
    found: ClassVar[bool] = False
    knots: ClassVar[Any] = ()
    yield_knots: ClassVar[Any] = ()
    tips: ClassVar[Any] = ()

    @property
    def modes(self) -> tuple[str, ...]:
        """Modes by which quantities and rules that apply are selected."""
        return (PUNCH, VARYING) if self.along else (PUNCH,)

    @property
    def fem_mode(self) -> str:
        """Mode of finite elements, "" where that depends on the profile and the solid."""
        return VARYING if self.along else ""

    @cached_property
    def flat(self) -> bool:
        """True if the slope of the punch vanishes at 101 positions."""
        return not np.any(self.profile.slope(self.half_width * np.linspace(-1.0, 1.0, 101)))

    @property
    def finite(self) -> bool:
        """True if all stresses are finite: both ends are free, and the profile has no tip."""
        return False

    @property
    def growth_exponent(self) -> float | None:
        """Exponent of the load by which similar contacts grow; None if other loads make others."""
        return 0.0 if self.flat else None

    @property
    def alike(self) -> bool:
        """True if contacts under all loads are similar: they differ in size alone."""
        return self.growth_exponent is not None

    @property
    def presses(self) -> bool:
        """True if it presses everywhere: flat, or a power of the distance, on a uniform solid."""
        return self.growth_exponent is not None and not (self.knots or self.solid.layers)

    @property
    def no_closed_form(self) -> str:
        """Reason why no closed form solves the contact, "" where one does."""
        if self.solid.layers:
            return "the solid has layers, and no closed form"
        if self.along and not self.flat:
            return "friction varies along the contact of a punch that is not flat; sie and fem solve it"
        return ""

    @property
    def half_width(self) -> Any:
        """Half-width a [m], a number or (states,); with free ends at rest and without friction."""
        return self.profile.half_width  # type: ignore[attr-defined]

    @property
    def lacks(self) -> dict[str, str]:
        """Reasons why there are no quantities that require something of the contact.

        Keys are requirements, as ``FLAT``, modes, as ``PUNCH``, or words of output.quantities, as
        :data:`galinx.solvers.contact.YIELD`.
        """
        reasons = self._lacks
        if not self.solid.knows_σ_ZZ:
            reasons[OUT_OF_PLANE] = "σ_ZZ is not known without solid.stiffness_Z"
        if all(strength is None for strength in self.strengths):
            reasons[STRENGTH] = "no yield_strength is given"
        if self.solid.above is None:
            reasons[IN_PUNCH] = "the punch is rigid"
        elif not self.solid.above.knows_σ_ZZ:
            reasons[ZZ_IN_PUNCH] = "σ_ZZ of the punch is not known without punch.solid.stiffness_Z"
        if self.solid.punch_strength is None:
            reasons[PUNCH_STRENGTH] = "no punch.solid.yield_strength is given"
        if self.solid.layers:
            reasons[UNIFORM] = "the solid has layers, each with a strength of its own"
            if not self.finite:
                needs = "over layers it needs a punch with two free ends and no tip, as a cylinder"
                reasons.setdefault(YIELD, needs)
        else:
            reasons[LAYERED] = "the solid has no layers"
        if self.along:
            reasons[FLAT] = "friction varies along the contact"
        if self.no_closed_form:
            reasons[CLOSED] = self.no_closed_form
        if getattr(self.solid, "speed", 0.0):
            reasons[RESTING] = "the punch's surface moves, too"
        return reasons

    @property
    def _lacks(self) -> dict[str, str]:
        """Reasons of :attr:`lacks` by the ends of the contact."""
        reasons = {} if self.flat else {FLAT: "the punch is not flat"}
        if self.along:
            reasons[YIELD] = "where friction varies, the solid may yield apart from the edges"
        return reasons

    @property
    def strengths(self) -> tuple[float | None, ...]:
        """Yield strengths of all layers and of the solid below [Pa]; None where one is not given."""
        return (*(layer.yield_strength for layer in self.solid.layers), self.yield_strength)

    @property
    def of_punch(self) -> "Contact":
        """Contact of the solid of an elastic punch, under the same load; for stresses and yield alone."""
        assert self.solid.above
        return replace(self, solid=self.solid.above, yield_strength=self.solid.punch_strength)

    def response(self, c: float) -> HalfPlane:
        """Response of the half-plane at a speed over its wave speed, dimensionless.

        Raises:
            ValueError: a wave in the half-plane is not faster than this speed.
        """
        return self.solid.response(c, self.half_width) if self.solid.layers else self.solid.response(c)

    def contacts(self, response: HalfPlane, g: NDArray) -> Any:
        """Contacts over a uniform half-plane, see :class:`galinx.solvers.contact.pressure.Contacts`.

        Args:
            response: of the half-plane at a speed.
            g: σ_XY/σ_YY, (states,).

        Raises:
            SolveError: no contact carries the load.
        """
        from .pressure import between_ends

        pressures: list[Any] = [self.flat_punch(response, g[:, None])]
        if self.along:
            from .along import FlatAlong

            pressures = [FlatAlong(response, self.along[value]) for value in g.tolist()]
        elif not self.flat:
            from .equation import UNIFORM as NO_LAYERS
            from .equation import Equation

            pressures = [
                Equation(response, NO_LAYERS, value, self.loaded(load).slope).pressure(_TERMS)
                for value, load in zip(g.tolist(), np.broadcast_to(self.load, g.shape).tolist())
            ]
        return between_ends(response, g, pressures, self.half_width)

    def flat_punch(self, response: HalfPlane, g: NDArray) -> Any:
        """Closed form of a flat punch with one friction a state; g is σ_XY/σ_YY, as it broadcasts."""
        from .closed_form import FlatPunch

        return FlatPunch(response, g)

    @property
    def yield_places(self) -> NDArray[np.float64]:
        """Places X, Y over a at which the stresses of every state are sampled for yield, (n, 2)."""
        if self.solid.layers:
            return places_in_layers(self.solid.depths / self.half_width)
        return Levels(self.yield_knots).places if len(self.yield_knots) else places_on_rays()

    def strength(self, solution: Any) -> Any:
        """Yield of a solution's states; the loads are theirs, [N/m], (states,) or a number."""
        return (StrengthOfLayers if self.solid.layers else Strength)(solution, self)

    def σ_ZZ(self, σ: NDArray, Y: NDArray) -> NDArray[np.float64]:
        """Normal stress out of the plane, (..., n), in the unit of the stresses in it.

        Args:
            σ: σ_XX, σ_YY, σ_XY, (3, ..., n).
            Y: heights over a, not above 0, (n,).
        """
        if self.solid.layers:
            return self.solid.σ_ZZ_at(-Y * self.half_width, σ)  # type: ignore[attr-defined, no-any-return]
        return self.solid.σ_ZZ(*σ)

    def friction(self, g: float, a: float) -> Along:
        """σ_XY/σ_YY over a contact of the half-width a [m], of a state with the number g."""
        return self.along[g].at(a) if self.along else constant(g)

    def ratio(self, g: NDArray, X: NDArray, a: Any = None) -> NDArray[np.float64]:
        """σ_XY/σ_YY under the punch at X over a, (states, n) or (states, 1), of states with numbers g.

        Args:
            g: numbers of the states, (states,).
            X: positions over a, (n,).
            a: half-widths of the contacts [m], (states,), NaN where there is none: the ratio is NaN,
                too; None for that of this contact.
        """
        g = np.asarray(g)
        if not self.along:
            return g[:, None]
        return np.stack([np.full(X.shape, np.nan) if f is None else f(X) for f in self._frictions(g, a)])

    def largest_ratios(self, g: NDArray, a: Any = None) -> NDArray[np.float64]:
        """σ_XY/σ_YY of the largest size along the contacts of :meth:`ratio`, (states,)."""
        return np.array([np.nan if f is None else f.largest for f in self._frictions(g, a)])

    def _frictions(self, g: NDArray, a: Any) -> Iterator[Along | None]:
        """Frictions of :meth:`ratio`, None where there is no contact."""
        each = np.broadcast_to(self.half_width if a is None else a, g.shape).tolist()
        return (None if np.isnan(a) else self.friction(g, a) for g, a in zip(g.tolist(), each))

    @property
    def friction_kinks(self) -> tuple[float, ...]:
        """Positions X/a at which friction along the contact is not smooth, in any state."""
        return tuple(sorted({kink for along in self.along.values() for kink in along.kinks}))

    @property
    def jumps_of_friction(self) -> tuple[float, ...]:
        """Positions X/a of :attr:`friction_kinks`, and those at which a higher derivative jumps."""
        return tuple(sorted({jump for along in self.along.values() for jump in along.jumps}))

    @property
    def own_meshes(self) -> bool:
        """True if kinks, of the punch or of friction, are at other positions X/a in every state."""
        of_friction = self._friction_has_length and len(self.jumps_of_friction) > 0
        return of_friction or len(kinks(self.profile)) > 0

    @property
    def _friction_has_length(self) -> bool:
        return self.found and any(along.has_length for along in self.along.values())

    def edges(self, response: HalfPlane, g: NDArray, a: Any = None, free: Any = False) -> Exponents:
        """Exponents of the pressure at ends with frictions of :meth:`ratio`, (states,).

        Args:
            response: of the half-plane.
            g, a: as of :meth:`ratio`.
            free: True where the left and the right end are free, broadcast to (states, 2).
        """
        at, (left, right) = self.ratio(g, _BOTH_ENDS, a), np.broadcast_to(free, (len(g), 2)).T
        at_right, at_left = (EdgeExponents(response, at[:, end]) for end in (-1, 0))
        return Exponents(at_right.α + right, at_left.β + left)

    def half_widths(self, response: HalfPlane, g: NDArray, load: Any = None) -> Any:
        """Half-widths [m] on which frictions depend, (states,), to a millionth; None where none does.

        NaN stands for a contact that has no solution to a millionth.

        Args:
            response, g, load: as of :meth:`local_exponents`.
        """
        if not self._friction_has_length:
            return None
        each = self._each(response, g, load)
        return np.array([unit * contact.half_width if contact else np.nan for unit, contact in each])

    def local_exponents(self, response: HalfPlane, g: NDArray, load: Any = None) -> Exponents:
        """Exponents of the pressure at the ends of states.

        Args:
            response: of the half-plane at the states' speed, lengths over this contact's half-width.
            g: σ_XY/σ_YY under the punch, (states,).
            load: of each state [N/m], (states,); None for this contact's.
        """
        half_widths, free = self.half_widths(response, g, load), self._free_ends(response, g, load)
        return self.edges(response, g, half_widths, free)

    def _free_ends(self, response: HalfPlane, g: NDArray, load: Any) -> NDArray[np.bool_]:
        """True where the left and the right end of states are free, (states, 2)."""
        free = np.tile(np.logical_not(getattr(self.profile, "sharp", (True, True))), (len(g), 1))
        if self.ends == ONE_FREE:
            if not self.solid.layers and not self.along:
                with suppress(SolveError):
                    return np.asarray(self.loaded(load).contacts(response, g).of("free"))
                return free
            for i, (_, contact) in enumerate(self._each(response, g, load)):
                if contact:
                    free[i] = contact.pressure.free
        return free

    def _each(self, response: HalfPlane, g: NDArray, load: Any) -> list[tuple[float, Any]]:
        """Contacts by the integral equation to a millionth, None for none; units [m] of their lengths.

        The method that solves reports a contact that fails.
        """
        from .equation import OF_ENDS, under_punch

        each, solved = [], self._solved
        for value, N in zip(g.tolist(), np.broadcast_to(self.loaded(load).load, g.shape).tolist()):
            state = response.c, value, N
            if state not in solved:
                at_speed, contact = under_punch(self.loaded(N), response, OF_ENDS), None
                with suppress(SolveError):
                    contact = at_speed.contact(value, checked=False)
                solved[state] = at_speed.punch.unit, contact
            each.append(solved[state])
        return each

    @cached_property
    def _solved(self) -> dict[tuple[float, float, float], tuple[float, Any]]:
        """Contacts of :meth:`_each` by speed, friction and load; those of all loads are in one."""
        return {}

    def keep(self, c: float, unit: float, contacts: Sequence[Any]) -> None:
        """Keep contacts of this load that a method solved to a millionth, so that none is solved twice.

        Args:
            c: their speed over the wave speed.
            unit: of their lengths [m].
            contacts: see :class:`galinx.solvers.contact.equation.SolvedContact`.
        """
        for contact in contacts:
            self._solved[c, contact.g, float(self.load)] = unit, contact

    @property
    def depths(self) -> tuple[str, NDArray[np.float64]]:
        """Unit of interfaces' depths, "1" over a half-width that all states share or "m", and these."""
        return "1", self.solid.depths / self.half_width

    def infinite_ends(self, local: Any) -> NDArray[np.bool_]:
        """True where stresses at the left and the right end are infinite, (states, 2).

        Args:
            local: exponents α at X = a and β at X = -a, (states,).
        """
        return np.column_stack([local.β, local.α]) < 0.0

    def loaded(self, load: Any = None) -> Self:
        """Punch and half-plane under another load [N/m], a number or (states,); unchanged for None."""
        if load is None:
            return self
        other = replace(self, load=load)
        vars(other)["_solved"] = self._solved
        return other

    def growth(self, load: Any) -> Any:
        """Half-widths at other loads [N/m] over that at this load; None if contacts are not similar."""
        k = self.growth_exponent
        return None if k is None else (load / self.load) ** k

    def bounds_on_half_widths(
        self, loads: Sequence[float], speeds: Sequence[float]
    ) -> tuple[float, float]:
        """Least and largest half-width [m] under loads [N/m] and at speeds over c_s."""
        return self.half_width, self.half_width

    @property
    def compression(self) -> Any:
        """Load over the shear modulus, N/μ [m]."""
        return self.load / self.solid.μ

    def height(self, r: NDArray, m: float = 0.0, h: Any = None) -> NDArray[np.float64]:
        """Height of the punch over N/(2μ) at places r over the half-width h from the middle m [m]."""
        h = self.half_width if h is None else h
        return np.asarray(self.profile.height(m + h * r) / self.displacement)

    def slope(self, r: NDArray, m: float = 0.0, h: Any = None) -> NDArray[np.float64]:
        """Slope μ v,X under the punch over N/(2h) at these places."""
        h = self.half_width if h is None else h
        return np.asarray(h * self.profile.slope(m + h * r) / self.displacement)

    @property
    def force(self) -> Any:
        """Unit of nodal forces, N/2 [N/m]: that of stresses, N/(2a), times that of lengths, a."""
        return self.load / 2.0

    @property
    def displacement(self) -> Any:
        """Unit of displacements, N/(2μ) [m]."""
        return self.load / (2.0 * self.solid.μ)

    @property
    def strain(self) -> Any:
        """Unit of strains, N/(2aμ), dimensionless."""
        return self.stress / self.solid.μ

    @property
    def stress(self) -> Any:
        """Unit of stresses, N/(2a) [Pa], a as in :attr:`half_width`.

        With free ends a state's stresses are over its own half-width instead.
        """
        return self.load / (2.0 * self.half_width)


class PrescribedContact(Contact):
    """Prescribed pressure between two given ends."""

    ends, modes, growth_exponent = PRESCRIBED, (OWN_PRESSURE, FINITE), 0.0  # type: ignore[assignment]
    pressure: LinearPressure

    @property
    def knots(self) -> tuple[float, ...]:
        return tuple(self.pressure.knots.tolist())

    @property
    def yield_knots(self) -> NDArray[np.float64]:
        return self.pressure.knots

    @property
    def _lacks(self) -> dict[str, str]:
        return super()._lacks | {SOLVED: "the pressure is prescribed"}

    def infinite_ends(self, local: Any) -> NDArray[np.bool_]:
        return np.tile(self.pressure.values[[0, -1]] != 0.0, (len(local.α), 1))

    def contacts(self, response: HalfPlane, g: NDArray) -> Any:
        from .pressure import between_ends

        return between_ends(response, g, [self.pressure], self.half_width)


class FreeEndContact(Contact):
    """Contact of which the pressure determines an end, or both; its ends are those of the profile."""

    found, flat = True, False  # type: ignore[assignment]

    @property
    def ends(self) -> str:
        return ONE_FREE if any(self.profile.sharp) else FREE  # type: ignore[attr-defined]

    @property
    def modes(self) -> tuple[str, ...]:
        return (PUNCH, FREE_ENDS, *(FINITE,) * self.finite, *(VARYING,) * bool(self.along))

    @property
    def fem_mode(self) -> str:
        return VARYING_FREE if self.along and not (self.solid.layers or self.own_meshes) else ""

    @property
    def finite(self) -> bool:
        return self.ends == FREE and not self.tips

    @property
    def tips(self) -> tuple[float, ...]:
        return tuple(kinks(self.profile)) if jumps(self.profile) else ()

    @property
    def yield_knots(self) -> Any:
        return SMOOTH if self.finite else ()

    @property
    def growth_exponent(self) -> float | None:
        k = exponent(self.profile)
        return None if not k or self.solid.layers or self._friction_has_length else 1.0 / k

    @property
    def _lacks(self) -> dict[str, str]:
        reasons = {
            FLAT: "the punch is not flat",
            PUNCH: "an end of the contact is, or may be, free",
            GIVEN_ENDS: "whose contact ends where the pressure says",
        }
        if not (exponent(self.profile) or 0.0) > 1.0:
            reasons[POWER] = "known where the height is a power of |X|: the contact grows with the load"
        elif self._friction_has_length:
            reasons[POWER] = "friction changes along a contact that grows with the load"
        if not self.finite:
            reasons[YIELD] = (
                "stresses are infinite at a sharp edge or a tip, and any load makes these yield"
            )
        return reasons

    @property
    def depths(self) -> tuple[str, NDArray[np.float64]]:
        return "m", self.solid.depths

    @cached_property
    def half_width(self) -> Any:
        if not np.ndim(self.load):
            return self._at_rest
        first = self.loaded(float(self.load[0]))
        growth = first.growth(self.load)
        if growth is not None:
            return first.half_width * growth
        if not self.solid.layers:
            with suppress(SolveError):
                return self._contacts_at_rest(len(self.load)).of("half_width")
        rest = np.full(np.shape(self.load), np.nan)
        for i, N in enumerate(self.load.tolist()):
            with suppress(SolveError):  # the method that solves reports a contact that fails
                rest[i] = self.loaded(N).half_width
        return rest

    def bounds_on_half_widths(
        self, loads: Sequence[float], speeds: Sequence[float]
    ) -> tuple[float, float]:
        """Least and largest half-width [m] under loads [N/m] and at speeds over c_s.

        A solid is about as soft as its margin is small; contacts grow at most as under wedges.
        """
        rest = [self.half_width]
        if len(loads) > 1:
            rest = self.loaded(np.array([min(loads), max(loads)])).half_width.tolist()
        margin = 1.0
        with suppress(ValueError):  # a speed beyond the limit, which is refused elsewhere
            margin = min(self.response(c).margin for c in speeds)
        return float(np.nanmin(rest)), float(np.nanmax(rest)) / max(margin, 1e-4)

    @property
    def _at_rest(self) -> float:
        """Half-width [m] under one load, at rest and without friction."""
        if self.solid.layers:
            from .equation import half_width_at_rest

            return half_width_at_rest(self.solid, self.profile, self.compression)  # type: ignore[arg-type]
        (rest,) = self._contacts_at_rest(1).of("half_width")
        return float(rest)

    def _contacts_at_rest(self, loads: int) -> Any:
        """Contacts on a uniform solid at rest without friction, under each of so many loads.

        They may be wider than what is known of the punch: friction and speed move the ends of states.
        """
        from .closed_form import contacts

        at_rest = self.solid.response(0.0)
        return contacts(at_rest, np.zeros(loads), self.profile, self.compression, checked=False)

    def contacts(self, response: HalfPlane, g: NDArray) -> Any:
        from .closed_form import contacts

        return contacts(response, g, self.profile, self.compression)

    @cached_property
    def kinks_at_rest(self) -> NDArray[np.float64]:
        """Positions of the punch's kinks over the half-width, at rest and without friction, (kinks,).

        There are none where no contact carries the load: the method that solves reports that.
        """
        try:
            contact = self._contacts_at_rest(1)
        except SolveError:
            return np.empty(0)
        (m,), (h,) = contact.of("centre"), contact.of("half_width")
        return kinks_between(self.profile, m, h)


def make_contact(
    solid: Solid,
    profile: Any,
    load: Any,
    pressure: LinearPressure | None = None,
    yield_strength: float | None = None,
    along: Mapping[float, Along] | None = None,
    free_ends: bool = False,
) -> Contact:
    """Contact of the kind that a punch, or a prescribed pressure, makes on a solid.

    Arguments are its attributes; and ``free_ends``: its ends are searched for even where both are sharp.

    Where an end is free the punch determines the pressure, and a prescribed one is left out.
    """
    kind: type[Contact] = PrescribedContact if pressure else Contact
    if free_ends or has_free_end(profile):
        kind, pressure = FreeEndContact, None
    return kind(solid, profile, load, pressure, yield_strength, along or {})


@dataclass(frozen=True)
class Task:
    """States of one speed, for every method to solve.

    Attributes:
        number: of the speed, from 0.
        body: contact of punch and solid, under the first of the loads.
        response: of the half-plane at that speed.
        places: points where stresses are output.
        runs: rows of the states at that speed, as runs of consecutive states.
        loads: of these states [N/m], each once.
    """

    number: int
    body: Contact
    response: HalfPlane
    places: Places
    runs: tuple[slice, ...]
    loads: tuple[float, ...]

    def of(self, values: NDArray) -> NDArray:
        """Rows of the task's states, of values of all states, (states, …)."""
        return np.concatenate([values[run] for run in self.runs])


def solved_once(
    task: Task, g: NDArray, load: NDArray | None
) -> tuple[NDArray[np.float64], NDArray | None, Any, Any]:
    """States to solve for; contacts that are similar under all loads are solved once for each friction.

    A half-plane has no length: stresses over N/(2a) do not depend on the load under a flat punch, nor
    under a punch whose height is a power of |X|, where the half-width alone follows the load.

    Args:
        task: the speed.
        g: σ_XY/σ_YY, (states,).
        load: load of each state [N/m], (states,); the task's if None.

    Returns:
        Frictions and loads of the states to solve for, None for the task's load; the number of each state
        among these, a slice where they are the same; and its half-width over that of the solved state.
    """
    growth = None if load is None else task.body.growth(load)
    if growth is None:
        return g, load, slice(None), 1.0
    different, rows = np.unique(g, return_inverse=True)
    return different, None, rows, growth


#: Distance over a up to which two kinks are one.
_COINCIDE = 1e-9
#: Difference of the largest by fewer samples, over the largest of all, up to which samples settle it.
_SETTLED = 1e-8


class Solution:
    """Friction states at one speed, from any method; an attribute is computed when it is first used.

    Attributes:
        task: the speed.
        body: contact of punch and solid, under the load of each state.
        g: σ_XY/σ_YY under the punch, (states,).
        local: the local analysis of the punch's edges: exponents α at X = a and β at X = -a, (states,).
        half_width: of each state's contact [m], (states,).
        surface: stresses on the surface.
        pressed: positions X over a under the punch, and contact stress over N/(2a) there, (n,) and
            (states, n).
        inside, σ_ZZ: σ_XX, σ_YY, σ_XY over N/(2a) at points inside, (3, states, m), and that out of the
            plane, (states, m).
        stresses: σ_XX, σ_YY, σ_XY, (3, states, n), at points over a with Y <= 0, (1 or states, n, 2), on
            a uniform solid; over layers ``inside_of`` a state's number at points (n, 2), (3, n).
        interfaces: σ_YY, σ_XY, σ_XX above and below every interface, (4, states, interfaces, n); also
            ``at_interface`` by numbers of a state and an interface at positions X (n,), (4, n).
        at_surface: σ_XX and σ_YY at positions X under the punch (n,) by a state's number, (2, n).
        kinks: positions over a at which each state's pressure is not smooth, (k,) each.
        yield_turns: limits of stresses where they vary like a power of the distance; None for none.
        nearest: least distance over a from these at which ``stresses`` are accurate.
    """

    task: Task
    body: Contact

    @property
    def places(self) -> Places:
        """Places at which stresses are evaluated."""
        return self.task.places

    @property
    def response(self) -> HalfPlane:
        """Half-plane at the states' speed."""
        return self.task.response

    @cached_property
    def strength(self) -> Any:
        """Yield of the states."""
        return self.body.strength(self)

    @cached_property
    def between_kinks_of_friction(self) -> NDArray[np.float64] | None:
        """As :attr:`.stresses.Turns.between`, by places of each state's own; None without such kinks."""
        if not self.body.along:
            return None
        extremes = np.full((2, 2, len(self.g)), np.nan)
        for state in range(len(self.g)):
            if self.kinks_of_friction[state]:
                extremes[..., state] = self.between_kinks(state, lambda σ_XX, σ_YY, σ_XY: σ_XX)
        return None if np.isnan(extremes).all() else extremes

    @cached_property
    def beside_tips(self) -> NDArray[np.float64] | None:
        """Places on both sides of tips from which on stresses count, and σ_XX there, (2, states, n).

        None where there is no tip. Next to one stresses grow to where they no longer count.
        """
        if not self.body.tips:
            return None
        tips = (np.array(self.body.tips) - self.centre[:, None]) / self.half_width[:, None]
        X = np.concatenate([tips - BESIDE_TIP, tips + BESIDE_TIP], axis=1)
        σ = np.full(X.shape, np.nan)
        for state, under in enumerate(np.abs(X) < 1.0):
            if under.any():
                σ[state, under] = self.at_surface(state, X[state, under])[0]
        return np.array([X, σ])

    @cached_property
    def kinks_of_friction(self) -> list[Sequence[float]]:
        """Positions over a at which the friction of each state is not smooth."""
        if not self.body.along:
            return [()] * len(self.g)
        half_widths = np.broadcast_to(self.half_width, self.g.shape)
        return [
            () if np.isnan(a) else self.body.friction(g, a).kinks
            for g, a in zip(self.g.tolist(), half_widths.tolist())
        ]

    def between_kinks(self, state: int, measure: Callable[..., NDArray]) -> NDArray[np.float64]:
        """Largest and smallest measure of a state's stresses between ends and kinks, and their places.

        Args:
            state: its number.
            measure: of σ_XX, σ_YY and σ_XY under the punch, (n,) each.

        Returns:
            Places over a, then values; the largest, then the smallest, (2, 2).
        """
        turns = np.unique([-1.0, *self.kinks_of_friction[state], *self.kinks[state], 1.0])
        turns = turns[np.append(np.diff(turns) > _COINCIDE, True)]
        ends, g, a = self.body.infinite_ends(self.local)[state], self.g[[state]], self.half_width[[state]]
        tips = (np.array(self.body.tips) - self.centre[state]) / a

        def stress(X: NDArray) -> NDArray[np.float64]:
            σ_XX, σ_YY = self.at_surface(state, X)
            σ = measure(σ_XX, σ_YY, self.body.ratio(g, X, a)[0] * σ_YY)
            return np.where(off_tips(X, tips), σ, np.nan)[None]

        infinite = [ends[0], *[False] * (len(turns) - 2), ends[1]]
        return at_and_between(turns, stress, infinite, self.nearest)[1][..., 0]

    @cached_property
    def extremes_in_plane(self) -> list[tuple[NDArray[np.float64], NDArray[np.float64]]]:
        """Highest and lowest in-plane stress over N/(2a), each with its place over a, (states,)."""
        return [extreme_in_plane(self, self.body, sign) for sign in (1.0, -1.0)]

    @cached_property
    def extremes_at_interfaces(self) -> NDArray[np.float64]:
        """Largest and smallest stresses along every interface, over N/(2a), and their places over a.

        The array is (2, 2, 4, states, interfaces): largest or smallest, stress or place, then as
        ``interfaces``.
        """
        count = len(self.body.solid.depths)
        return np.stack([self.extremes_along(i, lambda σ: σ) for i in range(count)], axis=-1)

    def extremes_along(
        self, interface: int, measure: Callable[[NDArray], NDArray], signs: Sequence[float] = (1.0, -1.0)
    ) -> NDArray[np.float64]:
        """Largest and smallest measures along an interface, each and its place, (2, 2, m, states).

        Kinks have places of their own in each state, and these as many samples as edges.

        Args:
            interface: its number.
            measure: of stresses (4, ..., n), see ``interfaces``: (m, ..., n).
            signs: 1 alone for the largest alone, (1, 2, m, states).
        """

        def ends(curves: NDArray, X: NDArray) -> NDArray[np.float64]:
            each = [[extreme(curves, X, s, n) for n in (ALONG, FEWER)] for s in signs]
            return np.swapaxes(each, 1, 2)

        X, σ = self.places.along, self.interfaces[:, :, interface]
        curves = measure(σ)
        of_all = ends(curves, X)
        best = of_all[:, :, 0]
        depths = self.body.solid.depths[interface] / self.half_width
        for state, (places, depth) in enumerate(zip(self.kinks, depths.tolist())):

            def at(X: NDArray) -> NDArray[np.float64]:
                return self.at_interface(state, interface, X)  # noqa: B023

            positions, along, of_state = X, curves[:, state], of_all[..., state]
            if len(places):
                apart = distances(depth, depth)
                near = np.add.outer(places, np.concatenate([-apart, apart])).ravel()
                positions, first = np.unique(np.concatenate([X, near]), return_index=True)
                along = measure(np.concatenate([σ[:, state], at(near)], axis=1)[:, first])
                of_state = ends(along, positions)
            best[..., state] = settled(
                lambda X: measure(at(X)), positions, along, of_state, _SETTLED
            )  # fmt: skip
        return best


#: σ_YY over N/(2a) at positions X over a under the punch.
ContactStress = Callable[[NDArray], NDArray]


class Solver(Protocol):
    """Solver of friction states at one speed."""

    def states(self, g: NDArray) -> Solution:
        """Solve the states with values g of σ_XY/σ_YY, (states,), under the load of the task's body.

        The solvers of a method whose kind has ``loads`` take a second argument, ``load``: the load of
        each state [N/m], (states,), or None for the task's.

        Raises:
            SolveError: the states could not be solved.
        """

    def record(self) -> dict[str, Any]:
        """Numbers of the work done, by the names of ``quantities.runs.RECORD``; may be empty."""


class Method(Protocol):
    """A way to solve the contact, for one plan.

    The ``begin()`` of a method that has it is called once, collectively over all ranks, before speeds are
    shared out over the ranks.
    """

    def at(self, task: Task, g: NDArray) -> AbstractContextManager[Solver]:
        """A solver at one speed.

        Args:
            task: the speed.
            g: all values of σ_XY/σ_YY that will be solved, sorted.

        Raises:
            SolveError: the equations could not be solved there.
        """
