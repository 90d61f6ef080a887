"""Pages that are made of results."""

import re
import shutil
import subprocess
from html.parser import HTMLParser

import pytest

from galinx import compute, template

CHROMIUM = shutil.which("chromium")


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
        self.loaded += [values[key] for key in ("src", "href") if key in values]
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
    assert "@import" not in text and "url(" not in text
    assert len([source for source in found.loaded if source.startswith("data:image")]) == 5
    for expected in ("FM1", "0.3161", "PASS", "dolfinx", "title = &#34;Tables 4 and 5&#34;"):
        assert expected in text
    # Published beside computed: eight Diff % differ in their last digit.
    assert (found.cells.count("yes"), found.cells.count("≤ 0.01")) == (4, 8) and "1.65" in found.cells


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
