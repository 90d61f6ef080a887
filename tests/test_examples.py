"""What the pages show is run: commands, Python, scenes, the notebook; and the pages are built."""

import hashlib
import os
import re
import runpy
import shlex
import shutil
import subprocess
import tomllib
from concurrent.futures import Future, ThreadPoolExecutor
from html.parser import HTMLParser
from pathlib import Path
from threading import Lock
from urllib.parse import unquote, urlsplit

import attrs
import pytest
from conftest import HOME, clean_environment

from app.changes import changed
from app.cli import cli
from app.scene import SECTIONS, parse
from app.templates import templates
from postprocess.fields import FIELDS

DOCS = HOME / "docs"
PAGES = [HOME / "README.md", HOME / "CONTRIBUTING.md", *sorted(DOCS.glob("*.md"))]
SCENES = sorted((HOME / "scenes").glob("*.toml"))

#: Words of run.sh that take minutes, run the tests themselves or write into the checkout.
NOT_RUN = ("test", "bench", "stress", "docs")

_FENCE = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
_COMMAND = re.compile(r"\s*(\w+=\S+ |for .*; do )*\./run\.sh\b")
_STATUS = re.compile(r"#.*\bstatus (\d)\b")
_SILENT = {"MPLBACKEND": "Agg", "PYTHONDONTWRITEBYTECODE": "1"}


def name_of(page):
    return page.name


def text_of(page):
    return page.read_text(encoding="utf-8")


def blocks(page, kind):
    """Bodies of the fenced blocks of one kind."""
    return [body for language, body in _FENCE.findall(text_of(page)) if language == kind]


def commands(page):
    """Lines with ./run.sh of indented blocks and of console blocks."""
    found, language = [], None
    for line in text_of(page).splitlines():
        if line.startswith("```"):
            language = line[3:] if language is None else None
        elif _COMMAND.match(line) and (language == "console" or (not language and line[:4] == "    ")):
            found.append(line.strip())
    return found


def words_of(command):
    """What follows ./run.sh, without comment."""
    words = shlex.split(command, comments=True)
    return words[words.index("./run.sh") + 1 :]


class Shelf:
    """Runs commands, from several threads; what ran before on the same files is taken from the shelf."""

    def __init__(self, folder):
        self._folder, self._known, self._lock = folder, {}, Lock()

    def run(self, command, cwd):
        """Status and output of a command line of a page in ``cwd``."""
        words = words_of(command) or ["paper", "-o", "results"]
        key = (command.split("./run.sh")[0].strip(), *words, *_digests(words, cwd))
        with self._lock:
            mine = key not in self._known
            done = self._known.setdefault(key, Future())
            folder = self._folder / str(len(self._known))
        if mine:
            try:
                done.set_result(self._record(command, cwd, folder))
            except BaseException as error:
                done.set_exception(error)
        status, told, files = done.result()
        if not mine:
            shutil.copytree(files, cwd, dirs_exist_ok=True)
        return status, told

    def _record(self, command, cwd, kept):
        before = _state(cwd)
        done = subprocess.run(
            ["bash", "-c", command], cwd=cwd, env=clean_environment() | _SILENT, text=True,
            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=200,
        )  # fmt: skip
        kept.mkdir()
        for path, stamp in _state(cwd).items():
            if before.get(path) != stamp:
                (kept / path).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy2(cwd / path, kept / path)
        return done.returncode, done.stdout, kept


def _files(cwd):
    """Files below a page's folder; scenes/ and run.sh are those of the checkout."""
    return [
        path.relative_to(cwd)
        for path in cwd.rglob("*")
        if path.is_file() and path.relative_to(cwd).parts[0] not in ("scenes", "run.sh")
    ]


def _state(cwd):
    return {path: (cwd / path).stat().st_mtime_ns for path in _files(cwd)}


def _digests(words, cwd):
    """Of the files that a command names or could find in its way."""
    named = {word.split("=")[-1] for word in words}
    named |= {Path(word).stem + ".h5" for word in words if word.endswith(".toml")}
    return sorted(
        (str(path), hashlib.sha256((cwd / path).read_bytes()).hexdigest())
        for path in _files(cwd)
        if str(path) in named
    )


def folder_for(page, folder):
    """A page's folder, in which ./run.sh and scenes/ are those of the checkout."""
    made = folder / page.name
    made.mkdir()
    script = made / "run.sh"
    script.write_text(f'#!/bin/sh\nexec {shlex.quote(str(HOME / "run.sh"))} "$@"\n')
    script.chmod(0o755)
    (made / "scenes").symlink_to(HOME / "scenes")
    return made


@pytest.fixture(scope="module")
def outputs(request, tmp_path_factory):
    """What the examples print, by page; the pages that are tested run side by side."""
    folder = tmp_path_factory.mktemp("pages")
    shelf = Shelf(tmp_path_factory.mktemp("shelf"))
    pages = [
        item.callspec.params["page"]
        for item in request.session.items
        if "outputs" in getattr(item, "fixturenames", ()) and item.path == Path(__file__)
    ]
    with ThreadPoolExecutor(min(4, os.cpu_count() or 1)) as pool:
        yield {page: pool.submit(run_page, page, shelf, folder_for(page, folder)) for page in pages}
        pool.shutdown(cancel_futures=True)


def run_page(page, shelf, folder):
    """Run the commands of a page in order, then its Python; what both print."""
    output, faults = "", []
    for command in commands(page):
        words = words_of(command)
        if words and words[0] in NOT_RUN:
            continue
        wanted = int((_STATUS.search(command) or [0, 0])[1])
        status, told = shelf.run(command, folder)
        output += told
        if status != wanted:
            faults.append(f"{command}\n  status {status}, expected {wanted}\n{told[-1500:]}")
    assert not faults, "\n".join(faults)
    return output + run_python(page, folder)


def run_python(page, folder):
    """Run the Python blocks of a page as one program; its output."""
    program = "\n".join(blocks(page, "python"))
    if not program:
        return ""
    done = subprocess.run(
        ["/usr/bin/python3", "-c", program], cwd=folder, text=True, timeout=200,
        env=clean_environment() | _SILENT | {"PYTHONPATH": str(HOME), "OMP_NUM_THREADS": "1"},
        stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
    )  # fmt: skip
    assert done.returncode == 0, f"{page.name}: {done.stdout}"
    return done.stdout


def without_numbers(text):
    """For comparison of output: numbers and line breaks may differ."""
    return " ".join(re.sub(r"[-+]?\d+(\.\d+)?(e[-+]?\d+)?", "#", text).split())


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_examples_of_a_page_run_and_print_what_it_quotes(page, outputs):
    told = without_numbers(outputs[page].result())
    for block in blocks(page, "text"):
        for piece in block.split("…\n"):
            assert without_numbers(piece) in told, f"{page.name} quotes what is not printed:\n{piece}"


def test_only_long_words_are_left_out():
    assert NOT_RUN == ("test", "bench", "stress", "docs")
    script = (HOME / "run.sh").read_text(encoding="utf-8")
    for word in NOT_RUN:
        assert f'"${{1:-}}" = {word} ]' in script or word in cli.commands, f"run.sh does not know {word}"
    shown = [command for page in PAGES for command in commands(page)]
    assert len(shown) > 50
    assert sum(words_of(command)[:1] not in ([word] for word in NOT_RUN) for command in shown) > 45


@pytest.mark.parametrize("page", [page for page in PAGES if blocks(page, "toml")], ids=name_of)
def test_scenes_of_a_page_are_valid(page):
    for block in blocks(page, "toml"):
        tree = tomllib.loads(block)
        if {"solid", "friction", "motion"} <= tree.keys():
            parse(block, page.name)
            continue
        changes = {}
        for section, keys in tree.items():
            known = {field.name for field in attrs.fields(SECTIONS[section])}
            assert keys.keys() <= known, f"{page.name}: {keys.keys() - known}"
            changes |= {f"{section}.{key}": value for key, value in keys.items()}
        if "motion.speed" in changes:
            changes["motion.c"] = None
        parse(changed(templates()["tables4_5"].text, changes), page.name)


@pytest.mark.parametrize("page", [page for page in PAGES if blocks(page, "matlab")], ids=name_of)
def test_matlab_reads_datasets_that_exist(page):
    read = re.findall(r"h5read\('[^']+', '/([^']+)'\)", "\n".join(blocks(page, "matlab")))
    assert read
    assert set(read) <= FIELDS.keys()


@pytest.mark.parametrize("page", [page for page in PAGES if blocks(page, "bash")], ids=name_of)
def test_shell_scripts_of_a_page_parse(page):
    for block in blocks(page, "bash"):
        done = subprocess.run(["bash", "-n"], input=block, capture_output=True, text=True)
        assert done.returncode == 0, f"{page.name}: {done.stderr}"


def test_made_pages_are_up_to_date():
    for path, text in runpy.run_path(str(DOCS / "make.py"))["pages"]().items():
        assert path.read_text(encoding="utf-8") == text, (
            f"{path.relative_to(HOME)} is out of date: PYTHONPATH=. /usr/bin/python3 docs/make.py"
        )


def test_the_schema_is_what_the_command_prints():
    from conftest import command

    assert command("schema").stdout == (HOME / "scenes" / "scene.schema.json").read_text(encoding="utf-8")


@pytest.mark.parametrize("path", SCENES, ids=name_of)
def test_scenes_follow_the_schema(path):
    jsonschema = pytest.importorskip("jsonschema")
    from app.schema import schema

    text = path.read_text(encoding="utf-8")
    parse(text, path.name)
    jsonschema.Draft7Validator.check_schema(schema())
    jsonschema.Draft7Validator(schema()).validate(tomllib.loads(text))


def test_the_notebook_runs(tmp_path):
    nbformat = pytest.importorskip("nbformat")
    pytest.importorskip("nbclient")
    pytest.importorskip("ipykernel")
    source = DOCS / "tutorial.ipynb"
    notebook = nbformat.read(source, as_version=4)
    nbformat.validate(notebook)
    assert not any(cell.get("outputs") for cell in notebook.cells), "clear the outputs of the notebook"
    shutil.copy(source, tmp_path)
    # A process of its own: MPI in this one must not reach the kernel.
    program = (
        "import nbformat, nbclient\n"
        "notebook = nbformat.read('tutorial.ipynb', as_version=4)\n"
        "nbclient.NotebookClient(notebook, timeout=120, kernel_name='python3').execute()\n"
    )
    done = subprocess.run(
        ["/usr/bin/python3", "-c", program], cwd=tmp_path, capture_output=True, text=True, timeout=200,
        stdin=subprocess.DEVNULL,
        env=clean_environment() | {"PYTHONPATH": str(HOME), "PYTHONDONTWRITEBYTECODE": "1"}
        | {"IPYTHONDIR": str(tmp_path / "ipython"), "JUPYTER_RUNTIME_DIR": str(tmp_path / "runtime")},
    )  # fmt: skip
    assert done.returncode == 0, done.stderr[-3000:]


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
        cwd=tmp_path, capture_output=True, text=True, env=clean_environment() | _SILENT,
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
