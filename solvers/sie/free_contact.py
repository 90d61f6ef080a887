"""Contacts whose ends are found: where they end, and the pressure under the punch.

Exact for parabolas and tilted flat punches, by quadrature for every other convex profile. Lengths are
over the half-width of each contact, from its middle, stresses over N/(2a) of that half-width.

Where a contact with two free ends ends, for any convex profile.

With w of :mod:`galinx.solvers.sie.panels`, s over the half-width h from the middle m of the contact:

    ∫ P'(m + h s)/w ds = 0,        N/μ = h (sin πa/N̂) ∫ s P'(m + h s)/w ds.

Newton's method finds m/h and log h; a step that makes it worse is halved.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import SolveError
from ..profiles import check_reach, cusp, jumps, kinks
from ..profiles.flat import Flat
from ..profiles.parabolic import Parabolic
from ..solids.solid import Response
from .closed_form import FlatPunch, Weighted
from .panels import FreeEnds, Panels, ends_of_panels

#: Most steps, most halvings of one, and what of a residual is rounding.
_STEPS, _HALVINGS, _ROUNDING = 60, 40, 1e-14
#: Step for the derivatives; largest change of m/h and of log h in a step.
_ε, _LARGEST = 1e-6, (0.5, 1.5)
#: Doublings of the half-width within which a load is looked for, and of the centre over it.
_DOUBLINGS, _FARTHER = 60, 12
#: Logarithm of the load carried over that wanted from which Newton's method serves.
_ROUGHLY = 3.0


@dataclass(frozen=True)
class Balance:
    """Both conditions of a contact with free ends.

    Attributes:
        profile: of the punch.
        a: exponent of the pressure at the right end.
        size: N N̂/(μ sin πa) [m].
    """

    profile: Any
    a: float
    size: float

    def panels(self, centre: float, half_width: float) -> Panels:
        """Quadrature over a contact, lengths in m."""
        at = (np.array(kinks(self.profile), dtype=float) - centre) / half_width
        # A power is no smooth function on either side of its kink; jumps and parabolas are.
        k = getattr(self.profile, "exponent", 1.0)
        return Panels(self.a, ends_of_panels(at, rough=not jumps(self.profile) and k != round(k)))

    def slope(self, panels: Panels, centre: float, half_width: float) -> NDArray[np.float64]:
        """P' at the panels' points."""
        return np.asarray(self.profile.slope(centre + half_width * panels.t), dtype=float)

    def residual(self, lean: float, size: float) -> NDArray[np.float64]:
        """Both conditions at m/h and log h, 0 where they are met, (2,); infinite without any load."""
        h = float(np.exp(size))
        panels = self.panels(lean * h, h)
        slope = self.slope(panels, lean * h, h)
        whole = panels.weights @ np.abs(slope)
        lifted, carried = panels.weights @ slope, h * (panels.weights @ (panels.t * slope))
        if not (whole > 0.0 and carried > 0.0):
            return np.array([np.inf, np.inf])
        return np.array([lifted / whole, np.log(carried / self.size)])


def free_ends(balance: Balance, start: tuple[float, float] | None = None) -> tuple[float, float]:
    """Centre and half-width [m] of the contact.

    Args:
        balance: what has to hold.
        start: centre and half-width near by.

    Raises:
        SolveError: it was not found; the message says what was tried.
    """
    point = np.array([start[0] / start[1], np.log(start[1])]) if start else _first(balance)
    value, told = balance.residual(*point), []
    for _ in range(_STEPS):
        size = float(np.abs(value).max())
        told.append(size)
        if size <= _ROUNDING:
            break
        step = _newton(balance.residual, point, value)
        for halving in range(_HALVINGS):
            moved = point + 0.5**halving * step
            found = balance.residual(*moved)
            if np.abs(found).max() < size:
                break
        else:
            break  # nothing better is near: rounding, or no contact
        point, value = moved, found
    if not told[-1] <= 1e3 * _ROUNDING:
        raise SolveError(
            f"the ends of the contact of a {balance.profile.words()} were not found: after {len(told)} "
            f"steps the conditions are off by {told[-1]:.3g}, wanted {_ROUNDING:g}; centre over "
            f"half-width {point[0]:.6g}, half-width {np.exp(point[1]):.6g} m; the residuals were "
            + ", ".join(f"{size:.2g}" for size in told[-6:])
        )
    h = float(np.exp(point[1]))
    return float(point[0]) * h, h


def _newton(residual: Callable[..., NDArray], point: NDArray, value: NDArray) -> NDArray[np.float64]:
    """Newton's step, within limits; derivatives by differences."""
    steps = np.diag([_ε, _ε])
    J = np.column_stack([(residual(*(point + d)) - residual(*(point - d))) / (2.0 * _ε) for d in steps])
    if not np.all(np.isfinite(J)) or np.linalg.matrix_rank(J) < 2:
        return np.array([-np.sign(value[0]) * 0.1, 0.1])
    step = np.linalg.solve(J, -value)
    return step / max(1.0, *(np.abs(step) / _LARGEST))


def _first(balance: Balance) -> NDArray[np.float64]:
    """A contact that carries about the load: m/h and log h."""
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
        found = np.isfinite(narrow) and np.isfinite(wide)
        if found and np.isfinite(carried) and abs(carried) < _ROUGHLY:
            return np.array([lean, size])
        if found:
            size = (narrow + wide) / 2.0
        else:
            size += np.log(2.0) if np.isfinite(narrow) else -np.log(2.0)
    raise SolveError(
        f"no contact of a {balance.profile.words()} carries the load: half-widths up to "
        f"{np.exp(size):.3g} m were tried; the profile has to be convex"
    )


def _lean(balance: Balance, size: float) -> float:
    """m/h at which the ends do not pull, roughly; by halving."""
    h, far = float(np.exp(size)), 1.0

    def pulled(lean: float) -> float:
        panels = balance.panels(lean * h, h)
        return float(panels.weights @ balance.slope(panels, lean * h, h))

    for _ in range(_FARTHER):
        if pulled(-far) <= 0.0 <= pulled(far):
            break
        far *= 2.0
    # Where a flat part holds all of the contact nothing pulls: the middle of these places is taken.
    edges = []
    for beyond in (np.less, np.less_equal):
        low, high = -far, far
        for _ in range(12 + int(np.log2(far))):
            middle = (low + high) / 2.0
            low, high = (middle, high) if beyond(pulled(middle), 0.0) else (low, middle)
        edges.append((low + high) / 2.0)
    return float(np.mean(edges))


#: Positions nearer than this to where the pressure is infinite are taken at this distance, over a.
NEXT_TO_TIP = 1e-6
#: Distance over a from a cusp of the pressure at which it is looked at.
_CUSP, _BOTH_SIDES = 1e-5, np.array([-1.0, 1.0])
#: Places at which a largest pressure is looked for, kinks and places beside them besides; most tops that
#: are looked at more nearly, places between their neighbours, and how often nearer.
_LOOKED_AT = np.sin(np.linspace(-np.pi / 2.0, np.pi / 2.0, 301))[1:-1]
_BESIDE_KINKS = np.concatenate([[0.0], *(sign * np.geomspace(1e-4, 0.1, 10) for sign in (-1.0, 1.0))])
_TOPS, _BETWEEN, _ROUNDS = 5, 21, 8


@dataclass(frozen=True)
class Group:
    """Some states whose pressure is of one kind.

    Attributes:
        rows: numbers of these states.
        pressure: a potential with ``σ_YY`` and ``hilbert``; of several states, or of the only one.
        α, β: exponents at the right and the left end, (rows,).
        half_width, centre: of the contact [m], (rows,).
        K_I: at the left and the right end, (rows, 2).
        infinite: places over the half-width at which the pressure is infinite inside the contact.
        cusps: places over the half-width at which it has a cusp, and the exponent there.
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
        """Positions, none where the pressure is infinite."""
        for at in self.infinite:
            side = np.where(r < at, -1.0, 1.0)
            r = np.where(np.abs(r - at) < NEXT_TO_TIP, at + side * NEXT_TO_TIP, r)
        return r


@dataclass(frozen=True)
class Contacts:
    """Contacts at one speed with several frictions.

    Attributes:
        response: of the half-plane at that speed.
        g: σ_XY/σ_YY, (states,).
        groups: all states.
    """

    response: Response
    g: NDArray[np.float64]
    groups: tuple[Group, ...]

    def of(self, name: str) -> NDArray[np.float64]:
        """``α``, ``β``, ``half_width``, ``centre`` or ``K_I`` of every state."""
        parts = [getattr(group, name) for group in self.groups]
        found = np.empty((len(self.g), *parts[0].shape[1:]))
        for group, part in zip(self.groups, parts):
            found[group.rows] = part
        return found

    def σ_YY(self, r: NDArray) -> NDArray[np.float64]:
        """Contact stress at r in (-1, 1), (states, points)."""
        found = np.empty((len(self.g), len(r)))
        for group in self.groups:
            found[group.rows] = group.pressure.σ_YY(group.off(r))
        return found

    def alike(self) -> Iterator[tuple[NDArray[np.int64], "Contacts", Sequence[float]]]:
        """Numbers of states whose pressure is of one kind, these states, and kinks of their pressure."""
        for group in self.groups:
            own = replace(group, rows=np.arange(len(group.rows)))
            yield group.rows, Contacts(self.response, self.g[group.rows], (own,)), group.cusps[0]

    def pressure(self, r: NDArray) -> NDArray[np.float64]:
        """σ_YY, also next to where it is infinite, (states, points)."""
        found = np.empty((len(self.g), len(r)))
        for group in self.groups:
            found[group.rows] = group.pressure.σ_YY(r)
        return found

    def σ_XX(self, r: NDArray) -> NDArray[np.float64]:
        """In-plane stress on the whole surface, off the ends, (states, points)."""
        found, answer = np.empty((len(self.g), len(r))), self.response
        for group in self.groups:
            at, σ_YY = group.off(r), np.zeros((len(group.rows), len(r)))
            under, g = np.abs(r) < 1.0, self.g[group.rows, None]
            σ_YY[:, under] = group.pressure.σ_YY(at[under])
            u_X = answer.q * σ_YY + (answer.n12 + answer.m * g) * group.pressure.hilbert(at)
            found[group.rows] = answer.σ_XX(u_X, σ_YY, g * σ_YY)
        return found

    def inside(self, X: NDArray, Y: NDArray) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY below the surface, at points (n,) or of each state (states, n)."""
        X, Y = np.broadcast_arrays(np.atleast_2d(X), np.atleast_2d(Y))
        found = np.empty((3, len(self.g), X.shape[1]))
        for group in self.groups:
            of_each = group.rows if len(X) > 1 else [0]
            g = self.g[group.rows, None]
            found[:, group.rows] = self.response.inside(group.pressure, g, X[of_each], Y[of_each])
        return found

    def stresses(self, X: NDArray, Y: NDArray) -> NDArray[np.float64]:
        """The same at points with Y <= 0, those of the surface among them."""
        X, Y = np.broadcast_arrays(np.atleast_2d(X), np.atleast_2d(Y))
        on = np.broadcast_to(Y == 0.0, (len(self.g), X.shape[1]))
        found = self.inside(X, np.where(Y == 0.0, -1.0, Y))
        for group in self.groups:
            for row in group.rows[on[group.rows].any(axis=1)].tolist():
                r = X[row if len(X) > 1 else 0, on[row]]
                alone = self._alone(row, group)
                σ_YY = np.zeros((1, len(r)))
                σ_YY[:, np.abs(r) < 1.0] = alone.σ_YY(r[np.abs(r) < 1.0])
                found[:, row, on[row]] = np.concatenate([alone.σ_XX(r), σ_YY, self.g[row] * σ_YY])
        return found

    @property
    def turns(self) -> NDArray[np.float64]:
        """Places over the half-width at which stresses are finite and have a power of the distance: free
        ends and kinks; NaN for none, (states, k)."""
        each: list[list[float]] = [[] for _ in self.g]
        for group in self.groups:
            kinks = [] if len(group.infinite) else list(group.cusps[0])
            for row, α, β in zip(group.rows.tolist(), group.α, group.β):
                each[row] = [-1.0] * bool(β > 0.0) + [1.0] * bool(α > 0.0) + kinks
        found = np.full((len(each), max(map(len, each))), np.nan)
        for row, places in zip(found, each):
            row[: len(places)] = places
        return found

    def _alone(self, row: int, group: Group) -> "Contacts":
        """One state."""
        i = int(np.flatnonzero(group.rows == row)[0])
        pressure = group.pressure
        if isinstance(pressure, Weighted):
            α, β, A, B = (
                np.asarray(part)[i : i + 1] for part in (pressure.α, pressure.β, pressure.A, pressure.B)
            )
            pressure = Weighted(α, β, A, B, pressure.order)
        some = slice(i, i + 1)
        alone = Group(
            np.array([0]), pressure, group.α[some], group.β[some], group.half_width[some],
            group.centre[some], group.K_I[some], group.infinite, group.cusps,
        )  # fmt: skip
        return Contacts(self.response, self.g[row : row + 1], (alone,))

    def largest(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Largest contact pressure, and where; NaN where it is infinite: (states,) each."""
        value, place = np.full((2, len(self.g)), np.nan)
        for group in self.groups:
            finite = (group.α > 0.0) & (group.β > 0.0) & (not group.infinite)
            if finite.all():
                value[group.rows], place[group.rows] = _largest(group)
        return value, place


def _largest(group: Group) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Largest pressure and its place."""
    if isinstance(group.pressure, Weighted):
        place = (group.β - group.α) / (group.β + group.α)
        return -group.pressure.σ_YY(place[:, None])[:, 0], place
    top, at = largest(lambda r: -group.pressure.σ_YY(group.off(r)), group.cusps)
    return np.array([top]), np.array([at])


def largest(
    pressure: Callable[[NDArray], NDArray], cusps: tuple[Sequence[float], float] = ((), 0.0)
) -> tuple[float, float]:
    """The largest pressure under a punch and its place, by looking nearer and nearer to several tops.

    Args:
        pressure: at r in (-1, 1), (points,).
        cusps: places at which it has a cusp, and the exponent there; 0 where it is d log d.
    """
    places, exponent = cusps
    beside = np.ravel(np.add.outer(np.array(places, dtype=float), _BESIDE_KINKS))
    r = np.unique(np.concatenate([_LOOKED_AT, beside[np.abs(beside) < 1.0]]))
    p = pressure(r)
    tops = 1 + np.flatnonzero((p[1:-1] >= p[:-2]) & (p[1:-1] >= p[2:]))
    tops = tops[np.argsort(-p[tops], kind="stable")][:_TOPS]
    found = [_nearer(pressure, r[i - 1], r[i + 1], places) for i in tops.tolist()]
    if exponent:  # which no grid meets: p(d) = p(0) + C d^exponent, the mean of both sides
        for at in places:
            near, far = (float(pressure(at + d * _BOTH_SIDES).mean()) for d in (_CUSP, 2.0 * _CUSP))
            found.append((near + (near - far) / (2.0**exponent - 1.0), float(at)))
    return max(found)


def _nearer(
    pressure: Callable[[NDArray], NDArray], low: float, high: float, kinks: Sequence[float]
) -> tuple[float, float]:
    """The largest pressure between two places, and where; a parabola at last, if there is no kink."""
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
    left, middle, right = p[i - 1 : i + 2]
    bend = left - 2.0 * middle + right
    u = float(np.clip((left - right) / (2.0 * bend), -1.0, 1.0)) if bend < 0.0 else 0.0
    top = middle + (right - left) * u / 2.0 + bend * u**2 / 2.0
    return max((float(p.max()), float(r[p.argmax()])), (float(top), float(r[i] + u * step)))


@dataclass(frozen=True)
class Exponents:
    """Exponents of the pressure at the right and the left end, (states,) each."""

    α: NDArray[np.float64]
    β: NDArray[np.float64]


def local_exponents(response: Response, g: NDArray, profile: Any, load: Any) -> Exponents | FlatPunch:
    """What the local analysis says of the ends: as of a flat punch at sharp ones, one more at others."""
    flat, sharp = FlatPunch(response, g), getattr(profile, "sharp", (True, True))
    if all(sharp):
        return flat
    try:
        found = contacts(response, g, profile, load) if isinstance(profile, Flat) else None
    except SolveError:
        found = None  # told of by the method that solves
    if found:
        return Exponents(found.of("α"), found.of("β"))
    return Exponents(flat.α + (not sharp[1]), flat.β + (not sharp[0]))


def contacts(response: Response, g: NDArray, profile: Any, load: Any) -> Contacts:
    """The contacts of a punch.

    Args:
        response: of the half-plane at a speed.
        g: σ_XY/σ_YY under the punch, (states,).
        profile: of the punch; its ends are found.
        load: N/μ [m], or that of each state, (states,).

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
    """Flat punches with both edges in contact, or with one lifted off."""
    flat, half, θ = FlatPunch(response, g), profile.half_width, profile.rise
    sin, α, β = flat._sin, flat.α, flat.β
    a, b = 1.0 + α, 1.0 + β
    A, B = 2.0 * sin / np.pi, -θ * sin / n * (2.0 * half / load)
    lifted = (A + 2.0 * a * B > 0.0) | (A - 2.0 * b * B > 0.0)
    order = np.where(lifted, 0, -1)
    # One end given, one found: the contact starts at the lower edge.
    share = a if θ > 0.0 else b
    h = np.where(lifted, load * n / (2.0 * np.pi * share * abs(θ)) if θ else half, half)
    centre = np.where(lifted, np.sign(θ) * (h - half), 0.0)
    α, β = (np.where(lifted, α + (θ > 0.0), α), np.where(lifted, β + (θ < 0.0), β))
    A = np.where(lifted, sin / (np.pi * share), A + B * (flat.α - flat.β))
    B = np.where(lifted, 0.0, B)
    found = []
    for kind in (-1, 0):
        rows = np.flatnonzero(order == kind)
        if len(rows):
            column = np.s_[rows, None]
            pressure = Weighted(α[column], β[column], A[column], B[column], kind)
            K = pressure.K_I[:, 0]
            found.append(Group(rows, pressure, α[rows], β[rows], h[rows], centre[rows], K))
    return tuple(found)


def _by_quadrature(
    response: Response, g: NDArray, n: NDArray, profile: Any, load: NDArray
) -> Sequence[Group]:
    """Any convex profile, state after state, equal ones once."""
    flat, found, start = FlatPunch(response, g), [], None
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
            found.append(group)
    return found


def pressure_of(
    balance: Balance, response: Response, g: float, m: float, h: float, load: float
) -> tuple[FreeEnds, tuple[float, ...]]:
    """The pressure of a contact, and where it is infinite inside, over the half-width."""
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
