"""What the figures of a result show, and whether they can be read in print."""

import numpy as np
import pytest
from legible import LEAST, faults, legible
from matplotlib.colors import LogNorm, to_rgba
from matplotlib.figure import Figure
from matplotlib.text import Annotation
from support import THOROUGH, computed, kept

from galinx.app.figures.choice import size
from galinx.app.figures.files import content
from galinx.app.figures.render import MARKERS, Curve, Panel, Size, TooSmall, render
from galinx.app.figures.style import looks


@pytest.fixture(scope="module")
def drawings(map_run):
    """Every figure of one result, by name."""
    return {d.name: d for d in map_run.drawings(dimensionless=True, figures=("all",))}


def test_every_figure_shows_what_it_says(map_run, drawings):
    assert list(drawings) == ["surface", "inside", "friction", "degrees", "mesh"]
    assert [d.name for d in map_run.drawings()] == ["surface", "inside", "friction"]
    strokes = [line for line in drawings["friction"].figure.axes[0].lines if len(line.get_xdata()) > 2]
    f = np.concatenate([line.get_ydata() for line in strokes])
    assert f[0] == 0.0 and f.max() == pytest.approx(map_run.data["states/f"].max(), abs=0.05)
    panels = drawings["surface"].figure.axes
    assert len(panels) == 4  # two speeds, two stresses
    maps = [image for axis in drawings["inside"].figure.axes for image in axis.images]
    # Five stresses at two speeds once each; how far both methods are apart is said below.
    assert len(maps) == 10 and "Finite elements differ by at most" in drawings["inside"].caption
    np.testing.assert_array_equal(
        maps[4].get_array(), map_run.data["interior/closed_form/sigma_YY"][1].reshape(20, 21)
    )
    degrees = [line for line in drawings["degrees"].figure.axes[0].lines if line.get_marker() == "x"]
    assert degrees[0].get_ydata()[0] == map_run.data["states/fem/true_error"][:6].max()


#: Scenes of all kinds of figures, by the quickest methods; the first one is drawn over a page, too.
KINDS = (
    "laws", "map", "high_speed", "cylinder", "coating", "slider", "from rest", "minor_loops",
    "velocity_steps", "parameter_study",
    *("fibres", "shoulders", "fig6", "sinusoidal", "own_material", "cylinder_on_steel") * THOROUGH,
)  # fmt: skip


@pytest.mark.parametrize("name", KINDS)
def test_figures_of_every_kind_fit_a_column_and_a_page(name):
    for width in ("85mm", "170mm") if THOROUGH or name in KINDS[:1] else ("85mm",):
        shown = list(kept(name).drawings(size=size(width), figures=("all",)))
        legible(shown)
        assert max(drawing.figure.get_figheight() for drawing in shown) * 25.4 <= 230.0 + 1e-6


def test_what_is_not_legible_is_found():
    figure = Figure((3.5, 2.0))
    axis = figure.subplots()
    axis.plot([0.0, 1.0], [0.0, 1.0], label="curve")
    axis.plot([0.0, 0.5, 1.0], [1.0, 0.5, 0.0], label="other")
    axis.legend(loc="center")
    axis.set_xlabel("too small", fontsize=LEAST - 0.5)
    axis.set_ylabel("an axis whose label is longer than the paper is high", fontsize=12)
    axis.text(0.2, 0.2, "one"), axis.text(0.2, 0.2, "two")
    said = "\n".join(faults(_drawable(figure)))
    for words in ("6.5 pt", "is cut off", "'one' lies on 'two'", "on the curve", "on a panel"):
        assert words in said


def _drawable(figure):
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    FigureCanvasAgg(figure)
    return figure


def test_strokes_are_told_apart_and_have_a_direction(drawings):
    figure = drawings["friction"].figure
    axis, (legend,) = figure.axes[0], figure.legends
    assert [text.get_text() for text in legend.get_texts()] == ["FM1", "BM1", "FM2"]
    strokes = [line for line in axis.lines if len(line.get_xdata()) > 2]
    assert len({line.get_color() for line in strokes}) == len(strokes) == 3
    assert len({str(line._unscaled_dash_pattern) for line in strokes}) == 3
    arrows = [text for text in axis.texts if isinstance(text, Annotation)]
    ahead = {arrow.arrow_patch.get_edgecolor(): arrow.xy[0] > arrow.xyann[0] for arrow in arrows}
    assert [ahead[to_rgba(line.get_color())] for line in strokes] == [True, False, True]


def test_what_somebody_has_set_for_other_figures_is_not_for_these(monkeypatch):
    """Texts by LaTeX, which may not be there, among it."""
    import matplotlib

    def drawn():
        return content(render([_line()]), "svg")

    plain = drawn()
    others = {"text.usetex": True, "axes.facecolor": "red", "axes.grid": True, "savefig.bbox": "tight"}
    for key, value in others.items():
        monkeypatch.setitem(matplotlib.rcParams, key, value)
    assert drawn() == plain


def _line(**options):
    x = np.linspace(0.0, 1.0, 101)
    return Panel("position", "number", curves=[Curve(x, x, looks(1)[0], "curve")], **options)


def test_panels_are_as_large_as_there_is_room():
    """Panels fill the width, are alike, and no taller than a page leaves them."""
    for count, size_ in ((6, Size(7.0)), (6, Size(3.35)), (12, Size(3.35)), (2, Size(5.0, 4.0))):
        figure = render([_line(title=f"panel {n}") for n in range(count)], size_)
        assert not [*faults(figure)]
        places = [axis.get_position() for axis in figure.axes]
        assert max(place.x1 for place in places) * size_.width == pytest.approx(size_.width, abs=0.15)
        assert len({round(place.width, 9) for place in places}) == 1
        assert figure.get_figheight() <= (size_.height or 230.0 / 25.4) + 1e-9
    with pytest.raises(TooSmall, match=r"expected at least \d\.\d in x \d\.\d in for 2 x 3 panels"):
        render([_line()] * 6, Size(2.0, 1.0), columns=3)
    x, many = np.linspace(0.0, 1.0, 11), looks(90)
    curves = [Curve(x, x, look, f"the curve of state {i}, at some speed") for i, look in enumerate(many)]
    with pytest.raises(TooSmall, match="its legend takes most of the page; choose fewer curves"):
        render([Panel("position", "number", curves=curves)] * 2, Size(3.35))


def test_markers_along_a_logarithmic_axis_are_as_far_apart_as_along_another():
    x = np.geomspace(1.0, 1e3, 301)
    figure = render([Panel("x", "y", log="x", curves=[Curve(x, x, looks(1)[0], form=MARKERS)])])
    shown = figure.axes[0].lines[0].get_xdata()
    assert len(shown) > 8 and np.ptp(np.diff(np.log(shown))) < 0.05


def test_maps_over_numbers_that_are_apart_by_ratios_have_logarithmic_axes_and_colours():
    """Hertz's largest pressure goes with √(N/R), which is straight there."""
    scene = """
        solid = { material = "steel" }
        friction = { mu = 0.0 }
        motion = { c = 0.0 }
        solve = { methods = ["closed_form"] }
        output = { quantities = ["sif"] }
        [punch]
        profile = "parabolic"
        radius = { from = "1 mm", to = "10 m", number = 5, spacing = "log" }
        load = { from = "10 N/mm", to = "1000 N/mm", number = 5, spacing = "log" }
    """
    result = computed(scene)
    drawing, over_a = (
        *result.drawings(figures=("parameters",)),
        *result.drawings(figures=("parameters",), dimensionless=True),
    )
    assert "over a = " in over_a.caption and "over a = " not in drawing.caption
    axis = drawing.figure.axes[0]
    assert (axis.get_xscale(), axis.get_yscale()) == ("log", "log")
    assert {"$100$", "$1000$"} <= {text.get_text() for text in axis.texts if text.get_visible()}
    (image,) = (one for one in axis.collections if one.get_array() is not None and one.norm.vmin)
    assert isinstance(image.norm, LogNorm) and not [*faults(drawing.figure)]
    assert "Between the states it is interpolated; dots are states." in drawing.caption
    assert "radius R (m)" in drawing.caption and "load" in drawing.caption
    p = np.reshape(image.get_array(), (65, 65))
    N, R = np.geomspace(1e4, 1e6, 65)[:, None], np.geomspace(1e-3, 10.0, 65)
    shape = np.sqrt(N / R)
    assert shape.shape == p.shape
    np.testing.assert_allclose(p / p[0, 0], shape / shape[0, 0], rtol=1e-6)


def test_maps_hold_the_numbers_of_states_that_are_not_evenly_apart():
    scene = """
        solid = { material = "steel" }
        friction = { mu = [0.0, 0.1, 0.15, 0.3, 0.5] }
        motion = { c = 0.0 }
        solve = { methods = ["closed_form"] }
        output = { quantities = ["yield"] }
        [punch]
        profile = "parabolic"
        radius = ["2 mm", "3 mm", "5 mm", "8 mm", "9 mm"]
        load = "100 N/mm"
    """
    result = computed(scene)
    f, R = (np.unique(result.data[f"states/{name}"]) for name in ("f", "punch.radius"))
    (axis,) = result.figure("parameters", y=("von_mises",)).axes
    (image,) = (one for one in axis.collections if one.get_array() is not None and one.norm.vmin)
    scaled = result.units().stress
    states = np.ravel(scaled.factor) * result.data["states/closed_form/von_mises"]
    order = np.lexsort([result.data["states/punch.radius"], result.data["states/f"]])
    drawn = np.reshape(image.get_array(), (65, 65))[::16, ::16]
    np.testing.assert_allclose(drawn.ravel(), states[order], rtol=1e-12)
    (dots,) = (line for line in axis.lines if line.get_marker() == ".")
    np.testing.assert_allclose(dots.get_xydata(), [[1e3 * x, y] for y in f for x in R], rtol=1e-12)
