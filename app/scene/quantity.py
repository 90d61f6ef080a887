"""What a quantity is as scenes write it: a number, and units with signs between them.

Nothing of it is evaluated: what is no such text is refused.
"""

import re
from dataclasses import dataclass

#: Characters that a quantity may have.
LONGEST = 200

_SUPERSCRIPTS = "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"
_PLAIN = str.maketrans(_SUPERSCRIPTS, "-0123456789")

_NUMBER = re.compile(r"\s*([-+]?(?:(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?|(?:nan|inf)\b))")
#: What a unit that divides begins with, where no other stands before it.
_ONE = re.compile(r"\s*1\s*(?=/)")
_FACTOR = re.compile(
    rf"\s*([*/]?)\s*(%|[^\W\d{_SUPERSCRIPTS}][^\W{_SUPERSCRIPTS}]*)"
    rf"(?:\s*(?:\*\*|\^)\s*([-+]?[0-9])(?![.\w])|(⁻?[{_SUPERSCRIPTS[1:]}]))?"
)

#: Names of units with their exponents, in the order in which they are written.
Units = tuple[tuple[str, int], ...]


@dataclass(frozen=True)
class Quantity:
    """A number with the product of powers of units that it counts; no units: it counts nothing."""

    number: float
    units: Units


def quantity(text: str) -> Quantity:
    """Read a quantity, as ``25000 1/m`` or ``7.86 g/mm^3``.

    Raises:
        ValueError: it is none.
    """
    found = _NUMBER.match(text) if len(text) <= LONGEST else None
    if not found:
        raise ValueError("no number")
    return Quantity(float(found[1]), units(text[found.end() :]))


def units(text: str) -> Units:
    """Read a product of powers of units; exponents have one digit.

    Raises:
        ValueError: it is none.
    """
    found: list[tuple[str, int]] = []
    one = _ONE.match(text)
    at, end = one.end() if one else 0, len(text.rstrip())
    while at < end:
        factor = _FACTOR.match(text, at)
        # Only what comes first needs no sign.
        if not factor or (bool(found) != bool(factor[1]) and factor[1] != "/"):
            raise ValueError("no product of units")
        sign = -1 if factor[1] == "/" else 1
        found.append((factor[2], sign * int((factor[3] or factor[4] or "1").translate(_PLAIN))))
        at = factor.end()
    return tuple(found)
