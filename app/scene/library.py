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
        source: publication of the constants.
        constants: keys and values of a scene's section [solid]: kind, constants and, of solids that yield
            before they break, the uniaxial yield_strength.
        yield_source: publication of that; "" for other solids.
    """

    about: str
    source: str
    constants: dict[str, Any]
    yield_source: str = ""


def _material(entry: dict[str, Any]) -> Material:
    """A material from its table, in which every key that is no attribute is a constant."""
    names = ("about", "source", "yield_source")
    attributes = {name: entry.pop(name) for name in names if name in entry}
    return Material(constants={"kind": "isotropic"} | entry, **attributes)


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
