"""Integrators: the state of a friction law along a stroke, and its work."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .law import FrictionLaw

#: Limit of h |∂rate/∂z| on the negative real axis for the classical Runge-Kutta scheme.
RK4_STABILITY_LIMIT = 2.785293563405282

#: Steps of the study's scheme in a stroke.
STEPS = 20

#: Relative and absolute tolerance of the integration of laws that are not exact.
TOLERANCES = 1e-12, 1e-14

#: Points of Gauss's rule in a piece of a stroke, and such pieces, for work without a formula.
_POINTS, _PIECES = 10, 12
#: Halvings of a piece at most, and accuracy over the whole work at which it is not halved further.
_HALVINGS, _OF_WORK = 20, 1e-13

#: Value of a switch nearer to zero than which it has just been passed.
_SWITCHED = 1e-10

#: (law, state at the start, direction, speed [m/s], length [m], slip since the start [m]) -> states.
Integrator = Callable[
    [FrictionLaw, NDArray[np.float64], int, float, float, NDArray[np.float64]], NDArray[np.float64]
]


@dataclass(frozen=True)
class RungeKuttaSteps:
    """Steps of one stroke: slip ``d`` [m], states ``z`` (steps, n) and slopes ``k`` (steps, 4, n)."""

    d: NDArray[np.float64]
    z: NDArray[np.float64]
    k: NDArray[np.float64]


def runge_kutta(
    law: FrictionLaw, z: NDArray, s: int, V: float, length: float, steps: int
) -> RungeKuttaSteps:
    """Integrate one stroke with the classical Runge-Kutta scheme, as the study does (Eqs 46-50).

    Eq 49 prints its second intermediate value wrongly; Table 1 follows the usual scheme, as this
    function does.

    Args:
        law: the law.
        z: state at the start, (n,).
        s: direction, +1 or -1.
        V: speed [m/s].
        length: length of the stroke [m].
        steps: number of steps, the study uses 20.

    Returns:
        ``steps + 1`` rows; the last row's slopes belong to the step that would follow.

    Raises:
        ValueError: the step is beyond the scheme's stability limit, the law has no known limit, or
            there is less than one step.
    """
    if steps < 1:
        raise ValueError(f"steps = {steps!r}: expected at least 1")
    h, stiffness = length / steps, law.stiffness(z, s, V)
    if stiffness is None:
        raise ValueError(
            f'no limit of stable steps is known for {type(law).__name__}; use integrator = "exact"'
        )
    if h * stiffness > RK4_STABILITY_LIMIT:
        raise ValueError(
            f"Runge-Kutta is unstable here: step times stiffness, {h * stiffness:.4g}, exceeds "
            f'{RK4_STABILITY_LIMIT:.3f}; use integrator = "exact", or more steps than {steps}'
        )
    states, k = np.empty((steps + 1, len(z))), np.empty((steps + 1, 4, len(z)))
    for i in range(steps + 1):
        k1 = law.rate(z, s, V)
        k2 = law.rate(z + h * k1 / 2.0, s, V)
        k3 = law.rate(z + h * k2 / 2.0, s, V)
        k4 = law.rate(z + h * k3, s, V)
        states[i], k[i] = z, (k1, k2, k3, k4)
        z = z + h * (k1 + 2.0 * k2 + 2.0 * k3 + k4) / 6.0
    return RungeKuttaSteps(np.linspace(0.0, length, steps + 1), states, k)


def exactly(
    law: FrictionLaw, z: NDArray, s: int, V: float, length: float, slip: NDArray
) -> NDArray[np.float64]:
    """States by the law's exact solution, else by its rate integrated to the last digits, (slips, n)."""
    states = law.exact(z, s, V, slip)
    return adaptively(law, z, s, V, length, slip) if states is None else states


def adaptively(
    law: FrictionLaw, z: NDArray, s: int, V: float, length: float, slip: NDArray
) -> NDArray[np.float64]:
    """States by the law's rate, integrated by an adaptive scheme of order 8 (SciPy's DOP853).

    It begins anew where the law switches, and stops at every slip of ``slip``: between its own steps it
    is of lower order. A stroke with a handful of states takes some milliseconds, with a hundred some 50.

    Raises:
        ValueError: the integration failed.
    """
    at, back = np.unique(np.clip(slip, 0.0, length), return_inverse=True)
    states, d, switched = np.empty((len(at), len(z))), 0.0, set[int]()
    z = np.asarray(z, dtype=float)
    for i, end in enumerate(at):
        while d < end:
            d, z = _smooth_piece(law, z, s, V, (d, end), switched)
        states[i] = z
    return states[back]


def closely(
    law: FrictionLaw, z: NDArray, s: int, V: float, length: float, slip: NDArray
) -> NDArray[np.float64]:
    """States by the law's exact solution, else by its rate integrated in the scheme's own steps.

    Between these steps states are interpolated, to about 1e-9: for many places at once, as of a curve.
    """
    if (exact := law.exact(z, s, V, slip)) is not None:
        return exact
    at, back = np.unique(np.clip(np.append(slip, length), 0.0, length), return_inverse=True)
    states, d, switched = np.empty((len(at), len(z))), 0.0, set[int]()
    states[:] = z
    while d < length:
        ahead = np.flatnonzero(at > d)
        piece, switches = _solved(law, z, s, V, (d, length), switched, at[ahead])
        # SciPy's y has no shape where a switch comes before the first place.
        passed = np.reshape(piece.y, (len(z), -1)).T
        states[ahead[: len(passed)]] = passed
        if piece.status == 0:
            break
        d, z = _last_switch(piece)
        switched.update(switches)
    return states[back[:-1]]


def _smooth_piece(
    law: FrictionLaw, z: NDArray, s: int, V: float, ends: tuple[float, float], switched: set[int]
) -> tuple[float, NDArray[np.float64]]:
    """Slip and state at the end or at the law's first switch, which is added to ``switched``.

    Raises:
        ValueError: the integration failed.
    """
    piece, switches = _solved(law, z, s, V, ends, switched)
    if piece.status == 0:
        return ends[1], piece.y[:, -1]
    # Located on the interpolant; from the last step before it, integration itself goes there.
    at, _ = _last_switch(piece)
    before = piece.t[piece.t < at][-1] if (piece.t < at).any() else ends[0]
    start = piece.y[:, np.flatnonzero(piece.t == before)[0]]
    switched.update(switches)
    if at == before:
        return at, start
    return at, _solved(law, start, s, V, (before, at), None)[0].y[:, -1]


def _last_switch(piece: Any) -> tuple[float, NDArray[np.float64]]:
    """Slip and state at the switch at which SciPy has stopped."""
    n = max((n for n, t in enumerate(piece.t_events) if len(t)), key=lambda n: piece.t_events[n][0])
    return float(piece.t_events[n][0]), piece.y_events[n][0]


def _solved(
    law: FrictionLaw,
    z: NDArray,
    s: int,
    V: float,
    ends: tuple[float, float],
    switched: set[int] | None,
    at: NDArray | None = None,
) -> tuple[Any, set[int]]:
    """SciPy's result between two slips, up to the next switch, and the numbers of the switches there.

    Args:
        law, z, s, V: as of :func:`adaptively`.
        ends: slips [m].
        switched: numbers of the switches already passed in this stroke, each is passed once; None: no
            switch stops the integration.
        at: slips of the states; None: the scheme's own steps.

    Raises:
        ValueError: the integration failed.
    """
    from scipy.integrate import solve_ivp  # slow to import, and exact laws do without

    ahead: list[int] = []
    if switched is not None:
        ahead = np.flatnonzero(law.switches(z, s, V) < -_SWITCHED).tolist()
        ahead = [n for n in ahead if n not in switched]
    result = solve_ivp(
        lambda _, state: law.rate(state, s, V), ends, z, method="DOP853", t_eval=at,
        events=[_event(law, s, V, n) for n in ahead] or None, rtol=TOLERANCES[0], atol=TOLERANCES[1],
    )  # fmt: skip
    if not result.success:
        raise ValueError(f"{type(law).__name__} could not be integrated: {result.message}")
    return result, {n for n, t in zip(ahead, result.t_events or ()) if len(t)}


def _event(law: FrictionLaw, s: int, V: float, n: int) -> Callable[[float, NDArray], float]:
    def passed(_: float, z: NDArray) -> float:
        return float(law.switches(z, s, V)[n])

    passed.terminal, passed.direction = True, 1.0  # type: ignore[attr-defined]
    return passed


def work(
    law: FrictionLaw, z: NDArray, s: int, V: float, slip: float, advance: "Integrator"
) -> NDArray[np.float64]:
    """Work ∫ s f d(slip) [m] from a state over a slip [m]: by the law's formula, else by quadrature.

    The quadrature is Gauss's rule on pieces that shrink towards the start, and are halved where that
    changes their part.
    """
    if (exact := law.work(z, s, V, np.array([slip]))) is not None:
        return exact[..., 0]
    if slip == 0.0:
        return np.zeros(())
    x, w = np.polynomial.legendre.leggauss(_POINTS)

    def parts(start: NDArray, end: NDArray) -> NDArray[np.float64]:
        half = 0.5 * (end - start)
        at = (0.5 * (end + start))[:, None] + half[:, None] * x
        states = advance(law, z, s, V, slip, at.ravel())
        f = s * law.friction(states, s, V)
        return (np.reshape(f, (*f.shape[:-1], *at.shape)) * half[:, None] * w).sum(axis=-1)

    ends = np.append(0.0, slip * 0.5 ** np.arange(_PIECES - 1, -1, -1.0))
    start, end = ends[:-1], ends[1:]
    whole = parts(start, end)
    total, size = np.zeros(whole.shape[:-1]), np.abs(whole).sum(axis=-1, keepdims=True)
    for _ in range(_HALVINGS):
        middle = 0.5 * (start + end)
        halves = parts(np.append(start, middle), np.append(middle, end))
        both = halves[..., : len(start)] + halves[..., len(start) :]
        far = (np.abs(both - whole) > _OF_WORK * size).reshape(-1, len(start)).any(axis=0)
        total = total + both[..., ~far].sum(axis=-1)
        start, end = np.append(start[far], middle[far]), np.append(middle[far], end[far])
        whole = halves[..., np.tile(far, 2)]
        if not far.any():
            break
    return total + whole.sum(axis=-1)


def by_runge_kutta(
    law: FrictionLaw, z: NDArray, s: int, V: float, length: float, slip: NDArray
) -> NDArray[np.float64]:
    """States by the study's Runge-Kutta scheme, (slips, n).

    A position between two steps is reached by a shorter last step, so no interpolation error enters.
    """
    steps = runge_kutta(law, z, s, V, length, STEPS)
    states = np.empty((len(slip), len(z)))
    for i, d in enumerate(slip):
        j = min(int(np.floor(d / length * STEPS + 1e-9)), STEPS)
        rest = max(d - steps.d[j], 0.0)
        states[i] = steps.z[j]
        if rest > 1e-12 * length:
            states[i] = runge_kutta(law, steps.z[j], s, V, rest, 1).z[1]
    return states


#: Integrators by the name that scenes use.
INTEGRATORS: dict[str, Integrator] = {"exact": exactly, "rk4": by_runge_kutta}
