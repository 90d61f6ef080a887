"""Integrators: the state of a friction law along a stroke, and its work."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
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

#: Pieces of a stroke, each half the next, for work without a formula, and its relative accuracy.
_PIECES, _OF_WORK = 12, 1e-12

#: Value of a switch nearer to zero than which it has just been passed.
_SWITCHED = 1e-10

#: (law, state at the start, direction, speed [m/s], length [m], slip since the start [m]) -> states.
Integrator = Callable[
    [FrictionLaw, NDArray[np.float64], int, float, float, NDArray[np.float64]], NDArray[np.float64]
]


def runge_kutta(
    law: FrictionLaw, z: NDArray, s: int, V: float, length: float, steps: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
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
        States, (steps + 1, n), and the scheme's four slopes there, (steps + 1, 4, n); the last slopes
        belong to the step that would follow.

    Raises:
        ValueError: the step is beyond the scheme's stability limit, or the law has no known limit.
    """
    h, stiffness = length / steps, law.stiffness(z, s, V)
    if stiffness is None:
        raise ValueError(
            f"no limit of stable steps is known for {law.about} with these parameters; use "
            'integrator = "exact"'
        )
    if h * stiffness > RK4_STABILITY_LIMIT:
        raise ValueError(
            f"Runge-Kutta is unstable here: step times stiffness, {h * stiffness:.4g}, exceeds "
            f'{RK4_STABILITY_LIMIT:.3f}; use integrator = "exact"'
        )
    states, k = np.empty((steps + 1, len(z))), np.empty((steps + 1, 4, len(z)))
    for i in range(steps + 1):
        k1 = law.rate(z, s, V)
        k2 = law.rate(z + h * k1 / 2.0, s, V)
        k3 = law.rate(z + h * k2 / 2.0, s, V)
        k4 = law.rate(z + h * k3, s, V)
        states[i], k[i] = z, (k1, k2, k3, k4)
        z = z + h * (k1 + 2.0 * k2 + 2.0 * k3 + k4) / 6.0
    return states, k


def exactly(
    law: FrictionLaw, z: NDArray, s: int, V: float, length: float, slip: NDArray, stops: bool = True
) -> NDArray[np.float64]:
    """States by the law's exact solution, else by its rate, see :func:`adaptively`, (slips, n)."""
    states = law.exact(z, s, V, slip)
    return adaptively(law, z, s, V, length, slip, stops) if states is None else states


#: States by the law's exact solution, else interpolated: for many places at once, as of a curve.
closely = partial(exactly, stops=False)


def adaptively(
    law: Any, z: NDArray, s: int, V: float, length: float, slip: NDArray, stops: bool = True
) -> NDArray[np.float64]:
    """States by the law's rate, integrated by an adaptive scheme of order 8 (SciPy's DOP853), (slips, n).

    Args:
        law: the law.
        z: state at the start, (n,).
        s: direction, ±1.
        V: speed [m/s].
        length: length of the stroke [m].
        slip: slips since the start [m], (slips,).
        stops: True to stop at every slip: a stroke with a handful of states takes some milliseconds, with
            a hundred some 50. Otherwise states between the scheme's own steps are interpolated, to about
            1e-9.

    Raises:
        ValueError: the integration failed.
    """
    at, back = np.unique(np.clip(slip, 0.0, length), return_inverse=True)
    states, d, passed = np.empty((len(at), len(z))), 0.0, set[int]()
    states[:] = z = np.asarray(z, dtype=float)
    for n in range(len(at)) if stops else range(len(at))[-1:]:
        while d < at[n]:
            begun, (d, z, between) = d, _smooth_piece(law, z, s, V, (d, at[n]), passed, not stops)
            inside = (begun < at) & (at <= d)
            if between and inside.any():
                states[inside] = between(at[inside]).T
        states[n] = z
    return states[back]


def _smooth_piece(
    law: Any, z: NDArray, s: int, V: float, ends: tuple[float, float], passed: set[int], dense: bool
) -> tuple[float, NDArray[np.float64], Callable[[NDArray], NDArray] | None]:
    """Slip and state at the end or at the law's first switch, and if ``dense`` SciPy's interpolant.

    Args:
        law, z, s, V: as of :func:`adaptively`.
        ends: slips [m].
        passed: numbers of the switches met in this stroke, each of which is met once; changed.
        dense: True for the interpolant.

    Raises:
        ValueError: the integration failed.
    """
    from scipy.integrate import solve_ivp  # slow to import, and exact laws do without

    ahead = set(np.flatnonzero(law.switches(z, s, V) < -_SWITCHED).tolist()) - passed

    def solve(start: float, end: float, z: NDArray, events: Any = None) -> Any:
        result = solve_ivp(
            lambda _, state: law.rate(state, s, V), (start, end), z, method="DOP853", events=events,
            rtol=TOLERANCES[0], atol=TOLERANCES[1], dense_output=dense,
        )  # fmt: skip
        if not result.success:
            raise ValueError(f"{type(law).__name__} could not be integrated: {result.message}")
        return result

    events = [event(lambda _, z, n=n: law.switches(z, s, V)[n], 1.0, True) for n in ahead]
    piece = solve(*ends, z, events or None)
    if piece.status == 0:
        return ends[1], piece.y[:, -1], piece.sol
    met = {n: float(t[0]) for n, t in zip(ahead, piece.t_events) if len(t)}
    passed.update(met)
    # Located on the interpolant; from the last step before it, integration itself goes there.
    at, last = max(met.values()), int(np.flatnonzero(piece.t < max(met.values())).max(initial=0))
    before, state = float(piece.t[last]), piece.y[:, last]
    return at, solve(before, at, state).y[:, -1] if before < at else state, piece.sol


def event(function: Callable[..., Any], direction: float, terminal: bool) -> Callable[..., Any]:
    """Event of SciPy's integrators where a function of time and state is zero.

    Args:
        function: of time and state.
        direction: 1 where it grows, -1 where it falls, 0 for both.
        terminal: True where the integration ends there.
    """
    function.direction, function.terminal = direction, terminal  # type: ignore[attr-defined]
    return function


@dataclass(frozen=True)
class _WithWork:
    """A law whose last state is the mean of s f over a length [m] so far."""

    law: FrictionLaw
    length: float

    def rate(self, z: NDArray, s: int, V: float) -> NDArray[np.float64]:
        f = self.law.friction(z[:-1], s, V)
        return np.append(self.law.rate(z[:-1], s, V), s * f / self.length)

    def switches(self, z: NDArray, s: int, V: float) -> NDArray[np.float64]:
        return self.law.switches(z[:-1], s, V)


def work(law: FrictionLaw, z: NDArray, s: int, V: float, slip: float) -> NDArray[np.float64]:
    """Work ∫ s f d(slip) [m] from a state over a slip [m]: by formula, by quadrature, or integrated.

    Without a formula of the work the exact solution is summed by Gauss and Kronrod's adaptive rule; where
    only the rate is known, the work is integrated beside the state.
    """
    if (exact := law.work(z, s, V, np.array([slip]))) is not None:
        return exact[..., 0]
    if slip == 0.0:
        return np.zeros(())
    if law.exact(z, s, V, np.zeros(1)) is None:
        whole, start = _WithWork(law, slip), np.append(z, 0.0)
        return slip * adaptively(whole, start, s, V, slip, np.array([slip]))[0, -1]
    from scipy.integrate import quad_vec  # a slow import

    def power(d: float) -> Any:
        return s * law.friction(law.exact(z, s, V, np.array([d])), s, V)[..., 0]  # type: ignore[arg-type]

    halves = slip * 0.5 ** np.arange(1.0, _PIECES)  # friction changes at first
    # Friction coefficients have no digits below the 14th.
    least = 1e-14 * slip
    return np.asarray(quad_vec(power, 0.0, slip, epsabs=least, epsrel=_OF_WORK, points=halves)[0])


def by_runge_kutta(
    law: FrictionLaw, z: NDArray, s: int, V: float, length: float, slip: NDArray
) -> NDArray[np.float64]:
    """States by the study's Runge-Kutta scheme, (slips, n).

    A position between two steps is reached by a shorter last step, so no interpolation error enters.
    """
    reached, _ = runge_kutta(law, z, s, V, length, STEPS)
    at, states = np.linspace(0.0, length, STEPS + 1), np.empty((len(slip), len(z)))
    for i, d in enumerate(slip):
        j = min(int(np.floor(d / length * STEPS + 1e-9)), STEPS)
        rest = max(d - at[j], 0.0)
        states[i] = reached[j]
        if rest > 1e-12 * length:
            states[i] = runge_kutta(law, reached[j], s, V, rest, 1)[0][1]
    return states


#: Integrators by the name that scenes use.
INTEGRATORS: dict[str, Integrator] = {"exact": exactly, "rk4": by_runge_kutta}
