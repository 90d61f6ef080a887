"""A contact pressure that was found, by what is read off it: values, transforms, integrals."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.special import roots_jacobi

from galinx.solvers.layers.panelled import Panels
from galinx.solvers.sie.collocation import Expansion

#: |r| up to which few polynomials have not grown, by how much many may, and points of the rule beyond it.
_NEAR, _GROWN, _FINE = 1.1, 1e3, 96


class Pressure(Protocol):
    """σ_YY over N/(2a) = (1 - r)^α (1 + r)^β p(r).

    Attributes:
        α, β: exponents.
        near: |r| up to which p is known.
        tips: places under the punch at which it is infinite.
    """

    @property
    def α(self) -> float: ...
    @property
    def β(self) -> float: ...
    @property
    def near(self) -> float: ...
    @property
    def tips(self) -> tuple[float, ...]: ...

    def series(self, r: NDArray) -> NDArray[np.float64]:
        """p at |r| <= near."""

    def rest(self, r: NDArray, near: float) -> NDArray[np.float64]:
        """(1/π) ∫ σ/(t - r) dt, where |r| <= near less p(r) times that of the weight."""

    def integral(self, kernel: Callable[[NDArray], NDArray], r: NDArray) -> NDArray[np.float64]:
        """∫ kernel(r - t) σ(t) dt, (len(r), functions)."""

    def points(self, finest: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """t and weights times σ_YY for integrals with what varies over ``finest``."""


def gauss(points: int, α: float, β: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Gauss's rule for the weight (1 - t)^α (1 + t)^β."""
    with np.errstate(invalid="ignore"):  # SciPy evaluates a branch it then discards
        t, w = roots_jacobi(points, α, β)
    return t, w


@dataclass(frozen=True)
class Polynomial:
    """A pressure by Jacobi polynomials."""

    expansion: Expansion

    tips: ClassVar[tuple[float, ...]] = ()

    @property
    def near(self) -> float:
        return min(_NEAR, float(np.cosh(np.log(_GROWN) / len(self.expansion.c))))

    @property
    def α(self) -> float:
        return self.expansion.α

    @property
    def β(self) -> float:
        return self.expansion.β

    @cached_property
    def _rule(self) -> tuple[NDArray, NDArray, NDArray]:
        t, w = gauss(max(_FINE, 2 * len(self.expansion.c)), self.α, self.β)
        return t, w, self.series(t)

    def series(self, r: NDArray) -> NDArray[np.float64]:
        return self.expansion.series(r)

    def rest(self, r: NDArray, near: float) -> NDArray[np.float64]:
        t, w, p = self._rule
        known = np.abs(r) <= near
        taken = np.zeros_like(r)
        taken[known] = self.series(r[known])
        difference = t - r[:, None]
        on = np.abs(difference) < 1e-13
        return np.asarray(((p - taken[:, None]) / np.where(on, np.inf, difference)) @ w / np.pi)

    def integral(self, kernel: Callable[[NDArray], NDArray], r: NDArray) -> NDArray[np.float64]:
        t, w, p = self._rule
        return np.asarray(np.einsum("rtf,t->rf", kernel(r[:, None] - t), w * p))

    def points(self, finest: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        fine = Panels(self.α, self.β, min(finest, 0.7))
        return fine.t, fine.weights * self.series(fine.t)
