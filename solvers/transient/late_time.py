"""Late times of a flat punch that starts from rest: its approach to steady sliding, like 1/t.

At late times t the pressure is nearly that of steady motion, and the waves that were sent out before
leave a tilt of the surface behind: with N̂ = n + g n₁₂ the kernel of complex speeds c + is/k differs from
the steady one by

    i s N̂'(c)/(k|k|),  that is (N̂'/π) s log s X + …,  so that  μ v = … + (2/π) N̂' X/t

(stresses over N/(2a), lengths over a, times over a/c_s). The punch does not tilt; its pressure is that of
one tilted by as much the other way, in closed form, and

    centre: + 2 (N̂'/N̂) (1 + α)(1 + β)/t,    K_I: + 2 (N̂'/N̂) (1 + α)/t at X = a, - 2 (N̂'/N̂) (1 + β)/t at -a

the latter relative to K_I. At rest N̂' = 0, and the next term remains, a bend by N̂'' X²/(2π t²).
"""

from dataclasses import dataclass
from math import sqrt

from ..contact.edges import EdgeExponents
from ..solids.solid import Solid

#: Step of differences in c, at which half of the digits of a second difference remain.
_STEP = 1e-4


@dataclass(frozen=True)
class Approach:
    """Differences from steady sliding at late times t over a/c_s.

    Attributes:
        centre: difference of the pressure's centre over a, times t.
        K_left, K_right: differences of K_I at X = -a and X = a over K_I of steady motion, times t.
        at_rest: next term of centre and intensities, times t²; at c = 0 the only one.
    """

    centre: float
    K_left: float
    K_right: float
    at_rest: float

    def within(self, share: float) -> float:
        """Time over a/c_s from which on all differences are below ``share``; the load came on at once."""
        slow = max(map(abs, (self.centre, self.K_left, self.K_right)))
        return (slow + sqrt(slow**2 + 4.0 * share * self.at_rest)) / (2.0 * share)


def approach(solid: Solid, c: float, g: float) -> Approach:
    """Approach to steady sliding after a start from rest.

    Args:
        solid: uniform.
        c: speed over c_s, below the solid's limit.
        g: σ_XY/σ_YY under the punch.
    """
    h = min(_STEP, (solid.limit() - c) / 10.0)

    def N(c: float) -> float:
        response = solid.response(abs(c))  # even in c
        return response.n + g * response.n12

    change = (N(c + h) - N(c - h)) / (2.0 * h) / N(c)
    bend = (N(_STEP) - 2.0 * N(0.0) + N(-_STEP)) / _STEP**2 / N(0.0)
    edges = EdgeExponents(solid.response(c), g)
    α, β = float(edges.α), float(edges.β)
    return Approach(
        2.0 * change * (1.0 + α) * (1.0 + β), -2.0 * change * (1.0 + β), 2.0 * change * (1.0 + α),
        abs(bend) / 4.0,
    )  # fmt: skip
