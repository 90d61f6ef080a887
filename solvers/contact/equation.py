"""The singular integral equation of a punch on a layered half-plane, and contacts that it determines.

    (n̂/π) ⨍ σ(t)/(t - r) dt - g q σ(r) + ∫ K(r - t) σ(t) dt = μ v,X(r),   ∫ σ dr = -2,

σ = σ_YY, n̂ = n + g n₁₂ of the surface's solid, K of :mod:`galinx.solvers.layers.kernel`. The dominant
part is that of a half-plane, and so are the exponents. The pressure is a sum of Jacobi polynomials under
their weight; its integrals with K are done by Gauss's rule. Where K is rough, with a logarithm and a jump
at 0, the pressure without its weight has terms like (1 - t) log(1 - t) towards the ends, which no
polynomial follows: values on panels replace them.

**Frictions.** Any number of frictions at one speed share the kernels, which do not depend on friction. A
pressure without its weight is an analytic function of g = σ_XY/σ_YY: beyond a few frictions the equation
is solved at Chebyshev's points in g, and what is linear in the pressure is interpolated between them.

**Two free ends, any convex profile.** With T the operator of the equation, its adjoint is, but for the
sign, that of the same contact seen from the other side. Let ρ₁ be the pressure of a flat punch there, and
ρ₂ that under the slope 1 without a resultant. A pressure σ that vanishes at both ends under the slope f,
T σ = f, then has ∫ ρ f = -∫ (-T* ρ) σ, so that

    ∫ ρ₁ P'(m + h s) ds = 0,        N/μ = h ∫ ρ₂ P'(m + h s) ds.

These conditions on the slope alone (:func:`rule_of_ends`) give both ends, by
:mod:`galinx.solvers.contact.ends`. Both ρ are smooth functions over w = (1 - s)^a (1 + s)^b, whatever the
profile is; without layers ρ₁ is 1/w and ρ₂ is s/w but for factors.

**A tilted punch one edge of which lifts off.** The contact starts at the other edge, and the intensity at
its free end vanishes for one sum of two pressures, that of a flat punch and that under the slope 1.

**Slopes that jump, or whose derivative jumps** (:class:`Kinked`). What a kink does to the pressure is of
the surface's solid alone: with f the slope less the mean by which the pressure σ₀ of
:mod:`galinx.solvers.contact.panels` vanishes at both ends, what layers add is a pressure under that mean
and under the slope -∫ K(r - t) σ₀(t) dt by which σ₀ bends the layers, which no kink makes rough.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.lapack import dgels, dgels_lwork

from ..approximation import gauss
from ..errors import SolveError
from ..friction.along import Along, constant
from ..layers.kernel import REACH, Kernel, Level, Scaled
from ..layers.layered import Layered, LayersAtSpeed
from ..profiles import check_reach, cusp, has_free_end, jumps, kinks
from ..profiles.punches import Flat
from .along import ExpansionAlong
from .closed_form import FreeEnds, contacts, panels_of
from .ends import ROUNDING, Punch, Rule, free_ends, half_width_of_load, logarithm_of_load
from .panels import PER_LENGTH, TO_BEND, Panels, summed
from .pressure import ENDS, Expansion, Functions, Pressure, off_tips

#: |r| up to which few polynomials have not grown, by how much many may, and points of the rule beyond it.
_NEAR, _GROWN, _FINE = 1.1, 1e3, 96
#: Points of a rule over the contact, times the length over which a kernel varies, that resolve it.
_RESOLVED = 16.0


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

    def sum(self, c: NDArray, r: NDArray) -> NDArray[np.float64]:
        """Σ c_k P_k at r; of one state by Clenshaw's recurrence, without values of all polynomials."""
        if c.ndim > 1 or len(c) < 2:
            return super().sum(c, r)
        r, s, later, last = np.asarray(r, dtype=float), self.α + self.β, 0.0, 0.0
        for n in range(len(c) - 1, 0, -1):  # P_(n+1) = (a r + b) P_n - d P_(n-1), d of the next n
            m = 2.0 * n + s
            size = 2.0 * (n + 1.0) * (n + s + 1.0)
            a, b = (m + 1.0) * (m + 2.0) / size, (m + 1.0) * (self.α - self.β) * s / (size * m)
            d = (n + 1.0 + self.α) * (n + 1.0 + self.β) * (m + 4.0)
            d /= (n + 2.0) * (n + s + 2.0) * (m + 2.0)
            later, last = last, c[n] + (a * r + b) * last - d * later
        first = self.α + 1.0 + (s + 2.0) * (r - 1.0) / 2.0
        d = (1.0 + self.α) * (1.0 + self.β) * (4.0 + s) / (2.0 * (2.0 + s) * (2.0 + s))
        return np.asarray(c[0] + first * last - d * later)

    def cauchy(self, c: NDArray, y: NDArray) -> NDArray[Any]:
        panels = Panels(self.α, self.β, finest(len(c)))
        return panels.cauchy(self.sum(c, panels.t), y)

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
        self, c: NDArray, kernel: Callable[[NDArray], NDArray], r: NDArray, length: float
    ) -> NDArray[np.float64]:
        """Integrals with a kernel, see :meth:`.pressure.Pressure.integral`."""
        t, w, p = self._rule(c)
        if len(t) * length < _RESOLVED:
            return summed(kernel, r, *self.points(c, PER_LENGTH * length))
        return summed(kernel, r, t, w * p)

    def points(self, c: NDArray, finest: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Rule for other integrals, see :meth:`.pressure.Pressure.points`."""
        fine = Panels(self.α, self.β, min(finest, 0.7), settled=_SETTLED)
        return fine.t, fine.weights * self.sum(c, fine.t)


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
#: Finer and finer resolutions: numbers of polynomials, and, where the kernel is rough, longest panels.
_TERMS: list[int] = [16, 24, 36, 54, 81, 121, 181, 271, 406, 609, 913, 1369, 1400]
_PANELS: list[Resolution] = (1.4 * 0.7 ** np.arange(14)).tolist()
#: Least number of polynomials times the root of a kernel's length: next to ends their points are as far
#: apart as the inverse of their number squared.
_AT_EDGES = 2.0
#: Longest panel below which panels get shorter in t only: in x shorter ones add unknowns and rounding.
_SETTLED = 0.5


class _NoLayers:
    """Kernel of a uniform half-plane, whose equation has none."""

    rough, error, length = False, 0.0, np.inf

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

        The last term vanishes for one friction. The adjoint has n̂ outside the integral. The equation is
        met at places between the points, in the least squares: at the points themselves it would leave
        one oscillation of every panel as good as free where friction is small.
        """
        friction, response = self.friction, self.response
        kinks = tuple(sorted({*self.kinks, *friction.jumps}))
        grading = _TO_KINKS_ALONG[bool(self.kinks)] if friction.varies else TO_BEND
        panels = Panels(
            self.α, self.β, finest, kinks, *grading, rough=self.kernel.rough, settled=_SETTLED,
            length=self.kernel.length,
        )  # fmt: skip
        x, own = panels.between
        r, scale = np.tanh(x / 2.0), 1.0 / panels.weight(x)
        g, there = friction(panels.t), friction(r)
        A = panels.weights / panels.apart(x[:, None], panels.x) / np.pi
        # What is subtracted at r is interpolated in its own panel.
        of_own = panels.hilbert_of_weight(x) - self._cot(r) - scale * A.sum(axis=1)
        A *= scale[:, None]
        for panel in range(len(panels.half)):
            rows = slice(panel * len(own), (panel + 1) * len(own))
            A[rows, panels.of(panel)] += of_own[rows, None] * own
        A *= response.n + (there[:, None] if self.adjoint else g) * response.n12
        if self.kernel is not UNIFORM:
            by_shear, by_pressure = np.moveaxis(panels.rows(self._kernels, x), -1, 0)
            A += scale[:, None] * (by_pressure + (there[:, None] if self.adjoint else g) * by_shear)
        A = np.vstack([A, panels.weights])
        b = np.vstack([np.stack([slope(r) * scale for slope in slopes], axis=-1), loads])
        # No column is nearly dependent: without pivots it takes a third of the time.
        size, _ = dgels_lwork(*A.shape, b.shape[1])
        _, x, dependent = dgels(A, b, lwork=int(size))
        if dependent:
            raise SolveError("the integral equation on panels is singular")
        c = x[: A.shape[1]].T
        if friction.varies:
            return ExpansionAlong(self.α, self.β, c, panels, friction=friction)
        return Expansion(self.α, self.β, c, panels)


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
    equation: Equation,
    at_resolution: Callable[[Resolution], SolvedContact],
    tolerance: float,
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
    weakest = 1.0 + min(equation.α, equation.β)
    if not weakest >= _STRONGEST:
        raise SolveError(
            f"the pressure's exponent at an edge is -1 + {weakest:.2g}, expected at least -1 + "
            f"{_STRONGEST:g}: all of it acts at that edge; take less friction"
        )
    before, error, allowed = None, np.inf, max(tolerance / 4.0, _ROUNDING)
    for resolution in resolutions(equation):
        now = at_resolution(resolution)
        if before is not None:
            error = max(now.moved(before), now.change)
            if error <= allowed:
                return replace(now, before=before.pressure, change=error)
        before = now
    raise _not_resolved(equation, error, allowed)


def resolutions(equation: Equation) -> list[Resolution]:
    """Finer and finer resolutions: longest panels, or numbers of polynomials."""
    if equation.rough:
        return _PANELS
    # Two numbers of polynomials that both miss what a thin film does at an edge agree.
    least = _AT_EDGES / np.sqrt(equation.kernel.length)
    return [count for count in _TERMS if count >= least]


def _not_resolved(equation: Equation, error: float, allowed: float) -> SolveError:
    look = "look at the units of the punch and the layers"
    if not np.isfinite(error):
        return SolveError(
            "the uppermost layer is so thin beside the contact's width that even the most unknowns miss "
            f"what it does at the edges: leave it out, or {look}"
        )
    reasons, units = ["friction varies much over the contact's width"] * equation.friction.varies, ""
    if equation.kernel is not UNIFORM and equation.kernel.length < 1.0:
        reasons.append("the uppermost layer is very thin beside the contact's width")
        units = f", and {look}"
    reasons = reasons or ["the punch has kinks, perhaps, that its profile does not name"]
    return SolveError(
        f"with the most unknowns the pressure still changes by {error:.2g}, expected {allowed:.2g}: "
        f"{', or '.join(reasons)}; take a larger tolerance{units}"
    )


#: Longest panel for a sum of so many polynomials, times their number, and at most.
_PANEL, _LONGEST = 16.0, 0.7


def rule_of_ends(equation: Equation, resolution: Resolution) -> Rule:
    """Quadrature of the conditions on both ends of contacts of one half-width.

    Args:
        equation: of such a contact; its slope is not used.
        resolution: number of polynomials, or longest panel.
    """
    adjoint, of_friction = replace(equation, adjoint=True), equation.friction.jumps
    ρ = adjoint.pressures(resolution, (np.zeros_like, np.ones_like), (-2.0, 0.0))

    def rule(kinks: tuple[float, ...]) -> tuple[NDArray, NDArray, NDArray]:
        panels = Panels(ρ.α, ρ.β, finest(resolution), tuple(sorted({*kinks, *of_friction})))
        lifting, carrying = panels.weights * ρ.series(panels.t)
        return panels.t, -lifting, carrying

    return rule


def vanishing(
    equation: Equation, resolution: Resolution, resultant: float = -2.0
) -> tuple[Expansion, float]:
    """Pressure of a contact between two free ends, at which it vanishes.

    An intensity left by the resolution is removed by a little of a flat punch and of the slope 1.

    Args:
        equation: of the contact, with its slope.
        resolution: number of polynomials, or longest panel.
        resultant: ∫ σ_YY dr.

    Returns:
        The pressure, and the correction: the larger of the change of its resultant over that of a punch,
        and the change of its slope over that by which one end alone would carry such a resultant.
    """
    slopes = (equation.slope, np.zeros_like, np.ones_like)
    parts = equation.pressures(resolution, slopes, (resultant, -2.0, 0.0))
    K = parts.series(ENDS).T
    little = np.linalg.solve(K[:, 1:], -K[:, 0])
    moved = np.abs(little) * np.abs(K[:, 1:]).max(axis=0) / np.abs(K[:, 1]).max()
    return parts.sum(np.append(1.0, little)).ending((True, True)), float(moved.max())


def finest(resolution: Resolution) -> float:
    """Longest panel that resolves a pressure of this resolution."""
    return min(resolution if isinstance(resolution, float) else _PANEL / resolution, _LONGEST)


@dataclass(frozen=True)
class Kinked(Pressure):
    """Pressure between free ends under a slope with kinks.

    Attributes:
        α, β: exponents of edges.
        alone: σ₀, the pressure on the surface's solid alone.
        on_panels: σ₀ over the weight of edges.
        more: the pressure that layers add.
        near, kinks, tips: see :class:`galinx.solvers.contact.pressure.Pressure`.
    """

    α: float
    β: float
    alone: FreeEnds
    on_panels: Expansion
    more: Expansion
    near: float
    kinks: tuple[float, ...]
    tips: tuple[float, ...]

    #: Rules of σ₀ by their longest panel.
    _fine: dict[float, tuple[NDArray, NDArray]] = field(default_factory=dict)

    #: Both ends are free.
    free = np.array([True, True])  # type: ignore[assignment]

    def series(self, r: NDArray) -> NDArray[np.float64]:
        return _without_weight(self.alone, off_tips(r, self.tips)) + self.more.series(r)

    def rest(self, r: NDArray, near: float) -> NDArray[np.float64]:
        values, under = self.more.rest(r, near), np.abs(r) < 1.0
        # cot(πα) = Q/n turns σ₀ under the punch into f/n.
        values[under] += self.alone.slope(r[under]) / self.alone.n
        values[~under] += self.alone.hilbert(r[~under])
        return values

    def integral(
        self, kernel: Callable[[NDArray], NDArray], r: NDArray, length: float
    ) -> NDArray[np.float64]:
        return self.more.integral(kernel, r, length) + self.on_panels.integral(kernel, r, length)

    def at(self, z: NDArray) -> NDArray[np.complex128]:
        return self.alone.at(z) + self.more.at(z)

    def points(self, finest: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        panels: Panels = self.on_panels.functions
        # Depths that are searched share panels.
        finest = min(float(2.0 ** np.floor(np.log2(finest))), panels.finest)
        if finest not in self._fine:
            fine, (values, at) = replace(panels, finest=finest, settled=_SETTLED), self._between
            self._fine[finest] = fine.t, fine.weights * at.interpolated(values, fine.x)
        (t, σ), (t_alone, σ_alone) = self.more.points(finest), self._fine[finest]
        return np.append(t, t_alone), np.append(σ, σ_alone)

    @cached_property
    def _between(self) -> tuple[NDArray[np.float64], Panels]:
        """σ₀ over the weight of edges, and panels from whose points it follows between them.

        Towards a kink, twice the points of a panel interpolate as accurately as its rule integrates.
        """
        panels: Panels = self.on_panels.functions
        twice = replace(panels, nodes=2 * panels.nodes)
        return _without_weight(self.alone, twice.t), twice


def _without_weight(alone: FreeEnds, r: NDArray) -> NDArray[np.float64]:
    """σ₀ over the weight of edges, whose exponents are 1 less, which is 0 from both ends on."""
    return (1.0 - r) * (1.0 + r) * alone.series(r)


def _on_panels(alone: FreeEnds, panels: Panels) -> Expansion:
    """σ₀ over the weight of edges by its values on panels."""
    return Expansion(panels.α, panels.β, _without_weight(alone, panels.t), panels)


def kinked(
    equation: Equation, resolution: Resolution, punch: Punch, m: float, h: float
) -> tuple[Pressure, float]:
    """Pressure of a contact with kinks, and its correction as of :func:`vanishing`.

    Args:
        equation: of the contact, with its slope.
        resolution: number of polynomials, or longest panel.
        punch: the punch.
        m, h: middle and half-width.
    """
    a, profile, places = 1.0 + equation.α, punch.profile, punch.kinks(m, h)
    panels = panels_of(profile, a, places)
    whole = equation.slope(panels.t)
    mean = float(panels.weights @ whole / panels.weights.sum())

    def slope(r: NDArray) -> NDArray[np.float64]:
        return equation.slope(r) - mean

    alone = FreeEnds(
        panels, whole - mean, slope, equation.n, equation.Q, places, cusp=cusp(profile),
    )  # fmt: skip
    carried = -np.sin(np.pi * a) / equation.n * float(panels.weights @ (panels.t * (whole - mean)))
    fine = Panels(equation.α, equation.β, finest(resolution), places, rough=equation.kernel.rough)
    on_panels = _on_panels(alone, fine)

    def of_layers(r: NDArray) -> NDArray[np.float64]:
        return mean - on_panels.integral(equation.K, r, equation.kernel.length)[:, 0]

    more = replace(equation, slope=of_layers, kinks=places)
    tips = places if jumps(profile) else ()
    added, taken = vanishing(more, resolution, -2.0 - carried)
    return Kinked(added.α, added.β, alone, on_panels, added, added.near, places, tips), taken


#: Accuracy of half-widths over the tolerance, where each has an equation of its own.
_OF_LENGTHS = 1e-4
#: Accuracy of the half-width at rest, over which others are given, and the least that serves.
_AT_REST, _NEARLY = 1e-5, 0.1
#: Accuracy with which an edge counts as lifted off.
OF_ENDS = 1e-6
#: Reach of tabulated kernels over that which the largest contact so far needs.
_KERNEL_MARGIN = 1.5
#: Accuracy of steps through graded layers over the tolerance.
_OF_STEPS = 1e-6
#: Depths whose fields are kept.
_LEVELS = 256
#: Chebyshev's points in g at first and at most; the last coefficients estimate the error; places at which
#: pressures are compared for that.
_FEW, _MANY, _LAST, _COMPARED = 9, 65, 2, np.array([-1.0, -0.6, 0.0, 0.6, 1.0])


@dataclass(frozen=True)
class LayersUnderPunch:
    """A half-plane at a speed under a punch: kernels, and contacts with any friction, which share these.

    Attributes:
        response: of the surface's solid.
        stack: layers with their substrate, lengths over the punch's unit; None without layers.
        tolerance: relative.
        punch: the punch, whose unit is the half-width where both its ends are sharp.
        every: solve each friction, however many there are.
        friction: σ_XY/σ_YY over the contact by the number g of a state and the half-width [m].
    """

    response: Any
    stack: LayersAtSpeed | None
    tolerance: float
    punch: Punch
    every: bool = False
    friction: Callable[[float, float], Along] = lambda g, h: constant(g)

    #: Largest error of stresses at each height over a at which they were evaluated.
    errors: dict[float, float] = field(default_factory=dict)

    #: Fields at the depths asked for last, each up to the largest distance so far.
    _levels: dict[float, Level] = field(default_factory=dict)

    def level(self, depth: float, reach: float) -> Level:
        """Fields at a depth, up to a distance from their load at least; lengths over the unit."""
        assert self.stack
        level = self._levels.pop(depth, None)
        if level is None or level.reach < reach:
            level = Level(self.stack, depth, reach, self.tolerance)
        self._levels[depth] = level
        if len(self._levels) > _LEVELS:
            del self._levels[next(iter(self._levels))]
        return level

    @cached_property
    def _kernels(self) -> list[Any]:
        return [Kernel(self.stack, self.tolerance / 1e3) if self.stack else UNIFORM]

    @property
    def kernel(self) -> Any:
        """The kernel with lengths over the shared unit."""
        return self._kernels[-1]

    def scaled(self, h: float, reach: float = REACH) -> Any:
        """The kernel of a contact of the half-width h, up to a distance over h at least."""
        if not self.stack:
            return UNIFORM
        if (needed := max(reach, REACH) * h) > self.kernel.reach:
            self._kernels.append(replace(self.kernel, reach=_KERNEL_MARGIN * needed))
        return Scaled(self.kernel, h)

    def interpolates(self, g: NDArray) -> bool:
        """True if contacts with frictions ``g``, (states,), are interpolated between few of them."""
        profile = self.punch.profile
        # Kinks move over the contact with friction, and edges lift off at one: nothing is smooth in it.
        rough = has_free_end(profile) and (isinstance(profile, Flat) or len(kinks(profile)))
        return not (self.every or rough or len(g) <= _FEW)

    def solved(self, g: NDArray) -> tuple[list[SolvedContact], float | None]:
        """Contacts from which those with all of ``g`` follow, and the error where they are interpolated.

        Args:
            g: σ_XY/σ_YY, sorted, (states,).
        """
        if not self.interpolates(g):
            return self._each(g), None
        count = _FEW
        middle, half = (g[-1] + g[0]) / 2.0, (g[-1] - g[0]) / 2.0
        while True:
            each = self._each(middle + half * np.cos(np.pi * np.arange(count) / (count - 1)))
            error = _unresolved(each)
            if error <= self.tolerance / 10.0 or count >= _MANY or count >= len(g):
                return each, error
            count = 2 * count - 1

    def _each(self, g: NDArray) -> list[SolvedContact]:
        contacts, h = self._contacts, 1.0
        for value in g.tolist():
            if value not in contacts:
                contacts[value] = self.contact(value, h)
            h = contacts[value].half_width
        return [contacts[value] for value in g.tolist()]

    @cached_property
    def _contacts(self) -> dict[float, SolvedContact]:
        """Solved contacts by friction."""
        return {}

    def contact(self, g: float, h: float = 1.0, checked: bool = True) -> SolvedContact:
        """The contact with a friction.

        Args:
            g: σ_XY/σ_YY.
            h: half-width to begin with.
            checked: the contact may not be wider than what is known of the punch.

        Raises:
            SolveError: no contact carries the load, or it is not resolved.
        """
        profile, unit = self.punch.profile, self.punch.unit
        solve: Callable[..., SolvedContact] = self._between_edges
        if has_free_end(profile):
            solve = self._tilted if isinstance(profile, Flat) else self._between_free_ends

        def at_resolution(resolution: Resolution) -> SolvedContact:
            nonlocal h
            contact = solve(g, h, resolution)
            h = contact.half_width
            return contact

        contact = converged(self._equation(g, 1.0), at_resolution, self.tolerance)
        m, h = contact.centre, contact.half_width
        if checked:
            check_reach(profile, unit * (m - h), unit * (m + h))
        return contact

    def half_width(self) -> float:
        """Half-width over the unit, without friction, of a contact with a free end, without its pressure.

        Raises:
            SolveError: no contact carries the load, or the half-width is not resolved.
        """
        equation, h, change = self._equation(0.0, 1.0), 1.0, np.inf
        for resolution in resolutions(equation):
            before = h
            _, h = self._free_ends(0.0, h, resolution)
            change = abs(h / before - 1.0)
            if change <= self.tolerance:
                break
        if change > _NEARLY:
            raise _not_resolved(equation, change, self.tolerance)
        return h

    def _equation(self, g: float, h: float, slope: Any = np.zeros_like) -> Equation:
        friction = self.friction(g, self.punch.unit * h)
        return Equation(self.response, self.scaled(h), friction, slope)

    def _between_edges(self, g: float, _: float, resolution: Resolution) -> SolvedContact:
        """Contact between two sharp corners at a resolution."""
        return SolvedContact(g, self._equation(g, 1.0, self.punch.slope(0.0, 1.0)).pressure(resolution))

    def _free_ends(self, g: float, h: float, resolution: Resolution) -> tuple[float, float]:
        """Centre and half-width of a contact with a free end, from the half-width h on."""
        if isinstance(self.punch.profile, Flat):
            contact = self._tilted(g, h, resolution)
            return contact.centre, contact.half_width
        rules: dict[float, Rule] = {}
        # On a uniform solid all half-widths share one rule, unless friction has a length.
        share = not self.stack and not self.friction(g, self.punch.unit).has_length

        def of_half_width(h: float) -> Rule:
            own = 1.0 if share else h
            if own not in rules:
                rules[own] = rule_of_ends(self._equation(g, own), resolution)
            return rules[own]

        rounding = ROUNDING if share else _OF_LENGTHS * self.tolerance
        return free_ends(self.punch, of_half_width, h, rounding=rounding)

    def _between_free_ends(self, g: float, h: float, resolution: Resolution) -> SolvedContact:
        """Contact between two free ends at a resolution, from the half-width h on."""
        m, h = self._free_ends(g, h, resolution)
        equation = self._equation(g, h, self.punch.slope(m, h))
        places = self.punch.kinks(m, h)
        if places and not equation.friction.varies:
            pressure, taken = kinked(equation, resolution, self.punch, m, h)
        else:
            pressure, taken = vanishing(replace(equation, kinks=places), resolution)
            if places and jumps(self.punch.profile):
                pressure = replace(pressure, tips=places)
        return SolvedContact(g, pressure, h, m, taken)

    def _tilted(self, g: float, h: float, resolution: Resolution) -> SolvedContact:
        """Contact of a tilted flat punch, the higher edge of which may have lifted off."""
        punch = self.punch
        whole, rise = punch.profile.half_width / punch.unit, punch.profile.rise
        side = 1 if rise > 0.0 else 0
        each: dict[float, tuple[Expansion, float]] = {}

        def load(h: float) -> float:
            """Logarithm of the load under which the higher end of the contact has no intensity."""
            equation = self._equation(g, h)
            parts = equation.pressures(resolution, (np.zeros_like, np.ones_like), (-2.0, 0.0))
            flat, bent = parts.series(ENDS)[:, side]
            # The slope over N/(2h) that leaves no intensity is (2h/(N/μ)) θ.
            slope = float(-flat / bent)
            each[h] = parts, slope
            carried = 2.0 * h * punch.unit * rise / punch.compression
            return logarithm_of_load(carried / slope) if slope else np.inf

        if load(whole) <= 0.0:
            slope = 2.0 * whole * punch.unit / punch.compression * rise
            return SolvedContact(g, each[whole][0].sum(np.array([1.0, slope])), whole)
        h = half_width_of_load(load, min(h, whole), punch)
        parts, slope = each[h]
        m = float(punch.profile.middle(punch.unit * h)) / punch.unit
        pressure = parts.sum(np.array([1.0, slope])).ending((side == 0, side == 1))
        return SolvedContact(g, pressure, h, m)


def under_punch(body: Any, response: Any, tolerance: float, every: bool = False) -> LayersUnderPunch:
    """A half-plane under the punch of a contact, with or without layers; lengths over its half-width."""
    unit = body.half_width
    stack = response.stack(unit, _OF_STEPS * tolerance) if body.solid.layers else None
    punch = Punch(body.profile, unit, body.compression)
    return LayersUnderPunch(response, stack, tolerance, punch, every, body.friction)


@lru_cache(maxsize=256)
def half_width_at_rest(solid: Layered, profile: Any, compression: float) -> float:
    """Half-width [m] of a contact at rest without friction, to five digits, over which others are given.

    Args:
        solid: the layers.
        profile: of the punch.
        compression: N/μ [m].

    Raises:
        SolveError: no contact carries the load.
    """
    response = solid.response(0.0)
    # That on the surface's solid alone is near enough to measure lengths by.
    at_rest = contacts(response, np.zeros(1), profile, compression, checked=False)
    (unit,) = at_rest.of("half_width").tolist()
    punch = Punch(profile, unit, compression)
    layers = LayersUnderPunch(response, response.stack(unit), _AT_REST, punch)
    return unit * layers.half_width()


def _unresolved(each: Sequence[SolvedContact]) -> float:
    """Relative error of contacts interpolated in g, from their last Chebyshev coefficients."""
    pressures = np.array([contact.pressure.series(_COMPARED) for contact in each])
    lengths = np.array([[contact.half_width, contact.centre] for contact in each])
    values = np.column_stack([pressures / np.abs(pressures).max(), lengths / lengths[:, 0].max()])
    x = np.cos(np.pi * np.arange(len(each)) / (len(each) - 1))
    c = np.linalg.solve(np.polynomial.chebyshev.chebvander(x, len(x) - 1), values)
    return float(np.abs(c[-_LAST:]).max() / np.abs(values).max())
