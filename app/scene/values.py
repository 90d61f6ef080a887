"""Kinds of values in a scene: each turns a value of TOML into the one to compute with, or refuses it.

There are single numbers and texts, numbers as a list or a range, and tables: rows of numbers, variations
of a law's parameters, strokes. Each kind also gives the JSON schema of its values.
"""

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from itertools import pairwise
from typing import Any, Protocol

from galinx.solvers.friction.motion import DIRECTION, Partial
from galinx.solvers.parameters import Range

from ..errors import excerpt, meant, nearest
from .units import to_si

_TEXT = {"type": "string"}
_NO_BOUNDS = Range()


class Kind(Protocol):
    """A kind of values; its docstring describes these in the documentation of scenes."""

    def __call__(self, value: Any) -> Any:
        """The checked value.

        Raises:
            ValueError: the value is refused; the message says what was found and what was expected.
        """

    def schema(self) -> dict[str, Any]:
        """JSON schema of the values in a scene."""


def _within(value: float, bounds: Range) -> float:
    if value not in bounds:
        shown = excerpt(value) if isinstance(value, int) else f"{value:g}"
        raise ValueError(f"found {shown}, expected {bounds}")
    return value


def _limits(bounds: Range) -> dict[str, float]:
    named = {
        "exclusiveMinimum": bounds.above,
        "minimum": bounds.at_least,
        "exclusiveMaximum": bounds.below,
        "maximum": bounds.at_most,
    }
    return {name: bound for name, bound in named.items() if bound is not None}


@dataclass(frozen=True)
class Number:
    """A number in ``unit``, or a text with a unit."""

    unit: str = ""
    bounds: Range = _NO_BOUNDS

    def __call__(self, value: Any) -> float:
        return _within(to_si(value, self.unit), self.bounds)

    def schema(self) -> dict[str, Any]:
        """JSON schema, whose bounds hold for plain numbers; the kind checks numbers with units."""
        return {"anyOf": [{"type": "number"} | _limits(self.bounds), _TEXT]}


@dataclass(frozen=True)
class Or:
    """A word, or a value of another kind; the word stands for None."""

    word: str
    kind: Kind

    def __call__(self, value: Any) -> Any:
        return None if value == self.word else self.kind(value)

    def schema(self) -> dict[str, Any]:
        return {"anyOf": [{"const": self.word}, self.kind.schema()]}


@dataclass(frozen=True)
class NumberList:
    """A list of ``count`` numbers in ``unit``, each of which may be a text with a unit."""

    unit: str
    count: int

    def __call__(self, value: Any) -> tuple[float, ...]:
        if not isinstance(value, list) or len(value) != self.count:
            raise ValueError(f"found {excerpt(value)}, expected a list of {self.count} numbers")
        return tuple(to_si(entry, self.unit) for entry in value)

    def schema(self) -> dict[str, Any]:
        return _array(Number(self.unit).schema(), self.count, self.count)


@dataclass(frozen=True)
class Whole:
    """A whole number."""

    bounds: Range = _NO_BOUNDS

    def __call__(self, value: Any) -> int:
        if isinstance(value, bool) or not isinstance(value, int):
            raise ValueError(f"found {excerpt(value)}, expected a whole number")
        return int(_within(value, self.bounds))

    def schema(self) -> dict[str, Any]:
        return {"type": "integer"} | _limits(self.bounds)


@dataclass(frozen=True)
class Choice:
    """A text."""

    options: Collection[str]

    def __call__(self, value: Any) -> str:
        if not isinstance(value, str) or value not in self.options:
            hint = meant(value, self.options) if isinstance(value, str) else ""
            raise ValueError(f"found {excerpt(value)}, expected {_one_of(self.options)}{hint}")
        return value

    def schema(self) -> dict[str, Any]:
        return _TEXT | {"enum": list(self.options)}


@dataclass(frozen=True)
class Choices:
    """A list of names."""

    options: Collection[str]
    at_least: int = 1

    def __call__(self, value: Any) -> tuple[str, ...]:
        if not isinstance(value, list):
            raise ValueError(f"found {excerpt(value)}, expected a list of names")
        if len(value) < self.at_least:
            raise ValueError(f"found an empty list, expected {_one_of(self.options)}")
        choice = Choice(self.options)
        return tuple(choice(entry) for entry in value)

    def schema(self) -> dict[str, Any]:
        return {"type": "array", "items": Choice(self.options).schema()}


def _one_of(options: Collection[str]) -> str:
    return " or ".join(filter(None, (", ".join(list(options)[:-1]), list(options)[-1])))


def _array(items: dict[str, Any], at_least: int = 0, at_most: int | None = None) -> dict[str, Any]:
    """JSON schema of a list."""
    most = {} if at_most is None else {"maxItems": at_most}
    return {"type": "array", "items": items, "minItems": at_least} | most


def _object(properties: dict[str, Any], required: Collection[str] = ()) -> dict[str, Any]:
    """JSON schema of a table."""
    needed = {"required": list(required)} if required else {}
    return {"type": "object", "properties": properties} | needed | {"additionalProperties": False}


@dataclass(frozen=True)
class Rows:
    """Rows of numbers, as [[1, 2], [3, 4]]; a scene in a file may name a file of them, `"rows.csv"`."""

    units: tuple[str, ...]
    at_least: int = 1
    #: The rows in words, for messages, and a check that raises ValueError.
    form: str = ""
    check: Callable[[Sequence[Sequence[float]]], None] = lambda rows: None

    def __call__(self, value: Any) -> tuple[tuple[float, ...], ...]:
        units = ", ".join(unit or "dimensionless" for unit in self.units)
        expected = self.form or f"at least {self.at_least} rows of {len(self.units)} numbers ({units})"
        if isinstance(value, str):
            expected += "; or, where the scene is a file itself, a file of these whose name ends in .csv"
        if not isinstance(value, list) or len(value) < self.at_least:
            raise ValueError(f"found {excerpt(value)}, expected {expected}")
        for row in value:
            if not isinstance(row, list) or len(row) != len(self.units):
                raise ValueError(f"found {excerpt(row)} among the rows, expected {expected}")
        rows = tuple(tuple(to_si(entry, unit) for entry, unit in zip(row, self.units)) for row in value)
        self.check(rows)
        return rows

    def schema(self) -> dict[str, Any]:
        rows = _array(_array(Number().schema(), len(self.units), len(self.units)), self.at_least)
        return {"anyOf": [rows, {"type": "string", "pattern": r"\.[cC][sS][vV]$"}]}


def _by_key(
    given: Mapping[str, Any], kinds: Mapping[str, Kind], where: str, needed: str = "", form: str = ""
) -> dict[str, Any]:
    """Values of a table by key.

    Args:
        given: as TOML gives them.
        kinds: of the values, by key.
        where: the table in words.
        needed: keys that it has to have, with blanks between them.
        form: an example of the table, for messages.

    Raises:
        ValueError: a key is unknown or missing, or a value is refused.
    """
    if unknown := [key for key in given if key not in kinds]:
        hint = nearest(unknown[0], [*kinds])
        raise ValueError(f"found the key {excerpt(unknown[0])} in {where}{hint}")
    if missing := [key for key in needed.split() if key not in given]:
        raise ValueError(f"found {where} without {missing[0]}, expected {form}")
    values = {}
    for key, entry in given.items():
        try:
            values[key] = kinds[key](entry)
        except ValueError as error:
            raise ValueError(f"in {where}, {key}: {error}") from None
    return values


def _check_over_contact(pairs: Sequence[Sequence[float]]) -> None:
    positions = [x for x, _ in pairs]
    if positions[0] != -1.0 or positions[-1] != 1.0 or positions != sorted(set(positions)):
        raise ValueError("expected positions that grow from X/a = -1 to X/a = 1")


def _check_pressure(pairs: Sequence[Sequence[float]]) -> None:
    _check_over_contact(pairs)
    if not any(σ for _, σ in pairs):
        raise ValueError("found no pressure but 0, expected a σ_YY/(N/2a) below 0")


def _check_along(pairs: Sequence[Sequence[float]]) -> None:
    _check_over_contact(pairs)
    f = [of for _, of in pairs]
    if min(f) < 0.0 or not any(f):
        raise ValueError(f"found f from {min(f):g} to {max(f):g}, expected none below 0, and not all 0")


def _check_points(points: Sequence[Sequence[float]]) -> None:
    for _, Y, *_ in points:
        if Y >= 0.0:
            raise ValueError(f"found Y/a = {Y:g}, expected Y/a < 0: the solid lies below the punch")


_BY_DEPTH = "at least 2 rows [depth, E, nu, rho], depths rising from 0"


def _check_depths(rows: Sequence[Sequence[float]]) -> None:
    depths = [row[0] for row in rows]
    if depths[0] != 0.0 or any(low >= high for low, high in pairwise(depths)):
        raise ValueError(f"found the depths {excerpt(depths)}, expected {_BY_DEPTH}")


#: A pressure and f by their positions, points below the surface, and constants of a solid by depth.
PRESSURE = Rows(
    ("", ""), 2, '"closed_form" or a list of pairs [X/a, σ_YY/(N/2a)], dimensionless', _check_pressure
)
ALONG = Rows(("", ""), 2, "a list of pairs [X/a, f]", _check_along)
POINTS = Rows(("", ""), 0, "a list of pairs [X/a, Y/a]", _check_points)
DEPTHS = Rows(("m", "Pa", "", "kg/m^3"), 2, _BY_DEPTH, _check_depths)


class Constants:
    """Constants of a solid at a layer's lower face, `{ E = 2.5e9, nu = 0.3 }`; others are as on top."""

    def __call__(self, value: Any) -> dict[str, Any]:
        if not isinstance(value, dict) or not value:
            raise ValueError(f"found {excerpt(value)}, expected constants, as in {{ E = 2.5e9 }}")
        return value

    def schema(self) -> dict[str, Any]:
        return {"type": "object", "minProperties": 1}


class Map:
    """``{X = [from, to, number], Y = [from, to, number]}``, over a, Y below the surface."""

    def __call__(self, value: Any) -> tuple[tuple[float, float, int], ...]:
        if not isinstance(value, dict) or set(value) != {"X", "Y"}:
            raise ValueError(
                f"found {excerpt(value)}, expected {{X = [from, to, number], Y = [from, to, number]}}, "
                "over a"
            )
        axes = []
        for axis in ("X", "Y"):
            found = f"{axis}: found {excerpt(given := value[axis])}, expected [from, to, number]"
            if not isinstance(given, list) or len(given) != 3:
                raise ValueError(found)
            first, last, count = (to_si(entry, "") for entry in given)
            if not first < last or count != int(count) or not 2 <= count <= 2000:
                raise ValueError(f"{found}, from < to, 2 ... 2000")
            axes.append((first, last, int(count)))
        _check_points([axes[1]])
        return tuple(axes)

    def schema(self) -> dict[str, Any]:
        axis = _array(Number().schema(), 3, 3)
        return _object({"X": axis, "Y": axis}, ("X", "Y"))


_FORM = '{from = …, to = …, number = …}, with spacing = "log" where ratios are to be equal'
#: Most numbers of a range.
_MOST = 10**6


@dataclass(frozen=True)
class Numbers:
    """One number, a list or a range of them."""

    unit: str = ""
    bounds: Range = Range()

    @property
    def _range(self) -> dict[str, Kind]:
        """Kinds of the keys of a range."""
        end, number = Number(self.unit, self.bounds), Whole(Range(at_least=2, at_most=_MOST))
        return {"from": end, "to": end, "number": number, "spacing": Choice(("linear", "log"))}

    def __call__(self, value: Any) -> tuple[float, ...]:
        if isinstance(value, dict):
            return tuple(_spread(value, self._range))
        kind = Number(self.unit, self.bounds)
        numbers = tuple(kind(entry) for entry in (value if isinstance(value, list) else [value]))
        if not numbers:
            raise ValueError("found an empty list, expected at least one number")
        return numbers

    def schema(self) -> dict[str, Any]:
        single = Number(self.unit, self.bounds).schema()
        keys = {key: kind.schema() for key, kind in self._range.items()}
        return {"anyOf": [*single["anyOf"], _array(single, 1), _object(keys, ("from", "to", "number"))]}


def _spread(given: dict[str, Any], keys: Mapping[str, Kind]) -> Iterator[float]:
    """Numbers of a range, ends included; those between are within bounds where both ends are.

    They are computed in decimals: 0.3 of 0, 0.1, … 0.9 is the float of "0.3".
    """
    values = {"spacing": "linear"} | _by_key(given, keys, "a range", "from to number", _FORM)
    first, last, number, logarithmic = (
        values["from"], values["to"], values["number"], values["spacing"] == "log",
    )  # fmt: skip
    if first == last:
        raise ValueError(f"found a range from {first:g} to {last:g}, expected two different ends")
    if logarithmic and min(first, last) <= 0.0:
        raise ValueError(
            f'found a range from {first:g} to {last:g} with spacing = "log", expected both ends > 0'
        )
    low, high = (Decimal(repr(end)) for end in (first, last))
    if logarithmic:
        low, high = low.ln(), high.ln()
    yield first
    for i in range(1, number - 1):
        at = (low * (number - 1 - i) + high * i) / (number - 1)
        yield float(at.exp() if logarithmic else at)
    yield last


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
        single = self.one.schema()
        return {"anyOf": [single, _array(single, 1)]}


@dataclass(frozen=True)
class Wrapped:
    """A value that is the same for all laws of a scene, as a list of one."""

    kind: Kind

    def __call__(self, value: Any) -> tuple[Any]:
        return (self.kind(value),)

    def schema(self) -> dict[str, Any]:
        return self.kind.schema()


@dataclass(frozen=True)
class Variations:
    """Tables, each with values, lists or ranges of parameters of the law."""

    #: Kinds of the law's parameters, by key.
    kinds: Mapping[str, Kind]
    #: Keys of the parameters of all laws.
    every: tuple[str, ...]

    def __call__(self, value: Any) -> tuple[dict[str, tuple[Any, ...]], ...]:
        if not isinstance(value, list) or not all(isinstance(table, dict) for table in value):
            raise ValueError(
                f"found {excerpt(value)}, expected tables [[friction.vary]] of parameters of the law"
            )
        return tuple(_by_key(table, self.kinds, f"table {n}") for n, table in enumerate(value, 1))

    def schema(self) -> dict[str, Any]:
        properties = {key: {"$ref": f"#/properties/friction/properties/{key}"} for key in self.every}
        return {"type": "array", "items": _object(properties)}


_STROKE_FORM = '{to = …}, with speed = "…" and rest = "…" where it has its own'
_KEYS: dict[str, Kind] = {
    "to": Number("", Range(at_least=0.0, at_most=1.0)),
    "speed": Number("m/s", Range(above=0.0)),
    "rest": Number("s", Range(at_least=0.0)),
}


class Strokes:
    """A list of `"forward"`, `"backward"` and `{to = X/L, speed = …, rest = …}`."""

    def __call__(self, value: Any) -> tuple[str | Partial, ...]:
        if not isinstance(value, list):
            raise ValueError(f"found {excerpt(value)}, expected a list of names or of {_STROKE_FORM}")
        if not value:
            raise ValueError(f"found an empty list, expected forward or backward or {_STROKE_FORM}")
        return tuple(self._stroke(entry) for entry in value)

    def _stroke(self, value: Any) -> str | Partial:
        if not isinstance(value, dict):
            return Choice(DIRECTION)(value)
        return Partial(**_by_key(value, _KEYS, "a stroke", "to", _STROKE_FORM))

    def schema(self) -> dict[str, Any]:
        stroke = _object({key: kind.schema() for key, kind in _KEYS.items()}, ("to",))
        return _array({"anyOf": [Choice(DIRECTION).schema(), stroke]}, 1)
