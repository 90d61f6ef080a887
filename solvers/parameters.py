"""Parameters of physical models: dataclass fields with a key, a unit, a range and a meaning.

Sections of scenes, columns of the states, the schema and the pages of documentation are made from them.
"""

import dataclasses
from dataclasses import MISSING, dataclass
from typing import Any

import numpy as np

_METADATA = "galinx parameter"


@dataclass(frozen=True)
class Range:
    """Range of a number.

    Attributes:
        above, at_least, below, at_most: bounds; None for no bound.
        otherwise: what is given in place of a number out of range, in a few words; "" for nothing.
    """

    above: float | None = None
    at_least: float | None = None
    below: float | None = None
    at_most: float | None = None
    otherwise: str = ""

    def __contains__(self, value: Any) -> bool:
        """Return True if a number, or every number of an array, lies in the range."""
        return bool(
            (self.above is None or np.all(value > self.above))
            and (self.at_least is None or np.all(value >= self.at_least))
            and (self.below is None or np.all(value < self.below))
            and (self.at_most is None or np.all(value <= self.at_most))
        )

    def __or__(self, other: "Range") -> "Range":
        """Least range that holds the numbers of both, of ranges with lower bounds of one kind or not."""
        if self == other:
            return self
        lows = [self.above, self.at_least, other.above, other.at_least]
        low = None if lows.count(None) > 2 else min(bound for bound in lows if bound is not None)
        return Range(at_least=low)

    def __str__(self) -> str:
        signs = {">": self.above, ">=": self.at_least, "<": self.below, "<=": self.at_most}
        bounds = ", ".join(f"{sign} {bound:g}" for sign, bound in signs.items() if bound is not None)
        return bounds + f"; {self.otherwise}" * bool(self.otherwise)


@dataclass(frozen=True)
class Parameter:
    """Description of a parameter.

    Attributes:
        key: name in scenes and archives.
        about: meaning, in a few words.
        unit: SI, "" for dimensionless.
        symbol: as formulas write it, in LaTeX without dollars.
        range: range of its value.
        usual: usual range; a value beyond it may be in another unit than meant.
        options: texts to choose from; none for a number.
        count: length of a tuple of numbers, 0 for one number.
        columns: units of the columns of a table of numbers; none for anything else.
        measured: numbers of the columns that a fit to measurements determines; the others are places.
        optional: True if the numbers may be left out.
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
    columns: tuple[str, ...] = ()
    measured: tuple[int, ...] = ()
    optional: bool = False
    note: str = ""

    @property
    def single(self) -> bool:
        """True if the parameter is one number or one text."""
        return not self.count and not self.columns


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
    """Field of a dataclass that is a number; ``bounds`` are those of :class:`Range`."""
    shown = symbol or rf"\mathrm{{{key}}}".replace("_", r"\_")
    description = Parameter(key, about, unit, shown, Range(**bounds), usual, note=note)
    return dataclasses.field(default=default, metadata={_METADATA: description})


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
    """Field of a dataclass that is a tuple of ``count`` numbers; empty if optional and left out."""
    description = Parameter(key, about, unit, usual=usual, count=count, optional=optional, note=note)
    return dataclasses.field(default=() if optional else MISSING, metadata={_METADATA: description})


def rows(
    key: str,
    about: str,
    columns: tuple[str, ...],
    *,
    measured: tuple[int, ...] = (),
    optional: bool = False,
    note: str = "",
) -> Any:
    """Field of a dataclass that is a table of numbers, a tuple of rows; ``columns`` are their units.

    The table is empty if it is optional and left out.
    """
    description = Parameter(key, about, columns=columns, measured=measured, optional=optional, note=note)
    return dataclasses.field(default=() if optional else MISSING, metadata={_METADATA: description})


def choice(key: str, about: str, options: tuple[str, ...], *, note: str = "") -> Any:
    """Field of a dataclass that is one of several texts; the first is the default."""
    description = Parameter(key, about, options=options, note=note)
    return dataclasses.field(default=options[0], metadata={_METADATA: description})


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


def build_model(kind: Any, given: dict[str, Any]) -> Any:
    """Model of a class from values by key; parameters without a value have their default."""
    fields_of_kind = fields(kind)
    return kind(**{fields_of_kind[key].name: value for key, value in given.items()})


def check(model: Any) -> None:
    """Check the values of a model's parameters, in its ``__post_init__``.

    Raises:
        ValueError: a parameter is not finite or outside its range; the message names value and range.
    """
    for key, field in fields(model).items():
        expected, value = field.metadata[_METADATA], getattr(model, field.name)
        if expected.options:
            if not set(np.ravel(value).tolist()) <= set(expected.options):
                options = " or ".join(map(repr, expected.options))
                raise ValueError(f"{field.name} = {value!r}: expected {options}")
        elif expected.columns:
            _check_rows(key, expected, value)
        elif expected.count:
            left_out = expected.optional and not value
            if not left_out and (len(value) != expected.count or not np.isfinite(value).all()):
                raise ValueError(f"{key} = {value!r}: expected {expected.count} finite numbers")
        elif not (np.isfinite(value).all() and value in expected.range):
            bounds = f" {expected.range}" if str(expected.range) else ""
            raise ValueError(f"{field.name} = {value!r} ({key}): expected a finite number{bounds}")


def check_gives(model: Any, function: str, shape: tuple[int, ...], *given: Any) -> None:
    """Check that a function of a model gives numbers.

    Args:
        model: a model, perhaps a user's own.
        function: its name.
        shape: of the array that it should give, () for a number.
        given: its arguments.

    Raises:
        ValueError: it gives something else, as None where ``return`` is missing.
    """
    with np.errstate(all="ignore"):
        answer = getattr(model, function)(*given)
    values = np.asarray(answer)
    listed = isinstance(answer, (list, tuple))
    if listed or values.shape != shape or values.dtype.kind not in "fiu":
        text = " ".join(str(values).split())[:80]
        raise ValueError(
            f"{type(model).__name__}.{function} gives {text}, {'a list' if listed else 'of shape'} "
            f"{values.shape}, expected an array of numbers of shape {shape}"
        )


def _check_rows(key: str, expected: Parameter, value: Any) -> None:
    if expected.optional and not len(value):
        return
    wide = len(expected.columns)
    if isinstance(value, np.ndarray):  # of many models at once
        wrong = value.shape[-1] != wide
    else:
        wrong = not len(value) or any(len(row) != wide for row in value)
    if wrong or not np.isfinite(value).all():
        raise ValueError(f"{key} = {value!r}: expected rows of {wide} finite numbers")
