"""What a friction law is."""

from typing import ClassVar, Protocol

import numpy as np
from numpy.typing import NDArray

from galinx.registry import Registry
from galinx.solvers.parameters import parameters


class FrictionLaw(Protocol):
    """A law of dynamic friction, per normal force: f = F/N.

    A law is a dataclass whose fields are made by :func:`galinx.solvers.parameters.parameter`; scenes set
    them by their keys. Its inner state z, (n,), changes with the slip. Those that inherit from this
    class need :meth:`friction`, and :meth:`rate` or :meth:`exact`.

    Attributes:
        about: what the law is called, with its source.
        depends_on_speed: False where f is the same at every speed; it is then computed once.
    """

    about: ClassVar[str]
    depends_on_speed: ClassVar[bool] = True

    def rest(self) -> NDArray[np.float64]:
        """State before the first stroke, (n,)."""
        return np.zeros(1)

    def rate(self, z: NDArray, s: int, V: float) -> NDArray[np.float64]:
        """dz/d(slip) [1/m] in direction s = ±1 at the speed V >= 0 [m/s], (n,)."""
        raise NotImplementedError

    def friction(self, z: NDArray, s: int, V: float) -> NDArray[np.float64]:
        """f at states z (..., n), dimensionless, positive in forward motion: (...)."""
        raise NotImplementedError

    def exact(self, z: NDArray, s: int, V: float, slip: NDArray) -> NDArray[np.float64] | None:
        """States after so much slip [m] from z, (len(slip), n); None where only the rate is known."""
        return None

    def stiffness(self, z: NDArray, s: int, V: float) -> float | None:
        """Largest |∂(dz/d(slip))/∂z| [1/m] of a stroke that starts at z; None where it is not known.

        Runge-Kutta's steps are stable where it is known to be small.
        """
        return None


class Laws(Registry[type[FrictionLaw]]):
    """Friction laws; parameters of one name are one column of archives, whatever the law."""

    def register(self, name: str, model: type[FrictionLaw]) -> type[FrictionLaw]:
        """Add a law of one's own, and return it.

        Raises:
            ValueError: the name is taken, or another law has that parameter in another unit.
        """
        for other, law in self.items():
            known = parameters(law)
            for key, parameter in parameters(model).items():
                if other != name and key in known and known[key].unit != parameter.unit:
                    raise ValueError(
                        f"the parameter {key!r} of the friction law {other!r} has the unit "
                        f"{known[key].unit or '1'!r}, {name!r} wants {parameter.unit or '1'!r}: name it "
                        "apart"
                    )
        return super().register(name, model)


#: Laws by the name that scenes use; every law adds itself.
LAWS = Laws("friction law")
