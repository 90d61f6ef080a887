"""Values of a scene: each kind turns what TOML gives into what is computed with."""

from collections.abc import Collection
from dataclasses import dataclass
from typing import Any, Protocol

from galinx.app.scene.excerpt import excerpt, meant
from galinx.app.scene.units import to_si
from galinx.solvers.parameters import Range

_TEXT = {"type": "string"}
_NO_BOUNDS = Range()


class Kind(Protocol):
    """A kind of values; its docstring says what a scene writes."""

    def __call__(self, value: Any) -> Any:
        """The checked value.

        Raises:
            ValueError: what was found, and what was expected.
        """

    def schema(self) -> dict[str, Any]:
        """JSON schema of what a scene writes."""


def _within(value: float, bounds: Range) -> float:
    if value not in bounds:
        found = excerpt(value) if isinstance(value, int) else f"{value:g}"
        raise ValueError(f"found {found}, expected {bounds}")
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
        """Bounds hold for plain numbers; those with units are checked by the program."""
        return {"anyOf": [{"type": "number"} | _limits(self.bounds), _TEXT]}


@dataclass(frozen=True)
class OrAuto:
    """A number, or ``"auto"``."""

    number: Number

    def __call__(self, value: Any) -> Any:
        return value if value == "auto" else self.number(value)

    def schema(self) -> dict[str, Any]:
        return self.number.schema()


@dataclass(frozen=True)
class NumberList:
    """So many numbers in ``unit``, each of which may be a text with a unit."""

    unit: str
    count: int

    def __call__(self, value: Any) -> tuple[float, ...]:
        if not isinstance(value, list) or len(value) != self.count:
            raise ValueError(f"found {excerpt(value)}, expected a list of {self.count} numbers")
        return tuple(to_si(entry, self.unit) for entry in value)

    def schema(self) -> dict[str, Any]:
        items = Number(self.unit).schema()
        return {"type": "array", "items": items, "minItems": self.count, "maxItems": self.count}


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


class Text:
    """A text."""

    def __call__(self, value: Any) -> str:
        if not isinstance(value, str):
            raise ValueError(f"found {excerpt(value)}, expected a text")
        return value

    def schema(self) -> dict[str, Any]:
        return dict(_TEXT)


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
        one = Choice(self.options)
        return tuple(one(entry) for entry in value)

    def schema(self) -> dict[str, Any]:
        return {"type": "array", "items": Choice(self.options).schema()}


def _one_of(options: Collection[str]) -> str:
    return " or ".join(filter(None, (", ".join(list(options)[:-1]), list(options)[-1])))


def _pairs(count: int) -> dict[str, Any]:
    pair = {"type": "array", "items": Number().schema(), "minItems": 2, "maxItems": 2}
    return {"type": "array", "items": pair, "minItems": count}


class Pressure:
    """``"closed_form"`` or pairs [X/a, σ_YY/(N/2a)] from X/a = -1 to 1."""

    def __call__(self, value: Any) -> Any:
        if value == "closed_form":
            return value
        if not isinstance(value, list) or len(value) < 2:
            raise ValueError(
                f'found {excerpt(value)}, expected "closed_form" or a list of pairs [X/a, σ_YY/(N/2a)]'
            )
        if not all(isinstance(pair, list) and len(pair) == 2 for pair in value):
            raise ValueError("expected a list of pairs [X/a, σ_YY/(N/2a)], dimensionless")
        pairs = tuple((to_si(x, ""), to_si(σ, "")) for x, σ in value)
        positions = [x for x, _ in pairs]
        if positions[0] != -1.0 or positions[-1] != 1.0 or positions != sorted(set(positions)):
            raise ValueError("expected positions that grow from X/a = -1 to X/a = 1")
        if not any(σ for _, σ in pairs):
            raise ValueError("found no pressure but 0, expected some σ_YY/(N/2a) below 0")
        return pairs

    def schema(self) -> dict[str, Any]:
        return {"anyOf": [{"const": "closed_form"}, _pairs(2)]}


def _below(Y: float) -> float:
    if Y >= 0.0:
        raise ValueError(f"found Y/a = {Y:g}, expected Y/a < 0: the solid lies below the punch")
    return Y


class Points:
    """Pairs [X/a, Y/a] below the surface."""

    def __call__(self, value: Any) -> tuple[tuple[float, float], ...]:
        if not isinstance(value, list) or not all(isinstance(p, list) and len(p) == 2 for p in value):
            raise ValueError(f"found {excerpt(value)}, expected a list of pairs [X/a, Y/a]")
        return tuple((to_si(X, ""), _below(to_si(Y, ""))) for X, Y in value)

    def schema(self) -> dict[str, Any]:
        return _pairs(0)


@dataclass(frozen=True)
class Spread:
    """Evenly spaced positions: ``count`` of them from ``first`` to ``last``, over a."""

    first: float
    last: float
    count: int


class Map:
    """``{X = [from, to, number], Y = [from, to, number]}``, over a, Y below the surface."""

    def __call__(self, value: Any) -> tuple[Spread, Spread]:
        if not isinstance(value, dict) or set(value) != {"X", "Y"}:
            raise ValueError(
                f"found {excerpt(value)}, expected {{X = [from, to, number], Y = [from, to, number]}}, "
                "over a"
            )
        X, Y = (self._range(axis, value[axis]) for axis in ("X", "Y"))
        _below(Y.last)
        return X, Y

    @staticmethod
    def _range(axis: str, value: Any) -> Spread:
        if not isinstance(value, list) or len(value) != 3:
            raise ValueError(f"{axis}: found {excerpt(value)}, expected [from, to, number]")
        first, last, count = (to_si(entry, "") for entry in value)
        if not first < last or count != int(count) or not 2 <= count <= 2000:
            raise ValueError(
                f"{axis}: found {excerpt(value)}, expected [from, to, number], from < to, 2 ... 2000"
            )
        return Spread(first, last, int(count))

    def schema(self) -> dict[str, Any]:
        axis = {"type": "array", "items": Number().schema(), "minItems": 3, "maxItems": 3}
        return {
            "type": "object",
            "properties": {"X": axis, "Y": axis},
            "required": ["X", "Y"],
            "additionalProperties": False,
        }
