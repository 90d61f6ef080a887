"""A verdict is never PASS over a value that is no answer, and check says what run said."""

import json

import numpy as np
import pytest
from support import computed, here

import galinx

ONE = {"motion.strokes": ["forward"], "motion.X_over_L": 0.8, "motion.c": 0.3}
CLOSED = {"solve.methods": ["closed_form"]}


@pytest.mark.parametrize(
    "nan_allowed, verdict", [("never", "FAIL"), ("beside the punch", "FAIL"), ("anywhere", "PASS")]
)
def test_a_nan_that_is_not_allowed_fails(nan_allowed, verdict, monkeypatch, tmp_path):
    row = galinx.Quantity(
        "surface/closed_form/nan", "1", "nothing", ("states", "points"),
        lambda s, _: np.where(s.surface.places.under, np.nan, 1.0) * np.ones((len(s.g), 1)),
        "closed_form", asked_by="surface", nan_allowed=nan_allowed,
    )  # fmt: skip
    monkeypatch.setitem(galinx.QUANTITIES, row.path, row)
    result = computed("tables4_5", ONE | CLOSED)
    assert result.verdict == verdict
    reasons = json.loads(result.attributes["verdict_reasons"])
    assert any("not finite" in reason for reason in reasons) == (verdict == "FAIL")


def test_exponents_that_cannot_be_fitted_are_no_fault(tmp_path):
    """At μ_C = 5 the raw pressure changes its sign beside an edge."""
    changes = ONE | {"friction.mu_c": 5.0, "friction.sigma0_over_load": 1e7, "solve.tolerance": 1e-4}
    result = computed("tables4_5", changes | {"motion.c": 0.82746})
    assert np.isnan(result.data["states/fem/alpha"]).any() or result.verdict == "PASS"
    assert not any(np.isnan(value) for value in result.comparisons.values())
    result.save(tmp_path / "a.h5")
    assert here("check", tmp_path / "a.h5").returncode == 0
