"""Pages that are made of results."""

import html
import json
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from pages_parsed import Page
from support import THOROUGH, computed, kept

from galinx import compute, template
from galinx.app.errors import BadInput
from galinx.app.results.report import markup
from galinx.postprocess.tables import BESIDE, sheets, state_columns

CHROMIUM = shutil.which("chromium")
CLOSED = {"solve.methods": ["closed_form"]}


@pytest.fixture(scope="module")
def page(map_run, tmp_path_factory):
    path = tmp_path_factory.mktemp("page") / "report.html"
    map_run.report(path)
    return path


def test_a_report_needs_nothing_else(page):
    text = page.read_text(encoding="utf-8")
    assert len(text) < 6e6
    found = Page(text)
    needed = [*found.loaded, *(target for target in found.links if target[0] != "#")]
    assert found.loaded and all(address.startswith("data:") for address in needed)
    assert "@import" not in text and "url(" not in text.replace("url(#inside)", "")
    assert (
        sum(source.startswith("data:image") for source in found.loaded) == 1
    )  # the mesh; others are charts
    for expected in ("FM1", "PASS", "dolfinx", "title = &#34;Tables 4 and 5&#34;"):
        assert expected in text
    # Published beside computed, by the study's arithmetic.
    assert (found.cells.count("yes"), found.cells.count("NO")) == (12, 0) and "1.65" in found.cells


def test_text_of_a_scene_cannot_break_the_page(tmp_path):
    result = compute(template("table1", {"title": "<script>alert(1)</script>"}))
    result.report(tmp_path / "a.html")
    assert "<script>alert" not in (tmp_path / "a.html").read_text(encoding="utf-8")


@pytest.mark.parametrize("name", ["laws", "slider"])
def test_a_report_has_all_tables_and_no_heading_without_text(name, tmp_path):
    result = kept(name)
    result.report(tmp_path / "a.html")
    text = (tmp_path / "a.html").read_text(encoding="utf-8")
    shown = sheets(result.data, result.units(), "", 0, strokes=True)
    assert "Friction loops" in {sheet.title for sheet in shown}
    for sheet in shown[1:]:
        assert sheet.title in text and all(str(markup(cell)) in text for cell in sheet.rows[0])
    assert not re.search(r"<h2[^>]*>[^<]*</h2>\s*<h2", text)


def test_a_report_of_friction_over_an_elastic_pair_shows_flutter(tmp_path):
    """What is drawn only by name elsewhere is all that such an archive has to show."""
    friction = {"output.quantities": ["friction"], "punch.solid": {"material": "TiN"}}
    along = {"friction.state": "advected", "motion.strokes": None, "motion.X_over_L": None}
    result = compute(template("cylinder", friction | along | {"output.map": None}))
    result.report(tmp_path / "report.html")
    assert "<figcaption" in (tmp_path / "report.html").read_text(encoding="utf-8")


def test_states_without_a_solution_are_drawn_nowhere(tmp_path):
    """Beyond the Rayleigh speed no punch has a contact; nor has a cylinder sharp edges for that."""
    punch = {"punch.profile": "parabolic", "punch.radius": 5e-3, "punch.half_width": None}
    grid = {"X": [-2, 2, 5], "Y": [-2, -0.1, 4]}
    result = compute(template("tables4_5", CLOSED | punch | {
        "motion.c": [0.5, 0.95, 0.3], "motion.strokes": ["forward"], "motion.X_over_L": [1.0],
        "output.quantities": ["sif", "surface", "interior"], "output.map": grid,
    }))  # fmt: skip
    assert result.verdict == "FAIL" and np.isnan(result.data["states/closed_form/half_width"][1])
    assert not any(column.name.startswith("K_I") for column in result.table())
    result.report(tmp_path / "report.html")
    assert "state 2" in (text := (tmp_path / "report.html").read_text()) and "state 1:" not in text
    chosen = {"figures": ("surface", "inside"), "formats": ("png",)}
    assert len(result.plot(tmp_path / "figures", **chosen)) == 2
    with pytest.raises(BadInput, match="1, which has no solution"):
        result.plot(tmp_path / "figures", states=[1])


def test_an_archive_without_figures_is_reported(tmp_path):
    steady = {"friction": {"mu": 0.3}, "motion": {"c": 0.3}, "output.quantities": ["sif"]}
    computed(changes=CLOSED | steady).report(tmp_path / "report.html")
    assert "<figcaption" not in (tmp_path / "report.html").read_text()


def data_of(page, name):
    text = page.read_text(encoding="utf-8")
    return json.loads(re.search(f'id="{name}-data">(.*?)</script>', text, re.DOTALL)[1])


def test_a_report_has_every_state_and_its_curves(page, map_run):
    table, large = data_of(page, "states"), data_of(page, "explorer")
    found = dict(zip((column["name"] for column in table["columns"]), zip(*table["rows"])))
    for column in state_columns(map_run.data, map_run.units()):
        if not column.constant and not isinstance(column.values[0], str):
            np.testing.assert_allclose(found[column.name or column.head], column.values, rtol=1e-11)
    assert list(found["motion"]) == list(map_run.data["states/motion"])
    X, half = map_run.data["surface/X_over_a"], 1e3 * map_run.scene.body.half_width
    stress = 1e-6 * map_run.scene.body.stress
    assert len(large["states"]) == len(map_run.data["states/f"]) and len(large["maps"]) == 3
    assert "_" not in str([*large["states"], *(one["label"] for one in large["maps"])])
    assert large["maps"][0]["charts"][0]["layout"]["yaxis"]["constrain"] == "domain"
    for charts, (name, sign) in zip(large["surface"], (("sigma_YY", -1.0), ("sigma_XX", 1.0))):
        for state, chart in enumerate(charts):
            assert chart["layout"]["yaxis"]["title"]["text"].replace("<br>", " ").endswith("(MPa)")
            assert "(mm)" in chart["layout"]["xaxis"]["title"]["text"]
            for trace, path in zip(chart["data"], ("closed_form", "fem")):
                x, y = (np.array(trace[axis], dtype=float) for axis in "xy")
                held = sign * stress * map_run.data[f"surface/{path}/{name}"][state]
                at = [int(np.abs(half * X - place).argmin()) for place in x[np.isfinite(x)]]
                np.testing.assert_allclose(y[np.isfinite(x)], held[at], rtol=1e-4)
                assert len(at) > 50


@pytest.mark.parametrize(
    "text, shown",
    [
        ("K_I at X", "<i>K</i><sub>I</sub> at X"), (r"$\mu_C$", "<i>μ</i><sub>C</sub>"),
        ("4.8e-07 m", "4.8&#8239;×&#8239;10<sup>−7</sup> m"), ("<b>", "&lt;b&gt;"),
        (r"$\sigma_0 l/N$", "σ₀ l/N"), ("sigma_XX", "<i>σ</i><sub>XX</sub>"),
        (r"c = $4.786 \times 10^{-7}$", "c = 4.786&#8239;×&#8239;10<sup>−7</sup>"), ("0x1e-7", "0x1e-7"),
        ("2-3 at X = -a, -1.5, MPa·m^(-β)", "2-3 at X = −a, −1.5, MPa·m<sup>−β</sup>"),
    ],
)  # fmt: skip
def test_symbols_are_typeset(text, shown):
    assert markup(text) == shown


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
PAGES = ("table1", "cylinder", "slider", *["coating"] * THOROUGH)


@pytest.mark.skipif(not CHROMIUM, reason="Debian's package chromium is not installed")
@pytest.mark.parametrize(
    "name, dimensionless",
    [*((name, name == "cylinder") for name in PAGES), *([("cylinder", False)] if THOROUGH else [])],
)
def test_everything_on_a_page_does_what_it_says(name, dimensionless, tmp_path):
    result = kept(name)
    result.report(tmp_path / "report.html", dimensionless=dimensionless)
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    (faults, told), console = browsed(page, tmp_path, EVERYTHING)
    assert not faults and not console and told["charts"] > 0
    # A table of many states can be saved; few stand side by side.
    assert told.get("saved") == ("states.csv" if len(result.data["states/f"]) > BESIDE else None)
    if "surface/X_over_a" in result.data:
        states = len(result.data["states/f"])
        assert told["states"] == min(states, told["last"] + 1) and told["held"] == min(2, states)
        assert told["zoomed"] and told["whole again"]
