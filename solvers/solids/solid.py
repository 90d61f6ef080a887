"""Elastic solids, and the fields of scenes that several kinds of them share."""

from abc import abstractmethod
from collections.abc import Sequence
from math import sqrt
from typing import Any, ClassVar, Protocol

import numpy as np
from numpy.typing import NDArray

from galinx.registry import Registry

from ..parameters import check, choice, parameter
from .half_plane import HalfPlane


class Solid(Protocol):
    """An elastic solid: a dataclass whose fields are :func:`galinx.solvers.parameters.parameter`.

    The ranges of these are checked.

    Attributes:
        about: kind of solid.
        form: name of the weak form that finite elements solve, see :mod:`galinx.solvers.fem.forms`; its
            constants are attributes of the half-plane.
        nearly_incompressible: displacements alone would lose digits; the form has an unknown pressure.
        knows_σ_ZZ: True if the constants are enough for :meth:`σ_ZZ`, which is NaN otherwise.
        plane: ``"strain"`` or ``"stress"``.
        μ: modulus that stresses are divided by [Pa].
        ρ: density [kg/m³].
        c_s: wave speed that c refers to [m/s].
        layers: from the top down; none in a uniform solid.
        above: solid of an elastic punch above it; None under a rigid one.
        punch_strength: uniaxial yield strength of that solid [Pa]; None where it is not given.
    """

    about: ClassVar[str]
    plane: str
    ρ: float

    layers: Sequence[Any] = ()
    above: "Solid | None" = None
    punch_strength: float | None = None

    def __post_init__(self) -> None:
        check(self)

    @property
    def surface(self) -> "Solid":
        """The solid at the surface."""
        return self

    @property
    def depths(self) -> NDArray[np.float64]:
        """Depths of the interfaces between solids [m], (layers,); none in a uniform solid."""
        return np.empty(0)

    @property
    @abstractmethod
    def form(self) -> str: ...
    @property
    @abstractmethod
    def μ(self) -> float: ...
    @property
    def nearly_incompressible(self) -> bool:
        return False

    @property
    def knows_σ_ZZ(self) -> bool:
        return True

    @property
    def c_s(self) -> float:
        return sqrt(self.μ / self.ρ)

    @abstractmethod
    def flutter(self, c: float = 0.0) -> tuple[float, float]:
        """Flutter thresholds: least σ_XY/σ_YY > 0, and least -σ_XY/σ_YY > 0, from which on short waves
        along the sliding interface grow; infinite for none.

        See :mod:`galinx.solvers.solids.flutter`.

        Args:
            c: speed of the punch over ``c_s``, below 0 (or -0.0) where it moves to negative X; it matters
                to two elastic bodies alone.
        """

    @property
    def solids(self) -> Sequence["Solid"]:
        """All solids from the top down, graded ones at both faces."""
        return (self,)

    @property
    def slowest(self) -> float:
        """Least of the solids' wave speeds [m/s]."""
        return min(solid.c_s for solid in self.solids)

    @abstractmethod
    def limit(self) -> float:
        """Highest speed over ``c_s``: that of a wave along the surface."""

    @abstractmethod
    def response(self, c: float, a: float = 1.0) -> HalfPlane:
        """The half-plane at a speed over ``c_s``.

        Args:
            c: speed over ``c_s``, dimensionless.
            a: unit of length [m], which a uniform solid does not use.

        Raises:
            ValueError: waves in the solid are not faster.
        """

    @abstractmethod
    def σ_ZZ(self, σ_XX: NDArray, σ_YY: NDArray, σ_XY: NDArray) -> NDArray[np.float64]:
        """Normal stress out of the plane, of one shape and unit with the others, at the surface."""

    @abstractmethod
    def words(self) -> str:
        """The solid in a sentence's middle, with units."""


class Composite(Solid):
    """Several solids, whose modulus, density, wave speed and σ_ZZ are those of the one at the surface."""

    @property
    @abstractmethod
    def surface(self) -> Solid:
        """The solid at the surface."""

    @property
    def plane(self) -> str:  # type: ignore[override]
        return self.surface.plane

    @property
    def μ(self) -> float:
        return self.surface.μ

    @property
    def ρ(self) -> float:  # type: ignore[override]
        return self.surface.ρ

    def σ_ZZ(self, σ_XX: NDArray, σ_YY: NDArray, σ_XY: NDArray) -> NDArray[np.float64]:
        return self.surface.σ_ZZ(σ_XX, σ_YY, σ_XY)


#: Solids by the name that scenes use.
SOLIDS: Registry[type[Solid]] = Registry("kind of solid", kind=Solid)


#: Where stiffnesses usually lie [Pa].
USUAL_STIFFNESS = (1e3, 2e12)


def modulus(key: str, about: str, symbol: str = "") -> Any:
    """Field of a positive stiffness [Pa]."""
    return parameter(key, about, "Pa", symbol=symbol, above=0.0, usual=USUAL_STIFFNESS)


def density() -> Any:
    """Field of the density ρ [kg/m³]."""
    return parameter("rho", "density", "kg/m^3", symbol=r"\rho", above=0.0, usual=(10.0, 3e4))


def angle(axis: str) -> Any:
    """Field of the angle from X to an axis of the solid [°]."""
    note = "counterclockwise, Y upwards"
    return parameter("angle", f"angle from X to {axis}", "deg", symbol=r"\theta", default=0.0, note=note)


def in_plane() -> Any:
    """Field of the choice between plane strain and plane stress."""
    note = '`"stress"` is a thin sheet'
    return choice("plane", "plane strain or stress", ("strain", "stress"), note=note)
