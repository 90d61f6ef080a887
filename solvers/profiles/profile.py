"""Protocol and registry of punch profiles, and the functions that read their optional attributes."""

from collections.abc import Sequence
from typing import Any, ClassVar, Protocol

import numpy as np
from numpy.typing import NDArray

from galinx.registry import Registry

from ..approximation import gauss_in_panels
from ..errors import NoContact
from ..parameters import check, check_gives


class Profile(Protocol):
    """A rigid punch: a dataclass whose fields are :func:`galinx.solvers.parameters.parameter`.

    The ranges of these are checked. A profile with a free end of the contact says so by ``sharp``; it has
    no half-width then and is convex. All attributes but ``about`` are optional, and read by the functions
    of this module.

    Attributes:
        about: kind of punch.
        half_width: half the width a of the contact [m] between two sharp corners; lengths are divided
            by it.
        sharp: True for the left and for the right end of the contact if it is a sharp corner of the
            punch whatever the load; (True, True) by default.
        kinks: positions [m] at which the slope or its derivative jumps, in their order; none by default.
        jumps: True if the slope itself jumps there, so that the pressure is infinite; False by default.
        exponent: k of a height c|X|^k, by which results at other loads follow; None by default, for
            other heights.
    """

    about: ClassVar[str]

    def __post_init__(self) -> None:
        check(self)

    def height(self, X: NDArray) -> NDArray:
        """Gap [m] at X [m] from the middle when the lowest point touches, 0 where it is lowest."""

    def slope(self, X: NDArray) -> NDArray:
        """Derivative of the height at X [m], dimensionless."""

    def words(self) -> str:
        """The punch in a sentence's middle, with units."""


#: Share of all changes of height by which the integral of the slope may differ from one, and change of
#: height over the half-width that is rounding.
_UNLIKE, _LEVEL = 0.02, 1e-11


def check_profile(profile: Any) -> None:
    """Check that height and slope of a profile are numbers at positions, and that it has ends.

    Raises:
        ValueError: one is something else, as None where ``return`` is missing, or ends are nowhere.
    """
    if not has_free_end(profile) and not hasattr(profile, "half_width"):
        raise ValueError(
            f"{type(profile).__name__} lacks half_width, of its contact between sharp corners; for free "
            "ends it needs sharp = (False, False)"
        )
    X = np.array([-1e-9, 1e-9])
    for name in ("height", "slope"):
        check_gives(profile, name, X.shape, X)


def check_slope(profile: Any, half_width: float) -> None:
    """Check that the slope of a profile is the derivative of its height.

    Args:
        profile: the punch.
        half_width: of a contact [m]; the middle of that is looked at.

    Raises:
        ValueError: it is another function's.
    """
    edges = np.array([-1.0, 0.0, 1.0, *kinks_between(profile, 0.0, half_width / 4.0)]) * half_width / 4.0
    edges = np.unique(edges)
    X, weights = gauss_in_panels(edges, 16)
    height, slope = (np.asarray(of, dtype=float) for of in (profile.height(edges), profile.slope(X)))
    rises = np.diff(height)
    sums, sizes = ((weights * of).reshape(len(rises), -1).sum(axis=1) for of in (slope, np.abs(slope)))
    n = int(np.argmax(np.abs(rises - sums)))
    rounding = _UNLIKE * max(sizes.sum(), np.abs(rises).sum()) + _LEVEL * half_width
    if abs(rises[n] - sums[n]) > rounding:
        raise ValueError(
            f"{type(profile).__name__}.slope is not the derivative of the height: from X = "
            f"{edges[n]:.3g} m to {edges[n + 1]:.3g} m it adds up to {sums[n]:.3g} m, and the height "
            f"changes by {rises[n]:.3g} m"
        )


def has_free_end(profile: Any) -> bool:
    """Return True if an end of the contact is free, not a sharp corner of the punch."""
    return not all(getattr(profile, "sharp", (True, True)))


def kinks(profile: Any) -> Sequence[float]:
    """Positions [m] at which the slope or its derivative jumps."""
    return getattr(profile, "kinks", ())


def kinks_between(profile: Any, centre: float, half_width: float) -> NDArray[np.float64]:
    """Positions of the kinks inside a contact, from its middle and over its half-width, (kinks,)."""
    at = (np.array(kinks(profile), dtype=float) - centre) / half_width
    return at[np.abs(at) < 1.0]


def jumps(profile: Any) -> bool:
    """Return True if the slope itself jumps at a kink."""
    return bool(np.any(getattr(profile, "jumps", False)))


def exponent(profile: Any) -> float | None:
    """Exponent k of a height c|X|^k; None for other heights."""
    return getattr(profile, "exponent", None)


def radius(profile: Any) -> float | None:
    """Radius of a parabola [m]; None for other heights."""
    return 1.0 / float(profile.slope(np.ones(1))[0]) if exponent(profile) == 2.0 else None


def cusp(profile: Any) -> float:
    """Exponent below 1 of the pressure's change by the distance from a kink; 0 for no cusp.

    It is k - 1 for a height |X|^k, 1 < k < 2.
    """
    k = exponent(profile) or 2.0
    return k - 1.0 if 1.0 < k < 2.0 and len(kinks(profile)) else 0.0


def leaving(profile: Any) -> float:
    """Exponent of the distance d from a kink with which the pressure leaves its value there.

    It is k - 1 for a height |X|^k. A whole number n stands for dⁿ log d: 1 where the slope's derivative
    jumps. 0 is for no kink, and for kinks at which the pressure is infinite.
    """
    if not len(kinks(profile)) or jumps(profile):
        return 0.0
    return (exponent(profile) or 2.0) - 1.0


def check_reach(profile: Any, left: float, right: float, found: str = "the contact would reach") -> None:
    """Check that the punch is known over a contact.

    Args:
        profile: the punch.
        left, right: ends of the contact [m].
        found: beginning of the message.

    Raises:
        NoContact: the contact is wider.
    """
    first, last = getattr(profile, "reach", (-np.inf, np.inf))
    if left < first or right > last:
        raise NoContact(
            f"{found} from X = {left:g} m to {right:g} m, but the punch is known from "
            f"{first:g} m to {last:g} m only; give more of its shape, or a smaller load"
        )


#: Profiles by the name that scenes use; every profile adds itself.
PROFILES: Registry[type[Profile]] = Registry("profile of the punch", kind=Profile)
