"""Models of a user's own, registered from outside: solved by two methods, archived, drawn, refused."""

from contextlib import contextmanager, suppress
from dataclasses import dataclass, make_dataclass

import numpy as np
import pytest
from support import command, computed, here

import galinx
from galinx.app.errors import BadInput
from galinx.solvers.errors import SolveError
from galinx.solvers.friction.law import FrictionLaw
from galinx.solvers.parameters import build_model, parameter
from galinx.solvers.profiles import check_slope
from galinx.solvers.profiles.punches import Flat


class Failing:
    """A method that solves the first speed only."""

    @contextmanager
    def at(self, task, g):
        if task.number:
            raise SolveError("provoked")
        yield self

    def states(self, g):
        return self

    def record(self):
        return {}


def test_a_method_of_ones_own_that_fails_is_told_of(monkeypatch):
    kind = galinx.MethodKind("failing method", lambda plan, progress, clock: Failing())
    monkeypatch.setitem(galinx.METHODS, "failing", kind)
    row = galinx.Quantity(
        "states/failing/one", "1", "one", ("states",), lambda s, body: np.ones(6), "failing"
    )
    monkeypatch.setitem(galinx.QUANTITIES, row.path, row)
    result = computed("tables4_5", {"solve.methods": ["closed_form", "failing"]})
    assert result.verdict == "FAIL" and list(result.data["run/failures"]) == ["c = 0.6: provoked"]
    np.testing.assert_array_equal(result.data[row.path], [1.0] * 6 + [np.nan] * 6)
    assert "failing method: 12 states" in list(result.data["run/done"])
    with pytest.raises(SolveError, match="provoked"):
        monkeypatch.setattr(Failing, "states", _refuse)
        computed("tables4_5", {"solve.methods": ["failing"]})


def _refuse(self, g):
    raise SolveError("provoked")


ONE_STATE = {"motion.c": 0.3, "motion.strokes": ["forward"], "motion.X_over_L": 0.8,
             "solve.methods": ["closed_form"]}  # fmt: skip


@pytest.mark.parametrize("shape", ["None", "(1,)"])
def test_a_profile_without_numbers_is_refused(monkeypatch, shape):
    """One whose slope returns nothing was flat, and its verdict PASS."""
    slope = {"None": lambda self, X: None, "(1,)": lambda self, X: X[:1]}[shape]
    own = type("Forgetful", (Flat,), {"slope": slope})
    monkeypatch.setitem(galinx.PROFILES, "forgetful", own)
    with pytest.raises(
        BadInput, match=r"Forgetful\.slope gives .* expected an array of numbers of shape \(2,\)"
    ):
        computed("tables4_5", ONE_STATE | {"punch.profile": "forgetful"})


@pytest.mark.parametrize(
    "members, message",
    [({}, r"Own lacks half_width, .* for free ends it needs sharp = \(False, False\)"),
     ({"sharp": (False, False), "slope": lambda self, X: 50.0 * X},
      r"Own\.slope is not the derivative of the height")],
)  # fmt: skip
def test_a_profile_that_contradicts_itself_is_refused(monkeypatch, members, message):
    """With the height of one radius and the slope of another, pressures were those of the slope."""
    own = {"about": "own", "height": lambda self, X: 50.0 * X**2, "slope": lambda self, X: 100.0 * X}
    own |= {"words": lambda self: "own punch"} | members
    monkeypatch.setitem(galinx.PROFILES, "own", dataclass(frozen=True)(type("Own", (), own)))
    with pytest.raises(BadInput, match=message):
        computed("cylinder", ONE_STATE | {"punch": {"profile": "own", "load": 1e5}})


@pytest.mark.parametrize("seed", range(4))
def test_built_in_profiles_do_not_contradict_themselves(seed):
    """Flat parts that end just within what is looked at, steep powers and random tables among them."""
    rng = np.random.default_rng(seed)
    for _ in range(40):
        a, X = 10.0 ** rng.uniform(-6.0, -1.0), np.sort(rng.uniform(-2.0, 2.0, 12))
        height = np.maximum(np.abs(X) ** rng.uniform(1.5, 5.0) - rng.uniform(0.0, 0.1), 0.0)
        kinds = {
            "rounded_flat": {"flat_half_width": a / rng.uniform(1.0, 8.0), "radius": 100.0 * a},
            "power": {"exponent": rng.uniform(1.01, 15.0), "coefficient": 2.0}, "wedge": {"slope": 1e-4},
            "flat": {"half_width": a, "tilt": 1e-4}, "table": {"shape": [*zip(a * X, 1e-3 * a * height)]},
        }  # fmt: skip
        profiles = []
        for kind, given in kinds.items():
            with suppress(ValueError):  # random points that are no punch
                profiles.append(build_model(galinx.PROFILES[kind], given))
        assert len(profiles) >= 4
        for profile in profiles:
            check_slope(profile, a)


def test_loads_under_which_the_contact_is_wider_than_the_punch_are_refused():
    """Far too wide before anything is computed, and otherwise where it is solved."""
    shape = [[-1e-4, 1e-6], [0.0, 0.0], [1e-4, 1e-6]]
    punch = {"profile": "table", "shape": shape, "load": 1e6}
    with pytest.raises(BadInput, match=r"punch\.load: found 1e\+06 N/m: the contact would be 0\.00033"):
        computed("cylinder", ONE_STATE | {"punch": punch})
    with pytest.raises(SolveError, match=r"c = 0\.3: the contact would reach .* or a smaller load"):
        computed("cylinder", ONE_STATE | {"punch": punch | {"load": 5e5}})


def linear(law, z, s, V):
    return 0.3 * z[..., 0]


@pytest.mark.parametrize(
    "function, given, message",
    [("friction", lambda law, z, s, V: 0.3 * s, r"0\.3, of shape \(\), expected an array of .* \(2,\)"),
     ("friction", lambda law, z, s, V: None, r"None, .*\(\)"),
     ("friction", lambda law, z, s, V: 0.3 * z, r"\[0\.\], of shape \(1,\), .*\(\)"),
     ("friction", lambda law, z, s, V: 0.3 * z[:, 0] if np.ndim(z) > 1 else 0.3 * z, r"\[0\.\], .*\(\)"),
     ("friction", lambda law, z, s, V: [0.3] * len(z), r"\[0\.3\], a list .*\(\)"),
     ("rate", lambda law, z, s, V: None, r"None, .*\(1,\)"),
     ("rest", lambda law: np.zeros(0), r"\[\], .*\(1,\)"),
     ("rest", lambda law: 0.0, r"0\.0, .*\(1,\)"),
     ("exact", lambda law, z, s, V, slip: z + slip, r".* of shape \(2,\), .*\(2, 1\)")],
)  # fmt: skip
def test_a_law_without_numbers_is_refused(monkeypatch, function, given, message):
    own = {"about": "own", "friction": linear, "rate": lambda law, z, s, V: 1e6 * (s - z)}
    own[function] = given
    monkeypatch.setitem(galinx.LAWS, "own", dataclass(frozen=True)(type("Own", (FrictionLaw,), own)))
    with pytest.raises(BadInput, match=rf"friction: Own\.{function} gives {message}"):
        computed("tables4_5", ONE_STATE | {"friction": {"model": "own"}})


@dataclass(frozen=True)
class Whole(FrictionLaw):
    """Friction of whole numbers."""

    about = "whole"

    def exact(self, z, s, V, slip):
        return np.zeros((len(slip), 1))

    def friction(self, z, s, V):
        return np.full(np.shape(z)[:-1], s)


class Lost(Whole):
    """The same, with a state that is lost."""

    def exact(self, z, s, V, slip):
        return np.full((len(slip), 1), np.nan)


def test_friction_may_be_whole_numbers_but_a_state_is_a_number(monkeypatch):
    monkeypatch.setitem(galinx.LAWS, "own", Whole)
    of_law = {"friction": {"model": "own"}, "output.quantities": ["friction"], "solve.methods": []}
    result = computed("tables4_5", ONE_STATE | of_law)
    assert result.data["states/f"][0] == 1.0
    assert result.data["loops/breakaway"][0] == result.scene.punch.load
    monkeypatch.setitem(galinx.LAWS, "own", Lost)
    with pytest.raises(BadInput, match="along FM1 found a state that is not finite"):
        computed("tables4_5", ONE_STATE | of_law)


@pytest.mark.parametrize("name", ["", " ", "own "])
def test_names_of_models_are_not_blank(name):
    with pytest.raises(ValueError, match=f"the profile of the punch {name!r}: expected a name"):
        galinx.PROFILES.register(name, Flat)


@pytest.mark.parametrize(
    "of, message",
    [(lambda s, body: 1.0, r"shape \(\), expected \(1,\), states"),
     (lambda s, body: np.ones((1, 3)), r"shape \(1, 3\)")],
)  # fmt: skip
def test_a_quantity_of_another_shape_is_named(monkeypatch, of, message):
    row = galinx.Quantity("states/closed_form/own", "1", "own", ("states",), of, "closed_form")
    monkeypatch.setitem(galinx.QUANTITIES, row.path, row)
    with pytest.raises(BadInput, match=f"'states/closed_form/own' has the {message}"):
        computed("tables4_5", ONE_STATE)


def test_a_quantity_that_changes_stresses_changes_nothing_archived(monkeypatch):
    def changing(s, body):
        s.surface.σ_XX[:] = 0.0
        return np.ones(len(s.g))

    row = galinx.Quantity("states/closed_form/own", "1", "own", ("states",), changing, "closed_form")
    sound = computed("tables4_5", ONE_STATE).data["surface/closed_form/sigma_XX"]
    monkeypatch.setitem(galinx.QUANTITIES, row.path, row)
    result = computed("tables4_5", ONE_STATE)
    np.testing.assert_array_equal(result.data["surface/closed_form/sigma_XX"], sound)


def test_dimensions_of_a_quantity_are_no_text():
    row = galinx.Quantity("states/own", "1", "own", "states", lambda s, body: np.ones(1))
    with pytest.raises(TypeError, match="states/own: over = 'states', expected a tuple"):
        galinx.QUANTITIES.add(row)


def test_the_method_of_a_quantity_exists(monkeypatch):
    row = galinx.Quantity("states/femm/own", "1", "own", ("states",), lambda s, body: s.g, "femm")
    monkeypatch.setitem(galinx.QUANTITIES, row.path, row)
    with pytest.raises(
        BadInput, match="'states/femm/own': found method = 'femm', expected one of local, "
    ):
        computed("tables4_5", ONE_STATE)


@pytest.mark.parametrize("key", ["model", "pre_sliding", "vary"])
def test_a_parameter_with_the_name_of_a_key_is_refused(monkeypatch, key):
    field = key, float, parameter(key, "own", default=1.0)
    own = make_dataclass("Own", [field], bases=(Whole,), frozen=True)
    monkeypatch.setitem(galinx.LAWS, "own", own)
    with pytest.raises(
        BadInput, match=f"friction: model 'own' has the parameter {key}, which is a key of"
    ):
        computed("tables4_5", ONE_STATE | {"friction": {"model": "own"}})


def test_models_that_cannot_work_are_not_registered():
    @dataclass(frozen=True)
    class Still(FrictionLaw):
        about = "still"

        def friction(self, z, s, V):
            return z

    bare = type("Bare", (), dict.fromkeys(("about", "height", "slope", "words")))
    with pytest.raises(TypeError, match="'still': Still has neither rate nor exact"):
        galinx.LAWS.register("still", Still)
    with pytest.raises(TypeError, match="'bare': Bare is no dataclass; write @dataclass above it"):
        galinx.PROFILES.register("bare", bare)


OWN = """
from dataclasses import dataclass
import galinx
from galinx.solvers.solids import Isotropic

@dataclass(frozen=True)
class Cork(Isotropic):
    about = "cork"
    def __post_init__(self):
        if self.ν > 0.1:
            raise ValueError("expected cork, which hardly widens")

galinx.SOLIDS.register("cork", Cork)
"""


def test_a_file_of_models_is_run_before_a_command(tmp_path):
    (tmp_path / "own.py").write_text(OWN, encoding="utf-8")
    changes = ("--set", "solid.kind=cork", "--set", 'solve.methods=["closed_form"]')
    table = galinx.template("tables4_5").text
    (tmp_path / "s.toml").write_text(table, encoding="utf-8")
    good = command("-x", "own.py", "run", "s.toml", *changes, "--set", "solid.nu=0.05", cwd=tmp_path)
    assert good.returncode == 0, good.stderr
    bad = command("-x", "own.py", "plan", "s.toml", *changes, cwd=tmp_path)
    assert bad.returncode == 2 and "solid: expected cork" in bad.stderr
    without = here("plan", "s.toml", *changes, cwd=tmp_path)
    assert without.returncode == 2 and "-x FILE.py" in without.stderr
