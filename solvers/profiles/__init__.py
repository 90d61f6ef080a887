"""Profiles of punches, by the name that scenes use."""

from . import (  # noqa: F401 - each adds its profile
    flat,
    power,
    rounded_flat,
    table,
)
from .profile import (
    PROFILES,
    Profile,
    check_reach,
    cusp,
    exponent,
    half_width,
    has_free_end,
    jumps,
    kinks,
    leaving,
    smooth,
)

__all__ = [
    "PROFILES",
    "Profile",
    "check_reach",
    "cusp",
    "exponent",
    "half_width",
    "has_free_end",
    "jumps",
    "kinks",
    "leaving",
    "smooth",
]  # fmt: skip
