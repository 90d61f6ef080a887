"""The elasto-plastic law of friction."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.friction.law import LAWS
from galinx.solvers.friction.lugre import Bristles
from galinx.solvers.parameters import parameter


@dataclass(frozen=True, kw_only=True)
class ElastoPlastic(Bristles):
    """The elasto-plastic law: LuGre's bristles, which do not slip before they break away::

        ż = v (1 - α(z, v) σ₀ z sgn(v)/g(v)),   f = σ₀ z + σ₁ ż + σ₂ v

    With ζ = σ₀ |z|/g, α = 0 up to the breakaway ratio r and where z and v differ in sign, 1 from ζ = 1
    on, and between (1 + sin(π (ζ - (1+r)/2)/(1-r)))/2. So loads below breakaway do not let it drift.
    (P. Dupont, V. Hayward, B. Armstrong, F. Altpeter, IEEE Transactions on Automatic Control 47 (2002)
    787.) Its state is σ₀ z/N.

    Raises:
        ValueError: a parameter is outside its range.
    """

    about: ClassVar[str] = "the elasto-plastic law"

    r: float = parameter(
        "breakaway_ratio", "deflection at breakaway over that of steady sliding", symbol="r",
        above=0.0, below=1.0, default=0.7,
    )  # fmt: skip

    def rate(self, z: NDArray, s: int, V: float) -> NDArray[np.float64]:
        """d(σ₀ z)/dd [1/m]."""
        ζ = s * z / self.g(V)
        between = np.minimum(np.maximum((ζ - self.r) / (1.0 - self.r), 0.0), 1.0)
        α = np.sin(0.5 * np.pi * between) ** 2
        return s * self.σ0 * (1.0 - α * ζ)

    def switches(self, z: NDArray, s: int, V: float) -> NDArray[np.float64]:
        """Breakaway."""
        return s * z / self.g(V) - self.r

    def slope(self, z: NDArray, s: int, V: float) -> NDArray[np.float64] | None:
        return s * self.rate(z[..., 0], s, V) if V * self.σ1 == 0.0 else None


LAWS.register("elasto_plastic", ElastoPlastic)
