"""Profiles of punches, by the name that scenes use."""

from galinx.registry import Registry
from galinx.solvers.profiles.flat import Flat
from galinx.solvers.profiles.profile import Profile

PROFILES: Registry[type[Profile]] = Registry("profile of the punch", {"flat": Flat})
