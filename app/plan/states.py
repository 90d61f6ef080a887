"""The states a scene asks for: every combination of its lists, in the order they are archived.

Which state is which: the product of speeds, loads, laws and places, in the order of archives.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import isfinite, nan
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.quantities import column, runs
from galinx.postprocess.quantities.states import INNER_STATE
from galinx.postprocess.quantities.validity import SIGNS
from galinx.solvers.friction import FrictionLaw
from galinx.solvers.friction.integrate import INTEGRATORS, Integrator, closely
from galinx.solvers.friction.motion import Stroke, Work, follow, last_cycle, works
from galinx.solvers.solids.solid import Solid

from ..errors import BadInput, listed
from ..scene.scene import Scene, oddities
from . import cost


@dataclass(frozen=True)
class Order:
    """States by speed, load, law and place on the strokes, the last fastest.

    Attributes:
        given: speeds over c_s that strokes have which have none of their own.
        loads: [N/m].
        laws: their number.
        own: speeds over c_s of the states along all strokes, NaN where that is the given one, (places,).
    """

    given: tuple[float, ...]
    loads: tuple[float, ...]
    laws: int
    own: NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.given) * self.states

    @property
    def states(self) -> int:
        """At each given speed."""
        return len(self.loads) * self.laws * len(self.own)

    @property
    def shape(self) -> tuple[int, int, int, int]:
        """Numbers of speeds, loads, laws and places."""
        return len(self.given), len(self.loads), self.laws, len(self.own)

    @property
    def c(self) -> NDArray[np.float64]:
        """Speed of every state over c_s, (states,)."""
        speeds = np.where(np.isnan(self.own), np.array(self.given)[:, None], self.own)
        return np.repeat(speeds, self.shape[1] * self.laws, axis=0).ravel()

    @cached_property
    def speeds(self) -> tuple[float, ...]:
        """All speeds over c_s, each once, as states meet them first."""
        if self._given_alone:
            return self.given
        met = np.where(np.isnan(self.own), np.array(self.given)[:, None], self.own)
        return tuple(dict.fromkeys(met.ravel().tolist()))

    @property
    def _given_alone(self) -> bool:
        return bool(np.isnan(self.own).all())

    def runs(self) -> Iterator[tuple[slice, ...]]:
        """Numbers of the states of every speed, as runs of states that follow one another."""
        if self._given_alone:
            for i in range(len(self.given)):
                yield (slice(i * self.states, (i + 1) * self.states),)
            return
        # A state's speed is the same under every load and law: few places tell all.
        c = self.c
        first = np.flatnonzero(np.diff(c, prepend=np.nan))
        by_speed: dict[float, list[slice]] = {}
        for start, stop in zip(first.tolist(), [*first[1:].tolist(), len(c)]):
            by_speed.setdefault(float(c[start]), []).append(slice(start, stop))
        for speed in self.speeds:
            yield tuple(by_speed[speed])

    def load(self, rows: slice) -> NDArray[np.float64]:
        """Load of some states [N/m]."""
        per_load = self.laws * len(self.own)
        return np.array(self.loads)[np.arange(rows.start, rows.stop) // per_load % len(self.loads)]


#: Positions on a stroke at which loops are archived, and the most loops that are.
FINE, LOOPS = np.linspace(0.0, 1.0, 101), 1000
#: The most of laws that have to be integrated, which takes some tenths of a second a loop.
INTEGRATED_LOOPS = 100
#: Laws that are followed together, and from word to word of how many are done.
_TOGETHER = 500


@dataclass(frozen=True)
class States:
    """Friction states, and the loops that they lie on.

    Attributes:
        columns: one entry a state in every array, by name as archived: motion, X_over_L, c (over the wave
            speed), the load in N/m where there are several, the law's parameters, the speed and that of
            a wave along the surface in m/s, flutter thresholds of both signs of g, how often a wave
            crosses the contact in a stroke, f = F/N signed, and g = σ_XY/σ_YY under the punch.
        inner: inner state of the law at each state, (states, n).
        directions: of the strokes, 1 forward, -1 backward, (states,).
        loop: row of ``loops`` of each state, -1 for none, (states,).
        travel: positions X/L along all strokes in the order of travel, (steps,).
        loops: friction coefficient there, (loops, steps).
        works: what strokes take, as archived, by path, (loops, strokes) and (loops,).
    """

    columns: dict[str, NDArray]
    inner: NDArray[np.float64]
    directions: NDArray[np.int64]
    loop: NDArray[np.int64]
    travel: NDArray[np.float64]
    loops: NDArray[np.float64]
    works: dict[str, NDArray[np.float64]]

    def __len__(self) -> int:
        return len(self.g)

    @property
    def g(self) -> NDArray[np.float64]:
        """σ_XY/σ_YY under the punch, (states,)."""
        return self.columns["g"]

    @property
    def datasets(self) -> dict[str, NDArray]:
        """All as archived, by path."""
        return {column(name): values for name, values in self.columns.items()} | {
            INNER_STATE.path: self.inner,
            runs.LOOP_OF_STATE.path: self.loop,
            runs.LOOP_X.path: self.travel,
            runs.LOOP_F.path: self.loops,
            **self.works,
        }


def speeds(scene: Scene) -> tuple[float, ...]:
    """Speeds over the wave speed.

    Raises:
        BadInput: a speed given in m/s is not subsonic.
    """
    if scene.motion.path is not None:
        return (0.0,)  # each stroke has its own
    if scene.motion.c is not None:
        return tuple(dict.fromkeys(scene.motion.c))
    c_s = scene.solid.c_s
    if fast := [f"{speed:g}" for speed in scene.motion.speed or () if speed >= c_s]:
        limit = f"the shear wave speed {c_s:.6g} m/s"
        if "fem" in scene.solve.methods:  # the one that is met first
            limit = (
                f"the Rayleigh speed {scene.solid.limit() * c_s:.6g} m/s (by closed_form alone, {limit})"
            )
        raise BadInput(
            f"motion.speed = {listed(fast)} m/s: expected less than {limit}"
            + "".join(f"; {text}" for text in oddities(scene))
        )
    return tuple(dict.fromkeys(speed / c_s for speed in scene.motion.speed or ()))


def order(scene: Scene) -> Order:
    """Which state is which.

    Raises:
        BadInput: a speed given in m/s is not subsonic.
    """
    own = [np.nan if leg.speed is None else leg.speed / scene.solid.c_s for leg in scene.legs]
    each = list(map(len, scene.places))
    return Order(speeds(scene), scene.punch.loads, scene.friction.count, np.repeat(own, each))


def laws_followed(scene: Scene) -> int:
    """Number of laws that are followed: once, or once a speed where they depend on that."""
    return scene.friction.count * (len(speeds(scene)) if scene.friction.law.depends_on_speed else 1)


def seconds_to_integrate(scene: Scene) -> float:
    """Time that laws without a formula take, 0 for others.

    Raises:
        BadInput: the law refuses its parameters.
    """
    try:
        if _has_formula(next(scene.friction.laws())):
            return 0.0
    except ValueError as error:
        raise BadInput(f"friction: {error}") from None
    laws = laws_followed(scene)
    return cost.seconds_to_integrate(laws * len(scene.legs), min(laws, INTEGRATED_LOOPS))


def _has_formula(law: FrictionLaw) -> bool:
    return law.exact(law.rest(), 1, 1.0, np.zeros(1)) is not None


def enumerate_states(scene: Scene, done: Callable[[int, int], None] = lambda laws, of: None) -> States:
    """Friction of every state; what is held at once is that and nothing else.

    Args:
        scene: the scene.
        done: is told now and then how many laws are followed, and of how many.

    Raises:
        BadInput: the integrator refuses the parameters.
    """
    friction, known, count = scene.friction, order(scene), laws_followed(scene)
    f, found, at = np.empty((count, len(known.own))), _Found(), 0
    inner: NDArray | None = None
    advance = INTEGRATORS[friction.integrator]
    try:
        for c, law, laws in _laws(scene):
            strokes = _strokes(scene, law, c, scene.places, laws is not None, advance)
            n = laws or 1
            f[at : at + n] = _joined([stroke.f for stroke in strokes])
            z = _joined([stroke.z for stroke in strokes], -2)
            if inner is None:
                inner = np.empty((*f.shape, z.shape[-1]))
            inner[at : at + n] = z
            most = LOOPS if laws or _has_formula(law) else INTEGRATED_LOOPS
            if at < most:
                found.add(*_loops(scene, law, c, laws), n, min(n, most - at))
            at += n
            if at % _TOGETHER == 0:
                done(at, count)
    except ValueError as error:
        raise BadInput(f"friction: {error}") from None
    assert inner is not None
    loop = np.arange(count)
    loop[len(found.f) :] = -1
    columns = _columns(scene, known, _of_all(known, f))
    travel = _joined([leg.start + (leg.end - leg.start) * FINE for leg in scene.legs])
    along = np.repeat([leg.s for leg in scene.legs], [len(X) for X in scene.places])
    return States(
        columns, _of_all(known, inner), _of_all(known, np.tile(along, (count, 1))),
        _of_all(known, np.tile(loop[:, None], f.shape[1])), travel, np.array(found.f),
        found.archived(scene),
    )  # fmt: skip


def _of_all(known: Order, values: NDArray) -> NDArray:
    """Values of all states, (states, …): under every load alike, at every speed where laws know none.

    Args:
        known: which state is which.
        values: of the laws that are followed, (laws and speeds, places, …).
    """
    *several, laws, places = known.shape
    rest = values.shape[2:]
    by_speed = values.reshape(-1, 1, laws, places, *rest)
    return np.broadcast_to(by_speed, (*several, laws, places, *rest)).reshape(-1, *rest)


def _columns(scene: Scene, known: Order, f: NDArray) -> dict[str, NDArray]:
    """One entry a state in every array; ``f`` is (states,)."""
    friction, (all_speeds, loads, laws, per_law) = scene.friction, known.shape
    each, followed, c = [len(X) for X in scene.places], all_speeds * loads * laws, known.c
    values = {
        key: np.tile(np.repeat(one, per_law), all_speeds * loads)
        for key, one in friction.columns().items()
    }
    of_load = np.tile(np.repeat(known.loads, laws * per_law), all_speeds)
    given = np.repeat(np.multiply(known.given, scene.solid.c_s), known.states)
    own = [np.nan if leg.speed is None else leg.speed for leg in scene.legs]
    speed = np.tile(np.repeat(own, each), followed)
    lengths = np.tile(np.repeat([leg.length for leg in scene.legs], each), followed)
    return {
        "motion": np.tile(np.repeat([leg.name for leg in scene.legs], each), followed),
        "X_over_L": np.tile(_joined(list(scene.places)), followed),
        "c": c,
        **({"load": of_load} if loads > 1 else {}),
        **values,
        "speed": np.where(np.isnan(speed), given, speed),
        **{f"flutter_{sign}": np.full(f.size, g) for sign, g in zip(SIGNS, _flutter(scene.solid))},
        "speed_limit": np.full(f.size, scene.solid.limit() * scene.solid.c_s),
        "wave_crossings": _crossings(scene, lengths, _half_widths(scene, known), c),
        "f": f,
        "g": friction.stress_ratio * f + 0.0,
    }


def _flutter(solid: Solid) -> list[float]:
    """Thresholds of both signs of σ_XY/σ_YY; NaN for none, and of a user's own solid that tells none."""
    return [g if isfinite(g) else nan for g in getattr(solid, "flutter", (nan, nan))]


def _half_widths(scene: Scene, known: Order) -> Any:
    """Of a contact at rest without friction under the load of each state [m], or of all."""
    if len(known.loads) == 1 or not scene.body.found:
        return scene.body.half_width
    of_loads = scene.body.loaded(np.array(known.loads)).half_width
    return np.tile(np.repeat(of_loads, known.laws * len(known.own)), len(known.given))


def _crossings(scene: Scene, lengths: NDArray, a: Any, c: NDArray) -> NDArray[np.float64]:
    """How often a wave of the speed c_s crosses the contact in a stroke: L/(2 a c), NaN at rest."""
    with np.errstate(divide="ignore", invalid="ignore"):
        often = lengths * scene.friction.pre_sliding / (2.0 * a * c)
    return np.where(c > 0.0, often, np.nan)


def _laws(scene: Scene) -> Iterator[tuple[float, FrictionLaw, int | None]]:
    """What is followed at a speed: a law, or one that stands for so many."""
    friction = scene.friction
    followed = speeds(scene) if friction.law.depends_on_speed else speeds(scene)[:1]
    together = friction.law.broadcasts and friction.integrator == "exact"
    columns = friction.columns() if together else {}
    for c in followed:
        if together:
            for first in range(0, friction.count, _TOGETHER):
                some = slice(first, min(first + _TOGETHER, friction.count))
                yield c, friction.together(columns, some), some.stop - some.start
        else:
            for law in friction.laws():
                yield c, law, None


def _strokes(
    scene: Scene, law: FrictionLaw, c: float, places: Sequence[NDArray], many: bool, advance: Integrator
) -> list[Stroke]:
    V = c * scene.solid.c_s
    return follow(law, scene.legs, scene.friction.pre_sliding, places, V, advance, many)


def _loops(scene: Scene, law: FrictionLaw, c: float, laws: int | None) -> tuple[list[Stroke], list[Work]]:
    """Friction along every stroke, and what these take."""
    friction, V = scene.friction, c * scene.solid.c_s
    fine = [leg.start + (leg.end - leg.start) * FINE for leg in scene.legs]
    advance = closely if friction.integrator == "exact" else INTEGRATORS[friction.integrator]
    drawn = _strokes(scene, law, c, fine, laws is not None, advance)
    taken = works(law, scene.legs, friction.pre_sliding, V, advance, laws is not None)
    return drawn, taken


class _Found:
    """Loops, and what their strokes take, as they are found.

    Attributes:
        f: friction coefficient along each loop.
        taken: by name of :class:`Work`, a row of strokes a loop.
    """

    def __init__(self) -> None:
        self.f: list[NDArray] = []
        self.taken: dict[str, list[NDArray]] = {"dissipated": [], "breakaway": [], "slope": []}

    def add(self, drawn: list[Stroke], taken: list[Work], laws: int, wanted: int) -> None:
        """The loops of so many laws, of which some are wanted."""
        f = _joined([np.broadcast_to(stroke.f, (laws, len(FINE))) for stroke in drawn])
        self.f += list(f[:wanted])
        for name, rows in self.taken.items():
            columns = [np.broadcast_to(getattr(stroke, name), (laws,)) for stroke in taken]
            rows += list(np.stack(columns, axis=-1)[:wanted])

    def archived(self, scene: Scene) -> dict[str, NDArray]:
        """What strokes take, by path, times the load."""
        N = scene.punch.load
        with np.errstate(over="ignore"):  # friction of 1e308 is somebody's
            dissipated, breakaway, slope = (N * np.array(rows) for rows in self.taken.values())
        first = last_cycle(scene.legs)
        cycle = np.full(len(dissipated), np.nan) if first is None else dissipated[:, first:].sum(axis=1)
        return {
            runs.LOOP_WORK.path: dissipated, runs.LOOP_CYCLE.path: cycle,
            runs.LOOP_BREAKAWAY.path: breakaway, runs.LOOP_STIFFNESS.path: slope,
        }  # fmt: skip


def _joined(parts: list[NDArray], axis: int = -1) -> NDArray:
    return np.concatenate(parts, axis=axis)
