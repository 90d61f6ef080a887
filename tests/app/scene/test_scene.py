"""Scenes: what is read, and a message for each fault."""

import re
import tomllib

import numpy as np
import pytest
from support import HOME, SCENE, computed, of_sections, scene_of

from galinx import template
from galinx.app.errors import BadInput
from galinx.app.scene.changes import changed, from_words
from galinx.app.scene.library import LIBRARY
from galinx.app.scene.read import parse, read
from galinx.app.scene.scene import oddities
from galinx.postprocess.quantities import states, validity, yielding
from galinx.solvers.parameters import values

TEXT = SCENE.read_text(encoding="utf-8")
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

    def stiffness(text, changes):
        return parse(changed(text, changes)).friction.parameters["sigma0_over_load"]

    assert stiffness(TEXT, _APART) == pytest.approx((28792.0,), abs=0.5)
    deeper = {"friction.sigma0": "0.15922 N/µm/mm", "punch.load": "5.53 N/mm"}
    assert stiffness(TEXT, _APART | deeper) == pytest.approx(stiffness(TEXT, _APART))
    # The load that a scene has where it gives none.
    alone = {"punch.load": None, "friction.sigma0": [1.5922e9, 55.3e6]}
    assert stiffness(TEXT, _APART | alone) == pytest.approx((28792.04, 1000.0))
    lugre = {"friction.model": "lugre", "friction.mu_s": 0.8, "friction.stribeck_velocity": 1e-3}
    assert stiffness(TEXT, _APART | lugre) == pytest.approx((28792.04,))
    # A scene that has it loses it with the law.
    coulomb = parse(changed(changed(TEXT, _APART), {"friction.model": "coulomb"})).friction
    assert coulomb.law.__name__ == "Coulomb"


def test_a_known_solid_gives_its_constants_and_the_scene_may_differ():
    solid = template("fig5").solid
    assert (solid.E, solid.ν, solid.ρ) == (193e9, 0.25, 7860.0)
    solid = template("own_material", {"solid.material": "steel", "solid.rho": 8000}).solid
    assert (solid.E, solid.ν, solid.ρ) == (210e9, 0.3, 8000.0)


@pytest.mark.parametrize("name", LIBRARY)
def test_every_known_solid_is_one(name):
    solid = template("fig5", {"solid.material": name}).solid
    soft, hard = {"rubber": (20.0, 35.0), "PTFE": (250.0, 350.0)}, ("DLC", "Al2O3", "Si3N4")
    slow, fast = soft.get(name, (500.0, 7500.0 if name in hard else 6000.0))
    assert LIBRARY[name].source and slow < solid.c_s < fast


def test_laws_that_vary_are_products_of_their_own_and_come_once():
    friction = template(
        "study",
        {
            "friction.mu_c": 0.5, "friction.sigma0_over_load": "25 1/mm", "friction.delta": 1.0,
            "friction.vary": [
                {"mu_c": [0.1, 0.5]},
                {"sigma0_over_load": ["12.5 1/mm", 25e3], "delta": {"from": 1, "to": 2, "number": 2}},
                {},
            ],
        },
    ).friction  # fmt: skip
    listed = [tuple(values(law).values()) for law in friction.laws()]
    assert listed == [
        (0.1, 25e3, 1.0), (0.5, 25e3, 1.0), (0.5, 12.5e3, 1.0), (0.5, 12.5e3, 2.0), (0.5, 25e3, 2.0),
    ]  # fmt: skip
    assert friction.count == 5
    assert [tuple(row) for row in zip(*friction.columns().values())] == listed
    together = friction.together(friction.columns(), slice(1, 4))
    assert np.ravel(together.δ).tolist() == [1.0, 1.0, 2.0]


def test_changes_reach_laws_that_vary():
    study = HOME / "scenes" / "study.toml"
    assert read(study, from_words(["friction.sign=eq25"])).friction.count == 9
    other = read(study, from_words(["friction.vary=[{mu_c = [0.2, 0.3]}]"]))
    assert [law.μ_C for law in other.friction.laws()] == [0.2, 0.3]
    assert read(study, from_words([], ["friction.vary"])).friction.count == 1
    coulomb = read(study, from_words(["friction.model=coulomb"]))  # has no parameter that is varied
    assert coulomb.friction.count == 1 and coulomb.friction.vary == ()


#: Without strokes a law without memory has one state at each speed.
STEADY = """
[solid]
material = "BK7"
[punch]
profile = "parabolic"
radius = "5 mm"
load = "100 N/mm"
[friction]
mu = 0.15
[motion]
speed = "1 m/s"
"""


def test_mu_alone_is_coulombs_law_and_a_scene_without_strokes_is_steady():
    """It asks for what the solid bears."""
    scene = parse(STEADY)
    given = parse(STEADY.replace("mu = 0.15", 'model = "coulomb"\nmu_c = 0.15'))
    assert scene.friction == given.friction and scene.steady and given.steady
    speeds = {"motion.speed": ["1 m/s", "2 m/s"], "solve.methods": ["closed_form"]}
    result = computed(STEADY, speeds)
    assert len(result.data[states.SPEED.path]) == 2
    assert not [text for text in result.attributes["warnings"] if "stroke" in text]
    assert np.isnan(result.data[validity.CROSSINGS.path]).all()
    assert result.data[yielding.VON_MISES["closed_form"].path].shape == (2,)
    assert yielding.FIRST_LOAD["closed_form"].path not in result.data  # without a yield strength


SLIDER = "[slider]\nmass = 1\nstiffness = 1e4\ndrive_speed = 1\nduration = 1"


@pytest.mark.parametrize("motion, word, strokes", [("[time]\nend = 1", "time", 1), (SLIDER, "slider", 3)])
def test_a_scene_with_a_motion_asks_for_it(motion, word, strokes):
    text = STEADY.replace('profile = "parabolic"\nradius = "5 mm"', 'half_width = "1 mm"')
    scene = parse("solve = { tolerance = 1e-3 }\n" + text + motion)
    assert scene.output.quantities == ("friction", word)
    # Friction without memory starts in one direction.
    assert len(scene.motion.strokes) == strokes


@pytest.mark.parametrize(
    "given", ["points = [[0.0, -1.0]]", "map = { X = [-1, 1, 3], Y = [-1, -0.5, 2] }"]
)
def test_places_ask_for_stresses_inside_and_these_have_places(given):
    """Besides what a scene computes without; a map where only the quantity is named."""
    usual = parse(STEADY).output.quantities
    assert parse(f"{STEADY}[output]\n{given}").output.quantities == (*usual, "interior")
    alone = parse(STEADY + '[output]\nquantities = ["interior"]').output
    assert np.ptp(alone.inside, axis=0).min() > 2.0 and alone.inside[:, 1].max() < 0.0
    with pytest.raises(BadInput, match='need "interior" among'):
        parse(f'{STEADY}[output]\nquantities = ["sif"]\n{given}')


@pytest.mark.parametrize(
    "old, new, message",
    [
        ("mu = 0.15", "mu = 0,15", "found 0,15 in line 9, expected a decimal point, as in 0.15"),
        ('"BK7"', "BK7", 'found BK7 in line 3, expected quotes around a text, "BK7"'),
        ('"BK7"', "“BK7”", "found “ in line 3, expected straight quotes"),
        ('"BK7"', '"BK7', "in line 3, whose text has no quote at its end"),
        ('"5 mm"', "5 mm", 'found 5 mm in line 6, expected quotes around a number and unit, "5 mm"'),
        ('"1 m/s"', "1 m/s # fast", "found 1 m/s in line 11, expected quotes"),
        ('"5 mm"', '"5,5 mm"', "decimals have a point"),
        ("mu = 0.15", "mu = 0.15\ndelta = 1", 'no such key of model = "coulomb"; dahl has it'),
        (
            "mu = 0.15",
            'law = "lugre"\nmu_s = 0.6',
            'friction.law: no such key; did you mean model = "lugre"?',
        ),
        ("mu = 0.15", "mu = 0.15\nmu_c = 0.15", "1 fault:\n  friction: mu and mu_c exclude each other"),
        ("mu = 0.15", "mu = 0.15\nsigma0 = 1e9", "friction.sigma0: no such key"),
        ("mu = 0.15", "coefficient = 0.15", "coefficient: no such key; did you mean mu_c (Coulomb's"),
    ],
)
def test_messages_say_what_to_write(old, new, message):
    with pytest.raises(BadInput) as raised:
        parse(STEADY.replace(old, new))
    assert message in str(raised.value)


def test_stiffnesses_of_either_sign_are_usual():
    """Shear and normal stresses are coupled so in the mirror image of a solid."""
    stiffness = ["40 GPa", "6 GPa", "-5 GPa", "15 GPa", "-1.5 GPa", "8 GPa"]
    solid = {"kind": "anisotropic", "stiffness": stiffness, "rho": 1600}
    assert not oddities(of_sections(solid=solid, friction={"mu": 0.3}, motion={"c": 0.3}))


def test_slopes_that_are_not_small_are_warned_about():
    """Of a table those that it has, of a cylinder half-width over radius."""
    steep = 'profile = "table"\nshape = [[-1, 1], [0, 0], [1, 1]]'
    scene = parse(STEADY.replace('profile = "parabolic"\nradius = "5 mm"', steep))
    assert any("slopes are up to 1," in text for text in oddities(scene))
    changes = {"punch.radius": "5 mm", "solid.E": "2 MPa", "solid.nu": 0.4}
    narrow, wide = (template("cylinder", changes | {"punch.load": load}) for load in ("1 N/m", "1e4 N/m"))
    a = wide.body.half_width
    assert a > 1e-3 and any(f"slopes of {a / 5e-3:.2g}, " in text for text in oddities(wide))
    assert not any("slopes of" in text for text in oddities(narrow))


@pytest.mark.parametrize("tilt", [0.0, 1e-3, -5e-4])
@pytest.mark.parametrize("between, said", [((), True), ((0.1e-3,), False)])
def test_a_table_whose_base_may_be_flat_is_warned_of(between, said, tilt):
    """A base of 1 mm between two points is 0.02 to 0.1 µm deeper in its middle, unasked."""
    X = sorted((-0.8e-3, -0.65e-3, -0.5e-3, *between, 0.5e-3, 0.65e-3, 0.8e-3))
    rows = [[x, 10.0 * max(abs(x) - 0.5e-3, 0.0) ** 2 + tilt * x] for x in X]
    table = f'profile = "table"\nshape = {rows}'
    scene = parse(STEADY.replace('profile = "parabolic"\nradius = "5 mm"', table))
    assert any("no point between" in text for text in oddities(scene)) is said


def test_a_table_of_a_parabola_without_its_lowest_point_is_as_meant():
    rows = [[x, x**2] for x in (-2e-3, -1.2e-3, -0.4e-3, 0.4e-3, 1.2e-3, 2e-3)]
    scene = parse(
        STEADY.replace('profile = "parabolic"\nradius = "5 mm"', f'profile = "table"\nshape = {rows}')
    )
    assert not any("no point between" in text for text in oddities(scene))


def test_keys_of_strokes_are_warned_of_where_the_punch_slides_steadily():
    """A rest alone makes no strokes of it."""
    mu = next(line for line in STEADY.splitlines() if line.startswith("mu"))
    scene = parse(STEADY.replace(mu, f'{mu}\npre_sliding = "3 µm"') + '\nrest = "1 s"\n')
    assert scene.steady
    assert any(
        text.startswith("friction.pre_sliding, motion.rest: without effect") for text in oddities(scene)
    )
    (said,) = oddities(parse(STEADY.replace(mu, f'{mu}\nstate = "advected"')))
    assert said == "friction.state: without effect, because this law of friction has no memory"
    to_and_fro = parse(scene.text + 'strokes = ["forward", "backward"]\n')
    assert not any("without effect" in text for text in oddities(to_and_fro))


def test_a_motion_in_time_has_a_tolerance_of_its_own():
    """The usual one is refused in time, also where a scene names none."""
    punch = '[solid]\nmaterial = "steel"\n[punch]\nhalf_width = 1e-3\nload = 1e3\n[friction]\nmu = 0.2\n'
    time = "[motion]\nc = 0.4\n[time]\nend = 1\n"
    quantities = '[output]\nquantities = ["time"]\n'
    assert parse(punch + time + quantities).solve.tolerance == 1e-3
    assert parse(punch + time + quantities + "[solve]\ntolerance = 1e-4\n").solve.tolerance == 1e-4


@pytest.mark.parametrize(
    "strokes, said",
    [(["forward", "backward"], ""), ([{"to": 0.9}, {"to": 0.2}], ""), (["backward", "forward"], ""),
     ([{"to": 0.9}, "backward"], "stroke 1 ends at X/L = 0.9, stroke 2 begins at 1"),
     (["forward", "backward", "backward"], "stroke 2 ends at X/L = 0, stroke 3 begins at 1")],
)  # fmt: skip
def test_strokes_that_do_not_go_on_from_the_last_are_warned_of(strokes, said):
    said_of = oddities(scene_of("tables4_5", {"motion.strokes": strokes}))
    (*found,) = (text for text in said_of if "stroke" in text)
    assert [text.startswith(f"motion.strokes: {said};") for text in found] == [True] * bool(said)
