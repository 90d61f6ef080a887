"""Mutated scenes: each runs, or ends with one readable message.

GALINX_THOROUGH=1 tries as many as a release does.
"""

from dataclasses import replace

import numpy as np
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from support import HOME, THOROUGH, at_most

from galinx import compute
from galinx.app.errors import BadInput
from galinx.app.plan.plan import expense, lines, make_plan
from galinx.app.scene.read import parse
from galinx.solvers.errors import SolveError
from galinx.solvers.friction.dahl import Dahl

SCENES = 2000 if THOROUGH else 40
#: One scene of so many that ask for finite elements is solved by them.
SHARE = 8 if THOROUGH else 24
TEXTS = [path.read_text(encoding="utf-8") for path in sorted((HOME / "scenes").glob("*.toml"))]

#: What a value may become.
_WORDS = """0 -1 nan inf -inf 1e308 1e-308 -0.0 "" "ν" "193GPa" "25mm" [] {} [[]] true "1e999Pa" [1,2,3]
["fem"] ["forward"] 0.5 1e-9 0.999 1979-05-27 "closed_form" [[-1,-1],[1,-1]] [[0,-1]] "box" "graded"
"traction" ["friction"] ["sif","interior"] "%s%n" "1lightyear" [0.3,"x"] 3 0.25 0.05 1e-3 1e-2"""

VALUES = [
    *_WORDS.split(), "9" * 400, "9" * 5000, "0x" + "f" * 5000, "[" * 3000, "[" * 300 + "]" * 300,
    "{a = 1}", "[{a = 1}]", '"1 Pa*9**9**9"', '"30 deg"', '"3 count"', '"5 %"', '"1 psi^9*psi^9"',
    '"\\u001b[31m"', str([0.9 * i / 5000 for i in range(5000)]), str([*range(1, 2000)]),
]  # fmt: skip


@st.composite
def mutated(draw):
    """A shipped scene with some values replaced, lines lost or repeated, or characters changed."""
    rows = draw(st.sampled_from(TEXTS)).splitlines()
    for _ in range(draw(st.integers(1, 4))):
        n = draw(st.integers(0, len(rows) - 1))
        kind = draw(st.sampled_from(["value", "value", "value", "lose", "repeat", "character", "key"]))
        if kind == "value" and "=" in rows[n]:
            rows[n] = rows[n].split("=")[0] + "= " + draw(st.sampled_from(VALUES))
        elif kind == "lose" and len(rows) > 1:
            del rows[n]
        elif kind == "repeat":
            rows.insert(n, rows[n])
        elif kind == "character" and rows[n]:
            i = draw(st.integers(0, len(rows[n]) - 1))
            rows[n] = rows[n][:i] + draw(st.characters(blacklist_categories=["Cs"])) + rows[n][i + 1 :]
        elif kind == "key" and "=" in rows[n]:
            rows[n] = draw(st.sampled_from(["E", "c", "points", "speed", "methods", "title", "δ"])) + (
                " =" + rows[n].split("=", 1)[1]
            )
    return "\n".join(rows)


@settings(max_examples=SCENES, deadline=None, derandomize=True, suppress_health_check=list(HealthCheck))
@given(text=mutated())
def test_a_mutated_scene_runs_or_is_refused_with_a_message(text):
    try:
        with at_most(10.0):
            scene = parse(text)
            plan = make_plan(scene)
            assert lines(plan) and expense(plan)
        # As many as take a second or two; over layers every speed has a kernel of its own.
        most = 200 if scene.layers else 5000
        if plan.states > most or plan.states * plan.numbers > 10**7:
            return
        with_fem = (plan.fem or plan.starts) and plan.states <= 200 and len(text) % SHARE == 0
        if plan.starts and not (with_fem and THOROUGH):
            return
        if plan.fem and not with_fem:
            only = replace(scene.solve, methods=("closed_form",))
            scene = replace(scene, solve=only)
        # Finite elements at several speeds take their time, and may have to be compiled first; so do
        # sliders whose springs ring.
        with at_most(300.0 if with_fem or scene.slider else 10.0):
            result = compute(scene)
    except (BadInput, SolveError) as error:
        assert 0 < len(str(error).strip()) < 8000 and "Traceback" not in str(error)
        return
    data = result.data
    assert np.isfinite(data["states/f"]).all()
    if scene.friction.law is Dahl:
        assert (np.abs(data["states/f"]) <= np.max(data["states/mu_c"]) * (1.0 + 1e-12)).all()
    if "states/closed_form/K_I" in data:
        K_I = data["states/closed_form/K_I"]
        assert ((K_I >= 0.0) & (1.0 / np.pi >= K_I)).all()
    if "states/fem/true_error" in data and result.verdict == "PASS":
        assert (data["states/fem/true_error"] <= data["states/fem/estimate"]).all()
