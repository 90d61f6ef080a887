"""Models of a user's own, registered from outside: solved by two methods, archived, drawn, refused."""

from contextlib import contextmanager
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import pytest
from support import THOROUGH, command, computed, here

import galinx
from galinx.solvers.errors import SolveError


@dataclass(frozen=True)
class Crowned:
    """A base that rises by ``rise`` at the edges, and a little more to the right."""

    about: ClassVar[str] = "crowned"

    half_width: float = galinx.parameter("half_width", "half-width a", "m", above=0.0)
    rise: float = galinx.parameter("rise", "height of the edges", "m")

    def height(self, X):
        s = X / self.half_width
        return self.rise * (s**2 + 0.3 * s**3)

    def slope(self, X):
        s = X / self.half_width
        return self.rise * (2.0 * s + 0.9 * s**2) / self.half_width

    def words(self):
        return f"crowned punch, half-width {self.half_width:g} m"


@pytest.mark.parametrize("c", [0.0, 0.6, 0.9] if THOROUGH else [0.6])
def test_finite_elements_and_collocation_agree_on_a_profile(c, monkeypatch):
    monkeypatch.setitem(galinx.PROFILES, "crowned", Crowned)
    changes = {"punch.profile": "crowned", "punch.rise": "30 nm", "motion.c": c}
    result = computed("tables4_5", changes)
    data = result.data
    assert result.verdict == "PASS", result.attributes["verdict_reasons"]
    assert data["states/fem/true_error"].max() <= 1e-6
    left, right = (data[f"states/closed_form/K_I_{side}"] for side in ("left", "right"))
    assert (left - right).max() > 4e-3, "the higher edge carries less"
    assert "states/closed_form/K_I" not in data and "states/fem/slope_under_punch" not in data
    assert result.comparisons["σ_YY pointwise, relative"] <= 1e-5
    assert result.comparisons["σ_XX pointwise, relative to itself or the largest"] <= 1e-6


@dataclass(frozen=True)
class Falling(galinx.FrictionLaw):
    """Friction that falls with the speed, from μ_S to nothing."""

    about: ClassVar[str] = "falling friction"

    μ_S: float = galinx.parameter("mu_s", "friction at rest", symbol=r"\mu_S", above=0.0)
    v: float = galinx.parameter("fall_speed", "speed of the fall", "m/s", above=0.0)

    def exact(self, z, s, V, slip):
        return np.zeros((len(slip), 1))

    def friction(self, z, s, V):
        return np.full(z.shape[:-1], s * self.μ_S * np.exp(-V / self.v))


LAW = {
    "friction.model": "falling", "friction.mu_s": [0.3, 0.6], "friction.fall_speed": "1 km/s",
    "friction.mu_c": None, "friction.sigma0_over_load": None, "friction.delta": None,
}  # fmt: skip


def test_a_law_that_depends_on_the_speed_is_followed_at_each(monkeypatch, tmp_path):
    monkeypatch.setitem(galinx.LAWS, "falling", Falling)
    result = computed("tables4_5", LAW | {"solve.methods": ["closed_form"]})
    data, V = result.data, result.data["states/c"] * result.scene.solid.c_s
    signs = np.where(data["states/motion"] == "BM1", -1.0, 1.0)
    np.testing.assert_allclose(
        data["states/f"], signs * data["states/mu_s"] * np.exp(-V / 1e3), rtol=1e-13
    )
    assert data["loops/f"].shape == (4, 303)
    grid = result.grid
    assert grid.f.sel(mu_s=0.6, motion="FM1").dims == ("c", "fall_speed", "X_over_L")
    drawn = next(iter(result.drawings(figures=("friction",)))).figure
    legend = [text.get_text() for text in drawn.legends[0].get_texts()][:4]
    first = r"$V = 0.0015\,\mathrm{m/s}$, $\mu_S = 0.3$"
    assert legend[0] == first and len(set(legend)) == 4
    result.report(tmp_path / "r.html")
    assert "falling friction" in (tmp_path / "r.html").read_text(encoding="utf-8")


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
    (tmp_path / "wrong.py").write_text("import galinx\n1 / 0\n", encoding="utf-8")
    for name, said in (
        ("wrong.py", "ZeroDivisionError: division by zero, line 2"),
        ("no.py", "cannot read"),
    ):
        done = here("-x", name, "plan", "s.toml", cwd=tmp_path)
        assert done.returncode == 2 and said in done.stderr and "Traceback" not in done.stderr
