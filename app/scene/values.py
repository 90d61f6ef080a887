"""Values of a scene: each kind turns what TOML gives into what is computed with."""

from dataclasses import dataclass
from typing import Any

from galinx.app.scene.units import to_si

_TEXT = {"type": "string"}


@dataclass(frozen=True)
class Number:
    """A number in ``unit``, or a text with a unit."""

    unit: str = ""

    def __call__(self, value: Any) -> float:
        return to_si(value, self.unit)

    def schema(self, limits: dict[str, Any]) -> dict[str, Any]:
        """``limits`` hold for plain numbers; those with units are checked by the program."""
        return {"anyOf": [{"type": "number"} | limits, _TEXT]}


class Whole:
    """A whole number."""

    def __call__(self, value: Any) -> int:
        if isinstance(value, bool) or not isinstance(value, int):
            raise ValueError(f"found {value!r}, expected a whole number")
        return int(value)

    def schema(self, limits: dict[str, Any]) -> dict[str, Any]:
        return {"type": "integer"} | limits


@dataclass(frozen=True)
class Numbers:
    """One number or a list of them."""

    unit: str = ""

    def __call__(self, value: Any) -> tuple[float, ...]:
        return tuple(to_si(entry, self.unit) for entry in (value if isinstance(value, list) else [value]))

    def schema(self, limits: dict[str, Any]) -> dict[str, Any]:
        one = Number(self.unit).schema(limits)
        return {"anyOf": [*one["anyOf"], {"type": "array", "items": one, "minItems": 1}]}


class Names:
    """A list of names."""

    def __call__(self, value: Any) -> tuple[Any, ...]:
        if not isinstance(value, list):
            raise ValueError(f"found {value!r}, expected a list of names")
        return tuple(value)

    def schema(self, limits: dict[str, Any]) -> dict[str, Any]:
        return {"type": "array", "items": _TEXT | limits}


class Text:
    """A text."""

    def __call__(self, value: Any) -> str:
        if not isinstance(value, str):
            raise ValueError(f"found {value!r}, expected a text")
        return value

    def schema(self, limits: dict[str, Any]) -> dict[str, Any]:
        return _TEXT | limits


def _pairs(count: int) -> dict[str, Any]:
    pair = {"type": "array", "items": Number().schema({}), "minItems": 2, "maxItems": 2}
    return {"type": "array", "items": pair, "minItems": count}


class Pressure:
    """``"closed_form"`` or pairs [X/a, σ_YY/(N/2a)] from X/a = -1 to 1."""

    def __call__(self, value: Any) -> Any:
        if value == "closed_form":
            return value
        if not isinstance(value, list) or len(value) < 2:
            raise ValueError(
                f'found {value!r}, expected "closed_form" or a list of pairs [X/a, σ_YY/(N/2a)]'
            )
        if not all(isinstance(pair, list) and len(pair) == 2 for pair in value):
            raise ValueError("expected a list of pairs [X/a, σ_YY/(N/2a)], dimensionless")
        pairs = tuple((to_si(x, ""), to_si(σ, "")) for x, σ in value)
        positions = [x for x, _ in pairs]
        if positions[0] != -1.0 or positions[-1] != 1.0 or positions != sorted(set(positions)):
            raise ValueError("expected positions that grow from X/a = -1 to X/a = 1")
        return pairs

    def schema(self, _: dict[str, Any]) -> dict[str, Any]:
        return {"anyOf": [{"const": "closed_form"}, _pairs(2)]}


def _below(Y: float) -> float:
    if Y >= 0.0:
        raise ValueError(f"found Y/a = {Y:g}, expected Y/a < 0: the solid lies below the punch")
    return Y


class Points:
    """Pairs [X/a, Y/a] below the surface."""

    def __call__(self, value: Any) -> tuple[tuple[float, float], ...]:
        if not isinstance(value, list) or not all(isinstance(p, list) and len(p) == 2 for p in value):
            raise ValueError(f"found {value!r}, expected a list of pairs [X/a, Y/a]")
        return tuple((to_si(X, ""), _below(to_si(Y, ""))) for X, Y in value)

    def schema(self, _: dict[str, Any]) -> dict[str, Any]:
        return _pairs(0)


@dataclass(frozen=True)
class Range:
    """Evenly spaced positions: ``count`` of them from ``first`` to ``last``, over a."""

    first: float
    last: float
    count: int


class Map:
    """``{X = [from, to, number], Y = [from, to, number]}``, over a, Y below the surface."""

    def __call__(self, value: Any) -> tuple[Range, Range]:
        if not isinstance(value, dict) or set(value) != {"X", "Y"}:
            raise ValueError(
                f"found {value!r}, expected {{X = [from, to, number], Y = [from, to, number]}}, over a"
            )
        X, Y = (self._range(axis, value[axis]) for axis in ("X", "Y"))
        _below(Y.last)
        return X, Y

    @staticmethod
    def _range(axis: str, value: Any) -> Range:
        if not isinstance(value, list) or len(value) != 3:
            raise ValueError(f"{axis}: found {value!r}, expected [from, to, number]")
        first, last, count = (to_si(entry, "") for entry in value)
        if not first < last or count != int(count) or not 2 <= count <= 2000:
            raise ValueError(
                f"{axis}: found {value!r}, expected [from, to, number], from < to, 2 ... 2000"
            )
        return Range(first, last, int(count))

    def schema(self, _: dict[str, Any]) -> dict[str, Any]:
        axis = {"type": "array", "items": Number().schema({}), "minItems": 3, "maxItems": 3}
        return {
            "type": "object",
            "properties": {"X": axis, "Y": axis},
            "required": ["X", "Y"],
            "additionalProperties": False,
        }
