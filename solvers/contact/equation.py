"""The singular integral equation of a punch on a layered half-plane.

    (n̂/π) ⨍ σ(t)/(t - r) dt - g q σ(r) + ∫ K(r - t) σ(t) dt = μ v,X(r),   ∫ σ dr = -2,

σ = σ_YY, n̂ = n + g n₁₂ of the surface's solid, K of :mod:`galinx.solvers.layers.kernel`. The dominant
part is that of a half-plane, and so are the exponents. The pressure is a sum of Jacobi polynomials under
their weight; its integrals with K are done by Gauss's rule. Where K is rough, with a logarithm and a jump
at 0, the pressure without its weight has terms like (1 - t) log(1 - t) towards the ends, which no
polynomial follows: values on panels replace them.

A prescribed pressure is linear between knots (:mod:`.prescribed_pressure`). It is integrated by Gauss's
rule on pieces between knots, as short as the kernel requires; where the kernel has a logarithm, graded
towards it. The part of the half-plane of the surface's solid is known exactly.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import lstsq
from scipy.special import roots_jacobi

from ..errors import SolveError
from ..friction.along import Along, constant
from .along import expansion
from .panels import TO_BEND, Panels
from .pressure import ENDS, Expansion, Functions

#: |r| up to which few polynomials have not grown, by how much many may, and points of the rule beyond it.
_NEAR, _GROWN, _FINE = 1.1, 1e3, 96


def jacobi(count: int, α: float, β: float, r: NDArray) -> NDArray[np.float64]:
    """Jacobi polynomials P_0^(α,β), P_1^(α,β), … at r by the recurrence, (*r.shape, count)."""
    r, s = np.asarray(r, dtype=float), α + β
    P = np.empty((count, *r.shape))
    P[0] = 1.0
    if count > 1:
        P[1] = α + 1.0 + (s + 2.0) * (r - 1.0) / 2.0
    for n in range(1, count - 1):
        m = 2.0 * n + s
        now = (m + 1.0) * ((m + 2.0) * m * r + (α - β) * s) * P[n]
        before = 2.0 * (n + α) * (n + β) * (m + 2.0) * P[n - 1]
        P[n + 1] = (now - before) / (2.0 * (n + 1.0) * (n + s + 1.0) * m)
    return np.moveaxis(P, 0, -1)


def gauss(points: int, α: float, β: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Points and weights of Gauss's rule for the weight (1 - t)^α (1 + t)^β, (points,) each."""
    with np.errstate(invalid="ignore", divide="ignore"):  # SciPy evaluates a branch it then discards
        t, w = roots_jacobi(points, α, β)
    return t, w


@dataclass(frozen=True)
class Jacobi(Functions):
    """Jacobi polynomials P_k^(α,β) of a pressure with the same exponents."""

    α: float
    β: float

    def near(self, count: int) -> float:
        """|r| up to which polynomials, so many, have not grown."""
        return min(_NEAR, float(np.cosh(np.log(_GROWN) / count)))

    def values(self, r: NDArray, count: int) -> NDArray[np.float64]:
        return jacobi(count, self.α, self.β, r)

    def _rule(self, c: NDArray) -> tuple[NDArray, NDArray, NDArray]:
        t, w = gauss(max(_FINE, 2 * c.shape[-1]), self.α, self.β)
        return t, w, self.sum(c, t)

    def rest(self, c: NDArray, r: NDArray, near: float) -> NDArray[np.float64]:
        """Hilbert transform without that of the weight, see :meth:`.pressure.Pressure.rest`."""
        t, w, p = self._rule(c)
        close = np.abs(r) <= near
        taken = np.zeros_like(r)
        taken[close] = self.sum(c, r[close])
        difference = t - r[:, None]
        on = np.abs(difference) < 1e-13
        return np.asarray(((p - taken[:, None]) / np.where(on, np.inf, difference)) @ w / np.pi)

    def integral(
        self, c: NDArray, kernel: Callable[[NDArray], NDArray], r: NDArray
    ) -> NDArray[np.float64]:
        """Integrals with a kernel, see :meth:`.pressure.Pressure.integral`."""
        t, w, p = self._rule(c)
        return np.asarray(np.einsum("rtf,t->rf", kernel(r[:, None] - t), w * p))

    def points(self, c: NDArray, finest: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Rule for other integrals, see :meth:`.pressure.Pressure.points`."""
        fine = Panels(self.α, self.β, min(finest, 0.7))
        return fine.t, fine.weights * self.sum(c, fine.t)


#: Number of polynomials at first, its growth from step to step, and its maximum.
FIRST, _MORE, MOST = 24, 1.5, 1400
#: Places at which pressures of two numbers of polynomials are compared, with both ends.
_LOOKED_AT = np.cos(np.pi * (np.arange(25) + 0.5) / 25)
#: Distance from a tip of the punch within which pressures are not compared.
NEAR_TIP = 0.02
#: Least distance from -1 of the pressure's exponents: points of quadrature fall on the edges beyond it.
_STRONGEST = 1e-4

#: μ v,X under the punch over N/(2a) at given r.
Slope: TypeAlias = Callable[[NDArray], NDArray]
#: Number of polynomials, or the longest panel where the kernel is rough.
Resolution: TypeAlias = int | float

#: Distances from a free end at which pressures are compared too, places between the ends, and the factor
#: by which they have to agree better next to ends.
_NEXT_TO_END, _ACROSS, _MORE_AT_ENDS = np.geomspace(1e-6, 1e-2, 5), np.linspace(-0.9, 0.9, 20), 10.0

#: A change that rounding alone may make.
_ROUNDING = 2e-12
#: Number and grading of panels towards kinks of friction that varies along the contact, and those of the
#: punch there, at which the pressure may be infinite.
_TO_KINKS_ALONG = (12, 0.2), (18, 0.35)
#: Longest panel at first where the kernel is rough, over the contact's half-width, its factor from step
#: to step, and the number of steps.
_COARSE, _SHORTER, _TIMES = 1.4, 0.7, 12


class _NoLayers:
    """Kernel of a uniform half-plane, whose equation has none."""

    rough, error = False, 0.0

    def __call__(self, x: NDArray) -> NDArray[np.float64]:
        return np.zeros((*np.shape(x), 4))


#: Kernel of the equation of a uniform half-plane.
UNIFORM = _NoLayers()


@dataclass(frozen=True)
class Equation:
    """Singular integral equation at one speed and friction.

    Attributes:
        response: of the surface's solid.
        kernel: of the layers; ``UNIFORM`` without any.
        g: σ_XY/σ_YY under the punch, a number or an :class:`Along`.
        slope: μ v,X under the punch over N/(2a) at given r.
        kinks: places r next to which the slope is not smooth.
        adjoint: True for the adjoint equation but for its sign: -q for q, and -K(-x) for K(x).
    """

    response: Any
    kernel: Any
    g: Any
    slope: Slope
    kinks: tuple[float, ...] = ()
    adjoint: bool = False

    @cached_property
    def friction(self) -> Along:
        """σ_XY/σ_YY over the contact."""
        return self.g if isinstance(self.g, Along) else constant(self.g)

    @property
    def rough(self) -> bool:
        """True if the pressure without its weight is followed by no polynomial."""
        return bool(self.kernel.rough or self.friction.varies)

    @property
    def n(self) -> float:
        """n̂ = n + g n₁₂ of one friction, dimensionless."""
        return float(self.response.n + self.friction.mean * self.response.n12)

    @property
    def Q(self) -> float:
        """Factor g q of the pressure with one friction, dimensionless."""
        return float(self.friction.mean * self.response.q) * (-1.0 if self.adjoint else 1.0)

    def K(self, x: NDArray) -> NDArray[np.float64]:
        """Kernel of the layers at x with one friction, (..., 1)."""
        by_kernel = self._kernels(x)
        return by_kernel[..., 1:] + self.friction.mean * by_kernel[..., :1]

    def _kernels(self, x: NDArray) -> NDArray[np.float64]:
        """Kernels of the layers at x by which σ_XY and σ_YY tilt the surface, (..., 2)."""
        sign = -1.0 if self.adjoint else 1.0
        return np.asarray(sign * self.kernel(sign * x)[..., 2:])

    def _cot(self, r: NDArray) -> NDArray[np.float64]:
        """cot(πα) = g q/n̂ at r."""
        g, sign = self.friction(r), -1.0 if self.adjoint else 1.0
        return np.asarray(sign * g * self.response.q / (self.response.n + g * self.response.n12))

    @cached_property
    def α(self) -> float:
        """Exponent at X = a, that of the surface's solid, dimensionless."""
        return -0.5 - float(np.arctan(self._cot(ENDS))[1]) / np.pi

    @cached_property
    def β(self) -> float:
        """Exponent at X = -a, dimensionless."""
        return -0.5 + float(np.arctan(self._cot(ENDS))[0]) / np.pi

    def pressure(self, resolution: Resolution) -> Expansion:
        """Pressure with resultant -2 at a resolution."""
        return self.pressures(resolution, [self.slope], [-2.0]).sum(np.ones(1))

    def pressures(
        self, resolution: Resolution, slopes: Sequence[Slope], loads: Sequence[float]
    ) -> Expansion:
        """Pressures under several slopes with resultants ``loads``, as many states, at a resolution."""
        if isinstance(resolution, float):
            return self._by_panels(resolution, slopes, loads)
        t, w = gauss(resolution, self.α, self.β)
        r, _ = gauss(resolution - 1, -self.α, -self.β)
        P = jacobi(resolution, self.α, self.β, t)
        A = np.empty((resolution, resolution))
        A[:-1] = self.n / np.pi * (w / (t - r[:, None])) @ P
        A[:-1] += (w * self.K(r[:, None] - t)[..., 0]) @ P
        A[-1] = w @ P
        b = np.vstack([np.stack([slope(r) for slope in slopes], axis=-1), loads])
        return Expansion(self.α, self.β, np.linalg.solve(A, b).T, Jacobi(self.α, self.β))

    def _by_panels(self, finest: float, slopes: Sequence[Slope], loads: Sequence[float]) -> Expansion:
        """Pressures by their values on panels, with which the dominant part of τ = n̂ σ = w P is regular:

            H[τ] - cot(πα) τ = (1/π) ∫ w(t) (P(t) - P(r))/(t - r) dt + (H[w] - cot(πα) w) P(r).

        The last term vanishes for one friction. The adjoint has n̂ outside the integral.
        """
        friction, response = self.friction, self.response
        kinks = tuple(sorted({*self.kinks, *friction.kinks, *friction.weak_kinks}))
        grading = _TO_KINKS_ALONG[bool(self.kinks)] if friction.varies else TO_BEND
        panels = Panels(self.α, self.β, finest, kinks, *grading, rough=self.kernel.rough)
        x, t = panels.x, panels.t
        apart = panels.apart(x[:, None], x - x[:, None])
        np.fill_diagonal(apart, np.inf)
        A = panels.weights / apart / np.pi
        A -= np.diag(A.sum(axis=1))
        for panel, D in enumerate(panels.derivative):
            own = panels.of(panel)
            A[own, own] += panels.weights[own, None] * D / np.pi
        scale, g = 1.0 / panels.weight(x), friction(t)
        A *= scale[:, None]
        A += np.diag(panels.hilbert_of_weight(x) - self._cot(t))
        n = response.n + g * response.n12
        A *= n[:, None] if self.adjoint else n
        by_shear, by_pressure = np.moveaxis(panels.rows(self._kernels), -1, 0)
        A += scale[:, None] * (by_pressure + (g[:, None] if self.adjoint else g) * by_shear)
        A = np.vstack([A, panels.weights])
        b = np.vstack([np.stack([slope(t) * scale for slope in slopes], axis=-1), loads])
        c = lstsq(A, b, lapack_driver="gelsy", check_finite=False)[0].T
        return expansion(self.α, self.β, c, panels, friction)


@dataclass(frozen=True)
class SolvedContact:
    """Contact with one friction; lengths are over a unit that all states share.

    Attributes:
        g: σ_XY/σ_YY.
        pressure: the pressure.
        half_width: of the contact.
        centre: its middle, from the punch's axis.
        change: relative change of the pressure and its intensities with the number of unknowns, at one
            resolution that by which intensities at free ends were removed.
        before: the pressure with fewer unknowns; None at a single resolution.
    """

    g: float
    pressure: Any
    half_width: float = 1.0
    centre: float = 0.0
    change: float = 0.0
    before: Any = None

    def moved(self, before: "SolvedContact") -> float:
        """Relative change of lengths and pressure since ``before``; next to free ends with a factor.

        In-plane stresses follow the pressure with such a factor there.
        """
        lengths = max(abs(self.half_width - before.half_width), abs(self.centre - before.centre))
        free = np.ravel(self.pressure.free)
        at = np.concatenate([*(ENDS[free, None] * (1.0 - _NEXT_TO_END)), _ACROSS])
        earlier, later = (
            (1.0 - at) ** p.α * (1.0 + at) ** p.β * p.series(at) for p in (before.pressure, self.pressure)
        )
        near = np.abs(earlier - later)[: -len(_ACROSS)].max(initial=0.0) / np.abs(later).max()
        at = np.concatenate([ENDS, _LOOKED_AT])
        for tip in self.pressure.tips:
            at = at[np.abs(at - tip) > NEAR_TIP]
        earlier, later = before.pressure.series(at), self.pressure.series(at)
        of_pressure = float(np.abs(earlier - later).max() / np.abs(later).max())
        return max(of_pressure, lengths / self.half_width, _MORE_AT_ENDS * float(near))


def converged(
    equation: Equation, at_resolution: Callable[[Resolution], SolvedContact], tolerance: float
) -> SolvedContact:
    """Contact to a relative tolerance, by finer and finer resolutions.

    Args:
        equation: of its pressure.
        at_resolution: gives the contact at a resolution.
        tolerance: the tolerance.

    Raises:
        SolveError: the tolerance was not reached; the message says by how much. Or an exponent is too
            close to -1 to be resolved.
    """
    least = 1.0 + min(equation.α, equation.β)
    if not least >= _STRONGEST:
        raise SolveError(
            f"the pressure's exponent at an edge is -1 + {least:.2g}, expected at least -1 + "
            f"{_STRONGEST:g}: all of it acts at that edge; take less friction"
        )
    before, error = None, np.inf
    for resolution in resolutions(equation.rough):
        now = at_resolution(resolution)
        if before is not None:
            error = max(now.moved(before), now.change)
            if error <= max(tolerance / 4.0, _ROUNDING):
                return replace(now, before=before.pressure, change=error)
        before = now
    raise SolveError(
        f"with the most unknowns the pressure still changes by {error:.2g}, expected {tolerance:g}: "
        "the uppermost layer is very thin over the contact's width; take a larger tolerance"
    )


def resolutions(rough: bool) -> Iterator[Resolution]:
    """Finer and finer resolutions: longest panels for rough kernels, else numbers of polynomials."""
    if rough:
        for time in range(_TIMES):
            yield _COARSE * _SHORTER**time
        return
    terms = int(FIRST / _MORE)
    while terms < MOST:
        yield terms
        terms = int(_MORE * terms)
    yield MOST
