"""Scenes: what is to be computed, as TOML with units, checked before any work starts."""

import difflib
import hashlib
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import attrs

from galinx.app.errors import BadInput
from galinx.app.scene.materials import LIBRARY
from galinx.app.scene.sections import SECTIONS, Friction, Motion, Output, Punch, Solid, Solve


@attrs.frozen
class Scene:
    """A checked scene; numbers are in SI.

    Attributes:
        title: free text.
        text: the TOML it came from, byte for byte as archived.
        warnings: what looks unusual, one sentence each.
    """

    title: str
    text: str
    solid: Solid
    punch: Punch
    friction: Friction
    motion: Motion
    solve: Solve
    output: Output
    warnings: tuple[str, ...]

    @property
    def sha256(self) -> str:
        """Hash of the scene's text."""
        return hashlib.sha256(self.text.encode()).hexdigest()


def read(path: Path, changes: Mapping[str, Any] | None = None) -> Scene:
    """Read and check a scene file.

    Args:
        path: the file.
        changes: new values by ``"section.key"``; they stand in the scene's text.

    Raises:
        BadInput: the file cannot be read, or the scene has faults; all are listed.
    """
    try:
        data = path.read_bytes()
    except IsADirectoryError:
        raise BadInput(f"{path} is a folder, expected a scene (TOML file)") from None
    except OSError as error:
        raise BadInput(f"cannot read {path}: {error.strerror}") from None
    try:
        text = data.decode("utf-8-sig").replace("\r\n", "\n")
    except UnicodeDecodeError as error:
        raise BadInput(f"{path} is not UTF-8 (byte {error.start}); save it as UTF-8") from None
    if not text.strip():
        raise BadInput(f"{path} is empty, expected a scene; scenes/ holds examples")
    if changes:
        from galinx.app.scene.changes import changed  # an import that only changes pay for

        text = changed(text, changes, str(path))
    return parse(text, str(path))


def parse(text: str, name: str = "scene") -> Scene:
    """Check a scene's text; ``name`` stands in messages.

    Raises:
        BadInput: with all faults of the scene in one message.
    """
    try:
        tree = tomllib.loads(text)
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        raise BadInput(f"{name} is not TOML: {error}") from None
    faults: list[str] = []
    _fill_in_material(tree)
    title = tree.pop("title", "")
    if not isinstance(title, str):
        faults.append(f"title: found {title!r}, expected a text")
    for key in tree.keys() - SECTIONS.keys():
        faults.append(f"[{key}]: no such section{_nearest(key, [*SECTIONS, 'title'])}")
    sections = {
        section: _structure(section, kind, tree.get(section, {}), faults)
        for section, kind in SECTIONS.items()
    }
    if not faults:
        scene = Scene(title, text, **sections, warnings=())
        faults = _contradictions(scene)
        if not faults:
            return attrs.evolve(scene, warnings=tuple(_oddities(scene)))
    lines = "\n".join(f"  {fault}" for fault in faults)
    raise BadInput(f"{name} has {len(faults)} fault{'s' * (len(faults) > 1)}:\n{lines}")


def _fill_in_material(tree: dict[str, Any]) -> None:
    """Values of a known solid; those that the scene gives itself stay."""
    solid = tree.get("solid")
    name = solid.get("material") if isinstance(solid, dict) else None
    if isinstance(name, str) and name in LIBRARY:
        tree["solid"] = LIBRARY[name].constants | solid


def _nearest(key: str, valid: list[str]) -> str:
    close = difflib.get_close_matches(key, valid, 1, 0.5)
    return f"; did you mean {close[0]}?" if close else f"; valid: {', '.join(valid)}"


def _structure(section: str, kind: type, given: Any, faults: list[str]) -> Any:
    """The section as its class, or None after adding its faults."""
    if not isinstance(given, dict):
        faults.append(f"{section}: found {given!r}, expected a section [{section}]")
        return None
    fields = {field.name: field for field in attrs.fields(kind)}
    found = [
        f"{section}.{key}: no such key{_nearest(key, [*fields])}" for key in given if key not in fields
    ]
    values = {}
    for key, field in fields.items():
        if key not in given:
            if field.default is attrs.NOTHING:
                known = ", or solid.material" if kind is Solid else ""
                found.append(f"{section}.{key}: missing; expected the {field.metadata['doc']}{known}")
            continue
        try:
            values[key] = field.metadata["convert"](given[key])
            if field.validator:
                field.validator(None, field, values[key])
        except (ValueError, TypeError) as error:
            found.append(f"{section}.{key} ({field.metadata['doc']}): {error.args[0]}")
    faults += found
    return None if found else kind(**values)


def _contradictions(scene: Scene) -> list[str]:
    faults = []
    asked, solve = set(scene.output.quantities), scene.solve
    if scene.motion.c is not None and scene.motion.speed is not None:
        faults.append("motion: c and speed exclude each other; keep one")
    if scene.motion.c is None and scene.motion.speed is None:
        faults.append("motion: expected c (over the shear wave speed) or speed (m/s)")
    if asked - {"friction"} and not solve.methods:
        faults.append(
            "solve.methods is empty, but output.quantities asks for "
            f"{', '.join(sorted(asked - {'friction'}))}; name closed_form, fem or both"
        )
    if ("interior" in asked) != bool(scene.output.points or scene.output.map):
        faults.append(
            'output: the quantity "interior" and output.points or output.map go together, as in points = '
            "[[0.0, -0.5], [1.0, -0.5]] or map = { X = [-2, 2, 81], Y = [-2, -0.05, 40] } (over a: from, "
            "to, number)"
        )
    fixed = solve.degree is not None
    if (fixed and solve.cuts % 4) or (not fixed and solve.cuts != 1):
        faults.append(
            f"solve.degree and solve.cuts: found {solve.degree} and {solve.cuts}, expected neither, or a "
            "degree and a multiple of 4: the error is measured with half and a quarter of the cuts"
        )
    if fixed and solve.mode == "traction":
        faults.append('solve.degree needs solve.mode = "contact"')
    if solve.pressure != "closed_form" and solve.mode != "traction":
        faults.append('solve.pressure needs solve.mode = "traction"')
    return faults


def _oddities(scene: Scene) -> list[str]:
    odd = []
    for key, value, unit, low, high in (
        ("solid.E", scene.solid.E, "Pa", 1e3, 2e12),
        ("solid.rho", scene.solid.rho, "kg/m^3", 1.0, 3e4),
        ("punch.half_width", scene.punch.half_width, "m", 1e-9, 10.0),
        ("friction.pre_sliding", scene.friction.pre_sliding, "m", 1e-10, 1.0),
    ):
        if not low <= value <= high:
            odd.append(f"{key} = {value:g} {unit} is unusual; is its unit as meant?")
    return odd
