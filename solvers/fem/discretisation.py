"""Meshes and spaces that all speeds of a plan share."""

import logging
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import cached_property
from typing import Any

from mpi4py import MPI

from galinx.clock import Clock
from galinx.meshes.kind import check_cells
from galinx.meshes.rings import TAGS
from galinx.meshes.store import obtain

from ..contact import AT_INTERFACES, BELOW, FEM, ON_SURFACE, YIELD
from ..contact.fem_plan import DOLFINX, TENSOR, FemPlan, Messages, Planned, with_friction_kinks
from .dolfinx_space import DolfinxSpace
from .space import Space, distribute

#: Spaces by the assembler of their matrices.
SPACES: dict[str, type[Space]] = {TENSOR: Space, DOLFINX: DolfinxSpace}

#: Accuracy of ends over the scene's tolerance, as an error ε of an end changes stresses at a distance d
#: from it by about ε/√d; and the least accuracy, above rounding.
_OF_ENDS, _LEAST = 1e-3, 1e-11

#: Tolerance over the scene's of the finer cells, tried where no degree reaches the scene's tolerance.
_FINER = 0.03


class Discretisation:
    """Meshes and spaces for a plan; collective over the ranks that share a mesh.

    Args:
        plan: the plan, with finite elements.
        progress: shows the work.
        clock: takes wall time by step.

    Attributes:
        plan: the finite elements' part of the plan.
        stresses: words of output.quantities that request stresses of finite elements.
        comm: the ranks that share a mesh.
    """

    def __init__(self, plan: Planned, progress: Messages, clock: Clock) -> None:
        assert plan.fem
        self._whole: Any = plan
        self.plan = plan.fem
        self.clock = clock
        words = (ON_SURFACE, BELOW, YIELD, AT_INTERFACES)
        self.stresses = frozenset(word for word in words if plan.asks(word, FEM))
        self.comm = MPI.COMM_SELF if plan.fem.shared_speeds else MPI.COMM_WORLD
        self._progress = progress
        self._refine: Callable[[FemPlan], FemPlan] = on_finer_cells
        self._meshes: dict[int, tuple[Any, Any]] = {}
        self._spaces: dict[tuple[int, int], Space] = {}

    def on(
        self, plan: FemPlan, stresses: frozenset[str] | None = None,
        refine: Callable[[FemPlan], FemPlan] | None = None,
    ) -> "Discretisation":  # fmt: skip
        """Discretisation for another plan of the mesh.

        Args:
            plan: the plan.
            stresses: words of output.quantities that request stresses, these if None.
            refine: gives the plan with finer cells; :func:`on_finer_cells` if None.
        """
        other = Discretisation(replace(self._whole, fem=plan), self._progress, self.clock)
        other.stresses = self.stresses if stresses is None else stresses
        other._refine = refine or on_finer_cells
        return other

    @cached_property
    def for_ends(self) -> "Discretisation":
        """Discretisation for the ends of contacts alone, at all speeds, without stresses."""
        plan = self.plan
        tolerance = max(_OF_ENDS * plan.tolerance, _LEAST)
        target = replace(
            plan.wanted, tolerance=tolerance, nearest=None, farthest=0.0, around=False, bends=True,
            exponent=plan.sharp,
        )  # fmt: skip
        degrees = tuple(plan.kind.degree(target, task.response.margin) for task in self._whole.tasks)
        refinement = plan.kind.refinement(target)
        return self.on(replace(plan, wanted=target, refinement=refinement, degrees=degrees), frozenset())

    @cached_property
    def finer(self) -> "Discretisation":
        """Discretisation of the plan on cells for a tighter tolerance."""
        return self.on(self._refine(self.plan), refine=self._refine)

    def warn(self, text: str) -> None:
        """Warn the user."""
        self._progress.warn(text)

    def space(self, degree: int, cuts: int = 1) -> Space:
        """The space of a degree on a mesh; speeds share it, its form and its numbering."""
        if (degree, cuts) not in self._spaces:
            self._spaces[degree, cuts] = self.space_of(self.mesh(cuts), degree)
        return self._spaces[degree, cuts]

    def space_of(self, mesh: tuple[Any, Any], degree: int) -> Space:
        """The space of a degree on a mesh with its facet tags, shared out over ranks."""
        with quiet_compiler():
            return SPACES[self.plan.assembler](
                *mesh, TAGS, self.plan.kind.chart, degree, self.plan.form, self.plan.terms,
                self.clock,
            )  # fmt: skip

    def mesh(self, cuts: int) -> tuple[Any, Any]:
        """The mesh with every cell cut, shared out over ranks, and its facet tags."""
        if cuts not in self._meshes:
            with self.clock("mesh"):
                self._meshes[cuts] = self._made(cuts)
        return self._meshes[cuts]

    def _made(self, cuts: int) -> tuple[Any, Any]:
        plan, comm = self.plan, self.comm
        check_cells(plan.pattern)
        if comm.rank:
            return distribute(None, comm)
        if plan.drawn is not None:  # no other run has the same
            return distribute(plan.pattern, comm)
        if cuts > 1:  # Gmsh's copy of a cut mesh would only be large
            return distribute(plan.kind.build(plan.refinement, cuts), comm)
        return distribute(obtain(plan.pattern), comm)


def on_finer_cells(plan: FemPlan) -> FemPlan:
    """Plan with cells for a tighter tolerance, and twice as many of them in angle and in distance."""
    kind, target = plan.kind, replace(plan.wanted, tolerance=_FINER * plan.tolerance)
    if drawn := kind.drawn(target):
        return replace(plan, wanted=target, drawn=drawn)
    rings = kind.refinement(target)
    columns = tuple(width / 2.0 for width in rings.columns for _ in range(2))
    refinement = replace(
        rings, levels=2 * rings.levels, ratio=rings.ratio**0.5, sectors=2 * rings.sectors, columns=columns
    )
    plan = replace(plan, wanted=target, refinement=refinement)
    if not plan.kinks:
        return plan
    return replace(plan, drawn=with_friction_kinks(refinement, plan.kinks, target.tolerance))


@contextmanager
def quiet_compiler() -> Iterator[None]:
    """Silence FFCx's build tools, which announce compilations on a root logger whose level they set."""
    disabled, warnings = logging.root.manager.disable, logging.getLogger("py.warnings")
    level = warnings.level
    logging.disable(logging.INFO)
    warnings.setLevel(logging.ERROR)
    try:
        yield
    finally:
        logging.disable(disabled)
        warnings.setLevel(level)
