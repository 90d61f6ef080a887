"""Output that pages quote, held against what is printed: every word, and every number by its notation.

- Without a decimal point a number counts or names something: the same text.
- Up to four digits: the same text, too. Another machine changes results by 1e-8, which these do not show.
- With five digits or more that change may tip the rounding over: one unit of the last digit quoted.
- Errors, which the program prints with two digits as in 2.2e-08 and nothing else so, are small
  differences of large numbers: their digits are those of a mesh generator and a linear solver. A factor
  of three; below 1e-11 they are rounding errors added up, of which no digit lasts.
- Seconds and bytes are the machine's: any number.
"""

import re
from decimal import Decimal
from textwrap import dedent

FACTOR = 3
ROUNDING = Decimal("1e-11")
#: Fewest digits of a result that may tip over.
DIGITS = 5

_NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
_ERROR = re.compile(r"\d\.\de[-+]\d\d")
#: Lines of time and cost with those that go on with them, and numbers with these units.
_MEASURED = re.compile(rf"^(?:time:|cost ).*(?:\n .*)*|{_NUMBER.pattern}(?= (?:s|MB|GB)\b)", re.MULTILINE)


def fault(quote, output):
    """How a piece that a page quotes differs from what is printed; None for not at all.

    Of several places with these words the one with most of the numbers counts. Lines may break elsewhere.
    """
    quote, output = _plain(quote), _plain(output)
    numbers = _NUMBER.findall(quote)
    pattern = f"({_NUMBER.pattern})".join(map(re.escape, _NUMBER.split(quote)))
    places = [
        [pair for pair in zip(numbers, place.groups(), strict=True) if not same(*pair)]
        for place in re.finditer(rf"(?<!\S)(?={pattern})", output)
    ]
    if not places:
        return "what is not printed"
    return ", ".join(f"{one} for {other}" for one, other in min(places, key=len)) or None


def same(quoted, printed):
    """Is this the printed number, as far as it is the same everywhere?"""
    if quoted == printed:
        return True
    one, other = Decimal(quoted), Decimal(printed)
    if _ERROR.fullmatch(quoted) and _ERROR.fullmatch(printed):
        return max(one, other) < max(ROUNDING, FACTOR * min(one, other))
    shown = one.as_tuple()
    rounded = shown.exponent < 0 and len(shown.digits) >= DIGITS
    return rounded and abs(one - other) <= Decimal(1).scaleb(shown.exponent)


def _plain(text):
    """In one line, without what is measured."""
    masked = _MEASURED.sub(lambda found: _NUMBER.sub("…", found[0]), dedent(text))
    return " ".join(masked.split())
