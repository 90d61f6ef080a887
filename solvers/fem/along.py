"""Flat punch with friction that varies along the contact, on the mesh of all contacts.

With R the normal reactions of the contact nodes, R₀ those without friction, and T R the normal reactions
that tangential forces R cause, friction requires

    (I - T G) R = R₀,

where G takes the normal forces to the tangential ones: through the contact's mass matrix to σ_YY, which
times g(X) is σ_XY. Every state is solved by dense algebra; the tangential forces of all states span the
loads whose displacements are solved for.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..contact.along import Recovered
from ..contact.recovery import ContactFacets
from ..contact.solution import Task
from .contact import PunchLevel, SharpEnds, SolvedEnds
from .discretisation import Discretisation
from .punch import LEAST, Part, SlidingPunch
from .space import Space


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
        #: Tangential forces of a state by its number, (n,).
        self._tangential_forces: dict[float, NDArray[np.float64]] = {}

    def prepare(self, g: NDArray[np.float64]) -> None:
        (space,) = self._spaces
        T, R0 = self._of_nodes[:, 1].T, space.forces[0, 1]
        for value in g.tolist():
            G = self._facets.product(self._body.along[value])
            self._tangential_forces[value] = G @ np.linalg.solve(np.eye(len(T)) - T @ G, R0)
        loads, size, _ = np.linalg.svd(np.transpose([*self._tangential_forces.values()]), full_matrices=False)
        space.load_by(loads[:, size > LEAST * size[0]])
        rough = self._displacements(self._tangential(space.waiting))
        space.take(rough, np.array([self._boundary.follow(force) for force in self._reactions(rough)]))
        self._settle(space)
        space.complete = True

    def parts(self, g: NDArray[np.float64], shapes: int | None = None) -> list[Part]:
        (space,) = self._spaces
        loads = np.array([self._tangential_forces[value] for value in g.tolist()])
        return [Part(np.column_stack([np.ones(len(g)), loads @ space.loads]), space.forces)]


class VaryingEnds(SharpEnds):
    """Sharp edges of a flat punch with friction that varies along the contact."""

    def pressure(self, level: PunchLevel, ends: SolvedEnds) -> Recovered:
        body: Any = level.task.body
        moments = ends.contact.tested(level.moments)
        return Recovered.of(level.task.response, [body.along[g] for g in ends.contact.g.tolist()], moments)


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
