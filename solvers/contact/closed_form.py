"""Exact pressures of rigid punches that slide over a uniform half-plane at constant speed.

Lengths are divided by the half-width a, stresses by N/(2a); positions r = X/a. ``g`` is the signed
ratio σ_XY/σ_YY under the punch: g = -f for a punch that drags the surface along with it.

**Flat punches** have the closed form of Eqs 38-58.

**Parabolic and tilted flat punches** have pressures (1 - s)^α (1 + s)^β (A + B s) whose exponents' sum is
an integer. Cauchy's integral of such a pressure is elementary, so that stresses on and below the surface
are exact: with X(z) = (z - 1)^α (z + 1)^β and q = A + B s

    Φ(z) = (1/π) ∫ σ_YY(t)/(t - z) dt = (X(z) q(z) - [X q])/sin(πα),

[X q] the part of X q that does not vanish at infinity.

**Any punch between two free ends** (:class:`FreeEnds`). With f = μ v,X under the punch, a + b = 1 the
exponents of the pressure, N̂ = n + g n₁₂ and C(y) of :mod:`.panels`, where w = (1 - s)^-a (1 + s)^-b,

    Φ(z) = -(sin πa/(π N̂)) X(z) ∫ w f/(t - z) dt = -(sin πa/(π N̂)) e^(-iπa) C(y).

The ends of such a contact, s over its half-width h from its middle m, meet two conditions for any convex
profile P, which :mod:`galinx.solvers.contact.ends` solves:

    ∫ P'(m + h s)/w ds = 0,        N/μ = h (sin πa/N̂) ∫ s P'(m + h s)/w ds.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import SolveError
from ..profiles import check_reach, cusp, jumps, radius
from ..profiles.punches import Flat
from ..solids.half_plane import HalfPlane
from .edges import EdgeExponents, EdgeTraction, from_edge, under_punch
from .ends import Punch, Rule, free_ends
from .panels import Panels, panels_of_slope, stretched
from .pressure import Contacts, Group, Pressure

#: Newton's steps for the logarithm of a distance; at a double root they halve the error.
_STEPS = 80
#: Logarithm of the largest distance with which they begin: a power of nearly 0 has its level farther out.
_FAR = 600.0


@dataclass(frozen=True)
class FlatPunch(EdgeExponents, Pressure):
    """Pressure of a flat punch at one speed and friction, or at several frictions."""

    def σ_XX(self, r: ArrayLike) -> NDArray[np.float64]:
        """In-plane stress over N/(2a) on the whole surface; NaN where it is infinite (Eq 32)."""
        return self.response.in_plane(self.g, self.σ_YY(r), self.hilbert(r))

    def series(self, r: NDArray) -> Any:
        """Amplitude of the contact stress over N/(2a) (Eq 55).

        The study's Eq 55 has lost the sign of its Eq 37; the stress is compressive.
        """
        return 2.0 * self._sin / np.pi

    @property
    def traction(self) -> EdgeTraction:
        """The contact stress over N/(2a) by distances over a from the two edges."""
        return EdgeTraction(2.0 * self._sin / np.pi, self.α, self.β)

    def hilbert(self, r: ArrayLike) -> NDArray[np.float64]:
        """(1/π) ⨍ σ_YY(t)/(t - r) dt on the whole surface over N/(2a); NaN at |r| = 1."""
        r = np.asarray(r, dtype=float)
        with np.errstate(invalid="ignore", divide="ignore"):
            size = np.abs(1.0 - r) ** self.α * np.abs(1.0 + r) ** self.β
        F = size * np.where(under_punch(r), self._cot, np.sign(r) / self._sin)
        return np.where(from_edge(r) == 0.0, np.nan, 2.0 * self._sin / np.pi * F)

    def at(self, z: NDArray) -> NDArray[np.complex128]:
        """Φ(z) = (2/π)(z - 1)^α (z + 1)^β, see :class:`galinx.solvers.solids.half_plane.Potential`."""
        return 2.0 / np.pi * np.exp(self.α * np.log(z - 1.0) + self.β * np.log(z + 1.0))

    def compressed_within(self, strain: float) -> NDArray[np.float64]:
        """Distances from X = -a and X = a, under the punch, within which -μ u,X over N/(2a) is large.

        Under the punch u,X is a multiple of the pressure, infinite at both edges. From its least value,
        which is between them, the pressure grows towards each, so that its logarithm can be halved.

        Args:
            strain: value of -μ u,X over N/(2a) that is exceeded there, positive.

        Returns:
            Distances over a, (2, …) by the shape of ``g``; both ends share out the whole width.
        """
        return self._distances(self._within, -self._by_pressure, strain)

    def strained_within(self, strain: float) -> NDArray[np.float64]:
        """Distances from X = -a and X = a, on both sides of these, within which |μ u,X| is large.

        Beside the punch u,X is a multiple of the pressure's Hilbert transform.

        Args:
            strain: value of |μ u,X| over N/(2a) that is exceeded there, positive.

        Returns:
            Distances over a, (2, …) by the shape of ``g``.
        """
        beside = 2.0 / np.pi * np.abs(self.response.strain(self.g, 0.0, 1.0))
        return np.maximum(
            self._distances(self._within, np.abs(self._by_pressure), strain),
            self._distances(self._beside, beside, strain),
        )

    @property
    def _by_pressure(self) -> NDArray[np.float64]:
        """μ u,X under the punch over N/(2a) and over (1 - X)^α (1 + X)^β."""
        return np.asarray(2.0 * self._sin / np.pi * self.response.strain(self.g, 1.0, self._cot))

    def _distances(
        self, within: Callable[[Any, Any, Any], NDArray], amplitude: NDArray, strain: float
    ) -> NDArray[np.float64]:
        """Distances from both ends within which a strain of an amplitude is exceeded."""
        # The ratio may overflow.
        log_ratio = np.log(strain) - np.log(np.maximum(amplitude, np.finfo(float).tiny))
        return np.array([within(self.β, self.α, log_ratio), within(self.α, self.β, log_ratio)])

    @staticmethod
    def _beside(own: Any, other: Any, level: Any) -> NDArray[np.float64]:
        """Distance d with own·log d + other·log(2 + d) = level."""
        t = np.minimum((level - other * np.log(2.0)) / own, _FAR)  # as if 2 + d were 2
        # Concave and falling, and not above the level here: Newton's steps never pass the answer.
        for _ in range(_STEPS):
            d = np.exp(t)
            excess = own * t + other * np.log(2.0 + d) - level
            t, before = t - excess / (own + other * d / (2.0 + d)), t
            if np.allclose(t, before, rtol=0.0, atol=1e-15):
                break
        return np.exp(t)

    @staticmethod
    def _within(own: Any, other: Any, level: Any) -> NDArray[np.float64]:
        """Largest d with own·log d + other·log(2 - d) >= level, not beyond the least of that sum."""
        high = np.log(-2.0 * own)
        low = np.minimum((level - other * np.log(2.0)) / own, high)  # as if 2 - d were 2
        # Convex and falling from the left of the answer on: Newton's steps never pass it.
        t = low
        for _ in range(_STEPS):
            d = np.exp(t)
            excess = own * t + other * np.log(2.0 - d) - level
            slope = np.minimum(own - other * d / (2.0 - d), -np.finfo(float).tiny)
            with np.errstate(over="ignore"):
                moved = np.where(excess > 0.0, np.minimum(t - excess / slope, high), t)
            if np.array_equal(moved, t):
                break
            t = moved
        return np.exp(t)


#: Places whose pressure is evaluated at once, over those whose integrals are.
_BLOCKS = 8

#: |z| from which powers of 1/z serve, and their number: 3^-36 is below rounding.
_FAR, _POWERS = 3.0, 36


@dataclass(frozen=True)
class Weighted(Pressure):
    """σ_YY = (1 - s)^α (1 + s)^β (A + B s) over N/(2a); all broadcast against positions.

    Attributes:
        α, β: exponents at the right and the left end; their sum is ``order``.
        A, B: coefficients, dimensionless.
        order: -1, 0 or 1, the same for all states.
    """

    α: Any
    β: Any
    A: Any
    B: Any
    order: int

    def series(self, r: NDArray) -> NDArray[np.float64]:
        return self.A + self.B * r

    def hilbert(self, r: ArrayLike) -> NDArray[np.float64]:
        """(1/π) ⨍ σ_YY(t)/(t - r) dt on the whole surface off the ends."""
        r = np.asarray(r, dtype=float)
        with np.errstate(invalid="ignore", divide="ignore"):
            size = np.abs(1.0 - r) ** self.α * np.abs(1.0 + r) ** self.β * (self.A + self.B * r)
            sign = np.where(under_punch(r), np.cos(np.pi * self.α), 1.0)
            # Left of the contact both factors of X are negative: (-1)^(α + β).
            sign = np.where(r < -1.0, (-1.0) ** self.order, sign)
            near = (sign * size - self._polynomial(r)) / self._sin
        return np.where(np.abs(r) > _FAR, self._far(np.where(np.abs(r) > _FAR, r, np.inf)), near)

    def largest(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        if not self.finite:
            return super().largest()
        place = np.ravel((self.β - self.α) / (self.β + self.α))  # of a parabola: B vanishes
        return -self.σ_YY(place[:, None])[:, 0], place

    def at(self, z: NDArray) -> NDArray[np.complex128]:
        """Φ(z), see :class:`galinx.solvers.solids.half_plane.Potential`."""
        far = np.abs(z) > _FAR
        X = np.exp(self.α * np.log(z - 1.0) + self.β * np.log(z + 1.0))
        Φ = (X * (self.A + self.B * z) - self._polynomial(z)) / self._sin
        columns = far.any(axis=tuple(range(z.ndim - 1)))
        if columns.any():
            Φ[..., columns] = np.where(far[..., columns], self._far(z[..., columns]), Φ[..., columns])
        return Φ

    @property
    def _sin(self) -> Any:
        return np.sin(np.pi * self.α)

    def _polynomial(self, z: Any) -> Any:
        """Polynomial [X q] at z; B vanishes where the order is 0 or 1."""
        if self.order == 1:
            return self.A * (z + self.β - self.α)
        return self.A if self.order == 0 else self.B

    @cached_property
    def _powers(self) -> list[Any]:
        """Coefficients of z^-1, z^-2, … of Φ, from those of (1 - y)^α (1 + y)^β, y = 1/z."""
        lean, total = self.β - self.α, self.order
        e = [1.0 + 0.0 * lean, lean]
        for k in range(1, _POWERS + 2):
            e.append((lean * e[k] + (k - 1 - total) * e[k - 1]) / (k + 1))
        # X q = Σ e_k z^(order - k) (A + B z)
        return [
            (self.A * e[j + total] + self.B * e[j + total + 1]) / self._sin for j in range(1, _POWERS)
        ]

    def _far(self, z: NDArray) -> Any:
        y, total = 1.0 / z, 0.0
        for coefficient in reversed(self._powers):
            total = (total + coefficient) * y
        return total


#: Distance from a cusp of the pressure that counts as none, and that from which it is extrapolated.
_AT_CUSP, _BESIDE_CUSP = 1e-12, 1e-7


@dataclass(frozen=True)
class FreeEnds(Pressure):
    """Pressure of a contact [-1, 1] with two free ends, over N/(2h).

    Attributes:
        panels: quadrature over the contact.
        f: μ v,X under the punch over N/(2h) at the panels' points, with ∫ f/w = 0.
        slope: function that gives μ v,X over N/(2h) at any positions in the contact.
        n, Q: n + g n₁₂ and g q of the half-plane.
        kinks, tips: see :class:`galinx.solvers.contact.pressure.Pressure`.
        cusp: exponent below 1 of the pressure's change by the distance from a kink; 0 for none.
    """

    panels: Panels
    f: NDArray[np.float64]
    slope: Any
    n: float
    Q: float
    kinks: Sequence[float] = ()
    tips: Sequence[float] = ()
    cusp: float = 0.0

    K_I = np.zeros(2)  # type: ignore[assignment]

    @property
    def α(self) -> float:  # type: ignore[override]
        """Exponent at the right end, positive."""
        return -self.panels.α

    @property
    def β(self) -> float:  # type: ignore[override]
        """Exponent at the left end, positive."""
        return -self.panels.β

    @property
    def _factor(self) -> float:
        return float(np.sin(np.pi * self.α) / (np.pi * self.n))

    def series(self, r: NDArray) -> NDArray[np.float64]:
        p, inside = np.zeros(np.shape(r)), np.abs(r) < 1.0
        at = r[inside]
        f = self.slope(at)
        # Without f(r) nothing cancels towards the ends.
        C, y = np.empty(len(at)), stretched(at)
        for rows in self.panels.blocks(len(at), _BLOCKS):
            C[rows] = self.panels.cauchy(self.f - f[rows, None], y[rows])
        stress = -self._factor * np.sin(np.pi * self.α) * C
        for kink in self.kinks if self.cusp else ():
            at_cusp = np.abs(at - kink) < _AT_CUSP
            if at_cusp.any():  # the part of the smallest panel that is missed there is not small
                stress[at_cusp] = self._at_cusp(kink)
        p[inside] = stress * (1.0 - at) ** -self.α * (1.0 + at) ** -self.β
        return p

    def _at_cusp(self, at: float) -> float:
        """Contact stress at a cusp: σ + C d^exponent extrapolated to d = 0, the mean of both sides."""
        d = _BESIDE_CUSP * np.array([-1.0, 1.0])
        near, far = (float(self.σ_YY(at + step).mean()) for step in (d, 2.0 * d))
        return near + (near - far) / (2.0**self.cusp - 1.0)

    def hilbert(self, r: NDArray) -> NDArray[np.float64]:
        transform, inside, beside = np.empty(r.shape), np.abs(r) < 1.0, np.abs(r) > 1.0
        under, end = r[inside], ~inside & ~beside
        transform[inside] = (self.slope(under) + self.Q * self.σ_YY(under)) / self.n
        transform[end] = self.slope(r[end]) / self.n
        transform[beside] = self.at(r[beside] - 0.0j).real
        return transform

    def at(self, z: NDArray) -> NDArray[np.complex128]:
        """Φ(z), see :class:`galinx.solvers.solids.half_plane.Potential`."""
        flat = np.ravel(z).astype(complex)
        y = np.log((1.0 + flat) / (1.0 - flat))
        C = self.panels.cauchy(self.f, y.real - 1j * (-y.imag % (2.0 * np.pi)))
        return (-self._factor * np.exp(-1j * np.pi * self.α) * C).reshape(np.shape(z))


#: First half-width in the search for the ends [m].
_FIRST = 1e-3


def contacts(response: HalfPlane, g: NDArray, profile: Any, load: Any, checked: bool = True) -> Contacts:
    """Contacts of a punch with free ends.

    Args:
        response: of the half-plane at a speed.
        g: σ_XY/σ_YY under the punch, (states,).
        profile: profile of the punch, with a free end at least.
        load: N/μ [m], a number or one for each state, (states,).
        checked: refuse contacts that are wider than what is known of the punch.

    Raises:
        SolveError: no contact carries the load.
        NoContact: a checked contact reaches beyond what is known of the punch.
    """
    g = np.atleast_1d(np.asarray(g, dtype=float))
    n, load = response.n + g * response.n12, np.broadcast_to(load, g.shape)
    if not np.all(n > 0.0):
        raise SolveError(
            f"at c = {response.c:g} and σ_XY/σ_YY = {g[np.argmin(n)]:g} the surface does not resist a "
            "punch (not below the Rayleigh speed): no contact of finite width carries a load"
        )
    if isinstance(profile, Flat):
        return Contacts(_tilted(response, g, n, profile, load))
    if R := radius(profile):
        return Contacts((_parabolas(response, g, n, R, load),))
    return Contacts(tuple(_by_quadrature(response, g, n, profile, load, checked)))


def _parabolas(response: HalfPlane, g: NDArray, n: NDArray, R: float, load: NDArray) -> Group:
    flat = FlatPunch(response, g)
    a, b = 1.0 + flat.α, 1.0 + flat.β
    h = np.sqrt(load * R * n / (2.0 * np.pi * a * b))
    A = flat._sin / (np.pi * a * b)  # ∫ σ_YY = -2; sin πα is negative
    pressure = Weighted(a[:, None], b[:, None], A[:, None], np.zeros((len(g), 1)), 1)
    return Group(response, np.arange(len(g)), g, pressure, h, h * (b - a))


def _tilted(
    response: HalfPlane, g: NDArray, n: NDArray, profile: Flat, load: NDArray
) -> tuple[Group, ...]:
    """Contacts of a tilted flat punch: both edges in contact, or one lifted off."""
    flat, half, θ = FlatPunch(response, g), profile.half_width, profile.rise
    sin, α, β = flat._sin, flat.α, flat.β
    a, b = 1.0 + α, 1.0 + β
    A, B = 2.0 * sin / np.pi, -θ * sin / n * (2.0 * half / load)
    lifted = (A + 2.0 * a * B > 0.0) | (A - 2.0 * b * B > 0.0)
    order = np.where(lifted, 0, -1)
    # One end is sharp, one free: the contact starts at the lower edge.
    share = a if θ > 0.0 else b
    h = np.where(lifted, load * n / (2.0 * np.pi * share * abs(θ)) if θ else half, half)
    centre = np.where(lifted, profile.middle(h), 0.0)
    α, β = (np.where(lifted, α + (θ > 0.0), α), np.where(lifted, β + (θ < 0.0), β))
    A = np.where(lifted, sin / (np.pi * share), A + B * (flat.α - flat.β))
    B = np.where(lifted, 0.0, B)
    groups = []
    for kind in (-1, 0):
        rows = np.flatnonzero(order == kind)
        if len(rows):
            column = np.s_[rows, None]
            pressure = Weighted(α[column], β[column], A[column], B[column], kind)
            groups.append(Group(response, rows, g[rows], pressure, h[rows], centre[rows]))
    return tuple(groups)


def _by_quadrature(
    response: HalfPlane, g: NDArray, n: NDArray, profile: Any, load: NDArray, checked: bool
) -> Sequence[Group]:
    """Contacts of any convex profile, state after state; equal states are solved once."""
    a, groups = 1.0 + FlatPunch(response, g).α, []
    m, h = None, _FIRST
    _, first, inverse = np.unique(
        np.column_stack([load, g]), axis=0, return_index=True, return_inverse=True
    )
    inverse = inverse.ravel()  # some versions of NumPy keep an axis
    for k, i in enumerate(first.tolist()):
        punch = Punch(profile, 1.0, float(load[i]))
        rule = rule_of_ends(profile, float(a[i]), float(n[i]))
        m, h = free_ends(punch, lambda _: rule, h, m)  # noqa: B023
        if checked:
            check_reach(profile, m - h, m + h)
        pressure = pressure_of(punch, float(a[i]), response, float(g[i]), m, h)
        rows = np.flatnonzero(inverse == k)
        half_width, centre = np.full(len(rows), h), np.full(len(rows), m)
        groups.append(Group(response, rows, g[rows], pressure, half_width, centre))
    return groups


def rule_of_ends(profile: Any, a: float, n: float) -> Rule:
    """Quadrature of the conditions on both ends of a contact on a uniform half-plane.

    Args:
        profile: profile of the punch.
        a: exponent of the pressure at the right end.
        n: n + g n₁₂ of the half-plane.
    """

    def rule(kinks: tuple[float, ...]) -> tuple[NDArray, NDArray, NDArray]:
        panels = panels_of(profile, a, kinks)
        return panels.t, panels.weights, np.sin(np.pi * a) / n * panels.weights * panels.t

    return rule


def pressure_of(punch: Punch, a: float, response: HalfPlane, g: float, m: float, h: float) -> FreeEnds:
    """Pressure of a contact with given ends.

    Args:
        punch: the punch and its load.
        a: exponent of the pressure at the right end.
        response: of the half-plane.
        g: σ_XY/σ_YY under the punch.
        m, h: middle and half-width of the contact.
    """
    places, slope = punch.kinks(m, h), punch.slope(m, h)
    panels, n = panels_of(punch.profile, a, places), response.n + g * response.n12
    tips = places if jumps(punch.profile) else ()
    return FreeEnds(panels, slope(panels.t), slope, n, g * response.q, places, tips, cusp(punch.profile))


def panels_of(profile: Any, a: float, kinks: Sequence[float]) -> Panels:
    """Quadrature over a contact of a punch.

    Args:
        profile: profile of the punch.
        a: exponent of the pressure at the right end.
        kinks: places over the half-width at which the slope or its derivative jumps.
    """
    # Beside its kink a power is not smooth; wedges and parabolas are.
    k = getattr(profile, "exponent", 1.0)
    return panels_of_slope(a, kinks, not jumps(profile) and k != round(k))
