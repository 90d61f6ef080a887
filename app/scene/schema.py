"""JSON schema of scenes, for editors that complete and check TOML; made from the classes that check."""

from typing import Any

import attrs
from attrs import validators as is_

from galinx.app.scene.sections import SECTIONS

_BOUNDS = {">": "exclusiveMinimum", ">=": "minimum", "<": "exclusiveMaximum", "<=": "maximum"}


def schema() -> dict[str, Any]:
    """JSON schema (draft 7) of a scene."""
    properties: dict[str, Any] = {"title": {"type": "string", "description": "free text"}}
    properties |= {name: _section(name, kind) for name, kind in SECTIONS.items()}
    return {
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "galinx scene",
        "type": "object",
        "properties": properties,
        "required": ["solid", "friction", "motion"],
        "additionalProperties": False,
    }


def _section(name: str, kind: type) -> dict[str, Any]:
    properties, required = {}, []
    for field in attrs.fields(kind):
        convert, about = field.metadata["convert"], field.metadata["doc"]
        unit = getattr(convert, "unit", None)
        about += "" if unit is None else f" [{unit or 'dimensionless'}]"
        entry = convert.schema(_limits(field.validator)) | {"description": about}
        if field.default is attrs.NOTHING:
            required.append(field.name)
        elif field.default is not None:
            entry["default"] = list(field.default) if isinstance(field.default, tuple) else field.default
        properties[field.name] = entry
    section = {"type": "object", "properties": properties, "additionalProperties": False}
    if name == "solid":  # a known material gives the constants
        section["anyOf"] = [{"required": ["material"]}, {"required": required}]
    elif required:
        section["required"] = required
    return section


def _limits(check: Any) -> dict[str, Any]:
    """What a validator of attrs asks for, in the words of JSON schema."""
    if check is None:
        return {}
    for inner in ("validator", "member_validator"):  # optional, deep_iterable
        if hasattr(check, inner):
            return _limits(getattr(check, inner))
    if hasattr(check, "_validators"):  # and_
        return {key: value for part in check._validators for key, value in _limits(part).items()}
    if hasattr(check, "options"):  # in_
        return {"enum": list(check.options)}
    if hasattr(check, "compare_op"):  # gt, ge, lt, le
        return {_BOUNDS[check.compare_op]: check.bound}
    if isinstance(check, type(is_.min_len(1))):
        return {}  # the kinds of values know it
    raise TypeError(f"no JSON schema for the validator {check!r}")
