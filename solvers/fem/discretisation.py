"""Meshes and spaces that all speeds of a plan share."""

import logging
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

from mpi4py import MPI

from galinx.clock import Clock
from galinx.meshes.kind import check_cells
from galinx.meshes.store import obtain

from ..contact.fem_plan import DOLFINX, TENSOR, FemPlan, Messages, on_finer_cells
from .dolfinx_space import DolfinxSpace
from .space import Space, distribute

#: Spaces by the assembler of their matrices.
SPACES: dict[str, type[Space]] = {TENSOR: Space, DOLFINX: DolfinxSpace}

#: Accuracy of ends over the scene's tolerance, as an error ε of an end changes stresses at a distance d
#: from it by about ε/√d; and the least accuracy, above rounding.
_OF_ENDS, _LEAST = 1e-3, 1e-11


@dataclass(eq=False)
class Discretisation:
    """Meshes and spaces for a plan; collective over the ranks that share a mesh.

    Attributes:
        plan: the finite elements' part of the plan.
        tasks: all speeds, each a :class:`galinx.solvers.contact.solution.Task`.
        stresses: words of output.quantities that request stresses of finite elements.
        progress: shows the work.
        clock: takes wall time by step.
    """

    plan: FemPlan
    tasks: Any
    stresses: frozenset[str]
    progress: Messages
    clock: Clock
    _meshes: dict[int, tuple[Any, Any]] = field(default_factory=dict, init=False)
    _spaces: dict[tuple[int, int], Space] = field(default_factory=dict, init=False)

    @property
    def comm(self) -> MPI.Comm:
        """The ranks that share a mesh."""
        return MPI.COMM_SELF if self.plan.shared_speeds else MPI.COMM_WORLD

    @cached_property
    def for_ends(self) -> "Discretisation":
        """Discretisation for the ends of contacts alone, at all speeds, without stresses."""
        plan = self.plan
        tolerance = max(_OF_ENDS * plan.tolerance, _LEAST)
        target = replace(
            plan.wanted, tolerance=tolerance, nearest=None, farthest=0.0, around=False, bends=True,
            exponent=plan.sharp,
        )  # fmt: skip
        degrees = tuple(plan.kind.degree(target, task.response.margin) for task in self.tasks)
        plan = replace(plan, wanted=target, refinement=plan.kind.refinement(target), degrees=degrees)
        return replace(self, plan=plan, stresses=frozenset())

    @cached_property
    def finer(self) -> "Discretisation":
        """Discretisation of the plan on cells for a tighter tolerance."""
        return replace(self, plan=on_finer_cells(self.plan))

    def space(self, degree: int, cuts: int = 1) -> Space:
        """The space of a degree on a mesh; speeds share it, its form and its numbering."""
        if (degree, cuts) not in self._spaces:
            with quiet_compiler():
                self._spaces[degree, cuts] = SPACES[self.plan.assembler](
                    *self.mesh(cuts), self.plan.kind.chart, degree, self.plan.form,
                    self.plan.terms, self.clock,
                )  # fmt: skip
        return self._spaces[degree, cuts]

    def mesh(self, cuts: int) -> tuple[Any, Any]:
        """The mesh with every cell cut, shared out over ranks, and its facet tags."""
        if cuts not in self._meshes:
            plan, comm, mesh = self.plan, self.comm, None
            with self.clock("mesh"):
                check_cells(plan.pattern)
                if comm.rank == 0:
                    if cuts > 1 and plan.drawn is None:  # Gmsh's copy of a cut mesh would only be large
                        mesh = plan.kind.build(plan.refinement, cuts)
                    else:  # no other run has the same that is drawn
                        mesh = plan.drawn or obtain(plan.pattern)
                self._meshes[cuts] = distribute(mesh, comm)
        return self._meshes[cuts]


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
