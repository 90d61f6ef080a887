"""Laws without memory, Coulomb's and Stribeck's; and Stribeck's curve, of which other laws are made."""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ..parameters import parameter
from .law import LAWS, FrictionLaw, MeasuredFriction, coulomb_coefficient


class Memoryless(FrictionLaw):
    """Base of laws without memory, f = s h(V); their state stays zero."""

    broadcasts: ClassVar[bool] = True
    has_memory: ClassVar[bool] = False

    def level(self, V: float) -> NDArray[np.float64]:
        """Size h of the friction coefficient at a speed [m/s]."""
        raise NotImplementedError

    def rate(self, z: NDArray, s: int, V: float = 0.0) -> NDArray[np.float64]:
        """Rate of the state: 0."""
        return np.zeros(np.shape(z))

    def friction(self, z: NDArray, s: int, V: float = 0.0) -> NDArray[np.float64]:
        return s * self.level(V) + np.zeros(np.shape(z)[:-1])

    def exact(self, z: NDArray, s: int, V: float, slip: NDArray) -> NDArray[np.float64]:
        return np.zeros(np.shape(self.level(V) + np.asarray(slip)))[..., None]

    def work(self, z: NDArray, s: int, V: float, slip: NDArray) -> NDArray[np.float64]:
        return self.level(V) * np.asarray(slip, dtype=float)

    def slope(self, z: NDArray, s: int, V: float) -> NDArray[np.float64]:
        return 0.0 * self.friction(z, s, V)


@dataclass(frozen=True)
class Coulomb(Memoryless):
    """Coulomb's law: friction against the motion, of one size and without memory::

        f = s μ_C

    (C. A. Coulomb, Théorie des machines simples, 1785.) Its state stays zero.

    Raises:
        ValueError: a parameter is outside its range.
    """

    about: ClassVar[str] = "Coulomb's law"
    depends_on_speed: ClassVar[bool] = False

    μ_C: float = coulomb_coefficient("at_least")

    @classmethod
    def guess(cls, measured: MeasuredFriction) -> dict[str, Any]:
        return {"mu_c": measured.level}

    def level(self, V: float) -> NDArray[np.float64]:
        return np.asarray(self.μ_C)


@dataclass(frozen=True, kw_only=True)
class StribeckCurve(FrictionLaw):
    """Base of laws that follow Stribeck's curve in steady sliding::

    g(V) = μ_C + (μ_S - μ_C) exp(-(V/v_S)^j)
    """

    μ_C: float = coulomb_coefficient()
    μ_S: float = parameter(
        "mu_s", "coefficient of static friction μ_S", symbol=r"\mu_S", above=0.0, usual=(1e-4, 10.0),
        note="steady sliding at vanishing speed",
    )  # fmt: skip
    v_S: float = parameter("stribeck_velocity", "Stribeck velocity v_S", "m/s", symbol="v_S", above=0.0)
    j: float = parameter(
        "stribeck_exponent", "exponent of Stribeck's curve", symbol="j", above=0.0, default=2.0,
        note="1: Tustin's form, 2: Gauss's",
    )  # fmt: skip

    @classmethod
    def guess(cls, measured: MeasuredFriction) -> dict[str, Any]:
        return {"mu_c": measured.least, "mu_s": measured.level, "stribeck_velocity": measured.speed}

    def g(self, V: float) -> NDArray[np.float64]:
        """Coefficient of steady sliding at a speed [m/s], without viscous friction."""
        with np.errstate(over="ignore"):  # a steep curve's power is infinite beyond v_S
            share = np.exp(-np.power(V / self.v_S, self.j))
        return self.μ_C + (self.μ_S - self.μ_C) * share


@dataclass(frozen=True, kw_only=True)
class Stribeck(Memoryless, StribeckCurve):
    """Stribeck's curve with viscous friction, without memory::

        f = s (g(V) + σ₂ V),   g(V) = μ_C + (μ_S - μ_C) exp(-(V/v_S)^j)

    (B. Armstrong-Hélouvry, P. Dupont, C. Canudas de Wit, Automatica 30 (1994) 1083.) Its state stays
    zero.

    Raises:
        ValueError: a parameter is outside its range.
    """

    about: ClassVar[str] = "Stribeck's curve"

    σ2: float = parameter(
        "sigma2_over_load", "viscous friction σ₂/N", "s/m", symbol=r"\sigma_2/N", at_least=0.0,
        default=0.0,
    )  # fmt: skip

    def level(self, V: float) -> NDArray[np.float64]:
        return self.g(V) + self.σ2 * V


LAWS.register("coulomb", Coulomb)
LAWS.register("stribeck", Stribeck)
