"""Pages that are made, the schema, and the site that is built of all pages."""

import runpy
import shutil
import subprocess
import tomllib
from html.parser import HTMLParser
from urllib.parse import unquote, urlsplit

import pytest
from conftest import HOME, clean_environment, command
from examples import DOCS, SILENT, name_of

from galinx.app.scene.read import parse

SCENES = sorted((HOME / "scenes").glob("*.toml"))


def test_made_pages_are_up_to_date():
    for path, text in runpy.run_path(str(DOCS / "make.py"))["pages"]().items():
        assert path.read_text(encoding="utf-8") == text, (
            f"{path.relative_to(HOME)} is out of date: PYTHONPATH=. /usr/bin/python3 docs/make.py"
        )


def test_the_schema_is_what_the_command_prints():
    assert command("schema").stdout == (HOME / "scenes" / "scene.schema.json").read_text(encoding="utf-8")


@pytest.mark.parametrize("path", SCENES, ids=name_of)
def test_scenes_follow_the_schema(path):
    jsonschema = pytest.importorskip("jsonschema")
    from galinx.app.scene.schema import schema

    text = path.read_text(encoding="utf-8")
    parse(text, path.name)
    jsonschema.Draft7Validator.check_schema(schema())
    jsonschema.Draft7Validator(schema()).validate(tomllib.loads(text))


class Page(HTMLParser):
    """Links, what is loaded, and anchors of a page."""

    def __init__(self, text):
        super().__init__()
        self.links, self.loaded, self.anchors = [], [], set()
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        self.anchors |= {given[key] for key in ("id", "name") if given.get(key)}
        if tag == "a" and given.get("href"):
            self.links.append(given["href"])
        elif tag in ("img", "script", "link") and (target := given.get("src") or given.get("href")):
            self.loaded.append(target)


def test_the_site_is_built_and_its_links_hold(tmp_path):
    mkdocs = shutil.which("mkdocs", path="/usr/bin") or shutil.which("mkdocs")
    if not mkdocs:
        pytest.skip("mkdocs is not installed")
    site = tmp_path / "site"
    done = subprocess.run(
        [mkdocs, "build", "--strict", "-f", HOME / "mkdocs.yml", "-d", site],
        cwd=tmp_path, capture_output=True, text=True, env=clean_environment() | SILENT,
    )  # fmt: skip
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
