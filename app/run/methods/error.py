"""The error of a punch, measured on punches of lower degree, and the degree that it asks for."""

import numpy as np
from numpy.typing import NDArray

from galinx.app.run.methods.ladder import Ladder, Level
from galinx.meshes.kind import DEGREES
from galinx.postprocess.estimate import differences, remaining
from galinx.solvers.sie.closed_form import FlatPunch

#: States, spread over all of a speed, whose measured error decides the degree.
PROBES = 9


def climb(ladder: Ladder, g: NDArray) -> "MeasuredError":
    """Raise the degree until the measured error of sample states is within tolerance.

    Args:
        ladder: without a level.
        g: the speed's values of σ_XY/σ_YY, sorted.
    """
    plan, top = ladder.work.plan, ladder.degree
    for step in (2, 1, 0):
        if plan.fixed:
            ladder.add(g, top, plan.cuts >> step)
        else:
            ladder.add(g, top - step)
    probes = g[np.unique(np.linspace(0, len(g) - 1, PROBES).astype(int))]
    error = MeasuredError(ladder, probes)
    changes = dict(error.changes)
    # Where the outer radius alone spoils the tolerance, the cells need not do better than it.
    enough = max(plan.tolerance, 1.1 * error.truncation(probes).max())
    while not plan.fixed and ladder.degree < DEGREES[1] and error.of(probes).max() > enough:
        ladder.add(g, ladder.degree + 1)
        error = MeasuredError(ladder, probes)
        changes |= error.changes
    error.changes = changes
    return error


class MeasuredError:
    """How far the last of three levels is off, by what changed from level to level.

    Args:
        ladder: with three levels.
        probes: values of σ_XY/σ_YY that stand for all of the speed.

    Attributes:
        changes: largest change of the probes from the degree before, by degree; none at a fixed degree.
    """

    def __init__(self, ladder: Ladder, probes: NDArray) -> None:
        self._ladder = ladder
        self._sample = self._differences(probes)
        self._rounding = self._asymmetry(probes)
        self.changes: dict[int, float] = {}
        if not ladder.work.plan.fixed:
            degrees = (ladder.degree - 1, ladder.degree)
            self.changes = {p: float(found.max()) for p, found in zip(degrees, self._sample)}

    def of(self, g: NDArray) -> NDArray[np.float64]:
        """Estimated relative error of K_I and of the pressure's moments, (states,)."""
        left = remaining(*self._differences(g), self._sample)
        return left + self.truncation(g) + self._rounding

    def truncation(self, g: NDArray) -> NDArray[np.float64]:
        """Estimated relative error from the finite outer radius, (states,)."""
        plan, response = self._ladder.work.plan, self._ladder.task.response
        return plan.kind.truncation(plan.tolerance, response.margin) * np.abs(g)

    def _differences(self, g: NDArray) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        coarse, middle, fine = (self._measured(level, g) for level in self._ladder.levels)
        return differences(coarse, middle), differences(middle, fine)

    def _measured(self, level: Level, g: NDArray) -> NDArray[np.float64]:
        """What the error is measured on, each about 1: (states, several)."""
        states = level.punch.states(g)
        K_I = level.pressure(states, FlatPunch(self._ladder.task.response, g)).K_I
        moments = states.normal @ level.recovery.moments[:, 1:6]
        return np.column_stack([K_I * np.pi, moments / 2.0])

    def _asymmetry(self, g: NDArray) -> float:
        """Largest relative difference of K_I left at g and right at -g, which only rounding makes.

        Of a flat punch, since a profile need not be its own mirror image.
        """
        level, response = self._ladder.levels[-1], self._ladder.task.response
        K_I, mirrored = (
            level.pressure(level.punch.states(sign * g, flat=True), FlatPunch(response, sign * g)).K_I
            for sign in (1.0, -1.0)
        )
        return float(np.abs(K_I - mirrored[:, ::-1]).max() * np.pi)
