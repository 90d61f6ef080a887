"""Texts that can be archived and shown; numbers, symbols and units as TeX and as plain text."""

import re
import unicodedata
from math import floor, isfinite, isnan, log10
from textwrap import fill

#: Control characters, what breaks lines or changes the direction of writing, and halves of characters,
#: as names of files have for bytes that are not UTF-8.
UNSEEN = re.compile("[\0-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069\ud800-\udfff]")


def unseen(text: str) -> str:
    """For a message, where a text has its first control character; "" if it has none."""
    if not (first := UNSEEN.search(text)):
        return ""
    return f"character {first.start() + 1} is the control character U+{ord(first[0]):04X}, expected none"


def counted(count: int, thing: str, things: str = "") -> str:
    """A number of things, as one says it: "1 state", "3 states"."""
    return f"{count} {thing if count == 1 else things or thing + 's'}"


def bytes_in_words(count: float, digits: int = 3) -> str:
    """A number of bytes with so many digits, as ``1.2 GB``."""
    for unit in ("bytes", "kB", "MB"):
        if count < 999.5:
            return f"{float(f'{count:.{digits}g}'):g} {unit}"
        count /= 1000.0
    return f"{float(f'{count:.{digits}g}'):g} GB"


#: Beyond these numbers are written with a power of ten.
_SMALL, _LARGE = 1e-3, 1e6

_GREEK = {"α": "alpha", "β": "beta"}
_RAISED = str.maketrans("-0123456789()", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹⁽⁾")
_LOWERED = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")


def number(value: float, digits: int = 4) -> str:
    """A number in TeX, without dollars: ``4.786 \\times 10^{-7}``."""
    if not isfinite(value):
        return r"\mathrm{NaN}" if isnan(value) else r"\infty" if value > 0 else r"-\infty"
    shown = f"{value:.{digits - 1}e}"
    mantissa, exponent = shown.split("e")
    if float(shown) == 0.0 or _SMALL <= abs(float(shown)) < _LARGE:
        whole, dot, rest = f"{float(shown):f}".rstrip("0").rstrip(".").partition(".")
        if len(whole.lstrip("-")) > 4:
            whole = f"{int(whole):,}".replace(",", r"\,")
        return whole + dot + rest
    mantissa = mantissa.rstrip("0").rstrip(".")
    power = f"10^{{{int(exponent)}}}"
    return {"1": power, "-1": f"-{power}"}.get(mantissa, rf"{mantissa} \times {power}")


def unit(name: str) -> str:
    """Unit in TeX, with the space before it; nothing for what has none."""
    if name in ("1", "", "none"):
        return ""
    if "(" in name:  # a quantity, as N/(2a) is
        return rf"\,{name}"
    over = re.fullmatch(r"1/(\w+)", name)
    return rf"\,\mathrm{{{over[1]}^{{-1}}}}" if over else rf"\,\mathrm{{{name}}}"


def in_tex(name: str) -> str:
    """Unit with its exponent in TeX, for an axis: ``MPa·m^(-β)`` as ``MPa·m$^{-\\beta}$``."""
    name = re.sub(r"\^(-?\d+(?:\.\d+)?)", r"$^{\1}$", name)
    return re.sub(r"\^\(-([αβ])\)", lambda of: f"$^{{-\\{_GREEK[of[1]]}}}$", name)


def plain(text: str) -> str:
    """Plain text of a text with formulas between dollars: μ_C = 4.786 × 10⁻⁷."""

    def greek(match: re.Match[str]) -> str:
        word = match[1]
        if word == "vartheta":  # Unicode calls it a symbol
            return "ϑ"
        kind = "CAPITAL" if word[0].isupper() else "SMALL"
        name = {"lambda": "LAMDA"}.get(word.lower(), word.upper())
        try:
            return unicodedata.lookup(f"GREEK {kind} LETTER {name}")
        except KeyError:
            return word

    def formula(match: re.Match[str]) -> str:
        characters = match[1].replace(r"\times", "×").replace(r"\,", "\u202f")
        raised = r"\^\{(-?\d+|\(\d+\))\}"
        characters = re.sub(raised, lambda power: power[1].translate(_RAISED), characters)
        characters = re.sub(r"\\(?:mathrm|mathit|text)\{((?:[^{}]|\{[^{}]*\})*)\}", r"\1", characters)
        characters = re.sub(r"\\([A-Za-z]+)", greek, characters)
        characters = re.sub(r"_\{?(\d)\}?", lambda index: index[1].translate(_LOWERED), characters)
        return characters.replace(r"\_", "_").replace("{", "").replace("}", "")

    return re.sub(r"\$([^$]*)\$", formula, text)


def folded(text: str, width: int) -> str:
    """Text in lines of at most so many characters; formulas count as they are shown and stay whole."""
    pieces = re.findall(r"\$[^$]*\$", text)
    marks = [f"\0{n}".ljust(max(3, len(plain(piece))), "\0") for n, piece in enumerate(pieces)]
    for piece, mark in zip(pieces, marks):
        text = text.replace(piece, mark, 1)
    text = fill(text, width, break_long_words=False, break_on_hyphens=False)
    for piece, mark in zip(pieces, marks):
        text = text.replace(mark, piece, 1)
    return text


def significant(value: float, digits: int = 4) -> str:
    """A number with so many significant digits: 1206, 0.03125, 1.2e-07; "" for NaN."""
    if value != value:
        return ""
    rounded = float(f"{value:.{digits - 1}e}")
    return f"{rounded:.0f}" if 10.0**digits <= abs(rounded) < 1e7 else f"{rounded:.{digits}g}"


#: Prefixes of units, and the position of the empty one.
_PREFIXES, _MIDDLE = "pnµm kMGT", 4


def with_prefix(value: float, unit: str, digits: int = 6) -> str:
    """Number in an SI unit with the prefix that suits it: 113.8 GPa, 5 mm."""
    if value == 0.0:
        return f"0 {unit}"
    size = floor(log10(abs(float(f"{value:.{digits - 1}e}"))))
    thousands = min(max(size // 3, -_MIDDLE), len(_PREFIXES) - 1 - _MIDDLE)
    prefix = _PREFIXES[thousands + _MIDDLE].strip()
    return f"{significant(value / 1000.0**thousands, digits)} {prefix}{unit}".replace("-", "−")
