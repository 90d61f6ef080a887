"""Parameters of physical models: dataclass fields that know their key, unit, range and meaning.

Sections of scenes, columns of the states, the schema and the pages of documentation are made from them.
"""

import dataclasses
from dataclasses import MISSING, dataclass
from math import isfinite
from typing import Any

_METADATA = "galinx parameter"


@dataclass(frozen=True)
class Range:
    """Where a number may lie; what is not given does not bound it.

    Attributes:
        above, at_least, below, at_most: bounds.
    """

    above: float | None = None
    at_least: float | None = None
    below: float | None = None
    at_most: float | None = None

    def __contains__(self, value: float) -> bool:
        return (
            (self.above is None or value > self.above)
            and (self.at_least is None or value >= self.at_least)
            and (self.below is None or value < self.below)
            and (self.at_most is None or value <= self.at_most)
        )

    def __str__(self) -> str:
        signs = {">": self.above, ">=": self.at_least, "<": self.below, "<=": self.at_most}
        return ", ".join(f"{sign} {bound:g}" for sign, bound in signs.items() if bound is not None)


@dataclass(frozen=True)
class Parameter:
    """What is known of a parameter.

    Attributes:
        key: its name in scenes and archives.
        about: what it is.
        unit: SI, "" for dimensionless.
        symbol: as formulas write it, in LaTeX without dollars.
        range: where it may lie.
        usual: where it usually lies; beyond, its unit may be another than meant.
        options: the texts that it may be; none for a number.
        count: of the numbers that it is, 0 for one number.
        pairs: is it a list of pairs of numbers?
        optional: may all of these be left out?
        note: what documentation says beyond ``about``.
    """

    key: str
    about: str
    unit: str = ""
    symbol: str = ""
    range: Range = Range()
    usual: tuple[float, float] | None = None
    options: tuple[str, ...] = ()
    count: int = 0
    optional: bool = False
    note: str = ""
    pairs: bool = False


def parameter(
    key: str,
    about: str,
    unit: str = "",
    *,
    symbol: str = "",
    default: Any = MISSING,
    usual: tuple[float, float] | None = None,
    note: str = "",
    **bounds: float,
) -> Any:
    """A number as a dataclass's field; ``bounds`` are those of :class:`Range`."""
    shown = symbol or rf"\mathrm{{{key}}}".replace("_", r"\_")
    known = Parameter(key, about, unit, shown, Range(**bounds), usual, note=note)
    return dataclasses.field(default=default, metadata={_METADATA: known})


def numbers(
    key: str,
    about: str,
    unit: str,
    count: int,
    *,
    optional: bool = False,
    usual: tuple[float, float] | None = None,
    note: str = "",
) -> Any:
    """So many numbers as a dataclass's field, a tuple; an empty one where they may be left out."""
    known = Parameter(key, about, unit, usual=usual, count=count, optional=optional, note=note)
    return dataclasses.field(default=() if optional else MISSING, metadata={_METADATA: known})


def pairs(key: str, about: str, unit: str, *, note: str = "") -> Any:
    """Pairs of numbers of one unit as a dataclass's field, a tuple of tuples."""
    known = Parameter(key, about, unit, note=note, pairs=True)
    return dataclasses.field(metadata={_METADATA: known})


def choice(key: str, about: str, options: tuple[str, ...], *, note: str = "") -> Any:
    """One of some texts as a dataclass's field; the first is the default."""
    known = Parameter(key, about, options=options, note=note)
    return dataclasses.field(default=options[0], metadata={_METADATA: known})


def fields(model: Any) -> dict[str, dataclasses.Field]:
    """Dataclass fields of a model, or of its class, that are parameters, by their key."""
    return {
        field.metadata[_METADATA].key: field
        for field in dataclasses.fields(model)
        if _METADATA in field.metadata
    }


def parameters(model: Any) -> dict[str, Parameter]:
    """Parameters of a model, or of its class, by their key."""
    return {key: field.metadata[_METADATA] for key, field in fields(model).items()}


def values(model: Any) -> dict[str, Any]:
    """Values of a model's parameters by their key."""
    return {key: getattr(model, field.name) for key, field in fields(model).items()}


def made(kind: Any, given: dict[str, Any]) -> Any:
    """A model of a class from values by key; what is not given has its default."""
    known = fields(kind)
    return kind(**{known[key].name: value for key, value in given.items()})


def check(model: Any) -> None:
    """For a model's ``__post_init__``.

    Raises:
        ValueError: a parameter is not finite or outside its range; the message names value and range.
    """
    for key, field in fields(model).items():
        known, value = field.metadata[_METADATA], getattr(model, field.name)
        if known.options:
            if value not in known.options:
                options = " or ".join(map(repr, known.options))
                raise ValueError(f"{field.name} = {value!r}: expected {options}")
        elif known.pairs:
            if any(len(pair) != 2 or not all(map(isfinite, pair)) for pair in value):
                raise ValueError(f"{key}: expected pairs of finite numbers")
        elif known.count:
            left_out = known.optional and not value
            if not left_out and (len(value) != known.count or not all(map(isfinite, value))):
                raise ValueError(f"{key} = {value!r}: expected {known.count} finite numbers")
        elif not (isfinite(value) and value in known.range):
            bounds = f" {known.range}" if str(known.range) else ""
            raise ValueError(f"{field.name} = {value!r} ({key}): expected a finite number{bounds}")
