"""Contacts with free ends over layers, by the singular integral equation.

**Two free ends, any convex profile.** With T the operator of the equation in
:mod:`galinx.solvers.contact.equation`, its adjoint is, but for the sign, that of the same contact seen
from the other side: -q for q, and -K(-x) for K(x). Let ρ₁ be the pressure of a flat punch there, and ρ₂
that under the slope 1 without a resultant. A pressure σ that vanishes at both ends under the slope f, T σ
= f, then has ∫ ρ f = -∫ (-T* ρ) σ, so that

    ∫ ρ₁ P'(m + h s) ds = 0,        N/μ = h ∫ ρ₂ P'(m + h s) ds.

These conditions on the slope alone (:func:`rule_of_ends`) give both ends, by
:mod:`galinx.solvers.contact.ends`. Both ρ are smooth functions over w = (1 - s)^a (1 + s)^b, whatever the
profile is; without layers ρ₁ is 1/w and ρ₂ is s/w but for factors.

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

from ..layers.kernel import REACH, Kernel, Scaled
from ..layers.layered import Layered
from ..profiles import check_reach, cusp, jumps, kinks
from ..profiles.flat import Flat
from .ends import Punch, Rule, free_ends, half_width_of_load, logarithm_of_load
from .equation import (
    Contacts,
    ContactsAtSpeed,
    Equation,
    Parts,
    Resolution,
    SolvedContact,
    check_exponents,
    converged,
    is_converged,
    not_converged,
    resolutions,
)
from .panelled import Panels
from .panels import FreeEnds
from .pressure import Expansion, Pressure
from .uniform import contacts, off_tips, panels_of

#: Longest panel for a sum of so many polynomials, times their number, and at most.
_PANEL, _LONGEST = 16.0, 0.7


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


def rule_of_ends(equation: Equation, resolution: Resolution) -> Rule:
    """Quadrature of the conditions on both ends of contacts of one half-width.

    Args:
        equation: of such a contact; its slope is not used.
        resolution: number of polynomials, or longest panel.
    """
    adjoint = Equation(_Adjoint(equation.response), _Adjoint(equation.kernel), equation.g, np.zeros_like)  # type: ignore[arg-type]
    parts = adjoint.parts(resolution, (np.zeros_like, np.ones_like), (-2.0, 0.0))
    ρ1, ρ2 = (parts.pressure(amplitudes) for amplitudes in np.eye(2))

    def rule(kinks: tuple[float, ...]) -> tuple[NDArray, NDArray, NDArray]:
        panels = Panels(ρ1.α, ρ1.β, finest(resolution), kinks)
        lifting, carrying = (panels.weights * ρ.series(panels.t) for ρ in (ρ1, ρ2))
        return panels.t, -lifting, carrying

    return rule


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


#: Positions on which kernels are held at once, over those of a rule.
_TOGETHER = 200


@dataclass(frozen=True)
class Kinked(Pressure):
    """Pressure between free ends under a slope with kinks.

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
    def near(self) -> float:  # type: ignore[override]
        """|r| up to which p can be evaluated."""
        return self.more.near

    @property
    def α(self) -> float:  # type: ignore[override]
        """Exponent at the right end, that of an edge."""
        return float(self.more.α)

    @property
    def β(self) -> float:  # type: ignore[override]
        """Exponent at the left end, that of an edge."""
        return float(self.more.β)

    @cached_property
    def _alone(self) -> Expansion:
        return on_panels(self.alone, self.finest, self.places)

    def series(self, r: NDArray) -> NDArray[np.float64]:
        return without_weight(self.alone, off_tips(r, self.tips)) + self.more.series(r)

    def rest(self, r: NDArray, near: float) -> NDArray[np.float64]:
        values, under = self.more.rest(r, near), np.abs(r) < 1.0
        # cot(πα) = Q/n turns σ₀ under the punch into f/n.
        values[under] += self.alone.slope(r[under]) / self.alone.n
        values[~under] += self.alone.hilbert(r[~under])
        return values

    def integral(self, kernel: Callable[[NDArray], NDArray], r: NDArray) -> NDArray[np.float64]:
        return self.more.integral(kernel, r) + integral(self._alone, kernel, r, self.rough)

    def points(self, finest: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        fine = on_panels(self.alone, min(finest, self.finest), self.places)
        (t, σ), (t_alone, σ_alone) = self.more.points(finest), fine.points(np.inf)
        return np.append(t, t_alone), np.append(σ, σ_alone)

    def continued(self, free: tuple[bool, bool]) -> "Kinked":
        return replace(self, more=self.more.continued(free))


def without_weight(alone: FreeEnds, r: NDArray) -> NDArray[np.float64]:
    """σ₀ over the weight of edges, whose exponents are 1 less, which is 0 from both ends on."""
    return (1.0 - r) * (1.0 + r) * alone.series(r)


def on_panels(alone: FreeEnds, finest: float, places: tuple[float, ...]) -> Expansion:
    """σ₀ by its values on panels that get shorter towards its kinks."""
    panels = Panels(alone.α - 1.0, alone.β - 1.0, finest, places)
    return panels.pressure(without_weight(alone, panels.t))


def integral(
    pressure: Expansion, kernel: Callable[[NDArray], NDArray], r: NDArray, rough: bool
) -> NDArray[np.float64]:
    """∫ kernel(r - t) σ(t) dt, (len(r), functions)."""
    if rough:
        return pressure.integral(kernel, r)
    t, σ = pressure.points(np.inf)
    batches = [r[first : first + _TOGETHER] for first in range(0, len(r), _TOGETHER)]
    return np.concatenate([np.einsum("rtf,t->rf", kernel(part[:, None] - t), σ) for part in batches])


def kinked(
    equation: Equation, resolution: Resolution, punch: Punch, m: float, h: float
) -> tuple[Pressure, float]:
    """Pressure of a contact with kinks, and its correction as of :func:`vanishing`.

    Args:
        equation: of the contact, with its slope.
        resolution: number of polynomials, or longest panel.
        punch: the punch.
        m, h: middle and half-width.
    """
    a, profile, places = 1.0 + equation.α, punch.profile, punch.kinks(m, h)
    panels = panels_of(profile, a, places)
    whole = equation.slope(panels.t)
    mean = float(panels.weights @ whole / panels.weights.sum())

    def slope(r: NDArray) -> NDArray[np.float64]:
        return equation.slope(r) - mean

    alone = FreeEnds(
        panels, whole - mean, slope, equation.n, equation.g * float(equation.response.q),
        places, cusp=cusp(profile),
    )  # fmt: skip
    carried = -np.sin(np.pi * a) / equation.n * float(panels.weights @ (panels.t * (whole - mean)))
    longest, rough = finest(resolution), equation.kernel.rough
    on_surface = on_panels(alone, longest, places)

    def of_layers(r: NDArray) -> NDArray[np.float64]:
        by_kernel = integral(on_surface, equation.kernel, r, rough)
        return mean - by_kernel[:, 3] - equation.g * by_kernel[:, 2]

    more = Equation(equation.response, equation.kernel, equation.g, of_layers, places)
    tips = places if jumps(profile) else ()
    added, taken = vanishing(more, resolution, -2.0 - carried)
    return Kinked(alone, added, places, longest, rough, tips), taken


def _contact(
    pressure: Pressure, h: float, m: float, free: tuple[bool, bool], correction: float = 0.0
) -> SolvedContact:
    """Contact at a resolution, with the relative correction that takes intensities from free ends."""
    return SolvedContact(pressure.continued(free), None, correction, h, m, free)


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

    def solved(self, g: NDArray) -> tuple[Contacts, NDArray[np.float64]]:
        # Kinks move over the contact with friction, and edges lift off at one: nothing is smooth in it.
        if self.every or len(kinks(self.punch.profile)) or isinstance(self.punch.profile, Flat):
            return Contacts(g, self._each(g)), np.zeros(1)
        return super().solved(g)

    def _each(self, g: NDArray) -> list[SolvedContact]:
        answers: list[SolvedContact] = []
        h = 1.0
        for value in g.tolist():
            contact = self.contact(value, h)
            h = contact.half_width
            answers.append(contact)
        return answers

    def contact(self, g: float, h: float = 1.0) -> SolvedContact:
        """The contact with a friction.

        Args:
            g: σ_XY/σ_YY.
            h: half-width to begin with.

        Raises:
            SolveError: no contact carries the load, or it is not resolved.
        """
        check_exponents(self._equation(g, 1.0))

        def at_resolution(resolution: Resolution) -> SolvedContact:
            nonlocal h
            contact = self._at_resolution(g, h, resolution)
            h = contact.half_width
            return contact

        contact = converged(at_resolution, self.tolerance, self.kernel.rough)
        low, high = (self.punch.unit * (contact.centre + side * h) for side in (-1.0, 1.0))
        check_reach(self.punch.profile, low, high)
        return contact

    def _equation(self, g: float, h: float, slope: Any = np.zeros_like) -> Equation:
        return Equation(self.response, self.scaled(h), g, slope)

    def _at_resolution(self, g: float, h: float, resolution: Resolution) -> SolvedContact:
        """Contact at a resolution, from the half-width h on."""
        if isinstance(self.punch.profile, Flat):
            return self._tilted(g, h, resolution)

        m, h = self._lengths(g, h, resolution)
        equation = self._equation(g, h, self.punch.slope(m, h))
        if self.punch.kinks(m, h):
            pressure, taken = kinked(equation, resolution, self.punch, m, h)
        else:
            pressure, taken = vanishing(equation, resolution)
        return _contact(pressure, h, m, (True, True), taken)

    def _lengths(self, g: float, h: float, resolution: Resolution) -> tuple[float, float]:
        """Middle and half-width of a contact with two free ends, from a half-width on."""
        return free_ends(self.punch, lambda h: rule_of_ends(self._equation(g, h), resolution), h)

    def half_width(self) -> float:
        """Half-width of the contact without friction; its pressure is not computed.

        Raises:
            SolveError: no contact carries the load, or it is not resolved.
        """
        h, error = 1.0, np.inf
        for resolution in resolutions(self.kernel.rough):
            before = h
            if isinstance(self.punch.profile, Flat):
                h = self._tilted(0.0, h, resolution).half_width
            else:
                _, h = self._lengths(0.0, h, resolution)
            error = abs(h / before - 1.0)
            if is_converged(error, self.tolerance):
                return h
        raise not_converged(error, self.tolerance)

    def _tilted(self, g: float, h: float, resolution: Resolution) -> SolvedContact:
        """Contact of a tilted flat punch, the higher edge of which may have lifted off."""
        punch = self.punch
        whole, rise = punch.profile.half_width / punch.unit, punch.profile.rise
        side = 1 if rise > 0.0 else 0
        each: dict[float, tuple[Parts, float]] = {}

        def load(h: float) -> float:
            """Logarithm of the load under which the higher end of the contact has no intensity."""
            parts = self._equation(g, h).parts(resolution, (np.zeros_like, np.ones_like), (-2.0, 0.0))
            flat, bent = parts.ends[side]
            # The slope over N/(2h) that leaves no intensity is (2h/(N/μ)) θ.
            slope = float(-flat / bent)
            each[h] = parts, slope
            carried = 2.0 * h * punch.unit * rise / punch.compression
            return logarithm_of_load(carried / slope) if slope else np.inf

        if load(whole) <= 0.0:
            slope = 2.0 * whole * punch.unit / punch.compression * rise
            pressure = each[whole][0].pressure(np.array([1.0, slope]))
            return _contact(pressure, whole, 0.0, (False, False))
        h = half_width_of_load(load, min(h, whole), punch)
        parts, slope = each[h]
        m = float(np.sign(rise)) * (h - whole)
        pressure = parts.pressure(np.array([1.0, slope]))
        return _contact(pressure, h, m, (side == 0, side == 1))


def free_edges(
    response: Any, g: float, profile: Any, unit: float, compression: float
) -> tuple[bool, bool]:
    """True where the left and the right edge of a tilted punch is free.

    Args:
        response: of the layers at a speed.
        g: σ_XY/σ_YY.
        profile: of the punch.
        unit: unit of length [m].
        compression: N/μ [m].

    Raises:
        SolveError: no contact carries the load.
    """
    punch = Punch(profile, unit, compression)
    speed = FreeContactsAtSpeed(response, response.stack(unit), np.zeros_like, _OF_ENDS, punch)
    return speed.contact(g).free


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
