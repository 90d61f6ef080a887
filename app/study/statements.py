"""The study's statements on its results (its sections 5 and 6), each decided by numbers.

Friction is that of the archive's loops and states; stresses are those of finite elements, or of the
closed form where an archive has these alone. The numbers that stand for words such as "close" are defined
below.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import pairwise
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
    """States and loops of an archive of scenes/study.toml.

    Args:
        data: the archive.
        solid: the scene's.
    """

    def __init__(self, data: dict[str, Any], solid: Solid) -> None:
        method = FEM if stresses.IN_PLANE[FEM].path in data else CLOSED_FORM
        self.data, self.solid = data, solid
        self.X: NDArray[np.float64] = data[stresses.SURFACE_X.path]
        self._in_plane, self._pressure = (
            data[rows[method].path] for rows in (stresses.IN_PLANE, stresses.PRESSURE)
        )
        self._f = data[states.FRICTION.path]
        #: Where pressures are compared, and the places next to the punch's ends, -a and a.
        self.under = np.abs(self.X) <= UNDER
        self.behind, self.ahead = (int(np.abs(self.X - X).argmin()) for X in (-BESIDE, BESIDE))
        self.left, self.right = (int(np.abs(self.X - X).argmin()) for X in (-UNDER, UNDER))

    def state(self, c: float = SLOW, motion: str = "FM1", X: float = 0.2, **law: float) -> int:
        """Number of the state at a speed, on a stroke, at a place X/L, of the reference law or another.

        Raises:
            LookupError: the archive does not have it.
        """
        return state_of(self.data, c, motion, X, **law)

    def values(self, name: str, law: dict[str, float]) -> list[dict[str, float]]:
        """Laws in which one parameter takes all its values and the others are those of a law."""
        chosen = np.ones(len(self._f), dtype=bool)
        for key, value in law.items():
            if key != name:
                chosen = chosen & (self.data[column(key)] == value)
        return [law | {name: value} for value in np.unique(self.data[column(name)][chosen]).tolist()]

    def f(self, **state: Any) -> float:
        """Friction coefficient of a state."""
        return float(self._f[self.state(**state)])

    def σ_XX(self, at: int, **state: Any) -> float:
        """In-plane stress of a state over N/(2a), at one of the positions."""
        return float(self._in_plane[self.state(**state), at])

    def stresses(self, **state: Any) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """In-plane stress and contact stress of a state over N/(2a), at all positions, (n,) each."""
        row = self.state(**state)
        return self._in_plane[row], self._pressure[row]

    def apart(self, first: dict[str, Any], second: dict[str, Any]) -> float:
        """Largest difference of the contact stress of two states over N/(2a), where pressures are
        compared."""
        return float(np.abs(self.stresses(**first)[1] - self.stresses(**second)[1])[self.under].max())

    def loop(self, **law: float) -> NDArray[np.float64]:
        """f along FM1, BM1 and FM2 of a law, each in the order of travel, (3, steps)."""
        row = self.data[runs.LOOP_OF_STATE.path][state_of(self.data, SLOW, "FM1", 0.2, **law)]
        return self.data[runs.LOOP_F.path][row].reshape(3, -1)

    @property
    def places(self) -> NDArray[np.float64]:
        """X/L of the steps of a forward stroke."""
        return self.data[runs.LOOP_X.path].reshape(3, -1)[0]

    @property
    def beside(self) -> str:
        """Position beside the punch at which σ_XX is read, over a, as it is printed."""
        return f"{self.X[self.ahead]:.3g} a"


_Decided = Iterator[tuple[bool, str]]

#: Statements in the order of the study's text: claims by their number, and what decides them.
_STATEMENTS: list[tuple[dict[str, str], Callable[[Results], _Decided]]] = []


def _says(**claims: str) -> Callable[[Callable[[Results], _Decided]], Callable[[Results], _Decided]]:
    def add(decide: Callable[[Results], _Decided]) -> Callable[[Results], _Decided]:
        _STATEMENTS.append(({number[1:]: claim for number, claim in claims.items()}, decide))
        return decide

    return add


def statements(data: dict[str, Any], solid: Solid) -> list[Statement]:
    """All statements, from an archive of scenes/study.toml.

    Args:
        data: the archive.
        solid: the scene's.

    Raises:
        LookupError: a state is missing.
    """
    results = Results(data, solid)
    return [
        Statement(number, claim, bool(holds), numbers)
        for claims, decide in _STATEMENTS
        for (number, claim), (holds, numbers) in zip(claims.items(), decide(results), strict=True)
    ]


def statements_sheet(decided: list[Statement]) -> Sheet:
    """All statements as a table."""
    return Sheet(
        "Statements of the study (sections 5 and 6)",
        ("", "the study", "computed"),
        [(statement.number, statement.claim, statement.words) for statement in decided],
        (
            f"stresses over N/(2a), mean pressure 1; of σ_YY for |X| ≤ {UNDER:g} a. Near, close, "
            f"negligible: within {NEAR:.0%}; slight: below {SLIGHT:.0%} of what is notable.",
        ),
        words=True,
    )


def _to(values: Any, form: str = ".2f") -> str:
    """Numbers one after the other, as they are printed."""
    return ", ".join(f"{value:{form}}" for value in values)


def _grows(values: Any) -> bool:
    return bool(np.all(np.diff(values) > 0.0))


def _falls(values: Any) -> bool:
    return bool(np.all(np.diff(values) < 0.0))


@_says(_1="f does not depend on speed (Fig 6a)")
def _speed(r: Results) -> _Decided:
    c, f = (r.data[row.path] for row in (states.SPEED, states.FRICTION))
    slow, fast = f[c == SLOW], f[c == FAST]
    off = np.abs(slow - fast).max()
    yield off <= 1e-12, f"f of {len(slow)} pairs of states differs by {off:.1g}"


@_says(_2="μ_C = 0.1: nearly steady within 0.01 mm; larger μ_C need more (6b)")
def _near(r: Results) -> _Decided:
    laws = r.values("mu_c", REFERENCE)
    place = 1e-5 / published()["table1"]["L_m"]
    shares = [np.interp(place, r.places, r.loop(**law)[0]) / law["mu_c"] for law in laws]
    yield shares[0] >= 1.0 - NEAR and _falls(shares), f"f/μ_C = {_to(shares)} there with μ_C"


@_says(_3="f of FM1 and FM2: the difference grows with μ_C and falls with σ₀l/N (6b, c)")
def _first_and_second(r: Results) -> _Decided:
    by_level, by_stiffness = (
        [float((loop[0] - loop[2]).mean()) for loop in (r.loop(**law) for law in r.values(name, others))]
        for name, others in (("mu_c", REFERENCE), ("sigma0_over_load", MILDER))
    )
    yield (
        _grows(by_level) and _falls(by_stiffness),
        f"mean over a stroke {_to(by_level, '.3f')} with μ_C; {_to(by_stiffness, '.3f')} with σ₀l/N",
    )


@_says(_4="larger σ₀l/N: friction develops sooner (6c)")
def _sooner(r: Results) -> _Decided:
    loops = [r.loop(**law)[0] for law in r.values("sigma0_over_load", MILDER)]
    ahead = min(float((later - sooner)[1:].min()) for sooner, later in pairwise(loops))
    half = [np.interp(0.5 * MILDER["mu_c"], loop, r.places) for loop in loops]
    yield ahead > 0.0, f"μ_C/2 at X/L = {_to(half, '.3f')}; in FM1 f larger by {ahead:.1g} at least"


@_says(_5a="larger δ_D: f lower at all X, steady later (6d): FM1", _5b="the same: FM2")
def _exponent(r: Results) -> _Decided:
    loops = [r.loop(**law) for law in r.values("delta", MILDER)]
    first = [loop[0] for loop in loops]
    lower = max(float((more - less)[1:].max()) for less, more in pairwise(first))
    share = [loop[-1] / MILDER["mu_c"] for loop in first]
    yield lower < 0.0 and _falls(share), f"lower by {-lower:.1g} at least; f/μ_C at L {_to(share)}"
    second = [loop[2] for loop in loops]
    higher = np.any([more > less for less, more in pairwise(second)], axis=0)
    until = float(r.places[higher].max(initial=0.0))
    yield (
        not higher.any(),
        f"higher up to X/L = {until:.2g} (at 0 {_to([f[0] for f in second])})"
        if higher.any()
        else "lower at all X",
    )


@_says(
    _6a="σ_YY of FM1 and BM1 differ slightly at X/L = 0.2, notably at 0.5 and 1.0; FM2 nearly as FM1 at "
    "0.5, 1.0 (7). X/L on the axis, as in Tables 4, 5",
    _6b="the same, X/L travelled since the turn",
)
def _backwards(r: Results) -> _Decided:
    places = (0.2, 0.5, 1.0)
    nearly = [r.apart({"X": X}, {"X": X, "motion": "FM2"}) for X in places[1:]]
    on_axis = [r.apart({"X": X}, {"X": X, "motion": "BM1"}) for X in places]
    sign = r.data[states.RATIO.path][r.state()] / r.f()
    f = np.interp(places, r.places, r.loop()[1])
    travelled = []
    for X, of_turn in zip(places, f.tolist()):
        σ_YY = FlatPunch(r.solid.response(SLOW), sign * of_turn).σ_YY(r.X)
        travelled.append(float(np.abs(r.stresses(X=X)[1] - σ_YY)[r.under].max()))
    for differences, note in (
        (on_axis, "; X/L = 1 is the turn, f is FM1's"),
        (travelled, f"; FM2 by {_to(nearly)} at 0.5, 1.0"),
    ):
        slight = differences[0] < SLIGHT * min(differences[1:])
        yield slight and max(nearly) < NEAR, f"by {_to(differences)}{note}"


@_says(_7="σ_YY of SS and HS close in all cases (7 to 10)")
def _close(r: Results) -> _Decided:
    c = r.data[states.SPEED.path]
    σ = r._pressure[:, r.under]
    off = np.abs(σ[c == FAST] / σ[c == SLOW] - 1.0).max()
    yield off < NEAR, f"at most {off:.1%} apart in {np.sum(c == FAST)} pairs"


@_says(_8="tensile peak of σ_XX behind the motion: X = -a in FM1 and FM2, X = a in BM1 (5, 7)")
def _peak(r: Results) -> _Decided:
    every = [
        (motion, X, c)
        for motion in ("FM1", "BM1", "FM2")
        for X in (0.2, 0.5, 0.8, 1.0)
        for c in (SLOW, FAST)
        if (motion, X) != ("BM1", 1.0)  # the turn, where f is still FM1's
    ]
    right, tension = 0, []
    for motion, X, c in every:
        ends = r.behind, r.ahead
        trailing, leading = ends if motion[0] == "F" else ends[::-1]
        peak, other = (r.σ_XX(at, motion=motion, X=X, c=c) for at in (trailing, leading))
        right += peak > 0.0 > other
        tension.append(peak)
    low, high = min(tension), max(tension)
    yield (
        right == len(every),
        f"in {right} of {len(every)} states, {low:+.2f} to {high:+.2f} at {r.beside} (BM1's X/L = 1, the "
        f"turn, is left out: f = {r.f(motion='BM1', X=1.0):+.2f} there)",
    )


@_says(_9="σ_XX of FM2 at X/L = 0.2 smaller than FM1's, the difference negligible at 1.0 (7)")
def _second_forward(r: Results) -> _Decided:
    early, late = ([r.σ_XX(r.behind, X=X, motion=m) for m in ("FM1", "FM2")] for X in (0.2, 1.0))
    off = abs(late[1] / late[0] - 1.0)
    yield (
        abs(early[1]) < abs(early[0]) and off < NEAR,
        f"{early[1]:.2f}, FM1 {early[0]:.2f} at -{r.beside}; {off:.1%} apart at 1.0",
    )


@_says(
    _10="HS: σ_XX more compressive under the punch, larger outside; the difference to SS grows with X/L "
    "and μ_C (7, 8)"
)
def _fast(r: Results) -> _Decided:
    def more(at: int, **state: Any) -> float:
        return r.σ_XX(at, c=FAST, **state) - r.σ_XX(at, **state)

    by_place = [more(r.behind, X=X) for X in (0.2, 0.5, 0.8, 1.0)]
    by_level = [more(r.behind, X=0.8, **law) for law in r.values("mu_c", REFERENCE)]
    under = under_punch(r.X)
    compressive = max(
        float((r.stresses(c=FAST, X=X, **law)[0] - r.stresses(X=X, **law)[0])[under].max())
        for law in r.values("mu_c", REFERENCE)
        for X in (0.2, 0.5, 0.8, 1.0)
    )
    yield (
        compressive < 0.0 and min(by_place + by_level) > 0.0 and _grows(by_place) and _grows(by_level),
        f"HS - SS at -{r.beside} {_to(by_place)} with X/L, {_to(by_level)} with μ_C; under the punch "
        f"at most {compressive:.2f}",
    )


@_says(_11="μ_C changes stresses more at X/L = 0.8 than at 0.2 (8)")
def _level(r: Results) -> _Decided:
    spread = []
    for X in (0.2, 0.8):
        laws = r.values("mu_c", REFERENCE)
        σ_YY = [r.stresses(X=X, **law)[1][r.under] for law in laws]
        σ_XX = [r.σ_XX(r.behind, X=X, **law) for law in laws]
        spread.append((float(np.ptp(σ_YY, axis=0).max()), float(np.ptp(σ_XX))))
    (σ_YY_early, σ_XX_early), (σ_YY_late, σ_XX_late) = spread
    yield (
        σ_YY_late > σ_YY_early and σ_XX_late > σ_XX_early,
        f"σ_YY by {σ_YY_early:.2f} and {σ_YY_late:.2f} at 0.8; σ_XX at -{r.beside} by {σ_XX_early:.2f} "
        f"and {σ_XX_late:.2f}",
    )


def _lean(r: Results, name: str, X: float) -> tuple[list[float], list[float], list[float], list[float]]:
    """|σ_YY| at -0.9 a and 0.9 a, tension behind and compression ahead, with a parameter, at SS."""
    laws = r.values(name, MILDER)
    pressures = [[abs(float(r.stresses(X=X, **law)[1][at])) for law in laws] for at in (r.left, r.right)]
    tension = [r.σ_XX(r.behind, X=X, **law) for law in laws]
    return *pressures, tension, [-r.σ_XX(r.ahead, X=X, **law) for law in laws]  # type: ignore[return-value]


@_says(
    _12a='σ₀l/N grows: σ_YY slants "towards the leading end" (9a)',
    _12b="the same: tension behind the punch and compression ahead grow (9b)",
)
def _stiffness(r: Results) -> _Decided:
    p_left, p_right, tension, compression = _lean(r, "sigma0_over_load", 0.2)
    leans = _grows(p_right) and _falls(p_left)
    why = ". It leans back, as 15 has it; with Eq 25's sign it leans ahead, and tension is ahead, too"
    yield (
        leans,
        f"-σ_YY at -{UNDER:g} a {_to(p_left)}, at {UNDER:g} a {_to(p_right)}" + why * (not leans),
    )
    yield (
        _grows(tension) and _grows(compression) and min(tension + compression) > 0.0,
        f"σ_XX at -{r.beside} {_to(tension)}; ahead {_to([-value for value in compression])}",
    )


@_says(
    _13="FM2, X/L = 0.2: friction points back at σ₀l/N = 12500, forward at larger ones; SS, HS (9c, d)"
)
def _turned(r: Results) -> _Decided:
    laws, at = r.values("sigma0_over_load", MILDER), {"motion": "FM2", "X": 0.2}
    f = [r.f(**at, **law) for law in laws]
    ends = [
        (r.σ_XX(r.behind, c=c, **at, **law), r.σ_XX(r.ahead, c=c, **at, **law))
        for c in (SLOW, FAST)
        for law in laws
    ]
    follows = all(np.sign(behind) == np.sign(of) == -np.sign(ahead)
                  for (behind, ahead), of in zip(ends, 2 * f))  # fmt: skip
    yield f[0] < 0.0 < min(f[1:]) and follows, f"f = {_to(f, '+.4f')}; σ_XX follows at both speeds"


@_says(_14="FM2: SS and HS differ more at larger σ₀l/N (9d)")
def _second_fast(r: Results) -> _Decided:
    off = []
    for law in r.values("sigma0_over_load", MILDER):
        fast, slow = (r.stresses(c=c, motion="FM2", **law)[0] for c in (FAST, SLOW))
        off.append(float(np.abs(fast - slow)[[r.behind, r.ahead]].max()))
    yield _grows(off), f"σ_XX at ±{r.beside} by {_to(off)}"


@_says(
    _15="δ_D grows: σ_YY falls a little at the trailing end and grows at the leading one; tension behind "
    "and compression ahead fall (10)"
)
def _less(r: Results) -> _Decided:
    p_left, p_right, tension, compression = _lean(r, "delta", 0.4)
    slight = max(abs(values[-1] / values[0] - 1.0) for values in (p_left, p_right))
    less = _falls(p_left) and _grows(p_right) and _falls(tension) and _falls(compression)
    why = ". With Eq 25's sign the ends change places, and it does not"
    yield (
        less and slight < NEAR,
        f"-σ_YY at -{UNDER:g} a {_to(p_left)}, at {UNDER:g} a {_to(p_right)}; σ_XX at -{r.beside} "
        f"{_to(tension)}; ahead {_to([-value for value in compression])}" + why * less,
    )


@_says(
    _16="K_I equal at both ends; FM1 and FM2 less at X/L = 0.8 than at 0.2, BM1 the reverse; Diff % "
    "larger in HS (Tables 4, 5)"
)
def _intensities(r: Results) -> _Decided:
    ends = [
        r.data[(rows[FEM] if rows[FEM].path in r.data else rows[CLOSED_FORM]).path]
        for rows in (states.K_I_LEFT, states.K_I_RIGHT)
    ]
    off = float(np.abs(ends[0] / ends[1] - 1.0).max())
    difference = {}
    for c in (SLOW, FAST):
        for motion in ("FM1", "BM1", "FM2"):
            early, late = (ends[0][r.state(c=c, motion=motion, X=X)] for X in (0.2, 0.8))
            difference[c, motion] = 100.0 * (late - early) / (late if motion == "BM1" else early)
    slow, fast = ([difference[c, motion] for motion in ("FM1", "BM1", "FM2")] for c in (SLOW, FAST))
    signs = all(first < 0.0 < second and third < 0.0 for first, second, third in (slow, fast))
    larger = all(abs(high) > abs(low) for low, high in zip(slow, fast))
    differences = "; ".join(
        f"{name} " + ", ".join(f"{value:+.2f}" for value in values)
        for name, values in (("SS", slow), ("HS", fast))
    )
    yield (
        off < 1e-6 and signs and larger,
        f"ends {off:.0e} apart; to 0.8 in FM1, BM1, FM2 by (%) {differences}",
    )


@_says(_17="a surface crack is likeliest at the trailing end at large μ_C and X/L")
def _crack(r: Results) -> _Decided:
    laws, places = r.values("mu_c", REFERENCE), (0.2, 0.4, 0.5, 0.8, 1.0)
    tension = np.array([[r.σ_XX(r.behind, X=X, c=FAST, **law) for X in places] for law in laws])
    ahead = max(r.σ_XX(r.ahead, X=X, c=FAST, **law) for X in places for law in laws)
    most = np.unravel_index(int(tension.argmax()), tension.shape)
    yield (
        bool(np.all(np.diff(tension, axis=0) > 0.0))
        and most == (len(laws) - 1, len(places) - 1)
        and tension.min() > 0.0
        and ahead < 0.0,
        f"HS, σ_XX at -{r.beside} {tension.min():.2f} to {tension.max():.2f}, this at μ_C = "
        f"{laws[most[0]]['mu_c']:g}, X/L = {places[most[1]]:g}; ahead at most {ahead:.2f}",
    )
