"""Elastic solids, by the name that scenes use, and their response at speed."""

from . import (  # noqa: F401 - each adds its solid
    anisotropic,
    cubic,
    isotropic,
    orthotropic,
)
from .isotropic import Isotropic
from .solid import SOLIDS, Solid

__all__ = ["SOLIDS", "Isotropic", "Solid"]
