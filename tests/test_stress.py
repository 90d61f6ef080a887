from dataclasses import replace

import all_kinds
import friction_law
import h5py
import matrix
import numpy as np
import pytest
import random_scenes
import resolution
from random_scenes import Ratios
from row import Row, Verdict, honest, reached

from galinx.postprocess.target import Folder


def test_rows_keep_their_word(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(
        matrix, "ROWS", (friction_law.exact_law, friction_law.runge_kutta_steps, resolution.degrees)
    )
    # The first scene of this seed, and the random ones of the other, are solved in a moment.
    monkeypatch.setattr(matrix, "all_kinds", lambda *_: all_kinds.all_kinds(5, 1))
    assert matrix.stress(Folder(tmp_path), seed=266, scenes=2)
    printed = capsys.readouterr().out
    assert "verdict: PASS" in printed and "FAILS" not in printed
    names = {path.name for path in tmp_path.iterdir()}
    drawings = (
        "dahl.pdf",
        *(f"{name}.png" for name in ("dahl", "runge_kutta", "degree", "random", "kinds")),
    )
    assert {"stress.h5", *drawings} <= names
    with h5py.File(tmp_path / "stress.h5") as file:
        assert file.attrs["verdict"] == "PASS" and len(file["degree/x"]) == 10
        assert file["dahl/x"].attrs["units"] == "1"


def test_a_broken_promise_fails(tmp_path, capsys, monkeypatch):
    broken, kept = (
        Row(name, "t", "x (1)", np.ones(2), "y (1)", {"a": np.ones(2)}, (Verdict("worse", holds),))
        for name, holds in (("x", False), ("random", True))
    )
    monkeypatch.setattr(matrix, "ROWS", (lambda: broken,))
    monkeypatch.setattr(matrix, "random_scenes", lambda *_: kept)
    monkeypatch.setattr(matrix, "all_kinds", lambda *_: replace(kept, name="kinds"))
    assert not matrix.stress(Folder(tmp_path), scenes=4)
    printed = capsys.readouterr().out
    assert "FAILS  worse" in printed and "holds  worse" in printed and "verdict: FAIL" in printed


def test_verdicts_can_fail():
    true, estimate = np.array([1e-8, 4e-8]), np.array([1e-8, 1e-8])
    assert not honest(true, estimate).holds and honest(0.2 * true, estimate).holds
    assert not reached(true, 3e-8, "here").holds and reached(true, 5e-8, "here").holds


@pytest.mark.parametrize(
    "found, holds",
    [
        ([2.0, 3.0, 90.0], True), ([0.9, 3.0, 4.0], False), ([2.0, 11.0, 12.0], True),
        ([2.0, 11.0, 12.0] * 4, True), ([2.0, 11.0, 12.0] * 20, False), ([9.0, 11.0] * 30, True),
        ([11.0] * 6, True), ([11.0] * 7, False),
    ],
)  # fmt: skip
def test_estimates_are_bounds_and_tight(found, holds):
    """By chance 2 of 3 scenes have more than the median, or 8 of 12; not 40 of 60, nor 7 of 7."""

    def good(*of_one_kind):
        return all(verdict.holds for verdict in random_scenes.verdicts({"kind": Ratios(*of_one_kind)}))

    assert good(found, found, found) == holds
    assert not good(found, found, [*found, 101.0]) and not good(found, found, found, [0.9])
