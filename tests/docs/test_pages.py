"""What the pages show is run: commands, Python, scenes, the notebook."""

import json
import re
import tomllib
from functools import cache

import h5py
import pytest
from examples import (
    DOCS,
    PAGES,
    blocks,
    commands,
    file_of,
    folder_for,
    name_of,
    quotes,
    run_page,
    run_program,
)
from quotes import fault
from support import HOME

from galinx.app.scene.changes import changed
from galinx.app.scene.library import templates
from galinx.app.scene.read import parse
from galinx.app.scene.sections import SECTIONS
from galinx.postprocess.quantities import table

README = HOME / "README.md"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Of the pages' folders."""
    return tmp_path_factory.mktemp("pages")


@pytest.fixture(scope="module")
def outputs(folder):
    """Runs the examples of a page, once, and returns what they print."""
    return cache(lambda page: run_page(page, folder_for(page, folder)))


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_examples_of_a_page_run_and_print_what_it_quotes(page, outputs):
    told = outputs(page)
    faults = [
        f"{page.name} quotes {found}:\n{piece}"
        for block in quotes(page)
        for piece in block.split("…\n")
        if (found := fault(piece, told))
    ]
    assert not faults, "\n".join(faults)


@pytest.mark.parametrize("page", [page for page in PAGES if commands(page)], ids=name_of)
def test_no_example_of_a_page_fails_at_its_defaults(page, outputs, folder):
    outputs(page)
    archives = sorted((folder / page.name).rglob("*.h5"))
    verdicts = {path.name: _verdict(path) for path in archives}
    assert "FAIL" not in verdicts.values(), verdicts


def _verdict(path):
    with h5py.File(path) as file:
        return file.attrs["verdict"]


@pytest.mark.parametrize("page", [README], ids=name_of)
def test_the_first_command_reproduces_the_study(page, outputs, folder):
    printed = outputs(page)
    assert (printed.count(" yes "), printed.count(" NO ")) == (12, 0)
    assert (printed.count(" holds: "), printed.count(" does not: ")) == (17, 3)
    names = [*(f"fig{n}" for n in range(1, 11)), "sinusoidal", "laws", "inside", "mesh"]
    figures = {f"{name}.{kind}" for name in names for kind in ("pdf", "png")}
    assert figures | {"study.h5", "inside.h5", "tables.txt", "statements.txt", "report.html"} == {
        path.name for path in (folder / page.name / "results").iterdir()
    }


@pytest.mark.parametrize("page", [page for page in PAGES if blocks(page, "toml")], ids=name_of)
def test_scenes_of_a_page_are_valid(page):
    for block in blocks(page, "toml"):
        if file_of(block):  # the page's commands run it, with what it needs
            continue
        tree = tomllib.loads(block)
        if {"solid", "friction", "motion"} <= tree.keys():
            parse(block, page.name)
            continue
        if layers := tree.pop("layer", []):
            for keys in layers:
                assert keys.keys() <= SECTIONS["layer"].keys(keys).keys(), f"{page.name}: {keys}"
            solved = changed(templates()["coating"], {})
            head, _, rest = solved.partition("[[layer]]")
            parse(f"{head}{block}\n[friction]{rest.partition('[friction]')[2]}", page.name)
            continue
        changes = {}
        for section, keys in tree.items():
            known = SECTIONS[section].keys(keys)
            assert keys.keys() <= known.keys(), f"{page.name}: {keys.keys() - known.keys()}"
            changes |= {f"{section}.{key}": value for key, value in keys.items()}
        if "motion.speed" in changes:
            changes["motion.c"] = None
        if changes.get("punch.profile", "flat") != "flat":
            changes["punch.half_width"] = None
        parse(changed(templates()["tables4_5"], changes), page.name)


@pytest.mark.parametrize("page", [page for page in PAGES if blocks(page, "matlab")], ids=name_of)
def test_matlab_reads_datasets_that_exist(page):
    read = re.findall(r"h5read\('[^']+', '/([^']+)'\)", "\n".join(blocks(page, "matlab")))
    assert read
    assert set(read) <= table().keys()


def test_the_notebook_runs(tmp_path):
    """Its cells as one program; it is kept without what they printed."""
    notebook = json.loads((DOCS / "tutorial.ipynb").read_text(encoding="utf-8"))
    code = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
    assert not any(cell["outputs"] for cell in code), "clear the outputs of the notebook"
    said = run_program("\n".join("".join(cell["source"]) for cell in code), tmp_path)
    assert "PASS" in said and (tmp_path / "tables.html").exists()
