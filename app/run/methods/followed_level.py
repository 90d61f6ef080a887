"""A contact over layers at one degree on a mesh drawn for its half-width; what its error is measured on.

Held under the punch are its height around a middle that is nearly known, what that changes by where the
middle moves, and a constant; what they carry and the intensities at both ends are linear in their
amplitudes. So the mesh's half-width has a load of its own, at which no intensity is left, and a middle:
of a parabola at once, of others once that hardly moves.
"""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.plan import layers
from galinx.app.plan.fem import FemPlan, wanted_for
from galinx.app.plan.task import Task
from galinx.app.run.methods.discretisation import Discretisation, on_finer_cells
from galinx.app.run.methods.gauge import Gauge, StressGauges
from galinx.app.run.methods.kinked_displacement import KinkedDisplacement
from galinx.app.run.methods.punch import negligible, tests_of
from galinx.postprocess import scale
from galinx.postprocess.pressure import contact_recovery
from galinx.postprocess.quantities.quantity import INTENSITIES
from galinx.postprocess.quantities.strata import AT_INTERFACES
from galinx.postprocess.quantities.stresses import BELOW, ON_SURFACE
from galinx.postprocess.stretched import from_moments
from galinx.solvers.errors import SolveError
from galinx.solvers.fem.punch import SlidingPunch
from galinx.solvers.fem.space import Space
from galinx.solvers.fem.states import ContactStates, Part, combined
from galinx.solvers.profiles.flat import Flat
from galinx.solvers.sie.closed_form import FlatPunch
from galinx.solvers.solution import Places

#: Places under the punch at which the pressure is measured.
_ACROSS = np.cos(np.pi * (np.arange(24) + 0.5) / 24.0)
#: Weights of a single field.
ONE = np.ones((1, 1))
#: Of the load's logarithm, by how much it grows with that of the half-width; of a half-plane it is 2.
GROWTH = 2.0


@dataclass(frozen=True)
class Sized:
    """A task as a contact of some half-width sees it; lengths are over that.

    Attributes:
        task: the task, under one load.
        half_width: [m].
    """

    task: Task
    half_width: float

    @cached_property
    def seen(self) -> Task:
        """With that length."""
        task, h = self.task, self.half_width
        places, depths = task.places, task.body.solid.depths / h  # type: ignore[attr-defined]
        return replace(
            task,
            body=replace(task.body, profile=Flat(h)),
            response=replace(task.response, a=h),  # type: ignore[type-var]
            places=replace(places, interfaces=depths),
        )

    def plan(self, plan: FemPlan, words: frozenset[str], tolerance: float) -> FemPlan:
        """Of a mesh drawn for it.

        Args:
            plan: of all contacts.
            words: of output.quantities that ask for stresses of it.
            tolerance: relative.
        """
        seen = self.seen
        places, interfaces = seen.places, seen.places.interfaces
        kind = layers.kind_of(interfaces, [seen.response])
        below = places.points if BELOW in words else np.empty((0, 2))
        if AT_INTERFACES in words:
            X, depth = np.meshgrid(places.along, interfaces)
            below = np.concatenate([below, np.column_stack([X.ravel(), -depth.ravel()])])
        X = places.X if ON_SURFACE in words else np.empty(0)
        asked = Places(X, below, places.around)
        wanted = wanted_for(tolerance, asked, plan.sharp, seen.response.spread)
        wanted = layers.wanted_of_free_ends(wanted)
        degree = kind.degree(wanted, seen.response.margin)
        return replace(
            plan, kind=kind, wanted=wanted, drawn=kind.drawn(wanted),
            degrees=(degree,) * len(plan.degrees), tests=layers.tests_of(seen.body.solid, kind, wanted),
        )  # fmt: skip


class FollowingMesh:
    """Spaces on a mesh of one contact; see :class:`Discretisation`.

    Args:
        work: of all contacts.
        plan: of the mesh.
        stresses: words of output.quantities that ask for stresses of it.
    """

    def __init__(self, work: Discretisation, plan: FemPlan, stresses: frozenset[str]) -> None:
        assert plan.drawn
        self._work, self.plan, self.stresses, self.clock = work, plan, stresses, work.clock
        self._mesh = work.own_mesh(plan.drawn)

    @cached_property
    def finer(self) -> "FollowingMesh":
        """With cells for a tighter tolerance."""
        return FollowingMesh(self._work, on_finer_cells(self.plan), self.stresses)

    def warn(self, text: str) -> None:
        """What the user should know."""
        self._work.warn(text)

    def space(self, degree: int, cuts: int = 1) -> Space:
        """The space of a degree."""
        return self._work.space_of(self._mesh, degree)


class FollowedLevel:
    """A contact at one degree; see :class:`galinx.app.run.methods.ladder.Level`.

    Args:
        work: the mesh, and what is asked for.
        task: with lengths over the mesh's half-width, under the load that is wanted.
        space: of the degree.
        g: σ_XY/σ_YY.
        profile: of the punch.
        near: middle of the contact near by [m].

    Attributes:
        contact: nodal forces of the state, over that load.
        off: logarithm of the load that makes a contact of this half-width over the one that is wanted.
        centre: middle of the contact over its half-width.
        field: its displacement over N/(2μ), condensed.
        pressure: the contact's.
        factor: of the linear system, freed, with numbers of its work.
    """

    def __init__(
        self, work: FollowingMesh, task: Task, space: Space, g: float, profile: Any, near: float
    ) -> None:
        self.space, self._g, self._task, plan = space, np.array([g]), task, work.plan
        assert plan.tests
        stretch = plan.tests.stretch
        r = space.chart.surface_position(space.contact.s)
        h, unit = task.body.half_width, task.body.displacement
        shapes = profile.height(near + h * r) / unit, h * profile.slope(near + h * r) / unit
        solved = SlidingPunch(space, task.response, plan.solver, negligible(work), np.stack(shapes))  # type: ignore[arg-type]
        more = space.degree - plan.degrees[task.number]
        recovery = contact_recovery(
            space.contact.s, space.degree, space.chart, np.empty(0), tests=tests_of(plan, more)
        )
        local = FlatPunch(task.response, self._g)
        try:
            self.factor = solved.factor

            def K_I(part: Part) -> NDArray[np.float64]:
                moments = part.tested(recovery.moments)
                return from_moments(moments, local.α, local.β, stretch).K_I[0]

            self.contact, self.off, moved = _balanced(solved, self._g, K_I, h)
            self.centre = near / h + moved
            self.field = solved.fields[0].duplicate()
            self.field.zeroEntries()
            self.field.maxpy(self.contact.weights[0].tolist(), solved.fields)
        finally:
            solved.destroy()
        self._moments = self.contact.tested(recovery.moments)
        self.pressure = from_moments(self._moments, local.α + 1.0, local.β + 1.0, stretch)
        gap = min(1.0, stretch.h)
        exponents = float(local.β[0]) + 1.0, float(local.α[0]) + 1.0
        self.displacement = KinkedDisplacement(task, space, self.field, (gap, gap), exponents)
        self._gauges = StressGauges(work, task, self.displacement.at_places_of)  # type: ignore[arg-type]

    @property
    def half_width(self) -> float:
        """Of the contact that carries the load that is wanted, over the mesh's, about."""
        return float(np.exp(-self.off / GROWTH))

    def measured(self, g: NDArray, load: Any = None) -> list[Gauge]:
        """Of the one state there is."""
        σ_YY = self.pressure.σ_YY(self._task.places.X)
        return [self._of_forces(), *self._gauges.of(self._g, ONE, σ_YY)]

    def _of_forces(self) -> Gauge:
        """The pressure all over the contact, its moments over the load, and where the contact ends."""
        σ = self.pressure.σ_YY(_ACROSS)
        moments, lengths = self._moments[:, 1:6], np.array([[self.off / GROWTH, self.centre]])
        values = np.concatenate([σ, moments, lengths], axis=1)
        of_others = [2.0 + 0.0 * moments, np.ones_like(lengths)]
        # What the last functions add is largest where they are multiplied by most.
        factor = np.abs(self.pressure.factor(_ACROSS)).max(axis=1)
        ends = np.abs(self.pressure.factor(np.array([-1.0, 1.0]))).max(axis=1)
        left = self.pressure.unresolved * ends / factor
        return Gauge(INTENSITIES, values, np.concatenate([scale.of_factor(σ), *of_others], axis=1), left)

    @property
    def mirrored(self) -> bool:
        """The image of a contact is another."""
        return False

    def rounding(self, g: NDArray) -> list[float]:
        """What a solve leaves of its forces stands for the rounding of these."""
        σ_YY = self.pressure.σ_YY(self._task.places.X)
        return [self.factor.largest_residual, *self._gauges.rounding(self._g, ONE, σ_YY)]

    def release(self) -> None:
        """There is one vector only."""

    def destroy(self) -> None:
        self.field.destroy()


def _balanced(
    solved: SlidingPunch, g: NDArray, K_I: Any, half_width: float
) -> tuple[ContactStates, float, float]:
    """The state without intensities, the logarithm of its load over the wanted one, and by how much its
    middle is moved, over the half-width [m].

    Raises:
        SolveError: no load makes such a contact.
    """
    parts = solved.parts(g)
    K = np.stack([K_I(part) for part in parts], axis=1)
    loads = np.array([part.load[0] for part in parts])
    amplitudes = np.linalg.solve(np.vstack([loads, K]), np.array([-2.0, 0.0, 0.0]))
    # Over the load that it takes the punch's height is that over the wanted one times their quotient.
    _, share, slope = amplitudes.tolist()
    if not share > 0.0:
        raise SolveError(
            f"finite elements found no load for a contact of the half-width {half_width:g} m"
        )
    states = combined(g, parts, amplitudes[None])
    return states, float(-np.log(share)), slope / share
