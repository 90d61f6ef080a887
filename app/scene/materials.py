"""Solids by name, with the source of their constants: the table of ``materials.toml``."""

import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any


@dataclass(frozen=True)
class Material:
    """A known isotropic solid.

    Attributes:
        about: what it is.
        E, nu, rho: Young's modulus, Poisson's ratio and density as a scene writes them.
        source: where they are printed.
        yield_strength, yield_source: uniaxial, as a scene writes it, and where that is printed; "" of
            what breaks rather than yields.
    """

    about: str
    E: str
    nu: float
    rho: str
    source: str
    yield_strength: str = ""
    yield_source: str = ""

    @property
    def constants(self) -> dict[str, Any]:
        """What a scene's section [solid] takes over."""
        strength = {"yield_strength": self.yield_strength} if self.yield_strength else {}
        return {"E": self.E, "nu": self.nu, "rho": self.rho} | strength


#: Solids by the name that scenes use.
LIBRARY = {
    name: Material(**entry)
    for name, entry in tomllib.loads(
        Path(__file__).with_name("materials.toml").read_text(encoding="utf-8")
    ).items()
}
