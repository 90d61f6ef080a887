"""JSON schema of scenes, for editors that complete and check TOML; made from the keys that check."""

from typing import Any

from galinx.app.scene.keys import REQUIRED, Key
from galinx.app.scene.layers import MOST
from galinx.app.scene.sections import SECTIONS


def schema() -> dict[str, Any]:
    """JSON schema (draft 7) of a scene."""
    properties: dict[str, Any] = {"title": {"type": "string", "description": "free text"}}
    properties |= {name: _section(name, section.alternatives) for name, section in SECTIONS.items()}
    properties["layer"] = {"type": "array", "items": _layer(properties["layer"]), "maxItems": MOST}
    return {
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "galinx scene",
        "type": "object",
        "properties": properties,
        "required": ["solid", "friction", "motion"],
        "additionalProperties": False,
    }


def _section(name: str, alternatives: dict[str, dict[str, Key]]) -> dict[str, Any]:
    """A section with the keys of all its alternatives; required are those that all of them require."""
    keys = {key: known for one in alternatives.values() for key, known in one.items()}
    needed = [
        key
        for key in keys
        if all(key in one and one[key].default is REQUIRED for one in alternatives.values())
    ]
    section = {
        "type": "object",
        "properties": {key: entry(known) for key, known in keys.items()},
        "additionalProperties": False,
    }
    if name == "solid":  # a known material gives the constants
        section["anyOf"] = [{"required": ["material"]}, {"required": needed}]
    elif needed:
        section["required"] = needed
    return section


def _layer(one: dict[str, Any]) -> dict[str, Any]:
    """A layer: constants of its own, a known material, or rows by depth."""
    needed = one.pop("required", [])
    enough = [["thickness", "material"], ["thickness", *needed], ["properties"]]
    return one | {"anyOf": [{"required": keys} for keys in enough]}


def entry(key: Key) -> dict[str, Any]:
    """JSON schema of a key's value."""
    unit = getattr(key.kind, "unit", None)
    about = key.about + ("" if unit is None else f" [{unit or 'dimensionless'}]")
    found = key.kind.schema() | {"description": about}
    if key.default is not REQUIRED and key.default not in (None, ((),)):  # a table left out is none
        found["default"] = list(key.default) if isinstance(key.default, tuple) else key.default
    return found
