"""Figures that notebooks show."""

from io import BytesIO

from matplotlib.figure import Figure

from galinx.postprocess.figures.style import styled

#: Dots per inch on a screen.
_DPI = 110


def shown(figure: Figure) -> Figure:
    """The same figure, which says itself how it looks: notebooks know those of pyplot only."""
    figure._repr_png_ = lambda: _png(figure)  # type: ignore[attr-defined]
    return figure


@styled
def _png(figure: Figure) -> bytes:
    data = BytesIO()
    figure.savefig(data, format="png", dpi=_DPI)
    return data.getvalue()
