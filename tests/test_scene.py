import pytest
from conftest import HOME

from galinx.app.errors import BadInput
from galinx.app.plan.plan import make_plan
from galinx.app.plan.states import enumerate_states, speeds
from galinx.app.plan.words import lines
from galinx.app.scene.scene import parse, read

GOOD = (HOME / "scenes" / "tables4_5.toml").read_text(encoding="utf-8")


def changed(*changes):
    text = GOOD
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    return text


def test_units_become_si():
    scene = parse(GOOD)
    assert (scene.solid.E, scene.punch.load, scene.friction.pre_sliding) == (193e9, 55.3e3, 1e-4)
    assert scene.friction.sigma0_over_load == (25000.0,)


def test_defaults_leave_only_what_has_none():
    scene = parse(
        "[solid]\nE = 1e9\nnu = 0.3\nrho = 1000\n[friction]\nmu_c = 0.5\nsigma0_over_load = 1e4\n"
        "[motion]\nc = 0.1\n"
    )
    assert scene.solve.tolerance == 1e-6 and scene.output.quantities == ("friction", "sif", "surface")
    assert len(enumerate_states(scene)) == 6


@pytest.mark.parametrize(
    "old, new, message",
    [
        ("nu = 0.25", "nuu = 0.25", "did you mean nu"),
        ("nu = 0.25", "nu = 0.25\nnu_ = 1", "solid.nu_: no such key"),
        ("[solid]", "[sloid]", "did you mean solid"),
        ("nu = 0.25", "", "solid.nu: missing"),
        ("nu = 0.25", "nu = 0.51", "0.51"),
        ("nu = 0.25", "nu = -1.0", "-1"),
        ("nu = 0.25", "nu = nan", "finite"),
        ("nu = 0.25", "nu = true", "True"),
        ('"193 GPa"', '"193 mm"', r"\[length\]"),
        ('"193 GPa"', '"193 GPz"', "GPz"),
        ('"193 GPa"', '"193 GPa("', "GPa"),
        ('"193 GPa"', "-1.0", "-1"),
        ('"193 GPa"', "inf", "finite"),
        ('"193 GPa"', "[1.0]", "solid.E"),
        ('"7860 kg/m^3"', "0", "rho"),
        ('"1 mm"', '"0 mm"', "half_width"),
        ('"55.3 N/mm"', '"-55.3 N/mm"', "load"),
        ("mu_c = 0.7", "mu_c = -0.7", "mu_c"),
        ("mu_c = 0.7", "mu_c = []", "mu_c"),
        ("mu_c = 0.7", 'mu_c = "0.5.5"', "0.5.5"),
        ('"193 GPa"', '"2 3 GPa"', "2 3 GPa"),
        ("delta = 1.0", "delta = 0", "delta"),
        ('pre_sliding = "0.1 mm"', 'pre_sliding = "nan mm"', "pre_sliding"),
        ('"dahl"', '"coulomb"', "dahl"),
        ('"exact"', '"euler"', "integrator"),
        ('"physical"', '"other"', "sign"),
        ("c = [4.786e-7, 0.6]", "c = [1.0]", "motion.c"),
        ("c = [4.786e-7, 0.6]", "c = [-0.1]", "motion.c"),
        ("c = [4.786e-7, 0.6]", "c = [0.95]", "Rayleigh speed c_R = 0.919402"),
        ("c = [4.786e-7, 0.6]", 'c = 0.1\nspeed = "1 m/s"', "exclude each other"),
        ("c = [4.786e-7, 0.6]", "", "motion: expected c"),
        ("c = [4.786e-7, 0.6]", 'speed = "4 km/s"', "shear wave speed 3133.99"),
        ("X_over_L = [0.2, 0.8]", "X_over_L = [1.2]", "X_over_L"),
        ("X_over_L = [0.2, 0.8]", "X_over_L = []", "X_over_L"),
        ('"backward"', '"sideways"', "strokes"),
        ('["closed_form", "fem"]', '["fme"]', "methods"),
        ('["closed_form", "fem"]', "[]", "solve.methods is empty"),
        ("tolerance = 1e-6", "tolerance = 0", "tolerance"),
        ('mesh = "confocal"', 'mesh = "round"', "mesh"),
        ('mesh = "confocal"', "pressure = [[-1, -1], [1, -1]]", "traction"),
        ('mesh = "confocal"', 'mode = "traction"\npressure = [[-1, -1], [0.5, -1]]', "X/a = 1"),
        ('"sif", "surface"', '"siff"', "quantities"),
        ("nu = 0.25", "nu = 0.5", None),
        ('title = "Tables 4 and 5"', "title = 5", "title"),
        ("[solve]", "[solve", "not TOML"),
        ('"exact"                 # or "rk4"', '"rk4" #', None),
    ],
)
def test_each_fault_has_its_message(old, new, message):
    def plan():
        scene = parse(changed((old, new)))
        enumerate_states(scene)
        return make_plan(scene)

    if message is None:
        assert plan().states == 12
    else:
        with pytest.raises(BadInput, match=message):
            plan()


def test_all_faults_come_in_one_message():
    with pytest.raises(BadInput) as caught:
        parse(changed(("nu = 0.25", "nuu = 1"), ("mu_c = 0.7", "mu_c = -1"), ('"exact"', '"x"')))
    for part in ("solid.nuu", "solid.nu: missing", "friction.mu_c", "friction.integrator", "4 faults"):
        assert part in str(caught.value)


def test_runge_kutta_beyond_its_stability_names_the_exact_integrator():
    scene = parse(
        changed(("mu_c = 0.7", "mu_c = 0.1"), ('"25000 1/m"', '"60000 1/m"'), ('"exact"', '"rk4"'))
    )
    with pytest.raises(BadInput, match="exact"):
        enumerate_states(scene)


@pytest.mark.parametrize(
    "content, message",
    [(b"", "empty"), (b"\xff\xfe", "UTF-8"), (None, "cannot read"), ("folder", "folder")],
)
def test_files_that_are_no_scenes(tmp_path, content, message):
    path = tmp_path / "scene.toml"
    if content == "folder":
        path.mkdir()
    elif content is not None:
        path.write_bytes(content)
    with pytest.raises(BadInput, match=message):
        read(path)


def test_byte_order_mark_and_carriage_returns_are_accepted(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_bytes(b"\xef\xbb\xbf" + GOOD.replace("\n", "\r\n").encode())
    assert read(path).sha256 == parse(GOOD).sha256


def test_a_value_off_by_its_unit_is_warned_of():
    scene = parse(changed(('"193 GPa"', "193")))
    assert any("solid.E = 193 Pa" in text for text in make_plan(scene).warnings)


def test_speed_in_metres_per_second():
    scene = parse(changed(("c = [4.786e-7, 0.6]", 'speed = ["1.5 mm/s", "1880.4 m/s"]')))
    assert speeds(scene) == pytest.approx((4.786e-7, 0.6), rel=1e-4)


def test_lists_mean_their_product():
    scene = parse(
        changed(("mu_c = 0.7", "mu_c = [0.3, 0.7]"), ("delta = 1.0", "delta = [1.0, 1.5, 2.0]"))
    )
    states = enumerate_states(scene)
    assert len(states) == 2 * 2 * 3 * 3 * 2 == make_plan(scene).states
    assert len({(c, m, d) for c, m, d in zip(states.c, states.mu_c, states.delta)}) == 12


def test_the_plan_skips_what_is_not_asked_for():
    friction = make_plan(parse(changed(('["friction", "sif", "surface"]', '["friction"]'))))
    assert not (friction.fem or friction.closed_form or friction.surface)
    closed = make_plan(parse(changed(('["closed_form", "fem"]', '["closed_form"]'))))
    assert closed.closed_form and not closed.fem and closed.refinement is None
    assert any("mesh and finite elements" in text for text in closed.skipped)
    scene = parse(changed(('"sif", "surface"', '"sif"')))
    assert not make_plan(scene).surface
    assert not any("surface" in text for text in lines(scene, make_plan(scene)))


def test_the_closed_form_beyond_the_rayleigh_speed_is_formal():
    text = changed(("c = [4.786e-7, 0.6]", "c = [0.95]"), ('["closed_form", "fem"]', '["closed_form"]'))
    assert any("formal" in warning for warning in make_plan(parse(text)).warnings)


def test_all_scenes_of_the_project_are_good():
    scenes = sorted((HOME / "scenes").glob("*.toml"))
    assert len(scenes) >= 5
    for path in scenes:
        assert make_plan(read(path)).states > 0


@pytest.mark.parametrize(
    "changes, message",
    [
        ([("c = [4.786e-7, 0.6]", "c = [0.918]")], "within 1 % of the Rayleigh speed c_R = 0.919402"),
        (
            [('mesh = "confocal"', 'mesh = "box"')],
            "boundary of the box mesh alone costs about 0.01",
        ),
    ],
)
def test_what_will_cost_accuracy_is_warned_of(changes, message):
    (warning,) = make_plan(parse(changed(*changes))).warnings
    assert message in warning
