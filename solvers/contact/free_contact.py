"""Contacts with free ends: the ends, and the pressure under the punch.

Both are exact for parabolas and tilted flat punches, and by quadrature for every other convex profile.
Lengths are over the half-width of each contact, from its middle, stresses over N/(2a) of that half-width.

The ends of a contact with two free ends and any convex profile P meet two conditions. With w of
:mod:`galinx.solvers.contact.panels`, s over the half-width h from the middle m of the contact:

    ∫ P'(m + h s)/w ds = 0,        N/μ = h (sin πa/N̂) ∫ s P'(m + h s)/w ds.

:mod:`galinx.solvers.contact.ends` solves them.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import SolveError
from ..profiles import check_reach, cusp, jumps
from ..profiles.flat import Flat
from ..profiles.power import Parabolic
from ..solids.solid import Response
from .closed_form import FlatPunch, Weighted
from .edges import Exponents
from .ends import Punch, Rule, free_ends
from .panels import FreeEnds, Panels, ends_of_panels

#: First half-width in the search for the ends [m].
_FIRST = 1e-3


def panels_of(profile: Any, a: float, kinks: Sequence[float]) -> Panels:
    """Quadrature over a contact of a punch.

    Args:
        profile: profile of the punch.
        a: exponent of the pressure at the right end.
        kinks: places over the half-width at which the slope or its derivative jumps.
    """
    # Beside its kink a power is not smooth; wedges and parabolas are.
    k = getattr(profile, "exponent", 1.0)
    rough = not jumps(profile) and k != round(k)
    return Panels(a, ends_of_panels(np.array(kinks, dtype=float), rough))


#: Positions nearer than this to a place of infinite pressure are taken at this distance, over a.
NEXT_TO_TIP = 1e-6
#: Distance over a from a cusp of the pressure at which it is sampled, on both sides.
_CUSP, _BOTH_SIDES = 1e-5, np.array([-1.0, 1.0])
#: Places at which the pressure is sampled for its largest value, and places about kinks; number of tops
#: that are refined, places between their neighbours, and rounds of refinement.
_SAMPLES = np.sin(np.linspace(-np.pi / 2.0, np.pi / 2.0, 301))[1:-1]
_BESIDE_KINKS = np.concatenate([[0.0], *(sign * np.geomspace(1e-4, 0.1, 10) for sign in (-1.0, 1.0))])
_TOPS, _BETWEEN, _ROUNDS = 5, 21, 8


@dataclass(frozen=True)
class Group:
    """States whose pressure is of one kind.

    Attributes:
        rows: numbers of these states, (rows,).
        pressure: a potential with ``σ_YY`` and ``hilbert``, of all these states or of the only one.
        α, β: exponents at the right and the left end, (rows,).
        half_width, centre: half-width and centre of the contact [m], (rows,).
        K_I: intensities at the left and the right end, (rows, 2).
        infinite: places over the half-width at which the pressure is infinite inside the contact.
        cusps: places over the half-width at which the pressure has a cusp, and the exponent there.
    """

    rows: NDArray[np.int64]
    pressure: Any
    α: NDArray[np.float64]
    β: NDArray[np.float64]
    half_width: NDArray[np.float64]
    centre: NDArray[np.float64]
    K_I: NDArray[np.float64]
    infinite: Sequence[float] = ()
    cusps: tuple[Sequence[float], float] = ((), 0.0)

    def off(self, r: NDArray) -> NDArray[np.float64]:
        """Positions r over the half-width, moved off the places of infinite pressure."""
        for at in self.infinite:
            side = np.where(r < at, -1.0, 1.0)
            r = np.where(np.abs(r - at) < NEXT_TO_TIP, at + side * NEXT_TO_TIP, r)
        return r


@dataclass(frozen=True)
class Contacts:
    """Contacts with free ends at one speed with several frictions.

    Attributes:
        response: of the half-plane at that speed.
        g: σ_XY/σ_YY, (states,).
        groups: all states by the kind of their pressure.
    """

    response: Response
    g: NDArray[np.float64]
    groups: tuple[Group, ...]

    def of(self, name: str) -> NDArray[np.float64]:
        """Attribute of every state by its name: ``α``, ``β``, ``half_width``, ``centre``, ``K_I``."""
        parts = [getattr(group, name) for group in self.groups]
        values = np.empty((len(self.g), *parts[0].shape[1:]))
        for group, part in zip(self.groups, parts):
            values[group.rows] = part
        return values

    def σ_YY(self, r: NDArray) -> NDArray[np.float64]:
        """Contact stress over N/(2a) at r in (-1, 1), off infinite values, (states, points)."""
        stress = np.empty((len(self.g), len(r)))
        for group in self.groups:
            stress[group.rows] = group.pressure.σ_YY(group.off(r))
        return stress

    def alike(self) -> Iterator[tuple[NDArray[np.int64], "Contacts", Sequence[float]]]:
        """Groups of states with one kind of pressure: their numbers, contacts and cusps, one by one."""
        for group in self.groups:
            own = replace(group, rows=np.arange(len(group.rows)))
            yield group.rows, Contacts(self.response, self.g[group.rows], (own,)), group.cusps[0]

    def pressure(self, r: NDArray) -> NDArray[np.float64]:
        """Contact stress σ_YY over N/(2a) at r, also next to infinite values, (states, points)."""
        stress = np.empty((len(self.g), len(r)))
        for group in self.groups:
            stress[group.rows] = group.pressure.σ_YY(r)
        return stress

    def σ_XX(self, r: NDArray) -> NDArray[np.float64]:
        """In-plane stress on the whole surface, off the ends, (states, points)."""
        stress, answer = np.empty((len(self.g), len(r))), self.response
        for group in self.groups:
            at, σ_YY = group.off(r), np.zeros((len(group.rows), len(r)))
            under, g = np.abs(r) < 1.0, self.g[group.rows, None]
            σ_YY[:, under] = group.pressure.σ_YY(at[under])
            u_X = answer.q * σ_YY + (answer.n12 + answer.m * g) * group.pressure.hilbert(at)
            stress[group.rows] = answer.σ_XX(u_X, σ_YY, g * σ_YY)
        return stress

    def inside(self, X: NDArray, Y: NDArray) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY below the surface, at points (n,) or of each state (states, n)."""
        X, Y = np.broadcast_arrays(np.atleast_2d(X), np.atleast_2d(Y))
        stresses = np.empty((3, len(self.g), X.shape[1]))
        for group in self.groups:
            of_each = group.rows if len(X) > 1 else [0]
            g = self.g[group.rows, None]
            stresses[:, group.rows] = self.response.inside(group.pressure, g, X[of_each], Y[of_each])
        return stresses

    def stresses(self, X: NDArray, Y: NDArray) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY over N/(2a) at points with Y <= 0, on the surface, too, (3, states, n)."""
        X, Y = np.broadcast_arrays(np.atleast_2d(X), np.atleast_2d(Y))
        on = np.broadcast_to(Y == 0.0, (len(self.g), X.shape[1]))
        stresses = self.inside(X, np.where(Y == 0.0, -1.0, Y))
        for group in self.groups:
            for row in group.rows[on[group.rows].any(axis=1)].tolist():
                r = X[row if len(X) > 1 else 0, on[row]]
                alone = self._alone(row, group)
                σ_YY = np.zeros((1, len(r)))
                σ_YY[:, np.abs(r) < 1.0] = alone.σ_YY(r[np.abs(r) < 1.0])
                stresses[:, row, on[row]] = np.concatenate([alone.σ_XX(r), σ_YY, self.g[row] * σ_YY])
        return stresses

    @property
    def turns(self) -> NDArray[np.float64]:
        """Free ends and kinks over the half-width, (states, k); NaN for none.

        Stresses are finite there, and go with a power of the distance.
        """
        each: list[list[float]] = [[] for _ in self.g]
        for group in self.groups:
            kinks = [] if len(group.infinite) else list(group.cusps[0])
            for row, α, β in zip(group.rows.tolist(), group.α, group.β):
                each[row] = [-1.0] * bool(β > 0.0) + [1.0] * bool(α > 0.0) + kinks
        positions = np.full((len(each), max(map(len, each))), np.nan)
        for row, places in zip(positions, each):
            row[: len(places)] = places
        return positions

    def _alone(self, row: int, group: Group) -> "Contacts":
        """Contact of one state, whose number is ``row``, of a group."""
        i = int(np.flatnonzero(group.rows == row)[0])
        pressure = group.pressure
        if isinstance(pressure, Weighted):
            α, β, A, B = (
                np.asarray(part)[i : i + 1] for part in (pressure.α, pressure.β, pressure.A, pressure.B)
            )
            pressure = Weighted(α, β, A, B, pressure.order)
        rows = slice(i, i + 1)
        alone = Group(
            np.array([0]), pressure, group.α[rows], group.β[rows], group.half_width[rows],
            group.centre[rows], group.K_I[rows], group.infinite, group.cusps,
        )  # fmt: skip
        return Contacts(self.response, self.g[row : row + 1], (alone,))

    def largest(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Largest contact pressure over N/(2a), and its place; NaN if infinite: (states,) each."""
        value, place = np.full((2, len(self.g)), np.nan)
        for group in self.groups:
            finite = (group.α > 0.0) & (group.β > 0.0) & (not group.infinite)
            if finite.all():
                value[group.rows], place[group.rows] = _largest(group)
        return value, place


def _largest(group: Group) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Largest pressure of each state of a group and its place over the half-width, (rows,) each."""
    if isinstance(group.pressure, Weighted):
        place = (group.β - group.α) / (group.β + group.α)
        return -group.pressure.σ_YY(place[:, None])[:, 0], place
    top, at = largest(lambda r: -group.pressure.σ_YY(group.off(r)), group.cusps)
    return np.array([top]), np.array([at])


def largest(
    pressure: Callable[[NDArray], NDArray], cusps: tuple[Sequence[float], float] = ((), 0.0)
) -> tuple[float, float]:
    """Largest pressure under a punch and its place, by ever finer samples about several tops.

    Args:
        pressure: at r in (-1, 1), (points,).
        cusps: places of its cusps, and the exponent there; 0 where the cusp is d log d.
    """
    places, exponent = cusps
    beside = np.ravel(np.add.outer(np.array(places, dtype=float), _BESIDE_KINKS))
    r = np.unique(np.concatenate([_SAMPLES, beside[np.abs(beside) < 1.0]]))
    p = pressure(r)
    tops = 1 + np.flatnonzero((p[1:-1] >= p[:-2]) & (p[1:-1] >= p[2:]))
    tops = tops[np.argsort(-p[tops], kind="stable")][:_TOPS]
    maxima = [_nearer(pressure, r[i - 1], r[i + 1], places) for i in tops.tolist()]
    if exponent:  # which no grid meets: p(d) = p(0) + C d^exponent, the mean of both sides
        for at in places:
            near, far = (float(pressure(at + d * _BOTH_SIDES).mean()) for d in (_CUSP, 2.0 * _CUSP))
            maxima.append((near + (near - far) / (2.0**exponent - 1.0), float(at)))
    return max(maxima)


def _nearer(
    pressure: Callable[[NDArray], NDArray], low: float, high: float, kinks: Sequence[float]
) -> tuple[float, float]:
    """Largest pressure between two places, and its place; by a parabola at last, if there is no kink."""
    for _ in range(_ROUNDS):
        r = np.linspace(low, high, _BETWEEN)
        p = pressure(r)
        i = int(np.clip(np.argmax(p), 1, len(r) - 2))
        step = r[1] - r[0]
        low, high = r[i] - step, r[i] + step
        if step < 1e-6:  # next to a kink the largest pressure may have a cusp
            break
    if any(low <= at <= high for at in kinks):
        return float(p.max()), float(r[p.argmax()])
    p_left, p_middle, p_right = p[i - 1 : i + 2]
    bend = p_left - 2.0 * p_middle + p_right
    u = float(np.clip((p_left - p_right) / (2.0 * bend), -1.0, 1.0)) if bend < 0.0 else 0.0
    top = p_middle + (p_right - p_left) * u / 2.0 + bend * u**2 / 2.0
    return max((float(p.max()), float(r[p.argmax()])), (float(top), float(r[i] + u * step)))


def local_exponents(response: Response, g: NDArray, profile: Any, load: Any) -> Exponents | FlatPunch:
    """Exponents by the local analysis: those of a flat punch at sharp ends, one more at free ends."""
    flat, sharp = FlatPunch(response, g), getattr(profile, "sharp", (True, True))
    if all(sharp):
        return flat
    try:
        exact = contacts(response, g, profile, load) if isinstance(profile, Flat) else None
    except SolveError:
        exact = None  # the method that solves reports it
    if exact:
        return Exponents(exact.of("α"), exact.of("β"))
    return Exponents(flat.α + (not sharp[1]), flat.β + (not sharp[0]))


def contacts(response: Response, g: NDArray, profile: Any, load: Any) -> Contacts:
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
        return Contacts(response, g, _tilted(response, g, n, profile, load))
    if isinstance(profile, Parabolic):
        return Contacts(response, g, (_parabolas(response, g, n, profile, load),))
    return Contacts(response, g, tuple(_by_quadrature(response, g, n, profile, load)))


def _parabolas(response: Response, g: NDArray, n: NDArray, profile: Parabolic, load: NDArray) -> Group:
    flat = FlatPunch(response, g)
    a, b = 1.0 + flat.α, 1.0 + flat.β
    h = np.sqrt(load * profile.radius * n / (2.0 * np.pi * a * b))
    A = flat._sin / (np.pi * a * b)  # ∫ σ_YY = -2; sin πα is negative
    pressure = Weighted(a[:, None], b[:, None], A[:, None], np.zeros((len(g), 1)), 1)
    return Group(np.arange(len(g)), pressure, a, b, h, h * (b - a), np.zeros((len(g), 2)))


def _tilted(
    response: Response, g: NDArray, n: NDArray, profile: Flat, load: NDArray
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
            K = pressure.K_I[:, 0]
            groups.append(Group(rows, pressure, α[rows], β[rows], h[rows], centre[rows], K))
    return tuple(groups)


def _by_quadrature(
    response: Response, g: NDArray, n: NDArray, profile: Any, load: NDArray
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
        pressure, tips = pressure_of(punch, float(a[i]), response, float(g[i]), m, h)
        for row in np.flatnonzero(inverse == k).tolist():
            group = Group(
                np.array([row]), pressure, a[[i]], 1.0 - a[[i]], np.array([h]), np.array([m]),
                np.zeros((1, 2)), tips, pressure.cusps,
            )  # fmt: skip
            groups.append(group)
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


def pressure_of(
    punch: Punch, a: float, response: Response, g: float, m: float, h: float
) -> tuple[FreeEnds, tuple[float, ...]]:
    """Pressure of a contact with given ends, and the places over h of infinite pressure inside.

    Args:
        punch: the punch and its load.
        a: exponent of the pressure at the right end.
        response: of the half-plane.
        g: σ_XY/σ_YY under the punch.
        m, h: middle and half-width of the contact.
    """
    places, slope = punch.kinks(m, h), punch.slope(m, h)
    panels, n = panels_of(punch.profile, a, places), response.n + g * response.n12
    cusps = places, cusp(punch.profile)
    tips = places if jumps(punch.profile) else ()
    return FreeEnds(panels, slope(panels.t), slope, n, g * response.q, cusps), tips
