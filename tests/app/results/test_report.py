"""Pages that are made of results."""

import html
import json
import re
import shutil
import subprocess
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
from support import computed

from galinx import compute, template
from galinx.app.results import report
from galinx.app.results.report import curves, states_table
from galinx.app.scene.read import parse
from galinx.postprocess.page import markup

CHROMIUM = shutil.which("chromium")
CLOSED = {"solve.methods": ["closed_form"]}


@pytest.fixture(scope="module")
def page(map_run, tmp_path_factory):
    path = tmp_path_factory.mktemp("page") / "report.html"
    map_run.report(path)
    return path


class Page(HTMLParser):
    """Tags that load something, and the cells of tables."""

    def __init__(self, text):
        super().__init__()
        self.loaded, self.cells, self._cell = [], [], False
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        self.loaded += [values[key] for key in ("src", "href") if values.get(key, "#")[0] != "#"]
        self._cell = tag == "td"

    def handle_data(self, text):
        if self._cell:
            self.cells.append(text)
            self._cell = False


def test_a_report_needs_nothing_else(page):
    text = page.read_text(encoding="utf-8")
    assert len(text) < 5e6
    found = Page(text)
    assert found.loaded and all(address.startswith("data:") for address in found.loaded)
    assert "@import" not in text and "url(" not in text.replace("url(#inside)", "")
    assert len([source for source in found.loaded if source.startswith("data:image")]) == 5
    for expected in ("FM1", "0.3161", "PASS", "dolfinx", "title = &#34;Tables 4 and 5&#34;"):
        assert expected in text
    # Published beside computed, by the study's arithmetic.
    assert (found.cells.count("yes"), found.cells.count("NO")) == (12, 0) and "1.65" in found.cells


def test_a_report_tells_of_a_scene_without_finite_elements(tmp_path):
    result = compute(template("table1"))
    result.report(tmp_path / "a.html")
    text = (tmp_path / "a.html").read_text(encoding="utf-8")
    assert "not judged" in text and "contact mechanics: only friction is asked for" in text
    # Of the terms those that the page has words for.
    told = text.partition('id="terms"')[2]
    assert "positive in forward motion" in told
    assert "yields" not in told and "edge of the punch" not in told


def test_text_of_a_scene_cannot_break_the_page(tmp_path):
    result = compute(template("table1", {"title": "<script>alert(1)</script>"}))
    result.report(tmp_path / "a.html")
    assert "<script>alert" not in (tmp_path / "a.html").read_text(encoding="utf-8")


def data_of(page, name):
    text = page.read_text(encoding="utf-8")
    return json.loads(re.search(f'id="{name}-data">(.*?)</script>', text, re.DOTALL)[1])


def test_a_report_has_every_state_and_its_curves(page, map_run):
    table, curves = data_of(page, "states"), data_of(page, "curves")
    heads = [column["csv"] for column in table["columns"]]
    found = dict(zip(heads, zip(*table["rows"])))
    np.testing.assert_allclose(found["f"], map_run.data["states/f"], rtol=1e-11)
    np.testing.assert_allclose(found["fem_v0 [m]"], map_run.data["states/fem/v0"], rtol=1e-11)
    assert list(found["motion"]) == list(map_run.data["states/motion"])
    fem = curves["methods"].index("finite elements")
    drawn = np.array(curves["values"][fem][curves["quantities"].index("σ_XX")])
    order = np.argsort(map_run.data["surface/X_over_a"])
    np.testing.assert_allclose(drawn, map_run.data["surface/fem/sigma_XX"][:, order], rtol=1e-4)
    assert (np.diff(curves["X"]) >= 0).all()


def test_a_report_begins_with_results_in_units(page, map_run):
    text = page.read_text(encoding="utf-8")
    X, stress = map_run.data["surface/X_over_a"], map_run.data["surface/fem/sigma_XX"]
    largest = stress[:, np.abs(np.abs(X) - 1.0) >= 0.01].max() * 55.3e3 / 2e-3 / 1e6
    assert f"{largest:.1f} MPa" in text
    assert text.index("Results</h2>") < text.index("Accuracy</h2>") < text.index("States</h2>")


def test_many_states_are_counted_where_not_all_are_shown(map_run):
    many = {path: np.repeat(values, 5000, axis=0) for path, values in map_run.data.items()
            if path.startswith("states/")}  # fmt: skip
    table = states_table(many)
    count = len(many["states/f"])
    assert len(table["data"]["rows"]) < count and f"{count} states" in table["note"]


@pytest.mark.parametrize(
    "text, shown",
    [
        ("K_I at X", "<i>K</i><sub>I</sub> at X"), (r"$\mu_C$", "<i>μ</i><sub>C</sub>"),
        ("4.8e-07 m", "4.8&#8239;×&#8239;10<sup>−7</sup> m"), ("<b>", "&lt;b&gt;"),
        (r"$\sigma_0 l/N$", "σ₀ l/N"), ("sigma_XX", "<i>σ</i><sub>XX</sub>"),
        (r"c = $4.786 \times 10^{-7}$", "c = 4.786&#8239;×&#8239;10<sup>−7</sup>"), ("0x1e-7", "0x1e-7"),
    ],
)  # fmt: skip
def test_symbols_are_typeset(text, shown):
    assert markup(text) == shown


#: Of a page in a browser: pictures that are not decoded, pictures, does all fit the width; rows of the
#: table at first, and of a search; the last f on top after sorting twice; curves, and what is read there.
PROBE = """<script>addEventListener('load', () => {
  const rows = () => document.querySelectorAll('#table tbody tr');
  const search = document.getElementById('search'), found = [rows().length];
  search.value = 'BM1 c=0.6'; search.dispatchEvent(new Event('input')); found.push(rows().length);
  search.value = ''; search.dispatchEvent(new Event('input'));
  const head = [...document.querySelectorAll('th button')].find(b => b.textContent === 'f');
  head.click(); head.click();
  found.push([...rows()[0].cells][[...head.closest('tr').cells].indexOf(head.closest('th'))].textContent);
  const svg = document.querySelector('#curves svg'), box = svg.getBoundingClientRect();
  svg.dispatchEvent(new PointerEvent('pointermove', { clientX: box.left + 58 + (box.width - 70) / 2 }));
  document.querySelector('figure img').click();
  const [pictures, curves] = ['figure img', '#curves path'].map(q => document.querySelectorAll(q).length);
  parent.document.title = JSON.stringify([
    [...document.images].filter(i => i.src && !i.naturalWidth).length, pictures,
    innerWidth, document.documentElement.scrollWidth <= innerWidth, ...found, curves,
    document.querySelector('#curves output').textContent.split(';')[0],
    document.getElementById('large').open]);
})</script></body>"""


@pytest.mark.skipif(not CHROMIUM, reason="Debian's package chromium is not installed")
@pytest.mark.parametrize("width", [390, 1200])
def test_a_browser_shows_the_report(page, map_run, tmp_path, width):
    """Pictures are decoded, nothing is wider than the window, what moves does; an empty console."""
    probe = tmp_path / "probe.html"
    text = html.escape(page.read_text(encoding="utf-8").replace("</body>", PROBE))
    # In a frame: no window of this browser is narrower than 500 px.
    frame = f'<iframe style="width: {width}px; height: 900px; border: 0" srcdoc="{text}"></iframe>'
    probe.write_text(f"<!doctype html><title></title>{frame}", encoding="utf-8")
    done = subprocess.run(
        [CHROMIUM, "--headless=new", "--no-sandbox", "--disable-gpu", "--window-size=1300,900",
         f"--user-data-dir={tmp_path / 'profile'}", "--enable-logging=stderr", "--dump-dom",
         "--virtual-time-budget=5000", probe.as_uri()],
        capture_output=True, text=True, timeout=120,
    )  # fmt: skip
    assert "CONSOLE" not in done.stderr, done.stderr
    told = json.loads(html.unescape(re.findall("<title>(.*?)</title>", done.stdout)[0]))
    f = map_run.data["states/f"]
    at = (map_run.data["states/c"] == 0.6) & (map_run.data["states/motion"] == "BM1")
    assert told == [
        0, 5, width, True, min(len(f), 25), at.sum(), f"{f.max():.6g}", 2, "X/a = 0", True
    ]  # fmt: skip


#: Clicks, drags, sorts, chooses and types into everything on a page.
EVERYTHING = Path(__file__).with_name("everything.js").read_text(encoding="utf-8")


def browsed(page, folder, script):
    """Title of a page after a script at its end, and what its console says."""
    probe = folder / "everything.html"
    probe.write_text(page.replace("</body>", f"<script>{script}</script></body>"), encoding="utf-8")
    done = subprocess.run(
        [CHROMIUM, "--headless=new", "--no-sandbox", "--disable-gpu", "--window-size=1200,900",
         f"--user-data-dir={folder / 'profile'}", "--enable-logging=stderr", "--dump-dom",
         "--virtual-time-budget=60000", probe.as_uri()],
        capture_output=True, text=True, timeout=200,
    )  # fmt: skip
    console = [line for line in done.stderr.splitlines() if "CONSOLE" in line]
    return json.loads(
        html.unescape(re.findall("<title>(.*?)</title>", done.stdout, re.DOTALL)[0])
    ), console


#: Pages of all kinds: what they have differs.
PAGES = {
    "flat": ("tables4_5", CLOSED),
    "friction alone": ("table1", {}),
    "cylinder": ("cylinder", CLOSED | {"output.quantities": ["sif", "surface"], "output.map": None}),
    "coating": ("coating", {"solve.methods": ["sie"], "output.quantities": ["surface", "interfaces"]}),
    "slider": ("slider", {}),
}  # fmt: skip


@pytest.mark.skipif(not CHROMIUM, reason="Debian's package chromium is not installed")
@pytest.mark.parametrize("name, si", [*((name, False) for name in PAGES), ("cylinder", True)])
def test_everything_on_a_page_does_what_it_says(name, si, tmp_path):
    result = computed(*PAGES[name])
    result.report(tmp_path / "report.html", dimensionless=not si)
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    (faults, told), console = browsed(page, tmp_path, EVERYTHING)
    assert not faults and not console and told["saved"] == "states.csv"
    if "surface/X_over_a" not in result.data:
        assert "left" not in told
        return
    assert told["left"] == pytest.approx(-1.0, abs=0.02) and told["right"] == pytest.approx(1.0, abs=0.02)
    assert told["all"] == pytest.approx(0.0, abs=0.1) == told["double click"]
    assert told["dragged"] == pytest.approx(-1.5, abs=0.1) == told["not dragged"]
    assert told["drawn"] == 1  # of one method, for every state and quantity


@pytest.mark.parametrize(
    "value, shown",
    [
        (1.138e11, "113.8 GPa"), (-2.5e-7, "−250.0 nPa"), (0.0, "0 Pa"), (999.96, "1.000 kPa"),
        (1.0, "1.000 Pa"), (7e15, "7000 TPa"), (3e-14, "0.03000 pPa"),
    ],
)  # fmt: skip
def test_numbers_have_prefixes(value, shown):
    assert report.engineering(value, "Pa") == shown


def test_in_si_the_table_and_the_curves_have_units(map_run):
    data = map_run.data
    table = states_table(data, map_run.units())
    columns = {column["csv"]: i for i, column in enumerate(table["data"]["columns"])}
    speed = columns["speed [m/s]"]
    assert [row[speed] for row in table["data"]["rows"]] == pytest.approx(data["states/speed"], rel=1e-11)
    width = columns["closed_form_slip_reversed_left [m]"]
    expected = 1e-3 * data["states/closed_form/slip_reversed_left"]
    assert [row[width] for row in table["data"]["rows"]] == pytest.approx(expected, rel=1e-11)
    assert "closed_form_slip_reversed_left" in {
        column["csv"] for column in states_table(data)["data"]["columns"]
    }


def test_a_report_tells_where_the_solid_yields_and_where_answers_hold():
    result = computed(
        "tables4_5",
        {
            "solid.material": "T302",
            "solve.methods": ["closed_form"],
            "output.quantities": ["sif", "yield"],
        },
    )
    found = {
        answer.name: answer.value for answer in report.answers(result.data, result.scene, result.units())
    }
    depth = result.data["states/closed_form/yield_depth"]
    assert (
        found["Depth of the yielded zone"]
        == f"{1e6 * depth.min() * 1e-3:.3f} µm to {1e3 * depth.max():.2f} µm"
    )
    assert found["Wave crossings of the contact in a stroke"].startswith("0.08333 to 1.045e+05")


def test_in_si_curves_are_in_megapascals(surface_run):
    data = surface_run.data
    plain, si = curves(data), curves(data, surface_run.units())
    assert plain["data"]["unit"] == "/ (N/2a)" and si["data"]["unit"] == "[MPa]"
    one, other = (np.array(found["data"]["values"][0][0], dtype=float) for found in (plain, si))
    np.testing.assert_allclose(other, 27.65 * one, rtol=1e-4)  # of five digits


@pytest.fixture(scope="module")
def surface_run():
    return computed("tables4_5", {"solve.methods": ["closed_form"]})


def in_pascals(text):
    number, unit = text.split()
    return float(number) * {"k": 1e3, "M": 1e6, "G": 1e9}[unit[0]]


def test_the_largest_tension_of_a_round_punch_is_that_at_the_end_itself():
    """A cylinder of steel, f = 0.15, slowly: 2 f p₀ by friction, and more by Poisson's ratio."""
    text = (
        "[solid]\nE = 2.1e11\nnu = 0.3\nrho = 7850\nplane = 'strain'\n"
        "[punch]\nprofile = 'parabolic'\nradius = 0.005\nload = 1e5\n"
        "[friction]\nmodel = 'coulomb'\nmu_c = 0.15\n[motion]\nspeed = 1.0\nstrokes = ['forward']\n"
        "X_over_L = [1.0]\n[solve]\nmethods = ['closed_form']\n[output]\nquantities = ['surface']\n"
    )
    scene = parse(text)
    result = compute(scene)
    shown = {answer.name: answer for answer in report.answers(result.data, scene, result.units())}
    tension = in_pascals(shown["Largest in-plane tension σ_XX on the surface"].value)
    p0 = in_pascals(shown["Largest contact pressure"].value)
    # The surface's own stress next to the end, where it is largest.
    X, σ = (result.data[f"surface/{path}"] for path in ("X_over_a", "closed_form/sigma_XX"))
    beside = (
        p0 * σ[0, np.abs(X + 1.000001).argmin()] / result.data["states/closed_form/largest_pressure"][0]
    )
    assert tension == pytest.approx(beside, rel=5e-3) and tension > 2.0 * 0.15 * p0


def test_the_largest_shear_at_an_interface_is_that_of_either_sign():
    scene = template("coating", {"solve.methods": ["sie"], "output.quantities": ["interfaces"]})
    result = compute(scene)
    shown = {answer.name: answer for answer in report.answers(result.data, scene, result.units())}
    for name, path in (("shear |σ_XY| at", "sigma_XY"), ("tension σ_YY at", "sigma_YY")):
        σ = np.nan_to_num(result.data[f"interfaces/sie/{path}"][:, 0])
        largest = np.abs(σ).max() if "shear" in name else σ.max()
        unit = scene.body.stress
        answer = next((shown[key] for key in shown if name in key), None)
        assert answer and in_pascals(answer.value) == pytest.approx(unit * largest, rel=1e-2)
