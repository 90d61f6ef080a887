"""A flat punch on a half-plane by Laplace's transform in time: pressure and indentation at each s.

The pressure is (1 - X)^α (1 + X)^β Σ a_j P_j(X), its exponents those of steady motion, tested with the
same of the mirror image.
"""

from functools import cached_property
from math import ceil, exp, lgamma, log, pi

import numpy as np
from numpy.polynomial.legendre import leggauss
from numpy.typing import NDArray
from scipy.special import roots_jacobi

from galinx.solvers.solids.solid import Response
from galinx.solvers.transient.kernel import Kernel, both_sides

#: Octaves of panels towards distances 0 and 2 of points under the punch (so many fewer there), and
#: Gauss's points of each.
_NEAR, _FAR, _POINTS = 24, 5, 8
#: Largest width of a panel.
_EVEN = 0.125
#: Steps, for so many polynomials, and half-length of the double exponential rule along what two shifted
#: contacts have in common.
_STEPS, _FOR, _LENGTH = 121, 24, 3.4
#: Points of the pressure as seen from beside the contact.
_FEW = 96
#: More polynomials than there are.
_ALL = 10**6


class Transformed:
    """Every punch at one speed, for some s.

    Args:
        response: of steady motion at that speed; tells the solid's stiffness and the exponents.
        rayleigh: speed of the wave along the surface over c_s.
        s: over c_s/a, Re s >= 0 but not 0, (n,).
        terms: polynomials of the pressure.
        panel: largest width of a panel of distances over a.
    """

    def __init__(
        self, response: Response, rayleigh: float, s: NDArray, terms: int, panel: float = _EVEN
    ) -> None:
        self._response, self.s, self._terms, self._panel = response, s, terms, min(panel, _EVEN)
        self._kernels = both_sides(response, rayleigh)

    def basis(self, g: float) -> "Basis":
        """Of the pressure where σ_XY = g σ_YY."""
        return Basis(self._response, g, self._terms)

    def answers(
        self, basis: "Basis", terms: tuple[int, ...] = (_ALL,)
    ) -> tuple[NDArray[np.complex128], ...]:
        """What a load N̂ makes for every s, by all polynomials or by the first of them.

        Returns:
            Coefficients of σ_YY over N̂/(2a), then v̂₀ over N̂/(2μ), (n, count + 1), for each of ``terms``.
        """
        matrices, found = self._matrices(basis), []
        for count in (min(one, self._terms) for one in terms):
            whole = np.zeros((len(self.s), count + 1, count + 1), dtype=complex)
            whole[:, :-1, :-1] = matrices[:, :count, :count]
            whole[:, :-1, -1] = basis.tested[:count]
            whole[:, -1, 0] = basis.force
            load = np.zeros((len(self.s), count + 1, 1))
            load[:, -1] = -2.0
            found.append(np.asarray(np.linalg.solve(whole, load)[..., 0], dtype=complex))
        return tuple(found)

    def _matrices(self, basis: "Basis") -> NDArray[np.complex128]:
        """Tested v̂ of each polynomial for every s, (s, tests, terms)."""
        ahead, behind = self._values
        g = basis.g
        return self._summed(
            basis.shared(self._x), ahead[:, 0] + g * ahead[:, 1], behind[:, 0] - g * behind[:, 1]
        )

    def _summed(self, both: NDArray, ahead: NDArray, behind: NDArray) -> NDArray[np.complex128]:
        """A response by the distance, (s, distances), with what tests and polynomials share there."""
        flat = both.reshape(2, len(self._x), -1) * self._weights[:, None]
        return (ahead @ flat[0] + behind @ flat[1]).reshape(-1, self._terms, self._terms)

    def along(self, basis: "Basis", a: NDArray) -> NDArray[np.complex128]:
        """∫ û weighted with each polynomial of the pressure, over N̂/(2μ), (s, terms).

        Args:
            basis: of the pressure.
            a: its coefficients for every s, (s, terms).
        """
        ahead, behind = self._values
        g = basis.g
        u = self._summed(
            basis.shared(self._x, itself=True), ahead[:, 2] + g * ahead[:, 3],
            g * behind[:, 3] - behind[:, 2],
        )  # fmt: skip
        return np.asarray(np.einsum("sij,sj->si", u, a))

    def strains(self, basis: "Basis", a: NDArray, beyond: float) -> NDArray[np.complex128]:
        """û,X on the surface at a distance over a beyond both ends, over N̂/(2aμ), (s, 2)."""
        X, w = _gauss_jacobi(_FEW, basis.α, basis.β)
        pressure = a @ (w[:, None] * basis.polynomials(X)).T
        found, g = [], basis.g
        for kernel, distances, sign in zip(
            self._kernels, (1.0 + beyond - X, 1.0 + beyond + X), (1.0, -1.0)
        ):
            slopes = np.array([_at(kernel, distances, s, True) for s in self.s])
            found.append(((slopes[:, 2] + sign * g * slopes[:, 3]) * pressure).sum(axis=1))
        return np.array(found[::-1]).T

    @cached_property
    def _grid(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        near = 2.0 ** -np.arange(_NEAR, -1, -1.0)
        even = np.linspace(_EVEN, 2.0, ceil((2.0 - _EVEN) / self._panel), endpoint=False)
        towards = [near[near < _EVEN], even, 2.0 - near[near < _EVEN][:_FAR:-1]]
        edges = np.concatenate([[0.0], *towards, [2.0]])
        t, w = leggauss(_POINTS)
        half = np.diff(edges)[:, None] / 2.0
        return (edges[:-1, None] + half * (1.0 + t)).ravel(), (half * w).ravel()

    @property
    def _x(self) -> NDArray[np.float64]:
        return self._grid[0]

    @property
    def _weights(self) -> NDArray[np.float64]:
        return self._grid[1]

    @cached_property
    def _values(self) -> tuple[NDArray[np.complex128], NDArray[np.complex128]]:
        """Responses ahead and behind at all distances for every s, (s, 4, distances) each."""
        ahead, behind = (np.array([_at(kernel, self._x, s) for s in self.s]) for kernel in self._kernels)
        return ahead, behind


def _at(kernel: Kernel, x: NDArray, s: complex, slopes: bool = False) -> NDArray[np.complex128]:
    """Where Im s < 0 the transform of what is real is the conjugate."""
    return kernel(x, s, slopes) if s.imag >= 0.0 else np.conj(kernel(x, np.conj(s), slopes))


class Basis:
    """Polynomials of the pressure with its exponents, and tests with those of the mirror image."""

    def __init__(self, response: Response, g: float, terms: int) -> None:
        self.g = g
        cot = g * response.q / (response.n + g * response.n12)
        self.α = -0.5 - np.arctan(cot) / pi
        self.β = -1.0 - self.α
        self._scales = np.array([_norm(j, self.α, self.β) for j in range(terms)])  # of α and β alike
        X, w = _gauss_jacobi(terms, self.α, self.β)
        P = self._polynomials(X, self.α, self.β)
        self.moments = np.array([w @ P, (w * X) @ P]).T
        self.force = float(self.moments[0, 0])
        ends = np.array([-1.0, 1.0])
        # -σ_YY/(N/a) over the weight: that is half of it over N/(2a)
        self.ends = self._polynomials(ends, self.α, self.β)
        X, w = _gauss_jacobi(terms, self.β, self.α)
        self.tested = w @ self._polynomials(X, self.β, self.α)

    def _polynomials(self, X: NDArray, α: float, β: float) -> NDArray[np.float64]:
        """Jacobi's, about as large each, (n, terms)."""
        return _jacobi(np.asarray(X, dtype=float), α, β, len(self._scales)) / self._scales

    def polynomials(self, X: NDArray) -> NDArray[np.float64]:
        """Those of the pressure, without its weight, (n, terms)."""
        return self._polynomials(X, self.α, self.β)

    def pressures(self, X: NDArray) -> NDArray[np.float64]:
        """Those with their weight, under the punch, (n, terms)."""
        weight = (1.0 - X) ** self.α * (1.0 + X) ** self.β
        return np.asarray(weight[:, None] * self.polynomials(X))

    def shared(self, x: NDArray, itself: bool = False) -> NDArray[np.float64]:
        """∫ τ_i(X) w(X - x) P_j(X - x) dX at distances x > 0, and at -x: (2, x, tests, terms).

        Args:
            x: distances.
            itself: the tests τ_i are the polynomials with their weight, not those of the mirror image.
        """
        α, β = (self.α, self.β) if itself else (self.β, self.α)
        d, e, weights = _overlap(2.0 - x, _STEPS * max(len(self._scales), _FOR) // _FOR)
        x = x[:, None]
        found = []
        for right, left, other_right, other_left in (
            (e, x + d, x + e, d), (x + e, d, e, x + d),
        ):  # fmt: skip
            of_test = weights * right**α * left**β
            of_trial = other_right**self.α * other_left**self.β
            tests = self._polynomials((left - right) / 2.0, α, β)
            trials = self._polynomials((other_left - other_right) / 2.0, self.α, self.β)
            product = (of_test * of_trial)[..., None] * tests
            found.append(product.swapaxes(1, 2) @ trials)
        return np.array(found)


def _gauss_jacobi(terms: int, α: float, β: float) -> tuple[NDArray, NDArray]:
    with np.errstate(
        invalid="ignore", divide="ignore"
    ):  # SciPy divides 0 by 0 where α + β = -1, and replaces that
        X, w = roots_jacobi(terms, α, β)
    return X, w


def _jacobi(X: NDArray, α: float, β: float, terms: int) -> NDArray[np.float64]:
    """Jacobi's polynomials by their recurrence, α + β = -1, (..., terms), terms > 1."""
    P = np.empty((*X.shape, terms))
    P[..., 0] = 1.0
    P[..., 1] = (α + 1.0) + (X - 1.0) / 2.0
    for j in range(2, terms):
        by_X = (2.0 * j - 2.0) * ((2.0 * j - 1.0) * (2.0 * j - 3.0) * X + (β - α))
        back = 2.0 * (j + α - 1.0) * (j + β - 1.0) * (2.0 * j - 1.0)
        P[..., j] = (by_X * P[..., j - 1] - back * P[..., j - 2]) / (
            2.0 * j * (j - 1.0) * (2.0 * j - 3.0)
        )
    return P


def _norm(j: int, α: float, β: float) -> float:
    """Root of the weighted square of Jacobi's polynomial where α + β = -1."""
    if j == 0:
        return exp(0.5 * (lgamma(α + 1.0) + lgamma(β + 1.0)))
    square = lgamma(j + α + 1.0) + lgamma(j + β + 1.0) - lgamma(j + 1.0) - lgamma(j)
    return exp(0.5 * (square - log(2.0 * j)))


def _overlap(length: NDArray, steps: int) -> tuple[NDArray, NDArray, NDArray]:
    """Double exponential rule on intervals: distances from both ends and weights, (n, steps) each."""
    u = np.linspace(-_LENGTH, _LENGTH, steps)
    grown = pi / 2.0 * np.sinh(u)
    d, e = 1.0 / (1.0 + np.exp(-2.0 * grown)), 1.0 / (1.0 + np.exp(2.0 * grown))
    weights = (u[1] - u[0]) * pi * np.cosh(u) * d * e
    return length[:, None] * d, length[:, None] * e, length[:, None] * weights
