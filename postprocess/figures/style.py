"""Style of all figures: type, sizes, colours, line styles; numbers, symbols and units as TeX and text."""

import re
import unicodedata
from collections.abc import Callable, Sequence
from functools import wraps
from textwrap import fill
from typing import Any, NamedTuple

import numpy as np

#: Widths of a column and of a page of most journals [in].
COLUMN, PAGE = 3.5, 7.0

#: Sizes of type [pt]; nothing is smaller than the last when printed.
TEXT, SMALL = 8.5, 7.5

#: Dots per inch of pictures made of pixels.
DPI = 300

#: Okabe and Ito's colours, told apart by colour-blind readers.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#999999")
MARKERS = ("o", "s", "^", "D", "v", "P", "X", "*")
LINES: tuple[Any, ...] = ("-", (0, (5, 1.5)), (0, (6, 1.5, 1, 1.5)), (0, (1.2, 1.2)), (0, (8, 2, 2, 2)))

GREY = "#777777"

_STYLE = {
    # Type as journals set it; shipped with matplotlib, its Greek included.
    "font.family": "STIXGeneral",
    "mathtext.fontset": "stix",
    "font.size": TEXT,
    "axes.titlesize": TEXT,
    "axes.labelsize": TEXT,
    "xtick.labelsize": SMALL,
    "ytick.labelsize": SMALL,
    "legend.fontsize": SMALL,
    "legend.frameon": False,
    "legend.handlelength": 2.6,
    "legend.borderpad": 0.2,
    "axes.linewidth": 0.6,
    "axes.axisbelow": True,
    "axes.titlelocation": "left",
    "axes.titlepad": 3.5,
    "axes.labelpad": 2.5,
    "xtick.direction": "in",
    "ytick.direction": "in",
    "xtick.top": True,
    "ytick.right": True,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.major.size": 2.5,
    "ytick.major.size": 2.5,
    "xtick.minor.size": 1.5,
    "ytick.minor.size": 1.5,
    "xtick.major.pad": 4.0,
    "ytick.major.pad": 2.5,
    "lines.linewidth": 1.0,
    "lines.markersize": 3.2,
    "lines.markeredgewidth": 0.6,
    "pdf.fonttype": 42,  # text stays text: journals ask for it
    "svg.fonttype": "path",  # pages are read where no such font is
    "svg.hashsalt": "galinx",
}


def _defaults() -> dict[str, Any]:
    """Matplotlib's own settings, without what somebody has set for other figures, as text by LaTeX."""
    import matplotlib  # a slow import, for nothing where texts alone are typeset

    return {key: value for key, value in matplotlib.rcParamsDefault.items() if "backend" not in key}


def styled(draw: Callable[..., Any]) -> Callable[..., Any]:
    """Decorator of what draws or saves: in this style, and none of it is left to whoever draws next."""

    @wraps(draw)
    def in_style(*arguments: Any, **options: Any) -> Any:
        from matplotlib import rc_context

        with rc_context({**_defaults(), **_STYLE}):
            return draw(*arguments, **options)

    return in_style


class Look(NamedTuple):
    """Look of one of several curves: colour, line and marker."""

    colour: Any
    line: Any
    marker: str


def looks(count: int, ordered: bool = False) -> list[Look]:
    """Looks of curves that are told apart, in print without colours, too.

    Args:
        count: how many.
        ordered: they follow a number, and so do their colours.
    """
    colours: Sequence[Any] = COLOURS
    if ordered and count > 3:
        from matplotlib import colormaps

        colours = colormaps["viridis"](np.linspace(0.0, 0.88, count)).tolist()
    return [
        Look(colours[n % len(colours)], LINES[n % len(LINES)], MARKERS[n % len(MARKERS)])
        for n in range(count)
    ]


#: Beyond these numbers are written with a power of ten.
_SMALL, _LARGE = 1e-3, 1e6

_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_LOWERED = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")


def number(value: float, digits: int = 4) -> str:
    """A number in TeX, without dollars: ``4.786 \\times 10^{-7}``."""
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


def plain(text: str) -> str:
    """Plain text of a text with formulas between dollars: μ_C = 4.786 × 10⁻⁷."""

    def greek(match: re.Match[str]) -> str:
        word = match[1]
        kind = "CAPITAL" if word[0].isupper() else "SMALL"
        name = {"lambda": "LAMDA"}.get(word.lower(), word.upper())
        try:
            return unicodedata.lookup(f"GREEK {kind} LETTER {name}")
        except KeyError:
            return word

    def formula(match: re.Match[str]) -> str:
        characters = match[1].replace(r"\times", "×").replace(r"\,", "\u202f")
        characters = re.sub(r"\^\{(-?\d+)\}", lambda power: power[1].translate(_RAISED), characters)
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
