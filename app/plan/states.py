"""The states of a scene: every combination of its lists, in the order of archives, and their friction.

An :class:`Order` is the product of speeds, loads, laws and places on the strokes. :class:`States` hold
the friction of every state, which :func:`enumerate_states` computes along the strokes.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import nan, prod

import numpy as np
from numpy.typing import ArrayLike, NDArray

from galinx.postprocess.quantities import column, runs
from galinx.postprocess.quantities.states import INNER_STATE
from galinx.postprocess.quantities.validity import SIGNS
from galinx.solvers.contact.solution import GIVEN_ENDS
from galinx.solvers.friction import FrictionLaw
from galinx.solvers.friction.integrate import INTEGRATORS, closely
from galinx.solvers.friction.motion import follow, last_cycle, works
from galinx.solvers.solids.solid import Solid

from ..errors import BadInput, listed
from ..scene.scene import Scene, oddities
from ..scene.sections import ADVECTED, Friction


@dataclass(frozen=True)
class Order:
    """States by speed, load, law and place on the strokes, the last fastest.

    Attributes:
        given: the scene's speeds over c_s, for strokes without a speed of their own.
        loads: [N/m].
        laws: number of laws.
        own: speeds over c_s of the states along all strokes, NaN for the scene's speeds, (places,).
    """

    given: tuple[float, ...]
    loads: tuple[float, ...]
    laws: int
    own: NDArray[np.float64]

    def __len__(self) -> int:
        return prod(self.shape)

    @property
    def shape(self) -> tuple[int, int, int, int]:
        """Numbers of speeds, loads, laws and places."""
        return len(self.given), len(self.loads), self.laws, len(self.own)

    @cached_property
    def numbers(self) -> NDArray[np.int64]:
        """Numbers of speed, load, law and place of every state, (4, states)."""
        return np.indices(self.shape).reshape(4, -1)

    @cached_property
    def _met(self) -> NDArray[np.float64]:
        """Speeds over c_s, (speeds, places)."""
        return np.where(np.isnan(self.own), np.array(self.given)[:, None], self.own)

    @property
    def c(self) -> NDArray[np.float64]:
        """Speed of every state over c_s, (states,)."""
        speed, _, _, place = self.numbers
        return self._met[speed, place]

    @cached_property
    def speeds(self) -> tuple[float, ...]:
        """All speeds over c_s, each once, in the order of the first state with it."""
        return tuple(dict.fromkeys(self._met.ravel().tolist()))

    def runs(self, row: int = 0) -> Iterator[tuple[slice, ...]]:
        """Rows of the states of every speed, as runs of consecutive ones; ``row`` is the first of all."""
        # A state's speed is the same under every load and law: it changes at few rows.
        c = self.c
        first = np.flatnonzero(np.diff(c, prepend=np.nan))
        by_speed: dict[float, list[slice]] = {}
        for start, stop in zip((row + first).tolist(), [*(row + first[1:]).tolist(), row + len(c)]):
            by_speed.setdefault(float(c[start - row]), []).append(slice(start, stop))
        yield from map(tuple, by_speed.values())


#: Positions on a stroke at which loops are archived, and most loops that are archived.
FINE, LOOPS = np.linspace(0.0, 1.0, 101), 1000
#: Most loops of laws that are integrated, which takes some tenths of a second a loop.
INTEGRATED_LOOPS = 100
#: Number of laws that are computed together, and from one report of progress to the next.
_TOGETHER = 500


@dataclass(frozen=True)
class States:
    """Friction states, and the loops that they lie on.

    Attributes:
        columns: one entry a state in every array, by name as archived: motion, X_over_L, c (over the wave
            speed), the load in N/m where there are several, the law's parameters, the speed and that of
            a wave along the surface in m/s, flutter thresholds of both signs of g, where ends are given
            how often a wave crosses the contact in a stroke, f = F/N signed, and g = σ_XY/σ_YY under
            the punch.
        others: further datasets by path: inner state of the law at each state, (states, n); row of each
            state among the loops, -1 for none, (states,); positions X/L along all strokes in the order of
            travel, (steps,), and friction there, (loops, steps); work and stiffness of strokes, (loops,
            strokes) and (loops,).
        crossed: half the way of a wave of the speed c_s during each state's stroke, L/(2c) [m], NaN at
            rest, and without strokes, (states,).
    """

    columns: dict[str, NDArray]
    others: dict[str, NDArray]
    crossed: NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.g)

    @property
    def g(self) -> NDArray[np.float64]:
        """σ_XY/σ_YY under the punch, (states,)."""
        return self.columns["g"]

    @property
    def load(self) -> NDArray[np.float64] | None:
        """Load of every state [N/m], (states,); None where all have one load."""
        return self.columns.get("load")

    @property
    def directions(self) -> NDArray[np.int64]:
        """Directions of the strokes, 1 forward, -1 backward, (states,)."""
        return np.where(np.char.startswith(self.columns["motion"], "F"), 1, -1)

    @property
    def datasets(self) -> dict[str, NDArray]:
        """All arrays as archived, by path."""
        return {column(name): values for name, values in self.columns.items()} | self.others


def speeds(scene: Scene) -> tuple[float, ...]:
    """The scene's speeds over c_s.

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
        if "fem" in scene.solve.methods:  # the lower limit
            alone = f" (by closed_form alone, {limit})" * (not scene.between_free_ends)
            limit = f"the Rayleigh speed {scene.solid.limit() * c_s:.6g} m/s{alone}"
        fault = f"motion.speed = {listed(fast)} m/s: expected less than {limit}"
        raise BadInput("\n  ".join([fault, *oddities(scene)]))  # what is unusual may be the cause
    return tuple(dict.fromkeys(speed / c_s for speed in scene.motion.speed or ()))


def order(scene: Scene) -> Order:
    """Order of the states of a scene.

    Raises:
        BadInput: a speed given in m/s is not subsonic.
    """
    own = [np.nan if leg.speed is None else leg.speed / scene.solid.c_s for leg in scene.legs]
    each = list(map(len, scene.places))
    return Order(speeds(scene), scene.punch.loads, scene.friction.count, np.repeat(own, each))


def enumerate_states(scene: Scene, done: Callable[[int, int], None] = lambda laws, of: None) -> States:
    """Friction of every state.

    Args:
        scene: the scene.
        done: called now and then with the number of laws that are computed, and with that of all laws.

    Raises:
        BadInput: the integrator refuses the parameters.
    """
    friction, order_, legs = scene.friction, order(scene), scene.legs
    of_laws = speeds(scene) if friction.law.depends_on_speed else speeds(scene)[:1]
    count = friction.count * len(of_laws)  # each law once, or at each speed if it depends on that
    fine = [leg.start + (leg.end - leg.start) * FINE for leg in legs]
    advance = INTEGRATORS[friction.integrator]
    advance_finely = closely if friction.integrator == "exact" else advance
    f, at = np.empty((count, len(order_.own))), 0
    z, loops, taken = list[NDArray](), list[NDArray](), list[NDArray]()
    try:
        for c, law, n, many in _laws(friction, of_laws):
            V, L = c * scene.solid.c_s, friction.pre_sliding
            strokes = follow(law, legs, L, scene.places, V, advance, many)
            f[at : at + n] = np.concatenate([stroke.f for stroke in strokes], axis=-1)
            inner = np.concatenate([stroke.z for stroke in strokes], axis=-2)
            z.append(np.broadcast_to(inner, (n, *inner.shape[-2:])))
            formula = many or law.exact(law.rest(), 1, 1.0, np.zeros(1)) is not None
            most = LOOPS if formula else INTEGRATED_LOOPS
            if at < most:
                on_loops = follow(law, legs, L, fine, V, advance_finely, many)
                drawn = np.concatenate([stroke.f for stroke in on_loops], axis=-1)
                loops.append(np.broadcast_to(drawn, (n, drawn.shape[-1]))[: most - at])
                done_on = works(law, legs, L, V, advance_finely, many)
                taken.append(np.broadcast_to(done_on, (3, n, len(legs)))[:, : most - at])
            at += n
            if at % _TOGETHER == 0:
                done(at, count)
    except ValueError as error:
        raise BadInput(f"friction: {error}") from None
    if friction.state == ADVECTED:
        f[:] = friction.stress_ratio * np.array(list(scene.along))[:, None]
    drawn_loops = np.concatenate(loops)
    loop = np.arange(count)
    loop[len(drawn_loops) :] = -1
    with np.errstate(over="ignore"):  # a friction of 1e308 is allowed
        work, breakaway, slope = scene.punch.load * np.concatenate(taken, axis=1)
    first = last_cycle(legs)
    cycle = np.full(len(work), np.nan) if first is None else work[:, first:].sum(axis=1)
    # Bristles that enter the contact have those of their places.
    advected = friction.state == ADVECTED
    inner_state = {} if advected else {INNER_STATE.path: _of_all(order_, np.concatenate(z))}
    crossed = _crossed(scene, order_)
    return States(_columns(scene, order_, _of_all(order_, f), crossed), {
        **inner_state,
        runs.LOOP_OF_STATE.path: _of_all(order_, np.tile(loop[:, None], f.shape[1])),
        runs.LOOP_X.path: np.concatenate(fine), runs.LOOP_F.path: drawn_loops,
        runs.LOOP_WORK.path: work, runs.LOOP_CYCLE.path: cycle,
        runs.LOOP_BREAKAWAY.path: breakaway, runs.LOOP_STIFFNESS.path: slope,
    }, crossed)  # fmt: skip


def headings(scene: Scene, directions: ArrayLike, c: ArrayLike = np.inf) -> NDArray[np.int64]:
    """Directions ±1 of strokes along X.

    By the study's Eq 25 friction under a forward stroke is that of a punch that moves towards -X. Where
    the punch's own solid is faster than the plate, the punch moves to X, and slip is to -X.

    Args:
        scene: gives the sign of friction.
        directions: of the strokes, 1 forward, -1 backward.
        c: speeds over c_s.
    """
    turned = (scene.friction.stress_ratio > 0.0) & ~overtaken(scene, c)
    return np.asarray(directions, dtype=np.int64) * np.where(turned, -1, 1)


def overtaken(scene: Scene, c: ArrayLike) -> NDArray[np.bool_]:
    """True at speeds over c_s of a plate that is slower than the punch's own solid."""
    own = scene.elastic_punch.speed if scene.elastic_punch else 0.0
    return np.asarray(own > np.asarray(c) * scene.solid.c_s * (1.0 + 1e-12))


def _of_all(order: Order, values: NDArray) -> NDArray:
    """Values of all states, (states, …), the same under every load, and at every speed if laws have none.

    Args:
        order: of the states.
        values: of the laws that are computed, (laws and speeds, places, …).
    """
    *several, laws, places = order.shape
    rest = values.shape[2:]
    by_speed = values.reshape(-1, 1, laws, places, *rest)
    return np.broadcast_to(by_speed, (*several, laws, places, *rest)).reshape(-1, *rest)


def _crossed(scene: Scene, order: Order) -> NDArray[np.float64]:
    """Ways of waves as of :attr:`States.crossed`, (states,)."""
    lengths = np.repeat([leg.length for leg in scene.legs], [len(X) for X in scene.places])
    c, L = order.c, lengths[order.numbers[3]] * scene.friction.pre_sliding
    return np.where((c > 0.0) & (not scene.steady), L / (2.0 * np.where(c > 0.0, c, 1.0)), np.nan)


def _columns(scene: Scene, order: Order, f: NDArray, crossed: NDArray) -> dict[str, NDArray]:
    """Columns of all states by name as archived, each (states,); ``f`` and ``crossed`` are, too."""
    friction, (speed, load, law, place), c = scene.friction, order.numbers, order.c
    legs = np.repeat(np.arange(len(scene.legs)), [len(X) for X in scene.places])[place]
    own = np.array([np.nan if leg.speed is None else leg.speed for leg in scene.legs])[legs]
    V = {speed / scene.solid.c_s: speed for speed in scene.motion.speed or ()}  # c·c_s would be rounded
    given = np.array([V.get(c, c * scene.solid.c_s) for c in order.given])
    N = np.array(order.loads)
    ways = headings(scene, np.array([leg.s for leg in scene.legs])[legs], c)
    return {
        "motion": np.array([leg.name for leg in scene.legs])[legs],
        "X_over_L": np.concatenate(scene.places)[place],
        "c": c,
        **({"load": N[load]} if len(N) > 1 else {}),
        **{key: np.full(f.size, value) for key, value in scene.swept.items()},
        **{key: column[law] for key, column in friction.columns().items()},
        "speed": np.where(np.isnan(own), given[speed], own),
        **{f"flutter_{sign}": g for sign, g in zip(SIGNS, _flutter(scene.solid, c, ways))},
        "speed_limit": np.full(f.size, scene.solid.limit() * scene.solid.c_s),
        "wave_crossings": crossed / (np.nan if GIVEN_ENDS in scene.body.lacks else scene.body.half_width),
        "f": f,
        "g": friction.stress_ratio * f + 0.0,
    }


def _flutter(solid: Solid, c: NDArray, ways: NDArray) -> NDArray[np.float64]:
    """Flutter thresholds of both signs of σ_XY/σ_YY, (2, states); NaN for none, or for a solid without
    ``flutter``.

    Args:
        solid: the solid.
        c: speeds over c_s, (states,).
        ways: 1.0 where the punch moves to positive X, -1.0 to negative, (states,).
    """
    flutter = getattr(solid, "flutter", lambda c: (nan, nan))
    motions, of = np.unique(c + 1j * ways, return_inverse=True)  # pairs take ten times as long
    each = np.array([flutter(speed) for speed in np.copysign(motions.real, motions.imag).tolist()])
    return np.where(np.isfinite(each), each, nan)[of].T


def _laws(friction: Friction, of_laws: Sequence[float]) -> Iterator[tuple[float, FrictionLaw, int, bool]]:
    """Speeds over c_s, laws to compute there, of how many laws each stands for, and True for arrays."""
    together = friction.law.broadcasts and friction.integrator == "exact"
    columns = friction.columns() if together else {}
    for c in of_laws:
        for first in range(0, friction.count, _TOGETHER) if together else ():
            rows = slice(first, min(first + _TOGETHER, friction.count))
            yield c, friction.together(columns, rows), rows.stop - rows.start, True
        for law in () if together else friction.laws():
            yield c, law, 1, False
