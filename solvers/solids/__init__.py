"""Elastic solids, by the name that scenes use, and their response at speed."""

from .isotropic import Isotropic
from .plane import Anisotropic, Cubic, Orthotropic
from .solid import SOLIDS, Solid

__all__ = ["SOLIDS", "Anisotropic", "Cubic", "Isotropic", "Orthotropic", "Solid"]

SOLIDS.register("anisotropic", Anisotropic)
SOLIDS.register("cubic", Cubic)
SOLIDS.register("isotropic", Isotropic)
SOLIDS.register("orthotropic", Orthotropic)
