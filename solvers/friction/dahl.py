"""Dahl's dynamic friction law (Eqs 2-5, 44-51)."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.friction.law import LAWS, FrictionLaw
from galinx.solvers.parameters import check, parameter


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

    μ_C: float = parameter(
        "mu_c", "Coulomb's coefficient μ_C", symbol=r"\mu_C", above=0.0, usual=(1e-4, 10.0)
    )
    λ: float = parameter(
        "sigma0_over_load", "stiffness σ₀ l/N", "1/m", symbol=r"\sigma_0 l/N", above=0.0,
        note="the slope of f over slip where f = 0",
    )  # fmt: skip
    δ: float = parameter(
        "delta", "Dahl's exponent", symbol=r"\delta_D", above=0.0, default=1.0,
        note="below 1, full slip is reached after a finite slip",
    )  # fmt: skip

    def __post_init__(self) -> None:
        check(self)

    def rate(self, z: NDArray, s: int, V: float = 0.0) -> NDArray[np.float64]:
        """df/dd [1/m]."""
        y = 1.0 - s * np.asarray(z, dtype=float) / self.μ_C
        return s * self.λ * np.sign(y) * np.abs(y) ** self.δ

    def friction(self, z: NDArray, s: int, V: float = 0.0) -> NDArray[np.float64]:
        return z[..., 0]

    def exact(self, z: NDArray, s: int, V: float, slip: NDArray) -> NDArray[np.float64]:
        """f after slip from f₀ = z, by the law's exact solution, (len(slip), 1).

        δ = 1: y = y₀ exp(-λ d/μ_C); otherwise |y|^(1-δ) = |y₀|^(1-δ) - (1-δ) λ d/μ_C, and for δ < 1
        full slip, y = 0, is reached after a finite distance.
        """
        x = self.λ * np.asarray(slip, dtype=float)[:, None] / self.μ_C
        y0 = 1.0 - s * float(z[0]) / self.μ_C
        p = 1.0 - self.δ
        if y0 == 0.0:
            decay = np.zeros_like(x)
        elif abs(p) * max(1.0, abs(np.log(abs(y0)))) < 1e-9:
            # Both formulas agree to the last digits here, and the power would divide by p ≈ 0.
            decay = -x
        else:
            # |y| = |y₀| (1 - p x |y₀|^(-p))^(1/p), through log1p so that p → 0 keeps its digits.
            base = np.maximum(-p * x * abs(y0) ** -p, -1.0)
            with np.errstate(divide="ignore"):
                decay = np.log1p(base) / p
        # y = y₀ exp(decay); what is added to f keeps its digits where it is small.
        return float(z[0]) - s * self.μ_C * y0 * np.expm1(decay)

    def stiffness(self, z: NDArray, s: int, V: float = 0.0) -> float:
        y0 = max(1.0, abs(1.0 - s * float(z[0]) / self.μ_C))
        return self.λ * self.δ * y0 ** (self.δ - 1.0) / self.μ_C


LAWS.register("dahl", Dahl)
