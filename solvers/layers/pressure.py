"""A contact pressure that was found, by what is read off it: values, transforms, integrals."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.special import roots_jacobi

from galinx.solvers.sie.collocation import Expansion

#: |r| up to which polynomials have not grown, and points of the rule beyond it.
_NEAR, _FINE = 1.1, 96


class Pressure(Protocol):
    """σ_YY over N/(2a) = (1 - r)^α (1 + r)^β p(r).

    Attributes:
        α, β: exponents.
        near: |r| up to which p is known.
    """

    @property
    def α(self) -> float: ...
    @property
    def β(self) -> float: ...
    @property
    def near(self) -> float: ...

    def series(self, r: NDArray) -> NDArray[np.float64]:
        """p at |r| <= near."""

    def rest(self, r: NDArray) -> NDArray[np.float64]:
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

    near = _NEAR

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

    def rest(self, r: NDArray) -> NDArray[np.float64]:
        t, w, p = self._rule
        known = np.abs(r) <= _NEAR
        taken = np.zeros_like(r)
        taken[known] = self.series(r[known])
        difference = t - r[:, None]
        on = np.abs(difference) < 1e-13
        return np.asarray(((p - taken[:, None]) / np.where(on, np.inf, difference)) @ w / np.pi)

    def integral(self, kernel: Callable[[NDArray], NDArray], r: NDArray) -> NDArray[np.float64]:
        t, w, p = self._rule
        return np.asarray(np.einsum("rtf,t->rf", kernel(r[:, None] - t), w * p))

    def points(self, finest: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        t, w = fine_rule(self.α, self.β, finest)
        return t, w * self.series(t)


#: Places x = log((1 + t)/(1 - t)) beyond which all is as at the end; longest panel in x, in t over the
#: length that is to be resolved; points of a panel.
_REACH, _LONGEST, _SHARE, _POINTS = 36.0, 2.5, 2.0, 16


def fine_rule(α: float, β: float, finest: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """A rule for the weight times what is smooth in log((1 + t)/(1 - t)) and varies over ``finest``."""
    edges = [0.0]
    while edges[-1] < _REACH:
        x = edges[-1]
        slope = 0.5 / np.cosh(x / 2.0) ** 2
        edges.append(x + min(_LONGEST, _SHARE * finest / slope, max(_REACH - x, 0.1)))
    ends = np.concatenate([-np.array(edges[:0:-1]), edges])
    τ, w = np.polynomial.legendre.leggauss(_POINTS)
    half = np.diff(ends) / 2.0
    x = ((ends[1:] + ends[:-1])[:, None] / 2.0 + half[:, None] * τ).ravel()
    return np.tanh(x / 2.0), (half[:, None] * w).ravel() * weight(x, α, β)


def weight(x: NDArray, α: float, β: float) -> NDArray[np.float64]:
    """(1 - t)^α (1 + t)^β dt/dx."""
    # 1 ∓ t = 2/(1 + e^(±x)) and dt/dx is half the product of both.
    log = (1.0 + α) * (np.log(2.0) - np.logaddexp(0.0, x)) + (1.0 + β) * (
        np.log(2.0) - np.logaddexp(0.0, -x)
    )
    return np.asarray(np.exp(log) / 2.0)
