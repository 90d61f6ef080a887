"""The singular integral equation of a punch on a layered half-plane.

    (n̂/π) ⨍ σ(t)/(t - r) dt - g q σ(r) + ∫ K(r - t) σ(t) dt = μ v,X(r),   ∫ σ dr = -2,

σ = σ_YY, n̂ = n + g n₁₂ of the surface's solid, K of :mod:`galinx.solvers.layers.kernel`. The dominant
part is that of a half-plane, and so are the exponents. The pressure is a sum of Jacobi polynomials under
their weight; its integrals with K are done by Gauss's rule. Where K is rough, panels take their place.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.errors import SolveError
from galinx.solvers.layers.kernel import Kernel
from galinx.solvers.layers.panelled import solved as panelled
from galinx.solvers.layers.pressure import Polynomial, Pressure, gauss
from galinx.solvers.sie.collocation import Expansion, jacobi

#: Polynomials at first, by how much more next time, and at most.
FIRST, _MORE, MOST = 24, 1.5, 1400
#: Where pressures of two numbers of polynomials are compared.
_LOOKED_AT = np.cos(np.pi * (np.arange(25) + 0.5) / 25)
#: Least distance from -1 of the pressure's exponents: points of quadrature fall on the edges beyond it.
_STRONGEST = 1e-4

#: A change that rounding alone may make.
_ROUNDING = 2e-12
#: Longest panel at first where the kernel is rough, over the contact's half-width, by how much shorter
#: next time, and how often.
_COARSE, _SHORTER, _TIMES = 1.4, 0.7, 12


@dataclass(frozen=True)
class Equation:
    """The equation at one speed and friction.

    Attributes:
        response: of the surface's solid.
        kernel: of the layers.
        g: σ_XY/σ_YY under the punch.
        slope: μ v,X under the punch over N/(2a) at given r.
    """

    response: Any
    kernel: Kernel
    g: float
    slope: Callable[[NDArray], NDArray]

    @property
    def n(self) -> float:
        """n̂."""
        return float(self.response.n + self.g * self.response.n12)

    @cached_property
    def α(self) -> float:
        """Exponent at X = a: that of the surface's solid."""
        return float(-0.5 - np.arctan2(self.g * self.response.q, self.n) / np.pi)

    @property
    def β(self) -> float:
        """Exponent at X = -a."""
        return -1.0 - self.α

    def solved(self, terms: int) -> Expansion:
        """The pressure with so many polynomials."""
        t, w = gauss(terms, self.α, self.β)
        r, _ = gauss(terms - 1, -self.α, -self.β)
        P = jacobi(terms, self.α, self.β, t)
        A = np.empty((terms, terms))
        A[:-1] = self.n / np.pi * (w / (t - r[:, None])) @ P
        by_kernel = self.kernel(r[:, None] - t)
        A[:-1] += (w * (by_kernel[..., 3] + self.g * by_kernel[..., 2])) @ P
        A[-1] = w @ P
        return Expansion(self.α, self.β, np.linalg.solve(A, np.append(self.slope(r), -2.0)))


@dataclass(frozen=True)
class Found:
    """A pressure, and by how much it changed with the number of polynomials.

    Attributes:
        pressure: the pressure.
        before: with fewer unknowns.
        change: of it and its intensities, relative.
    """

    pressure: Pressure
    before: Pressure
    change: float


def found(equation: Equation, tolerance: float, first: int = FIRST) -> Found:
    """The pressure to a tolerance.

    Raises:
        SolveError: it was not reached; the message says what is left.
    """
    least = 1.0 + min(equation.α, equation.β)
    if not least >= _STRONGEST:
        raise SolveError(
            f"the pressure's exponent at an edge is -1 + {least:.2g}, expected at least -1 + "
            f"{_STRONGEST:g}: all of it acts at that edge; take less friction"
        )
    before: Pressure | None = None
    change = np.inf
    for now in _ever_finer(equation, first):
        if before is not None:
            change = _change(before, now)
            if change <= tolerance / 4.0 or change <= _ROUNDING:
                return Found(now, before, change)
        before = now
    raise SolveError(
        f"with the most unknowns the pressure still changes by {change:.2g}, expected {tolerance:g}: "
        "the uppermost layer is very thin over the contact's width; take a larger tolerance"
    )


def _ever_finer(equation: Equation, first: int) -> Iterator[Pressure]:
    if equation.kernel.rough:
        for time in range(_TIMES):
            yield panelled(equation, _COARSE * _SHORTER**time)
        return
    terms = max(int(first / _MORE), 8)
    while terms < MOST:
        yield Polynomial(equation.solved(terms))
        terms = int(_MORE * terms)
    yield Polynomial(equation.solved(MOST))


def _change(before: Pressure, now: Pressure) -> float:
    """Of intensities and pressure without its weight, over the larger one."""
    at = np.concatenate([[-1.0, 1.0], _LOOKED_AT])
    one, other = before.series(at), now.series(at)
    return float(np.abs(one - other).max() / np.abs(other).max())
