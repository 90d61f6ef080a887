"""Profiles of punches, by the name that scenes use."""

from galinx.solvers.profiles import flat  # noqa: F401 - each adds its profile
from galinx.solvers.profiles.profile import PROFILES, Profile

__all__ = ["PROFILES", "Profile"]
