"""Kernels of a layered half-plane: on its surface and at a depth, and the transforms behind them.

The kernel by which a layered half-plane differs from one of its surface's solid (:class:`Kernel`) is

    K(x) = (1/π) Re ∫₀^∞ ΔŶ(k) e^(ikx) dk,

four functions that do not depend on friction. ΔŶ falls exponentially under uniform layers. Where the
solid at the surface changes with the power p of the depth it falls like A/kᵖ: that part, with
(1 - e^(-kH))ᵐ/kᵖ for 1/kᵖ, is

    (1/π) Re A Γ(1-p) Σ_j (-1)^j (m over j) (jH - ix)^(p-1),

with -log(jH - ix) for Γ(1-p) (…)^(p-1) where p = 1: a logarithm and a jump at x = 0. The terms after the
first are smooth and tabulated with what is left of the integral.

Integrals (1/π) Re ∫₀^∞ f(k) e^(ikx) dk of functions that are smooth piece by piece (:class:`Transform`)
are taken on panels. There f is a sum of Legendre polynomials, whose integrals with e^(ikx) are spherical
Bessel functions: the panels depend on f alone, and any x costs the same. Functions that are evaluated
many times are tabulated by polynomials on panels, fine towards 0 (:class:`Table`).

Strain and tractions at a depth follow from the pressure on top (:class:`Level`). For the field e^(ikX)
the tractions t on top displace it by Z⁻¹ t/k; the field carried down to a depth has the stiffness Z of
what is below there. These transforms fall like e^(-k d): kernels in X follow, as regular as the depth d
allows.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from math import comb, gamma
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev
from numpy.polynomial.legendre import leggauss, legvander
from numpy.typing import NDArray

from ..approximation import legendre_panel
from ..errors import SolveError
from .layered import LayersAtSpeed
from .stiffness import Medium, Uniform, inverse

#: Gauss points of a panel, their weights, and the matrix from values to Legendre coefficients.
_NODES = 16
_τ, _w, _TO_LEGENDRE = legendre_panel(_NODES)
#: Number of last coefficients that estimate a panel's error; most panels, and rounds of halving them;
#: octaves that are taken at once.
_LAST, _MOST, _ROUNDS, _AT_ONCE = 3, 4000, 60, 9
#: Positions whose integrals are taken at once, in numbers held.
_TOGETHER = 400_000


@dataclass(frozen=True)
class Transform:
    """Integrals (1/π) Re ∫₀^∞ f(k) e^(ikx) dk of several functions f.

    Attributes:
        middle, half: middles and half-lengths of the panels, (panels,).
        coefficients: of Legendre polynomials, (panels, nodes, functions).
        error: of the integrals, estimated by the last coefficients and the last panel.
        size: integral of the largest |f|.
    """

    middle: NDArray[np.float64]
    half: NDArray[np.float64]
    coefficients: NDArray[np.complex128]
    error: float
    size: float

    def __call__(self, x: NDArray) -> NDArray[np.float64]:
        """The integrals at positions, (..., functions)."""
        flat = np.ravel(np.asarray(x, dtype=float))
        integrals = np.empty((len(flat), self.coefficients.shape[-1]))
        many = max(_TOGETHER // (len(self.half) * _NODES), 1)
        turned = self.coefficients * (2.0 * 1j ** np.arange(_NODES))[:, None]
        for first in range(0, len(flat), many):
            positions = flat[first : first + many]
            bessel = spherical_bessel(_NODES, np.outer(positions, self.half))
            phase = self.half * np.exp(1j * np.outer(positions, self.middle))
            weights = bessel * phase[..., None]
            integrals[first : first + many] = np.tensordot(weights, turned, 2).real / np.pi
        return integrals.reshape(*np.shape(x), -1)


def spherical_bessel(count: int, z: NDArray) -> NDArray[np.float64]:
    """j₀ … j_(count - 1) of real z, (..., count), to the last digits of the largest.

    Upwards where |z| is larger than the order; elsewhere by Gauss's rule for (-i)ⁿ/2 ∫ P_n(τ) e^(izτ) dτ
    over [-1, 1], whose two halves are alike.
    """
    bessel = np.empty((*z.shape, count))
    far = np.abs(z) > count
    safe = np.where(far, z, 1.0)
    bessel[..., 0] = np.sin(safe) / safe
    bessel[..., 1] = (bessel[..., 0] - np.cos(safe)) / safe
    for n in range(1, count - 1):
        bessel[..., n + 1] = (2 * n + 1) / safe * bessel[..., n] - bessel[..., n - 1]
    τ, w = (part[count:] for part in leggauss(2 * count))
    weights = w[:, None] * legvander(τ, count - 1) * (-1.0) ** (np.arange(count) // 2)
    angle = np.outer(z[~far], τ)
    near = np.empty((len(angle), count))
    near[:, 0::2], near[:, 1::2] = np.cos(angle) @ weights[:, 0::2], np.sin(angle) @ weights[:, 1::2]
    bessel[~far] = near
    return bessel


def transform(
    f: Callable[[NDArray], NDArray], first: float, tolerance: float, scale: float = 0.0
) -> Transform:
    """Transform of f, on panels on which f is resolved.

    Args:
        f: of wavenumbers (n,), gives (n, functions).
        first: end of the first panel; the others double, until f is small.
        tolerance: of the integrals over that of |f|, or over ``scale`` where that is larger.

    Raises:
        SolveError: f does not become small, or is not smooth.
    """
    edges = first * 2.0 ** np.arange(_AT_ONCE)
    waiting = list(pairwise([0.0, *edges]))
    done: list[tuple[float, float, NDArray, float]] = []
    for _ in range(_ROUNDS):
        halves, middles = (np.array([(b + sign * a) / 2.0 for a, b in waiting]) for sign in (-1.0, 1.0))
        values = f((middles[:, None] + halves[:, None] * _τ).ravel())
        if not np.isfinite(values).all():
            raise SolveError("the stiffness of the surface is not finite at some wavenumber")
        c = _TO_LEGENDRE @ values.reshape(len(waiting), _NODES, -1)
        tails = 2.0 * halves * np.abs(c[:, -_LAST:]).max(axis=(1, 2))
        done += zip(middles.tolist(), halves.tolist(), c, tails.tolist())
        wholes = [2.0 * half * np.abs(panel).max() for _, half, panel, _ in done]
        size = max(float(sum(wholes)), scale)
        rough = [tail > tolerance * size / 10.0 for *_, tail in done]
        last = edges[-1]
        end = sum(w for w, (middle, *_) in zip(wholes, done) if middle > last / 2.0)
        waiting = [
            side
            for (middle, half, *_), again in zip(done, rough)
            if again
            for side in ((middle - half, middle), (middle, middle + half))
        ]
        done = [panel for panel, again in zip(done, rough) if not again]
        if not waiting and end > tolerance * size / 10.0:
            edges = last * 2.0 ** np.arange(_AT_ONCE)
            waiting = list(pairwise(edges))
        if not waiting:
            middle, half, coefficients, tail = zip(*done)
            error = sum(tail) + end
            return Transform(np.array(middle), np.array(half), np.array(coefficients), error, size)
        if len(done) + len(waiting) > _MOST:
            break
    raise SolveError("the stiffness of the surface is no smooth function of the wavenumber")


#: Chebyshev nodes of a panel, and the matrix from values there to coefficients.
_x = np.cos(np.pi * (np.arange(_NODES) + 0.5) / _NODES)
_TO_CHEBYSHEV = np.linalg.inv(chebyshev.chebvander(_x, _NODES - 1))
#: Most panels of a table; size of those next to 0 over the finest that may be asked for.
_MOST_PANELS, _AT_0 = 6000, 1e-9


@dataclass(frozen=True)
class Table:
    """Functions tabulated by position.

    Attributes:
        ends: of the panels, rising, (panels + 1,).
        coefficients: of Chebyshev polynomials, (panels, nodes, functions).
        error: absolute, estimated by the last coefficients, and that of the functions.
    """

    ends: NDArray[np.float64]
    coefficients: NDArray[np.float64]
    error: float

    def __call__(self, x: NDArray) -> NDArray[np.float64]:
        """Values at positions, (..., functions)."""
        x = np.asarray(x, dtype=float)
        flat = x.ravel()
        panel = np.clip(np.searchsorted(self.ends, flat) - 1, 0, len(self.ends) - 2)
        # Panel by panel: to gather coefficients for every position would take longer than to use them.
        order = np.argsort(panel, kind="stable")
        flat, panel = flat[order], panel[order]
        start, end = self.ends[panel], self.ends[panel + 1]
        T = chebyshev.chebvander((2.0 * flat - start - end) / (end - start), _NODES - 1)
        of_panel, values = np.empty((2, len(flat), self.coefficients.shape[-1]))
        for i, j in pairwise(np.flatnonzero(np.diff(panel, prepend=-1, append=-1)).tolist()):
            np.matmul(T[i:j], self.coefficients[panel[i]], out=of_panel[i:j])
        values[order] = of_panel
        return values.reshape(*x.shape, values.shape[-1])


def tabulated(
    f: Callable[[NDArray], NDArray], first: float, finest: float, reach: float, accuracy: float,
    scale: float = 0.0, more: Callable[[NDArray], NDArray] = lambda x: np.zeros((*x.shape, 1)),
) -> Table:  # fmt: skip
    """Transform of f, tabulated by position over [-reach, reach].

    Args:
        f, first, scale: see :func:`transform`.
        finest: size of the panels next to 0, where it may be rough; the others double.
        reach: where the table ends.
        accuracy: of the transform and of the table, over the integral of |f|.
        more: functions of positions that are added to it, (..., functions).

    Raises:
        SolveError: f, or its transform, is not smooth.
    """
    integrals = transform(f, first, accuracy, scale)
    tolerance = accuracy * integrals.size / np.pi
    count = max(int(np.ceil(np.log2(reach / finest))), 0)
    right = np.append(0.0, reach * 0.5 ** np.arange(count, -1, -1.0))
    ends = np.concatenate([-right[:0:-1], right])
    waiting = np.column_stack([ends[:-1], ends[1:]])
    done: list[tuple[float, NDArray, float]] = []
    while len(waiting):
        middle, half = waiting.mean(axis=1), np.diff(waiting, axis=1)[:, 0] / 2.0
        x = middle[:, None] + half[:, None] * _x
        c = _TO_CHEBYSHEV @ (integrals(x) + more(x))
        tail = np.abs(c[:, -_LAST:]).max(axis=(1, 2))
        # A power of the distance is followed to where it weighs nothing, under any pressure d^(-1/2).
        at_0 = np.any(waiting == 0.0, axis=1)
        good = (tail <= tolerance) | (half <= finest * np.where(at_0, _AT_0, 1.0 / 1024.0))
        tail[at_0] *= np.minimum(half[at_0], 1.0) ** 0.5
        done += zip(waiting[good, 0].tolist(), c[good], tail[good].tolist())
        (low, high), middle = waiting[~good].T, middle[~good]
        waiting = np.column_stack([low, middle, middle, high]).reshape(-1, 2)
        if len(done) + len(waiting) > _MOST_PANELS:
            raise SolveError("the kernel of the layers varies too much to be tabulated")
    starts, coefficients, tails = zip(*sorted(done, key=lambda panel: panel[0]))
    return Table(np.append(starts, reach), np.array(coefficients), max(tails) + integrals.error / np.pi)


#: Largest position over a: differences of places on the surface.
REACH = 6.5
#: First panel of wavenumbers over the inverse of the total thickness.
_FIRST = 0.2
#: Relative accuracy beyond which rounding is met.
ROUNDING = 2e-13


def wavenumbers(stack: LayersAtSpeed) -> float:
    """End of the first panel of wavenumbers, times a."""
    return _FIRST / float(stack.depths[-1])


def felt_depth(stack: LayersAtSpeed, depth: float) -> float:
    """A depth over a as its slowest decaying waves feel it; fields of a line load vary over it there."""
    felt, top = 0.0, 0.0
    for layer in stack.layers:
        felt += min(layer.H, depth - top) * min(map(_slowest, (layer.top, layer.bottom)))
        top += layer.H
        if top >= depth:
            return felt
    return felt + (depth - top) * _slowest(stack.substrate)


def _slowest(medium: Medium) -> float:
    """Decay of the slowest decaying waves of a solid over their wavenumber, at most 1."""
    return min(1.0, *(float(p.imag) for p in medium.response.roots.each))


#: Factors 1 - e^(-kH) by which a power of 1/k that is no whole number is smooth enough at k = 0.
_FACTORS = 4
#: Powers of the depth with which a graded top changes: from which on integrals over wavenumbers
#: converge fast, and from which on polynomials follow the kernel.
_CONVERGES, _SMOOTH = 2.0, 3.0


@dataclass(frozen=True)
class Kernel:
    """Kernels of layers on a substrate: u,X by σ_XY, u,X by σ_YY, v,X by σ_XY, v,X by σ_YY, times μ.

    Attributes:
        stack: layers with their substrate at a speed.
        tolerance: relative.
        reach: positions over a up to which the kernel is tabulated.
    """

    stack: LayersAtSpeed
    tolerance: float
    reach: float = REACH

    @cached_property
    def order(self) -> NDArray[Any]:
        """Limit A of kᵖ ΔŶ for large k, p the power of a graded top, (4,); 0 under a uniform layer.

        It is 0, too, for powers from 2 on, whose integrals converge without it.
        """
        if not self.stack.layers or not self._power < _CONVERGES:
            return np.zeros(4, dtype=complex)
        Y = inverse(self.stack.top.down)
        return np.asarray((-1j * Y @ self.stack.layers[0].first_order() @ Y).ravel())

    @cached_property
    def singular(self) -> bool:
        """True where the kernel has a logarithm and a jump at 0, or a power of the distance below 1."""
        return bool(np.any(self.order))

    @property
    def _power(self) -> float:
        """Power of the depth with which the top layer changes."""
        return float(self.stack.layers[0].power)

    @property
    def rough(self) -> bool:
        """True where no polynomial follows the kernel next to 0: a logarithm, a jump, a low power."""
        return self.singular or (bool(self.stack.layers) and 1.0 < self._power < _SMOOTH)

    @cached_property
    def length(self) -> float:
        """Length over a over which the kernel varies next to 0.

        That of the grading of a graded top, or the depth of a top as its slowest decaying waves feel it.
        """
        if not self.stack.layers:
            return np.inf
        felt = felt_depth(self.stack, self.stack.layers[0].H)
        change = np.abs(self.order).max() / self._size
        return float(1.0 / max(change ** (1.0 / self._power), 1.0 / felt))

    @property
    def _size(self) -> float:
        """Largest constant by which the surface's solid alone answers."""
        return float(np.abs(inverse(self.stack.top.down)).max())

    def _regular(self, k: NDArray) -> NDArray[Any]:
        regular = self.stack.admittance(k).reshape(-1, 4)
        if self.singular:
            leading = (-np.expm1(-k * self.stack.layers[0].H)) ** self._smooth / k**self._power
            regular = regular - self.order * leading[:, None]
        return regular

    @cached_property
    def table(self) -> Table:
        """The kernel without what is singular at 0, tabulated by position."""
        finest = min(float(self.stack.layers[0].H), 1.0) / 4.0 * (1e-6 if self.rough else 1.0)
        accuracy = max(self.tolerance, 100.0 * ROUNDING if self.rough else ROUNDING)
        given = self._regular, wavenumbers(self.stack), finest, self.reach, accuracy, self._size
        return tabulated(*given, self._of_shifts) if self.singular else tabulated(*given)

    @property
    def error(self) -> float:
        """Absolute error of the kernel."""
        return self.table.error

    @property
    def _smooth(self) -> int:
        """Number m of factors 1 - e^(-kH) by which e^(ikx)/kᵖ becomes smooth enough at k = 0."""
        return 1 if self._power == 1.0 else _FACTORS

    def _power_of(self, log: NDArray, s: NDArray) -> NDArray[Any]:
        """Γ(1-p) s^(p-1) by log s, but for a constant or a multiple of s, of which the sum has none.

        It would be lost beside these where p is near 1 or 2.
        """
        ε = self._power - 1.0
        if ε == 0.0:
            return -log
        if ε < 0.5:
            return gamma(-ε) * np.expm1(ε * log)
        return gamma(-ε) * s * np.expm1((ε - 1.0) * log)

    def _of_shifts(self, x: NDArray) -> NDArray[np.float64]:
        """Terms with e^(-jkH), j > 0, at positions, (..., 4)."""
        m, total = self._smooth, np.zeros(x.shape, dtype=complex)
        for j in range(1, m + 1):
            s = j * self.stack.layers[0].H - 1j * x
            total += (-1) ** j * comb(m, j) * self._power_of(np.log(s), s)
        return np.asarray((self.order * total[..., None]).real / np.pi)

    def _of_surface(self, x: NDArray) -> NDArray[np.float64]:
        """The term without e^(-kH), singular at 0, at positions, (..., 4)."""
        ε, at_0 = self._power - 1.0, x == 0.0
        log = np.log(np.where(at_0, 1.0, np.abs(x))) - 0.5j * np.pi * np.sign(x)
        term = self._power_of(log, -1j * x)
        if 0.0 < ε < 0.5:
            term = np.where(at_0, -gamma(-ε), term)
        return np.asarray((self.order * term[..., None]).real / np.pi)

    def __call__(self, x: NDArray) -> NDArray[np.float64]:
        """The kernels at positions over a, none of them 0 where it is infinite, (..., 4)."""
        kernels = self.table(x)
        return kernels + self._of_surface(np.asarray(x, dtype=float)) if self.singular else kernels


@dataclass(frozen=True, eq=False)
class Scaled:
    """A kernel with lengths over another unit than a, so that contacts of all sizes share one kernel.

    Attributes:
        kernel: with lengths over a.
        size: the other unit over a.
    """

    kernel: Kernel
    size: float

    @property
    def rough(self) -> bool:
        """True where no polynomial follows the kernel next to 0."""
        return self.kernel.rough

    @property
    def length(self) -> float:
        """Length over which the kernel varies next to 0, over the other unit."""
        return self.kernel.length / self.size

    def __call__(self, x: NDArray) -> NDArray[np.float64]:
        """The kernels at positions over the other unit, (..., 4)."""
        return self.size * self.kernel(self.size * np.asarray(x, dtype=float))


#: Relative distance of a depth from an interface within which it is that of the interface.
_AT = 1e-12
#: Numbers of differences of positions that are looked up at once: some megabytes.
_DIFFERENCES_AT_ONCE = 60_000


@dataclass(frozen=True)
class Level:
    """Strain and tractions at a depth of a layered half-plane.

    Attributes:
        stack: layers with their substrate.
        depth: over a, positive.
        reach: largest difference of positions over a.
        tolerance: relative.
    """

    stack: LayersAtSpeed
    depth: float
    reach: float
    tolerance: float

    @cached_property
    def _parts(self) -> tuple[int, list[Any]]:
        """Number of whole layers above the depth, and the parts above and below it of what it cuts.

        There are none of an interface, and of the substrate that above alone.
        """
        top = 0.0
        for i, layer in enumerate(self.stack.layers):
            bottom = top + layer.H
            if abs(bottom - self.depth) <= _AT * bottom:
                return i + 1, []
            if self.depth < bottom:
                return i, [*layer.cut(self.depth - top)]
            top = bottom
        return len(self.stack.layers), [Uniform(self.stack.substrate, self.depth - top)]

    @cached_property
    def length(self) -> float:
        """Length over a over which the stresses of a line load vary there."""
        return felt_depth(self.stack, self.depth)

    @property
    def media(self) -> tuple[Medium, Medium]:
        """The solids above and below the depth; the same one inside a layer."""
        (whole, parts), layers = self._parts, self.stack.layers
        above, *below = parts or layers[whole - 1 : whole + 1]
        return above.bottom, below[0].top if below else self.stack.substrate

    @cached_property
    def _modulus(self) -> float:
        """Modulus that makes a stress of the strain: the larger one of both sides."""
        return max(medium.modulus for medium in self.media)

    def _of(self, k: NDArray) -> NDArray:
        """Transforms of u,X times the modulus, σ_YY and σ_XY under σ_XY and σ_YY on top, (n, 6)."""
        whole, parts = self._parts
        surface, under, moved = self.stack.crossed(k)
        carried = inverse(surface)
        for by_top in moved[:whole]:
            carried = by_top @ carried
        Z = under[whole - 1]
        if len(parts) == 2:  # of a layer
            Z, by_top = self.stack.inside(k, whole, parts[0].H)
            carried = by_top @ carried
        elif parts:  # of the substrate
            carried = parts[0].carried(k, Z)[1] @ carried
        tractions = Z @ carried
        return np.stack(
            [*(1j * self._modulus * carried[:, 0].T), *tractions[:, 1].T, *tractions[:, 0].T], axis=-1
        )  # fmt: skip

    @cached_property
    def _table(self) -> Table:
        first = min(wavenumbers(self.stack), 1.0 / self.depth)
        # The integral of |f| grows as the depth falls; the stresses, which the error is of, do not.
        accuracy = max(min(self.depth / self.reach, 1.0) * self.tolerance / 100.0, ROUNDING)
        return tabulated(self._of, first, self.depth / 4.0, self.reach, accuracy)

    @property
    def error(self) -> float:
        """Absolute error of stresses under a pressure with the resultant of a punch, 2."""
        return 2.0 * self._table.error

    def read(
        self, t: NDArray, σ: NDArray, g: Any, X: NDArray, size: float = 1.0, ratios: Any = 1.0
    ) -> NDArray[np.float64]:
        """u,X times μ, σ_YY and σ_XY at positions, (3, ..., n).

        Args:
            t, σ: points of the pressure's rule, and weights times σ_YY there.
            g: σ_XY/σ_YY on top, (...).
            X: positions.
            size: unit over a of ``t``, ``X`` and stresses.
            ratios: σ_XY/σ_YY at ``t`` over g, a number or (len(t),).
        """
        both = np.stack([σ * ratios, σ], axis=-1)
        fields, step = np.empty((len(X), 6)), max(_DIFFERENCES_AT_ONCE // len(t), 1)
        for start in range(0, len(X), step):
            rows = slice(start, start + step)
            table = self._table(size * (X[rows, None] - t)).reshape(-1, len(t), 3, 2)
            fields[rows] = size * np.einsum("ts,xtfs->xfs", both, table).reshape(-1, 6)
        by_shear, by_pressure = fields[:, 0::2], fields[:, 1::2]
        both_loads = np.moveaxis(np.multiply.outer(g, by_shear.T) + by_pressure.T, -2, 0)
        both_loads[0] /= self._modulus
        return both_loads
