"""What plot draws by itself, what is chosen, and what it refuses."""

import re
import shutil
from itertools import pairwise

import numpy as np
import pytest
from legible import curves, drawn
from support import CLOSED_FORM, computed, here, kept

from galinx.app.errors import BadInput
from galinx.app.figures import files as written
from galinx.app.figures.archive import write
from galinx.app.figures.choice import Choice, size
from galinx.app.figures.files import Files
from galinx.postprocess.errors import Occupied
from galinx.postprocess.target import GIF, MP4


@pytest.fixture(scope="module")
def fast():
    """Five speeds, six states each."""
    return kept("high_speed")


@pytest.fixture(scope="module")
def sweep():
    """Three speeds, four coefficients, three stiffnesses."""
    law = {"friction.mu_c": [0.2, 0.4, 0.6, 0.8], "friction.sigma0_over_load": [1e4, 2e4, 4e4]}
    return computed("parameter_study", {"motion.c": [0.0, 0.5, 0.9]} | law | CLOSED_FORM)


@pytest.fixture(scope="module")
def strokes():
    """Twelve states of two strokes with a map each."""
    motion = {"motion.c": 0.6, "motion.strokes": ["forward", "backward"]}
    motion["motion.X_over_L"] = [0.0, 0.2, 0.4, 0.6, 0.8, 1.0]
    places = {"output.map": {"X": [-2, 2, 21], "Y": [-2, -0.1, 20]}, "output.points": None}
    return computed("inside", motion | places | CLOSED_FORM)


def test_two_values_are_drawn_over_where_they_are_named(tmp_path):
    """By themselves they tell curves apart, and make none."""
    run = computed("cylinder", {"punch.load": ["100 N/mm", "300 N/mm"]} | CLOSED_FORM)
    assert write(run.data, run.scene, Choice(x="load", y=("half_width",)), Files(tmp_path))


def test_what_a_figure_leaves_out_is_said(fast, tmp_path):
    """The last speed is the point of the scene: it is never the one that is left out."""
    drawing = drawn(fast, "surface")
    titles = [axis.get_title(loc="left") for axis in drawing.figure.axes[:3]]
    assert [re.search(r"c = ([\d.]+)", title)[1] for title in titles] == ["0", "0.6", "0.9"]
    assert drawing.left_out.startswith("12 of 30 states not shown (c = 0.3, 0.8): states 6-11,18-23;")
    assert "--figure surface --states" in drawing.left_out and drawing.left_out in drawing.full_caption
    chosen = drawn(fast, "surface", states=(*range(6, 12), *range(18, 24)))
    titles = [axis.get_title(loc="left") for axis in chosen.figure.axes[:2]]
    assert [re.search(r"c = ([\d.]+)", title)[1] for title in titles] == ["0.3", "0.8"]
    assert not chosen.left_out  # nothing of what was asked for


def test_numbers_are_drawn_over_what_is_swept_most(sweep):
    """Four coefficients are more than three speeds; these tell the curves apart."""
    drawing = drawn(sweep, "parameters")
    axes = drawing.figure.axes
    assert {axis.get_xlabel() for axis in axes} == {"Coulomb's coefficient $\\mu_C$"}
    (legend,) = drawing.figure.legends
    assert [text.get_text()[:8] for text in legend.get_texts()] == ["$c = 0$ ", "$c = 0.5", "$c = 0.9"]
    (K_I,) = [axis for axis in axes if "intensity" in axis.get_ylabel()]
    data, first = sweep.data, curves(K_I)[0]
    some = (data["states/c"] == 0.0) & (data["states/sigma0_over_load"] == 2e4)
    some &= (data["states/motion"] == "FM1") & (data["states/X_over_L"] == 0.8)
    assert first.get_xdata().tolist() == data["states/mu_c"][some].tolist() == [0.2, 0.4, 0.6, 0.8]
    assert first.get_ydata().tolist() == data["states/closed_form/K_I"][some].tolist()
    assert "σ₀ l/N = 20\u202f000 m⁻¹, FM1, X/L = 0.8" in drawing.caption.replace("\u202fm", " m")


def test_films_are_made_of_strokes(strokes, tmp_path):
    from PIL import Image

    (one,) = write(strokes.data, strokes.scene, Choice(), Files(tmp_path / "film.gif"))
    assert one.noun == "film" and GIF.of(one.path) and not one.left_out
    with Image.open(one.path) as opened:
        assert opened.n_frames == 12
        pictures = [opened.seek(n) or np.asarray(opened.convert("RGB")).copy() for n in (0, 3, 9)]
    assert all((one != other).any() for one, other in pairwise(pictures))
    write(strokes.data, strokes.scene, Choice(), Files(tmp_path / "film.gif"))  # made again unasked


def test_a_film_of_states_without_stresses_is_refused():
    """Friction along strokes alone is no film."""
    given = {"motion.X_over_L": [0.2, 0.4, 0.6, 0.8], "output.quantities": ["friction"]}
    run = computed("minor_loops", given)
    with pytest.raises(BadInput, match="a film needs stresses"):
        drawn(run, "film")


def test_ffmpeg_is_used_where_it_is(strokes, tmp_path, monkeypatch):
    files = Files(tmp_path / "film.mp4")
    if shutil.which("ffmpeg"):
        (one,) = write(strokes.data, strokes.scene, Choice(), files)
        assert MP4.of(one.path)
    monkeypatch.setattr(written.shutil, "which", lambda _: None)
    with pytest.raises(BadInput, match=r"mp4 needs ffmpeg, which is not installed; gif does not"):
        write(strokes.data, strokes.scene, Choice(), files)
    assert Files(tmp_path).endings("film") == ("gif",)
    monkeypatch.setattr(written.shutil, "which", lambda _: "/usr/bin/ffmpeg")
    assert Files(tmp_path).endings("film") == ("mp4",)


@pytest.mark.parametrize(
    ("options", "to", "said"),
    [
        ({"figures": ("surfase",)}, ".", r"figure 'surfase': there is none; did you mean surface\?"),
        ({"quantities": ("sgma_XX",)}, ".", "quantity 'sgma_XX': there is none; did you mean sigma_XX"),
        ({"method": "fem"}, ".", r"nothing to draw for --method; "),
        ({"states": (30,)}, ".", r"--states: found 30, expected numbers from 0 to 29; show lists them"),
        ({"x": "foo"}, ".", r"x 'foo': there is none; valid: c, mu_c"),
        ({"y": ("K_II",)}, ".", r"y 'K_II': there is none; did you mean K_I\?"),
        ({"by": "mu_c"}, ".", r"by 'mu_c': there is none; valid: motion, X_over_L"),
        ({"figures": ("friction",), "method": "fem"}, ".", r"friction follows no --method; leave"),
        ({"figures": ("film",), "states": (0, 1)}, ".", r"a film needs at least 4 states .*, found 2"),
        ({}, "a.pdf", r"a\.pdf is one file, found 3 figures; choose one by --figure: "),
        ({"figures": ("surface",)}, "a.jpg", r"found 'jpg' for the figure surface, expected pdf, png,"),
        ({"figures": ("surface",), "size": size("1.5in x 1.5in")}, ".", r"--size: the figure surface"),
    ],
)  # fmt: skip
def test_what_cannot_be_drawn_is_refused(fast, tmp_path, options, to, said):
    with pytest.raises(BadInput, match=said):
        write(fast.data, fast.scene, Choice(**options), Files(tmp_path / to))
    assert not list(tmp_path.rglob("*.*"))


@pytest.mark.parametrize("text", ["3", "3.5 inch", "in", "0.5in", "100in", "3in x", "-3in", "3in x 0mm"])
def test_sizes_that_no_figure_has_are_refused(text):
    with pytest.raises(BadInput, match=r"--size: found .*, expected"):
        size(text)


def test_wrong_resolutions_and_formats_are_refused(fast, tmp_path):
    choice = Choice(figures=("surface",))
    with pytest.raises(BadInput, match="--dpi: found 5, expected 30 to 2400"):
        write(fast.data, fast.scene, choice, Files(tmp_path, dpi=5))
    with pytest.raises(BadInput, match=r"--format: found 'eps' .*; convert a pdf for eps"):
        write(fast.data, fast.scene, choice, Files(tmp_path, formats=("eps",)))
    with pytest.raises(BadInput, match=r"--format png is not the ending of .*a\.pdf"):
        write(fast.data, fast.scene, choice, Files(tmp_path / "a.pdf", formats=("png",)))
    (tmp_path / "a.pdf").write_text("mine")
    with pytest.raises(Occupied, match="is not a figure of galinx"):
        write(fast.data, fast.scene, choice, Files(tmp_path / "a.pdf"))


def test_the_command_draws_what_it_is_told(archive, tmp_path):
    one = here(
        "plot", archive, "-o", tmp_path / "one.svg", "--states", "0,4,7", "--quantity", "sigma_XX",
        "--method", "fem", "--size", "3.5in", "--dpi", "600",
    )  # fmt: skip
    assert one.returncode == 0, one.stderr
    assert one.stdout == f"figure: {tmp_path / 'one.svg'}\n"
    assert b'width="252pt"' in (tmp_path / "one.svg").read_bytes()[:2000]
    refused = here("plot", archive, "-o", tmp_path / "two.tiff")
    assert refused.returncode == 2 and "expected pdf, png, svg or a folder" in refused.stderr


ROUND = {"solve.methods": ["closed_form"], "output.map": None, "output.quantities": ["sif"]}


def test_contacts_of_several_widths_are_compared_in_units():
    """The pressure under a cylinder falls with speed; over N/(2a), with a of every state, it rose."""
    result = computed("cylinder", ROUND)
    h, p = (result.data[f"states/closed_form/{name}"] for name in ("half_width", "largest_pressure"))
    pressure = 1e-6 * p * result.scene.punch.load / (2.0 * h)
    axes = drawn(result, "parameters", units=result.units()).figure.axes
    (axis,) = (axis for axis in axes if axis.get_ylabel().startswith("largest contact"))
    assert "(MPa)" in axis.get_ylabel()
    values = np.concatenate([line.get_ydata() for line in curves(axis)])
    assert np.isclose(values[:, None], pressure, rtol=1e-14).any(axis=1).all()
    assert values.max() == pytest.approx(pressure.max(), rel=1e-14)
    assert all((np.diff(line.get_ydata()) < 0.0).all() for line in curves(axis))
    assert not any("N/(2a)" in axis.get_ylabel() or "over $a$" in axis.get_ylabel() for axis in axes)


def test_a_film_over_time_names_its_dashed_curve():
    film = drawn(kept("from rest"), "film").film
    legends = [text.get_text() for legend in film.figure.legends for text in legend.get_texts()]
    legends += [text.get_text() for axis in film.figure.axes if axis.get_legend()
                for text in axis.get_legend().get_texts()]  # fmt: skip
    assert "steady" in legends


def test_few_swept_values_are_the_ticks():
    result = computed("cylinder", ROUND | {"motion.c": 0.1, "friction.mu_c": [0.1, 0.4, 0.6]})
    axes = drawn(result, "parameters", size=size("85mm")).figure.axes
    assert all(list(axis.get_xticks()) == [0.1, 0.4, 0.6] for axis in axes)


@pytest.mark.parametrize("dimensionless, name", [(False, "stress (µm)"), (True, "stress over $a$")])
def test_places_are_over_the_half_width_where_they_have_no_unit(dimensionless, name):
    result = computed("cylinder", ROUND | {"output.quantities": ["surface"]})
    choice = {"y": ("sigma_XX_max_X_over_a",), "units": result.units(dimensionless)}
    (axis, *_) = drawn(result, "parameters", **choice).figure.axes
    label = " ".join(axis.get_ylabel().split())
    assert label.endswith(name) and label.count("over") == dimensionless


@pytest.mark.parametrize("key, told", [("c", r"c = "), ("speed", r"V = ")])
def test_over_a_modulus_curves_are_at_the_speeds_that_are_given(key, told):
    """Of three c and three moduli there are nine speeds, and of three speeds nine c."""
    speeds = {"c": [0.1, 0.2, 0.3], "speed": ["300 m/s", "600 m/s", "900 m/s"]}[key]
    solid = {"solid": {"E": ["100 GPa", "200 GPa", "400 GPa"], "nu": 0.3, "rho": 7800.0}}
    result = computed("cylinder", ROUND | solid | {"motion.c": None, f"motion.{key}": speeds})
    figure = drawn(result, "parameters", units=result.units(False)).figure
    assert {axis.get_xlabel() for axis in figure.axes} == {"Young's modulus $\\mathrm{E}$ (GPa)"}
    labels = [text.get_text() for text in figure.legends[0].get_texts()]
    assert len(labels) == 3 and all(re.search(told, label) for label in labels)
    assert [len(curve.get_xdata()) for curve in curves(figure.axes[0])[:3]] == [3, 3, 3]


def test_numbers_are_drawn_over_what_changes_them():
    """E at a given c changes the speed of waves alone, and stands first; stresses follow from μ."""
    changes = {"solid.E": ["100 GPa", "200 GPa", "300 GPa"], "friction.mu_c": [0.1, 0.3, 0.5]}
    given = {"motion.strokes": ["forward"], "motion.X_over_L": 1.0, "motion.c": [0.3, 0.99]}
    result = computed("tables4_5", CLOSED_FORM | changes | given | {"output.quantities": ["sif"]})
    drawing = drawn(result, "parameters")
    assert {axis.get_xlabel() for axis in drawing.figure.axes} == {"Coulomb's coefficient $\\mu_C$"}
    assert any("intensity" in axis.get_ylabel() for axis in drawing.figure.axes)
    assert "Results are the same for every E" in drawing.caption and "is formal" in drawing.caption
