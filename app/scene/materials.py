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
    """

    about: str
    E: str
    nu: float
    rho: str
    source: str

    @property
    def constants(self) -> dict[str, Any]:
        """What a scene's section [solid] takes over."""
        return {"E": self.E, "nu": self.nu, "rho": self.rho}


#: Solids by the name that scenes use.
LIBRARY = {
    name: Material(**entry)
    for name, entry in tomllib.loads(
        Path(__file__).with_name("materials.toml").read_text(encoding="utf-8")
    ).items()
}
