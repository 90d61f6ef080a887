"""Pressure under a flat punch whose friction changes in time: the convolution is marched through.

At the stages of step n, with the quadrature's weights W of the response to σ_YY and g σ_YY ::

    Σ_m W_{n-m} [σ_m] = -v₀,      σ(t) = (1 - X)^α(t) (1 + X)^β(t) Σ a_j(t) P_j(X; t)

tested with fixed polynomials. Exponents are those of the friction of each moment. What such a pressure
does is analytic in g, and interpolated between a few of them; so what has been is kept by their shares.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.transient.between import Between
from galinx.solvers.transient.radau import STAGES, Radau
from galinx.solvers.transient.transform import Transformed

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
