"""Pressure under a flat punch whose friction changes in time: the convolution is marched through.

At the stages of step n, with the quadrature's weights W of the response to σ_YY and g σ_YY ::

    Σ_m W_{n-m} [σ_m] = -v₀,      σ(t) = (1 - X)^α(t) (1 + X)^β(t) Σ a_j(t) P_j(X; t)

tested with fixed polynomials. Exponents are those of the friction of each moment. What such a pressure
does is analytic in g, and interpolated between a few of them; so what has been is kept by their shares.

Convolution quadrature by Radau IIA of three stages (Lubich & Ostermann, Math. Comp. 60, 105, 1993).

What a response K makes of f over time is, at the stages of step n, Σ_m W_{n-m} f_m, where the weights are
those of Σ_k W_k ζ^k = K(Δ(ζ)/h) and Δ(ζ) = (A + ζ/(1 - ζ) 1 bᵀ)⁻¹ is the scheme's. It is of order five.

Pressures of any friction of a range by those of a few: analytic in g, so Chebyshev's points serve.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import ceil, pi

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..solids.solid import Response
from .transform import Basis, Transformed

#: Rounding of Laplace's transform, enlarged where steps are scaled back in time.
_ROUNDING = 1e-16
#: Length of the transform over what is told of it: the longer, the less comes round.
_LONGER = 1.75
#: Stages.
STAGES = 3


class Radau:
    """For a number of steps.

    Args:
        end: last time.
        steps: of equal length.

    Attributes:
        s: where Laplace's transform of a response is needed, (values,).
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
        self._h, self._nodes = h, A.sum(axis=1)
        self.times = self._stages(steps)
        # What comes round and the enlarged rounding are alike small.
        self._radius = _ROUNDING ** (1.0 / (steps + self._length))
        half = self._length // 2 + 1
        ζ = self._radius * np.exp(-2j * pi * np.arange(half) / self._length)
        Δ = np.linalg.inv(A + (ζ / (1.0 - ζ))[:, None, None] * np.outer(np.ones(STAGES), A[-1]))
        values, self._vectors = np.linalg.eig(Δ)
        self._inverse = np.linalg.inv(self._vectors)
        self.s = (values / h).ravel()

    def _stages(self, steps: int) -> NDArray[np.float64]:
        return np.asarray(self._h * (np.arange(steps)[:, None] + self._nodes))

    def convolved(self, response: NDArray, given: Callable[[NDArray], NDArray]) -> NDArray[np.float64]:
        """What a response makes of what is given over time, after each step, (steps, n).

        Args:
            response: its transform at ``s``, (values, n).
            given: function of time.
        """
        return self.answered(response[..., None], given(self.times)[..., None])

    def answered(self, response: NDArray, given: NDArray) -> NDArray[np.float64]:
        """What a response makes of many functions of time, after each step, (steps, n).

        Args:
            response: its transform at ``s``, (values, n, functions).
            given: at all stages, (steps, stages, functions).
        """
        scale = self._radius ** np.arange(self._steps)[:, None, None]
        scaled = np.fft.rfft(given * scale, self._length, axis=0)
        modes = self._inverse @ scaled
        answers = response.reshape(*modes.shape[:2], -1, modes.shape[2]) @ modes[..., None]
        last = np.einsum("fm,fmn->fn", self._vectors[:, -1], answers[..., 0])
        return np.asarray(np.fft.irfft(last, self._length, axis=0)[: self._steps] / scale[..., 0])

    def weights(self, response: NDArray) -> NDArray[np.float64]:
        """W_0, W_1, … of a response, (steps, stages, stages, ...).

        Args:
            response: its transform at ``s``, (values, ...).
        """
        of_mode = response.reshape(-1, STAGES, *response.shape[1:])
        found = np.empty((self._steps, STAGES, STAGES, *response.shape[1:]))
        scale = self._radius ** -np.arange(float(self._steps))
        for i in range(STAGES):
            for j in range(STAGES):
                both = self._vectors[:, i] * self._inverse[:, :, j]
                whole = np.fft.irfft(np.einsum("fm,fm...->f...", both, of_mode), self._length, axis=0)
                found[:, i, j] = (whole[: self._steps].T * scale).T
        return found


#: Accuracy over the largest, frictions at most, and frictions and places at which it is looked at.
_ACCURACY, _MOST, _LOOKED = 1e-10, 24, 7
_PLACES = -np.cos(pi * (np.arange(64) + 0.5) / 64)
#: Range of friction that is none: differences of it are rounding.
_SAME = 1e-13


class Between:
    """All frictions from g_least to g_most.

    Args:
        response: of steady motion.
        least, most: g = σ_XY/σ_YY.
        terms: polynomials of the pressure.

    Attributes:
        bases: at the few frictions.
        middle: at the middle of the range.
    """

    def __init__(self, response: Response, least: float, most: float, terms: int) -> None:
        self._response, self._terms = response, terms
        self._middle, self._half = (least + most) / 2.0, (most - least) / 2.0
        self.middle = Basis(response, self._middle, terms)
        count = 1 if self._half < _SAME else 2
        self._take(count)
        while 1 < count < _MOST and self._off() > _ACCURACY:
            count += 1
            self._take(count)

    def _take(self, count: int) -> None:
        self._angles = pi * (np.arange(count) + 0.5) / count
        self.bases = [
            Basis(self._response, self._middle + self._half * one, self._terms)
            for one in np.cos(self._angles)
        ]

    def _off(self) -> float:
        known = np.array([one.pressure(_PLACES) for one in self.bases])
        off = 0.0
        for share in np.cos(pi * np.arange(_LOOKED) / (_LOOKED - 1)):
            g = self._middle + self._half * share
            exact = Basis(self._response, g, self._terms).pressure(_PLACES)
            found = np.tensordot(self.shares(g), known, 1)
            off = max(off, float(np.abs(found - exact).max() / np.abs(exact).max()))
        return off

    def shares(self, g: ArrayLike) -> NDArray[np.float64]:
        """Of each of the few in what there is at frictions (...,): (..., few)."""
        count = len(self._angles)
        x = np.clip((np.asarray(g) - self._middle) / max(self._half, _SAME), -1.0, 1.0)
        orders = np.arange(count)
        known = np.cos(np.outer(self._angles, orders)) * np.where(orders == 0, 1.0, 2.0) / count
        return np.asarray(np.cos(np.arccos(x)[..., None] * orders) @ known.T)


#: Steps for which what has been before is summed together.
_BLOCK = 16


@dataclass(frozen=True)
class Marched:
    """What was found.

    Attributes:
        between: pressures of a few frictions.
        shares: of each polynomial of these in σ_YY at all stages, (steps, stages, few·terms).
        begun: these before t = 0, (few·terms,).
        a: coefficients of the pressure's polynomials after each step, (steps, terms).
        v0: indentation after each step, (steps,).
    """

    between: Between
    shares: NDArray[np.float64]
    begun: NDArray[np.float64]
    a: NDArray[np.float64]
    v0: NDArray[np.float64]


def march(
    transformed: Transformed, scheme: Radau, between: Between,
    g: Callable[[NDArray], NDArray], load: Callable[[NDArray], NDArray], steady: bool,
) -> Marched:  # fmt: skip
    """From t = 0 on, through all steps.

    Args:
        transformed: responses at the scheme's s.
        scheme: of the steps.
        between: pressures of the frictions that occur.
        g: σ_XY/σ_YY at times.
        load: share of N at times.
        steady: before t = 0 there was steady motion of what there is then, not rest.
    """
    tests, h = between.middle.tests, _History(transformed, scheme, between)
    few, given = between.shares(g(scheme.times)), -2.0 * load(scheme.times)
    forces = [one.pressure.integral for one in between.bases]
    if steady:
        start = between.shares(g(np.zeros(())))
        h.begun[:, :: tests.terms] = start * (-2.0 * float(load(np.zeros(()))) / (start @ forces))
    found, v0 = np.empty((len(few), tests.terms)), np.empty(len(few))
    shape = STAGES, tests.terms + 1
    for n, share in enumerate(few):
        whole, right = np.zeros((*shape, *shape)), np.empty(shape)
        whole[:, :-1, :, :-1] = h.now(share)
        whole[range(STAGES), 0, range(STAGES), -1] = tests.integral
        whole[range(STAGES), -1, range(STAGES), 0] = share @ forces
        right[:, :-1], right[:, -1] = -h.before(n), given[n]
        x = np.linalg.solve(whole.reshape(right.size, right.size), right.ravel()).reshape(shape)
        h.known(n, share[:, :, None] * x[:, None, :-1])
        found[n], v0[n] = x[-1, :-1], x[-1, -1]
    return Marched(between, h.added + h.begun, h.begun[0], found, v0)


class _History:
    """What has been, and what it does now.

    Attributes:
        added: shares in σ_YY less those before t = 0, (steps, stages, few·terms).
        begun: those before, (stages, few·terms), alike at all stages.
    """

    def __init__(self, transformed: Transformed, scheme: Radau, between: Between) -> None:
        tests, few = between.middle.tests, len(between.bases)
        self._weights = np.empty((len(scheme.times), STAGES, tests.terms, STAGES, few, tests.terms))
        for n, one in enumerate(between.bases):
            of_one = scheme.weights(transformed.sinking(one, tests))
            self._weights[..., n, :] = of_one.swapaxes(2, 3)
        self._flat = self._weights.reshape(len(self._weights), STAGES * tests.terms, -1)
        self.added = np.zeros((len(self._weights), STAGES, few * tests.terms))
        self.begun = np.zeros((STAGES, few * tests.terms))
        self._ahead = np.zeros((len(self._weights), STAGES * tests.terms))

    def now(self, share: NDArray) -> NDArray[np.float64]:
        """What the polynomials of a moment do at once, (stages, tests, stages, terms)."""
        return np.asarray(np.einsum("itjfk,jf->itjk", self._weights[0], share))

    def before(self, n: int) -> NDArray[np.float64]:
        """What has been before step n does there, (stages, tests)."""
        first = n - n % _BLOCK
        if n == first:
            self._look_ahead(first)
        whole = self._ahead[n] - self._flat[0] @ self.begun.ravel()
        for m in range(first, n):
            whole = whole + self._flat[n - m] @ self.added[m].ravel()
        return np.asarray(whole.reshape(STAGES, -1))

    def _look_ahead(self, first: int) -> None:
        """What has been before a block does in it; a weight serves many of its steps at once."""
        last = min(first + _BLOCK, len(self._flat))
        for lag in range(1, last):
            begin, end = max(0, first - lag), min(first, last - lag)
            if end > begin:
                been = self.added[begin:end].reshape(end - begin, -1)
                self._ahead[begin + lag : end + lag] += been @ self._flat[lag].T

    def known(self, n: int, whole: NDArray) -> None:
        """σ_YY of a step, (stages, few, terms)."""
        self.added[n] = whole.reshape(STAGES, -1) - self.begun
