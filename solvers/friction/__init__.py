"""Friction laws, by the name that scenes use, and how they advance along strokes."""

from galinx.registry import Registry
from galinx.solvers.friction.dahl import Dahl
from galinx.solvers.friction.law import FrictionLaw

LAWS: Registry[type[FrictionLaw]] = Registry("friction law", {"dahl": Dahl})
