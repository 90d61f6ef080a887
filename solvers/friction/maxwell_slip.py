"""Maxwell slip: springs with sliders, side by side."""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ..parameters import rows
from .law import LAWS, FrictionLaw, MeasuredFriction


@dataclass(frozen=True)
class Elements(FrictionLaw):
    """Base of laws with springs that each have a limit, side by side.

    Raises:
        ValueError: a stiffness or a limit is not above zero.
    """

    elements: tuple[tuple[float, float], ...] = rows(
        "elements", "springs and their limits", ("1/m", ""), measured=(0, 1),
        note="a row of k/N and μ for each; the slope of f over slip at its start is the sum of all k/N",
    )  # fmt: skip

    def __post_init__(self) -> None:
        super().__post_init__()
        if np.min(self.elements) <= 0.0:
            elements = [list(row) for row in self.elements]
            raise ValueError(f"elements = {elements}: expected stiffnesses and limits above 0")

    @classmethod
    def guess(cls, measured: MeasuredFriction) -> dict[str, Any]:
        """Elements that slide one after the other, each after twice the slip of the one before."""
        μ = measured.level / measured.rows
        slips = 0.5 * measured.length * 0.5 ** np.arange(measured.rows)
        return super().guess(measured) | {"elements": tuple((float(μ / slip), μ) for slip in slips[::-1])}

    @property
    def k(self) -> NDArray[np.float64]:
        """Stiffnesses over N [1/m], (n,)."""
        return np.asarray(self.elements)[..., 0]

    @property
    def μ(self) -> NDArray[np.float64]:
        """Limits over N, (n,)."""
        return np.asarray(self.elements)[..., 1]


@dataclass(frozen=True)
class MaxwellSlip(Elements):
    """Maxwell slip: springs that each slide at a limit of their own, side by side::

        df_i = k_i dx where |f_i| < μ_i or |f_i| falls, else 0;   f = Σ f_i

    Its hysteresis is Masing's: minor loops close, and f returns to a point of reversal as if it had never
    left it. (W. D. Iwan, Journal of Applied Mechanics 33 (1966) 893; F. Al-Bender, V. Lampaert, J.
    Swevers, IEEE Transactions on Automatic Control 50 (2005) 1883.) Its state is all f_i.

    Raises:
        ValueError: a parameter is outside its range.
    """

    about: ClassVar[str] = "Maxwell slip"
    depends_on_speed: ClassVar[bool] = False

    def rest(self) -> NDArray[np.float64]:
        return np.zeros(len(self.elements))

    def rate(self, z: NDArray, s: int, V: float = 0.0) -> NDArray[np.float64]:
        """df_i/dd [1/m]."""
        return np.where(s * z < self.μ, s * self.k, 0.0)

    def settle(self, z: NDArray, s: int, V: float = 0.0) -> NDArray[np.float64]:
        """State in which each element near its limit is exactly at it."""
        return np.where(s * z >= self.μ * (1.0 - 1e-9), s * self.μ, z)

    def friction(self, z: NDArray, s: int, V: float = 0.0) -> NDArray[np.float64]:
        return z.sum(axis=-1)

    def exact(self, z: NDArray, s: int, V: float, slip: NDArray) -> NDArray[np.float64]:
        return s * np.minimum(s * z + self.k * np.asarray(slip)[:, None], self.μ)

    def work(self, z: NDArray, s: int, V: float, slip: NDArray) -> NDArray[np.float64]:
        """Work by elements whose f is a straight line up to its limit, then constant."""
        d = np.asarray(slip, dtype=float)[:, None]
        stuck = np.minimum(d, (self.μ - s * z) / self.k)
        return (s * z * stuck + 0.5 * self.k * stuck**2 + self.μ * (d - stuck)).sum(axis=1)

    def slope(self, z: NDArray, s: int, V: float) -> NDArray[np.float64]:
        return s * self.rate(z, s).sum(axis=-1)

    def switches(self, z: NDArray, s: int, V: float) -> NDArray[np.float64]:
        """Zero where an element reaches its limit, (elements,)."""
        return s * z - self.μ


LAWS.register("maxwell_slip", MaxwellSlip)
