"""Several numbers of a scene: one, a list, or a range of them."""

from collections.abc import Iterator
from dataclasses import dataclass
from decimal import Decimal
from typing import Any

from galinx.app.scene.excerpt import excerpt, nearest
from galinx.app.scene.values import Choice, Kind, Number, Whole
from galinx.solvers.parameters import Range

_FORM = '{from = …, to = …, number = …}, with spacing = "log" where ratios are to be equal'
_SPACINGS = ("linear", "log")
#: A million speeds fit into a list, too.
_MOST = 10**6


@dataclass(frozen=True)
class Numbers:
    """One number, a list or a range of them."""

    unit: str = ""
    bounds: Range = Range()

    def __call__(self, value: Any) -> tuple[float, ...]:
        one = Number(self.unit, self.bounds)
        if isinstance(value, dict):
            return _spread(value, one)
        found = tuple(one(entry) for entry in (value if isinstance(value, list) else [value]))
        if not found:
            raise ValueError("found an empty list, expected at least one number")
        return found

    def schema(self) -> dict[str, Any]:
        kind = Number(self.unit, self.bounds)
        one = kind.schema()
        spread = {
            "type": "object",
            "properties": {key: known.schema() for key, known in _keys(kind).items()},
            "required": ["from", "to", "number"],
            "additionalProperties": False,
        }
        return {"anyOf": [*one["anyOf"], {"type": "array", "items": one, "minItems": 1}, spread]}


def _keys(end: Number) -> dict[str, Kind]:
    number = Whole(Range(at_least=2, at_most=_MOST))
    return {"from": end, "to": end, "number": number, "spacing": Choice(_SPACINGS)}


def _spread(given: dict[str, Any], end: Number) -> tuple[float, ...]:
    """Numbers of a range; where both ends are what ``end`` allows, what lies between is, too."""
    keys = _keys(end)
    values: dict[str, Any] = {"spacing": "linear"}
    for key in given:
        if key not in keys:
            raise ValueError(f"found the key {excerpt(key)} in a range{nearest(key, [*keys])}")
    for key, kind in keys.items():
        if key in given:
            try:
                values[key] = kind(given[key])
            except ValueError as error:
                raise ValueError(f"{key}: {error}") from None
        elif key not in values:
            raise ValueError(f"found a range without {key}, expected {_FORM}")
    first, last, logarithmic = values["from"], values["to"], values["spacing"] == "log"
    if first == last:
        raise ValueError(f"found a range from {first:g} to {last:g}, expected two different ends")
    if logarithmic and min(first, last) <= 0.0:
        raise ValueError(
            f'found a range from {first:g} to {last:g} with spacing = "log", expected both ends > 0'
        )
    return first, *_between(first, last, values["number"], logarithmic), last


def _between(first: float, last: float, number: int, logarithmic: bool) -> Iterator[float]:
    """What lies between the ends, in decimals: 0.3 of 0, 0.1, … 0.9 is what 0.3 is in a list."""
    one, other = (Decimal(repr(end)) for end in (first, last))
    if logarithmic:
        one, other = one.ln(), other.ln()
    for i in range(1, number - 1):
        at = (one * (number - 1 - i) + other * i) / (number - 1)
        yield float(at.exp() if logarithmic else at)
