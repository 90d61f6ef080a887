"""Friction of rate and state."""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ..parameters import choice, parameter
from .law import LAWS, FrictionLaw, MeasuredFriction


@dataclass(frozen=True, kw_only=True)
class RateAndState(FrictionLaw):
    """Friction of rate and state: contacts that age, and are renewed by slip over D_c::

        f = a asinh[V/(2V₀) exp((f₀ + b ln(V₀θ/D_c))/a)]
        ageing: dθ/dt = 1 - Vθ/D_c        slip: dθ/dt = -(Vθ/D_c) ln(Vθ/D_c)

    (J. H. Dieterich, Journal of Geophysical Research 84 (1979) 2161; A. Ruina, ibid. 88 (1983) 10359; the
    inverse hyperbolic sine, which is no more than the logarithm that goes through V = 0, J. R. Rice, N.
    Lapusta, K. Ranjith, Journal of the Mechanics and Physics of Solids 49 (2001) 1865.) Its state is
    ϑ = V₀θ/D_c; steady sliding is ϑ = V₀/V, hence f = f₀ + (a - b) ln(V/V₀).

    Raises:
        ValueError: a parameter is outside its range.
    """

    about: ClassVar[str] = "rate and state"
    broadcasts: ClassVar[bool] = True
    conventions: ClassVar[tuple[str, ...]] = ("reference_speed",)

    f0: float = parameter(
        "reference_friction", "friction coefficient f₀ at the reference speed", symbol="f_0", above=0.0,
        at_most=1e3, usual=(1e-4, 10.0),
    )  # fmt: skip
    V0: float = parameter("reference_speed", "reference speed V₀", "m/s", symbol="V_0", above=0.0)
    a: float = parameter("a", "direct effect a", symbol="a", above=0.0, usual=(1e-5, 0.3))
    b: float = parameter("b", "effect of the state b", symbol="b", at_least=0.0, usual=(0.0, 0.3))
    D_c: float = parameter("critical_slip", "critical slip D_c", "m", symbol="D_c", above=0.0)
    evolution: str = choice(
        "evolution", "law of ageing", ("ageing", "slip"), note="Dieterich's law, or Ruina's"
    )
    ϑ0: float = parameter(
        "state0", "state V₀θ/D_c before the first stroke", symbol=r"\vartheta_0", above=0.0, default=1.0,
        note="1: as after steady sliding at the reference speed",
    )  # fmt: skip

    @classmethod
    def guess(cls, measured: MeasuredFriction) -> dict[str, Any]:
        return {
            "reference_friction": measured.level, "reference_speed": measured.speed,
            "a": 0.02 * measured.level, "b": 0.02 * measured.level,
            "critical_slip": 0.1 * measured.length,
        }  # fmt: skip

    def rest(self) -> NDArray[np.float64]:
        return np.asarray(self.ϑ0, dtype=float)[..., None]

    def friction(self, z: NDArray, s: int, V: float) -> NDArray[np.float64]:
        """Friction coefficient s a asinh(e^u), by logarithms: a may be small against f₀."""
        u = self._exponent(z, V)
        return s * self.a * np.logaddexp(u, 0.5 * np.logaddexp(2.0 * u, 0.0))

    def slope(self, z: NDArray, s: int, V: float) -> NDArray[np.float64]:
        """Slope by the state's rate: s ∂f/∂ϑ = b/ϑ e^u/√(1 + e^2u)."""
        u, ϑ = self._exponent(z, V), z[..., 0]
        return self.b / ϑ * np.exp(u - 0.5 * np.logaddexp(2.0 * u, 0.0)) * self.rate(ϑ, s, V)

    def _exponent(self, z: NDArray, V: float) -> NDArray[np.float64]:
        """Exponent u."""
        with np.errstate(divide="ignore"):
            return np.log(V / (2.0 * self.V0)) + (self.f0 + self.b * np.log(z[..., 0])) / self.a

    def rate(self, z: NDArray, s: int, V: float) -> NDArray[np.float64]:
        """dϑ/dd [1/m]."""
        steady = self._steady(V)
        aged = (steady - z) / self.D_c
        return np.where(self.evolution == "ageing", aged, -z / self.D_c * np.log(z / steady))

    def flow(self, z: NDArray, s: int, V: float) -> NDArray[np.float64]:
        """dϑ/dt [1/s]; the state ages at rest, too."""
        if self.evolution == "ageing":
            return (self.V0 - V * z) / self.D_c
        turns = V * z / self.V0
        return -self.V0 / self.D_c * turns * np.log(turns) if V > 0.0 else 0.0 * z

    def exact(self, z: NDArray, s: int, V: float, slip: NDArray) -> NDArray[np.float64]:
        """States by the exact solution: exp(-d/D_c) is the decay of ϑ - V₀/V, or ln(ϑ V/V₀) by slip."""
        steady, ϑ, x = self._steady(V), z[..., 0], np.asarray(slip, dtype=float) / self.D_c
        aged = ϑ * np.exp(-x) - steady * np.expm1(-x)  # a sum: after a long rest ϑ is very large
        slipped = steady * np.exp(np.log(ϑ / steady) * np.exp(-x))
        return np.where(self.evolution == "ageing", aged, slipped)[..., None]

    def pause(self, z: NDArray, seconds: float) -> NDArray[np.float64]:
        """State after a rest: θ grows with time by the ageing law, and stays by the slip law."""
        grown = np.where(self.evolution == "ageing", self.V0 / self.D_c * seconds, 0.0)
        return z + grown[..., None]

    def stiffness(self, z: NDArray, s: int, V: float) -> float | None:
        return 1.0 / float(self.D_c) if self.evolution == "ageing" else None

    def _steady(self, V: float) -> NDArray[np.float64]:
        if np.any(np.asarray(V) <= 0.0):
            raise ValueError("found the speed 0 m/s, expected one above it: rate and state ages there")
        return np.asarray(self.V0 / V)


LAWS.register("rate_and_state", RateAndState)
