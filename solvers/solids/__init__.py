"""Elastic solids, by the name that scenes use, and their response at speed."""

from galinx.solvers.solids import (  # noqa: F401 - each adds its solid
    anisotropic,
    cubic,
    isotropic,
    orthotropic,
)
from galinx.solvers.solids.isotropic import Isotropic
from galinx.solvers.solids.solid import SOLIDS, Solid

__all__ = ["SOLIDS", "Isotropic", "Solid"]
