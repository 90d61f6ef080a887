"""The singular integral equation of a punch on a layered half-plane.

    (n̂/π) ⨍ σ(t)/(t - r) dt - g q σ(r) + ∫ K(r - t) σ(t) dt = μ v,X(r),   ∫ σ dr = -2,

σ = σ_YY, n̂ = n + g n₁₂ of the surface's solid, K of :mod:`galinx.solvers.layers.kernel`. The dominant
part is that of a half-plane, and so are the exponents. The pressure is a sum of Jacobi polynomials under
their weight; its integrals with K are done by Gauss's rule. Where K is rough, panels take their place.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.errors import SolveError
from galinx.solvers.layers.kernel import Kernel, Scaled
from galinx.solvers.layers.panelled import PanelledPressure
from galinx.solvers.layers.panelled import parts as panelled
from galinx.solvers.layers.pressure import Polynomial, Pressure, gauss
from galinx.solvers.sie.collocation import Expansion, jacobi

#: Polynomials at first, by how much more next time, and at most.
FIRST, _MORE, MOST = 24, 1.5, 1400
#: Where pressures of two numbers of polynomials are compared.
_ENDS = np.array([-1.0, 1.0])
_LOOKED_AT = np.cos(np.pi * (np.arange(25) + 0.5) / 25)
#: Distance from a tip of the punch within which they are not.
NEAR_TIP = 0.02
#: Least distance from -1 of the pressure's exponents: points of quadrature fall on the edges beyond it.
_STRONGEST = 1e-4

#: μ v,X under the punch over N/(2a) at given r.
Slope: TypeAlias = Callable[[NDArray], NDArray]
#: Number of polynomials, or the longest panel where the kernel is rough.
Resolution: TypeAlias = int | float

#: A change that rounding alone may make.
_ROUNDING = 2e-12
#: Longest panel at first where the kernel is rough, over the contact's half-width, by how much shorter
#: next time, and how often.
_COARSE, _SHORTER, _TIMES = 1.4, 0.7, 12


@dataclass(frozen=True)
class Parts:
    """Pressures that are added up.

    Attributes:
        coefficients: of each, (unknowns, parts).
        made: a pressure of coefficients, (unknowns,).
    """

    coefficients: NDArray[np.float64]
    made: Callable[[NDArray], Pressure]

    def pressure(self, amplitudes: NDArray) -> Pressure:
        """Their sum with amplitudes, (parts,)."""
        return self.made(self.coefficients @ amplitudes)

    @property
    def ends(self) -> NDArray[np.float64]:
        """Each without its weight at both ends, (2, parts)."""
        return np.stack([self.made(c).series(_ENDS) for c in self.coefficients.T], axis=-1)


@dataclass(frozen=True)
class Equation:
    """The equation at one speed and friction.

    Attributes:
        response: of the surface's solid.
        kernel: of the layers.
        g: σ_XY/σ_YY under the punch.
        slope: μ v,X under the punch over N/(2a) at given r.
        kinks: places r next to which the slope is not smooth.
    """

    response: Any
    kernel: Kernel | Scaled
    g: float
    slope: Slope
    kinks: tuple[float, ...] = ()

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
        (c,) = self._coefficients(terms, [self.slope], [-2.0]).T
        return Expansion(self.α, self.β, c)

    def pressure(self, resolution: Resolution) -> Pressure:
        """The pressure."""
        return self.parts(resolution, [self.slope], [-2.0]).pressure(np.ones(1))

    def parts(self, resolution: Resolution, slopes: Sequence[Slope], loads: Sequence[float]) -> Parts:
        """Pressures under several slopes with several resultants, of which others are sums."""
        if isinstance(resolution, float):
            panels, values = panelled(self, resolution, slopes, loads)
            return Parts(values, lambda p: PanelledPressure(panels, p))
        c = self._coefficients(resolution, slopes, loads)
        return Parts(c, lambda c: Polynomial(Expansion(self.α, self.β, c)))

    def _coefficients(
        self, terms: int, slopes: Sequence[Slope], loads: Sequence[float]
    ) -> NDArray[np.float64]:
        """Of so many polynomials, (terms, slopes)."""
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
    check_exponents(equation)
    before: Pressure | None = None
    left = np.inf
    for resolution in ever_finer(equation.kernel.rough, first):
        now = equation.pressure(resolution)
        if before is not None:
            left = change(before, now)
            if met(left, tolerance):
                return Found(now, before, left)
        before = now
    raise not_met(left, tolerance)


def check_exponents(equation: Equation) -> None:
    """Can the pressure be followed to its edges?

    Raises:
        SolveError: it cannot.
    """
    least = 1.0 + min(equation.α, equation.β)
    if not least >= _STRONGEST:
        raise SolveError(
            f"the pressure's exponent at an edge is -1 + {least:.2g}, expected at least -1 + "
            f"{_STRONGEST:g}: all of it acts at that edge; take less friction"
        )


def met(left: float, tolerance: float) -> bool:
    """Is a change with the resolution small enough?"""
    return left <= tolerance / 4.0 or left <= _ROUNDING


def not_met(left: float, tolerance: float) -> SolveError:
    """What is said where it never is."""
    return SolveError(
        f"with the most unknowns the pressure still changes by {left:.2g}, expected {tolerance:g}: "
        "the uppermost layer is very thin over the contact's width; take a larger tolerance"
    )


def ever_finer(rough: bool, first: int) -> Iterator[Resolution]:
    """Resolutions, of kernels that are rough or not."""
    if rough:
        for time in range(_TIMES):
            yield _COARSE * _SHORTER**time
        return
    terms = max(int(first / _MORE), 8)
    while terms < MOST:
        yield terms
        terms = int(_MORE * terms)
    yield MOST


def change(before: Pressure, now: Pressure) -> float:
    """Of intensities and pressure without its weight, over the larger one; not next to its tips."""
    at = np.concatenate([_ENDS, _LOOKED_AT])
    for tip in now.tips:
        at = at[np.abs(at - tip) > NEAR_TIP]
    one, other = before.series(at), now.series(at)
    return float(np.abs(one - other).max() / np.abs(other).max())
