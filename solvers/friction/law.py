"""Protocol and registry of friction laws, with the field of Coulomb's coefficient that most have."""

from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar, Protocol

import numpy as np
from numpy.typing import NDArray

from galinx.registry import Registry

from ..parameters import check, check_gives, parameter, parameters

#: Slip, over that on which the state decays by e, up to which :meth:`FrictionLaw.work_of_short` serves.
SHORT = 0.05


@dataclass(frozen=True)
class MeasuredFriction:
    """Summary of measured friction, for a guess of parameters.

    Attributes:
        level, least: large and small |f| in sliding.
        slope: |df/dX| where motion begins [1/m].
        length: slip between reversals [m].
        speed: mean speed [m/s].
        rows: number of rows of tables to be fitted.
        fitted: parameters by key of another law, of this class, that is fitted to the same data.
    """

    level: float
    least: float
    slope: float
    length: float
    speed: float
    rows: int
    fitted: Callable[[type["FrictionLaw"]], dict[str, Any]]


class FrictionLaw(Protocol):
    """A law of dynamic friction, per normal force: f = F/N.

    A law is a dataclass whose fields are made by :func:`galinx.solvers.parameters.parameter`; scenes set
    them by their keys. Its inner state z, (n,), dimensionless, changes with the slip. Those that inherit
    from this class need :meth:`friction`, and :meth:`rate` or :meth:`exact`; their parameters' ranges are
    checked.

    Attributes:
        about: name of the law, with its source.
        depends_on_speed: False where f is the same at every speed; it is then computed once.
        broadcasts: True if one law can stand for many. Their parameters are then (m, 1), their states
            (m, slips, n) with one slip where a stroke starts, and :meth:`exact` and :meth:`work` add
            slips by NumPy's rules of broadcasting.
        has_memory: False where f depends on direction and speed alone, whatever the motion before.
        batched: True if :meth:`rest`, :meth:`pause`, :meth:`exact` and :meth:`friction` alone do that,
            with tables (m, 1, rows, columns): enough for a fit, which tries many laws at once.
        conventions: keys of parameters, or names of numbers in tables as ``"elements[0, 1]"``, that are
            chosen, not fitted.
    """

    about: ClassVar[str]
    depends_on_speed: ClassVar[bool] = True
    broadcasts: ClassVar[bool] = False
    has_memory: ClassVar[bool] = True
    batched: ClassVar[bool] = False
    conventions: ClassVar[tuple[str, ...]] = ()

    @classmethod
    def guess(cls, measured: MeasuredFriction) -> dict[str, Any]:
        """Parameters by key with which a fit may begin; others begin with their defaults."""
        return {}

    def __post_init__(self) -> None:
        check(self)

    def rest(self) -> NDArray[np.float64]:
        """State before the first stroke, (n,)."""
        return np.zeros(1)

    def rate(self, z: NDArray, s: int, V: float) -> NDArray[np.float64]:
        """dz/d(slip) [1/m] in direction s = ±1 at the speed V >= 0 [m/s], (n,)."""
        raise NotImplementedError

    @abstractmethod
    def friction(self, z: NDArray, s: int, V: float) -> NDArray[np.float64]:
        """Friction coefficient f at states z (..., n), positive in forward motion: (...)."""
        raise NotImplementedError

    def exact(self, z: NDArray, s: int, V: float, slip: NDArray) -> NDArray[np.float64] | None:
        """States after slips [m] from z, (len(slip), n); None where only the rate is known."""
        return None

    def work(self, z: NDArray, s: int, V: float, slip: NDArray) -> NDArray[np.float64] | None:
        """Work ∫ s f d(slip) [m] over slips from z, (len(slip),); None where there is no formula."""
        return None

    def work_of_short(self, z: NDArray, s: int, V: float, slip: NDArray) -> NDArray[np.float64]:
        """Work [m] over slips on which :meth:`exact` hardly bends, by six places of Gauss's rule.

        Formulas that subtract from the work of full slip leave no digits there.
        """
        slip, (places, weights) = np.asarray(slip, dtype=float), np.polynomial.legendre.leggauss(6)
        between = slip[..., None] * (0.5 + 0.5 * places)
        states = self.exact(z, s, V, between.reshape(*slip.shape[:-1], -1))
        f = self.friction(states, s, V)  # type: ignore[arg-type]
        return 0.5 * s * slip * (f.reshape(*f.shape[:-1], -1, len(weights)) @ weights)

    def slope(self, z: NDArray, s: int, V: float) -> NDArray[np.float64] | None:
        """Tangent stiffness over N, s df/dd [1/m], at states z (..., n); None: by differences."""
        return None

    def stiffness(self, z: NDArray, s: int, V: float) -> float | None:
        """Largest |∂(dz/d(slip))/∂z| [1/m] of a stroke that starts at z; None where it is not known.

        Runge-Kutta's steps are stable where their length times it is small.
        """
        return None

    def switches(self, z: NDArray, s: int, V: float) -> NDArray[np.float64]:
        """Numbers that grow through zero where the rate is not smooth, each once a stroke, (any,)."""
        return np.zeros(0)

    def kinks(self, z: NDArray, s: int, V: float) -> NDArray[np.float64]:
        """Slips [m] from z at which f has a kink in its exact solution, or soon turns, (any,)."""
        return np.zeros(0)

    def flow(self, z: NDArray, s: int, V: float) -> NDArray[np.float64]:
        """dz/dt [1/s] in direction s = ±1 at the speed V >= 0 [m/s], (n,)."""
        return V * self.rate(z, s, V)

    def settle(self, z: NDArray, s: int, V: float) -> NDArray[np.float64]:
        """State with which a motion in direction s begins, or goes on where the rate has switched."""
        return z

    def pause(self, z: NDArray, seconds: float) -> NDArray[np.float64]:
        """State after a time at rest [s]; only laws that age change."""
        return z


def check_law(law: FrictionLaw) -> None:
    """Check that a law's functions give numbers in arrays of their shapes.

    Raises:
        ValueError: one gives something else, as None where ``return`` is missing.
    """
    z, slip = np.asarray(law.rest()), np.array([0.0, 1e-12])
    check_gives(law, "rest", z.shape if z.size and z.shape else (1,))
    check_gives(law, "friction", (), z, 1, 1.0)
    check_gives(law, "friction", (2,), np.stack([z, z]), 1, 1.0)
    with np.errstate(all="ignore"):
        exact = law.exact(z, 1, 1.0, slip)
    if exact is not None:
        check_gives(law, "exact", (2, *z.shape), z, 1, 1.0, slip)
    else:
        check_gives(law, "rate", z.shape, z, 1, 1.0)


class Laws(Registry[type[FrictionLaw]]):
    """Registry of friction laws; parameters of one name are one column of archives, whatever the law."""

    def check(self, name: str, model: type[FrictionLaw]) -> None:
        """Check that a law can be registered.

        Raises:
            TypeError: the name is no text, or the law no class with the members of :class:`FrictionLaw`,
                of which it has to have ``rate`` or ``exact``.
            ValueError: another law has one of its parameters in another unit.
        """
        super().check(name, model)
        if model.rate is FrictionLaw.rate and model.exact is FrictionLaw.exact:
            raise TypeError(f"the friction law {name!r}: {model.__name__} has neither rate nor exact")
        for other, law in self.items():
            described = parameters(law)
            for key, own in parameters(model).items():
                if other != name and key in described and described[key].unit != own.unit:
                    raise ValueError(
                        f"the parameter {key!r} of the friction law {other!r} has the unit "
                        f"{described[key].unit or '1'!r}, {name!r} has it in {own.unit or '1'!r}: "
                        "give it another key"
                    )


#: Laws by the name that scenes use; every law adds itself.
LAWS = Laws("friction law", kind=FrictionLaw)


def coulomb_coefficient(lowest: str = "above") -> Any:
    """Field of Coulomb's coefficient μ_C, dimensionless, ``"above"`` 0 or ``"at_least"`` 0."""
    return parameter(
        "mu_c", "Coulomb's coefficient μ_C", symbol=r"\mu_C", usual=(1e-4, 10.0),
        **{lowest: 0.0},  # type: ignore[arg-type]
    )  # fmt: skip
