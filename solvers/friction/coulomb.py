"""Coulomb's law of friction."""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ..parameters import check
from .law import LAWS, FrictionLaw, MeasuredFriction, coulomb_coefficient


@dataclass(frozen=True)
class Coulomb(FrictionLaw):
    """Coulomb's law: friction against the motion, of one size and without memory::

        f = s μ_C

    (C. A. Coulomb, Théorie des machines simples, 1785.) Its state stays zero.

    Raises:
        ValueError: a parameter is outside its range.
    """

    about: ClassVar[str] = "Coulomb's law"
    depends_on_speed: ClassVar[bool] = False
    broadcasts: ClassVar[bool] = True
    has_memory: ClassVar[bool] = False

    μ_C: float = coulomb_coefficient("at_least")

    def __post_init__(self) -> None:
        check(self)

    @classmethod
    def guess(cls, seen: MeasuredFriction) -> dict[str, Any]:
        return {"mu_c": seen.level}

    def rate(self, z: NDArray, s: int, V: float = 0.0) -> NDArray[np.float64]:
        """Rate of the state: 0."""
        return np.zeros(np.shape(z))

    def friction(self, z: NDArray, s: int, V: float = 0.0) -> NDArray[np.float64]:
        return s * self.μ_C + np.zeros(np.shape(z)[:-1])

    def exact(self, z: NDArray, s: int, V: float, slip: NDArray) -> NDArray[np.float64]:
        return np.zeros(np.shape(self.μ_C + np.asarray(slip)))[..., None]

    def work(self, z: NDArray, s: int, V: float, slip: NDArray) -> NDArray[np.float64]:
        return self.μ_C * np.asarray(slip, dtype=float)

    def slope(self, z: NDArray, s: int, V: float) -> NDArray[np.float64]:
        return 0.0 * self.friction(z, s)


LAWS.register("coulomb", Coulomb)
