"""Scenes: what is read, and a message for each fault."""

import re
import tomllib

import pytest
from support import HOME, SCENE

from galinx import template
from galinx.app.errors import BadInput
from galinx.app.plan.plan import make_plan
from galinx.app.plan.states import enumerate_states
from galinx.app.scene.changes import changed
from galinx.app.scene.read import parse, read

TEXT = SCENE.read_text(encoding="utf-8")


@pytest.mark.parametrize(
    "changes, message",
    [
        ({"solid.nu": None, "solid.nuu": 0.25}, "did you mean nu"),
        ({"solid.nu_": 1}, "solid.nu_: no such key"),
        ({"sloid.nu": 0.25}, "did you mean solid"),
        ({"solid.nu": None}, "solid.nu: missing"),
        ({"solid.nu": 0.51}, "0.51"),
        ({"solid.E": "193 mm"}, r"\[length\]"),
        ({"friction.model": "amontons"}, "dahl"),
        ({"motion.c": -0.1}, "motion.c"),
        ({"motion.c": 0.95}, "Rayleigh speed c_R = 0.919402"),
        ({"motion.speed": "1 m/s"}, "exclude each other"),
        ({"motion.c": None}, "motion: expected c"),
        (
            {"motion.c": None, "motion.speed": ["4 km/s", "5 km/s"]},
            r"^motion.speed = 4000, 5000 m/s: expected less than the Rayleigh speed 2881.39 m/s \(by",
        ),
        (
            {"motion.c": None, "motion.speed": "4 km/s", "solve.methods": ["closed_form"]},
            r"^motion.speed = 4000 m/s: expected less than the shear wave speed 3133.99 m/s$",
        ),
        ({"motion.c": None, "motion.speed": "3.1 km/s"}, r"c_R = 0.919402 \(over c_s\), 2881.39 m/s"),
        ({"motion.X_over_L": 1.2}, "X_over_L"),
        ({"solve.methods": ["fme"]}, "expected closed_form, sie or fem; did you mean fem\\?"),
        ({"motion.strokes": ["foward"]}, "did you mean forward\\?"),
        ({"solid.material": "STEEL"}, r"has 1 fault:.*found 'STEEL', .*; did you mean steel\?"),
        ({"solid.material": "gold"}, r"has 1 fault:.*rubber or PTFE$"),
        ({"solve.methods": []}, "solve.methods is empty"),
        ({"solve.pressure": [[-1, -1], [1, -1]]}, "traction"),
        ({"solve.mode": "traction", "solve.pressure": [[-1, -1], [0.5, -1]]}, "X/a = 1"),
        ({"output.quantities": ["friction", "siff"]}, "quantities"),
    ],
)
def test_each_fault_has_its_message(changes, message):
    with pytest.raises(BadInput, match=re.compile(message, re.DOTALL)):
        make_plan(template("tables4_5", changes))


FROZEN = sorted((HOME / "tests" / "frozen").glob("*.toml"))
#: A scene of each key: all keys are in one, see tests/frozen.
KEYS = {
    f"{section}.{key}": path
    for path in FROZEN
    for section, keys in tomllib.loads(path.read_text("utf-8")).items()
    if isinstance(keys, dict)
    for key in keys
}


@pytest.mark.parametrize("wrong", [True, {"a": 1}, float("nan"), "1 lb^7"], ids=str)
def test_a_wrong_value_of_any_key_is_named(wrong):
    assert len(KEYS) > 80
    for key, path in KEYS.items():
        with pytest.raises(BadInput, match=re.escape(key)):
            read(path, {key: wrong})


@pytest.mark.parametrize(
    "text, message",
    [
        ("[solid]\n# mu_c = 1\nE = 1\nnu = 0\n'E' = 2\n", "found 'E' = 2 in line 5, whose name stands"),
        ("[solid]\nE = 1\n[friction]\nE = 1\nnu = 0\nE = 2\n", "found E = 2 in line 6, whose name"),
        ("title = 'a'\nmu_c = 1\ntitle = 'b'\n", "found title = 'b' in line 3, whose name stands"),
        ("[solid]\n[motion]\n [ solid ]\n", "found [ solid ] in line 3, whose name stands above already"),
        ("map = {X = 1, X = 2}", "Duplicate inline table key"),
        ("E = [1,\nE = 2", "Invalid value"),
    ],
)
def test_what_stands_twice_is_named(text, message):
    with pytest.raises(BadInput) as caught:
        parse(text)
    assert f"scene is not TOML: {message}" in str(caught.value)


@pytest.mark.parametrize("changes", [{"solid.nu": 0.5}, {"friction.integrator": "rk4"}])
def test_what_looks_like_a_fault_and_is_none(changes):
    scene = template("tables4_5", changes)
    assert make_plan(scene).states == len(enumerate_states(scene)) == 12


@pytest.mark.parametrize(
    "line, message",
    [
        ("title = " + "9" * 5000, "thousands of digits"),
        ("title = 0x" + "f" * 6000, "title: found a whole number of about 7225 digits"),
        ("title = " + "[" * 3000 + "]" * 3000, "nested too deeply"),
        ("title = " + "[" * 200 + "]" * 200, r"title: found \[+\.\.\.\]+, expected a text"),
        ("title = {a = 1}", "title: found {'a': 1}, expected a text"),
        ("solve = " + "9" * 400, "solve: found a whole number of about 400 digits, expected a section"),
        ("\n".join(f"x{i} = 1" for i in range(10_000)), "10005 faults:.*and 9975 more"),
    ],
    ids=lambda text: text[:12],
)
def test_what_is_long_or_deep_is_refused_with_a_short_message(line, message):
    with pytest.raises(BadInput, match=re.compile(message, re.DOTALL)) as caught:
        parse(line)
    assert len(str(caught.value)) < 4000


def test_all_faults_come_in_one_message():
    changes = {
        "solid.nu": None, "solid.nuu": 1, "friction.mu_c": -1, "friction.integrator": "x"
    }  # fmt: skip
    with pytest.raises(BadInput) as caught:
        template("tables4_5", changes)
    for part in ("solid.nuu", "solid.nu: missing", "friction.mu_c", "friction.integrator", "4 faults"):
        assert part in str(caught.value)


@pytest.mark.parametrize(
    "content, message",
    [
        (b"", "empty"),
        (b"\xff\xfe", "UTF-8"),
        (None, "cannot read"),
        ("folder", "folder"),
        (b"galinx archive\n\0\xff", "is an archive of results, expected a scene"),
        (b"\x89HDF\r\n\x1a\n\0", "is an archive of results, expected a scene"),
    ],
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
    path.write_bytes(b"\xef\xbb\xbf" + TEXT.replace("\n", "\r\n").encode())
    assert read(path).sha256 == parse(TEXT).sha256


_APART = {"friction.sigma0_over_load": None, "friction.sigma0": "1.5922 N/µm/mm"}


def test_stiffness_and_load_apart():
    """The study's σ₀ = 1.5922 N/µm and N = 55.3 N, of any depth, are σ₀ l/N = 28 792 1/m."""
    (law,) = read(SCENE, _APART).friction.laws()
    assert law.λ == pytest.approx(28792.0, abs=0.5)
    deeper = {"friction.sigma0": "0.15922 N/µm/mm", "punch.load": "5.53 N/mm"}
    assert read(SCENE, _APART | deeper).friction.parameters == pytest.approx(
        read(SCENE, _APART).friction.parameters
    )
    # The load that a scene has where it gives none.
    alone = '[solid]\nmaterial = "T302"\n[motion]\nc = 0.3\n[friction]\nmu_c = 0.7\n'
    assert parse(f"{alone}sigma0 = [1.5922e9, 55.3e6]").friction.parameters[
        "sigma0_over_load"
    ] == pytest.approx((28792.04, 1000.0))
    lugre = {"friction.model": "lugre", "friction.mu_s": 0.8, "friction.stribeck_velocity": 1e-3}
    assert read(SCENE, _APART | lugre).friction.parameters["sigma0_over_load"] == pytest.approx(
        (28792.04,)
    )


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"friction.sigma0": 1e9}, "sigma0 and sigma0_over_load exclude each other; keep one"),
        (_APART | {"punch.load": [1e3, 2e3]}, "found 2 loads, expected one punch.load"),
        (_APART | {"friction.sigma0": "5 kg"}, "of dimension"),
        (_APART | {"friction.sigma0": -1.0}, "friction.sigma0"),
        (_APART | {"punch.load": "1 m"}, "punch.load"),
    ],
)
def test_a_stiffness_that_does_not_go_with_the_rest_is_one_fault(changes, message):
    with pytest.raises(BadInput, match="has 1 fault") as error:
        read(SCENE, changes)
    assert message in str(error.value)


def test_laws_without_that_stiffness_do_not_have_the_key():
    text = '[solid]\nmaterial = "T302"\n[motion]\nc = 0.3\n[friction]\nmodel = "coulomb"\nmu_c = 0.3\n'
    with pytest.raises(BadInput, match=r"friction\.sigma0: no such key"):
        parse(text + "sigma0 = 1e9")
    with pytest.raises(BadInput, match=r"friction\.sigma0: no such key"):
        read(SCENE, _APART | {"friction.model": "coulomb"})
    # A scene that has it loses it with the law.
    apart = changed(SCENE.read_text(encoding="utf-8"), _APART)
    coulomb = parse(changed(apart, {"friction.model": "coulomb"})).friction
    assert coulomb.law.__name__ == "Coulomb"
