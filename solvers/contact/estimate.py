"""Error of a finite element result, estimated from results of other degrees without an exact solution."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

#: Ratio of successive differences above which convergence is too slow to be summed; the estimate then
#: says that it is large.
SLOWEST = 0.9

#: Share of the largest first difference below which that of a single state is not used.
TYPICAL = 0.25

#: The ratio of successive differences is not quite constant; this covers it.
SAFETY = 2.0


@dataclass(frozen=True)
class Rate:
    """Rate at which errors fall from one level to the next.

    Attributes:
        usual: ratio of successive differences that is assumed where the measured one is not believed.
        believed: least ratio that is believed: a smaller one is a coincidence, or a level was too coarse.
        least: least second difference over the first that is believed; a smaller one is replaced by it.
    """

    usual: float
    believed: float
    least: float = 0.0


#: Differences of less than so many times the measured rounding are rounding; from twice that on they are
#: errors of discretisation. In between the estimate passes gradually from one to the other: if it jumped,
#: the archived estimate would jump with the last digit of any input.
_NOISE = 5.0

#: Ratio of successive differences below which those of derivatives are not believed: neighbouring cells
#: err differently at the sampled places.
_ERRATIC = 0.1


def of_degrees(order: int) -> Rate:
    """Rate at which errors fall from one degree to the next.

    Args:
        order: 2 for resultants and moments, 1 for derivatives.
    """
    return Rate(0.16, 0.16) if order == 2 else Rate(0.5, 0.5, _ERRATIC)


#: Rate for moments that converge unevenly.
SLOWER = Rate(0.3, 0.3)

#: Rate for derivatives at depths, away from all singularities, where many cells contribute evenly.
AT_DEPTHS = Rate(0.3, 0.3, _ERRATIC)


def remaining(
    first: NDArray,
    second: NDArray,
    sample: Sequence[NDArray],
    rate: Rate,
    rounding: float = 0.0,
) -> NDArray[np.float64]:
    """Errors that remain after two successive differences, by a geometric series, (states,).

    The series of differences d₀, d₁ with ratio ρ leaves d₁ ρ/(1 - ρ), here times ``SAFETY``. The ratio
    ρ = d₁/d₀ of a single state shows where its singularity is too strong for the degree. Its first
    difference may happen to vanish; so it counts as at least a share ``TYPICAL`` of the sample's largest
    first difference, and ρ as at least the sample's ratio.

    Args:
        first, second: successive differences of each state, (states,).
        sample: both successive differences of representative states, (m,) each.
        rate: assumed rate of convergence.
        rounding: rounding of the results, in their unit; differences of less than a few times this are
            not summed.

    Returns:
        Errors of the last level, in the unit of the differences, (states,).
    """
    second = np.maximum(second, rate.least * first)
    largest = max(sample[0].max(), np.finfo(float).tiny)
    common = sample[1].max() / largest
    own = second / np.maximum(first, TYPICAL * largest)
    ρ = np.maximum(common, own)
    ρ = np.minimum(np.where(ρ > rate.believed, ρ, rate.usual), SLOWEST)
    whole = ρ / (1.0 - ρ)
    noise = _NOISE * max(rounding, np.finfo(float).tiny)
    summed = np.clip(second / noise - 1.0, 0.0, 1.0)
    return SAFETY * second * (np.minimum(whole, 1.0) + summed * np.maximum(whole - 1.0, 0.0))


def before(difference: NDArray, rate: Rate) -> NDArray[np.float64]:
    """Errors of a level from its differences from the next level, times ``SAFETY``, (states,)."""
    return SAFETY * difference / (1.0 - rate.usual)
