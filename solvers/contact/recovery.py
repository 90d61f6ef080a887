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
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, lru_cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.linalg import solveh_banded
from scipy.special import gammaln, roots_legendre

from ..approximation import lagrange
from .edges import under_punch
from .panels import Panels
from .pressure import Expansion, Functions

#: Number of moments. The pressure under a flat punch has a single one; the mesh, the truncation or
#: another profile add further moments, and the highest measure how well these are resolved.
MOMENTS = 9


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
        maps = _to_factors(np.asarray(α).tobytes(), np.asarray(β).tobytes())
        return np.asarray(np.einsum("skm,sm->sk", maps, moments))

    def unresolved(self, c: NDArray) -> NDArray[np.float64]:
        """Relative error of smooth factors measured on the last functions: 0, as these suffice."""
        return np.zeros(len(c))

    def moved_edges(self, pressure: Expansion, r: NDArray, _: float) -> NDArray[np.float64]:
        """Change of the smooth factor where both edges are misplaced, 0: no edge of the mesh is."""
        return np.zeros((len(pressure.c), len(r)))


def without_zeros(p: NDArray, zeros: NDArray) -> NDArray[np.float64]:
    """Chebyshev coefficients of smooth factors divided by 1 + r or 1 - r where they vanish at an end.

    Args:
        p: Chebyshev coefficients of the factors, (states, ``MOMENTS``).
        zeros: True where a factor vanishes at r = -1 and at r = 1, (states, 2).

    Returns:
        Coefficients of the quotients, (states, ``MOMENTS``).
    """
    coefficients = np.array(p)
    for end, divisor in ((0, [1.0, 1.0]), (1, [1.0, -1.0])):  # 1 + r and 1 - r
        quotient = np.zeros((MOMENTS, MOMENTS))
        for k, row in enumerate(np.eye(MOMENTS)):
            part = np.polynomial.chebyshev.chebdiv(row[: k + 1], divisor)[0]
            quotient[k, : len(part)] = part
        coefficients = np.where(zeros[:, [end]], coefficients @ quotient, coefficients)
    return coefficients


def chebyshev(r: NDArray, count: int = MOMENTS) -> NDArray[np.float64]:
    """Chebyshev polynomials T_0, T_1, … at r in [-1, 1], (len(r), count)."""
    return np.polynomial.chebyshev.chebvander(np.clip(r, -1.0, 1.0), count - 1)


def from_moments(
    moments: NDArray, α: NDArray, β: NDArray, functions: "Polynomials | Stretch" = Polynomials()
) -> Expansion:
    """Pressure with given moments.

    Args:
        moments: ∫ σ_YY f_k dr of each state over N/(2a), (states, functions).
        α, β: exponents at X = a and X = -a, (states,); of polynomials those of the local analysis of
            sharp edges, α + β = -1.
        functions: functions f_k, which represent the smooth factor.
    """
    return Expansion(α[:, None], β[:, None], functions.coefficients(moments, α, β), functions)


@lru_cache(maxsize=4)
def _to_factors(α: bytes, β: bytes) -> NDArray[np.float64]:
    """Maps from moments to coefficients of the smooth factor, (states, k, moments).

    Levels by which an error is measured have equal exponents, so recent maps are kept.
    """
    of = np.frombuffer(α), np.frombuffer(β)
    P = jacobi_in_chebyshev(*of)
    return P.swapaxes(1, 2) @ (P / jacobi_norms(*of)[..., None])


def jacobi_in_chebyshev(α: NDArray, β: NDArray) -> NDArray[np.float64]:
    """Chebyshev coefficients of P_n^(α,β), α + β = -1, by the three-term recurrence: (states, n, k)."""
    P = np.zeros((len(α), MOMENTS, MOMENTS))
    P[:, 0, 0] = 1.0
    P[:, 1, 0], P[:, 1, 1] = α + 0.5, 0.5
    for n in range(1, MOMENTS - 1):
        last = P[:, n]
        times_r = np.zeros_like(last)  # r T_k = (T_{k+1} + T_{|k-1|})/2
        times_r[:, 1:] += last[:, :-1] / 2.0
        times_r[:, :-1] += last[:, 1:] / 2.0
        times_r[:, 1] += last[:, 0] / 2.0
        leading = (2 * n + 1) * (2 * n - 1) * times_r + (β - α)[:, None] * last
        trailing = ((n + α) * (n + β) * (2 * n + 1) / n)[:, None] * P[:, n - 1]
        P[:, n + 1] = (leading - trailing) / ((n + 1) * (2 * n - 1))
    return P


def jacobi_norms(α: NDArray, β: NDArray) -> NDArray[np.float64]:
    """Norms ∫ (1-r)^α (1+r)^β P_n² dr of Jacobi polynomials for α + β = -1, (states, n).

    Γ(n+α+1) Γ(n+β+1)/(2n n! Γ(n)), and π/sin(π(1+α)) for n = 0.
    """
    n = np.arange(1, MOMENTS)
    a, b = α[:, None], β[:, None]
    logs = gammaln(n + a + 1.0) + gammaln(n + b + 1.0) - gammaln(n + 1.0) - gammaln(n)
    return np.concatenate([np.pi / np.sin(np.pi * (1.0 + a)), np.exp(logs) / (2.0 * n)], axis=1)


@dataclass(frozen=True)
class ContactRecovery:
    """Linear maps from nodal forces to moments and to the raw pressure; they depend on the mesh alone.

    Attributes:
        moments: map to ∫ σ_YY T_k dr, or to moments with other test functions, (nodes, moments).
        raw: map to the raw pressure at chosen positions, NaN outside the contact, (nodes, points).
        edges: for X = a and X = -a: distances from it over a, (q,), and the map to the raw pressure
            there, (nodes, q).
    """

    moments: NDArray[np.float64]
    raw: NDArray[np.float64]
    edges: tuple[tuple[NDArray[np.float64], NDArray[np.float64]], ...]

    def exponents(self, forces: NDArray) -> NDArray[np.float64]:
        """Exponents at X = a and X = -a fitted to the raw pressure, (states, 2)."""
        return np.column_stack([fitted_exponent(d, forces @ to_σ) for d, to_σ in self.edges])


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


def contact_recovery(
    s: NDArray,
    degree: int,
    chart: Any,
    r: NDArray,
    farthest: float = 1e-3,
    tests: Callable[[NDArray], NDArray] = chebyshev,
) -> ContactRecovery:
    """Linear maps from nodal forces at the contact nodes of a mesh to moments and raw pressure.

    The raw pressure is the piecewise polynomial with these nodal forces: the mass matrix of the contact
    is solved, and no exponent is assumed. Exponents are fitted at its Gauss points, where a polynomial
    best approximates functions that it cannot represent.

    Args:
        s: surface coordinates of the contact nodes in order of X, (F p + 1,).
        degree: polynomial degree p.
        chart: chart of the mesh, see :class:`galinx.meshes.charts.Chart`.
        r: positions X/a of the raw pressure, (points,).
        farthest: distance from an edge over a of the facets to which an exponent is fitted. The fit uses
            the outer half of them, two at least: the innermost cannot follow the singularity and disturb
            their neighbours, and beyond this distance the pressure's second term biases the exponent.
        tests: smooth functions of r, (points, moments), with which forces are tested.
    """
    contact = ContactFacets(s, degree, chart)
    density = contact.density(np.eye(len(s)))  # symmetric
    facets, start, length = contact.facets, contact.start, contact.length
    inside = under_punch(r)
    raw = np.full((len(s), len(r)), np.nan)
    raw[:, inside] = contact.stress(density, r[inside])

    t = (roots_legendre(degree)[0] + 1.0) / 2.0
    d_left, d_right, stretch = chart.under_punch(
        start[:, None] - s[0] + length[:, None] * t,
        s[-1] - (start + length)[:, None] + length[:, None] * (1.0 - t),
    )
    at_gauss = density[:, facets] @ lagrange(contact.nodes, t)[0].T / stretch
    edges = []
    for d, to_σ in ((d_right[::-1], at_gauss[:, ::-1]), (d_left, at_gauss)):  # from the edge inwards
        last = max(int((d.max(axis=1) < farthest).sum()), 3)
        used = slice(min(last // 2, last - 2), last)
        edges.append((d[used].ravel(), to_σ[:, used].reshape(len(s), -1)))
    return ContactRecovery(tests(chart.surface_position(s)), raw, tuple(edges))


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
        density, product = self.density(np.eye(len(self._s))), np.zeros((len(self._s), len(self._s)))
        for facet, length, values in zip(self.facets, self.length, f):
            product[facet] += (basis.T * (values * w / 2.0 * length)) @ basis @ density[facet]
        return product

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
        return self.interpolated(density, r) / self._chart.surface_stretch(s)

    def interpolated(self, nodal: NDArray, r: NDArray) -> NDArray[np.float64]:
        """Values at r under the punch, (..., q), of functions by their values at the nodes, (..., n)."""
        s = self._chart.surface_coordinate(r)
        facet = np.clip(np.searchsorted(self.start, s, side="right") - 1, 0, len(self.start) - 1)
        values, _ = lagrange(self.nodes, (s - self.start[facet]) / self.length[facet])
        return np.einsum("qi,...qi->...q", values, nodal[..., self.facets[facet]])


#: Longest panel of the quadrature for products of functions, over the smaller of 1 and h.
_FINE = 0.3
#: Number of last polynomials that measure how well a pressure is resolved, and on graded solids, where
#: the remainder falls like a power of their number.
_LAST, _LAST_GRADED = 2, 4
#: Remainder on graded solids over the part of the last polynomials, where the solid softens and where it
#: stiffens with depth; measured on layers whose moduli fall to a tenth or grow three to three hundred
#: times, 0.1 to 1.5 a thick, with 18 to 46 functions. In stiffening ones the pressure changes within less
#: than h, which no number of functions follows.
_TAIL, _TAIL_STIFFENING = 4.0, 16.0
#: Highest power of the distance from an end, with its logarithms, among the functions of an end.
_POWERS = 3
#: Distance over h beyond which functions of an end are nearly constant; for a larger one functions become
#: nearly dependent.
_SHARE = 0.25
#: Both ends of the contact.
_ENDS = np.array([-1.0, 1.0])
#: Fewest polynomials beside functions of the ends.
_FEWEST = 6
#: Number of functions of both ends.
_OF_ENDS = _POWERS * (_POWERS + 1)
#: Times that functions are made orthonormal: rounding spoils the first result.
_TIMES = 2


@dataclass(frozen=True)
class Stretch(Functions):
    """Functions of a coordinate stretched towards the ends, which follow a pressure without its weight.

    Attributes:
        h: length over a within which the pressure changes next to an end.
        graded: True where the solid is graded from the surface on.
        stiffens: True where it stiffens with depth from the surface on.
    """

    h: float
    graded: bool = False
    stiffens: bool = False

    def __call__(self, r: ArrayLike) -> NDArray[np.float64]:
        """Stretched coordinate ζ in [-1, 1] at r, in the shape of r."""
        r = np.asarray(r, dtype=float)
        ζ = np.arcsinh((1.0 + r) / self.h) - np.arcsinh((1.0 - r) / self.h)
        return np.asarray(np.clip(ζ / np.arcsinh(2.0 / self.h), -1.0, 1.0))

    def functions(self, r: NDArray, count: int) -> NDArray[np.float64]:
        """Functions of the ends, then ``count`` polynomials of ζ, at r, (len(r), functions)."""
        if not self.graded:
            return chebyshev(self(r), count)
        r = np.clip(r, -1.0, 1.0)  # a contact node at an edge may be a rounding beyond it
        with np.errstate(divide="ignore"):
            x = np.log1p(r) - np.log1p(-r)
        return _rule(-0.5, -0.5, self).interpolated(_orthonormal(self, count), x)

    def of_ends(self, r: NDArray, count: int) -> NDArray[np.float64]:
        """Functions as in :meth:`functions`, before they are orthonormal, (len(r), functions)."""
        columns = []
        for d in (1.0 - r, 1.0 + r):
            d = np.maximum(d, 0.0)
            u = d / (d + _SHARE * self.h)
            log = np.log(np.maximum(u, np.finfo(float).tiny))
            columns += [u**n * log**m for n in range(1, _POWERS + 1) for m in range(1, n + 1)]
        return np.column_stack([*columns, chebyshev(self(r), count)])

    def polynomials(self, functions: int) -> int:
        """Number of polynomials among a number of functions."""
        return functions - _OF_ENDS * self.graded

    def values(self, r: NDArray, count: int) -> NDArray[np.float64]:
        """Values of ``count`` functions at r, those of the ends among them, (len(r), count)."""
        return self.functions(r, self.polynomials(count))

    def coefficients(self, moments: NDArray, α: NDArray, β: NDArray) -> NDArray[np.float64]:
        """Coefficients of the smooth factor, (states, functions); see :class:`Polynomials`.

        On graded solids further functions are nearly dependent on those before them, and what moments
        leave grows. So many of the first functions are taken that the last of these add least; the
        coefficients of the others are 0.
        """
        c, f = np.zeros_like(moments), _at_points(self, moments.shape[1])
        at_ends = self.values(_ENDS, moments.shape[1])
        for i, row in enumerate(moments):
            weights = _rule(float(α[i]), float(β[i]), self).weights
            products, least = (f * weights[:, None]).T @ f, np.inf
            for count in self._counts(len(row)):
                first = np.linalg.solve(products[:count, :count], row[:count])
                unresolved = self._unresolved(first, at_ends)
                if unresolved < least:
                    c[i], least = np.pad(first, (0, len(row) - count)), unresolved
        return c

    def _counts(self, functions: int) -> list[int]:
        """Numbers of the first functions of which one is taken."""
        if not self.graded:
            return [functions]
        return list(range(min(_OF_ENDS + _FEWEST, functions), functions + 1))

    def unresolved(self, c: NDArray) -> NDArray[np.float64]:
        """Share of the last functions in the larger smooth factor at both ends, (states,)."""
        at_ends = self.values(_ENDS, c.shape[1])
        return np.array([self._unresolved(np.trim_zeros(row, "b"), at_ends) for row in c])

    def _unresolved(self, c: NDArray, at_ends: NDArray) -> float:
        """Share of the last functions of a state's; see :meth:`unresolved`."""
        last, f = _LAST_GRADED if self.graded else _LAST, at_ends[:, : len(c)]
        share = np.abs(c[-last:] * f[:, -last:]).sum(axis=1).max() / np.abs(f @ c).max()
        tail = _TAIL_STIFFENING if self.stiffens else _TAIL
        return float((tail if self.graded else 1.0) * share)

    def moved_edges(self, pressure: Expansion, r: NDArray, length: float) -> NDArray[np.float64]:
        """Change of the smooth factor where both edges are misplaced by a length, (states, points).

        The pressure is stretched from the opposite edge. Its moments change like the functions over the
        length of the misplacement; the more functions there are, the more of this change appears as
        pressure at the ends.
        """
        change = np.empty((len(pressure.c), len(r)))
        for i, c in enumerate(pressure.c):
            c = np.trim_zeros(c, "b")
            count = len(c)
            f, at_r = _at_points(self, count), self.values(r, count)
            weights = _rule(float(pressure.α[i, 0]), float(pressure.β[i, 0]), self).weights
            moments = _moved(self, count, length) @ (weights * (f @ c))
            to_factor = np.linalg.solve((f * weights[:, None]).T @ f, moments.T)
            change[i] = np.abs(at_r @ to_factor).sum(axis=1)
        return change


@cache
def _orthonormal(stretch: Stretch, count: int) -> NDArray[np.float64]:
    """Combinations of a graded solid's functions that are orthonormal under the weight of no friction.

    The functions are nearly dependent, and rounding of their combinations differs from place to place. So
    combinations are represented by polynomials on panels through their values at the points of the
    quadrature, and evaluated by these everywhere: pressure and test functions are then equal.

    Returns:
        Values at the points of the quadrature, (points, functions).
    """
    rule = _rule(-0.5, -0.5, stretch)
    f, root = stretch.of_ends(rule.t, count), np.sqrt(rule.weights)[:, None]
    for _ in range(_TIMES):
        f = f @ np.linalg.inv(np.linalg.qr(f * root, mode="r"))
    return np.asarray(f)


def _rule(α: float, β: float, stretch: Stretch) -> Panels:
    """Quadrature of products of functions under a weight; its points do not depend on the exponents."""
    return Panels(α, β, _FINE * min(1.0, stretch.h))


@lru_cache(maxsize=8)
def _at_points(stretch: Stretch, count: int) -> NDArray[np.float64]:
    """Functions at the points of the quadrature, (points, count)."""
    return stretch.values(_rule(-0.5, -0.5, stretch).t, count)


@lru_cache(maxsize=8)
def _moved(stretch: Stretch, count: int, length: float) -> NDArray[np.float64]:
    """Changes of functions at the points of the quadrature where the right or the left edge is misplaced.

    Args:
        stretch: the functions.
        count: number of the functions.
        length: misplacement over a.

    Returns:
        Changes for either edge, (2, count, points).
    """
    t = _rule(-0.5, -0.5, stretch).t
    inwards = (t - length * (1.0 + t) / 2.0, t + length * (1.0 - t) / 2.0)
    moved = [stretch.values(at, count) for at in inwards]
    return np.array([(functions - _at_points(stretch, count)).T for functions in moved])
