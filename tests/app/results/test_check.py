"""An archive that contradicts its scene or numbers is found out; no verdict is PASS over no answer."""

import hashlib
import json
import shutil
from pathlib import Path

import h5py
import numpy as np
import pytest
from support import computed
from tampering import lost, opened, value

import galinx
from galinx.app.methods import METHODS
from galinx.app.results import check
from galinx.postprocess.errors import UnreadableArchive
from galinx.postprocess.hdf5 import archive


@pytest.fixture(scope="module")
def sound(inside_run, tmp_path_factory):
    """An archive without faults, to be read only."""
    path = tmp_path_factory.mktemp("sound") / "whole.h5"
    inside_run.save(path)
    assert check.faults(path) == []
    return path


@pytest.fixture
def whole(sound, tmp_path):
    """A copy of it that may be changed."""
    return Path(shutil.copy(sound, tmp_path))


def test_states_may_be_looked_at_a_few_at_a_time(sound, monkeypatch):
    monkeypatch.setattr(check, "_ROWS", 1)
    assert check.faults(sound) == []


def times(name, factor):
    def apply(file):
        file[name][...] *= factor

    return apply


def of_scene(old, new):
    """The archive of another scene, by its digest, too."""

    def apply(file):
        text = file["scene/text"].asstr()[()].replace(old, new)
        file["scene/text"][()] = text
        file.attrs["scene_sha256"] = hashlib.sha256(text.encode()).hexdigest()

    return apply


@pytest.mark.parametrize(
    "changed, message",
    [
        (times("states/g", -1.0), "states/g holds something else"),
        (value("interior/map", 3), "interior/map holds other positions than its scene gives"),
        (value("states/motion", "BM7"), "states/motion holds something else"),
        (of_scene("mu_c", "delta = 0.9\nmu_c"), "states/f holds something else"),
        (of_scene("X_over_L = 0.8", "X_over_L = [0.7, 0.8]"), "it holds 2 states, its scene has 4"),
        (lost("states/fem/v0"), "states/fem/v0 is missing, its scene asks for it"),
        (times("states/fem/K_I_right", 1.0 + 1e-3), "states/fem/true_error is not what"),
        (value("interior/fem/sigma_XX", 1e3), "its comparisons say"),
        (value("run/fem/largest_residual", -1.0), "largest_residual has numbers out of its range, >= 0"),
        (value("interior/fem/sigma_XX", np.nan), "interior/fem/sigma_XX is not finite in states 0 ..."),
    ],
)
def test_what_does_not_fit_is_said(whole, changed, message):
    with opened(whole, sealed=False) as file:
        changed(file)
    with pytest.raises(UnreadableArchive, match="damaged"):
        check.faults(whole)
    archive.put(whole)
    assert any(message in fault for fault in check.faults(whole))


#: Small archives of each way to a number.
SMALL = {
    "both methods": (
        "tables4_5",
        {
            "motion.c": 0.6, "motion.strokes": ["forward"], "motion.X_over_L": [0.5],
            "output.quantities": ["sif", "surface", "interior"], "output.points": [[0.2, -0.7]],
        },
    ),
    "finite elements alone": (
        "cylinder",
        {
            "motion.c": 0.6, "motion.X_over_L": [0.5], "solve.methods": ["fem"], "output.map": None,
            "output.quantities": ["sif", "surface"],
        },
    ),
    "yield": (
        "cylinder",
        {
            "motion.c": 0.6, "motion.X_over_L": [0.5], "solve.methods": ["closed_form"],
            "output.map": None, "output.quantities": ["yield"], "motion.strokes": ["forward"],
        },
    ),
    "layers": (
        "coating",
        {
            "solve.methods": ["sie"], "output.quantities": ["sif", "surface"], "motion.X_over_L": [0.5],
            "motion.strokes": ["forward"],
        },
    ),
}  # fmt: skip


#: What nobody can tell again of the work; the pressure that assumes no exponent, which is rough;
#: and places, which may be anywhere where something is flat.
NOT_COMPUTED = {
    *(f"run/fem/{name}" for name in ("back_substitutions", "change_by_degree", "factorisations",
      "iterations", "largest_condition", "largest_residual")),
    "run/seconds", "surface/fem/sigma_YY_raw", "states/fem/largest_pressure_position",
    "states/fem/sigma_XX_max_X_over_a", "states/fem/sigma_XX_min_X_over_a",
}  # fmt: skip
OF_THE_RUN = {"created", "machine", "program", "version", "versions"}


@pytest.mark.parametrize("name", SMALL)
def test_every_number_of_an_archive_is_computed_again_or_compared(name, tmp_path):
    """Each by itself a tenth larger, and with a new digest: nobody takes it for what it was.

    Attributes and numbers of no method are those of all: they are tried in the first archive.
    """
    path, changed = tmp_path / "small.h5", tmp_path / "changed.h5"
    computed(*SMALL[name]).save(path)
    assert check.faults(path) == []
    with h5py.File(path) as file:
        found: list[str] = []
        file.visititems(lambda name, item: found.append(name) if isinstance(item, h5py.Dataset) else None)
        numbers = [
            path
            for path in found
            if file[path].dtype.kind in "if" and np.nan_to_num(file[path][()]).any()
        ]
        attributes = list(file.attrs)
    if name != next(iter(SMALL)):
        numbers, attributes = [one for one in numbers if {*one.split("/")} & {*METHODS}], []
    missed = []
    for number in numbers:
        shutil.copy(path, changed)
        with opened(changed) as file:
            file[number][...] = file[number][()] * (2 if file[number].dtype.kind == "i" else 1.1)
        if not refused(changed):
            missed.append(number)
    assert set(missed) <= NOT_COMPUTED
    missed = []
    for number in attributes:
        shutil.copy(path, changed)
        with opened(changed) as file:
            value = file.attrs[number]
            text = "[]" if str(value)[:1] == "[" else "{}" if str(value)[:1] == "{" else "another"
            if isinstance(value, str) and value == text:
                continue
            file.attrs[number] = text if isinstance(value, str) else value * 1.1
        if not refused(changed):
            missed.append(number)
    assert set(missed) <= OF_THE_RUN


def refused(path):
    try:
        return bool(check.faults(path))
    except UnreadableArchive:
        return True


ONE = {"motion.strokes": ["forward"], "motion.X_over_L": 0.8, "motion.c": 0.3}
CLOSED = {"solve.methods": ["closed_form"]}


@pytest.mark.parametrize(
    "nan_allowed, verdict", [("never", "FAIL"), ("beside the punch", "FAIL"), ("anywhere", "PASS")]
)
def test_a_nan_that_is_not_allowed_fails(nan_allowed, verdict, monkeypatch, tmp_path):
    row = galinx.Quantity(
        "surface/closed_form/nan", "1", "nothing", ("states", "points"),
        lambda s, _: np.where(s.surface.places.under, np.nan, 1.0) * np.ones((len(s.g), 1)),
        "closed_form", asked_by="surface", nan_allowed=nan_allowed,
    )  # fmt: skip
    monkeypatch.setitem(galinx.QUANTITIES, row.path, row)
    result = computed("tables4_5", ONE | CLOSED)
    assert result.verdict == verdict
    reasons = json.loads(result.attributes["verdict_reasons"])
    assert any("not finite" in reason for reason in reasons) == (verdict == "FAIL")


@pytest.mark.parametrize("changes", [
    {  # exponents that cannot be fitted: the raw pressure changes its sign beside an edge
        "friction": {"mu_c": 5.0, "sigma0_over_load": 1e7}, "solve": {"tolerance": 1e-4},
        "motion": {"c": 0.82746, "strokes": ["forward"], "X_over_L": 0.8},
    },
    {  # no degree reaches the tolerance but on finer cells
        "solid": {"kind": "anisotropic", "rho": 3000, "stiffness": [5e10, 2e10, 5e9, 4e10, -3e9, 1.5e10]},
        "punch": {"profile": "parabolic", "radius": 4e-3, "load": 6e3},
        "friction": {"mu": 0.7}, "motion": {"c": 0.82}, "solve": {"tolerance": 1e-4},
        "output": {"quantities": ["sif", "surface"]},
    },
    {  # middles that are rounding, where there is no friction
        "punch": {"profile": "power", "exponent": 1.5, "coefficient": 0.03, "load": 190},
        "friction": {"mu": [0.0, 0.3]}, "motion": {"c": [0.0, 0.3]},
        "solve": {"methods": ["closed_form"]}, "output": {"quantities": ["sif"]},
    },
    {  # half-widths by finite elements, and strokes over them
        "punch": {"profile": "parabolic", "radius": "20 mm", "load": "20 N/mm"}, "motion": {"c": 0.8},
        "friction": {"mu_c": 0.3, "sigma0_over_load": "20000 1/m", "pre_sliding": "1 mm"},
        "solve": {"methods": ["fem"], "tolerance": 1e-3}, "output": {"quantities": ["sif"]},
    },
    {  # estimates of more frictions than are computed again, and under other loads
        "punch": {"half_width": 2e-4, "load": [1e3, 1e4]}, "motion": {"c": 0.01},
        "friction": {"mu": [0.1, 0.3, 0.05, 0.2, 0.25, 0.07]},
        "solve": {"methods": ["sie"], "tolerance": 1e-3}, "output": {"quantities": ["sif", "surface"]},
    },
])  # fmt: skip
def test_what_was_just_computed_has_no_faults(changes, tmp_path):
    result = computed(changes={"solve": None, "output": None} | changes)
    assert not np.isnan([*result.comparisons.values()]).any()
    result.save(tmp_path / "a.h5")
    assert check.faults(tmp_path / "a.h5") == []


def test_wave_crossings_follow_from_archived_half_widths(tmp_path):
    punch = {"profile": "parabolic", "radius": "20 mm", "load": "20 N/mm"}
    computed(changes={"punch": punch, "solve": {"methods": ["closed_form"]}}).save(tmp_path / "a.h5")
    assert check.faults(tmp_path / "a.h5") == []
    with opened(tmp_path / "a.h5") as file:
        times("states/wave_crossings", 1.001)(file)
    assert check.faults(tmp_path / "a.h5") == ["states/wave_crossings is not what its half-widths give"]
