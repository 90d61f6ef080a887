"""Style of all figures: type, sizes, colours and line styles."""

from typing import Any, NamedTuple

import numpy as np
from matplotlib import colormaps, style
from matplotlib.colors import to_hex

#: Widths of a column and of a page of most journals, and the height of a page [in].
COLUMN, PAGE, TALLEST = 85.0 / 25.4, 170.0 / 25.4, 230.0 / 25.4

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
    "axes.titlepad": 2.5,
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


#: Decorator of what draws or saves: in this style, and none of it is left to whoever draws next. What
#: somebody has set for other figures, as text by LaTeX, is not for these.
styled = style.context(["default", _STYLE])


class Look(NamedTuple):
    """Look of one of several curves: colour by its name or as ``#0072B2``, line and marker."""

    colour: str
    line: Any
    marker: str


def looks(count: int, ordered: bool = False) -> list[Look]:
    """Looks of curves that are told apart, in print without colours, too.

    Args:
        count: how many.
        ordered: they follow a number, and so do their colours.
    """
    colours = COLOURS
    if ordered and count > 3:
        colours = tuple(map(to_hex, colormaps["viridis"](np.linspace(0.0, 0.88, count))))
    return [
        Look(colours[n % len(colours)], LINES[n % len(LINES)], MARKERS[n % len(MARKERS)])
        for n in range(count)
    ]
