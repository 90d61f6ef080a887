"""Friction laws, by the name that scenes use, and how they advance along strokes."""

from galinx.solvers.friction import dahl  # noqa: F401 - each adds its law
from galinx.solvers.friction.law import LAWS, FrictionLaw

__all__ = ["LAWS", "FrictionLaw"]
