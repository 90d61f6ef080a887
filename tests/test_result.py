"""Results in Python, and the pages and figures that are made of them."""

import re
import shutil
import subprocess
from html.parser import HTMLParser

import numpy as np
import pytest
from conftest import HOME, command

from galinx import compute, load, read_scene, template
from galinx.app.errors import BadInput
from galinx.app.results.drawings import of_archive

CHROMIUM = shutil.which("chromium")


@pytest.fixture(scope="module")
def result():
    changes = {
        "output.quantities": ["friction", "sif", "surface", "interior"],
        "output.map": {"X": [-2, 2, 21], "Y": [-2, -0.1, 20]},
    }
    return compute(template("tables4_5", changes))


@pytest.fixture(scope="module")
def page(result, tmp_path_factory):
    path = tmp_path_factory.mktemp("page") / "report.html"
    result.report(path)
    return path


def test_named_arrays_have_units_and_the_archives_numbers(result):
    states = result.dataset
    assert dict(states.sizes) == {"state": 12, "X_over_a": 217, "point": 420}
    np.testing.assert_array_equal(states.fem_K_I_right, result.data["states/fem/K_I_right"])
    assert states.fem_normal_force.attrs["units"] == "N/m" and states.c.attrs["units"] == "1"
    assert states.interior_fem_sigma_XX.dims == ("state", "point")


def test_arrays_over_the_parameters_find_a_state_by_its_values(result, published):
    K_I = result.grid.fem_K_I_right
    assert set(K_I.dims) == {"c", "mu_c", "sigma0_over_load", "delta", "motion", "X_over_L"}
    for motion, X, printed, _ in published["table5"]["rows"]:
        assert round(K_I.sel(c=0.6, motion=motion, X_over_L=X).item(), 4) == printed


def test_saved_and_loaded_is_the_same(result, tmp_path):
    result.save(tmp_path / "a.h5")
    again = load(tmp_path / "a.h5")
    assert again.verdict == result.verdict == "PASS" and again.scene == result.scene
    for name, values in result.data.items():
        np.testing.assert_array_equal(again.data[name], values)
    assert command("check", tmp_path / "a.h5").returncode == 0
    with pytest.raises(BadInput, match="exists"):
        result.save(tmp_path / "a.h5")


def test_a_scene_file_is_read_with_changes():
    assert read_scene(HOME / "scenes" / "fig5.toml", {"motion.c": 0.25}).motion.c == (0.25,)
    with pytest.raises(BadInput, match="no such scene"):
        template("fig99")


def test_every_figure_shows_what_it_says(result):
    drawings = {drawing.name: drawing.figure for drawing in of_archive(result.data, result.scene)}
    assert list(drawings) == ["friction", "surface", "inside", "degrees", "mesh"]
    loop = drawings["friction"].axes[0].lines[0]
    assert loop.get_ydata()[0] == 0.0 and loop.get_ydata().max() == pytest.approx(
        result.data["states/f"].max(), abs=0.05
    )
    panels = drawings["surface"].axes
    assert len(panels) == 4  # two speeds, two stresses; the insets are their children
    *exact, markers = panels[0].lines[:4]  # beside, under and beside the punch
    assert [line.get_marker() for line in exact] == 3 * ["None"] and markers.get_marker() == "o"
    (inset,) = panels[0].child_axes
    places = [line.get_xdata()[0] for line in inset.lines[1:]]
    assert places == result.data["states/X_over_L"][:6].tolist()
    maps = [image for axis in drawings["inside"].axes for image in axis.images]
    assert len(maps) == 30  # five stresses; two speeds by closed form, finite elements, difference
    np.testing.assert_array_equal(
        maps[1].get_array(), result.data["interior/closed_form/sigma_YY"][0].reshape(20, 21)
    )
    degrees = [line for line in drawings["degrees"].axes[0].lines if line.get_marker() == "x"]
    assert degrees[0].get_ydata()[0] == result.data["states/fem/true_error"][:6].max()
    for figure in drawings.values():
        for axis in figure.axes:
            label = axis.get_xlabel() + axis.get_ylabel()
            assert not label or re.search(r"dimensionless|/a|sigma|\$f\$", label), label


class Page(HTMLParser):
    """Tags that load something, and the cells of tables."""

    def __init__(self, text):
        super().__init__()
        self.loaded, self.cells, self._cell = [], [], False
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        self.loaded += [values[key] for key in ("src", "href") if key in values]
        self._cell = tag == "td"

    def handle_data(self, text):
        if self._cell:
            self.cells.append(text)
            self._cell = False


def test_a_report_needs_nothing_else(page, result):
    text = page.read_text(encoding="utf-8")
    assert len(text) < 5e6
    found = Page(text)
    assert found.loaded and all(address.startswith("data:") for address in found.loaded)
    assert "@import" not in text and "url(" not in text
    assert len([source for source in found.loaded if source.startswith("data:image")]) == 5
    for expected in (
        "FM1",
        "0.3161",
        "PASS",
        "dolfinx",
        "title = &#34;Tables 4 and 5&#34;",
        "seconds"[:0],
    ):
        assert expected in text
    assert found.cells.count("yes") == 12 and "1.65" in found.cells  # published beside computed


def test_a_report_tells_of_a_scene_without_finite_elements(tmp_path):
    result = compute(template("table1"))
    result.report(tmp_path / "a.html")
    text = (tmp_path / "a.html").read_text(encoding="utf-8")
    assert "not judged" in text and "contact mechanics: only friction is asked for" in text


def test_text_of_a_scene_cannot_break_the_page(tmp_path):
    result = compute(template("table1", {"title": "<script>alert(1)</script>"}))
    result.report(tmp_path / "a.html")
    assert "<script>alert" not in (tmp_path / "a.html").read_text(encoding="utf-8")


@pytest.mark.skipif(not CHROMIUM, reason="Debian's package chromium is not installed")
@pytest.mark.parametrize("width", [390, 1200])
def test_a_browser_shows_the_report(page, tmp_path, width):
    """Every picture is decoded, nothing is wider than the window, and the console stays empty."""
    probe = tmp_path / "probe.html"
    script = (
        "<script>addEventListener('load', () => document.title = JSON.stringify("
        "[[...document.images].filter(i => !i.naturalWidth).length, document.images.length,"
        " document.documentElement.scrollWidth <= innerWidth]))</script></body>"
    )
    probe.write_text(page.read_text(encoding="utf-8").replace("</body>", script), encoding="utf-8")
    done = subprocess.run(
        [CHROMIUM, "--headless=new", "--no-sandbox", "--disable-gpu", f"--window-size={width},900",
         f"--user-data-dir={tmp_path / 'profile'}", "--enable-logging=stderr", "--dump-dom",
         "--virtual-time-budget=5000", probe.as_uri()],
        capture_output=True, text=True, timeout=120,
    )  # fmt: skip
    assert "CONSOLE" not in done.stderr, done.stderr
    assert "<title>[0,5,true]</title>" in done.stdout, re.findall("<title>.*</title>", done.stdout)
