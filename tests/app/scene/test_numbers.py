"""Several numbers: one, a list, a range."""

import re
import tomllib

import pytest
from support import SCENE

from galinx.app.scene.changes import from_words
from galinx.app.scene.read import parse, read
from galinx.app.scene.values import Numbers
from galinx.solvers.parameters import Range


def numbers(text, unit="", **bounds):
    return Numbers(unit, Range(**bounds))(tomllib.loads(f"x = {text}")["x"])


@pytest.mark.parametrize(
    "text, expected",
    [
        ("{from = 0, to = 0.9, number = 10}", (0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9)),
        ("{from = 0.7, to = 0.1, number = 3}", (0.7, 0.4, 0.1)),
        ("{from = 0.1, to = 0.7, number = 2}", (0.1, 0.7)),
        ('{from = 1e-4, to = 1, number = 5, spacing = "log"}', (1e-4, 1e-3, 1e-2, 0.1, 1.0)),
        ('{from = 8, to = 1, number = 4, spacing = "log"}', (8.0, 4.0, 2.0, 1.0)),
        ('{from = 0, to = 1, number = 3, spacing = "linear"}', (0.0, 0.5, 1.0)),
    ],
)
def test_a_range_is_what_a_list_would_be(text, expected):
    assert numbers(text) == expected


@pytest.mark.parametrize("spacing", ["linear", "log"])
def test_ends_are_exact_and_numbers_in_order(spacing):
    first, last = 1.0 / 3.0, 5e-324
    found = numbers(f'{{from = {first!r}, to = {last!r}, number = 1000, spacing = "{spacing}"}}')
    assert len(found) == 1000 and (found[0], found[-1]) == (first, last)
    assert list(found) == sorted(set(found), reverse=True)


@pytest.mark.parametrize(
    "text, message",
    [
        ("{from = 0, to = 0.9, number = 1}", "number: found 1, expected >= 2"),
        ("{from = 0, to = 0.9, number = 1_000_001}", "<= 1e+06"),
        ("{from = 0, to = 0.9, number = 2.5}", "number: found 2.5, expected a whole number"),
        ('{from = 0, to = 0.9, number = 3, spacing = "log"}', "from 0 to 0.9 with spacing"),
        ('{from = 1, to = 2, number = 3, spacing = "even"}', "spacing: found 'even', expected linear or"),
        ("{form = 0, to = 0.9, number = 3}", "found the key 'form' in a range; did you mean from?"),
        ("{from = 0, to = 0.9}", "found a range without number, expected {from = "),
        ("{}", "found a range without from"),
        ("{from = 0.5, to = 0.5, number = 3}", "expected two different ends"),
        ("{from = [0], to = 0.5, number = 3}", "from: found [0], expected a dimensionless number"),
        ("{from = 0, to = '3 mm', number = 3}", "to: found '3 mm'"),
        ("{from = 0, to = 1.0, number = 3}", "to: found 1, expected >= 0, < 1"),
        ("[{from = 0, to = 0.5, number = 3}]", "expected a dimensionless number"),
    ],
)
def test_a_wrong_range_says_what_is_wrong(text, message):
    bounds = {"at_least": 0.0, "below": 1.0} if "spacing" not in text or "log" in text else {}
    with pytest.raises(ValueError, match=re.escape(message)):
        numbers(text, **bounds)


def test_every_list_of_a_scene_may_be_a_range():
    words = [f"{key}={{from = 0.1, to = 0.3, number = 3}}" for key in ("motion.c", "motion.X_over_L")]
    words += [
        "punch.load={from = '1 N/mm', to = 3e3, number = 3}",
        "friction.mu_c={from = 0.01, to = 1, number = 3, spacing = 'log'}",
        "friction.sigma0_over_load={from = '10 1/mm', to = 3e4, number = 3}",
    ]
    scene = read(SCENE, from_words(words))
    assert scene.motion.c == scene.motion.X_over_L == (0.1, 0.2, 0.3)
    assert scene.punch.loads == (1e3, 2e3, 3e3)
    assert scene.friction.parameters["mu_c"] == (0.01, 0.1, 1.0)
    assert scene.friction.parameters["sigma0_over_load"] == (1e4, 2e4, 3e4)
    assert parse(scene.text).motion == scene.motion
