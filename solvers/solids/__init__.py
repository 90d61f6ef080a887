"""Elastic solids, by the name that scenes use, and their response at speed."""

from galinx.registry import Registry
from galinx.solvers.solids.isotropic import Isotropic
from galinx.solvers.solids.solid import Solid

SOLIDS: Registry[type[Solid]] = Registry("kind of solid", {"isotropic": Isotropic})
