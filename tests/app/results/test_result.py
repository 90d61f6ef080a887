"""Results in Python, and in a notebook."""

import numpy as np
import pytest
from support import CLOSED_FORM, SCENE, computed, of_sections

from galinx import LAWS, compare, compute, load, read_scene, template
from galinx.app.errors import BadInput
from galinx.app.results.check import faults
from galinx.postprocess.errors import Occupied


def test_named_arrays_have_units_and_the_archives_numbers(map_run):
    states = map_run.dataset
    assert dict(states.sizes) == {"state": 12, "X_over_a": 217, "point": 420, "inner": 1}
    np.testing.assert_array_equal(states.fem_K_I_right, map_run.data["states/fem/K_I_right"])
    assert states.fem_normal_force.attrs["units"] == "N/m" and states.c.attrs["units"] == "1"
    assert states.interior_fem_sigma_XX.dims == ("state", "point")


def test_arrays_over_the_parameters_find_a_state_by_its_values(map_run, published):
    K_I = map_run.grid.fem_K_I_right
    assert set(K_I.dims) == {"c", "mu_c", "sigma0_over_load", "delta", "motion", "X_over_L"}
    for motion, X, printed, _ in published["table5"]["rows"]:
        assert round(K_I.sel(c=0.6, motion=motion, X_over_L=X).item(), 4) == printed


def test_a_scene_is_computed_by_its_file_too(tmp_path):
    scene = read_scene(SCENE, {"output.quantities": ["friction"], "solve.methods": []})
    (tmp_path / "a.toml").write_text(scene.text, encoding="utf-8")
    one, other = compute(scene), compute(tmp_path / "a.toml")
    np.testing.assert_array_equal(one.data["states/f"], other.data["states/f"])
    with pytest.raises(BadInput, match="cannot read b"):
        compute("b.toml")


def test_plot_gives_a_figure_that_notebooks_show(exact_run, tmp_path, monkeypatch):
    from matplotlib.figure import Figure

    monkeypatch.chdir(tmp_path)
    figure = exact_run.plot()
    assert isinstance(figure, Figure) and not list(tmp_path.iterdir())
    assert figure._repr_png_().startswith(b"\x89PNG")
    friction = exact_run.figure("friction")
    assert len(friction.axes) < len(figure.axes)
    with pytest.raises(BadInput, match=r"figure 'surfcae': .*did you mean surface"):
        exact_run.figure("surfcae")


def test_a_result_without_its_stresses_is_not_saved(exact_run, tmp_path):
    """It would lack what its scene asks for."""
    exact_run.save(tmp_path / "a.h5")
    with pytest.raises(BadInput, match="without stresses"):
        load(tmp_path / "a.h5", stresses=False).save(tmp_path / "b.h5")
    again = load(tmp_path / "a.h5")
    assert again.scene == exact_run.scene and again.verdict == "PASS"
    again.save(tmp_path / "b.h5")
    assert not faults(tmp_path / "b.h5")
    with pytest.raises(Occupied, match="exists"):
        exact_run.save(tmp_path / "a.h5")


def test_options_of_figures_are_texts_as_on_the_command_line_or_lists(exact_run):
    result = exact_run
    words = result.choice(figures="surface, friction", states="0-2,4", quantities="sigma_XX", size="85mm")
    assert (words.figures, words.states, words.quantities) == (
        ("surface", "friction"), (0, 1, 2, 4), ("sigma_XX",),
    )  # fmt: skip
    assert words.size == result.choice(size=words.size).size and words.size.width == pytest.approx(
        85 / 25.4
    )
    assert result.choice(states=3).states == (3,) and result.choice(states=[1, 2]).states == (1, 2)
    with pytest.raises(BadInput, match=r"^--states: found "):
        result.choice(states="all")
    with pytest.raises(BadInput, match=r"found '3\.5', expected a width"):
        exact_run.choice(size=3.5)


def test_a_column_of_the_table_prints_its_numbers_and_unit(exact_run):
    f = next(column for column in exact_run.table() if column.name == "f")
    assert repr(f).startswith("friction f: 0.") and repr(f).count(",") == len(f.values) - 1


def test_a_grid_over_moduli_has_the_speed_that_the_scene_gives():
    """The speed over that of shear waves follows from them: with it most of a grid would be NaN."""
    scene = of_sections(
        solid={"E": [1e11, 2e11, 3e11], "nu": 0.3, "rho": 7800.0}, punch={"half_width": 1e-3},
        friction={"mu": 0.3}, motion={"speed": 100.0}, solve={"methods": ["closed_form"]},
    )  # fmt: skip
    K_I = compute(scene).grid.closed_form_K_I_right
    assert K_I.size == 3 and np.isfinite(K_I).all()


def test_an_archive_does_not_replace_another_kind_of_file(exact_run, tmp_path):
    scene = tmp_path / "scene.toml"
    scene.write_text("kept")
    with pytest.raises(Occupied, match=r"ends with \.toml, expected an archive's, as scene\.h5"):
        exact_run.save(scene, overwrite=True)
    assert scene.read_text() == "kept"


def test_a_grid_over_moduli_has_the_speeds_that_were_given_to_the_last_digit():
    """As c times the wave speed 250 m/s was 249.99999999999997 in one solid, and half of the grid NaN."""
    speeds = {"motion.c": None, "motion.speed": ["100 m/s", "250 m/s"]}
    result = computed("tables4_5", CLOSED_FORM | speeds | {"solid.E": ["2 GPa", "3.3 GPa"]})
    assert result.grid.speed.values.tolist() == [100.0, 250.0]
    assert not np.isnan(result.grid.closed_form_K_I).any()


@pytest.mark.parametrize(
    "call, said",
    [(lambda r: r.figure(3), "found 3, expected names"),
     (lambda r: r.figure(figures="friction,surface"), "found the figures friction, surface, expected"),
     (lambda r: r.figure("friction", figures="surface"), "found the figures friction, surface, expected"),
     (lambda r: r.fields("f.vtkhdf", state=0.0), r"states: found 0\.0, expected whole numbers"),
     (lambda r: r.plot(name="friction"), r"figure takes the name of a figure"),
     (lambda r: r.choice(states=1.5), r"states: found 1\.5, expected whole numbers"),
     (lambda r: r.choice(y=3), "found 3, expected names"),
     (lambda r: r.figure(method=3), "method: found 3, expected a text; valid: closed_form"),
     (lambda r: r.displacement(extent=-1.0), "extent: found -1 a, expected more than 0"),
     (lambda r: compare(r, "b.h5"), r"compare: found 'b\.h5', expected results"),
     (lambda r: template([]), r"template: found \[\], expected a text"),
     (lambda r: template("fig9", "c"), "template: found 'c', expected values by key"),
     (lambda r: template("fig9", {3: 0.3}), "found the key 3, expected a text")],
)  # fmt: skip
def test_what_is_no_argument_is_named(exact_run, call, said):
    with pytest.raises(BadInput, match=said):
        call(exact_run)


def test_a_figure_is_plotted_by_its_name_in_any_argument(exact_run):
    plotted = exact_run.plot(figures=(name for name in ["friction"]))
    assert len(plotted.axes) == len(exact_run.figure("friction").axes)


def test_a_model_that_is_not_registered_is_told_with_those_that_are():
    with pytest.raises(KeyError, match=r"the friction law 'nosuch': there is none; valid: .*dahl"):
        LAWS["nosuch"]
