"""Generalised Maxwell slip."""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ..parameters import parameter
from .law import LAWS, MeasuredFriction
from .maxwell_slip import Elements, MaxwellSlip
from .stribeck import StribeckCurve


@dataclass(frozen=True, kw_only=True)
class GeneralisedMaxwellSlip(Elements, StribeckCurve):
    """Generalised Maxwell slip: elements that stick as springs, and slip towards Stribeck's curve::

        stick: df_i = k_i dx, until s f_i = α_i g(v)
        slip:  df_i/dt = s C (α_i - |f_i|/g(v)), until v = 0
        f = Σ f_i,   α_i = μ_i/Σμ_i,   g(v) = μ_C + (μ_S - μ_C) exp(-|v/v_S|^j)

    (F. Al-Bender, V. Lampaert, J. Swevers, IEEE Transactions on Automatic Control 50 (2005) 1883.) At
    vanishing speed, and for C → ∞, it is Maxwell slip. Its state is all f_i, then the direction in which
    each slips, 0 where it sticks.

    Raises:
        ValueError: a parameter is outside its range.
    """

    about: ClassVar[str] = "generalised Maxwell slip"
    batched: ClassVar[bool] = True
    conventions: ClassVar[tuple[str, ...]] = ("elements[0, 1]",)  # only the ratios of limits matter

    C: float = parameter(
        "attraction_rate", "attraction rate C/N", "1/s", symbol="C/N", above=0.0,
        note="how fast slipping elements come to Stribeck's curve",
    )  # fmt: skip

    @classmethod
    def guess(cls, measured: MeasuredFriction) -> dict[str, Any]:
        """Springs of Maxwell slip, whose search among many minima is quick."""
        springs = measured.fitted(MaxwellSlip)["elements"]
        rate = 10.0 * measured.speed / measured.length
        return super().guess(measured) | {"elements": springs, "attraction_rate": rate}

    @property
    def α(self) -> NDArray[np.float64]:
        """Shares of the elements in steady sliding, (n,)."""
        return self.μ / self.μ.sum(axis=-1, keepdims=True)

    def rest(self) -> NDArray[np.float64]:
        return np.zeros(2 * self.k.shape[-1])

    def pause(self, z: NDArray, seconds: float) -> NDArray[np.float64]:
        """State after a rest, in which all elements stick."""
        if seconds <= 0.0:
            return z
        f, slipping = np.split(z, 2, axis=-1)
        return np.concatenate([f, 0.0 * slipping], axis=-1)

    def rate(self, z: NDArray, s: int, V: float) -> NDArray[np.float64]:
        """Rates df_i/dd [1/m] at a speed above 0, and 0 of the directions of slip."""
        return self.flow(z, s, V) / V

    def flow(self, z: NDArray, s: int, V: float) -> NDArray[np.float64]:
        """Rates df_i/dt [1/s], and 0 of the directions of slip."""
        f, slipping = np.split(z, 2)
        attracted = self.C * (self.α - s * f / self.g(V))
        return np.append(s * np.where(s * slipping > 0.0, attracted, V * self.k), 0.0 * f)

    def switches(self, z: NDArray, s: int, V: float) -> NDArray[np.float64]:
        """Zero where an element that sticks comes to its limit, (elements,)."""
        f, slipping = np.split(z, 2)
        return np.where(s * slipping > 0.0, -1.0, s * f - self.α * self.g(V))

    def settle(self, z: NDArray, s: int, V: float) -> NDArray[np.float64]:
        """State in which each element that has come to its limit slips."""
        f, slipping = np.split(z, 2)
        slips = (s * slipping > 0.0) | (s * f >= self.α * self.g(V) * (1.0 - 1e-9))
        return np.append(f, s * slips)

    def friction(self, z: NDArray, s: int, V: float) -> NDArray[np.float64]:
        return z[..., : self.k.shape[-1]].sum(axis=-1)

    def exact(self, z: NDArray, s: int, V: float, slip: NDArray) -> NDArray[np.float64]:
        """States by a straight line up to α g while an element sticks; |f_i| - α g decays in slip."""
        w, reached, stuck, decay = self._pieces(z, s, V, np.asarray(slip, dtype=float)[:, None])
        limit = self._limit(V)
        f = np.where(reached, limit + (w - limit) * np.exp(-decay), w + self.k * stuck)
        slipping = reached | (w + self.k * stuck >= limit * (1.0 - 1e-14))
        return np.concatenate([s * np.where(slipping & ~reached, limit, f), s * slipping], axis=-1)

    def work(self, z: NDArray, s: int, V: float, slip: NDArray) -> NDArray[np.float64]:
        d = np.asarray(slip, dtype=float)[:, None]
        w, reached, stuck, decay = self._pieces(z, s, V, d)
        limit, over = self.α * self.g(V), V * self.g(V) / self.C
        slipped = limit * d - (w - limit) * over * np.expm1(-decay)
        built = w * stuck + 0.5 * self.k * stuck**2 + limit * (d - stuck)
        return np.where(reached, slipped, built).sum(axis=1)

    def slope(self, z: NDArray, s: int, V: float) -> NDArray[np.float64]:
        """Slope of elements that stick, of those that slip, and of those at their limit, which is 0."""
        limit, w, slipping = self._limit(V), *(s * of for of in np.split(z, 2, axis=-1))
        slips = (slipping > 0.0) | (w > limit)
        attracted = self.C * (self.α - w / np.asarray(self.g(V))[..., None]) / V if V > 0.0 else 0.0
        return np.where(slips, attracted, np.where(w < limit, self.k, 0.0)).sum(axis=-1)

    def _pieces(
        self, z: NDArray, s: int, V: float, d: NDArray
    ) -> tuple[NDArray, NDArray, NDArray, NDArray]:
        """Pieces of the motion of each element.

        Returns:
            s f_i at the start; True where an element slips from the start on; slip while it sticks [m];
            and the exponent of its decay while it slips.
        """
        limit = self._limit(V)
        f, slipping = np.split(z, 2, axis=-1)
        w = s * f
        # A speed at which less is borne than an element bears makes it slip at once.
        reached = (s * slipping > 0.0) | (w > limit)
        stuck = np.minimum(d, np.maximum(limit - w, 0.0) / self.k)
        decay = d * (np.asarray(self.C / (V * self.g(V)))[..., None] if V > 0.0 else 1e300)
        return w, reached, stuck, decay

    def _limit(self, V: float) -> NDArray[np.float64]:
        """Limits α g of the elements."""
        return self.α * np.asarray(self.g(V))[..., None]


LAWS.register("gms", GeneralisedMaxwellSlip)
