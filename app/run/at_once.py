"""What there were at once in steady motion of the same friction, beside which motions are seen."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from galinx.app.plan.over_time import Starts
from galinx.solvers.layers.in_cells import LayersInCells
from galinx.solvers.layers.pressure import Pressure
from galinx.solvers.layers.states import Speed
from galinx.solvers.sie.closed_form import FlatPunch
from galinx.solvers.solids.solid import Solid

#: Length over a of the rule by which a pressure over layers is integrated.
_FINEST = 0.5
#: Accuracy over that of a scene.
_OF_TOLERANCE = 0.1


@dataclass(frozen=True)
class AtOnce:
    """Steady motion under a flat punch at a speed.

    Args:
        starts: what is asked for.
        solid: the solid.
        c: speed over c_s.
    """

    starts: Starts
    solid: Solid
    c: float

    def centres(self, ratios: NDArray) -> NDArray[np.float64]:
        """Centre of the pressure over a at frictions σ_XY/σ_YY, (n,)."""
        different, which = np.unique(ratios, return_inverse=True)
        response = self.starts.response(self.solid, self.c)
        if isinstance(response, LayersInCells):
            stack, accuracy = response.stack(response.a), _OF_TOLERANCE * self.starts.tolerance
            found, _ = Speed(response.surface, stack, np.zeros_like, accuracy).solved(different)
            return np.asarray((found.at(different) @ found.read(_centre))[which])
        punches = [FlatPunch(response, ratio) for ratio in different]
        return np.array([one.β - one.α for one in punches])[which]

    def K_I(self, ratio: float) -> float:
        """That of both ends; NaN over layers, where they differ."""
        response = self.starts.response(self.solid, self.c)
        return np.nan if isinstance(response, LayersInCells) else FlatPunch(response, ratio).K_I


def _centre(pressure: Pressure) -> NDArray[np.float64]:
    t, forces = pressure.points(_FINEST)
    return np.array(forces @ t / forces.sum())
