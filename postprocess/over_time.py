"""Motions in time: numbers from contact forces, comparison of both methods, distance from steady motion.

Nodal forces that change in time give the load, the centre of the pressure, and K_I at both ends. The same
numbers give the distance of a start from steady motion, and the time from which on it is small. Rules of
comparison are registered here: of these numbers, of works and energies, which have to balance, and of
stresses along the surface, by the integral equation and by a coarser motion.
"""

from collections.abc import Mapping, Sequence
from math import ceil
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import xlogy

from galinx.solvers.contact.edges import from_edge
from galinx.solvers.contact.stresses import NEAR, PLACES, tension
from galinx.solvers.transient.punch import LEAST, ON_SURFACE
from galinx.solvers.transient.transform import Weighted

from .compare import RULES, Rule, against, largest, pull
from .quantities import over_time as rows
from .quantities.over_time import SHARES
from .quantities.quantity import FEM, SIE


def contact_numbers(X: NDArray, forces: NDArray, α: float, β: float, degree: int) -> NDArray[np.float64]:
    """Centre of the pressure over a, K_I at X = -a and X = a over N, and tension, (4, times).

    The tension is the largest under the punch over N/(2a), see :func:`largest_tension`. Consistent nodal
    forces of σ_YY, tested with smooth functions, give moments of the pressure.

    Args:
        X: positions of the contact nodes over a, (nodes,).
        forces: nodal forces over N/2, (times, nodes); their sum is -2 under the whole load.
        α, β: exponents of the pressure at X = a and X = -a, α + β = -1.
        degree: polynomial degree of the elements.
    """
    # Elements have to represent the polynomials with which forces are tested, too. The smooth factor of
    # the pressure has fewer: a wave that runs little faster than the punch is short under it.
    moments = ceil(2.5 * degree)
    polynomials = moments - 4
    tests = Weighted(α, β, moments)
    a, (r, w) = forces @ tests.polynomials(X), tests.rule(400)  # of r log r
    basis = np.column_stack([np.eye(moments, polynomials), tests.polynomials(r).T @ (w * _logs(r)).T])
    factors = np.linalg.lstsq(basis, a.T, rcond=None)[0]
    ends = np.array([-1.0, 1.0])
    at_ends, under = (
        np.column_stack([tests.polynomials(at)[:, :polynomials], _logs(at).T]) @ factors
        for at in (ends, PLACES)
    )
    σ_YY = ((1.0 - PLACES) ** α * (1.0 + PLACES) ** β)[:, None] * under
    return np.array([(forces @ X) / forces.sum(axis=1), *(-0.5 * at_ends), largest_tension(σ_YY.T)])


def largest_tension(σ_YY: NDArray) -> NDArray[np.float64]:
    """Largest tension under the punch further than 0.01 a from its ends, 0 for none, (times,).

    Args:
        σ_YY: contact stress at ``PLACES``, (times, places).
    """
    far = from_edge(PLACES) > NEAR
    return tension(PLACES[far], σ_YY[:, far])[0]


def _logs(X: NDArray) -> NDArray[np.float64]:
    """Terms r log r of the distances from both ends, (2, points), which inertia adds to the pressure."""
    return np.array([xlogy(r, r) for r in (1.0 + X, 1.0 - X)])


#: Numbers that both methods give.
COMPARED = rows.V0, rows.CENTRE, rows.K_I_LEFT, rows.K_I_RIGHT


def largest_change(
    histories: Sequence[NDArray], expected: Sequence[NDArray], load: NDArray, lean: ArrayLike = 0.0
) -> float:
    """Largest difference of v₀, centre and K_I over time, relative to a start's largest, dimensionless.

    The centre is multiplied by the load: it is uncertain where there is hardly any load. K_I is relative
    to that of the stronger end, and left out where it is NaN.

    Args:
        histories, expected: v₀, centre, K_I left and right by two methods, (starts, times) each.
        load: load over N, (times,).
        lean: centre of steady motion over a, (starts, times), counted when the largest centre is taken.
    """
    off, sizes = [], []
    for n, (values, other) in enumerate(zip(histories, expected)):
        share = load if n == 1 else np.ones_like(load)
        off.append(np.abs((values - other) * share).max(axis=-1))
        sizes.append(np.abs(other * share).max(axis=-1))
    sizes[0] = np.maximum(sizes[0], LEAST)
    sizes[1] = np.maximum(np.maximum(sizes[1], LEAST), np.abs(np.atleast_1d(lean)).max(axis=-1))
    sizes[2] = sizes[3] = np.maximum(sizes[2], sizes[3])
    return float(np.nanmax(np.array(off) / np.array(sizes)))


def _both(fem: list[NDArray], sie: list[NDArray], data: Mapping[str, Any], _: Any) -> float:
    """Largest difference of both methods at times at which the integral equation has a solution."""
    solved = np.isfinite(sie[0]).all(axis=0)
    if not solved.any():
        return np.inf
    fem, sie = ([values[:, solved] for values in method] for method in (fem, sie))
    # Where friction changes faster than waves run, the pressure never reaches its steady centre.
    changing = np.ptp(data[rows.RATIOS.path], axis=-1, keepdims=True) > 0.0
    lean = np.where(changing, data[rows.CENTRES.path], 0.0)
    return largest_change(fem, sie, data[rows.LOAD.path][solved], lean[:, solved])


def from_steady(data: Mapping[str, Any], method: str) -> NDArray[np.float64]:
    """Largest difference of K_I over that of steady motion, and of the centre over a, (starts, times).

    Steady motion is that under the last load, which need not be N.

    Args:
        data: datasets of starts from rest by path.
        method: name of the method of solution.
    """
    K = data[rows.STEADY_K_I.path][:, None] * data[rows.LOAD.path][-1]
    centre = data[rows.STEADY_CENTRE.path][:, None]
    of_K = [np.abs(data[row[method].path] / K - 1.0) for row in (rows.K_I_LEFT, rows.K_I_RIGHT)]
    return np.asarray(np.max([*of_K, np.abs(data[rows.CENTRE[method].path] - centre)], axis=0))


def times_near_steady(t: NDArray, load: NDArray, off: NDArray) -> NDArray[np.float64]:
    """Times over a/c_s from which on starts are within ``SHARES`` of steady motion, (starts, shares).

    A time after the last one is extrapolated: the distance is taken to fall like 1/t, t from when the
    last load would have come on at once. That is done if distance times t changes by a tenth at most in
    the second half of the motion; else the motion is too short, and the time is NaN.

    Args:
        t: times over a/c_s, (times,).
        load: load over N, (times,).
        off: distances from steady motion, see :func:`from_steady`, (starts, times).
    """
    lacks, steps = np.concatenate([[1.0], 1.0 - load / load[-1]]), np.diff(t, prepend=0.0)
    begun = float(steps @ (lacks[1:] + lacks[:-1])) / 2.0
    times = np.empty((len(off), len(SHARES)))
    tail, since = t >= (begun + t[-1]) / 2.0, t - begun
    for i, distance in enumerate(off):
        scaled = since[tail] * distance[tail]
        like = np.isfinite(scaled).all() and np.ptp(scaled) <= 0.1 * scaled[-1]
        for n, share in enumerate(SHARES):
            far = np.flatnonzero(distance > share)
            last = int(far[-1]) if len(far) else -1
            if last == len(t) - 1:
                times[i, n] = begun + scaled[-1] / share if like else np.nan
            elif last < 0:
                times[i, n] = t[0]
            else:
                a, b = distance[last], distance[last + 1]
                times[i, n] = t[last] + (t[last + 1] - t[last]) * (a - share) / (a - b)
    return times


def distances_from_steady(data: Mapping[str, Any], method: str) -> dict[str, NDArray[np.float64]]:
    """Datasets of a method by path: distance from steady motion at the end, and times of nearness."""
    off = from_steady(data, method)
    off = np.where(np.isnan(off), np.inf, off)  # without K_I no state counts as near
    times, load = data[rows.TIMES.path], data[rows.LOAD.path]
    datasets = {
        rows.OFF[method].path: off[:, -1],
        rows.WITHIN[method].path: times_near_steady(times, load, off),
    }
    return {path: np.where(np.isfinite(values), values, np.nan) for path, values in datasets.items()}


#: Terms of the balance: works and energy that come in, and energies that are held or radiated.
DONE = rows.OF_LOAD[FEM], rows.OF_FRICTION[FEM], rows.CARRIED
HELD = rows.STRAIN, rows.KINETIC, rows.RADIATED


def energy_imbalance(data: Mapping[str, Any]) -> NDArray[np.float64]:
    """Work less energy, over the largest work of a motion, (motions, times).

    Of hardly any work, as in steady motion that goes on, over LEAST.
    """
    done, held = (sum(data[row.path] for row in kind) for kind in (DONE, HELD))
    return np.asarray((done - held) / np.abs(done).max(axis=1, keepdims=True, initial=LEAST))


def _over_largest(values: Any, expected: Any, axes: tuple[int, int]) -> float:
    """Largest difference over the largest expected number along some axes, dimensionless."""
    sizes = (np.abs(of).max(axis=axes) for of in (np.subtract(values, expected), np.asarray(expected)))
    return float(np.divide(*sizes).max())


def _until_turn(fem: list[NDArray], sie: list[NDArray], *_: Any) -> float | None:
    """Largest difference of histories up to the first turn, over a motion's largest of all of them.

    None where the integral equation has no solution.
    """
    solved = np.isfinite(sie).all(axis=(0, 1))
    fem, sie = ([y[:, solved] for y in method] for method in (fem, sie))
    return _over_largest(fem, sie, (0, 2)) if solved.any() else None


#: Stresses that are compared; the shear stress is proportional to the pressure.
SURFACE = rows.SURFACE_IN_PLANE, rows.SURFACE_PRESSURE


def largest_surface_change(stresses: Any, expected: Any) -> float:
    """Largest difference of stresses along the surface, over a motion's largest, dimensionless.

    Args:
        stresses, expected: σ_XX and σ_YY by two methods, (motions, times, places) each.
    """
    far = from_edge(ON_SURFACE) > NEAR  # at the edges stresses are infinite
    stresses, expected = ([σ[..., far] for σ in method] for method in (stresses, expected))
    return _over_largest(stresses, expected, (-2, -1))


def estimated(before: Mapping[str, NDArray], now: Mapping[str, NDArray]) -> dict[str, NDArray]:
    """Estimated error of a motion's stresses from two successive solutions, by path.

    Args:
        before, now: datasets by path of the coarser and of the finer solution.

    Returns:
        A dataset by path, relative to the largest stress; empty where a solution has no stresses.
    """
    if any(SURFACE[0][FEM].path not in of for of in (before, now)):
        return {}
    of_both = ([of[row[FEM].path] for row in SURFACE] for of in (before, now))
    return {rows.SURFACE_ESTIMATE.path: np.array(largest_surface_change(*of_both))}


def stress_datasets(method: str, stresses: NDArray) -> dict[str, NDArray]:
    """Datasets by path of a method's σ_XX, σ_YY and σ_XY over N/(2a), (3, times, places)."""
    of = rows.SURFACE_IN_PLANE, rows.SURFACE_PRESSURE, rows.SURFACE_SHEAR
    return {row[method].path: values for row, values in zip(of, stresses)}


def _along(fem: list[NDArray], sie: list[NDArray], *_: Any) -> float | None:
    """Largest difference of both methods up to the first turn; None without output before it."""
    solved = np.isfinite(sie[0]).all(axis=(0, 2))
    fem, sie = ([σ[:, solved] for σ in method] for method in (fem, sie))
    return largest_surface_change(fem, sie) if solved.any() else None


_AGAINST = "over time against the integral equation, over the largest"
_FAR = "further than 0.01 a from the edges"

#: Change of a scene in which a punch pulls for a while.
_SLOWER = "let time.load change more slowly, or end the motion earlier"
#: Name of the rule on estimates of stresses along the surface.
OF_SURFACE = "estimate on the surface over time"

_RULES = {
    "over time": against(
        SIE, _both, f"v₀, centre times load and K_I {_AGAINST}", *COMPARED,
        beside=(rows.LOAD, rows.RATIOS, rows.CENTRES),
    ),
    "estimate over time": largest(rows.ESTIMATE, "estimated error over time, over the largest"),
    "residual over time": largest(
        rows.RESIDUAL, "residual of the integral equation and of the load over time, relative"
    ),
    "works over time": against(
        SIE, _until_turn, f"works of load and friction {_AGAINST}", rows.OF_LOAD, rows.OF_FRICTION
    ),
    "energy over time": Rule(
        "work without its energy over time, over the largest work", (*DONE, *HELD),
        lambda data, _: float(np.abs(energy_imbalance(data)).max()), tolerances=1.0,
    ),
    "surface over time": against(
        SIE, _along, f"σ_XX and σ_YY along the surface {_AGAINST} {_FAR}", *SURFACE
    ),
    OF_SURFACE: largest(
        rows.SURFACE_ESTIMATE,
        f"estimated error of σ_XX and σ_YY along the surface over time, over the largest {_FAR}",
    ),
    "tension over time": pull(" over time", rows.TENSION[FEM], _SLOWER),
    "tension over time, sie": pull(" over time, by the integral equation", rows.TENSION[SIE], _SLOWER),
    # Its difference is reported, not judged: waves ahead of a fast punch are short.
    "ends over time": against(
        SIE, _until_turn, f"σ_XX 0.05 a beside both ends {_AGAINST}", rows.LEFT, rows.RIGHT,
        tolerances=None,
    ),
}  # fmt: skip
for _name, _rule in _RULES.items():
    RULES.register(_name, _rule)

#: Names of all rules of motions in time.
IN_TIME = frozenset(_RULES)
