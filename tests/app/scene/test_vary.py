"""Tables [[friction.vary]]: laws that are a union of products."""

import re

import numpy as np
import pytest
from support import HOME

from galinx.app.errors import BadInput
from galinx.app.scene.changes import from_words
from galinx.app.scene.read import parse, read
from galinx.solvers.parameters import values

_REST = '[solid]\nmaterial = "T302"\n[motion]\nc = 0.3\n'
_DAHL = '[friction]\nmu_c = 0.5\nsigma0_over_load = "25 1/mm"\n'


def laws(tables, section=_DAHL):
    """Parameters of the laws of a scene, one tuple a law, and its friction."""
    friction = parse(_REST + section + tables).friction
    return [tuple(values(law).values()) for law in friction.laws()], friction


def test_tables_are_products_of_their_own_and_laws_come_once():
    tables = (
        "[[friction.vary]]\nmu_c = [0.1, 0.5]\n"
        '[[friction.vary]]\nsigma0_over_load = ["12.5 1/mm", 25e3]\n'
        "delta = {from = 1, to = 2, number = 2}\n"
        "[[friction.vary]]\n"
    )
    listed, friction = laws(tables)
    assert listed == [
        (0.1, 25e3, 1.0), (0.5, 25e3, 1.0), (0.5, 12.5e3, 1.0), (0.5, 12.5e3, 2.0), (0.5, 25e3, 2.0),
    ]  # fmt: skip
    assert friction.count == 5
    assert [tuple(row) for row in zip(*friction.columns().values())] == listed
    together = friction.together(friction.columns(), slice(1, 4))
    assert np.ravel(together.δ).tolist() == [1.0, 1.0, 2.0]


@pytest.mark.parametrize(
    "tables, message",
    [
        ("[[friction.vary]]\nmu = 0.3", "found the key 'mu' in table 1; did you mean mu_c?"),
        ("[[friction.vary]]\n[[friction.vary]]\nsign = 'eq25'", "'sign' in table 2; valid: mu_c"),
        ("[[friction.vary]]\nmu_c = [0.1, -3]", "in table 1, mu_c: found -3, expected > 0"),
        ("[[friction.vary]]\nmu_c = []", "in table 1, mu_c: found an empty list"),
        ("vary = 3", "found 3, expected tables [[friction.vary]]"),
        (
            "[[friction.vary]]\nmu_c = {from = 0.1, to = 1, number = 500}\n"
            "delta = {from = 1, to = 2, number = 500}",
            "vary: found 250000 laws, expected at most 100000",
        ),
    ],
)
def test_mistakes_are_named(tables, message):
    with pytest.raises(BadInput, match=re.escape(message)):
        laws(tables)


def test_changes_reach_the_tables():
    study = HOME / "scenes" / "study.toml"
    assert read(study, from_words(["friction.sign=eq25"])).friction.count == 9
    other = read(study, from_words(["friction.vary=[{mu_c = [0.2, 0.3]}]"]))
    assert [law.μ_C for law in other.friction.laws()] == [0.2, 0.3]
    assert read(study, from_words([], ["friction.vary"])).friction.count == 1
    coulomb = read(study, from_words(["friction.model=coulomb"]))  # has no parameter that is varied
    assert coulomb.friction.count == 1 and coulomb.friction.vary == ()
