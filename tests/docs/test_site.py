"""Pages that are made, and the site that is built of all pages."""

import re
import runpy
import shutil
from types import SimpleNamespace
from urllib.parse import unquote, urlsplit

import pytest
from examples import DOCS
from pages_parsed import Page
from support import HOME, finished


def test_made_pages_are_up_to_date():
    for path, text in runpy.run_path(str(DOCS / "make.py"))["pages"]().items():
        assert path.read_text(encoding="utf-8") == text, (
            f"{path.relative_to(HOME)} is out of date: PYTHONPATH=. /usr/bin/python3 docs/make.py"
        )


#: What prose writes with one letter, by page; the glossary has each once.
SYMBOLS = re.compile(r"^- ([^:]+):", re.MULTILINE)


def test_no_symbol_and_no_word_stands_twice_in_the_glossary():
    text = (DOCS / "glossary.md").read_text(encoding="utf-8")
    found = [name for row in SYMBOLS.findall(text) for name in row.split(", ")]
    found = [name for name in found if name not in ("symbol", "word", "---")]
    assert len(found) > 70 and len(set(found)) == len(found)
    for name in ("σ₀l/N", "pre-sliding", "confocal", "back-substitution", "not judged", "friction state"):
        assert name in found


def test_formulas_are_typeset_without_a_network():
    """What the page becomes, and that all that it loads is in the site."""
    made = runpy.run_path(str(DOCS / "mathjax.py"))
    convert, installed = made["on_page_content"], made["on_page_content"].__globals__
    source = '<p>$<code>a &lt; b</code>$</p>\n<pre><code class="language-math">x_1\n</code></pre>'
    html = convert(source, SimpleNamespace(url="theory.html"))
    if installed["_INSTALLED"].is_dir():
        assert '<script type="math/tex">a < b</script>' in html
        assert '<script type="math/tex; mode=display">x_1</script>' in html
        assert html.count('src="mathjax/MathJax.js?config=TeX-AMS_SVG"') == 1
        assert 'src="../mathjax/' in convert(source, SimpleNamespace(url="below/theory.html"))
    assert convert("<p>no formula</p>", SimpleNamespace(url="a.html")) == "<p>no formula</p>"
    installed["_INSTALLED"] = DOCS / "nowhere"
    assert convert(source, SimpleNamespace(url="theory.html")) == source


def test_the_site_is_built_and_its_links_hold(tmp_path):
    mkdocs = shutil.which("mkdocs", path="/usr/bin") or shutil.which("mkdocs")
    if not mkdocs:
        pytest.skip("mkdocs is not installed")
    site = tmp_path / "site"
    done = finished([mkdocs, "build", "--strict", "-f", HOME / "mkdocs.yml", "-d", site], cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "WARNING" not in done.stderr, done.stderr
    assert not [path for path in site.rglob("*.py*")]
    pages = {path: Page(path.read_text(encoding="utf-8")) for path in site.rglob("*.html")}
    built = {path.stem for path in pages}
    assert {page.stem for page in DOCS.glob("*.md")} <= built
    for path, page in pages.items():
        for target in (*page.links, *page.loaded):
            parts = urlsplit(target)
            if parts.scheme or parts.netloc:
                assert target in page.links, f"{path.name} loads {target} from the network"
                continue
            if path.name == "404.html":  # its addresses start at the site's root
                continue
            there = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            assert there.exists(), f"{path.name}: {target}"
            if parts.fragment and there in pages:
                assert unquote(parts.fragment) in pages[there].anchors, f"{path.name}: {target}"
