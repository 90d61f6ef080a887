"""What a friction law is."""

from typing import ClassVar, Protocol

import numpy as np
from numpy.typing import NDArray


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
