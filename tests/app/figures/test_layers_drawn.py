"""Figures of layered half-planes: stresses along interfaces, thresholds of flutter over the angle."""

import numpy as np
import pytest
from legible import curves, drawn
from support import computed, of_sections

from galinx import compute
from galinx.app.figures import waves
from galinx.app.figures.choice import size
from galinx.app.figures.stresses import Along, Shown, surface_panel
from galinx.app.figures.style import looks

MAP = {"output.map": {"X": [-2.0, 2.0, 21], "Y": [-2.0, -0.1, 20]}}
QUANTITIES = {"output.quantities": ["sif", "surface", "interfaces", "interior"]}


@pytest.fixture(scope="module")
def coated():
    """Three frictions on one coating."""
    return computed("coating", MAP | QUANTITIES)


def test_curves_are_what_the_archive_holds_on_both_sides(coated):
    drawing = drawn(coated, "interfaces")
    normal, shear, in_plane = drawing.figure.axes
    X = coated.data["interfaces/X_over_a"]
    rows = [(normal, "sigma_YY"), (shear, "sigma_XY"), (in_plane, "sigma_XX_above")]
    for axis, name in rows:
        half = axis.get_xlim()[1]
        seen = np.abs(X) <= half
        for state, line in enumerate(curves(axis)[:3]):
            held = coated.data[f"interfaces/sie/{name}"][state, 0]
            assert np.array_equal(line.get_ydata(), held[seen])
            assert np.array_equal(line.get_xdata(), X[seen])
    below = curves(in_plane)[3:]
    assert len(below) == 3
    assert all(
        one.get_color() == other.get_color() and one.get_linestyle() != other.get_linestyle()
        for one, other in zip(curves(in_plane), below)
    )
    assert len({line.get_color() for line in below}) == 3
    assert "jumps" in drawing.caption and not drawing.left_out


def test_finite_elements_are_markers_and_only_some_of_many_interfaces_are_shown():
    layer = {"thickness": "0.3 mm", "nu": 0.3, "rho": 1200}
    run = computed("coating", {
        "layer": [layer | {"E": f"{E} GPa"} for E in (7.5, 5, 4, 6)],
        "friction.mu_c": 0.4, "solve": {"methods": ["sie", "fem"], "tolerance": 1e-2},
        "output.quantities": ["interfaces"],
    })  # fmt: skip
    drawing = drawn(run, "interfaces")
    axes = np.reshape(drawing.figure.axes, (3, -1))
    assert axes.shape[1] == 3
    assert "3 of 4 interfaces" in drawing.caption
    line, *rest = axes[0, 0].lines[1:]
    markers = next(one for one in rest if one.get_marker() != "None")
    at = np.searchsorted(line.get_xdata(), markers.get_xdata())
    inside = np.abs(markers.get_xdata()) < line.get_xdata()[-1]
    off = np.abs(markers.get_ydata() - line.get_ydata()[np.minimum(at, len(line.get_xdata()) - 1)])
    assert inside.any() and off[inside].max() < 1e-2
    wide = drawn(run, "interfaces", size=size("10in"))
    assert np.reshape(wide.figure.axes, (3, -1)).shape[1] == 4


def test_flutter_is_drawn_over_the_angle_of_a_solid_with_axes(monkeypatch):
    """Along and across the fibres both signs have one threshold; turned by -θ they change places."""
    monkeypatch.setattr(waves, "_ANGLES", np.linspace(-90.0, 90.0, 5))
    result = computed("cylinder", {
        "solid.material": "carbon-epoxy", "solve.methods": ["closed_form"], "output.map": None,
        "output.quantities": ["sif"], "motion.c": [0.0],
    })  # fmt: skip
    (drawing,) = result.drawings(figures=("flutter",))
    values = [line.get_ydata() for line in drawing.figure.axes[0].lines]
    positive, negative = (y for y in values if len(y) == 5)
    np.testing.assert_allclose(positive, negative[::-1], rtol=1e-6)
    np.testing.assert_allclose([positive[2], positive[0]], [2.689, 0.372], atol=1e-3)
    assert "flutter" not in [drawn.name for drawn in result.drawings(figures=("all",))]


def test_a_solid_whose_stress_along_Z_is_not_known_has_no_map_of_von_mises():
    stiffness = [200e9, 80e9, 10e9, 180e9, 5e9, 70e9]
    solid = {"kind": "anisotropic", "rho": 7800, "stiffness": stiffness}
    scene = MAP | {"output.quantities": ["interior"], "solve.methods": ["closed_form"]}
    result = computed(changes=scene | {"solid": solid, "motion.c": [0.3]})
    labels = [panel.map.label for panel in drawn(result, "inside").figure.panels]
    assert sum("sigma" in label for label in labels) == 3 and not any("Mises" in text for text in labels)


def test_maps_show_where_each_layer_yields_and_its_interface_in_every_state():
    """Over its own strength; titles name what is swept, and of one state of a sweep as well."""
    result = computed("coating", {
        "layer": [{"material": "TiN", "thickness": ["5 µm", "20 µm"], "yield_strength": "0.9 GPa"}],
        "solid.material": "steel", "solid.yield_strength": "600 MPa", "punch.load": "100 N/mm",
        "punch.profile": "parabolic", "punch.radius": "5 mm", "punch.half_width": None,
        "friction.mu_c": 0.3, "motion.speed": "1 m/s", "output.quantities": ["interior"],
        "output.map": {"X": [-2.0, 2.0, 21], "Y": [-1.6, -0.05, 32]},
    })  # fmt: skip
    chosen = {"quantities": ("von_mises",), "units": result.units()}
    drawing = drawn(result, "inside", states=(0, 1), **chosen)
    assert "white line" in drawing.caption and "Dashed" in drawing.caption
    depths = (5.0, 20.0)
    for panel, depth in zip(drawing.figure.panels, depths, strict=True):
        assert panel.dashes == pytest.approx([-depth])
        strengths = np.where(-depth > panel.map.Y, 600.0, 900.0)
        np.testing.assert_allclose(panel.map.level, strengths, rtol=1e-12)
        assert (panel.map.values > strengths[:, None]).any()
    (alone,) = drawn(result, "inside", states=(1,), **chosen).figure.panels
    assert "20" in alone.title and "V" not in alone.title


def test_curves_that_do_not_depend_on_what_is_swept_stand_once():
    result = computed("coating", {
        "solid.yield_strength": [1e6, 2e6], "friction.mu_c": [0.1, 0.2, 0.4],
    })  # fmt: skip
    for name in ("surface", "interfaces", "parameters"):
        drawing = drawn(result, name)
        assert "the same for every" in drawing.caption and "3 of 6 states" in drawing.left_out
        assert not any("Y" in panel.title for panel in drawing.figure.panels)


@pytest.mark.parametrize("peak, half", [(20.0, 30.0), (1.0, 2.0), (np.nan, 1.04)])
def test_a_panel_reaches_beyond_the_largest_tension_beside_the_contact(peak, half):
    """Which a stiff plate has many half-widths away; a pressure has none there."""
    X = np.concatenate([np.linspace(-0.9, 0.9, 19), np.linspace(1.0, 40.0, 79)])
    X = np.union1d(-X, X)
    σ = np.where(np.abs(X) < 1.0, -1.0, 0.1 - 0.01 * np.abs(np.abs(X) - peak))
    panel = surface_panel([Shown(Along(X, "", {"sie": σ[None]}, [(1.0, 0.0)]), 0, *looks(1))])
    assert panel.xlim == (-half, half)


def test_titles_have_the_depth_under_contacts_of_any_width_and_curves_reach_across():
    """Under a stiffer coating the contact is narrower: depths over its half-width are larger."""
    layer = {"E": ["100 GPa", "400 GPa"], "nu": 0.25, "rho": 5e3, "thickness": ["0.2 mm", "0.5 mm"]}
    run = compute(of_sections(
        layer=[layer], solid={"E": "210 GPa", "nu": 0.3, "rho": 7850.0},
        punch={"profile": "parabolic", "radius": "50 mm", "load": "100 N/mm"},
        friction={"mu": 0.15}, motion={"speed": "1 m/s"},
        solve={"methods": ["sie"]}, output={"quantities": ["interfaces"]},
    ))  # fmt: skip
    figure = drawn(run, "interfaces", units=run.units(False), states=(0, 2)).figure
    assert figure.axes[0].get_title(loc="left").endswith("depth 200 µm")
    widths = run.data["states/sie/half_width"][[0, 2]]
    assert np.ptp(widths) > 0.1 * widths.max()
    for axis in figure.axes[:3]:
        low, high = axis.get_xlim()
        ends = [curve.get_xdata()[[0, -1]] for curve in curves(axis) if len(curve.get_xdata()) > 2]
        assert all(first < 0.95 * low and last > 0.95 * high for first, last in ends)
