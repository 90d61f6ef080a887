"""Rigid flat punch with friction on the finite element half-plane: the pressure is an unknown.

Trial functions have v = -v₀ on the contact nodes, test functions w_Y + g w_X = 0 there. Nodal reactions
are then the consistent contact forces and no penalty or multiplier is met. With the normal
displacement held and the tangential free, the matrix is symmetric and does not know g: if T r are
the normal reactions caused by tangential forces r, friction asks for

    (I - g T) R = R₀.

The Krylov space of (T, R₀) serves every g at that speed.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from petsc4py import PETSc

from galinx.solvers.errors import SolveError
from galinx.solvers.fem.direct import Factor
from galinx.solvers.fem.multigrid import Multigrid
from galinx.solvers.fem.space import Space
from galinx.solvers.solids.solid import Response

#: Contact forces are found to this relative residual; the last digits are rounding.
KRYLOV_TOLERANCE = 1e-13
KRYLOV_LIMIT = 120


@dataclass(frozen=True)
class ContactStates:
    """Several friction states; lengths over a, stresses over N/(2a), so forces over N/2.

    Attributes:
        g: σ_XY/σ_YY under the punch, (states,).
        weights: of the basis fields, (states, fields).
        normal: consistent nodal forces of σ_YY at the contact nodes, (states, nodes).
        tangential: the same of σ_XY, read off the assembled equations.
        v0: indentation relative to the far boundary over N/(2μ), (states,).
    """

    g: NDArray[np.float64]
    weights: NDArray[np.float64]
    normal: NDArray[np.float64]
    tangential: NDArray[np.float64]
    v0: NDArray[np.float64]


class SlidingPunch:
    """All friction states of the punch at one speed, from one factorisation.

    Args:
        space: the finite element space.
        response: of the half-plane, at a speed below its limit.
        solver: of linear systems: ``"direct"``, ``"boomeramg"``, ``"gamg"`` or ``"multigrid"``.
        negligible: relative change of the contact forces that needs no refinement of a solution. The
            first solution is refined in any case and tells what that does to the others.
    """

    def __init__(
        self, space: Space, response: Response, solver: str = "direct", negligible: float = 0.0
    ) -> None:
        self.space, self.response = space, response
        nodes = space.contact
        A = space.assemble(response)
        comm = A.comm
        self._rows = [
            A.createSubMatrix(PETSc.IS().createGeneral(nodes.dofs(i), comm=comm)) for i in (0, 1)
        ]
        self._motions = [_ones(A, space.node_dofs[i::2]) for i in (0, 1)]
        #: Forces that a motion of the far boundary alone causes.
        self._far = [_product(A, _ones(A, space.far_dofs[space.far_dofs % 2 == i])) for i in (0, 1)]
        b = hold(A, space)
        self.factor: Factor | Multigrid
        if solver == "direct":
            self.factor = Factor(A, space.clock, definite=not space.mixed)
        else:
            self.factor = Multigrid(A, space.clock, solver, space.rigid_motions)
        #: Displacements of the basis: first the frictionless punch, then the tangential loads.
        self.fields = [self._displacement(b)]
        rough = self._reactions(self.fields[0])
        self._refine(self.fields[0], None, -1.0)
        self._forces = [self._reactions(self.fields[0])]
        change = np.linalg.norm(self._forces[0] - rough) / np.linalg.norm(rough)
        self._refines = change > negligible
        R0 = self._forces[0][1]
        self._size = np.linalg.norm(R0)
        self._V = [R0 / self._size]
        self._H = np.zeros((KRYLOV_LIMIT + 1, KRYLOV_LIMIT))
        self._complete = False
        b.destroy()

    def states(self, g: ArrayLike) -> ContactStates:
        """The states with σ_XY = g σ_YY under the punch and the load ∫σ_YY = -N."""
        g = np.atleast_1d(np.asarray(g, dtype=float))
        y = self._contact_forces(g)
        weights = np.zeros((len(g), len(self.fields)))
        weights[:, 0] = 1.0
        weights[:, 1 : 1 + y.shape[1]] = g[:, None] * y
        tangential, normal = np.einsum("sk,kin->isn", weights, np.array(self._forces))
        v0 = -2.0 / normal.sum(axis=1)  # ∫ σ_YY d(X/a) = -2 over N/(2a)
        scale = v0[:, None]
        return ContactStates(g, scale * weights, scale * normal, scale * tangential, v0)

    def release(self) -> None:
        """Free factor and fields; states that were asked for before can be asked for again."""
        self._complete = True
        self.destroy()

    def destroy(self) -> None:
        """Free factor and fields."""
        for held in (self.factor, *self._rows, *self._motions, *self._far, *self.fields):
            held.destroy()

    def _contact_forces(self, g: NDArray[np.float64]) -> NDArray[np.float64]:
        """Coefficients y of R = V y for every g, (states, m); the Krylov space grows as they need."""
        if not np.any(g):
            return np.zeros((len(g), 0))
        while True:
            m = len(self.fields) - 1
            if m:
                e1 = np.zeros((1, m, 1))
                e1[:, 0] = self._size
                y = np.linalg.solve(np.eye(m) - g[:, None, None] * self._H[:m, :m], e1)[..., 0]
                left = np.abs(g * self._H[m, m - 1] * y[:, -1]) / np.linalg.norm(y, axis=1)
                worst = int(np.argmax(left))
                if self._complete or left[worst] <= KRYLOV_TOLERANCE:
                    return y
            if m == KRYLOV_LIMIT:
                raise SolveError(
                    f"the contact forces at g = {g[worst]:g} (dimensionless) did not converge in "
                    f"{KRYLOV_LIMIT} steps: residual {left[worst]:.3g}, wanted {KRYLOV_TOLERANCE:g}"
                )
            self._extend()

    def _extend(self) -> None:
        """One Arnoldi step."""
        j = len(self.fields) - 1
        nodes = self.space.contact
        b = self.factor.A.createVecLeft()
        b.setValues(nodes.dofs(0), self._V[j][nodes.owned])
        b.assemble()
        self.fields.append(self._displacement(b))
        if self._refines:
            self._refine(self.fields[-1], b, 0.0)
        b.destroy()
        self._forces.append(self._reactions(self.fields[-1]))
        w = self._forces[-1][1]
        for _ in range(2):  # twice is enough
            h = np.array(self._V) @ w
            self._H[: j + 1, j] += h
            w = w - np.array(self._V).T @ h
        self._H[j + 1, j] = np.linalg.norm(w)
        # A happy breakdown: the space holds every answer.
        self._complete = self._H[j + 1, j] <= 1e-15 * np.linalg.norm(self._H[: j + 1, j])
        if not self._complete:
            self._V.append(w / self._H[j + 1, j])

    def _displacement(self, b: PETSc.Vec) -> PETSc.Vec:
        """The displacement for nodal forces b, with what the held displacements cause."""
        u = self.factor.solve(b)
        held = self.space.held_dofs
        u.setValues(held, b.getValues(held))  # an iterative solver only comes near them
        u.assemble()
        return u

    def _refine(self, u: PETSc.Vec, load: PETSc.Vec | None, v: float) -> None:
        """Solve once more for what a displacement leaves of its forces.

        The contact moves far before the body deforms, the farther the nearer the Rayleigh speed, and what
        forces that motion seems to need is rounding. The residual is taken without it: what is left of
        the displacement is zero under the punch, and the far boundary moves instead.

        Args:
            u: the displacement, in place.
            load: nodal forces.
            v: normal displacement of the contact.
        """
        held = self.space.held_dofs
        t = (self._contact_motion(u)[0], v)
        w = self._without(u, t)
        _set_zero(w, held)
        residual = _product(self.factor.A, w)
        residual.scale(-1.0)
        if load:
            residual.axpy(1.0, load)
        residual.maxpy(t, self._far)
        _set_zero(residual, held)
        if residual.norm() > 0.0:
            correction = self.factor.solve(residual)
            u.axpy(1.0, correction)
            correction.destroy()
        w.destroy(), residual.destroy()

    def _contact_motion(self, u: PETSc.Vec) -> tuple[float, float]:
        """Mean displacement of the contact nodes."""
        nodes, comm = self.space.contact, self.space.comm
        mine = np.array([u.getValues(nodes.dofs(i)).sum() for i in (0, 1)])
        return tuple((comm.allreduce(mine) / len(nodes.s)).tolist())

    def _without(self, u: PETSc.Vec, t: tuple[float, float]) -> PETSc.Vec:
        """u less the motion t of the whole body."""
        w = u.copy()
        w.maxpy((-t[0], -t[1]), self._motions)
        return w

    def _reactions(self, u: PETSc.Vec) -> NDArray[np.float64]:
        """Consistent forces in X and Y at the contact nodes, (2, n), the same on every rank."""
        nodes, comm = self.space.contact, self.space.comm
        mine = np.zeros((2, len(nodes.s)))
        w = self._without(u, self._contact_motion(u))
        for i, rows in enumerate(self._rows):
            force = rows.createVecLeft()
            rows.mult(w, force)
            mine[i, nodes.owned] = force.array_r
            force.destroy()
        w.destroy()
        return comm.allreduce(mine)


def hold(A: PETSc.Mat, space: Space) -> PETSc.Vec:
    """Hold the contact at v = -1 and the far boundary in a matrix; returns the forces of that."""
    held, b = A.createVecRight(), A.createVecLeft()
    held.setValues(space.contact.dofs(1), np.full(len(space.contact.blocks), -1.0))
    held.assemble()
    A.zeroRowsColumns(space.held_dofs, 1.0, held, b)
    held.destroy()
    return b


def _ones(A: PETSc.Mat, dofs: NDArray[np.int32]) -> PETSc.Vec:
    """A vector that is 1 at this rank's ``dofs`` and 0 elsewhere."""
    x = A.createVecRight()
    x.setValues(dofs, np.ones(len(dofs)))
    x.assemble()
    return x


def _product(A: PETSc.Mat, x: PETSc.Vec) -> PETSc.Vec:
    y = A.createVecLeft()
    A.mult(x, y)
    return y


def _set_zero(x: PETSc.Vec, dofs: NDArray[np.int32]) -> None:
    x.setValues(dofs, np.zeros(len(dofs)))
    x.assemble()
