"""Every kind of solid under every kind of punch, by commands into an archive and out of it."""

import csv
import json

import pytest
from combined import LAYERS, METHODS, PRESSURE, PROFILE, SOLID, answers, cases, check_same
from support import THOROUGH, here

import galinx
from galinx.solvers.profiles import PROFILES
from galinx.solvers.solids import SOLIDS

TOLERANCE = 1e-2
#: Scenes by both methods, and those of them whose words and methods are tried one by one.
ALL = [
    case.but(tolerance=TOLERANCE, strokes=("forward", "backward") if THOROUGH else ("backward",))
    for case in cases(None if THOROUGH else "parabolic")
]
ALONE = ALL if THOROUGH else ALL[:10:9]


def test_every_kind_is_in_it():
    """A new one needs a sample in tests/combined.py: then it is met everywhere."""
    assert {one["kind"] for one in SOLID.values()} == set(SOLIDS)
    assert {one["profile"] for one in PROFILE.values()} == set(PROFILES)
    assert {layers[0]["kind"] for layers in LAYERS.values()} == set(SOLIDS)
    if not THOROUGH:
        assert {case.solid for case in ALL} == {*SOLID, *LAYERS}
        assert {case.punch for case in ALL} == {*PROFILE, *PRESSURE}


@pytest.fixture(scope="module")
def archived(tmp_path_factory):
    """Makes a case's archive by the command line, once; returns its path and its run."""
    folder, known = tmp_path_factory.mktemp("matrix"), {}

    def run(case):
        if case not in known:
            path = folder / f"{len(known)}.toml"
            path.write_text(case.text(), encoding="utf-8")
            known[case] = path.with_suffix(".h5"), here("run", path.name, cwd=folder)
        return known[case]

    return run


@pytest.mark.parametrize("case", ALL, ids=str)
def test_both_methods_agree(case, archived):
    path, done = archived(case)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr
    data, compared = answers(galinx.load(path).data), set()
    exact = METHODS[case.layered][0]
    for name, values in data.items():
        section, method, *rest = name.split("/")
        other = "/".join((section, "fem", *rest))
        if method != exact or other not in data:
            continue
        compared.add(section)
        check_same(values, data[other], 10.0 * TOLERANCE, name)
    if case.by_finite_elements:
        assert compared >= ({"interior", "interfaces", "surface"} & set(case.words))
    else:
        assert not any("/fem/" in name for name in data) and "does not solve this: " in done.stderr


@pytest.mark.parametrize(
    "case, method, word",
    [
        (case, method, word)
        for case in ALONE
        for method in case.methods
        for word in case.words
        if method != "fem" or case.by_finite_elements
    ],
    ids=str,
)
def test_asking_for_less_changes_no_number(case, method, word, archived):
    path, done = archived(case.but(methods=(method,), words=(word,)))
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr
    alone, whole = (answers(galinx.load(one).data) for one in (path, archived(case)[0]))
    for name, values in alone.items():
        if f"/{method}/" in name:
            check_same(whole[name], values, 10.0 * TOLERANCE if method == "fem" else 1e-9, name)


@pytest.mark.parametrize("case", ALL if THOROUGH else ALL[2::4], ids=str)
def test_every_command_reads_it(case, archived):
    path, _ = archived(case)
    folder, name = path.parent, path.name
    done = here("check", name, cwd=folder)
    assert done.returncode == 0, done.stdout + done.stderr
    data = galinx.load(path).data
    done = here("show", name, "--json", cwd=folder)
    assert done.returncode == 0, done.stderr
    assert [one["f"] for one in json.loads(done.stdout)["states"]] == data["states/f"].tolist()
    assert "verdict: " in here("show", name, cwd=folder).stdout
    places = {"--states": 1, "--surface": len(data["surface/X_over_a"])}
    places |= {"--inside": 4} if "interior" in case.words else {}
    for table, points in places.items():
        done = here("csv", name, table, cwd=folder)
        assert done.returncode == 0, done.stderr
        head, *rows = csv.reader(done.stdout.splitlines())
        assert len(rows) == points * len(data["states/f"])
        assert all(len(row) == len(head) and row[0] for row in rows)


@pytest.mark.parametrize("case", ALL[:: 1 if THOROUGH else 5], ids=str)
def test_it_has_a_page_and_fields_or_says_why_not(case, archived):
    path, _ = archived(case)
    done = here("report", path.name, "--overwrite", cwd=path.parent)
    assert done.returncode == 0, done.stderr
    page = path.with_suffix(".html").read_text(encoding="utf-8")
    assert page.rstrip().endswith("</html>") and "verdict" in page and "Plotly.react" in page
    done = here("fields", path.name, "--overwrite", "--extent", 2, cwd=path.parent)
    scene = galinx.load(path).scene
    refusals = {
        "layers": scene.layers, "ends that are given": scene.body.found,
        "ν": scene.solid.nearly_incompressible,
    }  # fmt: skip
    reasons = [word for word, holds in refusals.items() if holds]
    assert done.returncode == (2 if reasons else 0), done.stderr
    assert not reasons or any(word in done.stderr for word in reasons)
