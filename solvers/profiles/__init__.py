"""Profiles of punches, by the name that scenes use."""

from . import punches  # noqa: F401 - adds its profiles
from .profile import (
    PROFILES,
    Profile,
    check_profile,
    check_reach,
    check_slope,
    cusp,
    exponent,
    has_free_end,
    jumps,
    kinks,
    kinks_between,
    leaving,
    radius,
)

__all__ = [
    "PROFILES",
    "Profile",
    "check_profile",
    "check_reach",
    "check_slope",
    "cusp",
    "exponent",
    "has_free_end",
    "jumps",
    "kinks",
    "kinks_between",
    "leaving",
    "radius",
]  # fmt: skip
