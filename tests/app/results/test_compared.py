"""Results beside each other, and measured points over figures."""

import re

import numpy as np
import pytest
from support import computed, here

import galinx
from galinx.app.errors import BadInput
from galinx.app.figures.measured import read
from galinx.app.results import fitted
from galinx.app.results.compared import Comparison
from galinx.app.scene.library import LIBRARY
from galinx.app.scene.read import parse

PLAIN = {"solve.methods": ["closed_form"], "motion.c": 0.3}
HEAVY = {"punch.load": "600 N/mm", "friction.mu_c": 0.5, "title": "heavy"}
POINTS = "position [mm],pressure [MPa],sigma_XX [MPa]\n-0.5,15.5,-20\n0,17.25,-30.5\n0.75,2e3,-25\n"


@pytest.fixture(scope="module")
def light():
    return computed("tables4_5", PLAIN)


@pytest.fixture(scope="module")
def heavy():
    """Ten times the load, less friction, and one place more on the strokes, before the others."""
    return computed("tables4_5", PLAIN | HEAVY | {"motion.X_over_L": [0.1, 0.2, 0.8]})


@pytest.fixture(scope="module")
def two(light, heavy, tmp_path_factory):
    paths = [tmp_path_factory.mktemp("two") / f"{name}.h5" for name in ("light", "heavy")]
    for path, result in zip(paths, (light, heavy)):
        result.save(path)
    return paths


@pytest.fixture
def table(tmp_path):
    """Function that writes a table of measured points."""

    def write(text):
        path = tmp_path / "device.csv"
        path.write_text(text, encoding="utf-8")
        return path

    return write


def dots(axis):
    """Numbers of the points of a panel."""
    (line,) = [line for line in axis.lines if line.get_color() == "black" and line.get_marker() == "o"]
    return line.get_xydata()


def by_name(columns):
    return {column.name: column for column in columns}


def test_states_are_paired_by_their_parameters(light, heavy):
    columns = by_name(galinx.compare(light, heavy))
    for name in ("motion", "X_over_L"):
        assert list(columns[f"{name}_1"].values) == list(columns[f"{name}_2"].values)
    assert columns["X_over_L_1"].values.tolist() == light.data["states/X_over_L"].tolist()
    own = {column.name: column for column in heavy.table()}
    kept = np.flatnonzero(np.asarray(own["X_over_L"].values) > 0.15)
    np.testing.assert_array_equal(columns["f_2"].values, np.asarray(own["f"].values)[kept])
    np.testing.assert_allclose(
        columns["load_2_difference"].values, 100.0 * (600.0 / 55.3 - 1.0), rtol=1e-12
    )
    K_I = "closed_form_K_I_right_2_difference"
    assert np.isnan(columns[K_I].values).all()  # of edges with other exponents
    plain = by_name(galinx.compare(light, heavy, dimensionless=True))
    assert np.isfinite(plain[K_I].values).all()


@pytest.mark.parametrize(
    "key, given, said",
    [
        (
            "motion.speed",
            ["1 m/s", "500 m/s"],
            ["states 0, 1 (speed 1 m/s)", "states 1, 0 (speed 500 m/s)"],
        ),
        ("motion.c", [0.1, 0.3], ["states 0, 1", "states 1, 0"]),  # m/s of the first alone would mislead
    ],
)
def test_speeds_pair_as_they_are_given(key, given, said):
    """Two solids have other wave speeds: equal speeds in m/s are not equal over c_s."""
    keys = PLAIN | {"motion.c": None, "motion.strokes": ["forward"], "motion.X_over_L": [0.5]}
    steel, aluminium = (
        computed("tables4_5", keys | {"solid": {"material": name}, key: values, "title": name})
        for name, values in (("steel", given), ("aluminium", given[::-1]))
    )
    comparison = Comparison([steel, aluminium])
    assert comparison.titles == said
    shown = [row[0] for sheet in comparison.sheets() for row in sheet.rows]
    assert any("speed" in head for head in shown) == (key == "motion.c")
    assert [*comparison.notes()][-1].startswith("difference")


def test_what_varies_in_one_result_is_a_constant_of_the_other():
    """A sweep's states were paired with one state by their order: 10 with 50 N/mm, without a word."""
    punch = '[solid]\nmaterial = "steel"\n[punch]\nprofile = "parabolic"\n'
    rest = '[friction]\nmu = 0.1\n[solve]\nmethods = ["closed_form"]\n[motion]\n'
    one, many, else_ = (
        galinx.compute(parse(f"{punch}radius = {radius}\nload = {load}\n{rest}c = {c}\n"))
        for radius, load, c in (
            ('"50 mm"', '"50 N/mm"', "0.5"),
            ('["30 mm", 0.05]', '["10 N/mm", "50 N/mm"]', "[0.0, 0.5]"),
            ('"50 mm"', '"20 N/mm"', "0.5"),
        )
    )
    assert Comparison([one, many]).pairs.tolist() == [[0, 7]]
    assert Comparison([many, one]).pairs.tolist() == [[7, 0]]
    assert "order" not in " ".join(Comparison([one, many]).notes())
    assert "order" in " ".join(Comparison([else_, many]).notes())


def test_constants_pair_in_the_units_of_swept_numbers():
    """An angle is swept in degrees, and may have its unit; a material gives constants, too."""
    keys = {"solve.methods": ["closed_form"]}
    turned = computed("fibres", keys | {"solid.angle": [0, 30, 60]})
    once = computed("fibres", keys | {"solid.angle": "60 deg"})
    pairs = Comparison([turned, once]).pairs
    assert len(pairs) == len(once.data["states/f"])
    assert (turned.data["states/solid.angle"][pairs[:, 0]] == 60.0).all()
    one = PLAIN | {"motion.strokes": ["forward"], "motion.X_over_L": [1.0]}
    steel = computed("tables4_5", one | {"solid": {"material": "steel"}})
    E = [1e11, LIBRARY["steel"].constants["E"]]
    softer = computed("tables4_5", one | {"solid": {"material": "steel", "E": E}})
    assert Comparison([softer, steel]).pairs.tolist() == [[1, 0]]


def test_other_parameters_are_paired_by_their_order(light):
    other = computed("tables4_5", PLAIN | {"motion.X_over_L": [0.3, 0.7], "title": "other"})
    comparison = Comparison([light, other])
    assert comparison.pairs.tolist() == [[i, i] for i in range(6)]
    notes = " ".join(comparison.notes())
    assert "paired by their order" in notes
    assert "motion.X_over_L: [0.2, 0.8] | [0.3, 0.7]" in notes and "friction" not in notes


def test_compare_prints_and_draws(two, tmp_path):
    done = here("compare", *two, "-o", tmp_path / "both.svg", "--states", "1")
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "both.svg").stat().st_size > 10_000
    assert "states 1, 2 (FM1, X/L 0.8)" in done.stdout and "state 0" not in done.stdout
    assert re.search(r"load \[N/mm\] +55\.3 +600 +\+985", done.stdout)
    assert "punch.load: 55.3 N/mm | 600 N/mm; friction.mu_c: 0.7 | 0.5" in " ".join(done.stdout.split())
    assert "states without a partner: 3 of heavy" in done.stdout
    assert max(len(line) for line in done.stdout.splitlines() if not line.startswith("figure: ")) <= 80
    for words, said in (
        ((two[0],), "expected two or more"),
        ((*two, "--states", "17"), "that have a partner: 0, 1"),
        ((*two, "--measured", "p.csv"), "say by -o where"),
    ):
        done = here("compare", *words)
        assert done.returncode == 2 and said in done.stderr, done.stderr


def test_measured_points_lie_at_their_places(light, heavy, table):
    points = read(table(POINTS))
    pressure, tension = light.figure("surface", states=(1,), measured=points).axes
    assert dots(pressure).tolist() == pytest.approx(np.array([[-0.5, 15.5], [0, 17.25], [0.75, 2e3]]))
    assert dots(tension).tolist() == pytest.approx(np.array([[-0.5, -20], [0, -30.5], [0.75, -25]]))
    assert pressure.get_ylim()[1] > 2e3  # above the curves
    (legend,) = pressure.figure.legends
    assert "measured, device.csv" in [text.get_text() for text in legend.get_texts()]
    far = read(table(POINTS + "99,1,1\n"))
    (legend,) = light.figure("surface", states=(1,), measured=far).legends
    assert "measured, device.csv (3 of 4 points)" in [text.get_text() for text in legend.get_texts()]
    pressure, _ = light.figure("surface", states=(1,), measured=points, dimensionless=True).axes
    assert dots(pressure)[1] == pytest.approx([0.0, 17.25 / 27.65], rel=1e-12)
    pressure, _ = Comparison([light, heavy]).drawing(points).figure.axes
    assert dots(pressure)[1] == pytest.approx([0.0, 17.25], rel=1e-12)


@pytest.mark.parametrize(
    "text, said",
    [
        ("position [mm],presure [MPa]\n0,1\n", "found position, presure in 1 rows, expected"),
        ("position [mm],presure [MPa]\n0,1\n", "rows of numbers; did you mean pressure?"),
        ("position,pressure [MPa]\n0,1\n", "position has no unit, expected one as in position [mm]"),
        ("position [MPa],pressure [MPa]\n0,1\n", "line 1, position: found 'MPa'"),
        ("pressure [MPa]\n1\n", "expected \"position [mm]"),
        ("position [mm],pressure [MPa]\n", "in 0 rows"),
        ("position [mm],x [mm],f\n1,1,1\n", "two columns of x"),
    ],
)  # fmt: skip
def test_what_is_no_measured_table_is_refused(table, text, said):
    with pytest.raises(BadInput, match=re.escape(said)):
        read(table(text))


def test_what_is_not_needed_stands_beside_what_is_measured(table):
    """As device and spreadsheet write it: the table that a fit takes."""
    text = "sep=;\ntime [s];position [mm];COF;note\n0;0;0;at rest\n1;0,5;0,2;\n2;0,2;-0,1;back\n"
    slip, f = read(table(text)).points["f"]
    assert slip.tolist() == pytest.approx([0.0, 5e-4, 2e-4]) and f.tolist() == [0.0, 0.2, -0.1]
    assert fitted.read(table(text)).measured.f.tolist() == f.tolist()


def test_motions_of_sliders_stand_below_each_other():
    light, stiff = (
        computed("slider", {"slider.duration": "1 s", "slider.stiffness": k, "title": k})
        for k in ("2 N/m^2", "4 N/m^2")
    )
    *_, first, second = Comparison([light, stiff]).sheets()
    assert [sheet.title for sheet in (first, second)] == [
        "Motion of the slider: 2 N/m^2", "Motion of the slider: 4 N/m^2",
    ]  # fmt: skip
    assert "has not broken away yet" in first.rows[0]


def test_words_of_yield_have_no_difference_from_a_share():
    """A flat punch yields at its edges at any load, a cylinder from a share of its strength on."""
    steel = PLAIN | {"solid.yield_strength": "500 MPa", "output.quantities": ["yield"]}
    round_ = {"punch.profile": "parabolic", "punch.radius": 5e-3, "punch.half_width": None}
    flat, cylinder = computed("tables4_5", steel), computed("tables4_5", steel | round_)
    for pair in ((flat, cylinder), (cylinder, flat)):
        found = by_name(galinx.compare(*pair))
        assert {"yields_1", "yields_2"} <= found.keys() and "yields_2_difference" not in found


def test_shares_say_of_what_they_are_and_lengths_are_over_one_half_width():
    """Where friction varies along the contact the load of first yield is not known."""
    usual = {"solve.methods": ["sie", "closed_form"], "output.quantities": ["sif", "yield"]}
    even = computed("cylinder_on_steel", usual | {"punch.radius": 10e-3})
    law = {
        "friction.mu": None,
        "friction.state": "advected",
        "friction.model": "dahl",
        "friction.mu_c": 0.6,
    }
    grown = computed("cylinder_on_steel", usual | law | {"friction.sigma0_over_load": 2e4})
    (row,) = [row for row in next(Comparison([even, grown]).sheets()).rows if row[0] == "yields"]
    assert row[1].endswith(" % of first yield") and row[2].endswith(" % of the yield strength")
    comparison = Comparison([even, grown], dimensionless=True)
    _, width, _ = (column for column in comparison.columns() if column.head.startswith("half-width"))
    a = [result.units().half_width for result in (even, grown)]
    assert width.values == pytest.approx(np.ravel(a[1]) / even.units().contact.half_width, rel=1e-12)
    assert any(note.startswith("half-width, centre: a = ") for note in comparison.notes())


def test_the_swapped_order_is_the_mirror(light, heavy):
    there, back = (by_name(galinx.compare(*pair)) for pair in ((light, heavy), (heavy, light)))
    assert there.keys() - {n for n in there if "difference" in n} == {
        re.sub(r"_[12]$", lambda m: {"_1": "_2", "_2": "_1"}[m[0]], name)
        for name in back
        if "difference" not in name
    }
    compared = 0
    for name, column in there.items():
        mirrored = re.sub(r"_1$", "_2", name)
        if name.endswith("_1"):
            assert column.unit == back[mirrored].unit
            np.testing.assert_array_equal(column.values, back[mirrored].values)
        elif name.endswith("_difference") and not column.place:
            a, b = (there[name.replace("_2_difference", f"_{n}")].values for n in (1, 2))
            np.testing.assert_allclose(
                column.values * np.abs(a), -back[name].values * np.abs(b), rtol=1e-9
            )
            compared += 1
    assert compared > 5
