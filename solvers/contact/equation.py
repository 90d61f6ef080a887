"""The singular integral equation of a punch on a layered half-plane.

    (n̂/π) ⨍ σ(t)/(t - r) dt - g q σ(r) + ∫ K(r - t) σ(t) dt = μ v,X(r),   ∫ σ dr = -2,

σ = σ_YY, n̂ = n + g n₁₂ of the surface's solid, K of :mod:`galinx.solvers.layers.kernel`. The dominant
part is that of a half-plane, and so are the exponents. The pressure is a sum of Jacobi polynomials under
their weight; its integrals with K are done by Gauss's rule. Where K is rough, panels replace them.

A prescribed pressure is linear between knots (:mod:`.prescribed_pressure`). It is integrated by Gauss's
rule on pieces between knots, as short as the kernel requires; where the kernel has a logarithm, graded
towards it. The part of the half-plane of the surface's solid is known exactly.

Any number of frictions at one speed share the kernels, which do not depend on friction
(:class:`ContactsAtSpeed`). A pressure without its weight is an analytic function of g = σ_XY/σ_YY: beyond
a few frictions the equation is solved at Chebyshev's points in g, and interpolated between them.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray
from scipy.special import roots_jacobi

from ..approximation import barycentric
from ..errors import SolveError
from ..layers.kernel import Kernel, Scaled
from ..layers.layered import LayersAtSpeed
from .panelled import Panels
from .panelled import parts as panelled
from .pressure import ENDS, Expansion, Functions, Pressure

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
        t, w = gauss(max(_FINE, 2 * len(c)), self.α, self.β)
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
#: Longest panel at first where the kernel is rough, over the contact's half-width, its factor from step
#: to step, and the number of steps.
_COARSE, _SHORTER, _TIMES = 1.4, 0.7, 12


@dataclass(frozen=True)
class Parts:
    """Pressures whose sums are other pressures.

    Attributes:
        coefficients: of each pressure, (unknowns, parts).
        made: makes a pressure of coefficients, (unknowns,).
    """

    coefficients: NDArray[np.float64]
    made: Callable[[NDArray], Pressure]

    def pressure(self, amplitudes: NDArray) -> Pressure:
        """Sum of the parts with amplitudes, (parts,)."""
        return self.made(self.coefficients @ amplitudes)

    @property
    def ends(self) -> NDArray[np.float64]:
        """Values of p at the left and the right end, (2, parts)."""
        return np.stack([self.made(c).series(ENDS) for c in self.coefficients.T], axis=-1)


class _NoLayers:
    """Kernel of a uniform half-plane, whose equation has none."""

    rough = False

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
        g: σ_XY/σ_YY under the punch.
        slope: μ v,X under the punch over N/(2a) at given r.
        kinks: places r next to which the slope is not smooth.
    """

    response: Any
    kernel: Any
    g: float
    slope: Slope
    kinks: tuple[float, ...] = ()

    @property
    def n(self) -> float:
        """n̂ = n + g n₁₂, dimensionless."""
        return float(self.response.n + self.g * self.response.n12)

    @cached_property
    def α(self) -> float:
        """Exponent at X = a, that of the surface's solid, dimensionless."""
        return float(-0.5 - np.arctan2(self.g * self.response.q, self.n) / np.pi)

    @property
    def β(self) -> float:
        """Exponent at X = -a, dimensionless."""
        return -1.0 - self.α

    def pressure(self, resolution: Resolution) -> Pressure:
        """Pressure with resultant -2 at a resolution."""
        return self.parts(resolution, [self.slope], [-2.0]).pressure(np.ones(1))

    def parts(self, resolution: Resolution, slopes: Sequence[Slope], loads: Sequence[float]) -> Parts:
        """Pressures under several slopes with resultants ``loads``, whose sums are other pressures."""
        if isinstance(resolution, float):
            panels, values = panelled(self, resolution, slopes, loads)
            return Parts(values, panels.pressure)
        c = self._coefficients(resolution, slopes, loads)
        return Parts(c, lambda c: Expansion(self.α, self.β, c, Jacobi(self.α, self.β)))

    def _coefficients(
        self, terms: int, slopes: Sequence[Slope], loads: Sequence[float]
    ) -> NDArray[np.float64]:
        """Coefficients of ``terms`` polynomials for each slope and load, (terms, slopes)."""
        t, w = gauss(terms, self.α, self.β)
        r, _ = gauss(terms - 1, -self.α, -self.β)
        P = jacobi(terms, self.α, self.β, t)
        A = np.empty((terms, terms))
        A[:-1] = self.n / np.pi * (w / (t - r[:, None])) @ P
        by_kernel = self.kernel(r[:, None] - t)
        A[:-1] += (w * (by_kernel[..., 3] + self.g * by_kernel[..., 2])) @ P
        A[-1] = w @ P
        b = np.vstack([np.stack([slope(r) for slope in slopes], axis=-1), loads])
        return np.asarray(np.linalg.solve(A, b))


@dataclass(frozen=True)
class SolvedContact:
    """A contact with its pressure; lengths are over a unit that all states share.

    Attributes:
        pressure: the pressure.
        before: the pressure with fewer unknowns; None at a single resolution.
        change: relative change of the pressure and its intensities with the number of unknowns.
        half_width: of the contact.
        centre: its middle, from the punch's axis.
        free: True where the left and the right end are free, and were solved for.
    """

    pressure: Pressure
    before: Any = None
    change: float = 0.0
    half_width: float = 1.0
    centre: float = 0.0
    free: tuple[bool, bool] = (False, False)

    def moved(self, before: "SolvedContact") -> float:
        """Relative change of lengths and pressure since ``before``; next to free ends with a factor.

        In-plane stresses follow the pressure with such a factor there.
        """
        lengths = max(abs(self.half_width - before.half_width), abs(self.centre - before.centre))
        ends = [side * (1.0 - _NEXT_TO_END) for side, free in zip((-1.0, 1.0), self.free) if free]
        at = np.concatenate([*ends, _ACROSS])
        earlier, later = (
            (1.0 - at) ** p.α * (1.0 + at) ** p.β * p.series(at) for p in (before.pressure, self.pressure)
        )
        near = np.abs(earlier - later)[: -len(_ACROSS)].max(initial=0.0) / np.abs(later).max()
        of_pressure = change(before.pressure, self.pressure)
        return max(of_pressure, lengths / self.half_width, _MORE_AT_ENDS * float(near))


def converged(
    at_resolution: Callable[[Resolution], SolvedContact], tolerance: float, rough: bool
) -> SolvedContact:
    """Contact to a relative tolerance, by finer and finer resolutions.

    Args:
        at_resolution: gives the contact at a resolution; its ``change`` is that by a correction.
        tolerance: the tolerance.
        rough: True where the kernel is rough.

    Raises:
        SolveError: the tolerance was not reached; the message says by how much.
    """
    before, error = None, np.inf
    for resolution in resolutions(rough):
        now = at_resolution(resolution)
        if before is not None:
            error = max(now.moved(before), now.change)
            if is_converged(error, tolerance):
                return replace(now, before=before.pressure, change=error)
        before = now
    raise not_converged(error, tolerance)


def converged_pressure(equation: Equation, tolerance: float) -> SolvedContact:
    """Contact with the pressure of an equation, to a relative tolerance.

    Raises:
        SolveError: the tolerance was not reached; the message says by how much.
    """
    check_exponents(equation)
    return converged(lambda at: SolvedContact(equation.pressure(at)), tolerance, equation.kernel.rough)


def check_exponents(equation: Equation) -> None:
    """Check that the pressure can be resolved up to its edges.

    Raises:
        SolveError: an exponent is too close to -1.
    """
    least = 1.0 + min(equation.α, equation.β)
    if not least >= _STRONGEST:
        raise SolveError(
            f"the pressure's exponent at an edge is -1 + {least:.2g}, expected at least -1 + "
            f"{_STRONGEST:g}: all of it acts at that edge; take less friction"
        )


def is_converged(moved: float, tolerance: float) -> bool:
    """Return True if a relative change with the resolution is small enough."""
    return moved <= tolerance / 4.0 or moved <= _ROUNDING


def not_converged(moved: float, tolerance: float) -> SolveError:
    """Error of a pressure that still changes with the most unknowns."""
    return SolveError(
        f"with the most unknowns the pressure still changes by {moved:.2g}, expected {tolerance:g}: "
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


def change(before: Pressure, now: Pressure) -> float:
    """Largest change of intensities and p, relative to the largest |p|; not next to tips."""
    at = np.concatenate([ENDS, _LOOKED_AT])
    for tip in now.tips:
        at = at[np.abs(at - tip) > NEAR_TIP]
    earlier, later = before.series(at), now.series(at)
    return float(np.abs(earlier - later).max() / np.abs(later).max())


#: Chebyshev's points in g at first and at most; the last coefficients estimate the error.
_FEW, _MANY, _LAST = 9, 65, 2


@dataclass(frozen=True)
class ContactsAtSpeed:
    """Contacts with any friction at one speed, which share kernels.

    Attributes:
        response: of the surface's solid.
        stack: layers with their substrate, lengths over a.
        slope: μ v,X under the punch over N/(2a) at given r.
        tolerance: relative.
    """

    response: Any
    stack: LayersAtSpeed
    slope: Callable[[NDArray], NDArray]
    tolerance: float

    @cached_property
    def kernel(self) -> Kernel:
        return Kernel(self.stack, self.tolerance / 1e3)

    def solved(self, g: NDArray) -> tuple["Contacts", NDArray[np.float64]]:
        """Pressures from which those at all of ``g`` are interpolated, and the error of that, (1,).

        Args:
            g: σ_XY/σ_YY, sorted, (states,).
        """
        if len(g) <= _FEW:
            return Contacts(g, self._each(g)), np.zeros(1)
        count = _FEW
        middle, half = (g[-1] + g[0]) / 2.0, (g[-1] - g[0]) / 2.0
        while True:
            nodes = middle + half * np.cos(np.pi * np.arange(count) / (count - 1))
            frictions = Contacts(nodes, self._each(nodes))
            error = frictions.unresolved
            if error <= self.tolerance / 10.0 or count >= _MANY or count >= len(g):
                return frictions, np.array([error])
            count = 2 * count - 1

    def _each(self, g: NDArray) -> list[SolvedContact]:
        equations = (Equation(self.response, self.kernel, value, self.slope) for value in g.tolist())
        return [converged_pressure(equation, self.tolerance) for equation in equations]

    def scaled(self, h: float) -> Scaled:
        """The kernel of a contact of the half-width h."""
        return Scaled(self.kernel, h)

    @property
    def rounding(self) -> float:
        """Relative error of the pressure by that of the kernel."""
        return 2.0 * np.pi * self.kernel.error / abs(self.response.n)


@dataclass(frozen=True)
class Contacts:
    """Contacts with several frictions, from which those with others are interpolated.

    Attributes:
        g: σ_XY/σ_YY, (nodes,).
        each: contacts, one for each g.
    """

    g: NDArray[np.float64]
    each: list[SolvedContact]

    @property
    def near(self) -> float:
        """|r| up to which p of all pressures can be evaluated."""
        return min(p.near for contact in self.each for p in (contact.pressure, contact.before))

    @cached_property
    def half_width(self) -> NDArray[np.float64]:
        """Half-width of every contact, (nodes,)."""
        return np.array([contact.half_width for contact in self.each])

    @cached_property
    def centre(self) -> NDArray[np.float64]:
        """Middle of every contact, (nodes,)."""
        return np.array([contact.centre for contact in self.each])

    @cached_property
    def free(self) -> NDArray[np.float64]:
        """1 where the left and the right end are free, 0 where they are not, (nodes, 2)."""
        return np.array([contact.free for contact in self.each], dtype=float)

    @cached_property
    def tips(self) -> NDArray[np.float64]:
        """Places at which the pressure is infinite inside the contact, (nodes, k); infinity for none."""
        each = [contact.pressure.tips for contact in self.each]
        places = np.full((len(each), max(map(len, each))), np.inf)
        for row, tips in zip(places, each):
            row[: len(tips)] = tips
        return places

    def read(self, what: Callable[[Any], NDArray]) -> NDArray[np.float64]:
        """Values of a function of every pressure, (nodes, ...)."""
        return np.array([what(contact.pressure) for contact in self.each])

    def both(self, what: Callable[[Any], NDArray]) -> NDArray[np.float64]:
        """Values of a function of every pressure, and of that with fewer unknowns, (2, nodes, ...)."""
        return self.of_each(lambda pressure, g, h: what(pressure))

    def of_each(self, what: Callable[[Any, float, float], NDArray]) -> NDArray[np.float64]:
        """Values of a function of pressure, friction and half-width, (2, nodes, ...).

        Those of every contact come first, then those of the pressures with fewer unknowns.
        """
        nodes = list(zip(self.each, self.g.tolist(), self.half_width.tolist()))
        return np.array(
            [
                [what(contact.pressure, g, h) for contact, g, h in nodes],
                [what(contact.before, g, h) for contact, g, h in nodes],
            ]
        )

    @cached_property
    def unresolved(self) -> float:
        """Relative error of pressures interpolated in g, from their last Chebyshev coefficients."""
        values = self.smooth
        x = np.cos(np.pi * np.arange(len(self.g)) / (len(self.g) - 1))
        c = np.linalg.solve(np.polynomial.chebyshev.chebvander(x, len(x) - 1), values)
        return float(np.abs(c[-_LAST:]).max() / np.abs(values).max())

    @property
    def smooth(self) -> NDArray[np.float64]:
        """Samples of every contact that are smooth in g, (nodes, n)."""
        r = np.array([-1.0, -0.6, 0.0, 0.6, 1.0])
        pressures = self.read(lambda pressure: pressure.series(r))
        lengths = np.column_stack([self.half_width, self.centre]) / self.half_width.max()
        return np.column_stack([pressures / np.abs(pressures).max(), lengths])

    def at(self, g: NDArray) -> NDArray[np.float64]:
        """Weights that interpolate values of every pressure to other frictions, (states, nodes)."""
        weights = (-1.0) ** np.arange(len(self.g))
        weights[[0, -1]] /= 2.0
        return barycentric(self.g, weights, g)

    @property
    def change(self) -> float:
        """Largest relative change of a pressure with the number of unknowns."""
        return max(contact.change for contact in self.each)
