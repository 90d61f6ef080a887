"""Scenes to begin with: those of the folder scenes, by name."""

from dataclasses import dataclass
from pathlib import Path

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
