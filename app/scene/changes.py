"""Changes of a scene's text, made where the value stands; comments and layout stay."""

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

import tomlkit
from tomlkit.exceptions import TOMLKitError
from tomlkit.items import Item

from galinx.solvers.friction import LAWS
from galinx.solvers.parameters import parameters
from galinx.solvers.profiles import PROFILES
from galinx.solvers.solids import SOLIDS

from ..errors import BadInput, excerpt, nearest, short

#: Keys that a material sets, or that a solid of another kind may not have.
_CONSTANTS = ["solid.kind", "solid.yield_strength"] + [
    f"solid.{key}" for kind in SOLIDS.values() for key in parameters(kind) if key != "plane"
]

#: Longest text that a change may set, in characters: the time of tomlkit grows with their square.
_LONGEST = 10_000


#: The value of a key that is to be removed, and has to exist.
UNSET = object()


def from_words(words: Iterable[str], unset: Iterable[str] = ()) -> dict[str, Any]:
    """Changes as the command line gives them: ``section.key=value``, the value as in TOML.

    A value that is not TOML is taken as a text: ``solid.E=70 GPa`` needs no quotes.

    Args:
        words: arguments of ``--set``.
        unset: arguments of ``--unset``, keys to be removed.

    Returns:
        New values by ``"section.key"``; ``UNSET`` for keys to be removed.

    Raises:
        BadInput: a word without key or value, or not UTF-8; a key that is both set and removed.
    """
    changes: dict[str, Any] = {}
    for word in words:
        try:
            word.encode()
        except UnicodeEncodeError:
            raise BadInput(f"--set {short(word)}: expected a text in UTF-8") from None
        key, equals, value = word.partition("=")
        if not equals or not key.strip():
            raise BadInput(
                f"--set {short(word)}: expected section.key=value, as in --set friction.mu_c=0.5"
            )
        try:
            changes[key.strip()] = tomlkit.value(value.strip())
        except (TOMLKitError, ValueError, RecursionError):
            changes[key.strip()] = value.strip()
    for key in unset:
        if key in changes:
            raise BadInput(f"--set and --unset {short(key)} exclude each other; keep one")
    return changes | dict.fromkeys(unset, UNSET)


def changed(text: str, changes: Mapping[str, Any], name: str = "scene") -> str:
    """A scene's text with other values.

    Args:
        text: TOML.
        changes: new values by ``"section.key"``, or ``"title"``; None removes a key if it exists,
            ``UNSET`` one that has to exist, and ``"solid.material"`` the constants not among the changes.
        name: of the scene, for messages.

    Raises:
        BadInput: the text is not TOML, a key is not of that form, or one to be removed does not exist.
    """
    try:
        tree = tomlkit.parse(text)
        keys = [*_keys(tree)]
        if stale := [path for path in _stale(tree, changes) if path in keys]:
            changes = dict.fromkeys(stale) | dict(changes)
        for path, value in changes.items():
            if value is UNSET and path not in keys:
                raise ValueError(f"found no key {excerpt(path)} to take away{nearest(path, keys)}")
            if value is not None or path in keys:
                _change(tree, path, None if value is UNSET else value)
        return tomlkit.dumps(tree)
    except (TOMLKitError, ValueError, TypeError) as error:
        raise BadInput(f"{name} cannot be changed: {error}") from None
    except RecursionError:
        raise BadInput(f"{name} cannot be changed: brackets are nested too deeply") from None


def _stale(tree: Any, changes: Mapping[str, Any]) -> list[str]:
    """Keys of parameters of the old solid, law or profile that a new one does not have."""
    return [
        *_of_old_solid(tree, changes),
        *_of_old_model("friction.model", LAWS, tree, changes),
        *_of_old_model("punch.profile", PROFILES, tree, changes),
    ]


def _of_old_model(
    choice: str, models: Mapping[str, Any], tree: Any, changes: Mapping[str, Any]
) -> list[str]:
    """Keys of a section that only models other than the newly chosen one have.

    Args:
        choice: key that names the model, as ``"friction.model"``.
        models: classes by name.
        tree: the scene.
        changes: new values by key.
    """
    section = choice.partition(".")[0]
    model, keys = changes.get(choice), tree.get(section)
    if not isinstance(model, str) or model not in models or not isinstance(keys, dict):
        return []
    own = parameters(models[model])
    every = {key for kind in models.values() for key in parameters(kind)}
    stale = [
        f"{section}.{key}" for key in keys if _parameter(key) in every and _parameter(key) not in own
    ]
    tables = keys.get("vary", ())
    varied = {key for table in tables for key in table} if isinstance(tables, list) else set()
    return stale + [f"{section}.vary"] * bool(varied & every - own.keys())


def _parameter(key: str) -> str:
    """Name of the parameter that a key sets."""
    return "sigma0_over_load" if key == "sigma0" else key


def _of_old_solid(tree: Any, changes: Mapping[str, Any]) -> list[str]:
    """Keys of section [solid] that the newly chosen material or kind replaces or does not have."""
    if "solid.material" in changes:
        return _CONSTANTS
    solid = tree.get("solid")
    old = solid.get("kind", "isotropic") if isinstance(solid, dict) else None
    kind = changes.get("solid.kind", old)
    if not isinstance(kind, str) or kind == old or kind not in SOLIDS:
        return []
    own = parameters(SOLIDS[kind])
    return [path for path in ("solid.material", *_CONSTANTS) if path.removeprefix("solid.") not in own]


def _keys(tree: Mapping[str, Any]) -> Iterator[str]:
    """Keys of a scene, as ``"section.key"`` or ``"title"``."""
    for name, value in tree.items():
        yield from (f"{name}.{key}" for key in value) if isinstance(value, dict) else [name]


def _change(tree: Any, path: str, value: Any) -> None:
    """Set a key of a scene in place, or remove it where the value is None."""
    *sections, key = path.split(".")
    if len(sections) > 1 or (not sections and key != "title"):
        raise ValueError(f"found {excerpt(path)}, expected section.key, as in friction.mu_c")
    if isinstance(value, str) and len(value) > _LONGEST:
        raise ValueError(f"found a text of {len(value)} characters, expected at most {_LONGEST}")
    for section in sections:
        tree = tree.setdefault(section, tomlkit.table())
        if not isinstance(tree, dict):
            raise ValueError(f"found {excerpt(section)} without keys, expected a section")
    if value is None:
        del tree[key]
    else:
        tree[key] = _item(value)


def _item(value: Any) -> Any:
    """A value as tomlkit holds it; lists are parsed, as the time to build one grows with its square."""
    if isinstance(value, dict) and not isinstance(value, Item):  # a range; stays in its line
        (table := tomlkit.inline_table()).update(value)
        return table
    if isinstance(value, Item) or not isinstance(value, (list, tuple)):
        return value
    items = [tomlkit.item(_item(entry)) for entry in value]
    if any(isinstance(entry, dict) for entry in items):
        return list(value)
    return tomlkit.value(f"[{', '.join(entry.as_string() for entry in items)}]")


def with_law(text: str, section: str, name: str = "scene") -> str:
    """A scene's text with the friction law of another section ``[friction]``, and that one's comments.

    Raises:
        BadInput: the text is not TOML.
    """
    try:
        own = tomlkit.parse(text).get("friction", {})
    except TOMLKitError as error:
        raise BadInput(f"{name} cannot be changed: {error}") from None
    every = {"model", "vary", *(key for law in LAWS.values() for key in parameters(law))}
    stale = [key for key in own if _parameter(key) in every] if isinstance(own, dict) else []
    law = {f"friction.{key}": item for key, item in tomlkit.parse(section)["friction"].items()}
    return changed(text, {f"friction.{key}": None for key in stale} | law, name)
