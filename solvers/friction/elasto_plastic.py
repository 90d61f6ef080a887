"""The elasto-plastic law of friction."""

from dataclasses import dataclass
from functools import lru_cache
from typing import ClassVar

import numpy as np
from numpy.polynomial.legendre import leggauss
from numpy.typing import NDArray

from ..approximation import inverted
from ..parameters import parameter
from .law import LAWS
from .lugre import Bristles

#: Width in y of a panel of Gauss's rule; y beyond that of breakaway squared from which on slip is y and a
#: constant to the last digit; y at which e^-y is still a number; panels that a step tries at once.
_WIDTH, _FAR, _LAST, _AT_ONCE = 1.0, 40.0, 700.0, 8
#: Deflections, evenly spaced, at which friction is looked at from breakaway to steady sliding.
_DEFLECTIONS = 32
#: Gauss's rule of a panel.
_NODES, _WEIGHTS = leggauss(16)


@dataclass(frozen=True, kw_only=True)
class ElastoPlastic(Bristles):
    """The elasto-plastic law: LuGre's bristles, which do not slip before they break away::

        ż = v (1 - α(z, v) σ₀ z sgn(v)/g(v)),   f = σ₀ z + σ₁ ż + σ₂ v

    With ζ = σ₀ |z|/g, α = 0 up to the breakaway ratio r and where z and v differ in sign, 1 from ζ = 1
    on, and between (1 + sin(π (ζ - (1+r)/2)/(1-r)))/2. So loads below breakaway do not let it drift.
    (P. Dupont, V. Hayward, B. Armstrong, F. Altpeter, IEEE Transactions on Automatic Control 47 (2002)
    787.) Its state is σ₀ z/N.

    At constant speed w = s σ₀ z/g obeys dw/dx = 1 - α w in x = σ₀ d/g: a straight line up to r, an
    exponential beyond 1, and between an integral of 1/(1 - α w), the same for all slips and stiffnesses.

    Raises:
        ValueError: a parameter is outside its range.
    """

    about: ClassVar[str] = "the elasto-plastic law"
    batched: ClassVar[bool] = True

    r: float = parameter(
        "breakaway_ratio", "deflection at breakaway over that of steady sliding", symbol="r",
        above=0.0, below=1.0, default=0.7,
    )  # fmt: skip

    def rate(self, z: NDArray, s: int, V: float) -> NDArray[np.float64]:
        """d(σ₀ z)/dd [1/m]."""
        ζ = s * z / self.g(V)
        return s * self.σ0 * (1.0 - np.sin(0.5 * np.pi * self._between(ζ)) ** 2 * ζ)

    def _between(self, w: NDArray) -> NDArray[np.float64]:
        """Position of w between breakaway and steady sliding, 0 to 1; constant beyond."""
        return np.minimum(np.maximum((w - self.r) / (1.0 - self.r), 0.0), 1.0)

    def switches(self, z: NDArray, s: int, V: float) -> NDArray[np.float64]:
        """Zero at breakaway, (1,)."""
        return s * z / self.g(V) - self.r

    def kinks(self, z: NDArray, s: int, V: float) -> NDArray[np.float64]:
        """Slips of breakaway and soon after, while damping ceases; none of a stroke that begins later."""
        w0 = float(s * z[0] / self.g(V))
        if w0 >= self.r:
            return np.zeros(0)
        w = np.linspace(self.r, 1.0, _DEFLECTIONS, endpoint=False)
        return self.g(V) / self.σ0 * (self.r - w0 + _yielding(self.r).slip(w))

    def exact(self, z: NDArray, s: int, V: float, slip: NDArray) -> NDArray[np.float64]:
        (ζ0, w0, x), steady = self._scaled(z, s, V, slip), s * self.g(V)
        straight = ζ0 + s * self.σ0 * np.asarray(slip, dtype=float)
        decayed = ζ0 + (ζ0 - steady) * np.expm1(-x)
        yielding = -steady * np.expm1(-self._yielded(w0, x))
        ζ = np.where(w0 >= 1.0, decayed, np.where(x <= self.r - w0, straight, yielding))
        return np.where(x == 0.0, ζ0, ζ)[..., None]

    def _yielded(self, w0: NDArray, x: NDArray) -> NDArray[np.float64]:
        """Coordinate y of :class:`_Yielding` after slips x from w0; anything where w0 >= 1."""
        x, w = x - np.maximum(self.r - w0, 0.0), np.where(w0 < 1.0, np.maximum(w0, self.r), self.r)
        if np.ndim(self.r) == 0:
            return _yielding(float(self.r)).after(x, w)
        return _stepped(x, w, np.asarray(self.r))

    def work(self, z: NDArray, s: int, V: float, slip: NDArray) -> NDArray[np.float64]:
        """∫ s (σ₀ z + σ₁ ż + σ₂ v) dd, with ∫ w dx in its three parts."""
        _, start, x = self._scaled(z, s, V, slip)
        w0 = float(start)
        if w0 >= 1.0:
            area = x - (w0 - 1.0) * np.expm1(-x)
        else:
            stuck = np.clip(self.r - w0, 0.0, x)
            yielded, first = x - stuck, max(w0, self.r)
            short = _yielding(self.r).short(yielded, first)
            area = stuck * (w0 + 0.5 * stuck) + yielded - np.where(yielded > 0.0, short, 0.0)
        built = self.exact(z, s, V, slip)[:, 0] - z[..., 0]
        bristles = self.g(V) ** 2 / self.σ0 * area
        return bristles + s * self.σ1 * V / self.σ0 * built + self.σ2 * V * np.asarray(slip)

    def slope(self, z: NDArray, s: int, V: float) -> NDArray[np.float64]:
        g = self.g(V)
        w = s * z[..., 0] / g
        between = self._between(w)
        α = np.sin(0.5 * np.pi * between) ** 2
        steeper = 0.5 * np.pi / (1.0 - self.r) * np.sin(np.pi * between)
        return s * self.rate(z[..., 0], s, V) * (1.0 - V * self.σ1 / g * (α + w * steeper))

    def _scaled(self, z: NDArray, s: int, V: float, slip: NDArray) -> tuple[NDArray, NDArray, NDArray]:
        """σ₀ z/N and w at the start, and slips x."""
        ζ0, g = z[..., 0], self.g(V)
        return ζ0, s * ζ0 / g, self.σ0 / g * np.asarray(slip, dtype=float)


def _slopes(y: NDArray, r: float | NDArray) -> NDArray[np.float64]:
    """dx/dy from breakaway to steady sliding, by y = -ln(1 - w), which grows with slip without end.

    With ε = 1 - w = e^-y and θ = π ε/(2(1 - r)), α is cos²θ, so that dx/dy = 1/(sin²θ/ε + cos²θ): smooth,
    and 1 in the end.
    """
    ε = np.exp(-np.minimum(y, _LAST))
    rising = np.sin(ε * (0.5 * np.pi / (1.0 - r))) ** 2 / ε
    return 1.0 / (1.0 + rising * (1.0 - ε))


def _nodes(start: NDArray, end: NDArray) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Half of the length between two y, (..., 1), and the nodes of Gauss's rule there, (..., n)."""
    half = 0.5 * (end - start)[..., None]
    return half, start[..., None] + half * (1.0 + _NODES)


def _stepped(x: NDArray, w: NDArray, r: NDArray) -> NDArray[np.float64]:
    """Coordinates y of many laws after a few slips x from w, panel after panel, (laws, slips).

    Tables for each law, as :class:`_Yielding` has them, take longer: a fit tries thousands of laws.

    Args:
        x: slips; x < 0 counts as none.
        w: r <= w < 1 at their start.
        r: breakaway ratios, (laws, 1).
    """
    left, y, far = np.maximum(x, 0.0), -np.log1p(-w), _FAR - np.log1p(-r)

    def slip(start: NDArray, end: NDArray) -> NDArray[np.float64]:
        half, nodes = _nodes(start, end)
        return (half * _slopes(nodes, np.reshape(r, (-1, *[1] * start.ndim)))) @ _WEIGHTS

    while True:
        starts = y[..., None] + _WIDTH * np.arange(_AT_ONCE)
        slips = np.cumsum(slip(starts, starts + _WIDTH), axis=-1)
        passed = slips < left[..., None]
        count = passed.sum(axis=-1)
        left, y = left - np.where(passed, slips, 0.0).max(axis=-1), y + _WIDTH * count
        if not ((count == _AT_ONCE) & (y < far)).any():
            break
    in_panel = np.minimum(left, _WIDTH)
    start = y + np.minimum(in_panel / _slopes(y + 0.5 * in_panel, r), _WIDTH)
    end = inverted(lambda end: (slip(y, end), _slopes(end, r)), in_panel, start, y, y + _WIDTH)
    return np.where(y < far, end, y + left)


class _Yielding:
    """Sliding from breakaway to steady sliding, by y = -ln(1 - w), which grows with slip without end.

    Args:
        r: breakaway ratio.
    """

    def __init__(self, r: float) -> None:
        self._r, self._first = r, -np.log1p(-r)
        count = int(np.ceil((self._first + _FAR) / _WIDTH))
        self._y = self._first + _WIDTH * np.arange(count + 1)
        pieces = self._pieces(self._y[:-1], self._y[1:])
        self._x, self._short = np.hstack([np.zeros((2, 1)), np.cumsum(pieces, axis=1)])
        from scipy.interpolate import CubicHermiteSpline  # a slow import

        self._near = CubicHermiteSpline(self._x, self._y, 1.0 / _slopes(self._y, r))

    def after(self, x: NDArray, w: float | NDArray) -> NDArray[np.float64]:
        """Coordinate y after slips x from w, r <= w < 1; x < 0 counts as none."""
        target = self.slip(np.asarray(w)) + np.maximum(x, 0.0)
        y = self._near(np.minimum(target, self._x[-1])) + np.maximum(target - self._x[-1], 0.0)
        return inverted(lambda y: (self._at(y)[0], _slopes(y, self._r)), target, y, self._first)

    def slip(self, w: NDArray) -> NDArray[np.float64]:
        """Slips from breakaway to w, r <= w < 1."""
        return self._at(-np.log1p(-w))[0]

    def short(self, x: NDArray, w: float) -> NDArray[np.float64]:
        """∫ (1 - w) dx over slips x from w."""
        start = np.array([-np.log1p(-w)])
        return self._at(self.after(x, w))[1] - self._at(start)[1]

    def _at(self, y: NDArray) -> NDArray[np.float64]:
        """Slip, and ∫ (1 - w) dx, from breakaway to y (...): (2, ...)."""
        panel = np.clip(np.searchsorted(self._y, y, side="right") - 1, 0, len(self._y) - 2)
        near = np.minimum(y, self._y[-1])
        x, short = self._pieces(self._y[panel], near)
        beyond = y - near
        short_beyond = np.exp(-near) * -np.expm1(-beyond)
        return np.array([self._x[panel] + x + beyond, self._short[panel] + short + short_beyond])

    def _pieces(self, start: NDArray, end: NDArray) -> NDArray[np.float64]:
        """Slip, and ∫ (1 - w) dx, from y to y in the same panel, (...) each: (2, ...)."""
        half, y = _nodes(start, end)
        x = _slopes(y, self._r)
        return np.array([((half * x) @ _WEIGHTS), ((half * x * np.exp(-y)) @ _WEIGHTS)])


@lru_cache(maxsize=64)
def _yielding(r: float) -> _Yielding:
    return _Yielding(r)


LAWS.register("elasto_plastic", ElastoPlastic)
