"""Which scenes have so many speeds that a few of them tell the others."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.layers.layered import LayeredResponse
from galinx.solvers.solids.solid import Response

#: Different speeds from which a fit through some of them is sooner there than all of them: it takes about
#: a dozen, four of these with all that measures an error.
LEAST = 16

#: Speeds at which the discretisation's error is measured, how many are solved besides as a rule, and
#: the most that are solved.
LADDERS, BESIDES, MOST = 4, 7, 24

#: Values of σ_XY/σ_YY up to which punches are sampled at these, and at no others.
_FEW = 8

#: Change of an inverse contraction over that of c² below which it tells speeds no better apart.
_FLAT = 1e-3


@dataclass(frozen=True)
class Sweep:
    """Speeds of which some are solved, the others fitted.

    Attributes:
        z: the speeds in the variable of the fit, in the order of the plan, (speeds,).
        g: all values of σ_XY/σ_YY where they are few, else the smallest and the largest.
        few: are they?
    """

    z: NDArray[np.float64]
    g: NDArray[np.float64]
    few: bool


def swept(wanted: str, responses: Sequence[Response], g: NDArray) -> Sweep | None:
    """The sweep of some speeds, None where each is to be solved.

    Args:
        wanted: ``"auto"`` or ``"every"``.
        responses: of the half-plane, one a speed.
        g: all values of σ_XY/σ_YY.
    """
    if wanted == "every" or len({response.c for response in responses}) < LEAST:
        return None
    values = np.unique(g)
    few = len(values) <= _FEW
    return Sweep(variable(responses), values if few else values[[0, -1]], few)


def variable(responses: Sequence[Response]) -> NDArray[np.float64]:
    """In which variable results are smoothest: they are analytic in c², and so is it.

    What the fields are analytic in, and the mesh where it follows them, contracts with a root of the
    distance to the slowest wave in the solid. So all is smooth in the contraction up to that speed, and
    in c² not. Its inverse spreads speeds near the limit; where it does not tell them apart c² has to do.

    Along layers waves of all lengths run, each with a speed of its own from the limit on: no pole is
    there, but the end of a branch, which the logarithm of the distance from it sends to infinity.
    """
    if isinstance(responses[0], LayeredResponse):
        return np.array([-np.log(response.margin) for response in responses])
    square = np.array([response.c**2 for response in responses])
    inverse = np.array([1.0 / response.contraction.imag for response in responses])
    order = np.argsort(square, kind="stable")
    steps, changes = np.diff(square[order]), np.diff(inverse[order])
    # Between speeds that hardly differ rounding may be all that is seen.
    seen = steps > 1e-6 * max(square.max(), np.finfo(float).tiny)
    tells = seen.any() and np.ptp(square) > 1e-4 and np.all(changes[seen] > _FLAT * steps[seen])
    return inverse if tells else square
