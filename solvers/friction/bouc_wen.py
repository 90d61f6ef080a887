"""The Bouc-Wen law of hysteresis."""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ..approximation import inverted
from ..parameters import parameter
from .law import LAWS, FrictionLaw, MeasuredFriction, coulomb_coefficient

#: y = -ln(1 - w) from which on the slip is its asymptote, and y of full slip.
_FAR, _FULL = 14.0, 700.0

#: w up to which the work of loading is its integral.
_LITTLE = 0.5


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

    μ_C: float = coulomb_coefficient()
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

    @classmethod
    def guess(cls, measured: MeasuredFriction) -> dict[str, Any]:
        return {
            "mu_c": measured.level,
            "yield_displacement": measured.level / measured.slope,
            "exponent": 1.2,
        }

    def rate(self, z: NDArray, s: int, V: float = 0.0) -> NDArray[np.float64]:
        """dζ/dd [1/m]."""
        w = s * np.asarray(z, dtype=float)
        return s * (1.0 - np.where(w > 0.0, 1.0, 2.0 * self.γ - 1.0) * np.abs(w) ** self.n) / self.x_y

    def friction(self, z: NDArray, s: int, V: float = 0.0) -> NDArray[np.float64]:
        return self.μ_C * z[..., 0]

    def exact(self, z: NDArray, s: int, V: float, slip: NDArray) -> NDArray[np.float64]:
        """Slip as a function of w, inverted: x = d/x_y = ∫ dw/(1 - k|w|ⁿ) = w ₂F₁(1, 1/n; 1+1/n; k|w|ⁿ).

        k = 1 where w > 0, 2γ-1 where w < 0. From w₀ < 0 it unloads to zero first.
        """
        w0, x = s * float(z[0]), np.asarray(slip, dtype=float) / self.x_y
        k = 2.0 * self.γ - 1.0
        from_zero = np.zeros(()) if w0 < 0.0 else _loaded_after(_slip_to(min(w0, 1.0), self.n), self.n)
        to_zero = _slip(-w0, k, self.n) if w0 < 0.0 else 0.0
        loading = np.maximum(x - to_zero, 0.0)
        start = 0.0 if w0 < 0.0 else _slip_to(min(w0, 1.0), self.n)
        up = _loaded_after(start + loading, self.n)
        # At no slip the result is the start to the last digit.
        up = np.where(loading == 0.0, max(w0, 0.0), up + (max(w0, 0.0) - from_zero))
        down = _unloaded_at(np.clip(to_zero - x, 0.0, None), -w0, k, self.n) if w0 < 0.0 else 0.0
        return s * np.where(x < to_zero, -down, np.minimum(up, 1.0))[:, None]

    def switches(self, z: NDArray, s: int, V: float) -> NDArray[np.float64]:
        """Zero at the switch from unloading to loading, (1,)."""
        return s * z

    def work(self, z: NDArray, s: int, V: float, slip: NDArray) -> NDArray[np.float64]:
        """∫ w dx = w²/2 ₂F₁(1, 2/n; 1+2/n; k|w|ⁿ) of both parts."""
        ends = s * np.append(z[:1], self.exact(z, s, V, np.asarray(slip))[:, 0])
        k, x = 2.0 * self.γ - 1.0, np.asarray(slip, dtype=float) / self.x_y
        down = _slip(np.maximum(-ends, 0.0), k, self.n, 2.0)
        begun = _slip(np.maximum(-ends[0], 0.0), k, self.n)
        loading = np.maximum(x - begun, 0.0)
        loaded = np.maximum(ends, 0.0)
        short = _short(loaded, self.n)
        # Where little is loaded, the work of full slip less what is short of it has no digits.
        little = _slip(np.minimum(loaded, _LITTLE), 1.0, self.n, 2.0)
        up = np.where(loaded[1:] < _LITTLE, little[1:] - little[0], loading - (short[1:] - short[0]))
        return self.μ_C * self.x_y * (up - (down[0] - down[1:]))

    def slope(self, z: NDArray, s: int, V: float) -> NDArray[np.float64]:
        return s * self.μ_C * self.rate(z[..., 0], s)

    def stiffness(self, z: NDArray, s: int, V: float) -> float:
        return self.n * max(1.0, abs(float(z[0]))) ** (self.n - 1.0) / self.x_y


def _slip(w: float | NDArray, k: float, n: float, power: float = 1.0) -> NDArray[np.float64]:
    """∫ w^(power - 1) dw/(1 - k wⁿ) from 0 to w >= 0: slip, and its moment for the power 2."""
    from scipy.special import hyp2f1  # slow to import

    return w**power / power * hyp2f1(1.0, power / n, 1.0 + power / n, k * np.power(w, n))


def _short(w: NDArray, n: float) -> NDArray[np.float64]:
    """∫ (1 - w)/(1 - wⁿ) dw from 0 to w: work of full slip less that of loading, over μ_C x_y."""
    near = np.minimum(w, -np.expm1(-_FAR))
    return _slip(near, 1.0, n) - _slip(near, 1.0, n, 2.0) + (w - near) / n


def _slip_of(y: NDArray, n: float) -> NDArray[np.float64]:
    """∫ dw/(1 - wⁿ) from 0 to w, by y = -ln(1 - w), which grows with the slip without end."""
    near = np.minimum(y, _FAR)
    ε, ε_near = np.exp(-y), np.exp(-near)
    # Beyond, 1/(1 - wⁿ) is 1/(nε) (1 + (n-1)ε/2) to the last digits, with ε = 1 - w.
    return _slip(-np.expm1(-near), 1.0, n) + (y - near + 0.5 * (n - 1.0) * (ε_near - ε)) / n


def _slip_to(w: float, n: float) -> NDArray[np.float64]:
    """Slip of loading from 0 to w."""
    with np.errstate(divide="ignore"):
        return _slip_of(np.minimum(-np.log1p(-np.asarray(w)), _FULL), n)


def _loaded_after(x: NDArray, n: float) -> NDArray[np.float64]:
    """State w after slips x from 0, by y = -ln(1 - w), of which slip is nearly linear."""

    def slip(y: NDArray) -> tuple[NDArray, NDArray]:
        w = -np.expm1(-y)
        with np.errstate(divide="ignore", invalid="ignore"):
            slope = np.where(y > _FAR, 1.0 / n, np.exp(-y) / -np.expm1(n * np.log(w)))
        return _slip_of(y, n), np.where(y == 0.0, 1.0, slope)

    # For n = 1 y is x, for larger n it is larger.
    return -np.expm1(-inverted(slip, x, np.array(x, dtype=float)))


def _unloaded_at(x: NDArray, most: float, k: float, n: float) -> NDArray[np.float64]:
    """Size |w| from which unloading to zero takes a slip x, at most ``most``, |w| at the start."""
    return inverted(lambda u: (_slip(u, k, n), 1.0 / (1.0 - k * u**n)), x, np.minimum(x, most), high=most)


LAWS.register("bouc_wen", BoucWen)
