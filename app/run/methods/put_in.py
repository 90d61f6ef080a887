"""What states share whose pressure is put in: by formula, or the user's own."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.run.methods.error import MeasuredError
from galinx.app.run.methods.ladder import Ladder
from galinx.solvers.solution import Body


class PutInAtSpeed:
    """A pressure put in at one speed, solved to the tolerance.

    Args:
        ladder: climbed.
        error: of its last level.
    """

    def __init__(self, ladder: Ladder, error: MeasuredError) -> None:
        self.task, self.level, self.error = ladder.task, ladder.levels[-1], error
        self._ladder = ladder

    def record(self) -> dict[str, Any]:
        return self._ladder.record() | self.error.record()


@dataclass(frozen=True)
class PutIn:
    """States with a pressure that is put in.

    Attributes:
        at: their speed.
        g: σ_XY/σ_YY, (states,).
        body: what slides over what, under the load of each.
    """

    at: Any
    g: NDArray[np.float64]
    body: Body

    @property
    def normal_force(self) -> NDArray[np.float64]:
        """Resultant over N/2, (states,)."""
        return np.full(len(self.g), self.at.level.resultant)

    @property
    def tangential_force(self) -> NDArray[np.float64]:
        """Resultant over N/2, (states,)."""
        return self.g * self.normal_force

    @cached_property
    def estimates(self) -> dict[str, NDArray[np.float64]]:
        """Relative errors, (states,), by the word of output.quantities that asks for what they are of."""
        found: dict[str, NDArray[np.float64]] = self.at.error.of(self.g)
        return found
