"""Pressures over solids that are graded from the surface on, by panels in x = log((1 + t)/(1 - t)).

There the kernel has a logarithm and a jump, and towards both ends the pressure without its weight has
terms like (1 - t) log(1 - t), which no polynomial follows. In x both ends lie at infinity and all is
smooth. With p the pressure without its weight w the dominant part of the equation is regular,

    (n̂/π) ∫ w(t) (p(t) - p(r))/(t - r) dt,

for what p(r) alone contributes is what the exponents make vanish.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from ..approximation import legendre_panel
from .pressure import Expansion, Functions

#: Points of a panel; matrices from values there to coefficients of Legendre polynomials, and to slopes.
_NODES = 14
_τ, _w, _TO_LEGENDRE = legendre_panel(_NODES)
_DERIVATIVE = (
    np.stack([legendre.legval(_τ, legendre.legder(row)) for row in np.eye(_NODES)], axis=1) @ _TO_LEGENDRE
)
#: |x| beyond which the pressure is that at the ends; longest panels up to some |x|.
_REACH, _LONGEST = 26.0, ((8.0, 2.0), (15.0, 3.5), (np.inf, 6.0))
#: Panels towards a kink: their grading, and their number where the pressure itself is infinite or has a
#: cusp, and where only the pressure that layers add is resolved.
_TO_KINK, _TO_TIP, TO_BEND = 0.2, 18, 5
#: Panels towards a place where a kernel is rough: their grading and number; distance over a panel's
#: length within which a place is near it.
_GRADING, _STEPS, _NEAR = 0.2, 22, 1.0
#: Distance from a free end within which a pressure is continued, and up to which it is fitted for that.
_MENDED, _KNOWN = 1e-4, 1e-2
_ξ, _ω = legendre.leggauss(14)


@lru_cache(maxsize=16)
def ends_of_panels(
    finest: float, kinks: tuple[float, ...] = (), steps: int = _TO_TIP
) -> NDArray[np.float64]:
    """Ends of panels in x, (panels + 1,).

    No panel is longer than ``finest`` in t, nor than ``finest`` times the usual length in x.

    Args:
        finest: longest panel.
        kinks: places in t towards which panels get shorter.
        steps: number of panels that do, to either side.
    """
    half = [0.0]
    while half[-1] < _REACH - 1e-9:
        half.append(min(half[-1] + float(_longest(half[-1], finest)), _REACH))
    ends = np.concatenate([-np.array(half[:0:-1]), half])
    at = _x(np.array(kinks, dtype=float))
    at = at[np.abs(at) < _REACH]
    if not len(at):
        return ends
    towards = np.append(_TO_KINK ** np.arange(steps + 1), 0.0)
    graded = (at[:, None] + np.concatenate([-towards, towards])).ravel()
    others = ends[np.abs(ends[:, None] - at).min(axis=1) > 1.0]
    ends = np.unique(np.concatenate([others, graded[np.abs(graded) < _REACH], [-_REACH, _REACH]]))
    while True:
        middle = (ends[1:] + ends[:-1]) / 2.0
        long = np.diff(ends) > 1.5 * _longest(middle, finest)
        if not long.any():
            return ends
        ends = np.sort(np.append(ends, middle[long]))


def _longest(x: Any, finest: float) -> NDArray[np.float64]:
    """Longest panel in x at places x, with the shape of x."""
    limits, lengths = np.array(_LONGEST).T
    longest = lengths[np.searchsorted(limits, np.abs(x), side="right")]
    return np.asarray(np.minimum(finest * longest, 2.0 * finest * np.cosh(np.abs(x) / 2.0) ** 2))


@dataclass(frozen=True)
class Panels(Functions):
    """Rule on panels for integrals with the weight (1 - t)^α (1 + t)^β.

    Attributes:
        α, β: exponents; their sum is -1 where a pressure has edges, and 1 where it has free ends.
        finest: longest panel in t.
        kinks: places in t towards which panels get shorter.
        steps: number of panels that do, to either side.
    """

    α: float
    β: float
    finest: float
    kinks: tuple[float, ...] = ()
    steps: int = _TO_TIP

    @cached_property
    def ends(self) -> NDArray[np.float64]:
        return ends_of_panels(self.finest, self.kinks, self.steps)

    @cached_property
    def half(self) -> NDArray[np.float64]:
        return np.diff(self.ends) / 2.0

    @cached_property
    def x(self) -> NDArray[np.float64]:
        """Points in x, (n,)."""
        return ((self.ends[1:] + self.ends[:-1])[:, None] / 2.0 + self.half[:, None] * _τ).ravel()

    @cached_property
    def t(self) -> NDArray[np.float64]:
        return np.tanh(self.x / 2.0)

    @cached_property
    def weights(self) -> NDArray[np.float64]:
        """Weights of integrals over t with (1 - t)^α (1 + t)^β, (n,); beyond the reach included."""
        weights = (self.half[:, None] * _w).ravel() * self.density(self.x)
        beyond = 2.0 / (1.0 + np.exp(_REACH))
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

    def apart(self, x: Any, δ: NDArray) -> NDArray[np.float64]:
        """t(x + δ) - t(x), to all digits."""
        return np.asarray(np.sinh(δ / 2.0) / (np.cosh(x / 2.0) * np.cosh((x + δ) / 2.0)))

    def panel(self, x: NDArray) -> NDArray[np.int64]:
        """Numbers of the panels in which positions x lie, with the shape of x."""
        return np.clip(np.searchsorted(self.ends, x) - 1, 0, len(self.half) - 1)

    def basis(self, x: NDArray, panel: int) -> NDArray[np.float64]:
        """Matrix from values at a panel's points to those at its places x, (len(x), nodes)."""
        middle = (self.ends[panel] + self.ends[panel + 1]) / 2.0
        return np.asarray(legendre.legvander((x - middle) / self.half[panel], _NODES - 1) @ _TO_LEGENDRE)

    def interpolated(self, p: NDArray, x: NDArray) -> NDArray[np.float64]:
        """Values at places x of functions p with values (n, ...) at the points, shape of x and (...)."""
        inside = np.clip(x, -_REACH, _REACH)
        values = np.empty((*inside.shape, *p.shape[1:]))
        panels = self.panel(inside)
        for panel in np.unique(panels).tolist():
            rows = panels == panel
            values[rows] = self.basis(inside[rows], panel) @ p[panel * _NODES : (panel + 1) * _NODES]
        return values

    @cached_property
    def derivative(self) -> NDArray[np.float64]:
        """Matrices from values in a panel to slopes dp/dt at its points, (panels, nodes, nodes)."""
        slope = 1.0 / (2.0 * np.cosh(self.x / 2.0) ** 2)
        return _DERIVATIVE / self.half[:, None, None] / slope.reshape(-1, _NODES, 1)

    def row(self, kernel: Callable[[NDArray], NDArray], x: float) -> NDArray[np.float64]:
        """Weights of values at the points in ∫ kernel(t(x) - t) w(t) … dt, (n, functions).

        The kernel may be rough where t = t(x).
        """
        away = -self.apart(x, self.x - x)
        away[away == 0.0] = 1.0  # the panels near x are replaced below
        by_rule = kernel(away)
        integrals = by_rule * self.weights[:, None]
        for panel, half in enumerate(self.half.tolist()):
            low, high = self.ends[panel], self.ends[panel + 1]
            if low - _NEAR * 2.0 * half <= x <= high + _NEAR * 2.0 * half:
                δ, weights = self._towards(x, float(low), float(high))
                places = x + δ
                values = kernel(-self.apart(x, δ)) * (weights * self.density(places))[:, None]
                near = slice(panel * _NODES, (panel + 1) * _NODES)
                beyond = self.weights[near] - half * _w * self.density(self.x[near])
                integrals[near] = self.basis(places, panel).T @ values
                integrals[near] += beyond[:, None] * by_rule[near]
        return np.asarray(integrals)

    @staticmethod
    def _towards(x: float, low: float, high: float) -> tuple[NDArray, NDArray]:
        """Distances from a place and weights on a panel, graded towards it or the nearer end."""
        steps = np.concatenate([[0.0], _GRADING ** np.arange(_STEPS, -1, -1.0)])
        middle, half = (steps[1:] + steps[:-1]) / 2.0, np.diff(steps) / 2.0
        s, ds = (middle[:, None] + half[:, None] * _ξ).ravel(), (half[:, None] * _ω).ravel()
        at = min(max(x, low), high)
        parts = [((at - x) + (end - at) * s, abs(end - at) * ds) for end in (low, high) if end != at]
        places, weights = (np.concatenate(numbers) for numbers in zip(*parts))
        return places, weights

    def pressure(self, p: NDArray) -> Expansion:
        """Pressure by its values over N/(2a) without its weight at the points, (n,)."""
        return Expansion(self.α, self.β, p, self)

    # As functions of an :class:`Expansion`, whose coefficients are values at the points.

    def sum(self, p: NDArray, r: NDArray) -> NDArray[np.float64]:
        return self.interpolated(p, _x(r))

    def rest(self, p: NDArray, r: NDArray, near: float) -> NDArray[np.float64]:
        """Hilbert transform without that of the weight, see :meth:`.pressure.Pressure.rest`."""
        values, under = np.empty(len(r)), np.abs(r) < 1.0
        values[~under] = (self.weights * p / (self.t - r[~under, None])).sum(axis=1)
        x = _x(r[under])
        x = np.where(np.abs(x[:, None] - self.x).min(axis=1) < 1e-7, x + 3e-7, x)
        difference = p - self.interpolated(p, x)[:, None]
        values[under] = (self.weights * difference / self.apart(x[:, None], self.x - x[:, None])).sum(
            axis=1
        )
        return values / np.pi

    def integral(
        self, p: NDArray, kernel: Callable[[NDArray], NDArray], r: NDArray
    ) -> NDArray[np.float64]:
        """Integrals with a kernel, see :meth:`.pressure.Pressure.integral`."""
        under = np.abs(r) < 1.0
        beside = np.einsum("rtf,t->rf", kernel(r[~under, None] - self.t), self.weights * p)
        integrals = np.empty((len(r), beside.shape[-1]))
        integrals[~under] = beside
        for i, x in zip(np.flatnonzero(under), _x(r[under]).tolist()):
            integrals[i] = p @ self.row(kernel, x)
        return integrals

    def points(self, p: NDArray, finest: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Rule for other integrals, see :meth:`.pressure.Pressure.points`."""
        fine = replace(self, finest=min(finest, self.finest))
        return fine.t, fine.weights * self.interpolated(p, fine.x)

    def continued(self, p: NDArray, free: tuple[bool, bool]) -> NDArray[np.float64]:
        """Values that fall to zero at free ends, left and right, like d and d log d.

        Nearer to an end than ``_MENDED`` a fit of such terms replaces p; the equation, which is weighted
        there as edges need it, resolves p only relative to the largest p.
        """
        continued = p.copy()
        for x in [side * self.x for side, is_free in zip((-1.0, 1.0), free) if is_free]:
            d = 2.0 / (1.0 + np.exp(x))
            fitted, near = (d > _MENDED) & (d < _KNOWN), d <= _MENDED
            c, *_ = np.linalg.lstsq(_to_end(d[fitted]), p[fitted] / d[fitted], rcond=None)
            continued[near] = d[near] * (_to_end(d[near]) @ c)
        return continued


def _to_end(d: NDArray) -> NDArray[np.float64]:
    """Terms of a pressure over its weight and d at distances d from a free end, (len(d), terms)."""
    log = np.log(d)
    return np.column_stack([np.ones_like(d), log, d, d * log, d * log**2, d**2, d**2 * log])


def _x(r: NDArray) -> NDArray[np.float64]:
    with np.errstate(divide="ignore"):
        return np.asarray(np.log1p(r) - np.log1p(-r))


def parts(
    equation: Any, finest: float, slopes: Sequence[Callable[[NDArray], NDArray]], loads: Sequence[float]
) -> tuple[Panels, NDArray[np.float64]]:
    """Panels, and pressures under several slopes with several resultants at their points.

    Args:
        equation: an :class:`galinx.solvers.contact.equation.Equation`.
        finest: longest panel in t.
        slopes: μ v,X under the punch over N/(2a) at given t.
        loads: ∫ σ_YY dr of each.

    Returns:
        The panels, and the values, (n, slopes).
    """
    panels = Panels(equation.α, equation.β, finest, equation.kinks, TO_BEND)
    n, count = equation.n, len(panels.x)
    apart = panels.apart(panels.x[:, None], panels.x - panels.x[:, None])
    np.fill_diagonal(apart, np.inf)
    A = n / np.pi * panels.weights / apart
    A -= np.diag(A.sum(axis=1))
    for panel, D in enumerate(panels.derivative):
        own = slice(panel * _NODES, (panel + 1) * _NODES)
        A[own, own] += n / np.pi * panels.weights[own, None] * D
    for i, x in enumerate(panels.x.tolist()):
        by_kernel = panels.row(equation.kernel, x)
        A[i] += by_kernel[:, 3] + equation.g * by_kernel[:, 2]
    scale = 1.0 / panels.weight(panels.x)
    A = np.vstack([A * scale[:, None], panels.weights])
    b = np.vstack([np.stack([slope(panels.t) * scale for slope in slopes], axis=-1), loads])
    p, *_ = np.linalg.lstsq(A, b, rcond=None)
    assert len(p) == count
    return panels, p
