"""Rigid punch with friction and two sharp edges on the finite element half-plane, its pressure unknown.

Trial functions have v = -v₀ + P on the contact nodes, test functions w_Y + g w_X = 0 there. Nodal
reactions are then the consistent contact forces and no penalty or multiplier is met. With the normal
displacement held and the tangential free, the matrix is symmetric and does not know g: if T r are
the normal reactions caused by tangential forces r, friction asks for

    (I - g T) R = R₀.

The Krylov space of (T, R₀) serves every g at that speed; a profile P that is not flat has one of its own.
For few nodes T is there as a matrix.
Of a contact whose ends are found P is a combination of some shapes, each with a space of its own.
"""

from collections.abc import Sequence

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray
from petsc4py import PETSc

from galinx.solvers.fem.direct import Factor
from galinx.solvers.fem.far import FarBoundary
from galinx.solvers.fem.held import forces_of_profile, ones, product, set_zero
from galinx.solvers.fem.krylov import KrylovSpace
from galinx.solvers.fem.multigrid import Multigrid
from galinx.solvers.fem.space import Space
from galinx.solvers.fem.states import Part, Punch
from galinx.solvers.solids.solid import Response

#: Frictions for which a basis is completed at most.
_SPREAD = 33

#: Nodes of a contact up to which loads at all of them at once cost less than one after the other.
_FEW_NODES = 64


class SlidingPunch(Punch):
    """All friction states of the punch at one speed, from one factorisation.

    Args:
        space: the finite element space.
        response: of the half-plane, at a speed below its limit.
        solver: of linear systems: ``"direct"``, ``"boomeramg"``, ``"gamg"`` or ``"multigrid"``.
        negligible: relative change of the contact forces that needs no refinement of a solution. The
            first solution is refined in any case and tells what that does to the others.
        heights: of the punch's profile over N/(2μ) at the contact nodes, (nodes,), or of several shapes
            that are combined, (shapes, nodes); None for a flat punch.
        left: relative residual of the contact forces that friction may leave.
    """

    def __init__(
        self,
        space: Space,
        response: Response,
        solver: str = "direct",
        negligible: float = 0.0,
        heights: NDArray[np.float64] | None = None,
        left: float = 0.0,
    ) -> None:
        self.space, self.response, self._left = space, response, left
        nodes = space.contact
        A = space.assemble(response)
        comm = A.comm
        self._rows = [
            A.createSubMatrix(PETSc.IS().createGeneral(nodes.dofs(i), comm=comm)) for i in (0, 1)
        ]
        self._motions = [ones(A, space.node_dofs[i::2]) for i in (0, 1)]
        #: Forces that a motion of the far boundary alone causes.
        self._far = [product(A, ones(A, space.numbers[space.far_nodes] + i)) for i in (0, 1)]
        flat = np.full(len(nodes.s), -1.0)
        shapes = [flat, *([] if heights is None else np.atleast_2d(heights))]
        shaped = [forces_of_profile(A, space, height) for height in shapes]
        self._boundary = FarBoundary(space, response, A)
        A = space.held(A, response, ("contact", "far"))
        self.factor: Factor | Multigrid
        if solver == "direct":
            self.factor = Factor(A, space.clock, definite=not space.mixed)
        else:
            self.factor = Multigrid(A, space.clock, solver, space.rigid_motions(response))
        self._nodal: tuple[NDArray, NDArray] | None = None
        self._take_boundary()
        #: Of the flat punch, and of each shape.
        self._spaces = self._krylov_spaces(shaped, negligible)

    @property
    def fields(self) -> list[PETSc.Vec]:
        """Displacements of the basis: the punches without friction, each before its tangential loads."""
        return [field for space in self._spaces for field in space.fields]

    def prepare(self, g: NDArray[np.float64]) -> None:
        """Complete the basis for these values of σ_XY/σ_YY, sorted.

        What the basis leaves is a smooth function of them, so that some spread over all stand for them.
        """
        some = np.unique(np.linspace(0, len(g) - 1, _SPREAD).astype(int))
        self._contact_forces(self._spaces, g[some])

    def parts(self, g: NDArray[np.float64], shapes: int | None = None) -> list[Part]:
        wanted = self._spaces[: None if shapes is None else 1 + shapes]
        return [self._of(space, g, y) for space, y in zip(wanted, self._contact_forces(wanted, g))]

    def _of(self, space: KrylovSpace, g: NDArray, y: NDArray) -> Part:
        """What a Krylov space makes of friction, by the coefficients of the contact forces."""
        weights = np.zeros((len(g), len(space.fields)))
        weights[:, 0] = 1.0
        weights[:, 1 : 1 + y.shape[1]] = g[:, None] * y
        return Part(weights, np.array(space.forces))

    def release(self) -> None:
        for space in self._spaces:
            space.complete = True
        self.destroy()

    def destroy(self) -> None:
        self._nodal = None
        for held in (self.factor, self._boundary, *self._rows, *self._motions, *self._far, *self.fields):
            held.destroy()

    def _take_boundary(self) -> None:
        """Solve for a far boundary that moves."""
        loads, contact = self._boundary.loads, self.space.contact
        if loads:
            fields = self._displacements(loads)
            # Moments after the resultants are felt too little to need that.
            self._refine(fields[:2], loads[:2], [0.0, 0.0])
            self._boundary.found(fields)
            X = self.space.chart.surface_position(contact.s)
            self._boundary.take(X, [self._reactions(field) for field in fields])

    def _krylov_spaces(self, forces: list[PETSc.Vec], negligible: float) -> list[KrylovSpace]:
        """Those of punches without friction: of the flat one at v = -1, and of shapes.

        Args:
            forces: of what is held; they are no longer needed afterwards.
            negligible: see the class.
        """
        fields = self._displacements(forces)
        rough = [self._reactions(field) for field in fields]
        # Under the flat punch all of the contact moves alike, and no other load acts.
        self._refine(fields, [None, *forces[1:]], [-1.0] + [0.0] * (len(forces) - 1))
        spaces = []
        for field, before, b in zip(fields, rough, forces):
            after = self._reactions(field)
            change = np.linalg.norm(after - before) / np.linalg.norm(before)
            after = self._boundary.follow(field, after)
            spaces.append(KrylovSpace(field, after, bool(change > negligible), self._left))
            b.destroy()
        return spaces

    def _contact_forces(
        self, spaces: Sequence[KrylovSpace], g: NDArray[np.float64]
    ) -> list[NDArray[np.float64]]:
        """Coefficients y of R = V y for every g, (states, m), in each Krylov space.

        The spaces grow as they need, those that do together: one pass over the factor serves them.
        """
        if not np.any(g):
            return [np.zeros((len(g), 0)) for _ in spaces]
        found: list[NDArray | None] = [None for _ in spaces]
        while True:
            for i, space in enumerate(spaces):
                if found[i] is None:
                    found[i] = space.converged(g)
            short = [space for space, y in zip(spaces, found) if y is None]
            if not short:
                return [y for y in found if y is not None]
            self._extend(short)

    def _extend(self, spaces: Sequence[KrylovSpace]) -> None:
        """The displacement and the forces of one more tangential load of each."""
        if len(self.space.contact.s) <= _FEW_NODES and isinstance(self.factor, Factor):
            fields, forces = self._of_nodes(any(space.refines for space in self._spaces))
            for space in spaces:
                field = self.factor.A.createVecRight()
                field.setArray(fields @ space.last)
                space.take(field, forces @ space.last)
            return
        loads = self._tangential([space.last for space in spaces])
        solved, reactions = self._answers(loads, [space.refines for space in spaces])
        for space, field, of_field in zip(spaces, solved, reactions):
            space.take(field, of_field)

    def _of_nodes(self, refines: bool) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Displacements (rows, n) and forces (2, n, n) that a tangential load at each node causes."""
        if self._nodal is None:
            n = len(self.space.contact.s)
            found, forces = self._answers(self._tangential(list(np.eye(n))), [refines] * n)
            of_nodes = np.moveaxis(np.array(forces), 0, 2)
            self._nodal = np.array([field.array_r for field in found]).T, of_nodes
            for field in found:
                field.destroy()
        return self._nodal

    def _answers(
        self, loads: Sequence[PETSc.Vec], refines: Sequence[bool]
    ) -> tuple[list[PETSc.Vec], list[NDArray[np.float64]]]:
        """Displacements that loads cause, refined where that is wanted, and forces; frees the loads."""
        found = self._displacements(loads)
        refined = [i for i, wanted in enumerate(refines) if wanted]
        self._refine([found[i] for i in refined], [loads[i] for i in refined], [0.0] * len(refined))
        for b in loads:
            b.destroy()
        return found, [self._boundary.follow(field, self._reactions(field)) for field in found]

    def _tangential(self, forces: Sequence[NDArray]) -> list[PETSc.Vec]:
        """Loads of tangential forces at the contact nodes, (n,) each."""
        nodes, loads = self.space.contact, []
        for force in forces:
            b = self.factor.A.createVecLeft()
            b.setValues(nodes.dofs(0), force[nodes.owned])
            b.assemble()
            loads.append(b)
        return loads

    def _displacements(self, forces: Sequence[PETSc.Vec]) -> list[PETSc.Vec]:
        """The displacements for nodal forces, with what the held displacements cause."""
        fields, held = self.factor.solve_all(forces), self.space.held_dofs
        for u, b in zip(fields, forces):
            u.setValues(held, b.getValues(held))  # an iterative solver only comes near them
            u.assemble()
        return fields

    def _refine(
        self, fields: Sequence[PETSc.Vec], loads: Sequence[PETSc.Vec | None], v: Sequence[float]
    ) -> None:
        """Solve once more for what displacements leave of their forces.

        The contact moves far before the body deforms, the farther the nearer the Rayleigh speed, and what
        forces that motion seems to need is rounding. The residual is taken without it: what is left of
        the displacement is zero under a flat punch, and the far boundary moves instead.

        Args:
            fields: the displacements, in place.
            loads: nodal forces, those of a profile's held displacements among them.
            v: normal displacement of the contact where all of it moves alike.
        """
        left = [self._residual(*of_one) for of_one in zip(fields, loads, v)]
        wrong = [(u, residual) for u, residual in zip(fields, left) if residual.norm() > 0.0]
        if wrong:
            for (u, _), correction in zip(wrong, self.factor.solve_all([b for _, b in wrong])):
                u.axpy(1.0, correction)
                correction.destroy()
        for residual in left:
            residual.destroy()

    def _residual(self, u: PETSc.Vec, load: PETSc.Vec | None, v: float) -> PETSc.Vec:
        """What a displacement leaves of its forces, see :meth:`_refine`."""
        held = self.space.held_dofs
        t = (self._contact_motion(u)[0], v)
        w = self._without(u, t)
        set_zero(w, held)
        residual = product(self.factor.A, w)
        residual.scale(-1.0)
        if load:
            residual.axpy(1.0, load)
        residual.maxpy(t, self._far)
        set_zero(residual, held)
        w.destroy()
        return residual

    def _contact_motion(self, u: PETSc.Vec) -> tuple[float, float]:
        """Mean displacement of the contact nodes."""
        nodes, comm = self.space.contact, self.space.comm
        total = np.array([u.getValues(nodes.dofs(i)).sum() for i in (0, 1)])
        comm.Allreduce(MPI.IN_PLACE, total)
        return tuple((total / len(nodes.s)).tolist())

    def _without(self, u: PETSc.Vec, t: tuple[float, float]) -> PETSc.Vec:
        """u less the motion t of the whole body."""
        w = u.copy()
        w.maxpy((-t[0], -t[1]), self._motions)
        return w

    def _reactions(self, u: PETSc.Vec) -> NDArray[np.float64]:
        """Consistent forces in X and Y at the contact nodes, (2, n), the same on every rank."""
        nodes, comm = self.space.contact, self.space.comm
        found = np.zeros((2, len(nodes.s)))
        w = self._without(u, self._contact_motion(u))
        for i, rows in enumerate(self._rows):
            force = rows.createVecLeft()
            rows.mult(w, force)
            found[i, nodes.owned] = force.array_r
            force.destroy()
        w.destroy()
        comm.Allreduce(MPI.IN_PLACE, found)
        return found
