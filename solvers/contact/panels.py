"""Functions over a contact by their values on panels in x = log((1 + t)/(1 - t)), and what follows.

In x both ends of the contact [-1, 1] lie at infinity, and what goes with a power or a logarithm of the
distance from an end is smooth. With the weight w = (1 - t)^α (1 + t)^β, δ = 1 + α + β, Cauchy's
integral is a convolution,

    ∫ w f/(t - z) dt = w(z) C(y),   C(y) = ∫ f [(1 + t)/(1 + z)]^δ e^(kξ)/(e^ξ - 1) dx,   ξ = x - y,

k = -α, y = log((1 + z)/(1 - z)), -π <= Im y < 0 below the surface; δ is 0 below edges with one friction,
and where each end has an exponent of its own it is not. In a panel that is near y the smooth rest of
the integrand is a sum of Legendre polynomials, whose Cauchy integrals are Legendre's functions of the
second kind.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from math import log
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from ..approximation import legendre_panel
from .pressure import Functions, log_beside

#: Points of a panel, and of one of a slope, which is exact to the last digits.
NODES, _OF_SLOPES = 14, 20
#: |x| beyond which functions are those at the ends: of pressures, of slopes.
_REACH, _REACH_OF_SLOPES = 26.0, 40.0
#: Longest panels up to some |x|, and of slopes and of the weight over these.
_LONGEST, _SLOPES, _LONGEST_OF_WEIGHT = ((8.0, 2.0), (15.0, 3.5), (np.inf, 6.0)), 0.8, 0.7
#: Panels towards a kink: their grading, and their number where the pressure itself is infinite or has a
#: cusp, and where only the pressure that layers add is resolved; both for slopes.
_TO_KINK, TO_TIP, TO_BEND, _TO_KINK_OF_SLOPES, _STEPS_OF_SLOPES = 0.2, 18, (5, 0.2), 0.5, 46
#: Panels towards a place where a kernel is rough: their grading and number; distance over a panel's
#: length within which a place is near it, and below which it is at its end.
_GRADING, _STEPS, _NEAR, _CLOSEST = 0.2, 22, 1.0, 1e-16
#: Kernels that are held at once.
_TOGETHER = 2_000_000
#: Longest panel over the length over which a kernel varies.
PER_LENGTH = 2.0
#: Distance from a free end within which a pressure is continued, and up to which it is fitted for that.
_MENDED, _KNOWN = 1e-4, 1e-2
#: Points of the longest step; by how many a step of no weight has fewer for each one that it is shorter.
_POINTS, _FEWER = 14, 0.8

#: Size of Bernstein's ellipse through y from which Gauss's rule alone serves a panel; |1 - e^ξ| below
#: which it is formed without cancellation; kernels at once, which stay in a core's cache, and those of
#: layers over that.
_ELLIPSE, _CLOSE, _AT_ONCE, _ROWS = 2.4, 0.1, 20_000, 8


@lru_cache(maxsize=16)
def ends_of_panels(
    finest: float,
    kinks: tuple[float, ...] = (),
    steps: int = TO_TIP,
    grading: float = _TO_KINK,
    reach: float = _REACH,
    settled: float = 0.0,
) -> NDArray[np.float64]:
    """Ends of panels in x, (panels + 1,).

    No panel is longer than ``finest`` in t, nor than ``finest`` times the usual length in x.

    Args:
        finest: longest panel.
        kinks: places in t towards which panels get shorter.
        steps: number of panels that do, to either side; -1 for panels that only end there.
        grading: length of a panel over that of the next.
        reach: |x| up to which there are panels.
        settled: longest panel below which only panels in t get shorter: what varies over a length in t is
            smooth in x next to the ends.
    """
    half = [0.0]
    while half[-1] < reach - 1e-9:
        half.append(min(half[-1] + float(_longest(half[-1], finest, settled)), reach))
    ends = np.concatenate([-np.array(half[:0:-1]), half])
    at = stretched(np.array(kinks, dtype=float))
    at = at[np.abs(at) < reach]
    if not len(at):
        return ends
    towards = np.append(grading ** np.arange(steps + 1), 0.0)
    graded = (at[:, None] + np.concatenate([-towards, towards])).ravel()
    others = ends[np.abs(ends[:, None] - at).min(axis=1) > 1.0]
    ends = np.unique(np.concatenate([others, graded[np.abs(graded) < reach], [-reach, reach]]))
    while True:
        middle = (ends[1:] + ends[:-1]) / 2.0
        long = np.diff(ends) > 1.5 * _longest(middle, finest, settled)
        if not long.any():
            return ends
        ends = np.sort(np.append(ends, middle[long]))


def _longest(x: Any, finest: float, settled: float) -> NDArray[np.float64]:
    """Longest panel in x at places x, with the shape of x."""
    limits, lengths = np.array(_LONGEST).T
    longest = lengths[np.searchsorted(limits, np.abs(x), side="right")]
    in_t = 2.0 * finest * np.cosh(np.abs(x) / 2.0) ** 2
    return np.asarray(np.minimum(max(finest, settled) * longest, in_t))


def stretched(r: NDArray) -> NDArray[np.float64]:
    """Coordinate x at positions r in [-1, 1], of their shape."""
    with np.errstate(divide="ignore"):
        return np.asarray(np.log1p(r) - np.log1p(-r))


class _Parts(NamedTuple):
    """Parts of panels near places, with one rule that is graded towards their starts, (parts,) each.

    Attributes:
        place, x: number of the place, and where it is.
        panel: number of the panel.
        start: where the part starts, in x.
        length: of the part, negative where it ends to the left of the start.
        apart, varied: steps of the rule, see :func:`_graded`.
    """

    place: NDArray[np.int64]
    x: NDArray[np.float64]
    panel: NDArray[np.int64]
    start: NDArray[np.float64]
    length: NDArray[np.float64]
    apart: int
    varied: int


@dataclass(frozen=True)
class Panels(Functions):
    """Rule on panels for integrals with the weight (1 - t)^α (1 + t)^β.

    Attributes:
        α, β: exponents.
        finest: longest panel in t.
        kinks, steps, grading, reach, settled: as in :func:`ends_of_panels`.
        nodes: points of a panel.
        rough: True if kernels in integrals may have a logarithm at 0.
        length: over which layers vary a pressure next to a free end.
    """

    α: float
    β: float
    finest: float
    kinks: tuple[float, ...] = ()
    steps: int = TO_TIP
    grading: float = _TO_KINK
    reach: float = _REACH
    nodes: int = NODES
    rough: bool = True
    settled: float = 0.0
    length: float = 1.0

    @cached_property
    def ends(self) -> NDArray[np.float64]:
        return ends_of_panels(self.finest, self.kinks, self.steps, self.grading, self.reach, self.settled)

    @cached_property
    def half(self) -> NDArray[np.float64]:
        return np.diff(self.ends) / 2.0

    @cached_property
    def middle(self) -> NDArray[np.float64]:
        return (self.ends[1:] + self.ends[:-1]) / 2.0

    @cached_property
    def x(self) -> NDArray[np.float64]:
        """Points in x, (n,)."""
        τ, _, _ = legendre_panel(self.nodes)
        return (self.middle[:, None] + self.half[:, None] * τ).ravel()

    @cached_property
    def dx(self) -> NDArray[np.float64]:
        """Weights of integrals over x, (n,)."""
        _, w, _ = legendre_panel(self.nodes)
        return np.asarray((self.half[:, None] * w).ravel())

    @cached_property
    def t(self) -> NDArray[np.float64]:
        return np.tanh(self.x / 2.0)

    @cached_property
    def weights(self) -> NDArray[np.float64]:
        """Weights of integrals over t with (1 - t)^α (1 + t)^β, (n,); beyond the reach included."""
        weights = self.dx * self.density(self.x)
        beyond = 2.0 / (1.0 + np.exp(self.reach))
        weights[-1] += 2.0**self.β * beyond ** (1.0 + self.α) / (1.0 + self.α)
        weights[0] += 2.0**self.α * beyond ** (1.0 + self.β) / (1.0 + self.β)
        return weights

    def density(self, x: NDArray) -> NDArray[np.float64]:
        """Weight times dt/dx; 1 - t = 2/(1 + e^x), and dt/dx is half the product of 1 - t and 1 + t."""
        log = -(1.0 + self.α) * np.logaddexp(0.0, x) - (1.0 + self.β) * np.logaddexp(0.0, -x)
        return np.asarray(2.0 ** (self.α + self.β + 1.0) * np.exp(log))

    def weight(self, x: NDArray) -> NDArray[np.float64]:
        """(1 - t)^α (1 + t)^β at x, with the shape of x."""
        log = -self.α * np.logaddexp(0.0, x) - self.β * np.logaddexp(0.0, -x)
        return np.asarray(2.0 ** (self.α + self.β) * np.exp(log))

    def apart(self, x: Any, y: NDArray, δ: Any = None) -> NDArray[np.float64]:
        """t(y) - t(x), to all digits, broadcast.

        Args:
            x, y: places.
            δ: y - x, where it has more digits than these.
        """
        δ = y - x if δ is None else δ
        return np.asarray(np.sinh(δ / 2.0) / (np.cosh(x / 2.0) * np.cosh(y / 2.0)))

    def basis(self, x: NDArray, panel: int | NDArray) -> NDArray[np.float64]:
        """Matrix from values at a panel's points to those at its places x, (len(x), nodes)."""
        τ = (x - self.middle[panel]) / self.half[panel]
        return np.asarray(legendre.legvander(τ, self.nodes - 1) @ legendre_panel(self.nodes)[2])

    def interpolated(self, p: NDArray, x: NDArray) -> NDArray[np.float64]:
        """Values at places x of functions p with values (n, ...) at the points, shape of x and (...)."""
        inside = np.clip(x, -self.reach, self.reach)
        values = np.empty((*inside.shape, *p.shape[1:]))
        panels = np.clip(np.searchsorted(self.ends, inside) - 1, 0, len(self.half) - 1)
        for panel in np.unique(panels).tolist():
            rows = panels == panel
            values[rows] = self.basis(inside[rows], panel) @ p[self.of(panel)]
        return values

    def of(self, panel: int) -> slice:
        """Numbers of a panel's points."""
        return slice(panel * self.nodes, (panel + 1) * self.nodes)

    @cached_property
    def between(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Places in x between the points, one more in a panel, and values there from the panel's points.

        Returns:
            Places, (panels * (nodes + 1),), and the matrix of each panel, (nodes + 1, nodes).
        """
        (τ, _, _), (_, _, to_legendre) = legendre_panel(self.nodes + 1), legendre_panel(self.nodes)
        x = (self.middle[:, None] + self.half[:, None] * τ).ravel()
        return x, legendre.legvander(τ, self.nodes - 1) @ to_legendre

    def rows(self, kernel: Callable[[NDArray], NDArray], x: NDArray) -> NDArray[np.float64]:
        """Weights of values at the points in ∫ kernel(t(x) - t) w(t) … dt at x, (len(x), n, functions).

        The kernel may be rough where t = t(x) if the panels are.
        """
        if self.rough:
            blocks = self.blocks(len(x), _ROWS)
            return np.concatenate([self._graded_rows(kernel, x[rows]) for rows in blocks])
        parts = [x[rows, None] for rows in self.blocks(len(x), _ROWS)]
        return np.concatenate([
            kernel(-self.apart(part, self.x)) * self.weights[:, None] for part in parts
        ])  # fmt: skip

    def _graded_rows(self, kernel: Callable[[NDArray], NDArray], x: NDArray) -> NDArray[np.float64]:
        """Weights of :meth:`rows` by rules on panels near the places, graded towards these."""
        x = np.clip(x, -self.reach, self.reach)
        reach, (τ, _, _) = _NEAR * np.diff(self.ends), legendre_panel(self.nodes)
        near = (self.ends[:-1] - reach <= x[:, None]) & (x[:, None] <= self.ends[1:] + reach)
        away = -self.apart(x[:, None], self.x)
        away[away == 0.0] = 1.0  # on panels that have rules
        parts = [*self._parts(x, *np.nonzero(near))]
        rules = [_graded(part.apart, part.varied, self.nodes) for part in parts]
        δ = [
            part.start[:, None] - part.x[:, None] + part.length[:, None] * s
            for part, (s, _, _) in zip(parts, rules)
        ]
        y = [part.x[:, None] + each for part, each in zip(parts, δ)]
        aways = [away, *(-self.apart(part.x[:, None], *of) for part, *of in zip(parts, y, δ))]
        sizes = np.cumsum([each.size for each in aways])[:-1]
        values, *of_parts = np.split(kernel(np.concatenate([*map(np.ravel, aways)])), sizes)
        weights = np.where(np.repeat(near, self.nodes, axis=1), self._beyond, self.weights)
        integrals = (values * weights.reshape(-1, 1)).reshape(*near.shape, self.nodes, -1)
        for part, (_, ds, through), of, values in zip(parts, rules, y, of_parts):
            weights = np.abs(part.length[:, None]) * ds * self.density(of)
            sums = through.T @ (values.reshape(*weights.shape, -1) * weights[..., None])
            # The polynomials of the panel are those of the part through as many points there.
            at = part.start[:, None] + part.length[:, None] * (1.0 + τ) / 2.0
            basis = self.basis(at.ravel(), np.repeat(part.panel, self.nodes))
            basis = basis.reshape(*at.shape, self.nodes).swapaxes(1, 2)
            integrals[part.place, part.panel] += basis @ sums
        return integrals.reshape(len(x), len(self.x), -1)

    def _parts(self, x: NDArray, place: NDArray, panel: NDArray) -> Iterator[_Parts]:
        """Parts of panels near places, to the left and to the right of these, by the steps of rules."""
        at = np.clip(x[place], self.ends[panel], self.ends[panel + 1])
        for end in (self.ends[panel], self.ends[panel + 1]):
            beside = end != at
            places, panels, start, length = place[beside], panel[beside], at[beside], (end - at)[beside]
            near = x[places]
            # Steps need be no shorter than the place is far; where kernels vary all weigh alike.
            needed = np.column_stack([np.abs(start - near), np.full(len(near), self.length)])
            shares = np.clip(needed / np.abs(length[:, None]), _CLOSEST, 1.0)
            steps = np.minimum(np.ceil(np.log(shares) / log(_GRADING)), _STEPS).astype(int)
            for apart, varied in np.unique(steps, axis=0).tolist():
                rows = (steps == [apart, varied]).all(axis=1)
                yield _Parts(
                    places[rows], near[rows], panels[rows], start[rows], length[rows], apart, varied
                )

    @cached_property
    def _beyond(self) -> NDArray[np.float64]:
        """Weights of what is beyond the reach, (n,)."""
        return self.weights - self.dx * self.density(self.x)

    def blocks(self, count: int, larger: int = 1) -> Iterator[slice]:
        """Blocks of so many places, of which values at all points take little memory."""
        step = max(larger * _AT_ONCE // len(self.x), 1)
        return (slice(start, start + step) for start in range(0, count, step))

    def cauchy(self, f: NDArray, y: NDArray) -> NDArray[Any]:
        """Cauchy's integral of w f over w, C(y), (points,); a principal value where y is real.

        Args:
            f: values at the points, (n,), or (points, n) if f differs from y to y.
            y: (points,).
        """
        k, δ, ends = -self.α, 1.0 + self.α + self.β, f[..., [0, -1]]
        f = f * (1.0 + np.exp(-self.x)) ** -δ
        x, rule = self.x, f * (np.exp(k * self.x) * self.dx)
        ζ = (y[:, None] - self.middle) / self.half
        root = np.sqrt((ζ - 1.0).astype(complex)) * np.sqrt((ζ + 1.0).astype(complex))
        near = np.abs(ζ + root) < _ELLIPSE
        integral = np.zeros(len(y), dtype=np.result_type(y, float))
        for rows in self.blocks(len(y)):
            kernel = _kernel(x, y[rows], near[rows])
            integral[rows] = kernel @ rule if f.ndim == 1 else (kernel * rule[rows]).sum(axis=1)
        integral *= np.exp(-k * y)
        point, panel = np.nonzero(near)
        ξ = x.reshape(-1, self.nodes)[panel] - y[point][:, None]
        values = f.reshape(*f.shape[:-1], len(self.half), self.nodes)
        of_panel = values[panel] if f.ndim == 1 else values[point, panel]
        # The distance from the end at which two panels meet is the same number, and logarithms cancel.
        from_start, from_end = (y[point] - self.ends[panel + i] for i in (0, 1))
        Q = _second_kind(ζ[point, panel], from_start, from_end, self.nodes)
        coefficients = (of_panel * _without_pole(k, ξ)) @ legendre_panel(self.nodes)[2].T
        np.add.at(integral, point, -2.0 * np.einsum("ik,ik->i", coefficients, Q))
        # Beyond the panels f is that of the ends: two terms of a series.
        beyond = (0, k + δ, -self.reach - y, -np.exp(δ * y)), (1, 1.0 - k, y - self.reach, 1.0)
        for end, rate, ξ, factor in beyond:
            for power in (rate, rate + 1.0):
                integral = integral + factor * ends[..., end] * np.exp(power * ξ) / power
        return integral * np.exp(δ * log_beside(1.0 + np.exp(-y)))

    def hilbert_of_weight(self, x: NDArray) -> NDArray[np.float64]:
        """(1/π) ⨍ w(t)/(t - t(x)) dt over w at x, (len(x),); for exponents whose sum is -1 cot(πα)."""
        wide = Panels(self.α, self.β, _LONGEST_OF_WEIGHT, reach=2.0 * self.reach)
        return np.asarray(wide.cauchy(np.ones(len(wide.x)), x) / np.pi)

    # As functions of an :class:`.pressure.Expansion`, whose coefficients are values at the points.

    def sum(self, c: NDArray, r: NDArray) -> NDArray[np.float64]:
        p = self.interpolated(c.T, stretched(r))
        return np.moveaxis(p, -1, 0) if c.ndim > 1 else p

    def rest(self, p: NDArray, r: NDArray, near: float) -> NDArray[np.float64]:
        """Hilbert transform without that of the weight, see :meth:`.pressure.Pressure.rest`."""
        values, under = np.empty(len(r)), np.abs(r) < 1.0
        values[~under] = (self.weights * p / (self.t - r[~under, None])).sum(axis=1)
        x = stretched(r[under])
        values[under] = self.weight(x) * self.cauchy(p - self.interpolated(p, x)[:, None], x)
        return values / np.pi

    def integral(
        self, p: NDArray, kernel: Callable[[NDArray], NDArray], r: NDArray, length: float
    ) -> NDArray[np.float64]:
        """Integrals with a kernel, see :meth:`.pressure.Pressure.integral`."""
        under = (np.abs(r) < 1.0) & self.rough
        beside = summed(kernel, r[~under], *self.points(p, np.inf if self.rough else PER_LENGTH * length))
        integrals = np.empty((len(r), beside.shape[-1]))
        integrals[~under] = beside
        places = np.flatnonzero(under)
        for block in self.blocks(len(places), _ROWS):
            at = places[block]
            integrals[at] = p @ self._graded_rows(kernel, stretched(r[at]))
        return integrals

    def points(self, p: NDArray, finest: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Rule for other integrals, see :meth:`.pressure.Pressure.points`."""
        if finest >= self.finest:
            return self.t, self.weights * p
        fine = replace(self, finest=finest)
        return fine.t, fine.weights * self.interpolated(p, fine.x)

    def continued(
        self, p: NDArray, free: tuple[bool, bool], lengths: tuple[float, float] = (1.0, 1.0)
    ) -> NDArray[np.float64]:
        """Values that fall to zero at free ends, left and right, like d and d log d.

        Nearer to an end than ``_MENDED`` a fit of such terms replaces p; the equation, which is weighted
        there as edges need it, resolves p only relative to the largest p. Distances d from an end are
        over the length over which the pressure varies there.
        """
        continued = p.copy()
        for end in np.flatnonzero(free).tolist():
            d = 2.0 / (1.0 + np.exp((2 * end - 1) * self.x)) / min(lengths[end], self.length)
            fitted, near = (d > _MENDED) & (d < _KNOWN), d <= _MENDED
            c, *_ = np.linalg.lstsq(_to_end(d[fitted]), p[fitted] / d[fitted], rcond=None)
            continued[near] = d[near] * (_to_end(d[near]) @ c)
        return continued


def summed(
    kernel: Callable[[NDArray], NDArray], r: NDArray, t: NDArray, forces: NDArray
) -> NDArray[np.float64]:
    """Σ kernel(r - t) forces over t, (len(r), functions); kernels of few positions are held at once."""
    return np.concatenate(
        [
            np.einsum("rtf,t->rf", kernel(block[:, None] - t), forces)
            for block in np.array_split(r, len(r) * len(t) // _TOGETHER + 1)
        ]
    )


def _to_end(d: NDArray) -> NDArray[np.float64]:
    """Terms of a pressure over its weight and d at distances d from a free end, (len(d), terms)."""
    log = np.log(d)
    return np.column_stack([np.ones_like(d), log, d, d * log, d * log**2, d**2, d**2 * log])


def _kernel(x: NDArray, y: NDArray, left_out: NDArray) -> NDArray[Any]:
    """1/(e^ξ - 1), ξ = x - y, (points, n), but 0 on panels that are left out, (points, panels)."""
    with np.errstate(divide="ignore", invalid="ignore"):
        rest = np.exp(x) * np.exp(-y)[:, None] - 1.0
        kernel = 1.0 / rest
    close = np.flatnonzero(np.abs(rest.real) < _CLOSE)
    close = close[np.abs(rest.ravel()[close]) < _CLOSE]
    point, node = np.divmod(close, len(x))
    ξ = x[node] - y[point]
    of = ξ * ξ
    with np.errstate(divide="ignore", invalid="ignore"):
        # Bernoulli's series next to the pole.
        series = ξ * (1 / 12 - of * (1 / 720 - of * (1 / 30240 - of / 1209600)))
        kernel[point, node] = 1.0 / ξ - 0.5 + series
    kernel.reshape(*left_out.shape, -1)[left_out] = 0.0
    return kernel


def _without_pole(k: float, ξ: NDArray) -> NDArray[Any]:
    """Smooth factor e^(kξ) ξ/(e^ξ - 1) of 1/ξ."""
    small = np.abs(ξ) < 1e-3
    safe = np.where(small, 1.0, ξ)
    ratio = np.where(small, 1.0 - ξ / 2.0 + ξ**2 / 12.0 - ξ**4 / 720.0, safe / np.expm1(safe))
    return np.exp(k * ξ) * ratio


@lru_cache(maxsize=1024)
def _graded(steps: int, varied: int, nodes: int) -> tuple[NDArray[np.float64], ...]:
    """Rule on (0, 1) in steps that get shorter towards 0, where the kernel may have a logarithm.

    Args:
        steps: number of steps but for the last.
        varied: steps down to the length over which the kernel varies; shorter ones weigh the less.
        nodes: number of a panel's points.

    Returns:
        Points and weights, (points,) each, and the polynomials through a panel's points, (points, nodes).
    """
    s, ds, end = [], [], 1.0
    for step in range(steps + 1):
        count = max(_POINTS - int(_FEWER * max(step - varied, 0)), 2)
        start = end * _GRADING if step < steps else 0.0
        ξ, ω, _ = legendre_panel(count)
        s.append((start + end + (end - start) * ξ) / 2.0)
        ds.append((end - start) / 2.0 * ω)
        end = start
    points = np.concatenate(s)
    _, _, to_legendre = legendre_panel(nodes)
    return points, np.concatenate(ds), legendre.legvander(2.0 * points - 1.0, nodes - 1) @ to_legendre


#: Least distance in x from the end of a panel in its logarithm.
_LEAST_APART = 1e-10


def _second_kind(ζ: NDArray, from_start: NDArray, from_end: NDArray, count: int) -> NDArray[Any]:
    """Legendre's functions of the second kind Q_k(ζ), (n, count).

    ∫ P_k(τ)/(τ - ζ) dτ = -2 Q_k, principal values for real ζ.

    Args:
        ζ: in a panel's own coordinate, (n,).
        from_start, from_end: distances from its ends, (n,).
        count: number of functions.
    """
    # Two panels' logarithms cancel as far as f is continuous from one to the other: what is left of them
    # where they meet is the jump times that of the least distance.
    start, end = (np.where(np.abs(d) < _LEAST_APART, _LEAST_APART, d) for d in (from_start, from_end))
    first = 0.5 * np.log(start / end if np.iscomplexobj(ζ) else np.abs(start / end))
    Q = [first, ζ * first - 1.0]
    for k in range(1, count - 1):
        Q.append(((2 * k + 1) * ζ * Q[k] - k * Q[k - 1]) / (k + 1))
    return np.stack(Q, axis=-1)


def panels_of_slope(a: float, kinks: Sequence[float], rough: bool) -> Panels:
    """Panels for integrals of a slope over the weight of a pressure between free ends.

    Args:
        a: exponent of the pressure at the right end.
        kinks: places over the half-width at which the slope or its derivative jumps.
        rough: True if the slope beside them is a power that is not smooth.
    """
    steps = _STEPS_OF_SLOPES if rough else -1
    return Panels(
        -a, a - 1.0, _SLOPES, tuple(kinks), steps, _TO_KINK_OF_SLOPES, _REACH_OF_SLOPES, _OF_SLOPES
    )
