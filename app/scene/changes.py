"""Changes of a scene's text, made where the value stands; comments and layout stay."""

from collections.abc import Iterable, Mapping
from typing import Any

import tomlkit
from tomlkit.exceptions import TOMLKitError

from galinx.app.errors import BadInput

_CONSTANTS = ("solid.E", "solid.nu", "solid.rho")


def from_words(words: Iterable[str]) -> dict[str, Any]:
    """Changes as the command line gives them: ``section.key=value``, the value as in TOML.

    What is no TOML value is a text: ``solid.E=70 GPa`` needs no quotes.

    Raises:
        BadInput: a word without key or value.
    """
    changes = {}
    for word in words:
        key, equals, value = word.partition("=")
        if not equals or not key.strip():
            raise BadInput(f"--set {word}: expected section.key=value, as in --set friction.mu_c=0.5")
        try:
            changes[key.strip()] = tomlkit.value(value.strip())
        except (TOMLKitError, ValueError):
            changes[key.strip()] = value.strip()
    return changes


def changed(text: str, changes: Mapping[str, Any], name: str = "scene") -> str:
    """A scene's text with other values.

    Args:
        text: TOML.
        changes: new values by ``"section.key"``, or ``"title"``; None takes a key away, and
            ``"solid.material"`` takes away the constants that are not among the changes.
        name: stands in messages.

    Raises:
        BadInput: the text is not TOML, or a key is not of that form.
    """
    try:
        tree = tomlkit.parse(text)
        if "solid.material" in changes:  # another solid: constants of the old one would override it
            changes = dict.fromkeys(_CONSTANTS) | dict(changes)
        for path, value in changes.items():
            _change(tree, path, value)
        return tomlkit.dumps(tree)
    except (TOMLKitError, ValueError, TypeError) as error:
        raise BadInput(f"{name} cannot be changed: {error}") from None


def _change(tree: Any, path: str, value: Any) -> None:
    *sections, key = path.split(".")
    if len(sections) > 1 or (not sections and key != "title"):
        raise ValueError(f"found {path!r}, expected section.key, as in friction.mu_c")
    for section in sections:
        tree = tree.setdefault(section, tomlkit.table())
    if value is None:
        tree.pop(key, None)
    else:
        tree[key] = list(value) if isinstance(value, tuple) else value
