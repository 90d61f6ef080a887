"""Style of all figures, and how they become files or text."""

from base64 import b64encode
from collections.abc import Iterable
from io import BytesIO
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot as plt
from matplotlib.figure import Figure

from galinx.postprocess.target import PDF, PNG, Folder

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


#: Ending, kind of file, and what in one says who made it.
_SAVED = (("pdf", PDF, "Creator"), ("png", PNG, "Software"))


def save(figures: Iterable[tuple[str, Figure]], folder: Folder) -> list[Path]:
    """Write figures as PDF and PNG and close them; none where one of them may not be written.

    Args:
        figures: by name.
        folder: where they go.

    Raises:
        Occupied: something is there that may not be replaced.
        UnwritableArchive: the file system refused.
    """
    drawn = []
    for name, figure in figures:
        for ending, kind, says in _SAVED:
            target, data = folder.target(f"{name}.{ending}", kind), BytesIO()
            # In memory: matplotlib leaves half of a figure on a full disk.
            figure.savefig(data, format=ending, dpi=160, metadata={says: "galinx"})
            drawn.append((target, data.getvalue()))
        plt.close(figure)
    for target, content in drawn:
        target.write(content)
    return [target.path for target, _ in drawn]


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
