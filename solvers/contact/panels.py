"""Pressure under any slope of a contact with two free ends, by quadrature in panels.

With f = μ v,X under the punch over the contact [-1, 1], w = (1 - s)^a (1 + s)^b, a + b = 1, and
N̂ = n + g n₁₂ the potential of the pressure that vanishes at both ends is

    Φ(z) = -(sin πa/(π N̂)) X(z) ∫ f(t)/(w(t) (t - z)) dt,     X = (z - 1)^a (z + 1)^b.

In the coordinate x = log((1 - t)/(1 + t)), which resolves both ends alike, this is a convolution,

    Φ = -(sin πa/(π N̂)) e^(-iπa) T(y),   T(y) = ∫ f e^(b ξ)/(1 - e^ξ) dx,   ξ = x - y,

y = log((1 - z)/(1 + z)), 0 < Im y <= π below the surface. Panels end where the slope or its derivative
jumps; in one that is near y the smooth rest of the integrand is a sum of Legendre polynomials, whose
Cauchy integrals are Legendre's functions of the second kind.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..approximation import legendre_panel
from .pressure import Pressure

#: Gauss points of a panel, their weights, and from values there to coefficients of Legendre polynomials.
_NODES = 20
_τ, _w, _TO_LEGENDRE = legendre_panel(_NODES)

#: Longest panel; |x| beyond which f is that of the end and the integral is exact; grading next to a place
#: where the slope is not smooth, and its steps.
_LONGEST, _REACH, _GRADING, _STEPS = 2.0, 40.0, 0.5, 46

#: Size of Bernstein's ellipse through y from which Gauss's rule alone serves a panel.
_NEAR = 2.4

#: |y| beyond which exponentials would overflow; |1 - e^ξ| below which it is formed without cancellation.
_FAR, _CLOSE = 200.0, 0.1

#: Kernels at once: these and what becomes of them stay in a core's cache.
_AT_ONCE = 20_000

#: Distance from a cusp of the pressure that counts as none, and that from which it is extrapolated.
_AT_CUSP, _BESIDE_CUSP = 1e-12, 1e-7


def ends_of_panels(kinks: NDArray, rough: bool) -> NDArray[np.float64]:
    """Ends of the panels in x, growing, (panels + 1,).

    Args:
        kinks: positions in (-1, 1) at which the slope or its derivative jumps.
        rough: True if the slope beside them is a power that is not smooth.
    """
    inside = kinks[np.abs(kinks) < 1.0]
    at = np.sort(np.log1p(-inside) - np.log1p(inside))
    at = at[np.abs(at) < _REACH]
    if rough:
        steps = _GRADING ** np.arange(_STEPS)
        at = np.concatenate([at, *(x + np.concatenate([-steps, steps]) for x in at)])
    fixed = np.unique(np.concatenate([[-_REACH, _REACH], at]))
    gaps = np.diff(fixed)
    count = np.ceil(gaps / _LONGEST).astype(int)
    number = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
    starts = np.repeat(fixed[:-1], count) + number * np.repeat(gaps / count, count)
    return np.append(starts, _REACH)


@dataclass(frozen=True)
class Panels:
    """Quadrature over the contact, in panels of x = log((1 - t)/(1 + t)).

    Attributes:
        a: exponent of w at the right end, in (0, 1).
        ends: ends of the panels in x, (panels + 1,).
    """

    a: float
    ends: NDArray[np.float64]

    @property
    def b(self) -> float:
        return 1.0 - self.a

    @cached_property
    def middle(self) -> NDArray[np.float64]:
        return (self.ends[1:] + self.ends[:-1]) / 2.0

    @cached_property
    def half(self) -> NDArray[np.float64]:
        return np.diff(self.ends) / 2.0

    @cached_property
    def x(self) -> NDArray[np.float64]:
        """Gauss points, (panels, nodes)."""
        return self.middle[:, None] + self.half[:, None] * _τ

    @cached_property
    def t(self) -> NDArray[np.float64]:
        """Positions in the contact, with both ends as the last two: (panels·nodes + 2,)."""
        return np.append(-np.tanh(self.x / 2.0).ravel(), [1.0, -1.0])

    @cached_property
    def weights(self) -> NDArray[np.float64]:
        """Weights of ∫ F(t)/w(t) dt = Σ weights·F, F at :attr:`t`, (panels·nodes + 2,)."""
        density = np.exp(self.b * self.x - np.logaddexp(0.0, self.x))
        inner = self.half[:, None] * _w * density
        tails = np.exp(-_REACH * np.array([self.b, self.a])) / [self.b, self.a]
        return np.append(inner.ravel(), tails)

    def transform(self, f: NDArray, y: NDArray) -> NDArray[Any]:
        """Transform T(y), (points,); a principal value where y is real.

        Args:
            f: values at :attr:`t`, (n,), or (points, n) if f differs from y to y.
            y: (points,).
        """
        ζ = (y[:, None] - self.middle) / self.half
        root = np.sqrt((ζ - 1.0).astype(complex)) * np.sqrt((ζ + 1.0).astype(complex))
        near = np.abs(ζ + root) < _NEAR
        rule = f[..., :-2] * (np.exp(self.b * self.x) * self.half[:, None] * _w).ravel()
        integral = np.concatenate([
            _sums(self.b, self.x, y[of], near[of], rule if f.ndim == 1 else rule[of])
            for of in _blocks(len(y), self.x.size)
        ])  # fmt: skip
        point, panel = np.nonzero(near)
        ξ = self.x[panel] - y[point][:, None]
        smooth = _smooth(self.b, ξ)
        values = f[..., :-2].reshape(*f.shape[:-1], *self.x.shape)
        of_panel = values[panel] if f.ndim == 1 else values[point, panel]
        # The distance from the end at which two panels meet is the same number, and logarithms cancel.
        from_start, from_end = (y[point] - self.ends[panel + i] for i in (0, 1))
        Q = _second_kind(ζ[point, panel], from_start, from_end)
        near_part = -2.0 * np.einsum("ik,ik->i", (of_panel * smooth) @ _TO_LEGENDRE.T, Q)
        np.add.at(integral := integral.astype(np.result_type(integral, near_part)), point, near_part)
        # Beyond the panels f is that of the ends: two terms of a series.
        for value, rate, ξ, sign in (
            (f[..., -2], self.b, -_REACH - y, 1.0), (f[..., -1], self.a, y - _REACH, -1.0)
        ):  # fmt: skip
            for k in (rate, rate + 1.0):
                integral = integral + sign * value * np.exp(k * ξ) / k
        return integral


def _blocks(points: int, nodes: int) -> list[slice]:
    """Parts of so many points, at least one, each with about :data:`_AT_ONCE` kernels."""
    step = max(_AT_ONCE // nodes, 1)
    return [slice(start, start + step) for start in range(0, max(points, 1), step)]


def _sums(b: float, x: NDArray, y: NDArray, near: NDArray, rule: NDArray) -> NDArray[Any]:
    """Sums of :func:`_kernel` at x - y over the panels that are not near, (points,).

    Args:
        b: exponent of the kernel.
        x: Gauss points, (panels, nodes).
        y: (points,).
        near: panels that are left out, (points, panels).
        rule: weights times values times e^(bx), (panels·nodes,) or (points, panels·nodes).
    """
    far = np.abs(y.real) > _FAR
    at = np.where(far, 0.0, y)
    with np.errstate(divide="ignore", invalid="ignore"):
        rest = 1.0 - np.exp(x) * np.exp(-at)[:, None, None]
        factor = 1.0 / rest
        close = (rest.real**2 + rest.imag**2 < _CLOSE**2) & ~near[..., None]
        point, *node = np.nonzero(close)
        factor[close] = _pole(x[tuple(node)] - y[point])
    kernel = factor  # times e^(bξ)
    kernel[far] = _kernel(b, x - y[far, None, None]) * np.exp(-b * x)
    kernel[near] = 0.0
    of_point = "j" if rule.ndim == 1 else "ij"
    sums = np.einsum(f"ij,{of_point}->i", kernel.reshape(len(y), x.size), rule)
    return np.where(far, 1.0, np.exp(-b * at)) * sums


def _pole(ξ: NDArray) -> NDArray[Any]:
    """1/(1 - e^ξ) next to its pole, |ξ| about :data:`_CLOSE` at most: Bernoulli's series."""
    of = ξ * ξ
    return 0.5 - 1.0 / ξ - ξ * (1 / 12 - of * (1 / 720 - of * (1 / 30240 - of / 1209600)))


def _kernel(b: float, ξ: NDArray) -> NDArray[Any]:
    """Kernel e^(bξ)/(1 - e^ξ), stable for every ξ."""
    lower = ξ.real < 0.0
    falling = np.where(lower, ξ, -ξ)
    # For ξ > 0: -e^(-(1 - b) ξ)/(1 - e^(-ξ)).
    return np.where(lower, -1.0, 1.0) * np.exp(np.where(lower, b, 1.0 - b) * falling) / np.expm1(falling)


def _smooth(b: float, ξ: NDArray) -> NDArray[Any]:
    """Smooth factor of 1/ξ in the kernel."""
    small = np.abs(ξ) < 1e-3
    safe = np.where(small, 1.0, ξ)
    ratio = np.where(small, 1.0 - ξ / 2.0 + ξ**2 / 12.0 - ξ**4 / 720.0, safe / np.expm1(safe))
    return -np.exp(b * ξ) * ratio


def _second_kind(ζ: NDArray, from_start: NDArray, from_end: NDArray) -> NDArray[Any]:
    """Legendre's functions of the second kind Q_k(ζ), (n, nodes).

    ∫ P_k(τ)/(τ - ζ) dτ = -2 Q_k, principal values for real ζ.

    Args:
        ζ: in a panel's own coordinate, (n,).
        from_start, from_end: distances from its ends, (n,).
    """
    ratio = _off(from_start) / _off(from_end)
    first = 0.5 * np.log(ratio if np.iscomplexobj(ζ) else np.abs(ratio))
    Q = [first, ζ * first - 1.0]
    for k in range(1, _NODES - 1):
        Q.append(((2 * k + 1) * ζ * Q[k] - k * Q[k - 1]) / (k + 1))
    return np.stack(Q, axis=-1)


def _off(distance: NDArray) -> NDArray[Any]:
    """Distances from a panel's end, none 0: infinite logarithms of two panels would not cancel."""
    return np.where(np.abs(distance) < 1e-300, 1e-300, distance)


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
        return self.panels.a

    @property
    def β(self) -> float:  # type: ignore[override]
        """Exponent at the left end, positive."""
        return self.panels.b

    @property
    def _factor(self) -> float:
        return float(np.sin(np.pi * self.panels.a) / (np.pi * self.n))

    def series(self, r: NDArray) -> NDArray[np.float64]:
        p, inside = np.zeros(np.shape(r)), np.abs(r) < 1.0
        at = r[inside]
        f = self.slope(at)
        # Without f(r) nothing cancels towards the ends.
        T = self.panels.transform(self.f - f[:, None], np.log1p(-at) - np.log1p(at))
        stress = -self._factor * np.sin(np.pi * self.panels.a) * T
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
        value = self._phase * self.panels.transform(self.f, _logarithm(flat))
        return value.reshape(np.shape(z))

    @property
    def _phase(self) -> complex:
        return complex(-self._factor * np.exp(-1j * np.pi * self.panels.a))


def _logarithm(z: NDArray) -> NDArray[np.complex128]:
    """Coordinate y = log((1 - z)/(1 + z)), 0 < Im y <= π below the surface and beside the contact."""
    y = np.log((1.0 - z) / (1.0 + z))
    return y.real + 1j * (y.imag % (2.0 * np.pi))
