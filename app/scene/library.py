"""The library of scenes: materials and example scenes by name.

Materials are solids with their constants and the source of these, from the table ``materials.toml``.
Templates are the scenes of the folder ``scenes``, to begin with.
"""

import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any


@dataclass(frozen=True)
class Material:
    """A solid of the library.

    Attributes:
        about: description of the material.
        kind: name of the kind of solid.
        values: constants by key, as a scene writes them.
        source: publication of the constants.
        yield_strength, yield_source: uniaxial yield strength as a scene writes it, and its publication;
            "" for solids that break rather than yield.
    """

    about: str
    kind: str
    values: dict[str, Any]
    source: str
    yield_strength: str = ""
    yield_source: str = ""

    @property
    def constants(self) -> dict[str, Any]:
        """Keys and values that a scene's section [solid] takes from the material."""
        strength = {"yield_strength": self.yield_strength} if self.yield_strength else {}
        return {"kind": self.kind} | self.values | strength

    @property
    def words(self) -> str:
        """Constants of the material in one line, each with its unit, if it has one."""
        return ", ".join(f"{key} = {value}" for key, value in self.values.items())


def _material(entry: dict[str, Any]) -> Material:
    """A material from its table, in which every key that is no attribute is a constant."""
    names = ("about", "source", "yield_strength", "yield_source")
    attributes = {name: entry.pop(name) for name in names if name in entry}
    return Material(kind=entry.pop("kind", "isotropic"), values=entry, **attributes)


#: Solids by the name that scenes use.
LIBRARY = {
    name: _material(entry)
    for name, entry in tomllib.loads(
        Path(__file__).with_name("materials.toml").read_text(encoding="utf-8")
    ).items()
}


#: Scenes that are part of the program.
SCENES = Path(__file__).parents[2] / "scenes"

#: Line by which editors find the schema; a scene that is copied elsewhere leaves the schema behind.
_SCHEMA = "#:schema scene.schema.json\n"


def templates() -> dict[str, str]:
    """Texts of scenes to begin with, by name; the first line of each is a comment that describes it."""
    return {
        path.stem: path.read_text(encoding="utf-8").removeprefix(_SCHEMA)
        for path in sorted(SCENES.glob("*.toml"))
    }
