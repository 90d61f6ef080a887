"""Solids by name, with the source of their constants: the table of ``materials.toml``.

Scenes to begin with: those of the folder scenes, by name.
"""

import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any


@dataclass(frozen=True)
class Material:
    """A known solid.

    Attributes:
        about: what it is.
        kind: of solid.
        values: its constants by key, as a scene writes them.
        source: where they are printed.
        yield_strength, yield_source: uniaxial, as a scene writes it, and where that is printed; "" of
            what breaks rather than yields.
    """

    about: str
    kind: str
    values: dict[str, Any]
    source: str
    yield_strength: str = ""
    yield_source: str = ""

    @property
    def constants(self) -> dict[str, Any]:
        """What a scene's section [solid] takes over."""
        strength = {"yield_strength": self.yield_strength} if self.yield_strength else {}
        return {"kind": self.kind} | self.values | strength

    @property
    def told(self) -> str:
        """Its constants in a line."""
        unit = {key: " (dimensionless)" for key, value in self.values.items() if isinstance(value, float)}
        return ", ".join(f"{key} = {value}{unit.get(key, '')}" for key, value in self.values.items())


def _material(entry: dict[str, Any]) -> Material:
    """From its table, in which what is no attribute is a constant."""
    names = ("about", "source", "yield_strength", "yield_source")
    known = {name: entry.pop(name) for name in names if name in entry}
    return Material(kind=entry.pop("kind", "isotropic"), values=entry, **known)


#: Solids by the name that scenes use.
LIBRARY = {
    name: _material(entry)
    for name, entry in tomllib.loads(
        Path(__file__).with_name("materials.toml").read_text(encoding="utf-8")
    ).items()
}


#: Scenes that are part of the program.
SCENES = Path(__file__).parents[2] / "scenes"

#: What editors look for; a scene that is copied elsewhere leaves the schema behind.
_SCHEMA = "#:schema scene.schema.json\n"


@dataclass(frozen=True)
class Template:
    """A scene to begin with: its name, what it is about, and its text."""

    name: str
    about: str
    text: str


def templates() -> dict[str, Template]:
    """All of them by name."""
    found = {}
    for path in sorted(SCENES.glob("*.toml")):
        text = path.read_text(encoding="utf-8").removeprefix(_SCHEMA)
        about = text.splitlines()[0].removeprefix("# ")
        found[path.stem] = Template(path.stem, about, text)
    return found
