"""Friction laws, by the name that scenes use, and how they advance along strokes."""

from . import (  # noqa: F401 - each adds its law
    bouc_wen,
    dahl,
    elasto_plastic,
    gms,
    lugre,
    maxwell_slip,
    rate_and_state,
    stribeck,
    table,
)
from .law import LAWS, FrictionLaw, check_law

__all__ = ["LAWS", "FrictionLaw", "check_law"]
