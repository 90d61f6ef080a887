"""Contacts with free ends: the ends, and the pressure under the punch.

Both are exact for parabolas and tilted flat punches, and by quadrature for every other convex profile.
Lengths are over the half-width of each contact, from its middle, stresses over N/(2a) of that half-width.

The ends of a contact with two free ends and any convex profile P meet two conditions. With w of
:mod:`galinx.solvers.contact.panels`, s over the half-width h from the middle m of the contact:

    ∫ P'(m + h s)/w ds = 0,        N/μ = h (sin πa/N̂) ∫ s P'(m + h s)/w ds.

Newton's method solves them for m/h and log h; a step that increases the residual is halved.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import SolveError
from ..profiles import check_reach, cusp, jumps, kinks
from ..profiles.flat import Flat
from ..profiles.power import Parabolic
from ..solids.solid import Response
from .closed_form import FlatPunch, Weighted
from .edges import Exponents
from .panels import FreeEnds, Panels, ends_of_panels

#: Steps at most, halvings of a step at most, and rounding in a residual.
_STEPS, _HALVINGS, _ROUNDING = 60, 40, 1e-14
#: Step for the derivatives; largest change of m/h and of log h in a step.
_ε, _LARGEST = 1e-6, (0.5, 1.5)
#: Doublings at most of the half-width in the search for the load, and of the centre over it.
_DOUBLINGS, _FARTHER = 60, 12
#: Logarithm of the load carried over the given load below which Newton's method starts.
_ROUGHLY = 3.0


@dataclass(frozen=True)
class Balance:
    """Both conditions of a contact with two free ends.

    Attributes:
        profile: profile of the punch.
        a: exponent of the pressure at the right end.
        size: N N̂/(μ sin πa) [m].
    """

    profile: Any
    a: float
    size: float

    def panels(self, centre: float, half_width: float) -> Panels:
        """Quadrature over a contact, lengths in m."""
        at = (np.array(kinks(self.profile), dtype=float) - centre) / half_width
        # Beside its kink a power is not smooth; wedges and parabolas are.
        k = getattr(self.profile, "exponent", 1.0)
        return Panels(self.a, ends_of_panels(at, rough=not jumps(self.profile) and k != round(k)))

    def slope(self, panels: Panels, centre: float, half_width: float) -> NDArray[np.float64]:
        """Slope P' of the profile at the panels' points, (points,)."""
        return np.asarray(self.profile.slope(centre + half_width * panels.t), dtype=float)

    def residual(self, lean: float, size: float) -> NDArray[np.float64]:
        """Residuals of both conditions, (2,), infinite if the contact carries no load.

        Args:
            lean: centre over half-width, m/h.
            size: log h, h in m.
        """
        h = float(np.exp(size))
        panels = self.panels(lean * h, h)
        slope = self.slope(panels, lean * h, h)
        whole = panels.weights @ np.abs(slope)
        lifted, carried = panels.weights @ slope, h * (panels.weights @ (panels.t * slope))
        if not (whole > 0.0 and carried > 0.0):
            return np.array([np.inf, np.inf])
        return np.array([lifted / whole, np.log(carried / self.size)])


def free_ends(balance: Balance, start: tuple[float, float] | None = None) -> tuple[float, float]:
    """Centre and half-width [m] of a contact with two free ends.

    Args:
        balance: conditions of the ends.
        start: centre and half-width [m] of a contact near by.

    Raises:
        SolveError: the ends were not found; the message says what was tried.
    """
    point = np.array([start[0] / start[1], np.log(start[1])]) if start else _first(balance)
    value, residuals = balance.residual(*point), []
    for _ in range(_STEPS):
        size = float(np.abs(value).max())
        residuals.append(size)
        if size <= _ROUNDING:
            break
        step = _newton(balance.residual, point, value)
        for halving in range(_HALVINGS):
            moved = point + 0.5**halving * step
            trial = balance.residual(*moved)
            if np.abs(trial).max() < size:
                break
        else:
            break  # nothing better is near: rounding, or no contact
        point, value = moved, trial
    if not residuals[-1] <= 1e3 * _ROUNDING:
        raise SolveError(
            f"the ends of the contact of a {balance.profile.words()} were not found: after "
            f"{len(residuals)} steps the conditions are off by {residuals[-1]:.3g}, wanted "
            f"{_ROUNDING:g}; centre over half-width {point[0]:.6g}, half-width "
            f"{np.exp(point[1]):.6g} m; the residuals were "
            + ", ".join(f"{size:.2g}" for size in residuals[-6:])
        )
    h = float(np.exp(point[1]))
    return float(point[0]) * h, h


def _newton(residual: Callable[..., NDArray], point: NDArray, value: NDArray) -> NDArray[np.float64]:
    """Newton's step for m/h and log h, (2,), within limits; derivatives by differences."""
    steps = np.diag([_ε, _ε])
    J = np.column_stack([(residual(*(point + d)) - residual(*(point - d))) / (2.0 * _ε) for d in steps])
    if not np.all(np.isfinite(J)) or np.linalg.matrix_rank(J) < 2:
        return np.array([-np.sign(value[0]) * 0.1, 0.1])
    step = np.linalg.solve(J, -value)
    return step / max(1.0, *(np.abs(step) / _LARGEST))


def _first(balance: Balance) -> NDArray[np.float64]:
    """Start of Newton's method: m/h and log h, (2,), of a contact that carries about the load."""
    size = float(np.log(1e-3))
    narrow, wide = -np.inf, np.inf
    for _ in range(_DOUBLINGS):
        lean = _lean(balance, size)
        carried = balance.residual(lean, size)[1]
        # Infinite: in a flat part, which carries nothing unless the contact is wider.
        if not np.isfinite(carried) or carried < 0.0:
            narrow = size
        else:
            wide = size
        bracketed = np.isfinite(narrow) and np.isfinite(wide)
        if bracketed and np.isfinite(carried) and abs(carried) < _ROUGHLY:
            return np.array([lean, size])
        if bracketed:
            size = (narrow + wide) / 2.0
        else:
            size += np.log(2.0) if np.isfinite(narrow) else -np.log(2.0)
    raise SolveError(
        f"no contact of a {balance.profile.words()} carries the load: half-widths up to "
        f"{np.exp(size):.3g} m were tried; the profile has to be convex"
    )


def _lean(balance: Balance, size: float) -> float:
    """Approximate m/h at which ∫ P'/w vanishes at a given log h; by halving."""
    h, far = float(np.exp(size)), 1.0

    def pulled(lean: float) -> float:
        panels = balance.panels(lean * h, h)
        return float(panels.weights @ balance.slope(panels, lean * h, h))

    for _ in range(_FARTHER):
        if pulled(-far) <= 0.0 <= pulled(far):
            break
        far *= 2.0
    # If a flat part holds all of the contact, the integral vanishes on an interval: its middle is taken.
    edges = []
    for beyond in (np.less, np.less_equal):
        low, high = -far, far
        for _ in range(12 + int(np.log2(far))):
            middle = (low + high) / 2.0
            low, high = (middle, high) if beyond(pulled(middle), 0.0) else (low, middle)
        edges.append((low + high) / 2.0)
    return float(np.mean(edges))


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
    flat, groups, start = FlatPunch(response, g), [], None
    _, first, inverse = np.unique(
        np.column_stack([load, g]), axis=0, return_index=True, return_inverse=True
    )
    inverse = inverse.ravel()  # some versions of NumPy keep an axis
    for k, i in enumerate(first.tolist()):
        a, N = float(1.0 + flat.α[i]), float(load[i])
        balance = Balance(profile, a, N * float(n[i]) / np.sin(np.pi * a))
        m, h = start = free_ends(balance, start)
        check_reach(profile, m - h, m + h)
        pressure, tips = pressure_of(balance, response, float(g[i]), m, h, N)
        for row in np.flatnonzero(inverse == k).tolist():
            group = Group(
                np.array([row]), pressure, np.array([a]), np.array([1.0 - a]), np.array([h]),
                np.array([m]), np.zeros((1, 2)), tips, pressure.cusps,
            )  # fmt: skip
            groups.append(group)
    return groups


def pressure_of(
    balance: Balance, response: Response, g: float, m: float, h: float, load: float
) -> tuple[FreeEnds, tuple[float, ...]]:
    """Pressure of a contact with given ends, and the places over h of infinite pressure inside.

    Args:
        balance: conditions of the ends.
        response: of the half-plane.
        g: σ_XY/σ_YY under the punch.
        m, h: middle and half-width of the contact [m].
        load: N/μ [m].
    """
    panels, profile = balance.panels(m, h), balance.profile
    unit = 2.0 * h / load

    def slope(r: NDArray) -> NDArray[np.float64]:
        return unit * np.asarray(profile.slope(m + h * r), dtype=float)

    cusps = [(x - m) / h for x in kinks(profile) if abs(x - m) < h], cusp(profile)
    pressure = FreeEnds(
        panels, slope(panels.t), slope, response.n + g * response.n12, g * response.q, cusps
    )
    tips = tuple((x - m) / h for x in kinks(profile)) if jumps(profile) else ()
    return pressure, tips
