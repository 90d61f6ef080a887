"""The Bouc-Wen law of hysteresis."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.friction.law import LAWS, FrictionLaw
from galinx.solvers.parameters import check, parameter


@dataclass(frozen=True)
class BoucWen(FrictionLaw):
    """The Bouc-Wen law: a hysteresis between elastic and full slip of any sharpness::

        dζ/dx = (1 - |ζ|^n (γ + (1-γ) sgn(ẋ ζ)))/x_y,   f = μ_C ζ

    (R. Bouc, Acustica 24 (1971) 16; Y. K. Wen, Journal of the Engineering Mechanics Division 102 (1976)
    249.) With w = s ζ: dw/dd = (1 - wⁿ)/x_y where w > 0, and (1 - (2γ-1) |w|ⁿ)/x_y where w < 0. n = 1 and
    γ = 0 is Dahl's law with δ = 1. Its state is ζ.

    Raises:
        ValueError: a parameter is outside its range.
    """

    about: ClassVar[str] = "the Bouc-Wen law"
    depends_on_speed: ClassVar[bool] = False

    μ_C: float = parameter(
        "mu_c", "Coulomb's coefficient μ_C", symbol=r"\mu_C", above=0.0, usual=(1e-4, 10.0)
    )
    x_y: float = parameter(
        "yield_displacement", "yield displacement x_y", "m", symbol="x_y", above=0.0,
        note="the slope of f over slip where f = 0 is μ_C/x_y",
    )  # fmt: skip
    n: float = parameter(
        "exponent", "exponent n", symbol="n", at_least=1.0, default=1.0, note="the larger, the sharper"
    )
    γ: float = parameter(
        "gamma", "shape γ of unloading", symbol=r"\gamma", at_least=0.0, below=1.0, default=0.5,
        note="0.5: unloading is a straight line",
    )  # fmt: skip

    def __post_init__(self) -> None:
        check(self)

    def rate(self, z: NDArray, s: int, V: float = 0.0) -> NDArray[np.float64]:
        """dζ/dd [1/m]."""
        w = s * np.asarray(z, dtype=float)
        return s * (1.0 - np.where(w > 0.0, 1.0, 2.0 * self.γ - 1.0) * np.abs(w) ** self.n) / self.x_y

    def friction(self, z: NDArray, s: int, V: float = 0.0) -> NDArray[np.float64]:
        return self.μ_C * z[..., 0]

    def switches(self, z: NDArray, s: int, V: float) -> NDArray[np.float64]:
        """From unloading to loading."""
        return s * z

    def exact(self, z: NDArray, s: int, V: float, slip: NDArray) -> NDArray[np.float64] | None:
        """n = 1: unloading to w = 0 with k = 2γ-1 is w = w₀ e^(kx) + (e^(kx) - 1)/k, loading an
        exponential."""
        if self.n != 1.0:
            return None
        w0, x, k = s * float(z[0]), np.asarray(slip, dtype=float) / self.x_y, 2.0 * self.γ - 1.0
        to_zero = 0.0
        if w0 < 0.0:
            to_zero = -w0 if k == 0.0 else -np.log1p(k * w0) / k
        down = np.minimum(x, to_zero)
        unloading = w0 * np.exp(k * down) + (down if k == 0.0 else np.expm1(k * down) / k)
        loading = max(w0, 0.0) - (1.0 - max(w0, 0.0)) * np.expm1(-np.maximum(x - to_zero, 0.0))
        return s * np.where(x < to_zero, unloading, loading)[:, None]

    def slope(self, z: NDArray, s: int, V: float) -> NDArray[np.float64]:
        return s * self.μ_C * self.rate(z[..., 0], s)

    def stiffness(self, z: NDArray, s: int, V: float) -> float:
        return self.n * max(1.0, abs(float(z[0]))) ** (self.n - 1.0) / self.x_y


LAWS.register("bouc_wen", BoucWen)
