"""A contact with kinks at one degree, and what its error is measured on."""

from dataclasses import replace
from functools import cached_property
from math import ceil, log
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.plan.fem import FemPlan
from galinx.app.plan.task import Task
from galinx.app.run.methods.discretisation import Discretisation
from galinx.app.run.methods.gauge import Gauge, StressGauges
from galinx.app.run.methods.kinked_displacement import KinkedDisplacement
from galinx.app.run.methods.kinked_ends import Ends
from galinx.app.run.methods.punch import negligible
from galinx.meshes.kinks import with_kinks
from galinx.meshes.rings import Refinement
from galinx.postprocess.kinked_pressure import KinkedPressure, gaps_of
from galinx.postprocess.pressure import chebyshev
from galinx.postprocess.quantities.quantity import INTENSITIES
from galinx.postprocess.scale import NEAR_TIP, off_tips
from galinx.solvers.errors import SolveError
from galinx.solvers.fem.punch import SlidingPunch
from galinx.solvers.fem.space import Space
from galinx.solvers.profiles import cusp, exponent, jumps, kinks
from galinx.solvers.sie.closed_form import FlatPunch
from galinx.solvers.solution import Body

#: Most kinks in a contact, and how near to its end one may be.
_MOST, _NEXT_TO_END = 12, 0.98

#: Places under the punch at which the pressure is measured.
_ACROSS = np.cos(np.pi * (np.arange(24) + 0.5) / 24.0)

#: Rings more around a cusp of the pressure; size of the innermost cells at a kink, over the tolerance.
_AROUND_CUSP, _INNERMOST = 4, 30.0

#: Size of the innermost cells at a tip over the distance from where stresses are looked at.
_OF_TIP = 0.25

#: Weights of a single field.
ONE = np.ones((1, 1))


def places_of_kinks(body: Body, ends: Ends) -> NDArray[np.float64]:
    """Of those under the contact, over the half-width from its middle.

    Raises:
        SolveError: cells cannot be graded towards them.
    """
    at = (np.array(kinks(body.profile), dtype=float) - ends.centre) / ends.half_width
    inside = at[np.abs(at) < 1.0]
    if len(inside) > _MOST or np.abs(inside).max(initial=0.0) > _NEXT_TO_END:
        raise SolveError(
            f"the punch has {len(inside)} kinks under the contact, at {inside.round(4).tolist()} "
            f"(over the half-width); finite elements want at most {_MOST}, none within "
            f'{1.0 - _NEXT_TO_END:.2g} of an end; take methods = ["closed_form"]'
        )
    return inside


def _gentle(plan: FemPlan) -> Refinement:
    """The plan's refinement with rings no steeper than its mesh has them as a rule.

    They are steeper where cells are finer in angle, which does at ends that are free: the pressure at a
    kink is no power of the distance, and a ring that spans a fifth of it is slow to follow that.
    """
    rings, ratio = plan.refinement, plan.kind.ratio
    if rings.ratio >= ratio:
        return rings
    return replace(rings, levels=ceil(rings.levels * log(rings.ratio) / log(ratio)), ratio=ratio)


def rings_around_kinks(rings: Refinement, tolerance: float, body: Body) -> int:
    """How many more than around the ends.

    Next to a kink of the slope's derivative the pressure is d log d, and what the innermost cells make of
    it is of their size whatever the degree is. At a tip it is infinite, and looked at farther away: where
    an innermost cell reached there, no degree would resolve it, however loose the tolerance is.
    """
    if cusp(body.profile):
        return _AROUND_CUSP
    if jumps(body.profile):
        size = _OF_TIP * NEAR_TIP
    else:
        order = max((exponent(body.profile) or 2.0) - 1.0, 1.0)
        size = (_INNERMOST * tolerance) ** (1.0 / order)
    return max(0, ceil(log(size) / log(rings.ratio)) - rings.levels)


class OwnMeshes:
    """Spaces on the mesh of one state, see :class:`Discretisation`.

    Args:
        work: of all states.
        places: of the kinks over the half-width.
        body: what slides over what.

    Attributes:
        plan: of all states.
    """

    def __init__(self, work: Discretisation, places: NDArray, body: Body) -> None:
        self._work, self._places, self._body, self.plan = work, places, body, work.plan
        rings = _gentle(work.plan)
        more = rings_around_kinks(rings, work.plan.tolerance, body)
        self._mesh = work.own_mesh(with_kinks(rings, places, more))

    @cached_property
    def finer(self) -> "OwnMeshes":
        """With cells for a tighter tolerance."""
        return OwnMeshes(self._work.finer, self._places, self._body)

    def warn(self, text: str) -> None:
        """What the user should know."""
        self._work.warn(text)

    def space(self, degree: int, cuts: int = 1) -> Space:
        """The space of a degree."""
        return self._work.space_of(self._mesh, degree)


class KinkedLevel:
    """A contact at one degree; see :class:`galinx.app.run.methods.ladder.Level`.

    Args:
        work: knows what is asked for.
        task: the speed, and the load.
        space: of the degree, on cells graded towards the kinks.
        places: of these over the half-width.
        ends: of the contact.
        g: σ_XY/σ_YY.

    Attributes:
        contact: nodal forces of the state.
        field: its displacement over N/(2μ), condensed.
        displacement: what is read off that.
        pressure: the contact's.
        kinks: places at which it is finite for all that.
        factor: of the linear system, freed, with numbers of its work.
    """

    def __init__(
        self, work: Discretisation, task: Task, space: Space, places: NDArray, ends: Ends, g: float
    ) -> None:
        self.space, self._g = space, np.array([g])
        r = space.chart.surface_position(space.contact.s)
        body = task.body
        height = body.profile.height(ends.centre + ends.half_width * r) / body.displacement
        least = negligible(work)
        punch = SlidingPunch(space, task.response, work.plan.solver, least, height)
        try:
            self.factor, self.contact = punch.factor, punch.states(self._g)
            self.field = punch.fields[0].duplicate()
            self.field.zeroEntries()
            self.field.maxpy(self.contact.weights[0].tolist(), punch.fields)
        finally:
            punch.destroy()
        self._moments = self.contact.normal @ chebyshev(r)[:, 1:6]
        local = FlatPunch(task.response, self._g)
        exponents = float(local.β[0]) + 1.0, float(local.α[0]) + 1.0
        self.pressure = KinkedPressure(
            space.contact.s, space.degree, space.chart, self.contact.normal[0], places, exponents,
            cusp(body.profile),
        )  # fmt: skip
        tips = places if jumps(body.profile) else np.empty(0)
        self.kinks = places if not len(tips) else np.empty(0)
        self._task, self._across = _off(task, tips), _ACROSS[off_tips(_ACROSS, tips)]
        self.displacement = KinkedDisplacement(task, space, self.field, gaps_of(places), exponents)
        self._gauges = StressGauges(work, self._task, self.displacement.at_places_of)

    def measured(self, g: NDArray, load: Any = None) -> list[Gauge]:
        """Of the one state there is."""
        return [self._of_forces(), *self._gauges.of(self._g, ONE, self._on_surface())]

    @property
    def mirrored(self) -> bool:
        """The image of the kinks has another mesh."""
        return False

    def rounding(self, g: NDArray) -> list[float]:
        """What a solve leaves of its forces stands for the rounding of these."""
        return [
            self.factor.largest_residual,
            *self._gauges.rounding(self._g, ONE, self._on_surface()),
        ]

    def release(self) -> None:
        """There is one vector only."""

    def destroy(self) -> None:
        self.field.destroy()

    def _on_surface(self) -> NDArray[np.float64]:
        return self.pressure.σ_YY(self._task.places.X)[None]

    def _of_forces(self) -> Gauge:
        """Moments of the pressure over the load, and the pressure over its largest."""
        σ = self.pressure.σ_YY(self._across)[None]
        values = np.concatenate([self._moments, σ], axis=1)
        scale = np.concatenate([2.0 + 0.0 * self._moments, np.abs(σ).max() + 0.0 * σ], axis=1)
        return Gauge(INTENSITIES, values, scale)


def _off(task: Task, tips: NDArray) -> Task:
    """The task without places next to tips, where stresses are infinite."""
    places = task.places
    X, points, around = places.X, places.points, places.around
    return replace(
        task,
        places=replace(
            places,
            X=X[off_tips(X, tips)],
            points=points[off_tips(points[:, 0], tips, points[:, 1])],
            around=around[off_tips(around[:, 0], tips, around[:, 1])],
        ),
    )
