"""How deep a punch is, from the pressure below it: the surface's displacement by line loads.

Line loads move the surface, by v,X = (n + g n₁₂) H[σ_YY] - g q σ_YY, so that at the left end of the
contact

    μ v(-1) = -(n + g n₁₂)/π ∫ σ_YY(t) log((1 + t)/D) dt + (g q/2) ∫ σ_YY(t) dt,

with D the distance at which a line load does not move it, the mean of both sides. There the punch has the
height P(-1), and v = P(-1) - v₀.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.solids.line_loads import DATUM
from galinx.solvers.solids.solid import Response

#: Places of the tanh-sinh rule, and how far it goes towards the ends.
_COUNT, _FAR = 400, 2.9
#: Share of the load next to the ends that the rule may leave.
_BEYOND = 1e-3


def places() -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Positions over a under the punch, dense at its ends, and the weights of an integral: (n,) each."""
    t, step = np.linspace(-_FAR, _FAR, _COUNT, retstep=True)
    u = np.pi / 2.0 * np.sinh(t)
    return np.tanh(u), step * np.pi / 2.0 * np.cosh(t) / np.cosh(u) ** 2


def indentation(response: Response, g: NDArray, σ_YY: NDArray, height: Any) -> NDArray[np.float64]:
    """v₀ of the punch's lowest point over N/(2μ), (states,), to about 2e-5 of it.

    NaN where pressures are so singular that the rule does not reach much of the load.

    Args:
        response: of a uniform half-plane at its speed.
        g: σ_XY/σ_YY, (states,).
        σ_YY: over N/(2a) at :func:`places`, (states, n).
        height: of the punch at the left end of the contact over N/(2μ), (states,).
    """
    X, weights = places()
    weighted = σ_YY * weights
    # What the rule leaves next to the ends of a sharp punch is in the load, which is 2.
    load = weighted.sum(axis=1)
    beyond = np.abs(load / -2.0 - 1.0) > _BEYOND
    mean = weighted @ np.log((1.0 + X) / DATUM) / load
    v = -2.0 * (-(response.n + g * response.n12) / np.pi * mean + g * response.q / 2.0)
    return np.where(beyond, np.nan, height - v)
