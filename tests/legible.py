"""Figures of results, and what makes one legible, measured on the figure as it is printed."""

from itertools import combinations

import numpy as np
from matplotlib.text import Text

from galinx.app.figures.archive import of_archive
from galinx.app.figures.choice import Choice

#: Least size of type [pt].
LEAST = 7.0


def drawn(run, name, **options):
    """The figure of a result by that name."""
    (drawing,) = of_archive(run.data, run.scene, Choice(figures=(name,), **options))
    return drawing


def curves(axis):
    """Lines of a panel that are drawn through more than two places."""
    return [line for line in axis.lines if len(np.unique(line.get_xdata())) > 2]


def faults(figure):
    """What a reader of the printed figure could not read, in words."""
    canvas = figure.canvas
    canvas.draw()
    renderer = canvas.get_renderer()
    beyond = _beyond(figure)
    texts = [
        text
        for text in figure.findobj(Text)
        if text.get_visible() and text.get_text().strip() and id(text) not in beyond
    ]
    for text in texts:
        if text.get_fontsize() < LEAST:
            yield f"{text.get_text()!r} has {text.get_fontsize()} pt"
    boxes = [(text.get_text(), text.get_window_extent(renderer)) for text in texts]
    sheet = figure.bbox.padded(1.5)
    for words, box in boxes:
        if not (sheet.x0 <= box.x0 and box.x1 <= sheet.x1 and sheet.y0 <= box.y0 and box.y1 <= sheet.y1):
            yield f"{words!r} is cut off at {np.round(box.extents)} of {figure.bbox.extents}"
    for (one, first), (other, second) in combinations(boxes, 2):
        if _overlap(first.padded(-1.0), second.padded(-1.0)):
            yield f"{one!r} lies on {other!r}"
    yield from _under_legends(figure, renderer)


def legible(drawings):
    """Assert that no figure has a fault."""
    found = [f"{drawing.name}: {fault}" for drawing in drawings for fault in faults(drawing.figure)]
    assert not found, "\n".join(found)


def _beyond(figure):
    """Labels of ticks that lie beyond the limits of their axis, which are not drawn."""
    found = set()
    for axes in figure.findobj(lambda artist: hasattr(artist, "xaxis")):
        for axis in (axes.xaxis, axes.yaxis):
            low, high = sorted(axis.get_view_interval())
            slack = 1e-9 * (high - low)
            for tick in [*axis.get_major_ticks(), *axis.get_minor_ticks()]:
                if not low - slack <= tick.get_loc() <= high + slack:
                    found |= {id(tick.label1), id(tick.label2)}
    return found


def _overlap(one, other):
    return one.x0 < other.x1 and other.x0 < one.x1 and one.y0 < other.y1 and other.y0 < one.y1


def _under_legends(figure, renderer):
    legends = [*figure.legends, *(axes.get_legend() for axes in figure.axes if axes.get_legend())]
    boxes = [legend.get_window_extent(renderer) for legend in legends]
    for axes in figure.axes:
        for line in axes.lines:
            points = line.get_transform().transform(np.column_stack(line.get_data(orig=False)))
            seen = points[_inside(axes.bbox, points)]
            for box in boxes:
                if _inside(box, seen).any():
                    yield f"a box lies on the curve {line.get_label()!r}"
    for box in boxes:
        for axes in figure.axes:
            if _overlap(box, axes.bbox):
                yield "a legend lies on a panel"


def _inside(box, points):
    x, y = np.reshape(points, (-1, 2)).T
    return (box.x0 <= x) & (x <= box.x1) & (box.y0 <= y) & (y <= box.y1)
