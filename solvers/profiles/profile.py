"""What the profile of a punch is."""

from typing import ClassVar, Protocol

from numpy.typing import NDArray

from galinx.registry import Registry


class Profile(Protocol):
    """A rigid punch: a dataclass whose fields are :func:`galinx.solvers.parameters.parameter`.

    Attributes:
        about: what kind of punch it is.
        half_width: half the width a of the contact [m]; lengths are divided by it.
    """

    about: ClassVar[str]

    @property
    def half_width(self) -> float: ...

    def height(self, X: NDArray) -> NDArray:
        """Gap [m] at X [m] from the middle when the lowest point touches, 0 where it is lowest."""

    def slope(self, X: NDArray) -> NDArray:
        """Its derivative, dimensionless."""

    def words(self) -> str:
        """The punch in a sentence's middle, with units."""


#: Profiles by the name that scenes use; every profile adds itself.
PROFILES: Registry[type[Profile]] = Registry("profile of the punch")
