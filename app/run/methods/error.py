"""The error of finite elements, measured on solutions of lower degree, and the degree it asks for."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.plan.task import Task
from galinx.app.run.methods.discretisation import Discretisation
from galinx.app.run.methods.gauge import Gauge
from galinx.app.run.methods.ladder import Ladder
from galinx.meshes.kind import DEGREES
from galinx.postprocess.estimate import Rate, of_cuts, of_degrees, remaining
from galinx.postprocess.quantities.quantity import INTENSITIES
from galinx.solvers.fem.space import Space

#: What rounding does, over what of it breaks the mirror image.
_ROUNDING = 2.0

#: States, spread over all of a speed, whose measured error decides the degree.
PROBES = 9


@contextmanager
def climbed(
    work: Discretisation, task: Task, g: NDArray, solved: Callable[[Space, NDArray], Any]
) -> Iterator[tuple[Ladder, "MeasuredError"]]:
    """A ladder whose degree was raised until the measured error is within tolerance; it is freed at last.

    Args:
        work, task, solved: of the :class:`Ladder`.
        g: the speed's values of σ_XY/σ_YY, sorted.
    """
    ladder = Ladder(work, task, solved)
    try:
        yield ladder, climb(ladder, g)
    finally:
        ladder.destroy()


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
    while not plan.fixed and ladder.degree < DEGREES[1] and error.excessive:
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
        excessive: is an error larger than the tolerance, and would a higher degree make it smaller?
    """

    def __init__(self, ladder: Ladder, probes: NDArray) -> None:
        self._ladder = ladder
        levels = self._measured(probes)
        self._sample = _changes(levels)
        self._rounding = dict(zip(self._sample, ladder.levels[-1].rounding(probes)))
        self.changes: dict[int, float] = {}
        if not ladder.work.plan.fixed:
            for i, degree in enumerate((ladder.degree - 1, ladder.degree)):
                found = (float(pair[i].max()) for pair in self._sample.values())
                self.changes[degree] = max(found, default=0.0)
        tolerance, unseen = ladder.work.plan.tolerance, self._unseen(levels[-1], probes)
        # Where the outer radius alone spoils the tolerance, the cells need not do better than it.
        self.excessive = any(
            bool((error > np.maximum(tolerance, 1.1 * unseen[name])).any())
            for name, error in self._errors(levels, probes).items()
        )

    def record(self) -> dict[str, list[float]]:
        """The changes by degree, as they are archived."""
        changes = np.zeros(DEGREES[1] + 1)
        for degree, change in self.changes.items():
            changes[degree] = change
        return {"change_by_degree": changes.tolist() if changes.any() else []}

    def of(self, g: NDArray) -> dict[str, NDArray[np.float64]]:
        """Estimated relative errors, (states,), by the word of output.quantities that asks for them."""
        return self._errors(self._measured(g), g)

    def _errors(self, levels: list[list[Gauge]], g: NDArray) -> dict[str, NDArray[np.float64]]:
        unseen = self._unseen(levels[-1], g)
        return {
            word: remaining(*pair, self._sample[word], self._rate(word), self._rounding[word])
            + unseen[word]
            + _ROUNDING * self._rounding[word]
            for word, pair in _changes(levels).items()
        }

    def _rate(self, word: str) -> Rate:
        ladder = self._ladder
        order = 2 if word == INTENSITIES else 1
        return of_cuts(ladder.degree, order) if ladder.work.plan.fixed else of_degrees(order)

    def _measured(self, g: NDArray) -> list[list[Gauge]]:
        return [level.measured(g) for level in self._ladder.levels]

    def _unseen(self, gauges: list[Gauge], g: NDArray) -> dict[str, NDArray[np.float64]]:
        """Estimated relative errors that no level sees: of outer radius, innermost cells; (states,)."""
        plan, margin = self._ladder.work.plan, self._ladder.task.response.margin
        kind, wanted = plan.kind, plan.wanted
        far, innermost = kind.truncation(wanted, margin), kind.unseen(wanted, self._ladder.degree)
        # Measured at far boundaries of 100 a and 300 a; see docs/verification.md.
        of_edges = 2.8 * np.abs(g) + 1.8 * far
        found = {}
        for gauge in gauges:
            if gauge.word == INTENSITIES:
                found[gauge.word] = innermost + far * of_edges
            else:
                of_places = 0.6 + 4.0 / gauge.scale.min(axis=1)
                found[gauge.word] = innermost + kind.unseen_beside(wanted) + far * (of_edges + of_places)
        return found


def _changes(levels: list[list[Gauge]]) -> dict[str, tuple[NDArray[np.float64], NDArray[np.float64]]]:
    """Largest changes of each state from the first level to the second, and to the last."""
    return {
        fine.word: (middle.change(coarse), fine.change(middle)) for coarse, middle, fine in zip(*levels)
    }
