"""Stresses of contacts: places, measures, sizes, and their extremes on the surface.

**Measures.** Relative errors of stresses are relative to the sizes that :func:`of_in_plane`,
:func:`of_inside`, :func:`of_interfaces` and :func:`of_factor` give.

**Extremes.** Next to free ends of a contact and kinks of its punch stresses change with a power of the
distance, and the largest may lie between samples: a :class:`Surface` has limits there, :class:`Turns`.
The highest and the lowest in-plane stress on the surface include these limits. Places next to sharp edges
and tips, where it is infinite, do not count.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from functools import cached_property, reduce
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .edges import from_edge, under_punch
from .extremes import ALONG, GRADED, between, highest, tops
from .prescribed_pressure import LinearPressure


@dataclass(frozen=True)
class Places:
    """Places at which stresses are computed, over a.

    Attributes:
        X: positions on the surface, (n,).
        points: positions X, Y inside, (m, 2).
        around: positions X, Y at which stresses are compared with the yield strength, (k, 2).
        interfaces: depths of a layered solid's interfaces, (layers,).
        along: positions X along each interface, (l,).
    """

    X: NDArray[np.float64]
    points: NDArray[np.float64]
    around: NDArray[np.float64] = field(default_factory=lambda: np.empty((0, 2)))
    interfaces: NDArray[np.float64] = field(default_factory=lambda: np.empty(0))
    along: NDArray[np.float64] = field(default_factory=lambda: np.empty(0))

    @cached_property
    def under(self) -> NDArray[np.bool_]:
        """True at positions on the surface under the punch, (n,)."""
        return under_punch(self.X)


@dataclass(frozen=True)
class Turns:
    """Limits of the stresses on the surface at free ends of a contact and at kinks of the punch.

    Near these places stresses go with a power of the distance, and samples miss the largest stress.

    Attributes:
        X: places over a, NaN for none, (states, k).
        σ: σ_XX, σ_YY, σ_XY over N/(2a) at these places, NaN for none, (3, states, k).
        between: place of the highest and of the lowest σ_XX between kinks, near which it has a logarithm
            of the distance, and σ_XX there, NaN for none, (2, 2, states): X or σ_XX, highest or lowest.
            None without kinks.
    """

    X: NDArray[np.float64]
    σ: NDArray[np.float64]
    between: NDArray[np.float64] | None = None

    @property
    def named(self) -> NDArray[np.float64]:
        """Places over a, the first again and again where a state has fewer than others, (states, k)."""
        return np.where(np.isnan(self.X), self.X[:, :1], self.X)

    def of(self, rows: NDArray) -> "Turns":
        """Turns of the states with these numbers, which may repeat."""
        between = None if self.between is None else self.between[..., rows]
        return Turns(self.X[rows], self.σ[:, rows], between)

    def joined(self, other: "Turns") -> "Turns":
        """Turns at these places and at other places of the same states."""
        σ = np.concatenate([self.σ, other.σ], axis=2)
        between = other.between if self.between is None else self.between
        return Turns(np.concatenate([self.X, other.X], axis=1), σ, between)


def together(each: list[Turns]) -> Turns | None:
    """Turns of all states from those of one or several each, padded with NaN to as many places.

    Returns:
        Turns of as many states; None where the list is empty.
    """
    if not each:
        return None
    most = max(turns.X.shape[1] for turns in each)

    def padded(values: NDArray) -> NDArray[np.float64]:
        widths = [(0, 0)] * (values.ndim - 1) + [(0, most - values.shape[-1])]
        return np.pad(np.asarray(values, dtype=float), widths, constant_values=np.nan)

    between = None
    if any(turns.between is not None for turns in each):
        none = [np.full((2, 2, len(turns.X)), np.nan) for turns in each]
        between = np.concatenate([n if t.between is None else t.between for n, t in zip(none, each)], 2)
    X, σ = (
        np.concatenate([padded(of) for of in ofs], axis=-2) for ofs in zip(*((t.X, t.σ) for t in each))
    )
    return Turns(X, σ, between)


@dataclass(frozen=True)
class Surface:
    """Stresses on the surface Y = 0.

    Attributes:
        places: positions at which the stresses are computed.
        σ_YY: contact stress over N/(2a), NaN beside the punch, (states, n).
        σ_XX: in-plane stress over N/(2a), (states, n).
        raw: contact stress over N/(2a) without an assumed exponent, (states, n); of finite elements
            alone.
        v_X: slopes μ v,X over N/(2a), (states, n); of finite elements alone.
        turns: limits of the stresses; None where they are infinite at both ends and have no cusp.
    """

    places: Places
    σ_YY: NDArray[np.float64]
    σ_XX: NDArray[np.float64]
    raw: NDArray[np.float64] | None = None
    v_X: NDArray[np.float64] | None = None
    turns: Turns | None = None

    def of(self, rows: NDArray) -> "Surface":
        """Stresses of the states with these numbers, which may repeat."""
        σ_YY, σ_XX, raw, v_X = (
            None if values is None else values[rows]
            for values in (self.σ_YY, self.σ_XX, self.raw, self.v_X)
        )  # fmt: skip
        return Surface(self.places, σ_YY, σ_XX, raw, v_X, self.turns and self.turns.of(rows))  # type: ignore[arg-type]


def flatness(surface: Any) -> NDArray[np.float64]:
    """Largest |v,X| for |X| <= 0.9a over the largest for 1.1a <= |X| <= 5a, dimensionless, (states,).

    Args:
        surface: of finite elements, :class:`galinx.solvers.contact.solution.Surface`.
    """
    X = np.abs(surface.places.X)
    parts = X <= 0.9, (X >= 1.1) & (X <= 5.0)
    under, beside = (np.abs(surface.v_X[:, part]).max(axis=1) for part in parts)
    return under / beside


def von_mises(σ_XX: NDArray, σ_YY: NDArray, σ_XY: NDArray, σ_ZZ: NDArray) -> NDArray[np.float64]:
    """Von Mises stress in the unit and the shape of the stresses.

    √(½[(σ_XX - σ_YY)² + (σ_YY - σ_ZZ)² + (σ_ZZ - σ_XX)²] + 3σ_XY²).
    """
    with np.errstate(invalid="ignore"):  # NaN of infinite stresses at tips
        normal = (σ_XX - σ_YY) ** 2 + (σ_YY - σ_ZZ) ** 2 + (σ_ZZ - σ_XX) ** 2
    return np.sqrt(normal / 2.0 + 3.0 * σ_XY**2)


def maximum_shear(σ_XX: NDArray, σ_YY: NDArray, σ_XY: NDArray) -> NDArray[np.float64]:
    """Largest shear stress in the plane, √(¼(σ_XX - σ_YY)² + σ_XY²), in the unit of the stresses."""
    return np.hypot((σ_XX - σ_YY) / 2.0, σ_XY)


def principal(σ_XX: NDArray, σ_YY: NDArray, σ_XY: NDArray) -> NDArray[np.float64]:
    """Principal stresses in the plane, the larger first, (2, ...), in the unit of the stresses."""
    middle, radius = (σ_XX + σ_YY) / 2.0, maximum_shear(σ_XX, σ_YY, σ_XY)
    return np.array([middle + radius, middle - radius])


#: Places X over a under the punch, closer towards the ends.
PLACES = -np.cos(np.pi * (np.arange(81) + 0.5) / 81)


def tension(X: NDArray, σ_YY: NDArray) -> NDArray[np.float64]:
    """Largest tension under the punch over N/(2a), and its X over a; 0 and NaN for none, (2, states).

    Args:
        X: positions over a under the punch, (n,); none where it presses everywhere.
        σ_YY: contact stress over N/(2a) there, (states, n).
    """
    size = σ_YY.max(axis=1, initial=0.0)
    place = X[σ_YY.argmax(axis=1)] if len(X) else np.nan
    return np.array([size, np.where(size > 0.0, place, np.nan)])


#: Distance over a from an edge of the punch, where stresses are infinite; nearer stresses are no measure
#: for the size of others.
NEAR = 1e-2

#: Distance over a from a tip of the punch, where stresses are infinite, within which none is compared.
NEAR_TIP = 0.02

#: Distance over a from a tip of the nearest place that counts.
BESIDE_TIP = NEAR_TIP * (1.0 + 1e-9)

#: Share of the largest smooth factor of a pressure; where the factor is smaller, its error is relative to
#: this share instead, since it may vanish.
_VANISHING = 0.1


def of_in_plane(σ_XX: NDArray, X: NDArray) -> NDArray[np.float64]:
    """Size of in-plane stresses on the surface: the larger of each and the largest far from the edges.

    Far from the edges is further than ``NEAR``.

    Args:
        σ_XX: in-plane stress on the surface, (states, n).
        X: positions over a, (n,).

    Returns:
        Sizes in the unit of the stress, (states, n).
    """
    return _at_least_far(np.abs(σ_XX), from_edge(X) >= NEAR)


def off_tips(X: NDArray, tips: NDArray, Y: Any = 0.0) -> NDArray[np.bool_]:
    """Mask of places further than ``NEAR_TIP`` from all tips of the punch.

    Args:
        X, Y: coordinates of the places over a, (n,).
        tips: positions X of the tips over a, (k,) for all states, or (states, k).

    Returns:
        True far from all tips, (n,), or (states, n).
    """
    from_tips = np.hypot(X[:, None] - np.asarray(tips)[..., None, :], np.reshape(Y, (-1, 1)))
    return np.all(from_tips >= NEAR_TIP, axis=-1)


def of_inside(σ: Iterable[NDArray], X: NDArray, Y: NDArray) -> NDArray[np.float64]:
    """Size of stresses inside: the larger of each point's largest component and that far from the edges.

    Far from the edges is further than ``NEAR``; the result has the shape (states, m).

    Args:
        σ: components of the stress, each (states, m).
        X, Y: positions over a, (m,).
    """
    return _at_least_far(largest(σ), np.hypot(from_edge(X), Y) >= NEAR)


#: Ratio of depths up to which positions along one interface suit another.
_SUITS = 1.5


def distances(low: float, high: float) -> NDArray[np.float64]:
    """Distances over a from an edge or a kink that suit interfaces at depths from ``low`` to ``high``.

    They are an eighth of the depth apart up to four depths, and farther away an eighth of themselves.
    """
    if high < _SUITS * low:
        low = high
    d = min(low, 1.0) * np.linspace(0.0, 4.0, 33)
    for ratio, end in ((33.0 / 32.0, min(4.0 * high, 1.0)), (9.0 / 8.0, 1.0)):
        if end > d[-1]:
            steps = int(np.ceil(np.log(end / d[-1]) / np.log(ratio))) + 1
            d = np.append(d, np.geomspace(d[-1], end, steps)[1:])
    return d


def of_interfaces(σ: NDArray) -> NDArray[np.float64]:
    """Size of stresses at interfaces: the largest along each interface of the component or a traction.

    Args:
        σ: σ_YY, σ_XY, σ_XX above and σ_XX below, (4, states, interfaces, n).

    Returns:
        Sizes in the unit of the stresses, (4, states, interfaces, 1).
    """
    size = np.abs(σ).max(axis=3, keepdims=True)
    tractions = np.maximum(size[0], size[1])
    return np.maximum(size, tractions)


def largest(components: Iterable[NDArray]) -> NDArray[np.float64]:
    """Largest absolute value, element by element, of arrays of equal shape."""
    return reduce(np.maximum, map(np.abs, components))


def of_factor(f: NDArray) -> NDArray[np.float64]:
    """Size of a smooth factor: the larger of each value and a tenth of a state's largest, (states, n)."""
    return np.maximum(np.abs(f), _VANISHING * np.abs(f).max(axis=1, keepdims=True))


def _at_least_far(size: NDArray, far: NDArray) -> NDArray[np.float64]:
    return np.maximum(size, np.where(far, size, 0.0).max(axis=1, keepdims=True, initial=0.0))


#: Distance over a from an end within which stresses outside the contact give the limit at the end;
#: relative singular value below which terms count as dependent.
_BESIDE_END, _NO_DIGIT = 2e-4, 1e-12


def turns_at_ends(surface: Surface, local: Any) -> Turns:
    """Limits of stresses at both ends of contacts, by those outside; NaN at sharp edges.

    Args:
        surface: stresses of the states on the surface.
        local: exponents α at X = a and β at X = -a, (states,).
    """
    exponents = np.column_stack([local.β, local.α])
    σ_XX = np.full(exponents.shape, np.nan)
    for i, side in enumerate((-1.0, 1.0)):
        d = side * surface.places.X - 1.0
        beside = (d > 0.0) & (d < _BESIDE_END)
        x = d[beside] / _BESIDE_END
        for row in np.flatnonzero(exponents[:, i] > 0.0):
            a = exponents[row, i]
            terms = np.column_stack([np.ones_like(x), x, x**a, x ** (1.0 + a)])
            σ_XX[row, i] = np.linalg.lstsq(terms, surface.σ_XX[row, beside], rcond=_NO_DIGIT)[0][0]
    none = np.where(np.isnan(σ_XX), np.nan, 0.0)
    return Turns(np.tile([-1.0, 1.0], (len(σ_XX), 1)), np.array([σ_XX, none, none]))


def turns_at_knots(
    pressure: LinearPressure, g: NDArray, σ_XX: Callable[[NDArray], NDArray[np.float64]]
) -> Turns:
    """Limits of stresses at the knots of a prescribed pressure, NaN where it jumps, and between knots.

    Args:
        pressure: the prescribed pressure.
        g: σ_XY/σ_YY, (states,).
        σ_XX: in-plane stress over N/(2a), (states, n), at positions on the surface over a, (n,).
    """
    infinite = np.zeros(len(pressure.knots), dtype=bool)
    infinite[[0, -1]] = pressure.values[[0, -1]] != 0.0
    σ, between_knots = at_and_between(pressure.knots, σ_XX, infinite)
    σ_YY, knots = (np.where(np.isnan(σ), np.nan, of) for of in (pressure.values, pressure.knots))
    return Turns(knots, np.array([σ, σ_YY, g[:, None] * σ_YY]), between_knots)


#: log(d/d') of the few places that show between which turns the stress is highest; number of the highest
#: of these, and of the lowest, next to which it is evaluated at many.
_COARSE, _HIGHEST = np.array([-2.0, 0.0, 2.0]), 4


def at_and_between(
    turns: NDArray,
    σ_XX: Callable[[NDArray], NDArray[np.float64]],
    infinite: NDArray | Sequence[bool] = (False,),
    nearest: float = 0.0,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """In-plane stress at turns, NaN where infinite, (states, turns), and :attr:`Turns.between`.

    Args:
        turns: rising positions over a from -1 to 1, (turns,).
        σ_XX: in-plane stress over N/(2a), (states, n), at positions over a, (n,).
        infinite: True where the stress is infinite at a turn, (turns,) or (1,).
        nearest: distance over a from turns within which the stress between them is not known.
    """
    infinite = np.broadcast_to(infinite, turns.shape)
    few = np.column_stack([turns[:-1], between(turns, _COARSE)]).ravel()
    with np.errstate(invalid="ignore"):  # an infinite weight at a free end, times 0, has no value there
        each = σ_XX(np.append(few, 1.0))
    per = 1 + len(_COARSE)
    each[:, ::per][:, infinite] = np.nan
    ranked = np.concatenate([sign * each for sign in (1.0, -1.0)])
    padded = np.pad(np.nan_to_num(ranked, nan=-np.inf), ((0, 0), (1, 1)), constant_values=-np.inf)
    inner = padded[:, 1:-1]
    heights = np.where((inner >= padded[:, :-2]) & (inner >= padded[:, 2:]), inner, -np.inf)
    chosen = np.unique(np.argsort(-heights, axis=1, kind="stable")[:, :_HIGHEST])
    # A turn belongs to the intervals on both sides of it.
    intervals = np.unique(np.clip([chosen // per, (chosen - 1) // per], 0, len(turns) - 2))
    X = between(turns)[intervals]
    σ = σ_XX(X.ravel()).reshape(len(each), *X.shape)
    σ[:, np.abs(X[..., None] - turns).min(axis=-1) < nearest] = np.nan
    σ[:, (np.abs(X[..., None] - turns[infinite]) <= NEAR).any(axis=-1)] = np.nan
    extremes = []
    for sign in (1.0, -1.0):
        candidates = []
        for i, interval in enumerate(intervals.tolist()):
            height, x = tops(GRADED, np.nan_to_num(sign * σ[:, i], nan=-np.inf), through=ALONG)
            width = turns[interval + 1] - turns[interval]
            candidates.append((height, turns[interval] + width / (1.0 + np.exp(-x))))
        height, place = highest(*(np.concatenate(of, axis=1) for of in zip(*candidates)))
        extremes.append([place, sign * height])
    return each[:, ::per], np.moveaxis(np.array(extremes), 0, 1)


def extreme_in_plane(
    solution: Any, body: Any, sign: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Highest (1) or lowest (-1) in-plane stress of states over N/(2a), and its place over a, (states,).

    Places next to sharp edges and tips, where it is infinite, do not count. At a free end the place is
    that end, exactly. Of places that are as high, as both ends are without friction, it is the left one.

    Args:
        solution: states solved by any method, see :class:`galinx.solvers.contact.solution.Solution`.
        body: punch and half-plane, see :class:`galinx.solvers.contact.solution.Contact`.
        sign: 1 for the highest, -1 for the lowest.
    """
    surface = solution.surface
    sharp = body.infinite_ends(solution.local)
    infinite = [(np.where(sharp[:, i], side, np.nan), NEAR) for i, side in enumerate((-1.0, 1.0))]
    infinite += [((tip - solution.centre) / solution.half_width, NEAR_TIP) for tip in body.tips]

    def counted(X: NDArray, σ: NDArray) -> NDArray[np.float64]:
        near = [np.abs(X - place[:, None]) <= reach for place, reach in infinite]
        return np.where(np.isnan(σ) | np.logical_or.reduce(near), -np.inf, sign * σ)

    turns = surface.turns or turns_at_ends(surface, solution.local)
    curves = counted(surface.places.X, surface.σ_XX)
    samples = curves.max(axis=1)[:, None], surface.places.X[curves.argmax(axis=1)][:, None]
    candidates = [(counted(turns.X, turns.σ[0]), turns.X), samples]
    between = solution.between_kinks_of_friction
    if between is None:
        between = turns.between
    if between is not None:
        X, σ = between[:, int(sign < 0.0), :, None]
        candidates.append((counted(X, σ), X))
        curves = np.where(np.isfinite(σ) & surface.places.under, -np.inf, curves)
    candidates.append(on_surface(surface.places.X, curves, turns))
    if (beside := solution.beside_tips) is not None:
        candidates.append((counted(*beside), beside[0]))
    height, place = highest(*(np.concatenate(of, axis=1) for of in zip(*candidates)))
    return sign * height, place


def on_surface(X: NDArray, curves: NDArray, turns: Turns) -> tuple[NDArray, NDArray]:
    """Highest tops of curves along the surface, and their places over a, (states, tops) each.

    Between turns and ends they are smooth in a coordinate that is like the root of the distance next to
    the ends.

    Args:
        X: rising positions over a, (n,).
        curves: values at these, -inf where they do not count, (states, n).
        turns: of each state.
    """
    u = np.arcsin(np.clip(X, -1.0, 1.0)) + np.sign(X) * np.arccosh(np.maximum(np.abs(X), 1.0))
    ends = (X > -1.0).astype(int) + (X > 1.0)
    beyond_turns = (X[:, None] > np.nan_to_num(turns.X, nan=np.inf)[:, None]).sum(axis=-1)
    heights, at = tops(u, curves, ends + beyond_turns)
    beyond = np.maximum(np.abs(at) - np.pi / 2.0, 0.0)
    return heights, np.where(beyond > 0.0, np.sign(at) * np.cosh(beyond), np.sin(at))
