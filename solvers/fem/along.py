"""Flat punch with friction that varies along the contact, on the mesh of all contacts.

With R the normal reactions of the contact nodes, R₀ those without friction, and T R the normal reactions
that tangential forces R cause, friction requires

    (I - T G) R = R₀,

where G takes the normal forces to the tangential ones t = G R: through the contact's mass matrix to σ_YY,
which times g(X) is σ_XY. All states share loads t; what they leave of the equation of a state is the next
load, as in GMRES.
"""

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..contact.along import Splines
from ..contact.pressure import ENDS, Expansion
from ..contact.recovery import ContactFacets
from ..contact.solution import Task
from .contact import PunchLevel, SharpEnds, SolvedEnds
from .discretisation import Discretisation
from .ladder import Gauge
from .punch import LEAST, ContactStates, Part, SlidingPunch
from .solution import SolvedStates
from .space import Space

#: States whose equations are in memory at a time.
_TOGETHER = 33
#: Distance from an end or a kink within which the pressure without its weight has no knots, over the root
#: of the length in which friction varies: nearer, innermost cells are not sure. That from which on it has
#: four in a cell, over that length; degree of the cells less that of its splines; places in a cell.
_NEXT, _WIDE, _LESS, _INSIDE = 1e-5, 1e-2, 2, np.array([0.25, 0.5, 0.75])


class VaryingPunch(SlidingPunch):
    """All states of a flat punch with friction that varies along the contact, at one speed.

    Args:
        body: the contact, with its friction.
        *sliding: as of :class:`galinx.solvers.fem.punch.SlidingPunch`.
    """

    def __init__(self, body: Any, *sliding: Any) -> None:
        super().__init__(*sliding)
        nodes, chart = self.space.contact, self.space.chart
        self._body, self._facets = body, ContactFacets(nodes.s, self.space.degree, chart)
        #: Coefficients of the loads of each state, by its number.
        self._of_states: dict[float, NDArray[np.float64]] = {}

    def prepare(self, g: NDArray[np.float64]) -> None:
        (space,) = self._spaces
        space.load_by(np.empty((len(self.space.contact.s), 0)))
        for first in range(0, len(g), _TOGETHER):
            some = g[first : first + _TOGETHER].tolist()
            products = [self._facets.product(self._body.along[value]) for value in some]
            while True:
                left = np.transpose([self._solved(G)[1] for G in products])
                more = space.beside(left[:, np.linalg.norm(left, axis=0) > max(self._left, 10.0 * LEAST)])
                if not more.shape[1]:
                    break
                space.load_by(np.column_stack([space.loads, more]))
                rough = self._displacements(self._tangential(more))
                forces = [self._boundary.follow(force) for force in self._reactions(rough)]
                space.take(rough, np.array(forces))
        self._settle(space)
        for value in g.tolist():
            self._of_states[value] = self._solved(self._facets.product(self._body.along[value]))[0]
        space.complete = True

    def _solved(self, G: NDArray) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Coefficients of the loads in t = G R, and what they leave of it, over G R₀."""
        (space,) = self._spaces
        A, b = space.loads - G @ space.forces[1:, 1].T, G @ space.forces[0, 1]
        y, *_ = np.linalg.lstsq(A, b, rcond=None)
        return y, (b - A @ y) / max(float(np.linalg.norm(b)), np.finfo(float).tiny)

    def parts(self, g: NDArray[np.float64], shapes: int | None = None) -> list[Part]:
        (space,) = self._spaces
        loads = np.array([self._of_states[value] for value in g.tolist()])
        return [Part(np.column_stack([np.ones(len(g)), loads]), space.forces)]


class VaryingEnds(SharpEnds):
    """Sharp edges of a flat punch with friction that varies along the contact."""

    def pressure(self, level: PunchLevel, ends: SolvedEnds) -> Expansion:
        return self._pressure(level, ends.contact, _NEXT)

    def gauge(self, level: PunchLevel, states: SolvedStates) -> Gauge:
        gauge, coarse = super().gauge(level, states), self._pressure(level, states.contact, 4.0 * _NEXT)
        # Without knots next to ends and kinks, splines of all degrees are off alike.
        off = np.abs(coarse.series(ENDS) / states.pressure.series(ENDS) - 1.0).max(axis=1)
        return replace(gauge, unresolved=gauge.unresolved + off)

    def _pressure(self, level: PunchLevel, contact: ContactStates, nearest: float) -> Expansion:
        """Pressure of contacts, by splines without knots within a distance of ends and kinks."""
        body, g, degree = level.task.body, contact.g, level.space.degree
        kinks = np.array(body.friction_kinks)
        places = np.concatenate([[-1.0], kinks, [1.0]])
        ends_of_cells = level.r[::degree]
        ratio = body.ratio(g, ends_of_cells)
        steepest = np.abs(np.diff(ratio) / np.diff(ends_of_cells)).max(axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            length = np.nanmin(np.append(np.ptp(ratio, axis=1) / steepest, 1.0))
        of_knots = [places]
        within = (ends_of_cells[:-1, None] + np.diff(ends_of_cells)[:, None] * _INSIDE).ravel()
        for some, least in ((ends_of_cells, nearest * np.sqrt(length)), (within, _WIDE * length)):
            of_knots.append(some[np.abs(some[:, None] - places).min(axis=1) > least])
        knots = np.unique(np.concatenate(of_knots))
        # Of a degree that rises with that of the cells, so that changes show what splines do not follow.
        splines = Splines(tuple(knots.tolist()), tuple(kinks.tolist()), degree - _LESS)
        local, at_nodes = body.edges(level.task.response, g), splines.values(level.r)
        # Nodal forces know of tests their interpolants only.
        facets = ContactFacets(level.space.contact.s, degree, level.space.chart)
        return splines.fitted(
            contact.tested(at_nodes), local.α, local.β,
            lambda r: facets.interpolated(at_nodes.T, r).T,
        )  # fmt: skip


class VaryingLevel(PunchLevel):
    """Punch at one degree, and the maps from its contact forces to its pressure."""

    mirrored = False  # type: ignore[assignment]

    def __init__(self, work: Discretisation, task: Task, space: Space, g: NDArray) -> None:
        super().__init__(work, task, space, g, ends=VaryingEnds())

    def sliding(self, *punch: Any) -> VaryingPunch:
        return VaryingPunch(self.task.body, *punch)

    def rounding(self, g: NDArray, load: Any = None) -> list[float]:
        """Effect of rounding on each gauge, relative: what the solve leaves of its forces."""
        own = self.fields_of(self.states(g, load))
        return [self.factor.largest_residual, *self.stress_gauges.rounding(*own)]
