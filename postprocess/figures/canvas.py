"""Style of all figures, and how they become files or text."""

from base64 import b64encode
from io import BytesIO
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot as plt
from matplotlib.figure import Figure

#: Okabe and Ito's colours, told apart by colour-blind readers.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#999999")
MARKERS = ("o", "s", "^", "D", "v", "P", "X", "*")

plt.rcParams.update(
    {
        "font.size": 9,
        "axes.grid": True,
        "grid.alpha": 0.25,
        "lines.linewidth": 1.1,
        "pdf.fonttype": 42,  # text stays text: journals ask for it
        "svg.hashsalt": "galinx",
    }
)


def save(figure: Figure, folder: Path, name: str) -> list[Path]:
    """Write a figure as PDF and PNG and close it."""
    paths = [folder / f"{name}.pdf", folder / f"{name}.png"]
    for path in paths:
        figure.savefig(path, dpi=160)
    plt.close(figure)
    return paths


def in_a_page(figure: Figure, pixels: bool) -> str:
    """A figure as a data URI for a page; closes it.

    Args:
        figure: what to show.
        pixels: as PNG, for pictures with too many elements to draw each; else as SVG, without ground.
    """
    data = BytesIO()
    if pixels:
        figure.savefig(data, format="png", dpi=130)
    else:
        figure.savefig(data, format="svg", transparent=True, metadata={"Date": None})
    plt.close(figure)
    kind = "png" if pixels else "svg+xml"
    return f"data:image/{kind};base64,{b64encode(data.getvalue()).decode()}"
