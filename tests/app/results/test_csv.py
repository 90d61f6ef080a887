"""Archives as tables of comma-separated values."""

import csv
from itertools import pairwise

import numpy as np
import pytest
from support import computed, here, kept

from galinx.app.results import csv as tables
from galinx.postprocess.hdf5 import archive

MAP = {"X": [-2, 2, 5], "Y": [-2, -0.1, 4]}
INSIDE = {
    "solve.methods": ["closed_form"], "output.quantities": ["sif", "surface", "interior"],
    "output.map": MAP, "motion.c": {"from": 0.0, "to": 0.6, "number": 3},
}  # fmt: skip


@pytest.fixture(scope="module")
def result():
    return computed("tables4_5", INSIDE)


@pytest.fixture(scope="module")
def path(result, tmp_path_factory):
    path = tmp_path_factory.mktemp("csv") / "a.h5"
    result.save(path)
    return path


def read(path, *of):
    """Columns by head, as texts."""
    head, *rows = csv.reader("".join(tables.pieces(path, *of)).splitlines())
    assert len(set(head)) == len(head)
    return dict(zip(head, zip(*rows)))


def numbers(column):
    return np.array([float(cell or "nan") for cell in column])


def test_a_row_a_state_has_what_tells_it_apart_first_and_all_digits(path, result):
    found, data = read(path, "states", True), result.data
    heads = ["state", "motion", "f [1]", "c [1]", "load [N/m]", "mu_c [1]", "sigma0_over_load [1/m]"]
    assert [*found][:9] == [*heads, "delta [1]", "X_over_L [1]"]
    assert found["state"] == tuple(map(str, range(len(data["states/f"]))))
    assert found["motion"] == tuple(data["states/motion"])
    single = [name for name in data if name.startswith("states/") and data[name].ndim == 1]
    for name in (name for name in single if name not in ("states/motion", "states/speed")):
        (head,) = (head for head in found if head.startswith(f"{name[7:].replace('/', '_')} ["))
        assert np.array_equal(numbers(found[head]), data[name], equal_nan=True), name


def test_a_row_for_each_state_and_point(path, result):
    found, data = read(path, "surface", True), result.data
    stress, X = data["surface/closed_form/sigma_YY"], data["surface/X_over_a"]
    assert stress.shape == (len(data["states/c"]), len(X))
    assert np.array_equal(numbers(found["closed_form_sigma_YY [N/(2a)]"]), stress.ravel(), equal_nan=True)
    assert "" in found["closed_form_sigma_YY [N/(2a)]"] and "nan" not in {*sum(found.values(), ())}
    assert (numbers(found["X_over_a [1]"]) == np.tile(X, len(stress))).all()
    assert (numbers(found["c [1]"]) == np.repeat(data["states/c"], len(X))).all()
    assert (numbers(found["state"]) == np.repeat(np.arange(len(stress)), len(X))).all()


def test_in_si(path, result):
    data, scene = result.data, result.scene
    a = scene.punch.profile.half_width
    found = read(path, "inside")
    assert [*found][7] == "load [N/mm]" and set(numbers(found["load [N/mm]"])) == {scene.punch.load / 1e3}
    assert [*found][8:] == [
        "X [mm]",
        "Y [mm]",
        *(f"closed_form_sigma_{ij} [MPa]" for ij in ("XX", "YY", "XY", "1", "2")),
        "closed_form_von_mises [MPa]",
    ]
    stress = data["interior/closed_form/sigma_XY"] * scene.punch.load / (2e6 * a)
    assert numbers(found["closed_form_sigma_XY [MPa]"]) == pytest.approx(stress.ravel(), rel=1e-14)
    assert numbers(found["Y [mm]"])[:20] == pytest.approx(1e3 * a * data["interior/Y_over_a"], rel=1e-14)
    speeds = np.unique(numbers(found["speed [m/s]"]))
    assert speeds == pytest.approx(scene.solid.c_s * np.array([0.0, 0.3, 0.6]), rel=1e-14)
    of_law = "sigma0_over_load [1/m]"
    assert numbers(found[of_law]).tolist() == numbers(read(path, "inside", True)[of_law]).tolist()


@pytest.mark.parametrize("which", ["states", "surface", "inside"])
@pytest.mark.parametrize("together", [7, 10**6])
def test_few_rows_are_read_and_written_at_once(path, which, together, monkeypatch):
    whole = "".join(tables.pieces(path, which))
    asked, rows = [], archive.Archive.rows

    def recorded(self, some, names):
        asked.append((some, {name.split("/")[0] for name in names}))
        return rows(self, some, names)

    monkeypatch.setattr(archive.Archive, "rows", recorded)
    monkeypatch.setattr(tables, "_TOGETHER", together)
    head, *pieces = tables.pieces(path, which)
    assert head.count("\n") == 1 and all(1 <= piece.count("\n") <= together for piece in pieces)
    assert head + "".join(pieces) == whole
    assert all(one.stop == other.start for (one, _), (other, _) in pairwise(asked))
    others = {"surface", "interior"} - {{"inside": "interior"}.get(which, which)}
    assert not any(sections & others for _, sections in asked)


def test_the_command_prints_a_table_or_writes_it(path, tmp_path):
    printed, output = here("csv", path, "--surface"), tmp_path / "a.csv"
    assert printed.returncode == 0 and printed.stdout == "".join(tables.pieces(path, "surface"))
    for _ in range(2):  # its own is made again
        assert here("csv", path, "--surface", "-o", output).returncode == 0
    assert output.read_text(encoding="utf-8") == printed.stdout
    assert here("csv", path, "--dimensionless", "-o", output).returncode == 0
    assert here("csv", path, "-o", output).returncode == 0
    output.write_text("state,mine\n", encoding="utf-8")
    refused = here("csv", path, "-o", output)
    assert refused.returncode == 2 and "is not a table of galinx" in refused.stderr
    both = here("csv", path, "--surface", "--inside")
    assert both.returncode == 2 and "--surface and --inside exclude each other" in both.stderr


@pytest.mark.parametrize("load", ["100 N/mm", ["10 N/mm", "100 N/mm"]])
def test_histories_tell_their_laws(load, tmp_path):
    """A loop is that of all speeds, and of all loads: of several it names that of its energy alone."""
    alone = {"solve.methods": [], "output.quantities": ["friction"], "motion.c": [0.1, 0.3]}
    result = computed("tables4_5", alone | {"friction.mu_c": [0.2, 0.4], "punch.load": load})
    result.save(tmp_path / "a.h5")
    found, loops = read(tmp_path / "a.h5", "histories"), result.data["loops/f"]
    assert numbers(found["mu_c [1]"]).reshape(loops.shape).tolist() == [
        [μ] * loops.shape[1] for μ in (0.2, 0.4)
    ]
    assert not any(head.startswith("speed") for head in found)
    head, first = ("load", 100.0) if isinstance(load, str) else ("cycle_dissipated_load", 10.0)
    assert {*numbers(found[f"{head} [N/mm]"])} == {first}
    assert len([head for head in found if "load" in head]) == 2  # the other is sigma0_over_load
    np.testing.assert_allclose(numbers(found["f [1]"]), loops.ravel(), rtol=1e-14)


@pytest.mark.parametrize(
    "name, head", [("from rest", "t [µs]"), ("slider", "time [s]"), ("flat", "state")]
)
def test_the_table_of_a_motion_is_that_of_its_times(name, head, tmp_path):
    kept(name).save(tmp_path / "a.h5")
    assert head in here("csv", tmp_path / "a.h5").stdout.splitlines()[0].split(",")
