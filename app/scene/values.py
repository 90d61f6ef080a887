"""Kinds of values in a scene: each turns a value of TOML into the one to compute with, or refuses it.

There are single numbers and texts, lists and tables of other kinds, numbers as a list or a range, and
rows of numbers. Each kind also gives the JSON schema of its values.
"""

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from itertools import pairwise
from typing import Any, Protocol

from galinx.solvers.friction.motion import DIRECTION, Partial
from galinx.solvers.parameters import Parameter, Range

from ..errors import excerpt, meant, nearest
from .units import to_si

_TEXT = {"type": "string"}
_NO_BOUNDS = Range()


class Kind(Protocol):
    """A kind of values; ``about`` or its docstring describes these in the documentation of scenes."""

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
            *first, last = self.options
            one_of = f"{', '.join(first)} or {last}" if first else last
            raise ValueError(f"found {excerpt(value)}, expected {one_of}{hint}")
        return value

    def schema(self) -> dict[str, Any]:
        return _TEXT | {"enum": list(self.options)}


@dataclass(frozen=True)
class List:
    """A list of values of a kind.

    Attributes:
        kind: of each.
        about: the list in words.
        count: number of values; None for any number from ``at_least`` on.
        alone: True where a single value stands for a list of one.
    """

    kind: Kind
    about: str = ""
    count: int | None = None
    at_least: int = 1
    alone: bool = False

    @property
    def unit(self) -> str | None:
        """Unit of each value, None where they have none."""
        return getattr(self.kind, "unit", None)

    def __call__(self, value: Any) -> tuple[Any, ...]:
        if self.alone and not isinstance(value, list):
            value = [value]
        if not isinstance(value, list) or len(value) != (self.count or len(value)):
            expected = self.about or f"a list of {self.count} numbers"
            raise ValueError(f"found {excerpt(value)}, expected {expected}")
        if len(value) < self.at_least:
            raise ValueError(f"found an empty list, expected {self.about}, at least one")
        return tuple(self.kind(entry) for entry in value)

    def schema(self) -> dict[str, Any]:
        single = self.kind.schema()
        array = _array(single, self.count or self.at_least, self.count)
        return {"anyOf": [single, array]} if self.alone else array


@dataclass(frozen=True)
class Table:
    """A table of values by key.

    Attributes:
        kinds: of the values, by key.
        words: the table in words.
        needed: keys that it has to have.
        form: an example of the table, for messages.
    """

    kinds: Mapping[str, Kind]
    words: str
    needed: tuple[str, ...] = ()
    form: str = ""

    def __call__(self, value: Any) -> dict[str, Any]:
        if not isinstance(value, dict):
            raise ValueError(f"found {excerpt(value)}, expected {self.form}")
        if unknown := [key for key in value if key not in self.kinds]:
            hint = nearest(unknown[0], [*self.kinds])
            raise ValueError(f"found the key {excerpt(unknown[0])} in {self.words}{hint}")
        if missing := [key for key in self.needed if key not in value]:
            raise ValueError(f"found {self.words} without {missing[0]}, expected {self.form}")
        values = {}
        for key, entry in value.items():
            try:
                values[key] = self.kinds[key](entry)
            except ValueError as error:
                raise ValueError(f"in {self.words}, {key}: {error}") from None
        return values

    def schema(self) -> dict[str, Any]:
        return _object({key: kind.schema() for key, kind in self.kinds.items()}, self.needed)


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
        rows = _array(List(Number(), count=len(self.units)).schema(), self.at_least)
        return {"anyOf": [rows, {"type": "string", "pattern": r"\.[cC][sS][vV]$"}]}


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


#: Least depth over a of points inside; differences over far less have no digits.
_SHALLOWEST = 1e-12


def _check_points(points: Sequence[Sequence[float]]) -> None:
    for _, Y, *_ in points:
        if Y > -_SHALLOWEST:
            raise ValueError(
                f"found Y/a = {Y:g}, expected Y/a < 0, by {_SHALLOWEST:g} at least: the solid lies below "
                "the punch, and `surface` has the stresses on its surface"
            )


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


_AXIS = List(Number(), "[from, to, number]", 3)
_AXES = Table(
    {"X": _AXIS, "Y": _AXIS}, "a map", ("X", "Y"),
    "{X = [from, to, number], Y = [from, to, number]}, over a",
)  # fmt: skip


class Map:
    """``{X = [from, to, number], Y = [from, to, number]}``, over a, Y below the surface."""

    schema = _AXES.schema

    def __call__(self, value: Any) -> tuple[tuple[float, float, int], ...]:
        axes = _AXES(value)
        for axis, (first, last, count) in axes.items():
            if not first < last or count != int(count) or not 2 <= count <= 2000:
                raise ValueError(
                    f"{axis}: found {excerpt(value[axis])}, expected [from, to, number], from < to, "
                    "2 ... 2000"
                )
        _check_points([axes["Y"]])
        return tuple((first, last, int(count)) for first, last, count in (axes["X"], axes["Y"]))


@dataclass(frozen=True)
class Numbers:
    """One number, a list or a range of them."""

    unit: str = ""
    bounds: Range = Range()

    def __call__(self, value: Any) -> tuple[float, ...]:
        return tuple(_spread(**self._range(value))) if isinstance(value, dict) else self._list(value)

    @property
    def _list(self) -> List:
        return List(Number(self.unit, self.bounds), "a number or a list of numbers", alone=True)

    @property
    def _range(self) -> Table:
        end = Number(self.unit, self.bounds)
        number, spacing = Whole(Range(at_least=2, at_most=10**6)), Choice(("linear", "log"))
        return Table(
            {"from": end, "to": end, "number": number, "spacing": spacing}, "a range",
            ("from", "to", "number"),
            '{from = …, to = …, number = …}, with spacing = "log" where ratios are to be equal',
        )  # fmt: skip

    def schema(self) -> dict[str, Any]:
        single, array = self._list.schema()["anyOf"]
        return {"anyOf": [*single["anyOf"], array, self._range.schema()]}


def _spread(to: float, number: int, spacing: str = "linear", **ends: float) -> Iterator[float]:
    """Numbers of a range, ends included; those between are within bounds where both ends are.

    They are computed in decimals: 0.3 of 0, 0.1, … 0.9 is the float of "0.3".
    """
    first, logarithmic = ends["from"], spacing == "log"
    if first == to:
        raise ValueError(f"found a range from {first:g} to {to:g}, expected two different ends")
    if logarithmic and min(first, to) <= 0.0:
        raise ValueError(
            f'found a range from {first:g} to {to:g} with spacing = "log", expected both ends > 0'
        )
    low, high = (Decimal(repr(end)) for end in (first, to))
    if logarithmic:
        low, high = low.ln(), high.ln()
    yield first
    for i in range(1, number - 1):
        at = (low * (number - 1 - i) + high * i) / (number - 1)
        yield float(at.exp() if logarithmic else at)
    yield to


def kind_of(parameter: Parameter, several: bool = False) -> Kind:
    """Kind of the values of a model's parameter.

    Args:
        parameter: the parameter.
        several: a number may be a list or a range of numbers.
    """
    if parameter.options:
        return Choice(parameter.options)
    if parameter.columns:
        return Rows(parameter.columns)
    if parameter.count:
        return List(Number(parameter.unit), count=parameter.count)
    return (Numbers if several else Number)(parameter.unit, parameter.range)


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
        if value and not self.kinds:
            raise ValueError(
                f"found tables: {len(value)}, expected none: the law's own parameters are lists or "
                "tables, the same for all states"
            )
        return tuple(Table(self.kinds, f"table {n}")(table) for n, table in enumerate(value, 1))

    def schema(self) -> dict[str, Any]:
        properties = {key: {"$ref": f"#/properties/friction/properties/{key}"} for key in self.every}
        return {"type": "array", "items": _object(properties)}


class _Stroke:
    """A direction, or how far a stroke goes, at its own speed, after its own time at rest."""

    table = Table(
        {"to": Number("", Range(at_least=0.0, at_most=1.0)), "speed": Number("m/s", Range(above=0.0)),
         "rest": Number("s", Range(at_least=0.0))},
        "a stroke", ("to",), '{to = …}, with speed = "…" and rest = "…" where it has its own',
    )  # fmt: skip
    name = Choice(DIRECTION)

    def __call__(self, value: Any) -> str | Partial:
        return Partial(**self.table(value)) if isinstance(value, dict) else self.name(value)

    def schema(self) -> dict[str, Any]:
        return {"anyOf": [self.name.schema(), self.table.schema()]}


#: Strokes one after the other.
STROKES = List(_Stroke(), 'a list of "forward", "backward" and {to = X/L, speed = …, rest = …}')
