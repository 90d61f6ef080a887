"""The LuGre law of friction."""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ..parameters import parameter
from .law import LAWS, SHORT, MeasuredFriction
from .stribeck import StribeckCurve


@dataclass(frozen=True, kw_only=True)
class Bristles(StribeckCurve):
    """Base of laws with bristles that deflect by z, per normal force::

        f = σ₀ z + σ₁ ż + σ₂ v

    Their state is ζ = σ₀ z/N.
    """

    σ0: float = parameter(
        "sigma0_over_load", "stiffness σ₀ l/N", "1/m", symbol=r"\sigma_0 l/N", above=0.0,
        note="of the bristles",
    )  # fmt: skip
    σ1: float = parameter(
        "sigma1_over_load", "damping of the bristles σ₁/N", "s/m", symbol=r"\sigma_1/N", at_least=0.0,
        default=0.0,
    )  # fmt: skip
    σ2: float = parameter(
        "sigma2_over_load", "viscous friction σ₂/N", "s/m", symbol=r"\sigma_2/N", at_least=0.0,
        default=0.0,
    )  # fmt: skip

    @classmethod
    def guess(cls, measured: MeasuredFriction) -> dict[str, Any]:
        return {**super().guess(measured), "sigma0_over_load": measured.slope}

    def friction(self, z: NDArray, s: int, V: float) -> NDArray[np.float64]:
        ζ = z[..., 0]
        return ζ + V * self.σ1 / self.σ0 * self.rate(ζ, s, V) + s * self.σ2 * V


@dataclass(frozen=True, kw_only=True)
class LuGre(Bristles):
    """The LuGre law: bristles that deflect by z and slip away as they reach Stribeck's curve::

        ż = v - σ₀ |v| z/g(v),   f = σ₀ z + σ₁ ż + σ₂ v,   g(v) = μ_C + (μ_S - μ_C) exp(-|v/v_S|^j)

    (C. Canudas de Wit, H. Olsson, K. J. Åström, P. Lischinsky, IEEE Transactions on Automatic Control 40
    (1995) 419.) Its state is ζ = σ₀ z/N, hence dζ/dd = σ₀ (s - ζ/g).

    Raises:
        ValueError: a parameter is outside its range.
    """

    about: ClassVar[str] = "the LuGre law"
    broadcasts: ClassVar[bool] = True

    def rate(self, z: NDArray, s: int, V: float) -> NDArray[np.float64]:
        """dζ/dd [1/m]."""
        return self.σ0 * (s - z / self.g(V))

    def exact(self, z: NDArray, s: int, V: float, slip: NDArray) -> NDArray[np.float64]:
        """ζ = s g + (ζ₀ - s g) exp(-σ₀ d/g)."""
        ζ0, g = z[..., 0], self.g(V)
        return (ζ0 + (ζ0 - s * g) * np.expm1(-self.σ0 * np.asarray(slip) / g))[..., None]

    def work(self, z: NDArray, s: int, V: float, slip: NDArray) -> NDArray[np.float64]:
        """∫ s (ζ + σ₁ ż + σ₂ v) dd, the middle term by ż = V/σ₀ dζ/dd."""
        ζ0, g, d = z[..., 0], self.g(V), np.asarray(slip, dtype=float)
        built = (ζ0 - s * g) * np.expm1(-self.σ0 * d / g)
        bristles = s * (s * g * d - built * g / self.σ0)
        whole = bristles + s * self.σ1 * V / self.σ0 * built + self.σ2 * V * d
        short = self.σ0 * d < SHORT * g
        return np.where(short, self.work_of_short(z, s, V, d), whole) if short.any() else whole

    def slope(self, z: NDArray, s: int, V: float) -> NDArray[np.float64]:
        return s * self.rate(z[..., 0], s, V) * (1.0 - V * self.σ1 / self.g(V))

    def stiffness(self, z: NDArray, s: int, V: float) -> float:
        return float(self.σ0 / self.g(V))


LAWS.register("lugre", LuGre)
