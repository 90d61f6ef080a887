"""The study's statements: against formulas written anew, and with results that say the opposite."""

import re
from itertools import pairwise
from math import log, pi

import numpy as np
import pytest
from study_reference import exponent, f_of, stresses
from support import kept

from galinx.app.study.published import FAST, SLOW, state_of
from galinx.app.study.statements import statements
from galinx.postprocess.quantities import column
from galinx.solvers.solids.isotropic import Isotropic

T302 = Isotropic(193e9, 0.25, 7860.0)
#: What the computed results say of each; the others hold.
DOES_NOT = {"5b", "6a", "12a"}
NUMBERS = [*"1234", "5a", "5b", "6a", "6b", *"789", "10", "11", "12a", "12b", *map(str, range(13, 18))]


@pytest.fixture(scope="module")
def study():
    """scenes/study.toml by the closed form."""
    return kept("study").data


@pytest.fixture
def data(study):
    """A copy to be changed."""
    return {path: np.array(values) if isinstance(values, np.ndarray) else values
            for path, values in study.items()}  # fmt: skip


def decided(data):
    return {one.number: one for one in statements(data, T302)}


def f(motion="FM1", X=0.2, μ=0.7, λ=25000.0, δ=1.0):
    return f_of(μ, λ, δ, motion, X)


def σ_YY(r, f, c):
    return stresses(np.asarray(r), f, c)[0]


def σ_XX(r, f, c):
    return float(stresses(np.asarray(r), f, c)[1])


UNDER = np.array([r for r in [*np.linspace(-0.88, 0.88, 45), -0.9, 0.9]])
BESIDE = 1.0 + 0.1 ** (4 / 3)
#: A step on the surface next to 1.05 a.
assert abs(BESIDE - 1.0464158883) < 1e-9


def apart(one, other, c=SLOW):
    return np.abs(σ_YY(UNDER, one, c) - σ_YY(UNDER, other, c)).max()


def behind(c=SLOW, **state):
    return σ_XX(-BESIDE, f(**state), c)


def ahead(c=SLOW, **state):
    return σ_XX(BESIDE, f(**state), c)


LEVELS, STIFFNESSES, EXPONENTS = (0.1, 0.3, 0.5, 0.7), (12500.0, 25000.0, 50000.0), (0.8, 1.0, 1.2, 1.5)
GRID = np.linspace(0.0, 1.0, 101)


def gap(**law):
    """Mean of f in FM1 less f in FM2."""
    return np.mean([f("FM1", X, **law) - f("FM2", X, **law) for X in GRID])


def percent(motion, c):
    early, late = (-np.sin(pi * exponent(f(motion, X), c)) / pi for X in (0.2, 0.8))
    return 100 * (late - early) / (late if motion == "BM1" else early)


def tilt(**varied):
    """-σ_YY at -0.9 a and 0.9 a, σ_XX behind and ahead, with a parameter."""
    ((name, values),) = varied.items()
    X = 0.2 if name == "λ" else 0.4
    frictions = [f(X=X, μ=0.5, **{name: value}) for value in values]
    return [
        *(-σ_YY(r, of, SLOW) for r in (-0.9, 0.9) for of in frictions),
        *(σ_XX(r, of, SLOW) for r in (-BESIDE, BESIDE) for of in frictions),
    ]


def independent():
    """The numbers that decide each statement, as and in the order in which they are printed."""
    every = [("FM1", X) for X in (0.2, 0.5, 0.8, 1.0)] + [("FM2", X) for X in (0.2, 0.5, 0.8, 1.0)]
    tension = [behind(c, motion=motion, X=X) for motion, X in every for c in (SLOW, FAST)]
    tension += [ahead(c, motion="BM1", X=X) for X in (0.2, 0.5, 0.8) for c in (SLOW, FAST)]
    FM1, FM2 = ([σ_XX(-BESIDE, f(motion, X), SLOW) for X in (0.2, 1.0)] for motion in ("FM1", "FM2"))
    higher = [
        X
        for X in GRID
        if any(f("FM2", X, 0.5, δ=b) > f("FM2", X, 0.5, δ=a) for a, b in pairwise(EXPONENTS))
    ]
    rising = [
        X
        for X in GRID
        if np.any(np.diff([f("FM1", X, 0.5, λ) - f("FM2", X, 0.5, λ) for λ in STIFFNESSES]) > 0)
    ]
    fine = np.linspace(-0.9, 0.9, 18001)
    second = [f("FM2", 0.2, 0.5, λ) for λ in STIFFNESSES]
    fast = [[abs(σ_XX(r, of, FAST) - σ_XX(r, of, SLOW)) for r in (-BESIDE, BESIDE)] for of in second]
    most = [behind(FAST, X=X, μ=μ) for μ in LEVELS for X in (0.2, 0.4, 0.5, 0.8, 1.0)]
    spread = [
        (np.ptp([σ_YY(UNDER, f(X=X, μ=μ), SLOW) for μ in LEVELS], axis=0).max(),
         np.ptp([behind(X=X, μ=μ) for μ in LEVELS])) for X in (0.2, 0.8)
    ]  # fmt: skip
    lean = {name: tilt(**{name: values}) for name, values in (("λ", STIFFNESSES), ("δ", EXPONENTS))}
    return {
        "2": shown(".2f", *(f(X=0.1, μ=μ) / μ for μ in LEVELS)),
        "3": shown(".3f", *(gap(μ=μ) for μ in LEVELS), *(gap(μ=0.5, λ=λ) for λ in STIFFNESSES))
        + shown(".2f", max(rising)),
        "4": shown(".3f", *(0.5 * log(2.0) / (λ * 1e-4) for λ in STIFFNESSES)),
        "5a": shown(".2f", *(f(X=1.0, μ=0.5, δ=δ) / 0.5 for δ in EXPONENTS)),
        "5b": shown(".2f", max(higher), *(f("FM2", 0.0, 0.5, δ=δ) for δ in EXPONENTS)),
        "6a": shown(".2f", *(apart(f("FM1", X), f("BM1", X)) for X in (0.2, 0.5, 1.0))),
        "6b": shown(".2f", *(apart(f("FM1", X), f("BM1", 1.0 - X)) for X in (0.2, 0.5, 1.0)),
                    *(apart(f("FM1", X), f("FM2", X)) for X in (0.5, 1.0))),
        "7": shown(".1%", max(
            np.abs(σ_YY(UNDER, one, FAST) / σ_YY(UNDER, one, SLOW) - 1).max()
            for one in (f("FM1", 1.0), f("BM1", 0.2)))),
        "8": ["22 of 22", *shown("+.2f", min(tension), max(tension)), *shown(".3f", BESIDE)],
        "9": shown(".2f", FM2[0], FM1[0]) + shown(".1%", 1 - FM2[1] / FM1[1]),
        "10": shown(".2f", *(behind(FAST, X=X) - behind(X=X) for X in (0.2, 0.5, 0.8, 1.0)),
                    *(behind(FAST, X=0.8, μ=μ) - behind(X=0.8, μ=μ) for μ in LEVELS)),
        "11": shown(".2f", spread[0][0], spread[1][0], spread[0][1], spread[1][1]),
        "12a": shown(".2f", *lean["λ"][:6], *(fine[σ_YY(fine, f(X=0.2, μ=0.5, λ=λ), SLOW).argmax()]
                                              for λ in STIFFNESSES)),
        "12b": shown(".2f", *lean["λ"][6:]),
        "13": shown("+.4f", *second),
        "14": shown(".2f", *np.max(fast, axis=1)),
        "15": shown(".2f", *lean["δ"]),
        "16": shown("+.2f", *(percent(m, c) for c in (SLOW, FAST) for m in ("FM1", "BM1", "FM2"))),
        "17": shown(".2f", min(most), max(most), *(max(
            ahead(FAST, X=X, μ=μ) for μ in LEVELS for X in (0.2, 1.0)),)),
    }  # fmt: skip


def shown(form, *values):
    return [f"{value:{form}}" for value in values]


def test_all_statements_with_what_decides_them(data):
    found = decided(data)
    assert list(found) == NUMBERS
    assert {number for number, one in found.items() if not one.holds} == DOES_NOT
    for number, expected in independent().items():
        in_order = r"(?!\d).*?(?<![\d.])".join(map(re.escape, expected))
        assert re.search(in_order, found[number].numbers), (number, found[number].numbers, expected)


def loops(data, **law):
    """Friction along the three strokes of a law, to be changed."""
    row = data["loops/of_state"][state_of(data, SLOW, "FM1", 0.2, **law)]
    return data["loops/f"][row].reshape(3, -1)


def surface(data, what, **state):
    """A stress of a state, to be changed."""
    state = {"c": SLOW, "motion": "FM1", "X": 0.2} | state
    return data[f"surface/closed_form/sigma_{what}"][state_of(data, **state)]


def put(target, values):
    target[...] = np.array(values)


def scale(target, factor):
    target *= factor


def swap(one, other):
    one[...], other[...] = other.copy(), one.copy()


def turn(*arrays):
    for one in arrays:
        put(one, one[..., ::-1])


def mirror(data):
    turn(*(data[f"surface/closed_form/sigma_{what}"] for what in ("XX", "YY")))


LAST = {"motion": "FM2", "mu_c": 0.5, "sigma0_over_load": 50000.0}
#: By the number of a statement: results that say the opposite.
OPPOSITE = {
    "1": lambda d: put(d["states/f"], d["states/f"] + 1e-6 * (d["states/c"] == FAST)),
    "2": lambda d: scale(loops(d, mu_c=0.1)[0], 0.9),
    "3": lambda d: put(loops(d, mu_c=0.7)[2], loops(d, mu_c=0.7)[0]),
    "4": lambda d: swap(*(loops(d, mu_c=0.5, sigma0_over_load=λ) for λ in STIFFNESSES[::2])),
    "5a": lambda d: swap(*(loops(d, mu_c=0.5, delta=δ) for δ in EXPONENTS[::3])),
    "5b": lambda d: [put(loop[2], loop[0]) for δ in EXPONENTS for loop in [loops(d, mu_c=0.5, delta=δ)]],
    "6a": lambda d: [
        put(surface(d, "YY", X=X, motion="BM1"), factor * surface(d, "YY", X=X) + more)
        for X, factor, more in ((0.2, 1.0, 0.1), (0.5, 1.0, 1.0), (1.0, 0.5, 0.0))
    ],
    "6b": lambda d: turn(loops(d)[1]),
    "7": lambda d: scale(surface(d, "YY", c=FAST), 1.2),
    "8": lambda d: turn(surface(d, "XX", motion="BM1", X=0.5)),
    "9": lambda d: scale(surface(d, "XX", motion="FM2", X=1.0), 1.5),
    "10": lambda d: [
        swap(*(surface(d, "XX", c=c, X=X) for c in (SLOW, FAST))) for X in (0.2, 0.5, 0.8, 1.0)
    ],
    "11": lambda d: [
        swap(*(surface(d, what, X=X, mu_c=μ) for X in (0.2, 0.8)))
        for μ in LEVELS
        for what in ("XX", "YY")
    ],
    "12a": mirror,
    "12b": mirror,
    "13": lambda d: np.negative.at(
        d[column("f")],
        [state_of(d, c, "FM2", 0.2, mu_c=0.5, sigma0_over_load=12500.0) for c in (SLOW, FAST)],
    ),
    "14": lambda d: put(surface(d, "XX", c=FAST, **LAST), surface(d, "XX", **LAST)),
    "15": mirror,
    "16": lambda d: scale(d["states/closed_form/K_I_right"], 1.001),
    "17": lambda d: scale(surface(d, "XX", c=FAST, X=1.0), 0.5),
}


@pytest.mark.parametrize("number", NUMBERS)
def test_other_results_turn_a_statement_round(data, number):
    before = decided(data)[number]
    OPPOSITE[number](data)
    after = decided(data)[number]
    assert before.holds == (number not in DOES_NOT)
    assert after.holds != before.holds, after.words


def test_in_plane_stress_that_does_not_follow_friction_is_not_said_to(data):
    turn(surface(data, "XX", motion="FM2", mu_c=0.5, sigma0_over_load=12500.0))
    assert not (of := decided(data)["13"]).holds and "σ_XX does not follow at both speeds" in of.words


def test_a_state_that_is_missing_is_named(data):
    data["states/X_over_L"][data["states/X_over_L"] == 0.5] = 0.55
    with pytest.raises(LookupError, match=r"X/L = 0\.5"):
        statements(data, T302)
