"""One contact over layers: its half-width found, the degree raised until the error is small enough."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.plan.task import Task
from galinx.app.run.methods.discretisation import Discretisation
from galinx.app.run.methods.error import reached
from galinx.app.run.methods.followed_level import GROWTH, ONE, FollowedLevel, FollowingMesh, Sized
from galinx.app.run.methods.ladder import WorkDone
from galinx.meshes.kind import DEGREES
from galinx.postprocess.quantities.quantity import INTENSITIES
from galinx.solvers.errors import SolveError
from galinx.solvers.profiles import check_reach
from galinx.solvers.solution import Surface

#: Meshes at most, the largest step of the half-width's logarithm, and the least and the most by which the
#: load's may grow with it.
_MESHES, _LARGEST, _SLOPES = 40, 1.2, (0.5, 15.0)
#: How near the half-width has to be before a degree is high, by how much it is lower until then, and how
#: near, over the tolerance, before nothing is moved any more.
_ROUGH, _LOWER, _SETTLED = 3e-2, 3, 0.1
#: Least difference of the half-width's logarithm by which loads of two meshes tell how these grow.
_APART = 1e-5
#: Share of the tolerance that may be left of it once all is solved; a mesh more is drawn otherwise.
_LEFT = 0.3

#: No stresses.
_NONE: frozenset[str] = frozenset()


@dataclass(frozen=True)
class FollowedState:
    """A solved contact; lengths over its half-width from its middle.

    Attributes:
        task: the speed, and the load, as this contact sees them.
        half_width, centre: of the contact [m].
        level: the last.
        estimates: relative errors by the word of output.quantities that asks for what they are of.
        record: numbers of the work, as they are archived.
    """

    task: Task
    half_width: float
    centre: float
    level: FollowedLevel
    estimates: dict[str, float]
    record: dict[str, Any]

    @cached_property
    def surface(self) -> Surface:
        """Stresses on the surface, of one state."""
        σ_YY = self.level.pressure.σ_YY(self.task.places.X)
        return self.level.displacement.surface(self.level.contact.g, ONE, σ_YY)

    @cached_property
    def inside(self) -> NDArray[np.float64]:
        """σ_XX, σ_YY, σ_XY at points inside, (3, m)."""
        return self.level.displacement.inside(ONE)[:, 0]

    @cached_property
    def interfaces(self) -> NDArray[np.float64]:
        """σ_YY, σ_XY, σ_XX above and below along every interface, (4, interfaces, n)."""
        return self.level.displacement.interfaces(ONE)[:, 0]

    def destroy(self) -> None:
        self.level.destroy()


class _Contact:
    """A contact that is looked for.

    Args:
        work: gives meshes.
        task: the speed, and the load.
        g: σ_XY/σ_YY.
        done: takes the numbers of the work.
    """

    def __init__(self, work: Discretisation, task: Task, g: float, done: WorkDone) -> None:
        self.work, self.task, self.g, self.done = work, task, g, done
        self._growth, self._centre = GROWTH, 0.0
        self._before: tuple[float, float] | None = None

    def settled(self, h: float) -> float:
        """The half-width [m] that carries the load, from one near by.

        Raises:
            SolveError: none was found.
        """
        x, tolerance, rough = float(np.log(h)), self.work.plan.tolerance, True
        for _ in range(_MESHES):
            off, lean = self._off(float(np.exp(x)), rough)
            self._learn(x, off)
            x_next = self.moved(x, off)
            # What the middle moves by is known to the square of that.
            step = max(abs(x_next - x), lean**2)
            if not rough and step <= _SETTLED * tolerance:
                return float(np.exp(x_next))
            if rough and step <= max(_ROUGH, _SETTLED * tolerance):
                # What a low degree says of the load is no measure of what a high one does.
                rough, self._before = False, None
            x = x_next
        raise SolveError(
            f"finite elements did not find the half-width of the contact: after {_MESHES} meshes it is "
            f"near {np.exp(x):.6g} m and still moves; take a speed farther from the limit"
        )

    def moved(self, x: float, off: float) -> float:
        """The half-width's logarithm, by how the load grows with it."""
        return x - float(np.clip(off / self._growth, -_LARGEST, _LARGEST))

    def _learn(self, x: float, off: float) -> None:
        """How the load grows, by two half-widths of one degree."""
        if self._before is not None and abs(x - self._before[0]) > _APART:
            low, high = _SLOPES
            self._growth = float(np.clip((off - self._before[1]) / (x - self._before[0]), low, high))
        self._before = x, off

    def _off(self, h: float, rough: bool) -> tuple[float, float]:
        """Logarithm of the load that makes a contact of this half-width, over the one that is wanted; and
        by how much the middle moves, over the half-width."""
        sized = Sized(self.task, h)
        plan = sized.plan(self.work.plan, _NONE, self.work.plan.tolerance)
        degree = plan.degrees[self.task.number]
        mesh = FollowingMesh(self.work, plan, _NONE)
        space = mesh.space(max(degree - _LOWER, DEGREES[0]) if rough else degree)
        level = self.level(mesh, sized.seen, space)
        level.destroy()
        before, self._centre = self._centre, h * level.centre
        return level.off, (self._centre - before) / h

    def level(self, mesh: FollowingMesh, task: Task, space: Any) -> FollowedLevel:
        """The contact on a space."""
        profile = self.task.body.profile
        found = FollowedLevel(mesh, task, space, self.g, profile, self._centre)
        self.done.count(found)
        return found

    def solved(self, h: float) -> tuple[Sized, FollowedLevel, dict[str, float]]:
        """On a mesh drawn for a half-width [m], as good as it has to be; and relative errors by word."""
        sized = Sized(self.task, h)
        words = self.work.stresses
        mesh = FollowingMesh(
            self.work, sized.plan(self.work.plan, words, self.work.plan.tolerance), words
        )
        g = np.array([self.g])

        def level(space: Any, _: NDArray) -> FollowedLevel:
            return self.level(mesh, sized.seen, space)

        with reached(mesh, sized.seen, g, level) as (ladder, error):
            of = {word: float(values[0]) for word, values in error.of(g).items()}
            self.record = error.record()
            return sized, ladder.levels.pop(), of


def solved(work: Discretisation, task: Task, g: float, near: float, done: WorkDone) -> FollowedState:
    """The contact at a friction.

    Args:
        work: gives meshes.
        task: the speed, and the load.
        g: σ_XY/σ_YY.
        near: half-width near by [m].
        done: takes the numbers of the work.

    Raises:
        SolveError: no contact was found, or the equations could not be solved.
    """
    contact = _Contact(work, task, g, done)
    h = contact.settled(near)
    sized, last, estimates = contact.solved(h)
    h = float(np.exp(contact.moved(float(np.log(h)), last.off)))
    if abs(h / sized.half_width - 1.0) > _LEFT * work.plan.tolerance:
        last.destroy()
        sized, last, estimates = contact.solved(h)
        h = float(np.exp(contact.moved(float(np.log(h)), last.off)))
    check_reach(task.body.profile, h * (last.centre - 1.0), h * (last.centre + 1.0))
    off = abs(h / sized.half_width - 1.0)
    estimates = {word: value + off for word, value in estimates.items()}
    assert INTENSITIES in estimates
    size = {"cells": last.space.cells, "unknowns": last.space.size, "degree": last.space.degree}
    return FollowedState(sized.seen, h, h * last.centre, last, estimates, size | contact.record)
