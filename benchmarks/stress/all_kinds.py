"""Random scenes of every kind of solid, profile and layer: do estimates tell the truth?

What a scene's verdict compares is what is known of it: finite elements against the closed form, or over
layers against the integral equation. An estimate below that under PASS is a fault; so is a FAIL by an
estimate alone, where all that is compared is within the tolerance, if there are many.
"""

import json
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from row import Row, Verdict

from galinx.app.errors import BadInput
from galinx.app.run.flow import Memory, compute
from galinx.app.scene.read import parse
from galinx.postprocess import compare
from galinx.solvers.errors import SolveError
from galinx.solvers.layers.layered import Layer, Layered
from galinx.solvers.parameters import values
from galinx.solvers.profiles import PROFILES, kinks
from galinx.solvers.profiles.punches import Flat, Parabolic, Power, RoundedFlat, Table, Wedge
from galinx.solvers.solids import SOLIDS
from galinx.solvers.solids.isotropic import Isotropic
from galinx.solvers.solids.plane import Anisotropic, Cubic, Orthotropic
from galinx.solvers.solids.solid import Solid

#: Share of all scenes that may FAIL by an estimate alone.
ALONE = 0.03

#: Names of estimates among the rules of the verdict, and of what is known of the truth of each; over
#: layers the integral equation's own estimate counts, too.
TRUTHS: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "estimate": (
        (
            "K_I",
            "ends",
            "largest pressure",
            "K_I over layers",
            "sigma_YY over layers",
            "ends over layers",
        ),
        ("estimate of the integral equation",),
    ),
    "estimate of sigma_XX": (("sigma_XX", "sigma_XX over layers"), ("estimate of sigma_XX, sie",)),
    "estimate inside": (("stresses inside", "stresses inside over layers"), ("estimate inside, sie",)),
    "estimate at interfaces, fem": (("stresses at interfaces",), ("estimate at interfaces, sie",)),
}

#: Modulus [Pa], density [kg/m³], load [N/m] and half-width [m] about which all is drawn.
_E, _ρ, _LOAD, _A = 1e11, 5e3, 1e5, 1e-3

_Random = np.random.Generator


@dataclass
class Judged:
    """What became of a scene.

    Attributes:
        text: of the scene.
        passed: its verdict.
        alone: does it FAIL by an estimate alone?
        ratios: estimates over what is known of the truth, by name.
    """

    text: str
    passed: bool
    alone: bool
    ratios: dict[str, float] = field(default_factory=dict)

    @property
    def below(self) -> bool:
        """Is an estimate below the truth, under PASS?"""
        return self.passed and min(self.ratios.values(), default=1.0) < 1.0


def judged(text: str) -> Judged:
    """Compute a scene of one state and judge it as its verdict does."""
    scene = parse(text)
    data = Memory()
    compute(scene, data)
    tolerance, load = scene.solve.tolerance, scene.punch.load
    found = compare.comparisons(data, load, compare.RULES)
    wrong = [name for name, value in found.items() if _is_wrong(name, value, tolerance)]
    ratios = {}
    for name, (truths, others) in TRUTHS.items():
        true = [found[truth] for truth in truths if truth in found]
        if name in found and true:
            estimate = found[name] + sum(found.get(other, 0.0) for other in others)
            ratios[name] = estimate / max(*true, np.finfo(float).tiny)
    alone = bool(wrong) and all(name.startswith("estimate") for name in wrong)
    return Judged(text, not wrong, alone, ratios)


def _is_wrong(name: str, value: float, tolerance: float) -> bool:
    limit = compare.RULES[name].allowed(tolerance)
    return limit is not None and not value <= limit


def scenes(seed: int) -> Iterator[str]:
    """Texts of random scenes without end; some of them may be refused."""
    rng = np.random.default_rng(seed)
    while True:
        yield _layered(rng) if rng.random() < 0.15 else _uniform(rng)


def all_kinds(seed: int = 1, count: int = 200) -> Row:
    """Random scenes of every kind: no estimate below the truth under PASS, hardly a FAIL by one alone.

    Args:
        seed: of the random numbers.
        count: of the scenes.
    """
    found: list[Judged] = []
    for text in scenes(seed):
        if len(found) == count:
            break
        # A contact may reach beyond its table, or have a kink next to an end.
        with suppress(BadInput, SolveError):
            found.append(judged(text))
    return row(found, seed)


def row(found: list[Judged], seed: int) -> Row:
    """What became of some scenes; one of few that FAILs by an estimate alone is no evidence."""
    count = len(found)
    names = sorted({name for one in found for name in one.ratios})
    of_name = {name: np.sort([one.ratios.get(name, np.inf) for one in found]) for name in names}
    below, alone, passed = (
        sum(getattr(one, name) for one in found) for name in ("below", "alone", "passed")
    )
    least = min((min(one.ratios.values()) for one in found if one.passed and one.ratios), default=1.0)
    return Row(
        "kinds", f"{count} random scenes of all kinds, seed {seed}", "scenes with less (1)",
        (np.arange(count) + 0.5) / count, "estimate over what is known of the true error (1)",
        {name: np.minimum(values_, 1e6) for name, values_ in of_name.items()},
        (
            Verdict(
                f"{below} of {count} scenes have an estimate below the truth under PASS, the least is "
                f"{least:.2f} of it", below == 0,
            ),
            Verdict(
                f"{alone} of {count} scenes FAIL by an estimate alone, allowed {ALONE:.0%}; "
                f"{count - passed} do not PASS", alone <= max(ALONE * count, 1.0),
            ),
        ),
        log_x=False,
    )  # fmt: skip


def _uniform(rng: _Random) -> str:
    solid = _SOLIDS[rng.integers(len(_SOLIDS))](rng)
    share = float(rng.choice([0.0, rng.uniform(0.0, 0.98), 1.0 - 10.0 ** rng.uniform(-1.7, -0.5)]))
    profile = _PROFILES[rng.integers(len(_PROFILES))](rng)
    tolerance = 10.0 ** rng.uniform(-9.0, -2.0)
    quantities = ["sif", *(["surface"] if rng.random() < 0.6 else [])]
    points: list[Any] = []
    if rng.random() < 0.25 and not solid.nearly_incompressible:
        quantities.append("interior")
        r, angle = 10.0 ** rng.uniform(-3.0, 0.7, 6), rng.uniform(0.02, np.pi - 0.02, 6)
        places = rng.choice([-1.0, 0.0, 1.0], 6) + r * np.cos(angle), -r * np.sin(angle)
        points = np.column_stack(places).tolist()
    mesh = "graded" if isinstance(profile, Flat) and rng.random() < 0.15 else "confocal"
    if mesh == "graded":  # finer is not what straight cells are meant for
        tolerance = max(tolerance, 1e-6)
    elif kinks(profile):  # cells towards kinks take minutes, and more over stiff fibres
        tolerance = max(tolerance, 1e-3)
        if isinstance(solid, Orthotropic):
            solid = replace(solid, E1=min(solid.E1, 10.0 * solid.E2))
    kind = next(name for name, known in SOLIDS.items() if known is type(solid))
    return _text(
        rng, _section("solid", {"kind": kind} | values(solid)), profile, share * solid.limit(), tolerance,
        quantities, points, ["closed_form", "fem"], mesh,
    )  # fmt: skip


def _layered(rng: _Random) -> str:
    substrate, coat, face = (
        Isotropic(one.E, min(one.ν, 0.45), one.ρ, "strain") for one in (_isotropic(rng) for _ in range(3))
    )
    bottom = face if rng.random() < 0.5 else None
    thickness = float(10.0 ** rng.uniform(-1.0, 0.7)) * _A
    solid = Layered((Layer(thickness, coat, bottom),), substrate)
    share = float(rng.choice([0.0, rng.uniform(0.0, 0.95)]))
    profile: Any = Flat(_A) if rng.random() < 0.7 else Parabolic(float(10.0 ** rng.uniform(-2.5, -1.0)))
    quantities = ["sif", *(["interfaces"] if rng.random() < 0.4 else [])]
    layer = {"thickness": thickness} | values(coat)
    text = _section("solid", {"kind": "isotropic"} | values(substrate)) + "[[layer]]\n" + _keys(layer)
    if bottom:
        of_face = ", ".join(f"{key} = {json.dumps(value)}" for key, value in _of_face(bottom))
        text += f"to = {{{of_face}}}\n"
    return _text(
        rng, text, profile, share * solid.limit(), 10.0 ** rng.uniform(-6.5, -2.0), quantities, [],
        ["sie", "fem"], "confocal",
    )  # fmt: skip


def _of_face(solid: Isotropic) -> list[tuple[str, Any]]:
    return [(key, value) for key, value in values(solid).items() if key != "plane"]


def _text(
    rng: _Random, solid: str, profile: Any, c: float, tolerance: float, quantities: list[str],
    points: list[Any], methods: list[str], mesh: str,
) -> str:  # fmt: skip
    kind = next(name for name, known in PROFILES.items() if known is type(profile))
    μ = float(rng.choice([rng.uniform(0.02, 1.1), 10.0 ** rng.uniform(-4.0, 0.0)]))
    return (
        solid
        + _section("punch", {"profile": kind} | values(profile) | {"load": _LOAD})
        + _section("friction", {"model": "coulomb", "mu_c": μ, "sign": _either(rng, "physical", "eq25")})
        + _section("motion", {"c": c, "strokes": ["forward"], "X_over_L": [0.5]})
        + _section("solve", {"methods": methods, "tolerance": float(tolerance), "mesh": mesh})
        + _section("output", {"quantities": quantities, "points": points})
    )


def _section(name: str, given: dict[str, Any]) -> str:
    return f"[{name}]\n{_keys(given)}"


def _keys(given: dict[str, Any]) -> str:
    kept = {key: value for key, value in given.items() if value is not None and np.size(value)}
    return "".join(f"{key} = {json.dumps(value)}\n" for key, value in kept.items())


def _either(rng: _Random, one: str, other: str) -> str:
    return one if rng.random() < 0.5 else other


def _isotropic(rng: _Random) -> Isotropic:
    return Isotropic(
        _E * float(10.0 ** rng.uniform(-0.5, 0.5)), float(rng.uniform(-0.3, 0.5)),
        _ρ * float(10.0 ** rng.uniform(-0.3, 0.3)), _either(rng, "strain", "stress"),
    )  # fmt: skip


def _orthotropic(rng: _Random) -> Solid:
    E1, angle = float(10.0 ** rng.uniform(0.0, 1.6)), float(rng.uniform(-180.0, 180.0))
    E3, ν12, ν13, ν23, G = (
        float(rng.uniform(*ends)) for ends in ((0.7, 1.0), *((0.0, 0.35),) * 3, (0.2, 0.6))
    )
    plane = _either(rng, "strain", "stress")
    return Orthotropic(_E * E1, _E, _E * E3, ν12, ν13, ν23, _E * G, _ρ, angle, plane)


def _cubic(rng: _Random) -> Solid:
    c12, shear = float(rng.uniform(-0.2, 0.8)), float(10.0 ** rng.uniform(-1.0, 0.5))
    plane, angle = _either(rng, "strain", "stress"), float(rng.uniform(-180.0, 180.0))
    return Cubic(_E, _E * c12, _E * shear * (1.0 - c12) / 2.0, _ρ, angle, plane)


def _anisotropic(rng: _Random) -> Solid:
    root = rng.normal(size=(3, 3))
    C = _E * (root @ root.T + 0.3 * np.eye(3))
    return Anisotropic(tuple(C[np.triu_indices(3)].tolist()), _ρ)


def _flat(rng: _Random) -> Flat:
    return Flat(_A, float(rng.choice([0.0, rng.uniform(-0.1, 0.1)])))


def _table(rng: _Random) -> Table:
    """Convex, far beyond where most contacts reach."""
    left, right = (10.0 ** rng.uniform(-4.5, -2.0, (2, 3))).tolist()
    X = np.sort([-2e-2, *(-x for x in left), *right, 2e-2])
    P = np.abs(X) ** float(rng.uniform(1.3, 2.5))
    P *= 1e-5 / np.interp(_A, X, P)
    return Table(tuple(zip(X.tolist(), P.tolist())))


def _power(rng: _Random) -> Power:
    k = float(rng.choice([rng.uniform(1.2, 2.0), rng.uniform(2.0, 5.0), 3.0, 4.0]))
    return Power(k, 1e-6 * float(10.0 ** rng.uniform(0.0, 1.5)) / _A**k)


#: What draws solids and profiles; isotropic ones, and flat punches, are most.
_SOLIDS: tuple[Callable[[_Random], Solid], ...] = (
    _isotropic, _isotropic, _orthotropic, _orthotropic, _cubic, _anisotropic,
)  # fmt: skip
_PROFILES: tuple[Callable[[_Random], Any], ...] = (
    _flat, _flat, _flat,
    lambda rng: Parabolic(float(10.0 ** rng.uniform(-2.5, -0.5))),
    lambda rng: Wedge(float(10.0 ** rng.uniform(-3.0, -1.5))),
    _power,
    lambda rng: RoundedFlat(_A * float(rng.uniform(0.3, 2.0)), float(10.0 ** rng.uniform(-2.5, -0.5))),
    _table,
)  # fmt: skip
