"""A flat punch that is pressed on and slides from rest at constant speed: integral equation in time.

The pressure is (1 - X)^α (1 + X)^β Σ a_j(t) P_j(X), its exponents those of steady motion, tested with
the same of the mirror image. What depends on time is solved as a convolution: quadrature by Radau IIA of
three stages (Lubich), of order five, so that Laplace's transform of the response is all that is needed.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from math import ceil, exp, lgamma, log, pi

import numpy as np
from numpy.polynomial.legendre import leggauss
from numpy.typing import NDArray
from scipy.special import eval_jacobi, roots_jacobi

from galinx.solvers.solids.solid import Response
from galinx.solvers.transient.kernel import Kernel

#: Octaves of panels towards distances 0 and 2 of points under the punch (so many fewer there), and
#: Gauss's points of each.
_NEAR, _FAR, _POINTS = 24, 5, 8
#: Largest width of a panel.
_EVEN = 0.125
#: Steps and half-length of the double exponential rule along what two shifted contacts have in common.
_STEPS, _LENGTH = 121, 3.4
#: Rounding that the scaling of steps back in time may enlarge.
_SCALED = 1e-15
#: Length of the quadrature over what is told of it: near its end rounding is enlarged most.
_LONGER = 1.5


def smooth(t: NDArray, length: float) -> NDArray[np.float64]:
    """Share of the load at times t: 10s³ - 15s⁴ + 6s⁵, s = t/length, up to 1."""
    s = np.clip(np.asarray(t, dtype=float) / length, 0.0, 1.0)
    return s**3 * (10.0 - 15.0 * s + 6.0 * s * s)


@dataclass(frozen=True)
class Course:
    """What happens over time; lengths over a, times over a/c_s, stresses over N/(2a).

    Attributes:
        t: times, (times,), > 0.
        v0: indentation of the surface under the punch over N/(2μ), from when all was at rest.
        load: over N.
        centre: of the pressure over a.
        K_left, K_right: normalised intensities of the pressure at X = -a and X = a, by the exponents of
            steady motion and over the final load, as those of the steady state.
    """

    t: NDArray[np.float64]
    v0: NDArray[np.float64]
    load: NDArray[np.float64]
    centre: NDArray[np.float64]
    K_left: NDArray[np.float64]
    K_right: NDArray[np.float64]


class StartingPunch:
    """All starts from rest at one speed.

    Args:
        slow: (c_s/c_d)² of the isotropic solid.
        rayleigh: its Rayleigh speed over c_s.
        response: of steady motion at that speed; tells the exponents.
        end: last time over a/c_s.
        steps: of the quadrature.
        terms: polynomials of the pressure.
    """

    def __init__(
        self, slow: float, rayleigh: float, response: Response, end: float, steps: int, terms: int = 24
    ) -> None:
        self._response, self._end, self._steps, self._terms = response, end, steps, terms
        ahead, behind = (Kernel(slow, sign * response.c, rayleigh) for sign in (1.0, -1.0))
        self._kernels = ahead, behind

    def course(self, g: float, load: Callable[[NDArray], NDArray]) -> Course:
        """What happens where σ_XY = g σ_YY under the punch and N grows by the share ``load(t)``."""
        basis = _Basis(self._response, g, self._terms)
        symbols = self._matrices(basis, g)
        forcing = np.zeros((len(symbols), self._terms + 1), dtype=complex)
        forcing[:, -1] = -2.0
        whole = np.zeros((len(symbols), self._terms + 1, self._terms + 1), dtype=complex)
        whole[:, :-1, :-1] = symbols
        whole[:, :-1, -1] = basis.tested
        whole[:, -1, 0] = basis.force
        answers = np.linalg.solve(whole, forcing[..., None])[..., 0]
        found = self._scheme.convolved(answers, load)[: self._steps]
        a, v0 = found[:, :-1], found[:, -1]
        t = np.arange(1.0, self._steps + 1.0) * (self._end / self._steps)
        normal = a @ basis.moments
        # Inertia adds r log r to what the polynomials tell at a distance r from an end, so that their
        # sum there converges with the square of their number; half of them say how.
        whole, half = (a[:, :n] @ basis.ends[:, :n].T for n in (self._terms, self._terms // 2))
        left, right = -(whole + (whole - half) / 3.0).T / 2.0
        return Course(t, v0, -normal[:, 0] / 2.0, normal[:, 1] / normal[:, 0], left, right)

    def _matrices(self, basis: "_Basis", g: float) -> NDArray[np.complex128]:
        """Tested response to each polynomial for every s, (s, tests, terms)."""
        both = basis.shared(self._x)
        ahead, behind = self._values
        kernel = np.stack([ahead[:, 0] + g * ahead[:, 1], behind[:, 0] - g * behind[:, 1]])
        flat = both.reshape(2, len(self._x), -1) * self._weights[:, None]
        found = kernel[0] @ flat[0] + kernel[1] @ flat[1]
        return found.reshape(-1, self._terms, self._terms)

    @cached_property
    def _scheme(self) -> "Radau":
        longer = ceil(_LONGER * self._steps)
        return Radau(self._end / self._steps * longer, longer)

    @cached_property
    def _grid(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        near = 2.0 ** -np.arange(_NEAR, -1, -1.0)
        even = np.arange(_EVEN, 2.0, _EVEN)
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
        """Responses ahead and behind at all distances for every s, (s, 2, distances) each."""
        ahead, behind = (
            np.array([_at(kernel, self._x, s) for s in self._scheme.s]) for kernel in self._kernels
        )
        return ahead, behind


def _at(kernel: Kernel, x: NDArray, s: complex) -> NDArray[np.complex128]:
    """Where Im s < 0 the transform of what is real is the conjugate."""
    return kernel(x, s) if s.imag >= 0.0 else np.conj(kernel(x, np.conj(s)))


class _Basis:
    """Polynomials of the pressure with its exponents, and tests with those of the mirror image."""

    def __init__(self, response: Response, g: float, terms: int) -> None:
        cot = g * response.q / (response.n + g * response.n12)
        self.α = -0.5 - np.arctan(cot) / pi
        self.β = -1.0 - self.α
        self._orders = np.arange(terms)
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
        scale = np.array([_norm(int(j), α, β) for j in self._orders])
        return np.asarray(eval_jacobi(self._orders, α, β, X[..., None])) / scale

    def shared(self, x: NDArray) -> NDArray[np.float64]:
        """∫ τ_i(X) w(X - x) P_j(X - x) dX at distances x > 0, and at -x: (2, x, tests, terms)."""
        d, e, weights = _overlap(2.0 - x)
        x = x[:, None]
        found = []
        for right, left, other_right, other_left in (
            (e, x + d, x + e, d), (x + e, d, e, x + d),
        ):  # fmt: skip
            of_test = weights * right**self.β * left**self.α
            of_trial = other_right**self.α * other_left**self.β
            tests = self._polynomials((left - right) / 2.0, self.β, self.α)
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


def _norm(j: int, α: float, β: float) -> float:
    """Root of the weighted square of Jacobi's polynomial where α + β = -1."""
    if j == 0:
        return exp(0.5 * (lgamma(α + 1.0) + lgamma(β + 1.0)))
    square = lgamma(j + α + 1.0) + lgamma(j + β + 1.0) - lgamma(j + 1.0) - lgamma(j)
    return exp(0.5 * (square - log(2.0 * j)))


def _overlap(length: NDArray) -> tuple[NDArray, NDArray, NDArray]:
    """Double exponential rule on intervals: distances from both ends and weights, (n, steps) each."""
    u = np.linspace(-_LENGTH, _LENGTH, _STEPS)
    grown = pi / 2.0 * np.sinh(u)
    d, e = 1.0 / (1.0 + np.exp(-2.0 * grown)), 1.0 / (1.0 + np.exp(2.0 * grown))
    weights = (u[1] - u[0]) * pi * np.cosh(u) * d * e
    return length[:, None] * d, length[:, None] * e, length[:, None] * weights


class Radau:
    """Convolution quadrature by Radau IIA of three stages.

    Args:
        end: last time.
        steps: of equal length.

    Attributes:
        s: where Laplace's transform of a response is needed, (values,).
    """

    def __init__(self, end: float, steps: int) -> None:
        root = np.sqrt(6.0)
        A = np.array([
            [(88.0 - 7.0 * root) / 360.0, (296.0 - 169.0 * root) / 1800.0, (-2.0 + 3.0 * root) / 225.0],
            [(296.0 + 169.0 * root) / 1800.0, (88.0 + 7.0 * root) / 360.0, (-2.0 - 3.0 * root) / 225.0],
            [(16.0 - root) / 36.0, (16.0 + root) / 36.0, 1.0 / 9.0],
        ])  # fmt: skip
        self._steps, h = steps, end / steps
        nodes = A.sum(axis=1)
        self._times = h * (np.arange(steps)[:, None] + nodes)
        self._scale = _SCALED ** (np.arange(steps) / (2.0 * steps))
        half = steps // 2 + 1
        ζ = _SCALED ** (0.5 / steps) * np.exp(-2j * pi * np.arange(half) / steps)
        Δ = np.linalg.inv(A + (ζ / (1.0 - ζ))[:, None, None] * np.outer(np.ones(3), A[-1]))
        values, self._vectors = np.linalg.eig(Δ)
        self.s = (values / h).ravel()

    def convolved(self, response: NDArray, given: Callable[[NDArray], NDArray]) -> NDArray[np.float64]:
        """What a response makes of what is given over time, after each step.

        Args:
            response: its transform at ``s``, (values, n).
            given: function of time.
        """
        scaled = np.fft.rfft(given(self._times) * self._scale[:, None], axis=0)
        modes = np.linalg.solve(self._vectors, scaled[..., None])[..., 0]
        answered = modes[..., None] * response.reshape(*modes.shape, -1)
        last = np.einsum("fm,fmn->fn", self._vectors[:, -1], answered)
        return np.fft.irfft(last, self._steps, axis=0) / self._scale[:, None]
