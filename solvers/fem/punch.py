"""Punch with friction on the finite element half-plane, its pressure unknown.

Trial functions have v = -v₀ + P on the contact nodes, test functions w_Y + g w_X = 0 there. Nodal
reactions are then the consistent contact forces; no penalty and no multiplier is needed. With the normal
displacement held and the tangential free, the matrix is symmetric and does not depend on g. With R₀ the
normal reactions without friction, T t those of tangential forces t, and G the map from normal to
tangential forces of the contact, friction requires

    t = G (R₀ + T t).

G is a number g, or, where friction varies along the contact, a matrix: through the contact's mass matrix
to σ_YY, which times g(X) is σ_XY. All frictions and all displacements P share a space of loads t, which
grows by what it leaves of these equations, as Arnoldi's method does. A contact with free ends is a sum of
several shapes P, a flat one first, which are the parts of the punch.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from mpi4py import MPI
from numpy.typing import ArrayLike, NDArray
from petsc4py import PETSc

from ..errors import SolveError
from ..solids.half_plane import HalfPlane
from ..solids.pair import PairAtSpeed
from .boundary import FarBoundary, held_forces
from .fields import Slopes
from .linear import LinearSolver, times, vector
from .space import Space

#: Least residual of the contact forces that can be required, relative; the last digits are rounding.
LEAST = 1e-13
#: Relative change of the contact forces for which no solution is refined. It keeps results on any number
#: of ranks equal to 1e-9; next to an edge a force counts by the little load there.
NEGLIGIBLE = 1e-11
#: Most loads of an iterative solver; a factor takes as many as there are contact nodes.
LIMIT = 120
#: Frictions at which a space of loads is completed at most; states whose equations are held in memory.
_SPREAD, _TOGETHER = 33, 33
#: Share of the largest residual from which on one is about as large.
_ABOUT = 0.9


def spread(values: NDArray, count: int) -> NDArray:
    """As many of the values as a count, or all, from the first to the last."""
    return values[np.unique(np.linspace(0, len(values) - 1, count).astype(int))]


@dataclass(frozen=True)
class ContactStates:
    """States of a punch as sums of its fields; lengths over a, stresses over N/(2a), so forces over N/2.

    Attributes:
        weights: of the fields, (states, fields).
        forces: of each field, consistent nodal forces of σ_XY and σ_YY at the contact nodes, read off the
            assembled equations, (fields, 2, nodes); of σ_YY alone, (fields, 1, nodes), where no equations
            were assembled.
        g: σ_XY/σ_YY under the punch, (states,).
        v0: indentation of the punch's lowest point over N/(2μ), (states,), relative to the surface at
            :data:`.line_loads.DATUM`, or to a far boundary that is held.
        half_width, centre: half-width and middle of each contact [m], (states,).
        free: True where the left and the right end are free, (states, 2).
        unresolved: part of the punch's slope that its shapes leave out, relative, (states,) or 0.
    """

    weights: NDArray[np.float64]
    forces: NDArray[np.float64]
    g: NDArray[np.float64]
    v0: NDArray[np.float64]
    half_width: Any = 1.0
    centre: Any = 0.0
    free: Any = False
    unresolved: Any = 0.0

    def between(self, half_width: Any, centre: Any, free: Any, **more: Any) -> "ContactStates":
        """States with their ends, and other attributes changed; a number is that of all states."""
        lengths = (np.broadcast_to(length, self.g.shape) for length in (half_width, centre))
        each = dict(zip(("half_width", "centre"), lengths))
        return replace(self, **each, free=np.broadcast_to(free, (len(self.g), 2)), **more)

    @cached_property
    def normal(self) -> NDArray[np.float64]:
        """Nodal forces of σ_YY, (states, nodes)."""
        return self.weights @ self.forces[:, -1]

    @cached_property
    def tangential(self) -> NDArray[np.float64]:
        """Nodal forces of σ_XY, (states, nodes): from the equations, or g times the normal ones."""
        has_both = self.forces.shape[1] == 2
        return self.weights @ self.forces[:, 0] if has_both else self.g[:, None] * self.normal

    def tested(self, tests: NDArray) -> NDArray[np.float64]:
        """Nodal forces of σ_YY times some tests (nodes, n), (states, n); nodal forces are not formed."""
        return self.weights @ (self.forces[:, -1] @ tests)

    @property
    def load(self) -> NDArray[np.float64]:
        """∫σ_YY dX, (states,)."""
        return self.weights @ self.forces[:, -1].sum(axis=1)

    @property
    def friction(self) -> NDArray[np.float64]:
        """∫σ_XY dX, (states,)."""
        return np.asarray(self.tangential.sum(axis=1))


class Punch:
    """All states of a punch with friction at one speed, which are sums of its parts.

    The parts are the flat punch at v = -1, and each of the shapes, held at v = P.

    Attributes:
        space: the finite element space.
        response: of the half-plane.
        fields: displacements over N/(2μ).
        forces: their nodal forces, see :class:`ContactStates`.
        slopes: their slopes on the surface at the places of a task, where they were interpolated.
    """

    space: Space
    response: HalfPlane
    fields: list[PETSc.Vec]
    forces: NDArray[np.float64]
    slopes: Slopes | None = None

    def parts(self, g: NDArray[np.float64]) -> NDArray[np.float64]:
        """Weights of the fields in each part, (states, parts, fields), at values g of σ_XY/σ_YY.

        Raises:
            SolveError: the contact forces did not converge.
        """
        raise NotImplementedError

    def tested(self, parts: NDArray, tests: NDArray) -> NDArray[np.float64]:
        """Normal forces of parts times tests (nodes, n), (states, parts, n); forces are not formed."""
        return np.asarray(parts @ (self.forces[:, -1] @ tests))

    def loads(self, parts: NDArray) -> NDArray[np.float64]:
        """∫σ_YY dX of each part, (states, parts)."""
        return np.asarray(parts @ self.forces[:, -1].sum(axis=1))

    def summed(self, g: NDArray, parts: NDArray, amplitudes: NDArray) -> ContactStates:
        """States that are sums of parts, by amplitudes (states, parts), the first of which is v₀."""
        weights = np.einsum("sp,spf->sf", amplitudes, parts)
        return ContactStates(weights, self.forces, g, amplitudes[:, 0])

    def states(self, g: ArrayLike, flat: bool = False, share: ArrayLike = 1.0) -> ContactStates:
        """States with the load ∫σ_YY = -N.

        Args:
            g: values of σ_XY/σ_YY.
            flat: states of a flat punch, whatever the profile is.
            share: factor of the profile's heights in each state: smaller for a larger load.
        """
        values = np.atleast_1d(np.asarray(g, dtype=float))
        parts = self.parts(values)[:, : 1 if flat else None]
        loads, heights = self.loads(parts), np.asarray(share, dtype=float) * np.ones(len(values))
        # ∫ σ_YY d(X/a) = -2 over N/(2a)
        v0 = (-2.0 - heights * loads[:, 1:].sum(axis=1)) / loads[:, 0]
        return self.summed(values, parts, np.column_stack([v0, *[heights] * (parts.shape[1] - 1)]))

    def destroy(self) -> None:
        """Free factor and fields."""
        for field in self.fields:
            field.destroy()


class SlidingPunch(Punch):
    """All friction states of the punch at one speed, from one factorisation.

    Args:
        space: the finite element space.
        response: of the half-plane, at a speed below its limit.
        solver: of linear systems: ``"direct"``, ``"boomeramg"``, ``"gamg"`` or ``"multigrid"``.
        heights: of the punch at the contact nodes, (nodes,), over N/(2μ) or in another unit that shares
            make up for; or of shapes that are combined, (shapes, nodes); None for a flat punch.
        along: gives G where friction varies along the contact, by what stands for g then, a number or an
            object; None where G is g.
        least: relative residual of the contact forces that may remain.
    """

    def __init__(
        self, space: Space, response: HalfPlane, solver: str = "direct",
        heights: NDArray[np.float64] | None = None, along: Callable[[Any], NDArray] | None = None,
        least: float = LEAST,
    ) -> None:  # fmt: skip
        self.space, self.response, self._along = space, response, along
        #: Product with G.
        self._times = np.matmul if along else np.multiply
        nodes = space.contact
        A = space.assemble(response)
        both = np.column_stack([nodes.dofs(0), nodes.dofs(1)]).ravel()
        #: Rows of the contact nodes, along X and Y in turn.
        self._rows = A.createSubMatrix(PETSc.IS().createGeneral(both, comm=A.comm))
        self._first = A.getOwnershipRange()[0]
        #: Motions of the whole body along X and Y, at this rank's rows, (rows, 2).
        self._motions = space.translations
        moved = np.zeros_like(self._motions)
        far = space.far_dofs - self._first
        moved[far] = self._motions[far]
        #: Forces that a motion of the far boundary alone causes, (rows, 2).
        self._far = times(A, moved)
        shapes = np.vstack([np.full(len(nodes.s), -1.0), *([] if heights is None else [heights])])
        shaped = held_forces(A, space, nodes.dofs(1), shapes[:, nodes.owned].T)
        self._boundary = FarBoundary(space, response, A)
        A = space.held(A, response, ("contact", "far"))
        self.factor = LinearSolver(A, space.clock, solver, not space.mixed, space.places(response))
        #: Relative residual that may remain; number of parts; true where solutions are refined.
        self._left, self._parts, self._refines = least, len(shapes), False
        self.fields, self.forces = self._frictionless(shaped)
        #: Orthonormal loads, (n, loads).
        self._loads: NDArray[np.float64] = np.empty((len(nodes.s), 0))
        self._complete = False

    def prepare(self, g: NDArray[np.float64]) -> None:
        """Complete the loads for these values of σ_XY/σ_YY, sorted, and for their opposites.

        What loads leave of the equations is a smooth function of g, so some values spread over all
        suffice. At opposite frictions a punch is the mirror image, with which rounding is estimated.
        Frictions that vary along the contact are no such family: each counts.
        """
        sample = spread(g, _SPREAD)
        self._grow(g if self._along else np.concatenate([sample, -sample]))
        self._complete = True

    def parts(self, g: NDArray[np.float64]) -> NDArray[np.float64]:
        if not self._complete:
            self._grow(g)
        by_load = np.concatenate([y for _, y in self._amplitudes(g)]).swapaxes(1, 2)
        each = np.broadcast_to(np.eye(self._parts), (len(g), self._parts, self._parts))
        return np.concatenate([each, by_load], axis=2)

    def _amplitudes(self, g: NDArray) -> Iterator[tuple[Any, NDArray[np.float64]]]:
        """G and amplitudes y of the loads in t, (states, loads, parts), of some states after others.

        They are Galerkin's: V'(V y - G (R₀ + T V y)) = 0, V the loads.
        """
        V, R = self._loads, self.forces[:, 1].T
        count = V.shape[1]
        projected = V.T @ R
        for batch in np.split(g, range(_TOGETHER, len(g), _TOGETHER)) if self._along else [g]:
            if self._along:
                G: Any = np.array([self._along(value) for value in batch.tolist()])
                H = V.T @ (G @ R)
            else:
                G, H = batch[:, None, None], batch[:, None, None] * projected
            R0, TV = H[..., : self._parts], H[..., self._parts :]
            yield G, np.linalg.solve(np.eye(count) - TV, R0)

    def _rest(self, g: NDArray) -> NDArray[np.float64]:
        """Residuals of the equations under the loads, over the tangential forces, (n, states × parts)."""
        R0, TV = np.split(self.forces[:, 1].T, [self._parts], axis=1)
        every = []
        for G, y in self._amplitudes(g):
            R = R0 + TV @ y
            t = self._times(G, R)
            size = np.maximum(np.linalg.norm(t, axis=1, keepdims=True), np.finfo(float).tiny)
            every.append(np.moveaxis((t - self._loads @ y) / size, 0, 1).reshape(len(R0), -1))
        return np.concatenate(every, axis=1)

    def _grow(self, g: NDArray) -> None:
        """Add loads until the equations of every friction are solved, and fields of these loads.

        Raises:
            SolveError: there are as many loads as there may be.
        """
        limit = len(self.space.contact.s) if self.factor.direct else LIMIT
        waiting: list[NDArray] = []
        while True:
            rest = self._rest(g)
            left = float(np.linalg.norm(rest, axis=0).max())
            if left <= self._left:
                if not waiting:
                    return
                # All at once: many right-hand sides cost little more than one.
                b = self._tangential(self._loads[:, len(self.fields) - self._parts :])
                fields, forces = self._refined(b, np.column_stack(waiting), self._refines)
                self.forces[len(self.fields) :], waiting = forces, []
                self.fields = [*self.fields, *fields]
                continue
            if self._loads.shape[1] >= limit:
                of = "" if self._along else f" at g = {g[0]:g} to {g[-1]:g} (dimensionless)"
                raise SolveError(
                    f"the contact forces{of} did not converge in {limit} steps: residual "
                    f"{left:.3g}, expected {self._left:g}"
                )
            more = self._loads[:, :0]
            while (sizes := np.linalg.norm(rest, axis=0)).max() > self._left:
                # The first of those that are about as large: rounding chooses among equal ones.
                worst = int(np.argmax(sizes > _ABOUT * sizes.max()))
                along = rest[:, worst] / sizes[worst]
                rest = rest - np.outer(along, along @ rest)
                more = np.column_stack([more, along])
            for _ in range(2):  # twice is enough
                more, _ = np.linalg.qr(more - self._loads @ (self._loads.T @ more))
            waiting.append(self._displacements(self._tangential(more)))
            self._loads = np.column_stack([self._loads, more])
            more_forces = map(self._boundary.follow, self._reactions(waiting[-1]))
            self.forces = np.concatenate([self.forces, [*more_forces]])

    def _frictionless(self, shaped: NDArray) -> tuple[list[PETSc.Vec], NDArray]:
        """Fields and forces of the flat punch at v = -1 and of each shape, without friction.

        The far boundary's fields are solved for with them. They are refined in any case, which shows
        whether other solutions need it.

        Args:
            shaped: nodal forces of the held displacements, (rows, shapes).
        """
        b = np.column_stack([self._boundary.loads, shaped])
        flat, count = self._boundary.loads.shape[1], b.shape[1]
        x = self._displacements(b, checked=True)
        before = self._reactions(x)
        # Under the flat punch all of the contact moves by the same distance, and no other load acts.
        v = np.where(np.arange(count) == flat, -1.0, 0.0)
        b[:, flat] = 0.0
        # The far boundary's moments after the resultants have too little effect to be refined.
        refined = [*range(min(flat, 2)), *range(flat, count)]
        x[:, refined] += self._corrections(self._residuals(x[:, refined], b[:, refined], v[refined]))
        after = self._reactions(x)
        fields = [vector(self.factor.A, column) for column in x.T]
        if flat:
            X = self.space.chart.surface_position(self.space.contact.s)
            self._boundary.take(fields[:flat], X, after[:flat])
        changes = [np.linalg.norm(a - b) / np.linalg.norm(b) for a, b in zip(after[flat:], before[flat:])]
        self._refines = bool(max(changes) > NEGLIGIBLE)
        return fields[flat:], self._followed(fields[flat:], after[flat:])

    def _refined(
        self, b: NDArray, x: NDArray, refines: bool, checked: bool = True
    ) -> tuple[list[PETSc.Vec], NDArray[np.float64]]:
        """Fields and forces of displacements x under loads b, both (rows, k), checked and refined."""
        if checked or refines:
            residuals = self._residuals(x, b, np.zeros(b.shape[1]))
            if checked:
                self.factor.check(b, x, residuals)
            if refines:
                x += self._corrections(residuals)
        fields = [vector(self.factor.A, column) for column in x.T]
        return fields, self._followed(fields, self._reactions(x))

    def _followed(self, fields: Sequence[PETSc.Vec], forces: NDArray) -> NDArray[np.float64]:
        """Forces (fields, 2, n) once the far boundary moves with the fields, which it moves."""
        return np.array([self._boundary.follow(force, field) for force, field in zip(forces, fields)])

    def by_units(self) -> tuple[list[PETSc.Vec], NDArray, NDArray]:
        """Forces that displacements and tangential loads at each contact node cause.

        Displacements are those of all nodes by -1, which the flat punch has, and of each but the first.
        By the theorem of Maxwell and Betti a tangential load causes normal forces that are less the
        tangential displacements where it acts, by normal displacements where they act: one solution a
        node gives both.

        Returns:
            Fields of the displacements after the first; forces of the displacements and of the loads,
            (n, 2, n) each.
        """
        nodes = self.space.contact
        n = len(nodes.s)
        units = np.eye(n)
        units[0] = -1.0
        b = self._normal(units)
        x = self._displacements(b)
        moved = np.zeros((n, n))
        moved[:, nodes.owned] = x[nodes.dofs(0) - self._first].T
        self.space.comm.Allreduce(MPI.IN_PLACE, moved)
        normal = -moved
        normal[0] = -normal.sum(axis=0)
        loaded = [self._boundary.follow(np.array(pair)) for pair in zip(np.eye(n), normal.T)]
        fields, forces = self._refined(b[:, 1:], x[:, 1:], self._refines, checked=False)
        return fields, np.concatenate([self.forces[:1], forces]), np.array(loaded)

    def _normal(self, displacements: NDArray) -> NDArray[np.float64]:
        """Nodal forces (rows, k) of normal displacements held at the contact nodes, (k, n)."""
        nodes = self.space.contact
        moved, total = self._rows.createVecLeft(), self._rows.createVecRight()
        b = np.empty((len(self._motions), len(displacements)))
        for column, each in zip(b.T, displacements[:, nodes.owned]):
            moved.setArray(np.column_stack([np.zeros_like(each), each]).ravel())
            self._rows.multTranspose(moved, total)
            column[:] = -total.array_r
        moved.destroy(), total.destroy()
        b[self._held] = 0.0
        b[nodes.dofs(1) - self._first] = displacements[:, nodes.owned].T
        return b

    def _tangential(self, forces: NDArray) -> NDArray[np.float64]:
        """Loads (rows, k) of tangential forces at the contact nodes, (n, k)."""
        nodes, b = self.space.contact, np.zeros((len(self._motions), forces.shape[1]))
        b[nodes.dofs(0) - self._first] = forces[nodes.owned]
        return b

    def _displacements(self, b: NDArray, checked: bool = False) -> NDArray[np.float64]:
        """Displacements under nodal forces (rows, k), the effect of held displacements included."""
        x, held = self.factor.solve(b, checked), self._held
        x[held] = b[held]  # an iterative solver only comes near them
        return x

    @property
    def _held(self) -> NDArray[np.int32]:
        """This rank's rows of held unknowns."""
        return self.space.held_dofs - self._first

    def _corrections(self, residuals: NDArray) -> NDArray[np.float64]:
        """Displacements under residual forces (rows, k)."""
        x = np.zeros_like(residuals)
        left = np.any(residuals, axis=0)
        self.space.comm.Allreduce(MPI.IN_PLACE, left, MPI.LOR)
        if left.any():
            x[:, left] = self.factor.solve(residuals[:, left], checked=False)
        return x

    def _residuals(self, x: NDArray, b: NDArray, v: NDArray) -> NDArray[np.float64]:
        """Residual forces of displacements x (rows, k) under loads b.

        The contact moves far before the body deforms, the farther the nearer the Rayleigh speed, and what
        forces that motion seems to need is rounding. The residual is taken without it: the rest of the
        displacement is zero under a flat punch, and the far boundary moves instead.

        Args:
            x: displacements, (rows, k).
            b: nodal forces, those of a profile's held displacements among them.
            v: normal displacement of the contact where all of it moves by the same distance, (k,).
        """
        motion = np.stack([self._contact_motion(x)[0], v])
        w = x - self._motions @ motion
        w[self._held] = 0.0
        residuals = b + self._far @ motion - times(self.factor.A, w)
        residuals[self._held] = 0.0
        return residuals

    def _contact_motion(self, x: NDArray) -> NDArray[np.float64]:
        """Mean displacement along X and Y of the contact nodes over N/(2μ), (2, k)."""
        nodes = self.space.contact
        total = np.array([x[nodes.dofs(i) - self._first].sum(axis=0) for i in (0, 1)])
        self.space.comm.Allreduce(MPI.IN_PLACE, total)
        return total / len(nodes.s)

    def _reactions(self, x: NDArray) -> NDArray[np.float64]:
        """Consistent forces in X and Y at the contact nodes, (k, 2, n), the same on every rank."""
        nodes = self.space.contact
        forces = np.zeros((x.shape[1], 2, len(nodes.s)))
        w = x - self._motions @ self._contact_motion(x)
        reactions = times(self._rows, w).T
        for i in (0, 1):
            forces[:, i, nodes.owned] = reactions[:, i::2]
        self.space.comm.Allreduce(MPI.IN_PLACE, forces)
        return forces

    def destroy(self) -> None:
        super().destroy()
        for held in (self.factor, self._boundary, self._rows):
            held.destroy()


class ElasticPunch(SlidingPunch):
    """All friction states of an elastic punch and the plate, each on the mesh of the plate.

    With S the normal reactions by normal displacements held at the contact nodes, T those by tangential
    forces, of the plate, and S', T' of the mirrored punch, whose displacement is v' by contact forces R:

        R = S (P - v') + g T R,   R = S' v' - g T' R.

    Solutions are dense algebra. Their displacements in the plate are combinations of few fields, a basis
    of all that frictions require.

    Args:
        space, solver, heights, least: as of :class:`SlidingPunch`.
        response: of the plate and the punch.
    """

    response: PairAtSpeed

    def __init__(
        self, space: Space, response: PairAtSpeed, solver: str = "direct",
        heights: NDArray[np.float64] | None = None, along: Callable[[Any], NDArray] | None = None,
        least: float = LEAST,
    ) -> None:  # fmt: skip
        punch = SlidingPunch(space, response.punch, solver)
        super().__init__(space, response.plate, solver, heights, along, least)
        self.response = response
        # v' is that of the first node and, of the others, what they move farther. So the contact's common
        # motion, which is large, spoils no digits of the rest.
        signs = np.where(np.arange(len(space.contact.s)), 1.0, -1.0)[:, None, None]
        self._moving_fields, moving, by_loads = self.by_units()
        #: Forces in the plate by each unit of v', (n, 2, n).
        self._moving = signs * moving
        #: Combinations of displacements and tangential forces, orthonormal, (basis, 2 n).
        self._basis: NDArray[np.float64] = np.empty((0, 2 * len(signs)))
        fields, moving_punch, by_loads_punch = punch.by_units()
        S, T, S_punch, T_punch = (
            forces[:, 1].T for forces in (self._moving, by_loads, signs * moving_punch, by_loads_punch)
        )
        for held in (*fields, punch):
            held.destroy()
        unit = np.eye(len(signs))
        #: -v' by R, and by g R; and matrices of the equations of R, likewise.
        self._moved = -response.ratio * np.linalg.solve(S_punch, [unit, T_punch])
        self._equations = unit - S @ self._moved[0], -S @ self._moved[1] - T
        #: 0 where the punch is the softer one: all of the plate's displacement is in the basis then.
        self._rigid = 1.0
        if response.punch.n * response.ratio > response.plate.n:
            self._rigid, self._moved = 0.0, np.linalg.solve(S, [unit, -T])

    def _changes(self, g: NDArray) -> NDArray[np.float64]:
        """Displacements -v' and tangential forces G R of every part for every g, (states, parts, 2 n)."""
        (first, second), (moved, by_g) = self._equations, self._moved
        forces, changes = self.forces[: self._parts, 1].T, []
        for value in g.tolist():
            G = self._along(value) if self._along else value
            R = np.linalg.solve(first + self._times(second, G), forces)
            t = self._times(G, R)
            changes.append(np.concatenate([moved @ R + by_g @ t, t]).T)
        return np.array(changes)

    def prepare(self, g: NDArray[np.float64]) -> None:
        super().prepare(g)
        self._forget_moving()

    def _forget_moving(self) -> None:
        while self._moving_fields:
            self._moving_fields.pop().destroy()

    def _grow(self, g: NDArray) -> None:
        """Add fields until the basis has all that these frictions require."""
        n = len(self._moving)
        changes = self._changes(g).reshape(-1, 2 * n)
        changes /= np.linalg.norm(changes, axis=1, keepdims=True)
        rest = changes - (changes @ self._basis.T) @ self._basis
        _, size, rows = np.linalg.svd(rest, full_matrices=False)
        more = rows[size > self._left * np.linalg.norm(changes, 2)]
        if not len(more):
            return
        for _ in range(2):  # twice is enough
            more = np.linalg.qr((more - (more @ self._basis.T) @ self._basis).T)[0].T
        units = np.array([-self.fields[0].array_r, *(field.array_r for field in self._moving_fields)])
        b = self._tangential(more[:, n:].T)
        fields, forces = self._refined(b, self._displacements(b), True, bool(np.any(g)))
        for field, moved in zip(fields, more[:, :n] @ units):
            field.setArray(field.array_r + moved)
        self.fields = [*self.fields, *fields]
        forces += np.tensordot(more[:, :n], self._moving, 1)
        self.forces, self._basis = np.concatenate([self.forces, forces]), np.vstack([self._basis, more])

    def parts(self, g: NDArray[np.float64]) -> NDArray[np.float64]:
        if not self._complete:
            self._grow(g)
        first = np.broadcast_to(self._rigid * np.eye(self._parts), (len(g), self._parts, self._parts))
        return np.concatenate([first, self._changes(g) @ self._basis.T], axis=2)

    def destroy(self) -> None:
        self._forget_moving()
        super().destroy()


def sliding_punch(space: Space, response: HalfPlane, *args: Any, **options: Any) -> SlidingPunch:
    """Punch of the arguments of :class:`SlidingPunch`, elastic where the response is that of a pair."""
    kind = ElasticPunch if isinstance(response, PairAtSpeed) else SlidingPunch
    return kind(space, response, *args, **options)  # type: ignore[arg-type]
