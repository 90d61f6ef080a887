"""Scenes are read: TOML with units, checked before any work starts."""

import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from galinx import files
from galinx.app.console.program import program
from galinx.app.errors import BadInput
from galinx.app.scene.excerpt import excerpt, nearest, short
from galinx.app.scene.files_of_rows import filled
from galinx.app.scene.materials import LIBRARY
from galinx.app.scene.repeated import repeated
from galinx.app.scene.scene import Scene
from galinx.app.scene.sections import SECTIONS
from galinx.app.scene.sense import contradictions
from galinx.app.scene.texts import control_characters

#: Bytes of a scene; a million speeds fit, and what has no end is not read for ever.
_LARGEST = 50 * 10**6

#: How archives begin, and HDF5 files that were written without a seal.
_ARCHIVES = (b"galinx archive\n", b"\x89HDF\r\n\x1a\n")

#: Faults that a message lists at most.
_FAULTS = 30


def read(path: Path, changes: Mapping[str, Any] | None = None) -> Scene:
    """Read and check a scene file.

    Args:
        path: the file. Files of rows that it names are looked for beside it.
        changes: new values by ``"section.key"``; they stand in the scene's text.

    Raises:
        BadInput: the file cannot be read, or the scene has faults; all are listed.
    """
    try:
        data = files.read(path, _LARGEST + 1)
    except OSError as error:
        raise BadInput(f"cannot read {path}: {error.strerror}") from None
    if len(data) > _LARGEST:
        raise BadInput(f"{path} is larger than {_LARGEST // 10**6} MB, expected a scene (TOML file)")
    if data.startswith(_ARCHIVES):
        raise BadInput(
            f"{path} is an archive of results, expected a scene (TOML file); "
            f"{program()} show {path} shows what it holds"
        )
    try:
        text = data.decode("utf-8-sig").replace("\r\n", "\n")
    except UnicodeDecodeError as error:
        raise BadInput(f"{path} is not UTF-8 (byte {error.start}); save it as UTF-8") from None
    if not text.strip():
        raise BadInput(f"{path} is empty, expected a scene; scenes/ holds examples")
    if changes:
        from galinx.app.scene.changes import changed  # an import that only changes pay for

        text = changed(text, changes, str(path))
    text = filled(text, SECTIONS, path.parent, str(path))
    return parse(text, str(path))


def parse(text: str, name: str = "scene") -> Scene:
    """Check a scene's text; ``name`` stands in messages.

    Raises:
        BadInput: with all faults of the scene in one message.
    """
    try:
        tree = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        twice = repeated(text, str(error))
        raise BadInput(f"{name} is not TOML: {twice or error}") from None
    except RecursionError:
        raise BadInput(f"{name} cannot be read: its brackets are nested too deeply") from None
    except ValueError:  # Python's limit of digits
        raise BadInput(f"{name} cannot be read: a whole number has thousands of digits") from None
    faults = list(control_characters(tree))
    _fill_in_material(tree)
    faults += _fill_in_stiffness(tree)
    title = tree.pop("title", "")
    if not isinstance(title, str):
        faults.append(f"title: found {excerpt(title)}, expected a text")
    faults += [
        f"[{short(key)}]: no such section{nearest(key, [*SECTIONS, 'title'])}"
        for key in tree
        if key not in SECTIONS
    ]
    read = {key: section.read(key, tree.get(key, {}), faults) for key, section in SECTIONS.items()}
    if not faults:
        scene = Scene(title, text, half_plane=read.pop("solid"), layers=read.pop("layer"), **read)
        faults = contradictions(scene)
        if not faults:
            return scene
    lines = [f"  {fault}" for fault in faults[:_FAULTS]]
    if len(faults) > _FAULTS:
        lines.append(f"  and {len(faults) - _FAULTS} more")
    told = "\n".join(lines)
    raise BadInput(f"{name} has {len(faults)} fault{'s' * (len(faults) > 1)}:\n{told}")


def _fill_in_material(tree: dict[str, Any]) -> None:
    """Values of a known solid; those that the scene gives itself stay."""
    solid = tree.get("solid")
    if isinstance(solid, dict):
        name = solid.get("material")
        if isinstance(name, str):
            # Those of a name that there is not are not missing: that is one fault, and found.
            known = LIBRARY.get(name) or next(iter(LIBRARY.values()))
            tree["solid"] = known.constants | solid


def _fill_in_stiffness(tree: dict[str, Any]) -> list[str]:
    """σ₀ l/N of a stiffness that is given apart from the load; faults of both together."""
    friction, punch = tree.get("friction"), tree.get("punch", {})
    if not isinstance(friction, dict) or not isinstance(punch, dict) or "sigma0" not in friction:
        return []
    known, load = (SECTIONS[name].keys(tree.get(name, {})) for name in ("friction", "punch"))
    if "sigma0" not in known:
        return []  # the section says that there is no such key
    if "sigma0_over_load" in friction:
        return ["friction: sigma0 and sigma0_over_load exclude each other; keep one"]
    # What cannot be read is a fault of its own section, where the other is not missing then.
    tree["friction"] = friction | {"sigma0_over_load": 1.0}
    try:
        stiffness = known["sigma0"].kind(friction["sigma0"])
        loads = load["load"].kind(punch["load"]) if "load" in punch else load["load"].default
    except ValueError:
        return []
    if len(loads) > 1:
        return [
            f"friction.sigma0: found {len(loads)} loads, expected one punch.load to divide it by; "
            "sigma0_over_load is the same under all"
        ]
    tree["friction"]["sigma0_over_load"] = [value / loads[0] for value in stiffness]
    return []
