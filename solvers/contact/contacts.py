"""Contacts on uniform half-planes: states with a pressure, a half-width and a middle, and their stresses.

What differs between contacts is the pressure. It is exact under flat punches, tilted ones among them, and
parabolas, and where it is prescribed; by quadrature under every other convex profile with free ends; and
by the integral equation under a profile between two sharp edges. Lengths are over the half-width of each
contact, from its middle, stresses over N/(2a) of that half-width.

The ends of a contact with two free ends and any convex profile P meet two conditions. With w of
:mod:`galinx.solvers.contact.panels`, s over the half-width h from the middle m of the contact:

    ∫ P'(m + h s)/w ds = 0,        N/μ = h (sin πa/N̂) ∫ s P'(m + h s)/w ds.

:mod:`galinx.solvers.contact.ends` solves them.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import SolveError
from ..profiles import check_reach, cusp, jumps
from ..profiles.punches import Flat, Parabolic
from ..solids.half_plane import HalfPlane
from .closed_form import FlatPunch, FreeEnds, Weighted
from .ends import Punch, Rule, free_ends
from .panels import Panels, panels_of_slope
from .pressure import Pressure

#: Positions nearer than this to a place of infinite pressure are taken at this distance, over a.
NEXT_TO_TIP = 1e-6
#: Jacobi polynomials under a punch that is not flat: smooth profiles need a dozen for the last digits.
_TERMS = 40
#: First half-width in the search for the ends [m].
_FIRST = 1e-3


@dataclass(frozen=True)
class Group:
    """States at one speed whose pressure is of one kind, and their stresses.

    Attributes:
        response: of the half-plane at that speed.
        rows: numbers of these states, (rows,).
        g: σ_XY/σ_YY, (rows,).
        pressure: pressure of all these states or of the only one.
        half_width, centre: half-width and centre of the contact [m], (rows,).
    """

    response: HalfPlane
    rows: NDArray[np.int64]
    g: NDArray[np.float64]
    pressure: Any
    half_width: NDArray[np.float64]
    centre: NDArray[np.float64]

    @property
    def K_I(self) -> NDArray[np.float64]:
        """Intensities at the left and the right end, (rows, 2)."""
        return np.broadcast_to(self.pressure.K_I, (len(self.rows), 2))

    @property
    def free(self) -> NDArray[np.bool_]:
        """True where the left and the right end are free, (rows, 2)."""
        return np.broadcast_to(self.pressure.free, (len(self.rows), 2))

    @property
    def α(self) -> NDArray[np.float64]:
        """Exponent of the pressure at the right end, (rows,)."""
        return np.broadcast_to(np.ravel(self.pressure.α), self.rows.shape)

    @property
    def β(self) -> NDArray[np.float64]:
        """Exponent of the pressure at the left end, (rows,)."""
        return np.broadcast_to(np.ravel(self.pressure.β), self.rows.shape)

    def contact_stress(self, r: NDArray) -> NDArray[np.float64]:
        """σ_YY over N/(2a) at r in (-1, 1), also next to infinite values, (rows, points)."""
        stress = self.pressure.σ_YY(r)
        return np.broadcast_to(stress, (len(self.rows), stress.shape[-1]))

    def surface(self, r: NDArray) -> NDArray[np.float64]:
        """σ_XX and σ_YY, 0 beside the contact, at r off the ends, (points,) or (rows, points).

        The result is (2, rows, points).
        """
        r = off_tips(r, self.pressure.tips)
        σ_YY = np.where(np.abs(r) < 1.0, self.pressure.σ_YY(r), 0.0)
        ratio, H, C = self.pressure.transforms(self.g[:, None], r)
        σ_XX = self.response.in_plane(ratio, σ_YY, H, self.response.m * C + self.strain(r))
        return np.array([σ_XX, np.broadcast_to(σ_YY, σ_XX.shape)])

    def strain(self, r: NDArray) -> Any:
        """Strain μ u,X over N/(2a) that layers add on the surface at r, (rows, points)."""
        return 0.0

    def inside(self, X: NDArray, Y: NDArray) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY at points (1, n) or (rows, n) below the surface: (3, rows, n)."""
        return self.pressure.inside(self.response, self.g[:, None], X, Y)

    def stresses(self, X: NDArray, Y: NDArray) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY at points (1, n) or (rows, n), on the surface, too: (3, rows, n)."""
        on = Y == 0.0
        σ = self.inside(X, np.where(on, -1.0, Y))
        columns = on.any(axis=0)
        if columns.any():
            σ_XX, σ_YY = self.surface(X[:, columns])
            g, ratios = self.pressure.ratios(self.g, X[:, columns])
            on_surface = [σ_XX, σ_YY, g[:, None] * ratios * σ_YY]
            σ[..., columns] = np.where(on[:, columns], on_surface, σ[..., columns])
        return σ


def off_tips(r: NDArray, tips: Sequence[float]) -> NDArray[np.float64]:
    """Positions r over the half-width, moved off tips, where the pressure is infinite."""
    for tip in tips:
        side = np.where(r < tip, -1.0, 1.0)
        r = np.where(np.abs(r - tip) < NEXT_TO_TIP, tip + side * NEXT_TO_TIP, r)
    return r


@dataclass(frozen=True)
class Contacts:
    """Contacts at one speed with several frictions.

    Attributes:
        groups: all states by the kind of their pressure.
    """

    groups: tuple[Group, ...]

    def of(self, name: str) -> NDArray[np.float64]:
        """Attribute of every state by its name, as ``α``, ``free``, ``half_width``, ``K_I``."""
        return self.joined(lambda group: getattr(group, name))

    def joined(self, values: Callable[[Any], NDArray], axis: int = 0) -> NDArray[np.float64]:
        """Values of all states from those of every group, along an axis of states."""
        if len(self.groups) == 1:
            return values(self.groups[0])
        each = np.concatenate([values(group) for group in self.groups], axis=axis)
        return each.take(self.order, axis)

    @cached_property
    def order(self) -> NDArray[np.int64]:
        """Number of each state among those of all groups, one group after the other, (states,)."""
        return np.argsort(np.concatenate([group.rows for group in self.groups]))

    @property
    def in_punch(self) -> "Contacts":
        """The same pressures on the half-plane of an elastic punch, mirrored at Y = 0.

        There σ_XY has the other sign, and so has the friction.
        """
        return Contacts(
            tuple(replace(of, response=of.response.punch, g=-of.g) for of in self.groups)  # type: ignore[attr-defined]
        )

    def on_surface(self, r: NDArray) -> NDArray[np.float64]:
        """σ_XX and σ_YY, 0 beside the contact, on the surface off the ends, (2, states, points)."""
        return self.joined(lambda group: group.surface(r), 1)

    def stresses(self, X: NDArray, Y: NDArray) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY over N/(2a), (3, states, n), at points with Y <= 0, on the surface, too.

        Points are (n,), or of each state (states, n).
        """
        X, Y = np.broadcast_arrays(np.atleast_2d(X), np.atleast_2d(Y))
        return self.joined(
            lambda group: group.stresses(*(x[group.rows] if len(x) > 1 else x for x in (X, Y))), 1
        )

    def largest(self) -> NDArray[np.float64]:
        """Largest contact pressure over N/(2a), and its place; NaN if infinite: (2, states)."""
        return self.joined(
            lambda group: np.broadcast_to(group.pressure.largest(), (2, len(group.rows))), 1
        )


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


def between_edges(body: Any, response: HalfPlane, g: NDArray) -> Contacts:
    """Contacts between two sharp corners of a punch.

    Args:
        body: see :class:`galinx.solvers.contact.solution.SharpContact`.
        response: of the half-plane at a speed.
        g: σ_XY/σ_YY, (states,).
    """
    if body.flat:
        return between_given_ends(body, response, g, [FlatPunch(response, g[:, None])])
    from .equation import UNIFORM, Equation  # SciPy's special functions, a slow import

    loads = np.broadcast_to(body.load, g.shape).tolist()
    each = [
        Equation(response, UNIFORM, value, body.loaded(load).slope).pressure(_TERMS)
        for value, load in zip(g.tolist(), loads)
    ]
    return between_given_ends(body, response, g, each)


def between_given_ends(
    body: Any, response: HalfPlane, g: NDArray, pressures: Sequence[Pressure]
) -> Contacts:
    """Contacts from -a to a of given pressures.

    Args:
        body, response, g: as in :func:`between_edges`.
        pressures: one for all states, or one for each.
    """
    groups = []
    for rows, pressure in zip(np.array_split(np.arange(len(g)), len(pressures)), pressures):
        half_width = np.full(len(rows), body.half_width)
        groups.append(Group(response, rows, g[rows], pressure, half_width, np.zeros(len(rows))))
    return Contacts(tuple(groups))


def contacts(response: HalfPlane, g: NDArray, profile: Any, load: Any) -> Contacts:
    """Contacts of a punch with free ends.

    Args:
        response: of the half-plane at a speed.
        g: σ_XY/σ_YY under the punch, (states,).
        profile: profile of the punch, with a free end at least.
        load: N/μ [m], a number or one for each state, (states,).

    Raises:
        SolveError: no contact carries the load, or the contact reaches beyond what is known of the punch.
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
    if isinstance(profile, Parabolic):
        return Contacts((_parabolas(response, g, n, profile, load),))
    return Contacts(tuple(_by_quadrature(response, g, n, profile, load)))


def _parabolas(response: HalfPlane, g: NDArray, n: NDArray, profile: Parabolic, load: NDArray) -> Group:
    flat = FlatPunch(response, g)
    a, b = 1.0 + flat.α, 1.0 + flat.β
    h = np.sqrt(load * profile.radius * n / (2.0 * np.pi * a * b))
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
    centre = np.where(lifted, np.sign(θ) * (h - half), 0.0)
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
    response: HalfPlane, g: NDArray, n: NDArray, profile: Any, load: NDArray
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
