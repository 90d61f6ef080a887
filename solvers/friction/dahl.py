"""Dahl's dynamic friction law (Eqs 2-5, 44-51)."""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ..parameters import parameter
from .law import LAWS, SHORT, FrictionLaw, MeasuredFriction, coulomb_coefficient

#: Distance y from full slip, below which its rate, a root, is followed no more.
_FULL = 1e-9


@dataclass(frozen=True)
class Dahl(FrictionLaw):
    """Dahl's law: along a stroke of direction s = ±1, with d the slip since its start::

        df/dd = s λ sgn(y) |y|^δ,   y = 1 - s f/μ_C,   λ = σ₀ l/N

    Its state is f itself.

    Raises:
        ValueError: a parameter is outside its range.
    """

    about: ClassVar[str] = "Dahl's law"
    depends_on_speed: ClassVar[bool] = False
    broadcasts: ClassVar[bool] = True

    μ_C: float = coulomb_coefficient()
    λ: float = parameter(
        "sigma0_over_load", "stiffness σ₀ l/N", "1/m", symbol=r"\sigma_0 l/N", above=0.0,
        note="the slope of f over slip where f = 0",
    )  # fmt: skip
    δ: float = parameter(
        "delta", "Dahl's exponent", symbol=r"\delta_D", above=0.0, default=1.0,
        note="below 1, full slip is reached after a finite slip",
    )  # fmt: skip

    @classmethod
    def guess(cls, measured: MeasuredFriction) -> dict[str, Any]:
        return {"mu_c": measured.level, "sigma0_over_load": measured.slope}

    def rate(self, z: NDArray, s: int, V: float = 0.0) -> NDArray[np.float64]:
        """df/dd [1/m]."""
        y = 1.0 - s * np.asarray(z, dtype=float) / self.μ_C
        return s * self.λ * np.sign(y) * np.abs(y) ** self.δ

    def switches(self, z: NDArray, s: int, V: float) -> NDArray[np.float64]:
        """Zero where the slip is full, if that comes after a finite slip, (0,) or (1,)."""
        return np.ravel(_FULL - (1.0 - s * z / self.μ_C))[: int(self.δ < 1.0)]

    def settle(self, z: NDArray, s: int, V: float) -> NDArray[np.float64]:
        """State of full slip where that has come."""
        full = (self.δ < 1.0) & (np.abs(1.0 - s * z / self.μ_C) <= 2.0 * _FULL)
        return np.where(full, s * self.μ_C, z)

    def friction(self, z: NDArray, s: int, V: float = 0.0) -> NDArray[np.float64]:
        return z[..., 0]

    def exact(self, z: NDArray, s: int, V: float, slip: NDArray) -> NDArray[np.float64]:
        """f after slip d from f₀ = z, by the law's exact solution, (len(slip), 1).

        δ = 1: y = y₀ exp(-λ d/μ_C); otherwise |y|^(1-δ) = |y₀|^(1-δ) - (1-δ) λ d/μ_C, and for δ < 1
        full slip, y = 0, is reached after a finite distance.
        """
        y0, decay = self._decay(z, s, slip)
        # y = y₀ exp(decay); a small change of f keeps its digits.
        return (z[..., 0] - s * self.μ_C * y0 * np.expm1(decay))[..., None]

    def distance(self, share: float) -> float:
        """Slip from rest [m] after which f is a share of μ_C, 0 < share < 1; the study's L_a."""
        fall = float(np.log1p(-share))
        x = (1.0 - self.δ) * fall
        return -self.μ_C / self.λ * fall * (float(np.expm1(x)) / x if x else 1.0)

    def work(self, z: NDArray, s: int, V: float, slip: NDArray) -> NDArray[np.float64]:
        """∫ s f dd = μ_C (d - ∫ y dd), and ∫ y dd = sgn(y₀) μ_C/λ (|y₀|^(2-δ) - |y|^(2-δ))/(2-δ)."""
        y0, decay = self._decay(z, s, slip)
        q = 2.0 - self.δ
        near = np.abs(q) < 1e-12
        with np.errstate(invalid="ignore"):
            by_power = -np.expm1(q * decay) / np.where(near, 1.0, q)
        y = np.where(near, -decay, by_power) * np.sign(y0) * np.abs(y0) ** q
        whole = self.μ_C * (slip - np.where(y0 == 0.0, 0.0, y) * self.μ_C / self.λ)
        short = -decay * np.maximum(1.0, np.abs(1.0 - self.δ)) < SHORT
        return np.where(short, self.work_of_short(z, s, V, slip), whole) if short.any() else whole

    def slope(self, z: NDArray, s: int, V: float) -> NDArray[np.float64]:
        return s * self.rate(z[..., 0], s)

    def stiffness(self, z: NDArray, s: int, V: float = 0.0) -> float | None:
        if self.δ < 1.0:
            return None  # it is infinite at full slip, about which steps of any length go to and fro
        y0 = max(1.0, abs(1.0 - s * float(z[0]) / self.μ_C))
        return self.λ * self.δ * y0 ** (self.δ - 1.0) / self.μ_C

    def _decay(self, z: NDArray, s: int, slip: NDArray) -> tuple[NDArray, NDArray]:
        """Distance y₀ from full slip at the start, and ln(y/y₀) after the slip."""
        x = self.λ * np.asarray(slip, dtype=float) / self.μ_C
        y0 = 1.0 - s * np.asarray(z, dtype=float)[..., 0] / self.μ_C
        p, size = 1.0 - self.δ, np.where(y0 == 0.0, 1.0, np.abs(y0))
        # Both formulas agree to the last digits here, and the power would divide by p ≈ 0.
        near = np.abs(p) * np.maximum(1.0, np.abs(np.log(size))) < 1e-9
        # |y| = |y₀| (1 - p x |y₀|^(-p))^(1/p), through log1p so that p → 0 keeps its digits.
        base = np.maximum(-p * x * size**-p, -1.0)
        with np.errstate(divide="ignore"):
            decay = np.log1p(base) / np.where(near, 1.0, p)
        decay = np.where(near, -x, decay)
        return y0, np.where(y0 == 0.0, 0.0, decay)


LAWS.register("dahl", Dahl)
