"""Pressure under a flat punch whose friction changes in time, by a convolution in steps.

At the stages of step n, with the quadrature's weights W of the response to σ_YY and g σ_YY ::

    Σ_m W_{n-m} [σ_m] = -v₀,      σ(t) = (1 - X)^α(t) (1 + X)^β(t) Σ a_j(t) P_j(X; t)

tested with fixed polynomials. Exponents are those of the friction of each moment. The displacement by
such a pressure is analytic in g: it is interpolated between a few frictions, Chebyshev's points of the
range, and the pressures before step n are kept as shares of the pressures of these.

The quadrature is Radau IIA of three stages, of order five (Lubich & Ostermann, Math. Comp. 60, 105,
1993): the convolution of a response K with f is, at the stages of step n, Σ_m W_{n-m} f_m, with weights
by Σ_k W_k ζ^k = K(Δ(ζ)/h) and the scheme's Δ(ζ) = (A + ζ/(1 - ζ) 1 bᵀ)⁻¹.

The residual of a motion in its integral equation is by steps and tests that it was not computed by: the
pressure's coefficients are interpolated to the stages of fewer steps, and the displacements that they
cause then are tested with more polynomials than the pressure has. Against the indentation these show what
steps, polynomials or a wrong number of the solution leave.
"""

from collections.abc import Sequence
from math import ceil, pi

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..approximation import chebyshev_nodes, polynomial_through
from ..solids.half_plane import HalfPlane
from .history import History
from .transform import Basis, Transformed

#: Rounding of Laplace's transform, enlarged where steps are scaled back in time.
_ROUNDING = 1e-16
#: Length of the discrete transform over the number of steps: the longer, the less comes round.
_LONGER = 1.75
#: Stages.
STAGES = 3


class Radau:
    """Convolution quadrature over a number of equal steps.

    Args:
        end: last time.
        steps: their number.

    Attributes:
        s: arguments of Laplace's transform of a response, (values,).
        times: of all stages, (steps, stages); the last is the end of the step.
    """

    def __init__(self, end: float, steps: int) -> None:
        root = np.sqrt(6.0)
        A = np.array([
            [(88.0 - 7.0 * root) / 360.0, (296.0 - 169.0 * root) / 1800.0, (-2.0 + 3.0 * root) / 225.0],
            [(296.0 + 169.0 * root) / 1800.0, (88.0 + 7.0 * root) / 360.0, (-2.0 - 3.0 * root) / 225.0],
            [(16.0 - root) / 36.0, (16.0 + root) / 36.0, 1.0 / 9.0],
        ])  # fmt: skip
        self._steps, h = steps, end / steps
        self._length = ceil(_LONGER * steps)
        self.times = h * (np.arange(steps)[:, None] + A.sum(axis=1))
        # With this radius what comes round and the enlarged rounding are of one size.
        self._radius = _ROUNDING ** (1.0 / (steps + self._length))
        half = self._length // 2 + 1
        ζ = self._radius * np.exp(-2j * pi * np.arange(half) / self._length)
        Δ = np.linalg.inv(A + (ζ / (1.0 - ζ))[:, None, None] * np.outer(np.ones(STAGES), A[-1]))
        values, self._vectors = np.linalg.eig(Δ)
        self._inverse = np.linalg.inv(self._vectors)
        self.s = (values / h).ravel()

    def answered(self, response: NDArray, given: NDArray) -> NDArray[np.float64]:
        """Sum of a response's convolutions with many functions, after each step, (steps, n).

        Args:
            response: its transform at ``s``, (values, n, functions).
            given: functions at all stages, (steps, stages, functions).
        """
        scale = self._radius ** np.arange(self._steps)[:, None, None]
        scaled = np.fft.rfft(given * scale, self._length, axis=0)
        modes = self._inverse @ scaled
        answers = response.reshape(*modes.shape[:2], -1, modes.shape[2]) @ modes[..., None]
        last = np.einsum("fm,fmn->fn", self._vectors[:, -1], answers[..., 0])
        return np.asarray(np.fft.irfft(last, self._length, axis=0)[: self._steps] / scale[..., 0])

    def weights(self, response: NDArray) -> NDArray[np.float64]:
        """Weights W_0, W_1, … of a response, (steps, stages, stages, ...).

        Args:
            response: its transform at ``s``, (values, ...).
        """
        of_mode = response.reshape(-1, STAGES, *response.shape[1:])
        weights = np.empty((self._steps, STAGES, STAGES, *response.shape[1:]))
        scale = self._radius ** -np.arange(float(self._steps))
        for i in range(STAGES):
            for j in range(STAGES):
                both = self._vectors[:, i] * self._inverse[:, :, j]
                whole = np.fft.irfft(np.einsum("fm,fm...->f...", both, of_mode), self._length, axis=0)
                weights[:, i, j] = (whole[: self._steps].T * scale).T
        return weights


#: Accuracy over the largest pressure, frictions at most, and frictions and places at which it is tested.
_ACCURACY, _MOST, _TESTED = 1e-10, 24, 7
_PLACES = -np.cos(pi * (np.arange(64) + 0.5) / 64)
#: Half-range of friction below which friction is constant: differences are rounding.
_SAME = 1e-13


class FrictionInterpolation:
    """Interpolation in friction: pressures of any g from ``least`` to ``most`` by those of a few.

    Args:
        response: of steady motion.
        least, most: g = σ_XY/σ_YY.
        terms: polynomials of the pressure.

    Attributes:
        bases: polynomials of the pressure at the few frictions.
        middle: polynomials at the middle of the range.
    """

    def __init__(self, response: HalfPlane, least: float, most: float, terms: int) -> None:
        self._response, self._terms = response, terms
        self._middle, self._half = (least + most) / 2.0, (most - least) / 2.0
        self.middle = Basis(response, self._middle, terms)
        low, high = self._middle - self._half, self._middle + self._half
        for count in (1,) if self._half < _SAME else range(2, _MOST + 1):
            self._at = polynomial_through(chebyshev_nodes(count, low, high))
            self.bases = [Basis(response, g, terms) for g in self._at.nodes.tolist()]
            if self._off() <= _ACCURACY:
                break

    def _off(self) -> float:
        values = np.array([basis.pressure(_PLACES) for basis in self.bases])
        off = 0.0
        for share in np.cos(pi * np.arange(_TESTED) / (_TESTED - 1)):
            g = self._middle + self._half * share
            exact = Basis(self._response, g, self._terms).pressure(_PLACES)
            interpolated = np.tensordot(self.shares(g), values, 1)
            off = max(off, float(np.abs(interpolated - exact).max() / np.abs(exact).max()))
        return off

    def shares(self, g: ArrayLike) -> NDArray[np.float64]:
        """Weights of the few frictions in the interpolation at frictions g, (...,): (..., few)."""
        within = np.clip(g, self._middle - self._half, self._middle + self._half)
        return self._at.shares(within.ravel()).reshape(*within.shape, -1)


#: Steps for which the effect of earlier steps is summed together.
_BLOCK = 16


def march(
    transformed: Transformed, scheme: Radau, between: FrictionInterpolation,
    g: History, load: History, steady: bool,
) -> tuple[NDArray[np.float64], ...]:  # fmt: skip
    """Pressure and indentation from t = 0 on, step after step.

    Args:
        transformed: responses at the scheme's s.
        scheme: of the steps.
        between: pressures of the frictions that occur.
        g: σ_XY/σ_YY at times.
        load: share of N at times.
        steady: True for steady motion before t = 0 at the load and friction of t = 0; False for rest.

    Returns:
        Coefficients in σ_YY of the polynomials of the few frictions before t = 0, (few·terms,), and what
        is added to them at all stages, (steps, stages, few·terms); coefficients of the pressure's own
        polynomials after each step, (steps, terms); and the indentation, (steps,).
    """
    tests, steps, terms = between.middle.tests, len(scheme.times), between.middle.tests.terms
    few, given = between.shares(g(scheme.times)), -2.0 * load(scheme.times)
    forces = [basis.pressure.integral for basis in between.bases]
    # Tested displacements by lag, stage and test, of the polynomials of each stage and friction.
    weights = np.empty((steps, STAGES, terms, STAGES, len(forces), terms))
    for n, basis in enumerate(between.bases):
        weights[..., n, :] = scheme.weights(transformed.sinking(basis, tests)).swapaxes(2, 3)
    flat = weights.reshape(steps, STAGES * terms, -1)
    begun, added = np.zeros(len(forces) * terms), np.zeros((steps, STAGES, len(forces) * terms))
    if steady:
        start = between.shares(g(np.zeros(())))
        begun[::terms] = start * (-2.0 * float(load(np.zeros(()))) / (start @ forces))
    before = np.tile(-flat[0] @ np.tile(begun, STAGES), (steps, 1))
    a, v0, shape = np.empty((steps, terms)), np.empty(steps), (STAGES, terms + 1)
    for n, share in enumerate(few):
        first = n - n % _BLOCK
        if n == first:  # a weight serves many steps of the block
            for lag in range(1, last := min(first + _BLOCK, steps)):
                begin, end = max(0, first - lag), min(first, last - lag)
                if end > begin:
                    before[begin + lag : end + lag] += (
                        added[begin:end].reshape(end - begin, -1) @ flat[lag].T
                    )
        for m in range(first, n):
            before[n] += flat[n - m] @ added[m].ravel()
        whole, right = np.zeros((*shape, *shape)), np.empty(shape)
        whole[:, :-1, :, :-1] = np.einsum("itjfk,jf->itjk", weights[0], share)
        whole[range(STAGES), 0, range(STAGES), -1] = tests.integral
        whole[range(STAGES), -1, range(STAGES), 0] = share @ forces
        right[:, :-1], right[:, -1] = -before[n].reshape(STAGES, -1), given[n]
        x = np.linalg.solve(whole.reshape(right.size, right.size), right.ravel()).reshape(shape)
        added[n] = (share[:, :, None] * x[:, None, :-1]).reshape(STAGES, -1) - begun
        a[n], v0[n] = x[-1, :-1], x[-1, -1]
    return begun, added, a, v0


#: Steps over those of the solution, and polynomials of the tests besides as many as the pressure has.
_FEWER_STEPS, _MORE = 0.7, 8


class Residual:
    """Residuals of motions at one speed.

    Args:
        response: of steady motion at that speed.
        rayleigh: speed of the wave along the surface over c_s.
        t: times over a/c_s of the solution, > 0, equal steps apart, (times,).
        terms: polynomials of the pressure.
        way: ±1, in which the punch moves along X.
    """

    def __init__(
        self, response: HalfPlane, rayleigh: float, t: NDArray, terms: int, way: int = 1
    ) -> None:
        self._response, self._t, self._terms = response, np.append(0.0, t), terms
        self._scheme = Radau(float(t[-1]), max(round(_FEWER_STEPS * len(t)), 1))
        self._transformed = Transformed(response, rayleigh, self._scheme.s, terms, way=way)

    def of(self, bases: Sequence[Basis], a: NDArray, v0: NDArray) -> float:
        """Largest tested displacement under the punch besides its indentation, over the largest of that.

        Args:
            bases: polynomials of the pressure.
            a: coefficients of their σ_YY, less those before t = 0, (times, bases·terms).
            v0: indentation since t = 0, (times,).
        """
        # The mean of their frictions changes sign in the mirror image, as they do.
        g = float(np.mean([basis.g for basis in bases]))
        tests = Basis(self._response, g, self._terms + _MORE).tests
        rows = np.concatenate([self._transformed.sinking(basis, tests) for basis in bases], axis=2)
        v = self._scheme.answered(rows, self._interpolated(a, self._scheme.times))
        v[:, 0] += tests.integral * self._interpolated(v0, self._scheme.times[:, -1])
        largest = float(np.linalg.norm(v, axis=1).max())
        return largest / max(tests.integral * float(np.abs(v0).max()), np.finfo(float).tiny)

    def _interpolated(self, values: NDArray, t: NDArray) -> NDArray[np.float64]:
        """Values (times, ...), 0 at t = 0, at other times."""
        from scipy.interpolate import CubicSpline  # a slow import

        return np.asarray(CubicSpline(self._t, np.concatenate([0.0 * values[:1], values]))(t))
