"""Tables of a scene: rows of numbers, one of several texts, strokes."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from galinx.app.scene.excerpt import excerpt, nearest
from galinx.app.scene.values import Choice, Kind, Number
from galinx.solvers.friction.motion import DIRECTION, Partial
from galinx.solvers.parameters import Range


@dataclass(frozen=True)
class Rows:
    """Rows of numbers, as [[1, 2], [3, 4]]; a scene in a file may name a file of them, `"rows.csv"`."""

    units: tuple[str, ...]
    at_least: int = 1

    def __call__(self, value: Any) -> tuple[tuple[float, ...], ...]:
        wide = len(self.units)
        units = ", ".join(unit or "dimensionless" for unit in self.units)
        expected = f"at least {self.at_least} rows of {wide} numbers ({units})"
        if isinstance(value, str):
            expected += "; or, where the scene is a file itself, a file of these whose name ends in .csv"
        if not isinstance(value, list) or len(value) < self.at_least:
            raise ValueError(f"found {excerpt(value)}, expected {expected}")
        for row in value:
            if not isinstance(row, list) or len(row) != wide:
                raise ValueError(f"found {excerpt(row)} among the rows, expected {expected}")
        columns = [Number(unit) for unit in self.units]
        return tuple(tuple(kind(entry) for kind, entry in zip(columns, row)) for row in value)

    def schema(self) -> dict[str, Any]:
        wide = len(self.units)
        row = {"type": "array", "items": Number().schema(), "minItems": wide, "maxItems": wide}
        rows = {"type": "array", "items": row, "minItems": self.at_least}
        return {"anyOf": [rows, {"type": "string", "pattern": r"\.[cC][sS][vV]$"}]}


@dataclass(frozen=True)
class OneOrMore:
    """A text or a list of texts."""

    one: Choice

    def __call__(self, value: Any) -> tuple[str, ...]:
        if not isinstance(value, list):
            return (self.one(value),)
        if not value:
            raise ValueError("found an empty list, expected at least one text")
        return tuple(self.one(entry) for entry in value)

    def schema(self) -> dict[str, Any]:
        one = self.one.schema()
        return {"anyOf": [one, {"type": "array", "items": one, "minItems": 1}]}


@dataclass(frozen=True)
class Wrapped:
    """What is the same for all laws of a scene."""

    kind: Kind

    def __call__(self, value: Any) -> tuple[Any]:
        return (self.kind(value),)

    def schema(self) -> dict[str, Any]:
        return self.kind.schema()


@dataclass(frozen=True)
class Variations:
    """Tables, each with values, lists or ranges of parameters of the law.

    Attributes:
        kinds: of the parameters that the law has, by key.
        every: keys of the parameters that some law has.
    """

    kinds: Mapping[str, Kind]
    every: tuple[str, ...]

    def __call__(self, value: Any) -> tuple[dict[str, tuple[Any, ...]], ...]:
        if not isinstance(value, list) or not all(isinstance(one, dict) for one in value):
            raise ValueError(
                f"found {excerpt(value)}, expected tables [[friction.vary]] of parameters of the law"
            )
        return tuple(self._one(f"table {number}", table) for number, table in enumerate(value, 1))

    def _one(self, name: str, table: dict[str, Any]) -> dict[str, tuple[Any, ...]]:
        given = {}
        for key, value in table.items():
            if key not in self.kinds:
                hint = nearest(key, [*self.kinds])
                raise ValueError(f"found the key {excerpt(key)} in {name}{hint}")
            try:
                given[key] = self.kinds[key](value)
            except ValueError as error:
                raise ValueError(f"{key} of {name}: {error}") from None
        return given

    def schema(self) -> dict[str, Any]:
        properties = {key: {"$ref": f"#/properties/friction/properties/{key}"} for key in self.every}
        table = {"type": "object", "properties": properties, "additionalProperties": False}
        return {"type": "array", "items": table}


_FORM = '{to = …}, with speed = "…" and rest = "…" where it has its own'
_KEYS: dict[str, Kind] = {
    "to": Number("", Range(at_least=0.0, at_most=1.0)),
    "speed": Number("m/s", Range(above=0.0)),
    "rest": Number("s", Range(at_least=0.0)),
}


class Strokes:
    """A list of `"forward"`, `"backward"` and `{to = X/L, speed = …, rest = …}`."""

    def __call__(self, value: Any) -> tuple[str | Partial, ...]:
        if not isinstance(value, list):
            raise ValueError(f"found {excerpt(value)}, expected a list of names or of {_FORM}")
        if not value:
            raise ValueError(f"found an empty list, expected forward or backward or {_FORM}")
        return tuple(self._one(entry) for entry in value)

    def _one(self, value: Any) -> str | Partial:
        if not isinstance(value, dict):
            return Choice(DIRECTION)(value)
        if unknown := [key for key in value if key not in _KEYS]:
            found, hint = excerpt(unknown[0]), nearest(unknown[0], [*_KEYS])
            raise ValueError(f"found the key {found} in a stroke{hint}")
        if "to" not in value:
            raise ValueError(f"found a stroke without to, expected {_FORM}")
        given = {}
        for key, entry in value.items():
            try:
                given[key] = _KEYS[key](entry)
            except ValueError as error:
                raise ValueError(f"{key} of a stroke: {error}") from None
        return Partial(**given)

    def schema(self) -> dict[str, Any]:
        stroke = {
            "type": "object",
            "properties": {key: kind.schema() for key, kind in _KEYS.items()},
            "required": ["to"],
            "additionalProperties": False,
        }
        return {"type": "array", "items": {"anyOf": [Choice(DIRECTION).schema(), stroke]}, "minItems": 1}
