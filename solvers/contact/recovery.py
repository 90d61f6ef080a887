"""Contact pressure, edge exponents and stress intensity factors from consistent nodal forces.

Nodal forces tested with smooth functions give moments of the pressure that converge at twice the rate of
the displacement. So K_I and the smooth pressure follow from Jacobi moments, whose weight uses the
exponents of the local edge analysis; the exponents reported for the finite elements are fitted to the raw
pressure, for which none are assumed. The largest contact pressure and its place follow from the smooth
pressure.

All states of a speed are treated at once: a small matrix, made once, has all that depends on the mesh.

**Pressures that change fast towards the ends**, as over thin layers, have functions of their own. Without
its weight such a pressure varies over a length h next to the ends, and farther away over the distance
from the end. In

    ζ = [asinh((1 + r)/h) - asinh((1 - r)/h)]/asinh(2/h)

it is smooth everywhere, and few Chebyshev polynomials of ζ represent it for any h. On a solid that is
graded from the surface on it also has terms dⁿ logᵐ d, 1 <= m <= n, of the distance d from an end, which
no polynomial represents; the first of these terms, with u = d/(d + h/4) for d, stand before the
polynomials. Where elastic constants change much within h, omitted powers decrease slowly with the number
of functions, and the last functions measure their effect on the intensities.

**Next to ends and kinks.** Pressure and slopes are continued from a little farther away to free ends and
kinks, where finite elements have few digits. By the local analysis they are sums of two terms there: a
smooth function, and a smooth function times a power of the distance or its logarithm.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solveh_banded
from scipy.special import beta, roots_legendre

from ..approximation import lagrange
from ..friction.along import Along
from .along import ExpansionAlong
from .edges import under_punch
from .estimate import SAFETY
from .extremes import between, largest
from .panels import panels_of_slope
from .pressure import Expansion, Functions, Pressure

#: Number of moments. The pressure under a flat punch has a single one, and that under a polynomial one
#: more than its degree; the mesh and the truncation add further moments, and the highest measure how well
#: these are resolved.
MOMENTS, _HIGHEST = 9, 2


@dataclass(frozen=True)
class Polynomials(Functions):
    """Chebyshev polynomials of r, which follow a pressure without its weight on a uniform solid."""

    def values(self, r: NDArray, count: int) -> NDArray[np.float64]:
        """Values of ``count`` functions at r in [-1, 1], (len(r), count)."""
        return chebyshev(r, count)

    def coefficients(self, moments: NDArray, α: NDArray, β: NDArray) -> NDArray[np.float64]:
        """Coefficients of the smooth factor of pressures with given moments, (states, functions).

        Args:
            moments: ∫ σ_YY f_k dr of each state over N/(2a), (states, functions).
            α, β: exponents of the weight at X = a and X = -a, (states,); α + β = -1.
        """
        each = np.moveaxis(products(α, β, moments.shape[-1]), -1, 0)
        return np.asarray(np.linalg.solve(each, moments[..., None])[..., 0])

    def unresolved(self, c: NDArray) -> NDArray[np.float64]:
        """Relative error of smooth factors measured on the last functions, (states,)."""
        size = np.abs(c)
        return np.asarray(size[:, -_HIGHEST:].sum(axis=1) / size.max(axis=1))


def without_zeros(p: NDArray, zeros: NDArray) -> NDArray[np.float64]:
    """Chebyshev coefficients of smooth factors divided by 1 + r or 1 - r where they vanish at an end.

    Args:
        p: Chebyshev coefficients of the factors, (states, functions).
        zeros: True where a factor vanishes at r = -1 and at r = 1, (states, 2).

    Returns:
        Coefficients of the quotients, (states, functions).
    """
    chebyshev, coefficients, count = np.polynomial.chebyshev, np.array(p), p.shape[-1]
    for end, divisor in ((0, [1.0, 1.0]), (1, [1.0, -1.0])):  # 1 + r and 1 - r
        quotient = np.zeros((count, count))
        for k in range(1, count):
            quotient[k, :k] = chebyshev.chebdiv(np.eye(k + 1)[k], divisor)[0]
        coefficients = np.where(zeros[:, [end]], coefficients @ quotient, coefficients)
    return coefficients


def chebyshev(r: NDArray, count: int = MOMENTS) -> NDArray[np.float64]:
    """Chebyshev polynomials T_0, T_1, … at r in [-1, 1], (len(r), count)."""
    return np.polynomial.chebyshev.chebvander(np.clip(r, -1.0, 1.0), count - 1)


def products(α: Any, β: Any, count: int) -> NDArray[np.float64]:
    """Integrals ∫ (1-r)^α (1+r)^β T_m T_n dr, (count, count, ...), in the shape of the exponents.

    The products are halves of T_{m+n} + T_{|m-n|}, whose integrals follow from a three-term recurrence.
    """
    μ = [2.0 ** (α + β + 1.0) * beta(α + 1.0, β + 1.0)]
    μ.append(μ[0] * (β - α) / (α + β + 2.0))
    for k in range(1, 2 * count - 2):
        μ.append((2.0 * (β - α) * μ[k] + (k - 2.0 - α - β) * μ[k - 1]) / (k + 2.0 + α + β))
    n = np.arange(count)
    of = np.array(μ)
    return np.asarray((of[np.add.outer(n, n)] + of[np.abs(np.subtract.outer(n, n))]) / 2.0)


def from_moments(moments: NDArray, α: NDArray, β: NDArray) -> Expansion:
    """Pressure with given moments.

    Args:
        moments: ∫ σ_YY T_k dr of each state over N/(2a), (states, polynomials).
        α, β: exponents at X = a and X = -a by the local analysis of sharp edges, (states,): α + β = -1.
    """
    functions = Polynomials()
    return Expansion(α[:, None], β[:, None], functions.coefficients(moments, α, β), functions)


def fitted_exponent(d: NDArray, σ: NDArray) -> NDArray[np.float64]:
    """Exponent of σ ~ d^α by least squares on the logarithms, (states,); NaN where the sign changes.

    Args:
        d: distances, (q,).
        σ: stresses, (states, q).
    """
    x = np.log(d) - np.log(d).mean()
    one_sign = np.all(σ < 0.0, axis=1) | np.all(σ > 0.0, axis=1)
    slopes = np.log(np.where(one_sign[:, None], np.abs(σ), 1.0)) @ (x / (x @ x))
    return np.where(one_sign, slopes, np.nan)


class ContactFacets:
    """Piecewise polynomials on the facets of a contact, from their consistent nodal forces.

    Args:
        s: surface coordinates of the contact nodes in order of X, (n,).
        degree: polynomial degree p.
        chart: chart of the mesh, see :class:`galinx.meshes.charts.Chart`.

    Attributes:
        facets: numbers of the nodes of each facet, (F, p + 1).
        start, length: of each facet in the surface coordinate, (F,).
        nodes: nodes of a facet over its length, (p + 1,), of the widest, which rounding affects least.
    """

    def __init__(self, s: NDArray, degree: int, chart: Any) -> None:
        self._s, self._chart = s, chart
        self.facets = np.arange((len(s) - 1) // degree)[:, None] * degree + np.arange(degree + 1)
        self.start, self.length = s[self.facets[:, 0]], s[self.facets[:, -1]] - s[self.facets[:, 0]]
        widest = np.argmax(self.length)
        self.nodes = (s[self.facets[widest]] - self.start[widest]) / self.length[widest]

    def product(self, factor: Callable[[NDArray], NDArray]) -> NDArray[np.float64]:
        """Map from nodal forces of σ_YY to those of its product with a function of r, (n, n)."""
        degree = self.facets.shape[1] - 1
        t, w = roots_legendre(degree + 2)
        basis, _ = lagrange(self.nodes, (t + 1.0) / 2.0)
        s = self.start[:, None] + self.length[:, None] * (t + 1.0) / 2.0
        f = np.reshape(factor(self._chart.surface_position(s.ravel())), s.shape)
        product = np.zeros((len(self._s), len(self._s)))
        for facet, length, values in zip(self.facets, self.length, f):
            product[facet] += (basis.T * (values * w / 2.0 * length)) @ basis @ self._densities[facet]
        return product

    @cached_property
    def _densities(self) -> NDArray[np.float64]:
        """Densities of unit forces, (n, n)."""
        return self.density(np.eye(len(self._s)))

    def density(self, forces: NDArray) -> NDArray[np.float64]:
        """Density σ_YY dX/ds at the nodes by nodal forces, (n, ...) each, with the mass matrix."""
        degree = self.facets.shape[1] - 1
        t, w = roots_legendre(degree + 1)
        basis, _ = lagrange(self.nodes, (t + 1.0) / 2.0)
        unit_mass = basis.T * (w / 2.0) @ basis
        banded = np.zeros((degree + 1, len(self._s)))
        for row, length in zip(self.facets, self.length):
            mass = unit_mass * length
            for k in range(degree + 1):
                banded[degree - k, row[k:]] += np.diagonal(mass, k)
        return np.asarray(solveh_banded(banded, forces))

    def stress(self, density: NDArray, r: NDArray) -> NDArray[np.float64]:
        """Stress over N/(2a) at r under the punch, (..., q), by densities at the nodes, (..., n)."""
        s = self._chart.surface_coordinate(r)
        return (density @ self.interpolation(r).T) / self._chart.surface_stretch(s)

    def interpolation(self, r: NDArray) -> Any:
        """Map from a function's values at the nodes to those at r under the punch, sparse (q, n)."""
        from scipy.sparse import csr_matrix  # a slow import

        s = self._chart.surface_coordinate(r)
        facet = np.maximum(np.searchsorted(self.start, s, side="right") - 1, 0)
        values, _ = lagrange(self.nodes, (s - self.start[facet]) / self.length[facet])
        nodes = self.facets[facet]
        starts = np.arange(len(r) + 1) * nodes.shape[1]
        return csr_matrix((values.ravel(), nodes.ravel(), starts), (len(r), len(self._s)))


class ContactRecovery(ContactFacets):
    """Linear maps from nodal forces at the contact nodes of a mesh to raw pressure and its exponents.

    The raw pressure is the piecewise polynomial with these nodal forces: the mass matrix of the contact
    is solved, and no exponent is assumed. Exponents are fitted at its Gauss points, where a polynomial
    best approximates functions that it cannot represent.

    Args:
        s, degree, chart: as of :class:`ContactFacets`.
        r: positions X/a of the raw pressure, (points,).
        farthest: distance from an edge over a of the facets to which an exponent is fitted. The fit uses
            the outer half of them, two at least: the innermost cannot follow the singularity and disturb
            their neighbours, and beyond this distance the pressure's second term biases the exponent.

    Attributes:
        raw: map to the raw pressure at chosen positions, NaN outside the contact, (nodes, points).
        edges: for X = a and X = -a: distances from it over a, (q,), and the map to the raw pressure
            there, (nodes, q).
    """

    def __init__(self, s: NDArray, degree: int, chart: Any, r: NDArray, farthest: float = 1e-3) -> None:
        super().__init__(s, degree, chart)
        density, start, length = self.density(np.eye(len(s))), self.start, self.length  # symmetric
        inside = under_punch(r)
        self.raw = np.full((len(s), len(r)), np.nan)
        self.raw[:, inside] = self.stress(density, r[inside])
        t = (roots_legendre(degree)[0] + 1.0) / 2.0
        d_left, d_right, stretch = chart.under_punch(
            start[:, None] - s[0] + length[:, None] * t,
            s[-1] - (start + length)[:, None] + length[:, None] * (1.0 - t),
        )
        at_gauss = density[:, self.facets] @ lagrange(self.nodes, t)[0].T / stretch
        self.edges = []
        for d, to_σ in ((d_right[::-1], at_gauss[:, ::-1]), (d_left, at_gauss)):  # from the edge inwards
            last = max(int((d.max(axis=1) < farthest).sum()), 3)
            used = slice(min(last // 2, last - 2), last)
            self.edges.append((d[used].ravel(), to_σ[:, used].reshape(len(s), -1)))

    def exponents(self, forces: NDArray) -> NDArray[np.float64]:
        """Exponents at X = a and X = -a fitted to the raw pressure, (states, 2)."""
        return np.column_stack([fitted_exponent(d, forces @ to_σ) for d, to_σ in self.edges])


#: Distance from an end, over that of the nearest kink, nearer than which the pressure is continued.
_NEXT_TO_END = 0.02
#: Distances from an end, over that of the nearest kink, between which a function A(d) + d^a B(d), A and B
#: smooth, is sampled on either side: slopes next to an end, the pressure next to a cusp. Number of
#: samples, Chebyshev's in the root of d; terms of each of the two series.
_RANGE_AT_END, _SAMPLES, _TERMS_OF_EACH = (2e-5, 5e-2), 24, 3
#: Next to a kink: the nearest sample's distance over the farthest's; the least and the largest distance
#: of the farthest sample; and the truncation error of the series over the cube of that distance, which
#: may be a tenth of the tolerance.
_NEAREST_AT_KINK, _FARTHEST_AT_KINK, _LEFT_OUT = 0.015, (5e-3, 2e-2), 7e-4
#: Least distance of the farthest sample over the length of the innermost cell.
_CELLS_SAMPLED = 2.0
#: Distance of the farthest sample over the usual one, to measure the truncation error of the series.
FARTHER = 2.0
#: Distance from an end, over that of the nearest kink, up to which a remaining intensity is subtracted.
_CLEARED = 0.1


class Series:
    """Continuation of A(d) + d^a B(d), A and B smooth, to nearer distances d from an end or a kink.

    Where a is a whole number n, the second term is dⁿ log d times a smooth function.

    Args:
        gap: unit of the distances over a, of the next kink or end.
        span: distances of the nearest and the farthest sample, over the gap.
        exponent: a.
        at_end: add the terms of solids graded from the surface on, d^(a + 1) log d and d^(a + 2) log d,
            and that of a remaining intensity, d^(a - 1), the last of the terms.

    Attributes:
        samples: distances of the samples over a, (m,).
        amplitudes: map from values at the samples to amplitudes of the terms, (terms, m).
    """

    def __init__(
        self, gap: float, span: tuple[float, float], exponent: float, at_end: bool = False
    ) -> None:
        low, high = (np.sqrt(share * min(gap, 1.0)) for share in span)
        t = np.cos(np.pi * (np.arange(_SAMPLES) + 0.5) / _SAMPLES)
        self.samples = ((low + high) / 2.0 + (high - low) / 2.0 * t) ** 2
        self._farthest, self._exponent, self._at_end = high**2, exponent, at_end
        self.amplitudes = np.linalg.pinv(self.terms(self.samples))

    def terms(self, d: NDArray) -> NDArray[np.float64]:
        """Terms of both series at distances d, (n, terms)."""
        x, a, powers = d / self._farthest, self._exponent, np.arange(_TERMS_OF_EACH)
        log = np.log(np.maximum(x, np.finfo(float).tiny))[:, None]
        second = np.power.outer(x, a + powers) * (log if a % 1.0 == 0.0 else 1.0)
        both = [np.power.outer(x, powers), second]
        if self._at_end:
            both += [np.power.outer(x, a + powers[1:]) * log, x[:, None] ** (a - 1.0)]
        return np.concatenate(both, axis=1)

    def limit(self, values: NDArray) -> float:
        """Limit at d = 0 of values at the samples, (m,); the first term alone is left there."""
        return float(self.amplitudes[0] @ values)


def towards_kink(gap: float, exponent: float, farthest: float, farther: float = 1.0) -> Series:
    """Continuation of pressure or slopes to a kink where they are finite.

    Args:
        gap: distance of the next kink or end, over a.
        exponent: power of the distance d from the kink, below 1 at a cusp; a whole number n for dⁿ log d.
        farthest: usual distance of the farthest sample over the gap, from :func:`farthest_at_kink`.
        farther: distance of the farthest sample over the usual distance.
    """
    return Series(gap, (_NEAREST_AT_KINK * farthest, farther * farthest), exponent)


def farthest_at_kink(tolerance: float) -> float:
    """Distance from a kink, over that of the next kink or end, of the farthest sample.

    Nearer to the kink finite elements have fewer digits, farther away the series converge less.
    """
    return float(np.clip((0.1 * tolerance / _LEFT_OUT) ** (1.0 / 3.0), *_FARTHEST_AT_KINK))


def error_at_kink(usual: NDArray, farther: NDArray, in_cells: float | None = None) -> float:
    """Error of the limits from the left and the right of a kink, in their unit.

    One part is the truncation error, which grows with the distance like the first term that the series
    lack. The other is half of the difference of both limits, which should be equal.

    Samples in the innermost cells have the error of these, which hardly falls with the degree. Changes to
    values that have more of it, or less, then show it whole.

    Args:
        usual: both limits, (2,), from series sampled up to the usual distance.
        farther: both limits, (2,), from series sampled up to ``FARTHER`` times that distance.
        in_cells: value of the innermost cells at the kink; None where all samples are beyond these cells.
    """
    left_out = np.abs(farther - usual).max() / (FARTHER**_TERMS_OF_EACH - 1.0)
    if in_cells is not None:
        left_out = np.abs([farther - usual, in_cells - usual]).max()
    return float(SAFETY * left_out + np.ptp(usual) / 2.0)


def slopes_towards_ends(
    X: NDArray, gaps: tuple[float, float], exponents: tuple[float, float]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Map from displacement gradients a little farther away to those next to free ends.

    Nearer than ``_RANGE_AT_END`` a derivative of finite elements has fewer digits than two series have.
    A remaining intensity, d^(a - 1), is subtracted up to ``_CLEARED``: a free end has none, and the few
    moments of the pressure do not contain it.

    Args:
        X: positions over a, (n,).
        gaps: distances of the left and the right end from the nearest kink, over a.
        exponents: exponents a at the left and at the right end.

    Returns:
        Positions over a of the gradients that are needed, (m,), and the map from these, (n, m).
    """
    places, rows = [X], [np.eye(len(X))]
    for end, gap, a in zip((-1.0, 1.0), gaps, exponents):
        for side in (-1.0, 1.0):
            d = side * (X - end)
            near, cleared = (
                (d > 0.0) & (d < share * min(gap, 1.0)) for share in (_RANGE_AT_END[0], _CLEARED)
            )
            if cleared.any():
                series = Series(gap, _RANGE_AT_END, a, at_end=True)
                rows[0][near] = 0.0
                more = np.zeros((len(X), len(series.samples)))
                more[cleared] = -series.terms(d[cleared])[:, -1:] * series.amplitudes[-1]
                more[near] = series.terms(d[near])[:, :-1] @ series.amplitudes[:-1]
                places.append(end + side * series.samples)
                rows.append(more)
    return np.concatenate(places), np.concatenate(rows, axis=1)


def gaps_of(kinks: NDArray) -> tuple[float, float]:
    """Distances over a of the left and the right end from the nearest kink, or 2 without kinks."""
    return 1.0 + float(kinks.min(initial=1.0)), 1.0 - float(kinks.max(initial=-1.0))


class KinkedPressure(Pressure):
    """Pressure σ_YY over N/(2a) of one state, with free ends and kinks, from its nodal forces alone.

    Its moments would converge slowly where it has a logarithm. But cells are small and many there, so
    that the piecewise polynomial with these nodal forces is as accurate as the forces; towards ends and
    kinks it goes as the local analysis says.

    Args:
        s: surface coordinates of the contact nodes in order of X, (F p + 1,).
        degree: polynomial degree p.
        chart: chart of the mesh, see :class:`galinx.meshes.charts.Chart`.
        forces: consistent nodal forces over N/2, (F p + 1,).
        kinks: rising positions of the kinks over a, (k,).
        exponents: exponents of the pressure at the left and the right end, positive.
        at_ends: pressure that holds next to the ends.
        at_kinks: powers of the distance d with which the pressure departs from its values at kinks, see
            :func:`towards_kink`; 0 where it is infinite, (k,).
        tolerance: relative error allowed for the limit at a kink.
    """

    kinks: NDArray[np.float64]

    #: Both ends are free.
    K_I = np.zeros((1, 2))  # type: ignore[assignment]

    def __init__(
        self, s: NDArray, degree: int, chart: Any, forces: NDArray, kinks: NDArray,
        exponents: tuple[float, float], at_ends: Pressure, at_kinks: NDArray, tolerance: float,
    ) -> None:  # fmt: skip
        self._chart, self._at_kinks, self.at_ends = chart, at_kinks, at_ends
        self.kinks, (self.β, self.α) = kinks, exponents
        self._farthest = farthest_at_kink(tolerance)
        self._facets = ContactFacets(s, degree, chart)
        self._density = self._facets.density(forces)

    @property
    def breaks(self) -> NDArray[np.float64]:  # type: ignore[override]
        """Positions over a between which pressure times the chart's stretch is a polynomial, (n,)."""
        return np.asarray(self._chart.surface_position(self._facets.start[1:]))

    def cells_beside(self, places: NDArray) -> NDArray[np.float64]:
        """Length over a of the longer of the two facets that meet at each end or kink, (n,)."""
        return np.asarray(self._facets_beside(places).max(axis=0))

    def _facets_beside(self, places: NDArray) -> NDArray[np.float64]:
        """Lengths over a of the facets to the left and to the right of each end or kink, (2, n)."""
        edges = np.concatenate([[-1.0], self.breaks, [1.0]])
        lengths = np.pad(np.diff(edges), 1)
        i = np.abs(edges[:, None] - places).argmin(axis=0)
        return lengths[[i, i + 1]]

    def series(self, r: NDArray) -> NDArray[np.float64]:
        σ, inside = np.full(len(r), np.nan), under_punch(r)
        σ[inside] = self._piecewise(r[inside])
        for d, gap in zip((1.0 + r, 1.0 - r), gaps_of(self.kinks)):
            near = (d > 0.0) & (d < _NEXT_TO_END * min(gap, 1.0))
            σ[near] = self.at_ends.σ_YY(r[near])[0]
        for number in np.flatnonzero(self._at_kinks).tolist():
            at = self.kinks[number]
            for side in (-1.0, 1.0):
                series, d = self._series(number, side), side * (r - at)
                near = (d >= 0.0) & (d < series.samples.min())
                if near.any():
                    amplitudes = series.amplitudes @ self._piecewise(at + side * series.samples)
                    σ[near] = series.terms(d[near]) @ amplitudes
        return (σ / ((1.0 - r) ** self.α * (1.0 + r) ** self.β))[None]

    def largest(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Largest pressure over N/(2a), and its place over a, NaN where it is infinite, (1,) each."""
        if not self._at_kinks.all():
            return np.full(1, np.nan), np.full(1, np.nan)
        pieces = self._facets.start[:, None] + self._facets.length[:, None] * self._facets.nodes
        ends = np.concatenate([[-1.0], self.breaks, [1.0]])
        at_turn = np.isin(ends, [-1.0, *ends[np.abs(ends[:, None] - self.kinks).argmin(axis=0)], 1.0])
        open_, pressure = at_turn[:-1] | at_turn[1:], lambda r: -self.σ_YY(r)[0]
        top = max(
            largest(pressure, [*between(ends)[open_]], ends=False),
            largest(pressure, [*self._chart.surface_position(pieces[~open_])]),
            *((-self.at_kink(i), float(kink)) for i, kink in enumerate(self.kinks)),
            *zip(pressure(self.kinks).tolist(), self.kinks.tolist()),
        )
        return np.array(top[:1]), np.array(top[1:])

    def at_kink(self, number: int) -> float:
        """Contact stress σ_YY over N/(2a) at a kink."""
        return self.limit_at_kink(number, self._piecewise)

    def limit_at_kink(self, number: int, values: Callable[[NDArray], NDArray]) -> float:
        """Stress or strain at a kink at which it is finite: the mean of limits from both sides.

        A limit is taken because the innermost cells are so small that rounding of the nodal forces shows
        in their values.

        Args:
            number: number of the kink, from the left.
            values: function of positions over a, (n,), that gives the stress or strain, (n,).
        """
        return float(np.mean(self._limits(number, values)))

    @property
    def left_at_kinks(self) -> float:
        """Largest error over N/(2a) of the limits at kinks, measured on limits from both sides."""
        errors = [0.0]
        for number in np.flatnonzero(self._at_kinks).tolist():
            kink = self.kinks[[number]]
            nearest = [self._series(number, side).samples.min() for side in (-1.0, 1.0)]
            in_cells = bool((nearest < self._facets_beside(kink)[:, 0]).any())
            usual, farther = (self._limits(number, self._piecewise, by) for by in (1.0, FARTHER))
            errors.append(error_at_kink(usual, farther, self._piecewise(kink)[0] if in_cells else None))
        return max(errors)

    def _limits(
        self, number: int, values: Callable[[NDArray], NDArray], farther: float = 1.0
    ) -> NDArray[np.float64]:
        """Limits from the left and the right of a kink, (2,)."""
        each = [(side, self._series(number, side, farther)) for side in (-1.0, 1.0)]
        kink = self.kinks[number]
        return np.array([series.limit(values(kink + side * series.samples)) for side, series in each])

    def _series(self, number: int, side: float, farther: float = 1.0) -> Series:
        """Continuation of the pressure to a kink from one side."""
        gaps = np.diff(np.concatenate([[-1.0], self.kinks, [1.0]]))[number : number + 2]
        right = int(side > 0.0)
        # Either side's series are smooth as far as the nearer neighbour, whichever side that is on; but
        # samples that all lie in the innermost cell would show nothing of its error.
        cell = float(self._facets_beside(self.kinks[[number]])[right, 0])
        gap = min(float(gaps[right]), max(float(gaps.min()), _CELLS_SAMPLED * cell / self._farthest))
        return towards_kink(gap, float(self._at_kinks[number]), self._farthest, farther)

    def _piecewise(self, r: NDArray) -> NDArray[np.float64]:
        """Contact stress over N/(2a) of the piecewise polynomial at positions over a, (n,)."""
        return self._facets.stress(self._density, r)


def on_panels(pressure: Pressure, row: int, α: float, β: float, friction: Along) -> Expansion:
    """Pressure of one of several states by its values on panels, with the field below it.

    It has no kinks but those of friction.

    Where an end is free a factor 1 - r or 1 + r of the weight is one of the values.

    Args:
        pressure: of several states.
        row: number of the state among these.
        α, β: exponents of its pressure at the right and the left end.
        friction: σ_XY/σ_YY over X/a.
    """
    sharp_α, sharp_β = α - (α > 0.0), β - (β > 0.0)
    panels = replace(panels_of_slope(-sharp_α, friction.jumps, friction.varies), β=sharp_β)
    inner = np.clip(panels.t, -pressure.near, pressure.near)
    # 1 - t = 2/(1 + e^x) has all its digits next to an end.
    right, left = (2.0 / (1.0 + np.exp(sign * panels.x)) for sign in (1.0, -1.0))
    factor = np.atleast_2d(pressure.series(inner))[row]
    c = factor * right ** (α - sharp_α) * left ** (β - sharp_β)
    if friction.varies:
        return ExpansionAlong(sharp_α, sharp_β, c, panels, friction=friction)
    return Expansion(sharp_α, sharp_β, c, panels)
