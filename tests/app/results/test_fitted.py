"""Laws fitted in Python: comparison, several measurements, tables as other programs write them."""

import warnings
from itertools import pairwise

import numpy as np
import pytest

import galinx
from galinx.app.errors import BadInput
from galinx.app.results.fitted import ALL, read
from galinx.app.scene.read import parse
from galinx.solvers.friction import LAWS
from galinx.solvers.friction.fit import friction, moves
from galinx.solvers.parameters import build_model

REST = '[solid]\nmaterial = "steel"\n[motion]\nspeed = "1 mm/s"\n[output]\nquantities = ["friction"]\n'
LUGRE = {
    "mu_c": 0.3, "mu_s": 0.5, "stribeck_velocity": 2e-3, "sigma0_over_load": 3e4,
    "sigma1_over_load": 20.0,
}  # fmt: skip


def swing(name, parameters, samples=300, speed=2e-3, seed=1, noise=3e-3):
    """A sinusoidal motion of 0.1 mm, and a law's friction along it with noise."""
    t = np.linspace(0.0, 2e-4 * np.pi / speed, samples)
    X = 5e-5 * (1.0 - np.cos(speed / 5e-5 * t))
    kind = LAWS[name]
    f = friction(build_model(kind, parameters), moves(t, X, kind.depends_on_speed), samples)
    f[0] = 0.0
    return galinx.Measured(t, X, f + noise * np.random.default_rng(seed).standard_normal(samples))


def strokes(name, parameters, seed=1):
    """Strokes of 0.1 mm and less there and back, faster and faster, with noise of 0.003."""
    ends, speeds = np.array([0, 1, 0.2, 1]) * 1e-4, np.geomspace(1e-4, 1e-2, 3)
    at = np.append(0.0, np.cumsum(np.abs(np.diff(ends)) / speeds))
    t = np.append(0.0, np.concatenate([np.linspace(*leg, 16)[1:] for leg in pairwise(at)]))
    X = np.interp(t, at, ends)
    f = friction(build_model(LAWS[name], parameters), moves(t, X, True), len(t))
    f[0] = 0.0
    return galinx.Measured(t, X, f + 3e-3 * np.random.default_rng(seed).standard_normal(len(t)))


def test_of_all_laws_the_true_one_is_best_and_all_are_told():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = galinx.fit(strokes("dahl", {"mu_c": 0.4, "sigma0_over_load": 2.2e4}))
    assert {found.model, *(one.model for one in found.others), *found.failed} == {*LAWS}
    criteria = [found.aic, *(one.aic for one in found.others)]
    assert criteria == sorted(criteria)
    # A law that becomes Dahl's is as good, but for the parameters that it needs for it.
    assert found.model in ("dahl", "bouc_wen", "lugre")
    assert found.rms == pytest.approx(3e-3, rel=0.15)
    text = [" ".join(row) for row in found.sheet().rows]
    assert text[0].startswith(f"{found.model} 0.00") and len(text) == len(LAWS) - len(found.failed)


def test_what_the_data_do_not_determine_is_called_so():
    found = galinx.fit(swing("dahl", {"mu_c": 0.4, "sigma0_over_load": 2.2e4}), "lugre")
    section = found.scene()
    assert {"sigma1_over_load", "sigma2_over_load"} & {*found.not_determined}
    for key in found.not_determined:
        line = next(line for line in section.splitlines() if line.startswith(f"{key} = "))
        assert "not determined" in line
        if found.parameters[key] == 0.0:
            assert '"0 s/m"' in line
    assert parse(section + REST).friction.count == 1


def test_friction_that_drives_the_motion_has_the_wrong_sign():
    data = swing("dahl", {"mu_c": 0.3, "sigma0_over_load": 3e4})
    with pytest.raises(BadInput, match="drives the motion"):
        galinx.fit(galinx.Measured(data.t, data.X, -data.f), "dahl")
    assert galinx.fit(galinx.Measured(data.t, -data.X, -data.f), "dahl").model == "dahl"


def test_several_measurements_have_one_set_of_parameters():
    slow, fast = swing("lugre", LUGRE, 100, 5e-4), swing("lugre", LUGRE, 100, 2e-2, seed=2)
    both, alone, other = (
        galinx.fit(data, "lugre", fix={"stribeck_exponent": 2.0}) for data in ([slow, fast], slow, fast)
    )
    assert both.samples == alone.samples + other.samples and len(both.f) == 2
    for key, value in both.deviations.items():
        true = LUGRE.get(key, 0.0)
        assert abs(both.parameters[key] - true) < 4.0 * value, key
    assert both.deviations["mu_c"] < alone.deviations["mu_c"]
    first = friction(both.law, moves(slow.t, slow.X, True), 100)
    np.testing.assert_array_equal(both.f[0], first)


def written(measured, path, head="time [s],position [mm],f", decimal=".", separator=",", load=0.0):
    """A measurement as a table."""
    f = measured.f * (load or 1.0)
    columns = [measured.t, 1e3 * measured.X, f] + [np.full(len(f), -load)] * bool(load)
    rows = [separator.join(repr(float(x)).replace(".", decimal) for x in row) for row in zip(*columns)]
    path.write_text("\n".join([head.replace(",", separator), *rows]) + "\n", encoding="utf-8")
    return path


def test_tables_of_all_conventions_are_one_measurement(tmp_path):
    # Of 100 samples the two beside the turn would be alike, or not, as a processor rounds.
    measured = swing("dahl", {"mu_c": 0.4, "sigma0_over_load": 2.2e4}, 101)
    forms = [
        {}, {"decimal": ",", "separator": ";"}, {"decimal": ",", "separator": "\t"},
        {"separator": ";"}, {"head": "t (s),Displacement [mm],Friction Coefficient"},
    ]  # fmt: skip
    fits = [
        galinx.fit(written(measured, tmp_path / f"{n}.csv", **form), "dahl")
        for n, form in enumerate(forms)
    ]
    assert all(one.parameters == fits[0].parameters for one in fits)
    for names in ("friction force [mN/mm],normal load [N/m]", "F [kN],N [kN]"):
        head = f"time [s],position [mm],{names}"
        forces = galinx.fit(written(measured, tmp_path / "force.csv", head=head, load=250.0), "dahl")
        np.testing.assert_allclose(forces.tables[0].measured.f, fits[0].tables[0].measured.f, rtol=1e-12)


@pytest.mark.parametrize(
    "text, said",
    [
        ("slip [mm];f\n0;0,1\n1;0.2\n2;0,3\n", "line 2, f: found '0,1'.*with a decimal point"),
        ("slip [mm];f\n0;0\n1;1.234,5\n2;3\n", "line 3, f: found '1.234,5'"),
        ("slip [mm],f\n0,1,0,2\n", "line 2: found 4 columns.*separate columns by semicolons"),
        ("slip [mm],force [N]\n0,1\n1,1\n2,1\n", "a friction force without a load"),
        ("slip [mm],force [N],load [N/m]\n0,1,1\n1,1,1\n", "expected both in N, or both in N/m"),
        ("slip [mm],force,load\n0,1,1\n1,1,1\n", "expected both in N, or both in N/m"),
        ("slip [mm],force [N],load [N]\n0,1,1\n1,1,0\n2,1,1\n", "line 3: found no load"),
        ("slip [mm],force [N],load [N]\n0,1,1\n1,1,1\n2,1,-1\n", "line 4: found loads of two signs"),
        ("slip [mm],f\n", "three or more rows"),
        ("a,b\n1,2\n", r'expected "slip \[mm\],f", "time \[s\],position \[mm\],f", or with "force'),
        ("slip,f\n0,0\n1,x\n2,1\n", "line 3, f: found 'x', expected a finite number"),
        ("slip;f\n0;0\n1;\n2;1\n", "line 3, f: found '', expected a finite number; leave rows without"),
        ("slip,f\n0,0\n2,1\n1,1\n", "line 4: .* the slip grows; .* write time and position"),
        ("position [mm],f\n0,0\n1,1\n2,1\n", "line 1: found the columns .*; alone, a slip"),
        ("slip [mm],fricton\n0,0\n1,1\n", "did you mean friction"),
        ("slip[mm] f\n0 0\n1 2\n", "found one column; tabs, semicolons or commas separate columns, expe"),
        ("slip [mm],f\n0,0\n", "line 2: found 1 row, expected three or more rows"),
        ("time,position,f\n0,1,0\n1,1,0\n2,1,0\n", "found one position in all rows, expected a motion"),
        ("slip [s],f\n0,0\n1,1\n2,1\n", "line 1, slip: found 's'"),
        ("slip [mm],f\n5,0\n5.1,0.2\n5.2,0.3\n", "line 2: found slips from 5 mm to 5.2 mm, expected"),
        ("", "is empty"),
    ],
)  # fmt: skip
def test_faults_of_tables_are_told(tmp_path, text, said):
    (tmp_path / "a.csv").write_text(text, encoding="utf-8")
    with pytest.raises(BadInput, match=said):
        read(tmp_path / "a.csv")


@pytest.mark.parametrize(
    "t, X, f, said",
    [
        ([0, 1, 2], [0, 1, 2], [0, np.nan, 1], r"found f\[1\] = nan"),
        ([0, 1, 1], [0, 1, 2], [0, 1, 1], r"found t\[2\] = 1 s after 1 s, expected growing times"),
        ([0, 1, 2], [0, 1, 2], [0, 1], r"found the shapes t \(3,\), X \(3,\), f \(2,\)"),
        ([0, 1, 2], [1, 1, 1], [0, 1, 1], "found one position in all rows"),
        ([0, 1, 2], [0, 1, 2], [0, 0, 0], "found f = 0 in all rows, expected friction"),
        ([0, 1, 2], [0, 1, 2], ["a", 0, 0], "expected numbers"),
    ],
)  # fmt: skip
def test_faults_of_arrays_are_told(t, X, f, said):
    with pytest.raises(BadInput, match=said):
        galinx.fit(galinx.Measured(t, X, f), "dahl")


def test_lists_are_as_good_as_arrays():
    t, f = np.linspace(0.0, 1.0, 9), np.full(9, 0.3)
    f[0] = np.nan  # before the motion
    found = galinx.fit(galinx.Measured([*t], [*t], [*f]), "coulomb")
    assert found.parameters["mu_c"] == pytest.approx(0.3, rel=1e-9)


def test_of_two_columns_of_a_kind_the_first_is_read(tmp_path):
    (tmp_path / "a.csv").write_text("slip [mm],f,mu\n0,0,1\n1,1,1\n2,1,2\n", encoding="utf-8")
    table = read(tmp_path / "a.csv")
    assert table.measured.f.tolist() == [0.0, 1.0, 1.0]
    assert "columns 2 and 3 are both friction" in table.notes[0]


def test_speeds_are_those_of_the_tables(tmp_path):
    for n in (1, 2):
        (tmp_path / f"{n}.csv").write_text("slip [mm],f\n0,0\n0.1,0.2\n0.2,0.3\n", encoding="utf-8")
    files = [tmp_path / "1.csv", tmp_path / "2.csv"]
    found = galinx.fit(files, "coulomb", speed=["1 mm/s", 0.002])
    np.testing.assert_allclose([table.measured.t[-1] for table in found.tables], [0.2, 0.1])
    assert "not fitted: 2 of 6 samples" in found.notes[0]
    with pytest.raises(BadInput, match="found 3 for 2 tables of slips"):
        galinx.fit(files, "coulomb", speed=[1.0, 2.0, 3.0])
    found = galinx.fit(files, ALL)
    assert "give --speed" in found.failed["lugre"]


@pytest.mark.parametrize("model, parameters, offset", [
    ("coulomb", {"mu_c": 0.0}, 0.3), ("coulomb", {"mu_c": 0.3}, 0.0),
    ("dahl", {"mu_c": 0.4, "sigma0_over_load": 2e4}, 0.1),
    ("dahl", {"mu_c": 0.4, "sigma0_over_load": 2e4}, 0.0),
])  # fmt: skip
def test_friction_that_no_law_follows_is_called_so(model, parameters, offset):
    """As one of one sign in a motion to and fro, or one of which an offset was not taken off."""
    swung = swing(model, parameters)
    found = galinx.fit(galinx.Measured(swung.t, swung.X, swung.f + offset), model)
    said = offset > 0.0
    assert any("does not follow the data" in note for note in found.notes) == said


def test_friction_in_per_cent_is_said_to_be_unusual(tmp_path):
    d = np.linspace(0.0, 2e-4, 40)
    path = written(galinx.Measured(d, d, 40.0 * -np.expm1(-2e4 * d)), tmp_path / "a.csv")
    (note,) = (note for note in galinx.fit(path, "dahl", fix={"delta": 1.0}).notes if "usual" in note)
    assert note.startswith("mu_c = 40 is unusual, usual is 0.0001 to 10")
    with pytest.raises(BadInput, match="more than once, expected each measurement once"):
        galinx.fit([path, path], "dahl")


@pytest.mark.parametrize("data, found", [([], "nothing"), ([1.5], r"1\.5"), (np.zeros((2, 2)), "array")])
def test_data_that_are_no_measurements_are_named(data, found):
    with pytest.raises(BadInput, match=f"data: found {found}.*, expected names of files"):
        galinx.fit(data, "dahl")


@pytest.mark.parametrize(
    "options, said",
    [({"rows": 0}, "rows: found 0, expected a whole number from 1 to 20"),
     ({"rows": 1.5}, r"rows: found 1\.5"),
     ({"fix": "k"}, "fix or start: found 'k', expected numbers by key"),
     ({"fix": {"elements": 3}}, "elements: found 3, expected rows"),
     ({"fix": {"elements": "[[1, .2]]"}}, r"elements: found .*, expected rows"),
     ({"fix": {"elements": [[-1.0, 0.1]]}}, "expected stiffnesses and limits above 0"),
     ({"model": None}, "friction law: found None, expected a text")],
)  # fmt: skip
def test_options_of_a_fit_that_are_none_are_named(options, said):
    t = np.linspace(0.0, 1.0, 60)
    measured = galinx.Measured(t, 1e-4 * t, 0.3 * -np.expm1(-20.0 * t))
    with pytest.raises(BadInput, match=said):
        galinx.fit(measured, **{"model": "maxwell_slip"} | options)


def test_masked_samples_are_refused():
    """Without their mask they are numbers like others."""
    t = np.linspace(0.0, 1.0, 60)
    f = np.ma.array(np.where(t > 0.6, 9.0, 0.4), mask=t > 0.6)
    with pytest.raises(BadInput, match="found masked or complex numbers"):
        galinx.fit(galinx.Measured(t, t, f), "coulomb")


def test_a_fit_shows_its_work_where_it_is_asked_to():
    t = np.linspace(0.0, 1.0, 60)
    measured = galinx.Measured(t, 1e-4 * t, 0.3 * -np.expm1(-20.0 * t))
    shown = galinx.fit(measured, "dahl", progress=True, rows=np.int64(2))
    assert shown.rms == galinx.fit(measured, "dahl").rms
