"""What the figures of a result show."""

import re

import numpy as np
import pytest

from galinx.app.results.drawings import of_archive


def test_every_figure_shows_what_it_says(map_run):
    drawings = {drawing.name: drawing.figure for drawing in of_archive(map_run.data, map_run.scene)}
    assert list(drawings) == ["friction", "surface", "inside", "degrees", "mesh"]
    loop = drawings["friction"].axes[0].lines[0]
    assert loop.get_ydata()[0] == 0.0 and loop.get_ydata().max() == pytest.approx(
        map_run.data["states/f"].max(), abs=0.05
    )
    panels = drawings["surface"].axes
    assert len(panels) == 4  # two speeds, two stresses; the insets are their children
    *exact, markers = panels[0].lines[:4]  # beside, under and beside the punch
    assert [line.get_marker() for line in exact] == 3 * ["None"] and markers.get_marker() == "o"
    (inset,) = panels[0].child_axes
    places = [line.get_xdata()[0] for line in inset.lines[1:]]
    assert places == map_run.data["states/X_over_L"][:6].tolist()
    maps = [image for axis in drawings["inside"].axes for image in axis.images]
    assert len(maps) == 30  # five stresses; two speeds by closed form, finite elements, difference
    np.testing.assert_array_equal(
        maps[1].get_array(), map_run.data["interior/closed_form/sigma_YY"][0].reshape(20, 21)
    )
    degrees = [line for line in drawings["degrees"].axes[0].lines if line.get_marker() == "x"]
    assert degrees[0].get_ydata()[0] == map_run.data["states/fem/true_error"][:6].max()
    for figure in drawings.values():
        for axis in figure.axes:
            label = axis.get_xlabel() + axis.get_ylabel()
            assert not label or re.search(r"dimensionless|/a|sigma|\$f\$", label), label
