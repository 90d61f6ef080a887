"""Contacts with free ends over layers, by the singular integral equation.

**Two free ends, any convex profile.** With T the operator of the equation in
:mod:`galinx.solvers.contact.equation`, its adjoint is, but for the sign, that of the same contact seen
from the other side: -q for q, and -K(-x) for K(x). Let ρ₁ be the pressure of a flat punch there, and ρ₂
that under the slope 1 without a resultant. A pressure σ that vanishes at both ends under the slope f, T σ
= f, then has ∫ ρ f = -∫ (-T* ρ) σ, so that

    ∫ ρ₁ P'(m + h s) ds = 0,        N/μ = h ∫ ρ₂ P'(m + h s) ds.

These two conditions on the slope alone give the middle m, and the load that makes a contact of the
half-width h (:class:`Conditions`). Both ρ are smooth functions over w = (1 - s)^a (1 + s)^b, whatever the
profile is; without layers ρ₁ is 1/w and ρ₂ is s/w but for factors, and these are the conditions of
:mod:`galinx.solvers.contact.free_contact`. The load grows with h, which is iterated until the contact
carries the load of the punch.

**A tilted punch one edge of which lifts off.** The contact starts at the other edge, and the intensity at
its free end vanishes for one sum of two pressures, that of a flat punch and that under the slope 1.

**Slopes that jump, or whose derivative jumps** (:class:`Kinked`). What a kink does to the pressure is of
the surface's solid alone: with f the slope less the mean by which the pressure σ₀ of
:mod:`galinx.solvers.contact.panels` vanishes at both ends, what layers add is a pressure under that mean
and under the slope -∫ K(r - t) σ₀(t) dt by which σ₀ bends the layers, which no kink makes rough.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from ..errors import SolveError
from ..layers.kernel import REACH, Kernel, Scaled
from ..layers.layered import Layered
from ..profiles import check_reach, cusp, jumps, kinks
from ..profiles.flat import Flat
from .closed_form import FlatPunch
from .edges import Exponents
from .equation import (
    FIRST,
    ContactsAtSpeed,
    ConvergedPressure,
    Equation,
    Pressure,
    PressuresByFriction,
    Resolution,
    change,
    check_exponents,
    is_converged,
    not_converged,
    resolutions,
)
from .free_contact import NEXT_TO_TIP, Balance, contacts
from .free_contact import local_exponents as of_the_surface
from .panelled import PanelledPressure, Panels
from .panels import FreeEnds

#: Most steps to a half-width, the largest step of its logarithm, and rounding of that.
_STEPS, _LARGEST, _ROUNDING = 80, 1.5, 1e-13
#: Growth of the load's logarithm with that of the half-width: at first, and its bounds in a secant.
_GROWTH, _GROWTHS = 2.0, (0.3, 40.0)
#: Doublings of the middle over the half-width within which it is sought, and its rounding.
_FARTHER, _OF_MIDDLE = 12, 1e-15
#: Longest panel for a sum of so many polynomials, times their number, and at most.
_PANEL, _LONGEST = 16.0, 0.7


@dataclass(frozen=True)
class Punch:
    """A punch with both ends of its contact free, and its load; lengths over a unit shared by states.

    Attributes:
        profile: of the punch, in m.
        unit: the unit of length [m].
        compression: N/μ [m].
    """

    profile: Any
    unit: float
    compression: float

    def slope(self, m: float, h: float) -> Callable[[NDArray], NDArray]:
        """μ v,X over N/(2h) at places over the half-width h from the middle m."""

        def slope(r: NDArray) -> NDArray[np.float64]:
            slopes = np.asarray(self.profile.slope(self.unit * (m + h * r)), dtype=float)
            return 2.0 * h * self.unit / self.compression * slopes

        return slope

    def kinks(self, m: float, h: float) -> tuple[float, ...]:
        """Places inside the contact at which the slope or its derivative jumps."""
        at = (np.array(kinks(self.profile), dtype=float) / self.unit - m) / h
        return tuple(at[np.abs(at) < 1.0].tolist())


@dataclass(frozen=True)
class _Adjoint:
    """Response, or kernels, of the adjoint equation."""

    of: Any

    @property
    def n(self) -> float:
        return float(self.of.n)

    @property
    def n12(self) -> float:
        return float(self.of.n12)

    @property
    def q(self) -> float:
        return -float(self.of.q)

    @property
    def rough(self) -> bool:
        return bool(self.of.rough)

    def __call__(self, x: NDArray) -> NDArray[np.float64]:
        return -np.asarray(self.of(-np.asarray(x, dtype=float)))


@dataclass(frozen=True)
class Conditions:
    """Both conditions on contacts with free ends and one half-width.

    Attributes:
        punch: the punch.
        h: half-width.
        lifting, carrying: ρ₁ and ρ₂.
        finest: longest panel that resolves these.
    """

    punch: Punch
    h: float
    lifting: Pressure
    carrying: Pressure
    finest: float

    def _over(self, ρ: Pressure, m: float) -> float:
        """∫ ρ f ds with f the slope over N/(2h), dimensionless."""
        panels = Panels(ρ.α, ρ.β, self.finest, self.punch.kinks(m, self.h))
        f = self.punch.slope(m, self.h)(panels.t)
        return float(panels.weights @ (ρ.series(panels.t) * f))

    def middle(self) -> float:
        """Middle m of the contact for which the pressure vanishes at both ends.

        Raises:
            SolveError: there is no such middle.
        """

        def pulled(lean: float) -> float:
            return -self._over(self.lifting, lean * self.h)

        far = 1.0
        for _ in range(_FARTHER):
            if pulled(-far) <= 0.0 <= pulled(far):
                return self.h * float(brentq(pulled, -far, far, xtol=_OF_MIDDLE, rtol=1e-15))
            far *= 2.0
        raise SolveError(
            f"no middle of a contact of the half-width {self.h * self.punch.unit:g} m of a "
            f"{self.punch.profile.words()} was found over the layers; take a speed farther from the limit"
        )

    def off(self, m: float) -> float:
        """Logarithm of the load that a contact of this half-width carries, over the punch's load.

        Minus infinity where a flat part carries none, infinity where it would carry tension.
        """
        share = self._over(self.carrying, m) / 2.0
        if share == 0.0:
            return -np.inf
        return float(np.log(share)) if share > 0.0 else np.inf


def conditions(equation: Equation, resolution: Resolution, punch: Punch, h: float) -> Conditions:
    """Conditions on contacts of the half-width h.

    Args:
        equation: of such a contact; its slope is not used.
        resolution: number of polynomials, or longest panel.
        punch: the punch.
        h: half-width.
    """
    adjoint = Equation(_Adjoint(equation.response), _Adjoint(equation.kernel), equation.g, np.zeros_like)  # type: ignore[arg-type]
    parts = adjoint.parts(resolution, (np.zeros_like, np.ones_like), (-2.0, 0.0))
    lifting, carrying = (parts.pressure(amplitudes) for amplitudes in np.eye(2))
    return Conditions(punch, h, lifting, carrying, finest(resolution))


def vanishing(
    equation: Equation, resolution: Resolution, resultant: float = -2.0
) -> tuple[Pressure, float]:
    """Pressure of a contact between two free ends, at which it vanishes.

    An intensity left by the resolution is removed by a little of a flat punch and of the slope 1.

    Args:
        equation: of the contact, with its slope.
        resolution: number of polynomials, or longest panel.
        resultant: ∫ σ_YY dr.

    Returns:
        The pressure, and the correction: the larger of the change of its resultant over that of a punch,
        and the change of its slope over that by which one end alone would carry such a resultant.
    """
    slopes = (equation.slope, np.zeros_like, np.ones_like)
    parts = equation.parts(resolution, slopes, (resultant, -2.0, 0.0))
    K = parts.ends
    little = np.linalg.solve(K[:, 1:], -K[:, 0])
    moved = np.abs(little) * np.abs(K[:, 1:]).max(axis=0) / np.abs(K[:, 1]).max()
    return parts.pressure(np.append(1.0, little)), float(moved.max())


def finest(resolution: Resolution) -> float:
    """Longest panel that resolves a pressure of this resolution."""
    return min(resolution if isinstance(resolution, float) else _PANEL / resolution, _LONGEST)


def balanced(at: Callable[[float], tuple[float, Any]], x: float) -> tuple[float, Any]:
    """Root of a growing function, by secants inside a bracket.

    Args:
        at: of the logarithm of a half-width, gives that of the load over the punch's, and more.
        x: first logarithm.

    Returns:
        The logarithm of the half-width at the root, and what else ``at`` gave there.

    Raises:
        SolveError: there is no root.
    """
    growth, before, low, high = _GROWTH, None, -np.inf, np.inf
    for _ in range(_STEPS):
        off, more = at(x)
        low, high = (max(low, x), high) if off < 0.0 else (low, min(high, x))
        if before is not None and np.isfinite(off) and x != before[0]:
            secant = (off - before[1]) / (x - before[0])
            growth = secant if _GROWTHS[0] < secant < _GROWTHS[1] else growth
        step = -off / growth if np.isfinite(off) else -np.sign(off) * _LARGEST
        step = float(np.clip(step, -_LARGEST, _LARGEST))
        if abs(step) <= _ROUNDING or (
            before is not None and abs(off) <= 1e-12 and abs(off) >= abs(before[1])
        ):
            return x, more
        if not low < x + step < high and np.isfinite(high - low):
            step = (low + high) / 2.0 - x
        if np.isfinite(off):
            before = x, off
        x += step
    raise SolveError(
        f"no contact over the layers was found that carries the load: in {_STEPS} steps its half-width "
        f"came to {np.exp(x):.6g} of that at rest, and still changes; take a speed farther from the "
        "limit"
    )


#: Positions on which kernels are held at once, over those of a rule.
_TOGETHER = 200


@dataclass(frozen=True)
class Kinked:
    """Pressure between free ends under a slope with kinks, see :class:`.contact.Pressure`.

    Attributes:
        alone: σ₀, the pressure on the surface's solid alone.
        more: the pressure that layers add.
        places: of the kinks.
        finest: longest panel on which integrals of σ₀ with kernels are done.
        rough: True where kernels have a logarithm at 0.
        tips: kinks at which the pressure is infinite.
    """

    alone: FreeEnds
    more: Pressure
    places: tuple[float, ...]
    finest: float
    rough: bool
    tips: tuple[float, ...]

    @property
    def near(self) -> float:
        return self.more.near

    @property
    def α(self) -> float:
        return self.more.α

    @property
    def β(self) -> float:
        return self.more.β

    @cached_property
    def _alone(self) -> PanelledPressure:
        return on_panels(self.alone, self.α, self.β, self.finest, self.places)

    def series(self, r: NDArray) -> NDArray[np.float64]:
        return without_weight(self.alone, self.α, self.β, self._off(r)) + self.more.series(r)

    def rest(self, r: NDArray, near: float) -> NDArray[np.float64]:
        values, under = self.more.rest(r, near), np.abs(r) < 1.0
        # cot(πα) = Q/n turns σ₀ under the punch into f/n.
        values[under] += self.alone.slope(r[under]) / self.alone.n
        values[~under] += self.alone.hilbert(r[~under])
        return values

    def integral(self, kernel: Callable[[NDArray], NDArray], r: NDArray) -> NDArray[np.float64]:
        return self.more.integral(kernel, r) + integral(self._alone, kernel, r, self.rough)

    def points(self, finest: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        fine = on_panels(self.alone, self.α, self.β, min(finest, self.finest), self.places)
        t, σ = self.more.points(finest)
        return np.append(t, fine.panels.t), np.append(σ, fine.panels.weights * fine.p)

    def _off(self, r: NDArray) -> NDArray[np.float64]:
        """Positions, moved off tips where the pressure is infinite, (len(r),)."""
        for tip in self.tips:
            side = np.where(r < tip, -1.0, 1.0)
            r = np.where(np.abs(r - tip) < NEXT_TO_TIP, tip + side * NEXT_TO_TIP, r)
        return r


def without_weight(alone: FreeEnds, α: float, β: float, r: NDArray) -> NDArray[np.float64]:
    """σ₀ over the weight (1 - r)^α (1 + r)^β, which is 0 from both ends on."""
    r, inside = np.asarray(r, dtype=float), np.abs(r) < 1.0
    values, at = np.zeros_like(r), r[inside]
    values[inside] = alone.σ_YY(at) * (1.0 - at) ** -α * (1.0 + at) ** -β
    return values


def on_panels(
    alone: FreeEnds, α: float, β: float, finest: float, places: tuple[float, ...]
) -> PanelledPressure:
    """σ₀ by its values on panels that get shorter towards its kinks."""
    panels = Panels(α, β, finest, places)
    return PanelledPressure(panels, without_weight(alone, α, β, panels.t))


def integral(
    pressure: PanelledPressure, kernel: Callable[[NDArray], NDArray], r: NDArray, rough: bool
) -> NDArray[np.float64]:
    """∫ kernel(r - t) σ(t) dt, (len(r), functions)."""
    if rough:
        return pressure.integral(kernel, r)
    t, σ = pressure.panels.t, pressure.panels.weights * pressure.p
    batches = [r[first : first + _TOGETHER] for first in range(0, len(r), _TOGETHER)]
    return np.concatenate([np.einsum("rtf,t->rf", kernel(part[:, None] - t), σ) for part in batches])


def kinked(
    equation: Equation, resolution: Resolution, punch: Punch, m: float, h: float
) -> tuple[Kinked, float]:
    """Pressure of a contact with kinks, and its correction as of :func:`vanishing`.

    Args:
        equation: of the contact, with its slope.
        resolution: number of polynomials, or longest panel.
        punch: the punch.
        m, h: middle and half-width.
    """
    a, profile, places = 1.0 + equation.α, punch.profile, punch.kinks(m, h)
    panels = Balance(profile, a, np.nan).panels(punch.unit * m, punch.unit * h)
    whole = equation.slope(panels.t)
    mean = float(panels.weights @ whole / panels.weights.sum())

    def slope(r: NDArray) -> NDArray[np.float64]:
        return equation.slope(r) - mean

    alone = FreeEnds(
        panels, whole - mean, slope, equation.n, equation.g * float(equation.response.q),
        (places, cusp(profile)),
    )  # fmt: skip
    carried = -np.sin(np.pi * a) / equation.n * float(panels.weights @ (panels.t * (whole - mean)))
    longest, rough = finest(resolution), equation.kernel.rough
    on_surface = on_panels(alone, equation.α, equation.β, longest, places)

    def of_layers(r: NDArray) -> NDArray[np.float64]:
        by_kernel = integral(on_surface, equation.kernel, r, rough)
        return mean - by_kernel[:, 3] - equation.g * by_kernel[:, 2]

    more = Equation(equation.response, equation.kernel, equation.g, of_layers, places)
    tips = places if jumps(profile) else ()
    added, taken = vanishing(more, resolution, -2.0 - carried)
    return Kinked(alone, added, places, longest, rough, tips), taken


#: Distances from a free end at which pressures are compared too, places between the ends, and the factor
#: by which they have to agree better next to ends.
_NEXT_TO_END, _ACROSS, _MORE_AT_ENDS = np.geomspace(1e-6, 1e-2, 5), np.linspace(-0.9, 0.9, 20), 10.0


@dataclass(frozen=True)
class Contact(ConvergedPressure):
    """A pressure with its contact; lengths are over a unit that all states share.

    Attributes:
        half_width: of the contact.
        centre: its middle, from the punch's axis.
        free: True where the left and the right end are free, and were solved for.
    """

    half_width: float = 1.0
    centre: float = 0.0
    free: tuple[bool, bool] = (True, True)


@dataclass(frozen=True)
class ContactAtResolution:
    """A contact at one resolution.

    Attributes:
        h, m: half-width and middle.
        pressure: the contact's.
        correction: of the pressure, relative, by which no intensity remains at free ends.
        free: True where the left and the right end are free.
    """

    h: float
    m: float
    pressure: Pressure
    correction: float = 0.0
    free: tuple[bool, bool] = (True, True)

    def moved(self, before: "ContactAtResolution") -> float:
        """Relative change of lengths and pressure since ``before``; next to free ends with a factor.

        In-plane stresses follow the pressure with such a factor there.
        """
        lengths = max(abs(self.h - before.h), abs(self.m - before.m)) / self.h
        ends = [side * (1.0 - _NEXT_TO_END) for side, free in zip((-1.0, 1.0), self.free) if free]
        at = np.concatenate([*ends, _ACROSS])
        earlier, later = (
            (1.0 - at) ** p.α * (1.0 + at) ** p.β * p.series(at) for p in (before.settled, self.settled)
        )
        near = np.abs(earlier - later)[: -len(_ACROSS)].max(initial=0.0) / np.abs(later).max()
        return max(change(before.settled, self.settled), lengths, _MORE_AT_ENDS * float(near))

    @cached_property
    def settled(self) -> Pressure:
        """The pressure, continued to zero at free ends where panels resolve it less well."""
        pressure, free = self.pressure, self.free
        if isinstance(pressure, Kinked) and isinstance(pressure.more, PanelledPressure):
            return replace(pressure, more=pressure.more.vanishing(free))
        return pressure.vanishing(free) if isinstance(pressure, PanelledPressure) else pressure


@dataclass(frozen=True)
class Contacts(PressuresByFriction):
    """Contacts with several frictions, from which those with others are interpolated."""

    each: list[Any]

    @cached_property
    def half_width(self) -> NDArray[np.float64]:
        """Half-width of every contact, (nodes,)."""
        return np.array([contact.half_width for contact in self.each])

    @cached_property
    def centre(self) -> NDArray[np.float64]:
        """Middle of every contact, (nodes,)."""
        return np.array([contact.centre for contact in self.each])

    @cached_property
    def free(self) -> NDArray[np.float64]:
        """1 where the left and the right end are free, 0 where they are not, (nodes, 2)."""
        return np.array([contact.free for contact in self.each], dtype=float)

    @cached_property
    def tips(self) -> NDArray[np.float64]:
        """Places at which the pressure is infinite inside the contact, (nodes, k); infinity for none."""
        each = [contact.pressure.tips for contact in self.each]
        places = np.full((len(each), max(map(len, each))), np.inf)
        for row, tips in zip(places, each):
            row[: len(tips)] = tips
        return places

    def of_each(self, what: Callable[[Pressure, float, float], NDArray]) -> NDArray[np.float64]:
        """Values of a function of pressure, friction and half-width, (2, nodes, ...).

        Those of every contact come first, then those of the pressures with fewer unknowns.
        """
        nodes = list(zip(self.each, self.g.tolist(), self.half_width.tolist()))
        return np.array(
            [
                [what(contact.pressure, g, h) for contact, g, h in nodes],
                [what(contact.before, g, h) for contact, g, h in nodes],
            ]
        )

    @property
    def smooth(self) -> NDArray[np.float64]:
        lengths = np.column_stack([self.half_width, self.centre]) / self.half_width.max()
        pressures = super().smooth
        return np.column_stack([pressures / np.abs(pressures).max(), lengths])


#: Accuracy of a half-width at rest, over which others are given.
_AT_REST = 1e-5
#: Accuracy with which an edge counts as lifted off.
_OF_ENDS = 1e-6
#: Reach of tabulated kernels over that which the largest contact so far needs.
_KERNEL_MARGIN = 1.5


@dataclass(frozen=True)
class FreeContactsAtSpeed(ContactsAtSpeed):
    """Contacts with free ends and any friction at one speed, which share kernels.

    Attributes:
        punch: the punch; ``slope`` of :class:`Speed` is not used.
        every: solve each friction, however many there are.
    """

    punch: Any = None
    every: bool = False

    @cached_property
    def _kernels(self) -> list[Kernel]:
        return [Kernel(self.stack, self.tolerance / 1e3)]

    @property
    def kernel(self) -> Kernel:
        """The kernel with lengths over the shared unit."""
        return self._kernels[-1]

    def scaled(self, h: float) -> Scaled:
        """The kernel of a contact of the half-width h; a longer table is made where one is needed."""
        if (needed := REACH * h) > self.kernel.reach:
            self._kernels.append(replace(self.kernel, reach=_KERNEL_MARGIN * needed))
        return Scaled(self.kernel, h)

    def solved(self, g: NDArray) -> tuple[PressuresByFriction, NDArray[np.float64]]:
        # Kinks move over the contact with friction, and edges lift off at one: nothing is smooth in it.
        if self.every or len(kinks(self.punch.profile)) or isinstance(self.punch.profile, Flat):
            return Contacts(g, self._each(g)), np.zeros(1)
        return super().solved(g)

    def _together(self, g: NDArray, each: list[Any]) -> PressuresByFriction:
        return Contacts(g, each)

    def _each(self, g: NDArray) -> list[ConvergedPressure]:
        answers: list[ConvergedPressure] = []
        h = 1.0
        for value in g.tolist():
            contact = self.contact(value, h)
            h = contact.half_width
            answers.append(contact)
        return answers

    def contact(self, g: float, h: float = 1.0) -> Contact:
        """The contact with a friction.

        Args:
            g: σ_XY/σ_YY.
            h: half-width to begin with.

        Raises:
            SolveError: no contact carries the load, or it is not resolved.
        """
        check_exponents(self._equation(g, 1.0))
        before, error = None, np.inf
        for resolution in resolutions(self.kernel.rough, FIRST):
            now = self._at_resolution(g, h, resolution)
            h = now.h
            if before is not None:
                error = max(now.moved(before), now.correction)
                if is_converged(error, self.tolerance):
                    unit = self.punch.unit
                    check_reach(self.punch.profile, unit * (now.m - h), unit * (now.m + h))
                    return Contact(now.settled, before.settled, error, h, now.m, now.free)
            before = now
        raise not_converged(error, self.tolerance)

    def _equation(self, g: float, h: float, slope: Any = np.zeros_like) -> Equation:
        return Equation(self.response, self.scaled(h), g, slope)

    def _at_resolution(self, g: float, h: float, resolution: Resolution) -> ContactAtResolution:
        """Contact at a resolution, from the half-width h on."""
        if isinstance(self.punch.profile, Flat):
            return self._tilted(g, h, resolution)

        h, m = self._lengths(g, h, resolution)
        equation = self._equation(g, h, self.punch.slope(m, h))
        if self.punch.kinks(m, h):
            return ContactAtResolution(h, m, *kinked(equation, resolution, self.punch, m, h))
        return ContactAtResolution(h, m, *vanishing(equation, resolution))

    def _lengths(self, g: float, h: float, resolution: Resolution) -> tuple[float, float]:
        """Half-width and middle of a contact with two free ends."""

        def at(x: float) -> tuple[float, float]:
            h = float(np.exp(x))
            both = conditions(self._equation(g, h), resolution, self.punch, h)
            m = both.middle()
            return both.off(m), m

        x, m = balanced(at, float(np.log(h)))
        return float(np.exp(x)), m

    def half_width(self) -> float:
        """Half-width of the contact without friction; its pressure is not computed.

        Raises:
            SolveError: no contact carries the load, or it is not resolved.
        """
        h, error = 1.0, np.inf
        for resolution in resolutions(self.kernel.rough, FIRST):
            before = h
            if isinstance(self.punch.profile, Flat):
                h = self._tilted(0.0, h, resolution).h
            else:
                h, _ = self._lengths(0.0, h, resolution)
            error = abs(h / before - 1.0)
            if is_converged(error, self.tolerance):
                return h
        raise not_converged(error, self.tolerance)

    def _tilted(self, g: float, h: float, resolution: Resolution) -> ContactAtResolution:
        """Contact of a tilted flat punch, the higher edge of which may have lifted off."""
        punch = self.punch
        whole, rise = punch.profile.half_width / punch.unit, punch.profile.rise
        side = 1 if rise > 0.0 else 0

        def at(x: float) -> tuple[float, Any]:
            h = float(np.exp(x))
            parts = self._equation(g, h).parts(resolution, (np.zeros_like, np.ones_like), (-2.0, 0.0))
            flat, bent = parts.ends[side]
            # The slope over N/(2h) that leaves no intensity is (2h/(N/μ)) θ.
            share = -flat / bent / rise
            taken = 2.0 * h * punch.unit / (share * punch.compression)
            return float(np.log(taken)) if share > 0.0 else np.inf, (parts, -flat / bent)

        off, (parts, _) = at(float(np.log(whole)))
        if off <= 0.0:
            slope = 2.0 * whole * punch.unit / punch.compression * rise
            return ContactAtResolution(
                whole, 0.0, parts.pressure(np.array([1.0, slope])), free=(False, False)
            )
        x, (parts, slope) = balanced(at, float(np.log(min(h, whole))))
        h, pressure = float(np.exp(x)), parts.pressure(np.array([1.0, slope]))
        m = float(np.sign(rise)) * (h - whole)
        return ContactAtResolution(h, m, pressure, free=(side == 0, side == 1))


def local_exponents(
    response: Any, g: NDArray, profile: Any, unit: float, compression: NDArray
) -> Exponents | FlatPunch:
    """Exponents at both ends by local analysis: those of the surface's solid, plus 1 at free ends.

    Args:
        response: of the layers at a speed.
        g: σ_XY/σ_YY, (states,).
        profile: of the punch.
        unit: unit of length, where the equation has to be solved [m].
        compression: N/μ, one for all states or one for each [m].
    """
    if not (isinstance(profile, Flat) and profile.rise):
        return of_the_surface(response, g, profile, compression)
    flat, free = FlatPunch(response, g), np.zeros((len(g), 2))
    each = np.broadcast_to(compression, g.shape)
    for N in np.unique(each).tolist():
        punch, rows = Punch(profile, unit, N), each == N
        speed = FreeContactsAtSpeed(response, response.stack(unit), np.zeros_like, _OF_ENDS, punch)
        try:
            free[rows] = [speed.contact(value).free for value in g[rows].tolist()]
        except SolveError:
            continue  # reported by the method that solves
    free_left, free_right = free.T
    return Exponents(flat.α + free_right, flat.β + free_left)


@lru_cache(maxsize=256)
def half_width_at_rest(solid: Layered, profile: Any, compression: float) -> float:
    """Half-width [m] of a contact at rest without friction, to five digits, over which others are given.

    Args:
        solid: the layers.
        profile: of the punch.
        compression: N/μ [m].

    Raises:
        SolveError: no contact carries the load.
    """
    response = solid.response(0.0)
    # That on the surface's solid alone is near enough to measure lengths by.
    (unit,) = contacts(response, np.zeros(1), profile, compression).of("half_width").tolist()
    punch = Punch(profile, unit, compression)
    speed = FreeContactsAtSpeed(response, response.stack(unit), np.zeros_like, _AT_REST, punch)
    return unit * speed.half_width()
