"""The study as a program: its verdict, on one rank and on two.

With all figures tests/docs/test_pages.py runs it as the README does.
"""

import json
import shutil
from copy import deepcopy

import numpy as np
import pytest
from scipy.integrate import quad
from support import THOROUGH, command, here, paper_run

from galinx.app.results.fields import displacement_under_punch
from galinx.app.results.result import Result
from galinx.app.scene import read as scenes
from galinx.app.study import paper, published
from galinx.postprocess.compare import RULES
from galinx.postprocess.hdf5 import archive
from galinx.solvers.contact.closed_form import FlatPunch


@pytest.fixture(scope="module")
def wrong(tmp_path_factory):
    """``paper`` with a wrong K_I in Table 4: process, folder and results.

    Its archives are those of a run before, and it draws no figures.
    """
    folder, tables, judged = tmp_path_factory.mktemp("wrong"), published.published(), []
    row = tables["table4"]["rows"][0]
    assert row[:3] == ["FM1", 0.2, 0.3161]
    row[2] = 0.3162
    own, computed = paper._judged, paper._computed

    def archived(scene, progress, target=None):
        if target is None:
            return computed(scene, progress)
        shutil.copy(paper_run()[0] / target.path.name, target.path)
        return Result(*archive.read(target.path))

    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(published, "published", lambda: deepcopy(tables))
        patched.setattr(paper, "_computed", archived)
        patched.setattr("galinx.app.study.drawings.of_study", lambda *_: iter(()))
        patched.setattr(paper, "_judged", lambda *results: judged.extend(results) or own(*results))
        done = here("paper", "-o", folder)
    return done, folder, judged


def test_a_wrong_table_is_a_fail(wrong):
    done, folder, _ = wrong
    assert done.returncode == 1, done.stderr
    assert "verdict: FAIL" in done.stdout and done.stdout.count(" NO ") == 1
    (line,) = (line for line in done.stdout.splitlines() if "rows not as printed" in line)
    assert line.split()[-2:] == ["1", "0"]
    page = (folder / "report.html").read_text(encoding="utf-8")
    assert '<span class="verdict FAIL">' in page and "rows not as printed, of 12: 1, at most 0" in page


def test_every_other_line_passes_and_each_can_fail(wrong):
    """With the table as it is published, and with each result spoiled."""
    _, _, results = wrong
    _, checks = paper._judged(*results)
    assert paper.failing(checks) == [] and len(checks) >= 16

    def failing(**spoiled):
        names = ("study", "inside", "block", "tractions", "tensor", "dolfinx")
        changed = [spoiled.get(name, result) for name, result in zip(names, results)]
        failed = paper.failing(paper._judged(*changed)[1])
        return {text.partition(":")[0].partition(",")[0] for text in failed}

    study, inside, block, tractions, _, dolfinx = results
    data = dict(study.data)
    data["surface/fem/sigma_YY_raw"] = data["surface/fem/sigma_YY_raw"] * (1.0 + 1e-5)
    assert failing(study=Result(data, study.attributes)) == {"σ_YY of the raw nodal forces"}
    assert failing(study=worse(study, "exponents", 1e-3)) == {"edge exponents fitted to them"}
    assert failing(study=worse(study, "exponents", np.nan)) == {"edge exponents fitted to them"}
    assert failing(study=worse(study, "K_I", 1e-5)) == {"K_I at both ends"}
    assert failing(inside=worse(inside, "stresses inside", 1e-5)) == {"stresses inside"}
    assert failing(block=worse(block, "K_I", 0.02)) == {"the block of Fig 4"}
    assert failing(tractions=worse(tractions, "slope under the punch", 1e-4)) == {
        "Dahl's friction and the pressure as tractions"
    }
    data = dolfinx.data | {"states/fem/K_I_right": dolfinx.data["states/fem/K_I_right"] * (1.0 + 2e-9)}
    assert failing(dolfinx=Result(data, dolfinx.attributes)) == {
        "K_I by dolfinx's own assembler on the same mesh at the same degree"
    }
    data = study.data | {"states/closed_form/K_I": study.data["states/closed_form/K_I"] * (1.0 + 1e-9)}
    assert failing(study=Result(data, study.attributes)) == {
        "expansion-collocation against the closed form"
    }


def worse(result, rule, value):
    """A result in which a comparison came out so."""
    comparisons = json.loads(result.attributes["comparisons"]) | {RULES[rule].text: value}
    return Result(result.data, result.attributes | {"comparisons": json.dumps(comparisons)})


def test_tables_1_and_3_are_in_the_verdict(wrong, monkeypatch):
    monkeypatch.setattr(paper, "not_as_printed", lambda *_: 1)
    checks = paper._judged(*wrong[2])[1]
    (line,) = paper.failing(checks)
    assert line == "Tables 1 and 3: entries not as printed, misprints aside" and checks[line] == (1, 0)


def test_displacement_under_the_punch_is_that_of_the_strain():
    """v is the same everywhere; u changes as the closed form's u,X says (Eqs 17-18)."""
    scene = scenes.read(paper.SCENES / "tables4_5.toml")
    X, (slow, fast) = displacement_under_punch(scene, [1, 7], 8)
    # They are sines, whose last digit is the machine's.
    assert X[[0, -1]] == pytest.approx([-1.0, 1.0], rel=1e-15) and np.all(np.diff(X) > 0.0)
    for (u, v), c, v_0 in ((slow, 4.786e-7, 0.9130e-6), (fast, 0.6, 1.3217e-6)):
        response, f = scene.solid.response(c), 0.7 * (1.0 - np.exp(-25.0 / 7.0 * 0.8))
        punch = FlatPunch(response, -f)
        np.testing.assert_allclose(v, v[0], rtol=1e-6)
        assert -v[0] == pytest.approx(v_0, rel=1e-4)
        middle = int(np.abs(X).argmin())
        for start, end in ((0, middle), (middle, len(X) - 1)):
            strain = quad(
                lambda r: response.q * punch.σ_YY(r) + response.m * punch.g * punch.hilbert(r),  # noqa: B023
                X[start], X[end], limit=400,
            )[0]  # fmt: skip
            assert u[end] - u[start] == pytest.approx(scene.body.displacement * strain, rel=1e-4)


@pytest.mark.skipif(not THOROUGH, reason="takes long: GALINX_THOROUGH=1")
def test_two_ranks_reproduce_the_study(tmp_path):
    done = command("-n", "2", "paper", "-o", tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "verdict: PASS" in done.stdout and done.stdout.count(" yes ") == 12
    assert (tmp_path / "study.h5").is_file() and (tmp_path / "fig10.pdf").is_file()
