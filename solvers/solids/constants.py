"""Constants that several kinds of solid have, each as the field of a dataclass."""

from typing import Any

from galinx.solvers.parameters import choice, parameter

#: Where stiffnesses usually lie [Pa].
USUAL_STIFFNESS = (1e3, 2e12)


def modulus(key: str, about: str, symbol: str = "") -> Any:
    """A stiffness that is positive [Pa]."""
    return parameter(key, about, "Pa", symbol=symbol, above=0.0, usual=USUAL_STIFFNESS)


def density() -> Any:
    """ρ [kg/m³]."""
    return parameter("rho", "density", "kg/m^3", symbol=r"\rho", above=0.0, usual=(1.0, 3e4))


def angle(axis: str) -> Any:
    """From X to an axis of the solid [°]."""
    note = "counterclockwise, Y upwards"
    return parameter("angle", f"angle from X to {axis}", "deg", symbol=r"\theta", default=0.0, note=note)


def in_plane() -> Any:
    """Plane strain or plane stress."""
    note = '`"stress"` is a thin sheet'
    return choice("plane", "plane strain or stress", ("strain", "stress"), note=note)
