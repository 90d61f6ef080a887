"""The study's statements on its results (its sections 5 and 6), each decided by numbers.

Friction is that of the archive's loops and states; stresses are those of finite elements, or of the
closed form where an archive has these alone. The numbers that stand for words such as "close" are defined
below.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.quantities import column, runs, states, stresses
from galinx.postprocess.quantities.quantity import CLOSED_FORM, FEM
from galinx.postprocess.tables import Sheet
from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.contact.edges import under_punch
from galinx.solvers.solids import Solid

from .published import FAST, MILDER, REFERENCE, SLOW, published, state_of

#: "Near", "close" and "negligible": a share of the whole. "Slight" beside "notable": a share of that.
NEAR, SLIGHT = 0.1, 0.5

#: Position over a under the punch up to which pressures are compared, and that of σ_XX beside it: at the
#: edges both are infinite.
UNDER, BESIDE = 0.9, 1.05


@dataclass(frozen=True)
class Statement:
    """One of the study's statements, or one reading of it.

    Attributes:
        number: in the order of the study's text, with a letter where there are several readings.
        claim: what the study says, and where.
        holds: True where the numbers agree with the claim.
        numbers: the numbers that decide.
    """

    number: str
    claim: str
    holds: bool
    numbers: str

    @property
    def words(self) -> str:
        """Verdict and numbers as they are printed."""
        return f"{'holds' if self.holds else 'does not'}: {self.numbers}"


class Results:
    """States and loops of an archive of scenes/study.toml; states are those of FM1 at X/L = 0.2, slow, by
    the reference law, but for what is given.

    Args:
        data: the archive.
        solid: the scene's.
    """

    def __init__(self, data: dict[str, Any], solid: Solid) -> None:
        method = FEM if stresses.IN_PLANE[FEM].path in data else CLOSED_FORM
        self.data, self.solid = data, solid
        self.state = partial(state_of, data)
        self.X: NDArray[np.float64] = data[stresses.SURFACE_X.path]
        self.in_plane, self.pressure = (
            data[rows[method].path] for rows in (stresses.IN_PLANE, stresses.PRESSURE)
        )
        #: Where pressures are compared; the places next to the punch's ends, -a and a, and inside them.
        self.under = np.abs(self.X) <= UNDER
        self.behind, self.ahead, self.left, self.right = (
            int(np.abs(self.X - X).argmin()) for X in (-BESIDE, BESIDE, -UNDER, UNDER)
        )
        #: Position beside the punch at which σ_XX is read, over a, as it is printed.
        self.beside = f"{self.X[self.ahead]:.4g} a"
        #: X/L of the steps of a forward stroke.
        self.places: NDArray[np.float64] = data[runs.LOOP_X.path].reshape(3, -1)[0]

    def over(self, name: str, law: dict[str, float]) -> list[dict[str, float]]:
        """Laws in which one parameter takes all its values and the others are those of a law."""
        columns = {key: self.data[column(key)] for key in law}
        chosen = np.all([columns[key] == law[key] for key in law if key != name], axis=0)
        return [law | {name: value} for value in np.unique(columns[name][chosen]).tolist()]

    def f(self, **state: Any) -> float:
        """Friction coefficient of a state."""
        return float(self.data[states.FRICTION.path][self.state(**state)])

    def σ_XX(self, at: Any, **state: Any) -> Any:
        """In-plane stress of a state over N/(2a), at one or several of the positions."""
        return self.in_plane[self.state(**state), at]

    def contact_stress(self, **state: Any) -> NDArray[np.float64]:
        """Contact stress of a state over N/(2a) where pressures are compared."""
        return self.pressure[self.state(**state), self.under]

    def loop(self, **law: Any) -> NDArray[np.float64]:
        """f along FM1, BM1 and FM2 of a law, each in the order of travel, (3, steps)."""
        row = self.data[runs.LOOP_OF_STATE.path][self.state(**law)]
        return self.data[runs.LOOP_F.path][row].reshape(3, -1)

    def lean(self, name: str, X: float) -> tuple[list[float], ...]:
        """-σ_YY near -a and a, and σ_XX behind and ahead, while a parameter of the milder law grows."""
        laws: list[dict[str, Any]] = [*self.over(name, MILDER)]
        pressures = (
            [-float(self.pressure[self.state(X=X, **law), at]) for law in laws]
            for at in (self.left, self.right)
        )
        in_plane = (
            [float(self.σ_XX(at, X=X, **law)) for law in laws] for at in (self.behind, self.ahead)
        )
        return (*pressures, *in_plane)


def _to(values: Any, form: str = ".2f") -> str:
    """Numbers one after the other, as they are printed."""
    return ", ".join(f"{value:{form}}" for value in values)


def _grows(values: Any) -> bool:
    return bool(np.all(np.diff(values, axis=0) > 0.0))


def _falls(values: Any) -> bool:
    return bool(np.all(np.diff(values, axis=0) < 0.0))


def _apart(first: NDArray, second: NDArray) -> float:
    """Largest difference of two stresses along the surface."""
    return float(np.abs(first - second).max())


#: Number and claim of a statement, whether it holds, and the numbers that decide.
_Decided = Iterator[tuple[str, str, Any, str]]


def _friction(r: Results) -> _Decided:
    """Fig 6: friction along the strokes."""
    c, f = (r.data[row.path] for row in (states.SPEED, states.FRICTION))
    off = _apart(f[c == SLOW], f[c == FAST])
    yield (
        "1", "f does not depend on speed (Fig 6a)",
        off <= 1e-12, f"f of {np.sum(c == SLOW)} pairs of states differs by {off:.1g}",
    )  # fmt: skip

    place = 1e-5 / published()["table1"]["L_m"]
    shares = [
        np.interp(place, r.places, r.loop(**law)[0]) / law["mu_c"] for law in r.over("mu_c", REFERENCE)
    ]
    yield (
        "2", "μ_C = 0.1: nearly steady within 0.01 mm; larger μ_C need more (6b)",
        shares[0] >= 1.0 - NEAR and _falls(shares), f"f/μ_C = {_to(shares)} there with μ_C",
    )  # fmt: skip

    by_level, by_stiffness = (
        [float((loop[0] - loop[2]).mean()) for loop in (r.loop(**law) for law in r.over(name, others))]
        for name, others in (("mu_c", REFERENCE), ("sigma0_over_load", MILDER))
    )
    loops = [r.loop(**law) for law in r.over("sigma0_over_load", MILDER)]
    rises = np.any(np.diff([loop[0] - loop[2] for loop in loops], axis=0) > 0.0, axis=0)
    until = r.places[rises].max(initial=0.0)
    early = f"; at X/L up to {until:.2g} it grows with σ₀l/N" if rises.any() else ""
    yield (
        "3", "f of FM1 and FM2: the difference grows with μ_C and falls with σ₀l/N (6b, c)",
        _grows(by_level) and _falls(by_stiffness),
        f"mean over a stroke {_to(by_level, '.3f')} with μ_C; {_to(by_stiffness, '.3f')} with σ₀l/N"
        + early,
    )  # fmt: skip

    first = [loop[0] for loop in loops]
    ahead = np.diff(first, axis=0)[:, 1:].min()
    half = [np.interp(0.5 * MILDER["mu_c"], loop, r.places) for loop in first]
    yield (
        "4", "larger σ₀l/N: friction develops sooner (6c)",
        ahead > 0.0, f"μ_C/2 at X/L = {_to(half, '.3f')}; in FM1 f larger by {ahead:.1g} at least",
    )  # fmt: skip

    first, _, second = np.moveaxis(np.array([r.loop(**law) for law in r.over("delta", MILDER)]), 1, 0)
    lower, share = np.diff(first, axis=0)[:, 1:].max(), first[:, -1] / MILDER["mu_c"]
    yield (
        "5a", "larger δ_D: f lower at all X, steady later (6d): FM1",
        lower < 0.0 and _falls(share), f"lower by {-lower:.1g} at least; f/μ_C at L {_to(share)}",
    )  # fmt: skip
    higher = np.any(np.diff(second, axis=0) > 0.0, axis=0)
    until = r.places[higher].max(initial=0.0)
    words = f"higher up to X/L = {until:.2g} (at 0 {_to(second[:, 0])})"
    yield "5b", "the same: FM2", not higher.any(), words if higher.any() else "lower at all X"


def _strokes(r: Results) -> _Decided:
    """Figs 5, 7 and 8: stresses of the three strokes, slow and fast."""
    places = (0.2, 0.5, 1.0)
    nearly = [_apart(r.contact_stress(X=X), r.contact_stress(X=X, motion="FM2")) for X in places[1:]]
    on_axis = [_apart(r.contact_stress(X=X), r.contact_stress(X=X, motion="BM1")) for X in places]
    sign, response = r.data[states.RATIO.path][r.state()] / r.f(), r.solid.response(SLOW)
    travelled = [
        _apart(r.contact_stress(X=X), FlatPunch(response, sign * f).σ_YY(r.X[r.under]))
        for X, f in zip(places, np.interp(places, r.places, r.loop()[1]).tolist())
    ]
    for number, claim, differences, note in (
        ("6a", "σ_YY of FM1 and BM1 differ slightly at X/L = 0.2, notably at 0.5 and 1.0; FM2 nearly as "
               "FM1 at 0.5, 1.0 (7). X/L on the axis, as in Tables 4, 5",
         on_axis, "; X/L = 1 is the turn, f is FM1's"),
        ("6b", "the same, X/L travelled since the turn",
         travelled, f"; FM2 by {_to(nearly)} at 0.5, 1.0"),
    ):  # fmt: skip
        slight = differences[0] < SLIGHT * min(differences[1:])
        yield number, claim, slight and max(nearly) < NEAR, f"by {_to(differences)}{note}"

    c, σ = r.data[states.SPEED.path], r.pressure[:, r.under]
    off = np.abs(σ[c == FAST] / σ[c == SLOW] - 1.0).max()
    yield (
        "7", "σ_YY of SS and HS close in all cases (7 to 10)",
        off < NEAR, f"at most {off:.1%} apart in {np.sum(c == FAST)} pairs",
    )  # fmt: skip

    right, peaks = 0, []
    for motion, X, speed in product(("FM1", "BM1", "FM2"), (0.2, 0.5, 0.8, 1.0), (SLOW, FAST)):
        if (motion, X) == ("BM1", 1.0):  # the turn, where f is still FM1's
            continue
        behind_and_ahead = [r.behind, r.ahead][:: 1 if motion[0] == "F" else -1]
        peak, other = r.σ_XX(behind_and_ahead, motion=motion, X=X, c=speed)
        right += peak > 0.0 > other
        peaks.append(peak)
    yield (
        "8", "tensile peak of σ_XX behind the motion: X = -a in FM1 and FM2, X = a in BM1 (5, 7)",
        right == len(peaks),
        f"in {right} of {len(peaks)} states, {min(peaks):+.2f} to {max(peaks):+.2f} at {r.beside} "
        f"(BM1's X/L = 1, the turn, is left out: f = {r.f(motion='BM1', X=1.0):+.2f} there)",
    )  # fmt: skip

    early, late = ([r.σ_XX(r.behind, X=X, motion=m) for m in ("FM1", "FM2")] for X in (0.2, 1.0))
    off = abs(late[1] / late[0] - 1.0)
    yield (
        "9", "σ_XX of FM2 at X/L = 0.2 smaller than FM1's, the difference negligible at 1.0 (7)",
        abs(early[1]) < abs(early[0]) and off < NEAR,
        f"{early[1]:.2f}, FM1 {early[0]:.2f} at -{r.beside}; {off:.1%} apart at 1.0",
    )  # fmt: skip


def _level(r: Results) -> _Decided:
    """Fig 8: stresses by the level of friction, slow and fast."""

    def more(at: Any, **state: Any) -> Any:
        return r.σ_XX(at, c=FAST, **state) - r.σ_XX(at, **state)

    places, laws, under = (0.2, 0.5, 0.8, 1.0), r.over("mu_c", REFERENCE), under_punch(r.X)
    by_place = [more(r.behind, X=X) for X in places]
    by_level = [more(r.behind, X=0.8, **law) for law in laws]
    compressive = max(more(under, X=X, **law).max() for law in laws for X in places)
    yield (
        "10", "HS: σ_XX more compressive under the punch, larger outside; the difference to SS grows "
              "with X/L and μ_C (7, 8)",
        compressive < 0.0 and min(by_place + by_level) > 0.0 and _grows(by_place) and _grows(by_level),
        f"HS - SS at -{r.beside} {_to(by_place)} with X/L, {_to(by_level)} with μ_C; under the punch "
        f"at most {compressive:.2f}",
    )  # fmt: skip

    σ_YY, σ_XX = (
        [float(np.ptp([of(X=X, **law) for law in laws], axis=0).max()) for X in (0.2, 0.8)]
        for of in (r.contact_stress, lambda **state: r.σ_XX(r.behind, **state))
    )
    yield (
        "11", "μ_C changes stresses more at X/L = 0.8 than at 0.2 (8)",
        _grows(σ_YY) and _grows(σ_XX),
        f"σ_YY by {σ_YY[0]:.2f} and {σ_YY[1]:.2f} at 0.8; σ_XX at -{r.beside} by {σ_XX[0]:.2f} "
        f"and {σ_XX[1]:.2f}",
    )  # fmt: skip


def _stiffness(r: Results) -> _Decided:
    """Figs 9 and 10: stresses by the stiffness and the exponent of friction."""
    p_left, p_right, tension, ahead = r.lean("sigma0_over_load", 0.2)
    leans = _grows(p_right) and _falls(p_left)
    laws: list[dict[str, Any]] = [*r.over("sigma0_over_load", MILDER)]
    g = [r.data[states.RATIO.path][r.state(**law)] for law in laws]
    punch = FlatPunch(r.solid.response(SLOW), np.array(g))
    why = (
        ". It leans back, as 15 has it; its top, the least pressure, moves to X/a = "
        f"{_to(punch.α - punch.β)}. With Eq 25's sign it leans ahead, and tension is ahead, too"
    )
    yield (
        "12a", 'σ₀l/N grows: σ_YY slants "towards the leading end" (9a)',
        leans, f"-σ_YY at -{UNDER:g} a {_to(p_left)}, at {UNDER:g} a {_to(p_right)}" + why * (not leans),
    )  # fmt: skip
    yield (
        "12b", "the same: tension behind the punch and compression ahead grow (9b)",
        _grows(tension) and _falls(ahead) and min(tension) > 0.0 > max(ahead),
        f"σ_XX at -{r.beside} {_to(tension)}; ahead {_to(ahead)}",
    )  # fmt: skip

    at = [r.behind, r.ahead]
    f = [r.f(motion="FM2", **law) for law in laws]
    slow, fast = ([r.σ_XX(at, c=c, motion="FM2", **law) for law in laws] for c in (SLOW, FAST))
    follows = np.all(np.sign([*slow, *fast]) == np.outer(np.sign(2 * f), (1.0, -1.0)))
    of_speeds = f"σ_XX {'follows' if follows else 'does not follow'} at both speeds"
    yield (
        "13", "FM2, X/L = 0.2: friction points back at σ₀l/N = 12500, forward at larger ones; SS, HS "
              "(9c, d)",
        f[0] < 0.0 < min(f[1:]) and follows, f"f = {_to(f, '+.4f')}; {of_speeds}",
    )  # fmt: skip
    off = [_apart(*both) for both in zip(fast, slow)]
    yield (
        "14", "FM2: SS and HS differ more at larger σ₀l/N (9d)",
        _grows(off), f"σ_XX at ±{r.beside} by {_to(off)}",
    )  # fmt: skip

    p_left, p_right, tension, ahead = r.lean("delta", 0.4)
    slight = max(abs(values[-1] / values[0] - 1.0) for values in (p_left, p_right))
    less = _falls(p_left) and _grows(p_right) and _falls(tension) and _grows(ahead)
    why = ". With Eq 25's sign the ends change places, and this does not hold"
    yield (
        "15", "δ_D grows: σ_YY falls a little at the trailing end and grows at the leading one; tension "
              "behind and compression ahead fall (10)",
        less and slight < NEAR,
        f"-σ_YY at -{UNDER:g} a {_to(p_left)}, at {UNDER:g} a {_to(p_right)}; σ_XX at -{r.beside} "
        f"{_to(tension)}; ahead {_to(ahead)}" + why * less,
    )  # fmt: skip


def _damage(r: Results) -> _Decided:
    """Tables 4 and 5, and where the surface cracks."""
    method = FEM if states.K_I_LEFT[FEM].path in r.data else CLOSED_FORM
    left, right = (r.data[rows[method].path] for rows in (states.K_I_LEFT, states.K_I_RIGHT))
    off = float(np.abs(left / right - 1.0).max())
    changes = []
    for c in (SLOW, FAST):
        K_I = {m: [left[r.state(c=c, motion=m, X=X)] for X in (0.2, 0.8)] for m in ("FM1", "BM1", "FM2")}
        changes.append([
            100.0 * (late - early) / (late if motion == "BM1" else early)
            for motion, (early, late) in K_I.items()
        ])  # fmt: skip
    signs = all(first < 0.0 < second and third < 0.0 for first, second, third in changes)
    differences = "; ".join(f"{name} {_to(of, '+.2f')}" for name, of in zip(("SS", "HS"), changes))
    yield (
        "16", "K_I equal at both ends; FM1 and FM2 less at X/L = 0.8 than at 0.2, BM1 the reverse; Diff "
              "% larger in HS (Tables 4, 5)",
        off < 1e-6 and signs and _grows(np.abs(changes)),
        f"ends {off:.0e} apart; to 0.8 in FM1, BM1, FM2 by (%, of all digits) {differences}",
    )  # fmt: skip

    laws, places = r.over("mu_c", REFERENCE), (0.2, 0.4, 0.5, 0.8, 1.0)
    tension, ahead = (
        np.array([[r.σ_XX(at, X=X, c=FAST, **law) for X in places] for law in laws])
        for at in (r.behind, r.ahead)
    )
    most = np.unravel_index(int(tension.argmax()), tension.shape)
    yield (
        "17", "a surface crack is likeliest at the trailing end at large μ_C and X/L",
        _grows(tension) and most == (len(laws) - 1, len(places) - 1)
        and tension.min() > 0.0 > ahead.max(),
        f"HS, σ_XX at -{r.beside} {tension.min():.2f} to {tension.max():.2f}, this at μ_C = "
        f"{laws[most[0]]['mu_c']:g}, X/L = {places[most[1]]:g}; ahead at most {ahead.max():.2f}",
    )  # fmt: skip


def statements(data: dict[str, Any], solid: Solid) -> list[Statement]:
    """All statements in the order of the study's text, from an archive of scenes/study.toml.

    Args:
        data: the archive.
        solid: the scene's.

    Raises:
        LookupError: a state is missing.
    """
    results = Results(data, solid)
    return [
        Statement(number, claim, bool(holds), numbers)
        for topic in (_friction, _strokes, _level, _stiffness, _damage)
        for number, claim, holds, numbers in topic(results)
    ]


def statements_sheet(decided: list[Statement]) -> Sheet:
    """All statements as a table."""
    return Sheet(
        "Statements of the study (sections 5 and 6)",
        ("", "the study", "computed"),
        [(statement.number, statement.claim, statement.words) for statement in decided],
        (
            f"stresses over N/(2a), mean pressure 1; of σ_YY for |X| ≤ {UNDER:g} a. Near, close, "
            f"negligible: within {NEAR:.0%} (in 6 of the mean pressure); slight: below {SLIGHT:.0%} of "
            "what is notable.",
        ),
        words=True,
    )
