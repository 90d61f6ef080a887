"""Rigid punch with friction and two sharp edges on the finite element half-plane, its pressure unknown.

Trial functions have v = -v₀ + P on the contact nodes, test functions w_Y + g w_X = 0 there. Nodal
reactions are then the consistent contact forces; no penalty and no multiplier is needed. With the normal
displacement held and the tangential free, the matrix is symmetric and does not depend on g: if T r are
the normal reactions caused by tangential forces r, friction requires

    (I - g T) R = R₀.

The Krylov space of (T, R₀), made by Arnoldi's method, holds the contact forces of every g at that speed;
a profile P that is not flat has a space of its own. Where that takes many loads, as in some anisotropic
solids with much friction, T is formed as a matrix. For a contact with free ends P is a combination of
several shapes, each with a space of its own. Every state of a punch with friction is a sum of these
parts.

At a speed between others at which the punch was solved, its parts are interpolated. At a solved speed
they are sampled at some frictions, between which they are polynomials in g to rounding. At another speed
each number is a sum over the solved speeds, with the same weights for all numbers. The effect of an
edge's singularity is divided out before and multiplied in again: a force or a slope at a distance d goes
as d^α with an exponent that changes with speed.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from mpi4py import MPI
from numpy.typing import ArrayLike, NDArray
from petsc4py import PETSc
from scipy.linalg import schur

from ..approximation import barycentric
from ..errors import SolveError
from ..solids.half_plane import HalfPlane
from ..solids.pair import PairAtSpeed
from .boundary import FarBoundary, held_forces
from .fields import Slopes
from .linear import LinearSolver, times, vector
from .space import Space

#: Least relative residual of contact forces that can be required; the last digits are rounding.
LEAST = 1e-13
#: Relative residual that refined solutions may bring back; what is larger takes further loads.
_BROUGHT_BACK = 1e-12
#: Most loads applied one after the other.
LIMIT = 120
#: Number of loads from which on a factor takes loads at all contact nodes, and the rest is dense algebra,
#: where these take no longer than the loads so far; loads that are taken at once; loads at once that take
#: as long as a single one.
_MANY, _AT_ONCE, _AS_LONG = 40, 64, 6.0

#: Numbers of frictions up to which each is solved for itself; beyond, all share a triangular form.
_FEW = 40


class KrylovSpace:
    """The space that holds the contact forces of every friction.

    It grows by what is left of the equations at the worst friction. That is Arnoldi's method, but for
    rounding: loads are applied one after the other by rough solutions, and these are refined together.
    What is left then is as small as the changes, and another few loads take it away. Where that takes
    many loads, dense algebra gives the last ones (:meth:`complete_by`).

    Args:
        field: the punch without friction.
        forces: its forces in X and Y at the contact nodes, (2, n).
        refines: solutions are refined.
        left: relative residual of the contact forces that may remain, if it is above the least.
        limit: most loads.

    Attributes:
        fields: displacements, of the punch without friction first, then of each tangential load.
        forces: their forces at the contact nodes, those of rough fields included, (fields, 2, n).
        rough: displacements of loads without fields at this rank's rows, not yet refined; the last loads
            may lack them.
        complete: the space holds every answer.
    """

    def __init__(self, field: PETSc.Vec, forces: NDArray, refines: bool, left: float, limit: int) -> None:
        self.fields, self.forces, self.refines, self.limit = [field], forces[None], refines, limit
        self.rough: list[NDArray[np.float64]] = []
        self.left = max(left, LEAST)
        self._size = np.linalg.norm(forces[1])
        #: Orthonormal loads, (n, loads); the last ones may not be applied yet.
        self._V = forces[1][:, None] / self._size
        self.complete = False

    @property
    def applied(self) -> int:
        """Number of loads that are applied."""
        return len(self.forces) - 1

    @property
    def waiting(self) -> NDArray[np.float64]:
        """Loads that are not yet applied, (n, loads)."""
        return self._V[:, self.applied :]

    @property
    def loads(self) -> NDArray[np.float64]:
        """All loads, (n, loads)."""
        return self._V

    def load_by(self, loads: NDArray) -> None:
        """Take orthonormal loads, (n, k), the first of which are those that are applied."""
        self._V = loads

    def beside(self, loads: NDArray) -> NDArray[np.float64]:
        """Orthonormal loads, (n, m), that span with those of the space as much as loads (n, k) do."""
        directions, size, _ = np.linalg.svd(self._beside(loads), full_matrices=False)
        more, _ = np.linalg.qr(self._beside(directions[:, size > LEAST]))
        return np.asarray(more)

    @property
    def unsettled(self) -> NDArray[np.float64]:
        """Loads that are applied and have no fields yet, (n, loads)."""
        return self._V[:, len(self.fields) - 1 : self.applied]

    def take(self, rough: NDArray, forces: NDArray) -> None:
        """Take forces (loads, 2, n) of waiting loads, and displacements, (rows, loads) or (rows, 0)."""
        self.rough += list(rough.T)
        self.forces = np.concatenate([self.forces, forces])

    def settle(self, fields: Sequence[PETSc.Vec], forces: NDArray) -> None:
        """Take the fields of the unsettled loads, and their forces (fields, 2, n)."""
        self.forces[len(self.fields) :] = forces
        self.fields += fields
        self.rough = []

    def reduce(self, y: NDArray) -> None:
        """Keep of the unsettled loads what answers need: fewer fields are refined and differentiated.

        Args:
            y: coefficients of the contact forces of every friction, (states, m).
        """
        if len(self.fields) > 1 or len(self.rough) < self.applied:
            return
        # The first load is that of the equations.
        _, size, rows = np.linalg.svd(y[:, 1:] / np.linalg.norm(y, axis=1)[:, None], full_matrices=False)
        Q = np.zeros((self.applied, 1 + int((size > LEAST).sum())))
        Q[0, 0], Q[1:, 1:] = 1.0, rows[: Q.shape[1] - 1].T
        self._V = self._V @ Q
        self.rough = list(Q.T @ np.array(self.rough))
        self.forces = np.concatenate([self.forces[:1], np.tensordot(Q.T, self.forces[1:], 1)])

    def converged(self, g: NDArray) -> NDArray[np.float64] | None:
        """Coefficients y of R = V y for every g, (states, m); None where more loads are waiting.

        Raises:
            SolveError: the space has grown to its limit.
        """
        if not self.applied:
            return None
        y, directions, rest = self.solve(g)
        residuals = np.linalg.norm(rest, axis=0)
        worst = int(np.argmax(residuals))
        if self.complete or residuals[worst] <= self.left:
            return y
        if self.applied >= self.limit:
            raise SolveError(
                f"the contact forces at g = {g[worst]:g} (dimensionless) did not converge in "
                f"{self.applied} steps: residual {residuals[worst]:.3g}, expected {self.left:g}"
            )
        while residuals[worst] > self.left:
            along = rest[:, worst] / residuals[worst]
            rest = rest - np.outer(along, along @ rest)
            load = self._beside(directions @ along)
            self._V = np.column_stack([self._V, load / np.linalg.norm(load)])
            residuals = np.linalg.norm(rest, axis=0)
            worst = int(np.argmax(residuals))
        return None

    def complete_by(self, T: NDArray, g: NDArray) -> None:
        """Add to the waiting loads what is left of the equations at every g, solved by dense algebra.

        Args:
            T: normal forces under a tangential load at each contact node, (n, n), a column a load.
            g: values of σ_XY/σ_YY, (states,).
        """
        left = np.tile(self._V[:, :1], len(g))
        if self.applied:
            _, directions, rest = self.solve(g)
            short = np.linalg.norm(rest, axis=0) > self.left
            g, left = g[short], directions @ rest[:, short]
        answers = [np.linalg.solve(np.eye(len(T)) - value * T, r) for value, r in zip(g, left.T)]
        R = np.column_stack([answer / np.linalg.norm(answer) for answer in answers])
        self._V = np.column_stack([self._V, self.beside(R)])

    def _beside(self, loads: NDArray) -> NDArray[np.float64]:
        """Parts of loads (n, k) that are orthogonal to the others."""
        for _ in range(2):  # twice is enough
            loads = loads - self._V @ (self._V.T @ loads)
        return loads

    def solve(self, g: NDArray) -> tuple[NDArray, NDArray, NDArray]:
        """Coefficients y of R = V y for every g, and what is left of (I - g T) R = R₀ over R.

        Returns:
            Coefficients (states, m), orthonormal directions (n, k), residuals along them (k, states).
        """
        m = self.applied
        V, W = self._V[:, :m], self.forces[1:, 1].T
        H = V.T @ W
        directions, R = np.linalg.qr(W - V @ H)
        if len(g) <= _FEW:
            first = np.zeros((len(g), m, 1))
            first[:, 0] = self._size
            y = np.linalg.solve(np.eye(m) - g[:, None, None] * H, first)[..., 0]
        else:  # once for all g: Schur's form keeps the digits that eigenvectors may lose
            T, Q = schur(H, output="complex")
            solved = np.tile((self._size * Q[0].conj())[:, None], len(g))
            for i in reversed(range(m)):
                solved[i] += g * (T[i, i + 1 :] @ solved[i + 1 :])
                solved[i] /= 1.0 - g * T[i, i]
            y = (Q @ solved).real.T
        return y, directions, R @ (g[:, None] * y / np.linalg.norm(y, axis=1)[:, None]).T


@dataclass(frozen=True)
class Part:
    """Combinations of fields of a punch; lengths over a, stresses over N/(2a), so forces over N/2.

    Attributes:
        weights: of the fields, (states, fields).
        forces: of each field, consistent nodal forces of σ_XY and σ_YY at the contact nodes, read off the
            assembled equations, (fields, 2, nodes); of σ_YY alone, (fields, 1, nodes), where no equations
            were assembled.
    """

    weights: NDArray[np.float64]
    forces: NDArray[np.float64]

    @cached_property
    def normal(self) -> NDArray[np.float64]:
        """Nodal forces of σ_YY, (states, nodes)."""
        return self.weights @ self.forces[:, -1]

    def tested(self, tests: NDArray) -> NDArray[np.float64]:
        """Nodal forces of σ_YY times some tests (nodes, n), (states, n); nodal forces are not formed."""
        return self.weights @ (self.forces[:, -1] @ tests)

    @property
    def load(self) -> NDArray[np.float64]:
        """∫σ_YY dX, (states,)."""
        return self.weights @ self.forces[:, -1].sum(axis=1)


@dataclass(frozen=True)
class ContactStates(Part):
    """States of a punch with several frictions.

    Attributes:
        g: σ_XY/σ_YY under the punch, (states,).
        v0: indentation over N/(2μ), (states,), relative to the surface at :data:`.line_loads.DATUM`, or
            to a far boundary that is held.
    """

    g: NDArray[np.float64]
    v0: NDArray[np.float64]

    @cached_property
    def tangential(self) -> NDArray[np.float64]:
        """Nodal forces of σ_XY, (states, nodes): from the equations, or g times the normal ones."""
        has_both = self.forces.shape[1] == 2
        return self.weights @ self.forces[:, 0] if has_both else self.g[:, None] * self.normal


class Punch:
    """All states of a punch with friction at one speed, which are sums of its parts.

    Attributes:
        space: the finite element space.
        response: of the half-plane.
        fields: displacements of the parts, part after part.
    """

    space: Space
    response: HalfPlane
    fields: Any

    def parts(self, g: NDArray[np.float64], shapes: int | None = None) -> list[Part]:
        """Parts of the states with σ_XY = g σ_YY: the flat punch at v = -1, and each shape held at v = P.

        Args:
            g: values of σ_XY/σ_YY, (states,).
            shapes: number of shapes, all of them if not given.
        """
        raise NotImplementedError

    def release(self) -> None:
        """Free factor and fields; states at frictions that were solved before remain available."""
        raise NotImplementedError

    def destroy(self) -> None:
        """Free factor and fields."""
        raise NotImplementedError

    def states(self, g: ArrayLike, flat: bool = False, share: ArrayLike = 1.0) -> ContactStates:
        """The states with σ_XY = g σ_YY under the punch and the load ∫σ_YY = -N.

        Args:
            g: values of σ_XY/σ_YY.
            flat: states of a flat punch, whatever the profile is.
            share: factor of the profile's heights in each state: smaller for a larger load.
        """
        g = np.atleast_1d(np.asarray(g, dtype=float))
        heights = np.asarray(share, dtype=float) * np.ones(len(g))
        parts = self.parts(g, 0 if flat else None)
        amplitudes = [heights] * (len(parts) - 1)
        # ∫ σ_YY d(X/a) = -2 over N/(2a)
        carried = sum(of * part.load for of, part in zip(amplitudes, parts[1:]))
        v0 = (-2.0 - carried) / parts[0].load
        return combined(g, parts, np.column_stack([v0, *amplitudes]))


def combined(g: NDArray, parts: Sequence[Part], amplitudes: NDArray) -> ContactStates:
    """States that are sums of a punch's parts, the first of which is the flat one.

    Args:
        g: values of σ_XY/σ_YY, (states,).
        parts: see :meth:`Punch.parts`.
        amplitudes: of each part, (states, parts); the first is the indentation v₀.
    """
    weights = [amplitudes[:, [i]] * part.weights for i, part in enumerate(parts)]
    forces = np.concatenate([part.forces for part in parts])
    return ContactStates(np.concatenate(weights, axis=1), forces, g, amplitudes[:, 0])


#: Frictions for which a basis is completed at most.
_SPREAD = 33


class SlidingPunch(Punch):
    """All friction states of the punch at one speed, from one factorisation.

    Args:
        space: the finite element space.
        response: of the half-plane, at a speed below its limit.
        solver: of linear systems: ``"direct"``, ``"boomeramg"``, ``"gamg"`` or ``"multigrid"``.
        negligible: relative change of the contact forces that needs no refinement of a solution. The
            first solution is refined in any case, which shows whether the others need it.
        heights: of the punch's profile over N/(2μ) at the contact nodes, (nodes,), or of several shapes
            that are combined, (shapes, nodes); None for a flat punch.
        left: relative residual of the contact forces that may remain at each friction.
    """

    def __init__(
        self,
        space: Space,
        response: HalfPlane,
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
        self._first = A.getOwnershipRange()[0]
        rigid = space.rigid_motions(response)
        #: Motions of the whole body along X and Y, at this rank's rows, (rows, 2).
        self._motions, moved = rigid[:, :2], np.zeros((len(rigid), 2))
        far = space.far_dofs - self._first
        moved[far] = self._motions[far]
        #: Forces that a motion of the far boundary alone causes, (rows, 2).
        self._far = times(A, moved)
        flat = np.full(len(nodes.s), -1.0)
        shapes = [flat, *([] if heights is None else np.atleast_2d(heights))]
        shaped = held_forces(A, space, nodes.dofs(1), np.array(shapes)[:, nodes.owned].T)
        self._boundary = FarBoundary(space, response, A)
        A = space.held(A, response, ("contact", "far"))
        self.factor = LinearSolver(A, space.clock, solver, not space.mixed, rigid)
        #: Krylov spaces of the flat punch, and of each shape.
        self._spaces = self._begin(shaped, negligible)

    @property
    def fields(self) -> list[PETSc.Vec]:
        """Displacements of the basis: the punches without friction, each before its tangential loads."""
        return [field for space in self._spaces for field in space.fields]

    def prepare(self, g: NDArray[np.float64]) -> None:
        """Complete the basis for these values of σ_XY/σ_YY, sorted, and for their opposites.

        What a basis leaves is a smooth function of g, so some values spread over all suffice. At opposite
        frictions a punch is the mirror image, with which rounding is estimated.
        """
        spread = g[np.unique(np.linspace(0, len(g) - 1, _SPREAD).astype(int))]
        self._contact_forces(self._spaces, np.concatenate([spread, -spread]), reduces=True)
        for space in self._spaces:
            space.complete = True

    def parts(self, g: NDArray[np.float64], shapes: int | None = None) -> list[Part]:
        spaces = self._spaces[: None if shapes is None else 1 + shapes]
        return [self._of(space, g, y) for space, y in zip(spaces, self._contact_forces(spaces, g))]

    def _of(self, space: KrylovSpace, g: NDArray, y: NDArray) -> Part:
        """Part of a Krylov space at frictions g, by coefficients y (states, m) of its contact forces."""
        weights = np.zeros((len(g), len(space.fields)))
        weights[:, 0] = 1.0
        weights[:, 1 : 1 + y.shape[1]] = g[:, None] * y
        return Part(weights, space.forces)

    def release(self) -> None:
        for space in self._spaces:
            space.complete = True
        self.destroy()

    def destroy(self) -> None:
        self.__dict__.pop("_of_nodes", None)
        for held in (self.factor, self._boundary, *self._rows, *self.fields):
            held.destroy()

    def _begin(self, shaped: NDArray, negligible: float) -> list[KrylovSpace]:
        """Krylov spaces of the flat punch at v = -1 and of each shape, without friction.

        The far boundary's fields are solved for with them.

        Args:
            shaped: nodal forces of the held displacements, (rows, shapes).
            negligible: see the class.
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
        spaces, limit = [], len(self.space.contact.s) if self.factor.direct else LIMIT
        for field, rough, forces in zip(fields[flat:], before[flat:], after[flat:]):
            change = np.linalg.norm(forces - rough) / np.linalg.norm(rough)
            forces = self._boundary.follow(forces, field)
            spaces.append(KrylovSpace(field, forces, bool(change > negligible), self._left, limit))
        return spaces

    def _contact_forces(
        self, spaces: Sequence[KrylovSpace], g: NDArray[np.float64], reduces: bool = False
    ) -> list[NDArray[np.float64]]:
        """Coefficients y of R = V y for every g, (states, m), in each Krylov space.

        Spaces grow as they need, together where several do: one pass over the factor serves them. Where
        no other g will come they are reduced to what these need.
        """
        if not np.any(g):
            return [np.zeros((len(g), 0)) for _ in spaces]
        while True:
            coefficients = [space.converged(g) for space in spaces]
            short = [space for space, y in zip(spaces, coefficients) if y is None]
            if short:
                self._extend(short, g)
            elif any(space.unsettled.size for space in spaces):
                for space, y in zip(spaces, coefficients):
                    if space.unsettled.size:
                        if reduces and y is not None:
                            space.reduce(y)
                        self._settle(space)
            else:
                return [y for y in coefficients if y is not None]

    def _extend(self, spaces: Sequence[KrylovSpace], g: NDArray) -> None:
        """Forces of the waiting loads of each space, and rough displacements, all solved for at once.

        Loads at all nodes, where there are many, give forces alone.
        """
        many = min(max(_MANY, len(self.space.contact.s) / _AS_LONG), LIMIT)
        if self.factor.direct and max(space.applied for space in spaces) >= many:
            for space in spaces:
                space.complete_by(self._of_nodes[:, 1].T, g)
                forces = np.einsum("mcn,mk->kcn", self._of_nodes, space.waiting, optimize=True)
                space.take(np.empty((len(self._motions), 0)), forces)
            return
        waiting = [space.waiting for space in spaces]
        x = self._displacements(self._tangential(np.column_stack(waiting)))
        forces = np.array([self._boundary.follow(force) for force in self._reactions(x)])
        ends = np.cumsum([loads.shape[1] for loads in waiting])
        for space, end, loads in zip(spaces, ends, waiting):
            columns = slice(end - loads.shape[1], end)
            space.take(x[:, columns], forces[columns])

    def _settle(self, space: KrylovSpace) -> None:
        """Fields of the unsettled loads of a space: rough ones are checked, and refined if needed."""
        b = self._tangential(space.unsettled)
        more = b[:, len(space.rough) :]
        x = np.column_stack([*space.rough, *([self._displacements(more)] if more.shape[1] else [])])
        residuals = self._residuals(x, b, np.zeros(b.shape[1]))
        self.factor.check(b, x, residuals)
        if space.refines:
            x = x + self._corrections(residuals)
        fields, forces = [vector(self.factor.A, column) for column in x.T], self._reactions(x)
        space.settle(
            fields,
            np.array([self._boundary.follow(force, field) for force, field in zip(forces, fields)]),
        )
        if space.refines:  # loads that follow are as small as what was changed
            space.refines, space.left = False, max(space.left, _BROUGHT_BACK)

    @cached_property
    def _of_nodes(self) -> NDArray[np.float64]:
        """Forces that a tangential load at each contact node causes, (n, 2, n)."""
        loads, forces = np.eye(len(self.space.contact.s)), []
        for start in range(0, len(loads), _AT_ONCE):
            x = self._displacements(self._tangential(loads[:, start : start + _AT_ONCE]))
            forces += [self._boundary.follow(force) for force in self._reactions(x)]
        return np.array(forces)

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
        for i, rows in enumerate(self._rows):
            forces[:, i, nodes.owned] = times(rows, w).T
        self.space.comm.Allreduce(MPI.IN_PLACE, forces)
        return forces


class ElasticPunch(SlidingPunch):
    """All friction states of an elastic punch and the plate, each on the mesh of the plate.

    With S the normal reactions by normal displacements held at the contact nodes, T those by tangential
    forces, of the plate, and S', T' of the mirrored punch, whose displacement is v' by contact forces R:

        R = S (P - v') + g T R,   R = S' v' - g T' R.

    Solutions are dense algebra. Their displacements in the plate are combinations of few fields, a basis
    of all that frictions require.

    Args:
        space, solver, negligible, heights, left: as of :class:`SlidingPunch`.
        response: of the plate and the punch.
    """

    response: PairAtSpeed

    def __init__(
        self, space: Space, response: PairAtSpeed, solver: str = "direct", negligible: float = 0.0,
        heights: NDArray[np.float64] | None = None, left: float = 0.0,
    ) -> None:  # fmt: skip
        unit = np.eye(len(space.contact.s))
        # v' is that of the first node and, of the others, what they move farther. So the contact's common
        # motion, which is large, spoils no digits of the rest.
        others = unit[1:]
        punch = SlidingPunch(space, response.punch, solver, negligible, others)
        each = others if heights is None else np.vstack([heights, others])
        super().__init__(space, response.plate, solver, negligible, each, left)
        self.response, count = response, len(self._spaces) - len(others)
        self._spaces, self._others = self._spaces[:count], self._spaces[count:]
        #: Forces in the plate by each unit of v', (n, 2, n).
        self._moving = _forces([self._spaces[0], *self._others])
        S, S_punch = self._moving[:, 1].T, _forces(punch._spaces)[:, 1].T
        T, T_punch = (of._of_nodes[:, 1].T for of in (self, punch))
        punch.destroy()
        #: -v' by R, for g = 0 and for each unit of g; and matrices of the equations of R, likewise.
        self._moved = -response.ratio * np.linalg.solve(S_punch, [unit, T_punch])
        self._equations = unit - S @ self._moved[0], -S @ self._moved[1] - T
        #: 0 where the punch is the softer one: all of the plate's displacement is in the basis then.
        self._rigid = 1.0
        if response.punch.n * response.ratio > response.plate.n:
            self._rigid, self._moved = 0.0, np.linalg.solve(S, [unit, -T])
        self._bases: list[NDArray[np.float64]] = []
        self._fields = [list(of.fields) for of in self._spaces]
        self._forces = [of.forces for of in self._spaces]

    @property
    def fields(self) -> list[PETSc.Vec]:
        """Displacements of the plate: of each part under a rigid punch, and of its basis."""
        return [field for of_part in self._fields for field in of_part]

    def _changes(self, g: NDArray, part: int) -> NDArray[np.float64]:
        """Displacements -v' and tangential forces g R of a part for every g, (states, 2 n)."""
        (first, second), (moved, by_g) = self._equations, self._moved
        forces, changes = self._spaces[part].forces[0, 1], []
        for value in g.tolist():
            R = np.linalg.solve(first + value * second, forces)
            changes.append(np.append((moved + value * by_g) @ R, value * R))
        return np.array(changes)

    def prepare(self, g: NDArray[np.float64]) -> None:
        spread = g[np.unique(np.linspace(0, len(g) - 1, _SPREAD).astype(int))]
        n = len(self._moving)
        units = np.array(
            [-self._spaces[0].fields[0].array_r, *(of.fields[0].array_r for of in self._others)]
        )
        for i in range(len(self._spaces)):
            changes = self._changes(np.concatenate([spread, -spread]), i)
            _, size, rows = np.linalg.svd(changes, full_matrices=False)
            basis = rows[size > LEAST * size[0]]
            b = self._tangential(basis[:, n:].T)
            x = self._displacements(b)
            residuals = self._residuals(x, b, np.zeros(b.shape[1]))
            if np.any(g):
                self.factor.check(b, x, residuals)
            x += self._corrections(residuals)
            fields = [vector(self.factor.A, column) for column in x.T]
            forces = np.array([self._boundary.follow(*pair) for pair in zip(self._reactions(x), fields)])
            for field, along in zip(fields, basis[:, :n] @ units):
                field.setArray(field.array_r + along)
            self._bases.append(basis)
            self._fields[i] += fields
            self._forces[i] = np.concatenate(
                [self._forces[i], forces + np.tensordot(basis[:, :n], self._moving, 1)]
            )
        for of in self._others:
            of.fields[0].destroy()

    def parts(self, g: NDArray[np.float64], shapes: int | None = None) -> list[Part]:
        first, every = np.full((len(g), 1), self._rigid), list(enumerate(zip(self._bases, self._forces)))
        return [
            Part(np.hstack([first, self._changes(g, i) @ basis.T]), forces)
            for i, (basis, forces) in every[: None if shapes is None else 1 + shapes]
        ]


def _forces(spaces: Sequence[KrylovSpace]) -> NDArray[np.float64]:
    """Forces by a common displacement 1 of all nodes, of a flat punch's space, and by each shape."""
    return np.array([-spaces[0].forces[0], *(of.forces[0] for of in spaces[1:])])


def sliding_punch(space: Space, response: HalfPlane, *args: Any) -> SlidingPunch:
    """Punch of the arguments of :class:`SlidingPunch`, elastic where the response is that of a pair."""
    if isinstance(response, PairAtSpeed):
        return ElasticPunch(space, response, *args)
    return SlidingPunch(space, response, *args)


@dataclass(frozen=True)
class Frictions:
    """Values of g = σ_XY/σ_YY at which punches are sampled.

    Attributes:
        g: the values, all different, (frictions,).
        weights: barycentric weights of the polynomial through values there.
    """

    g: NDArray[np.float64]
    weights: NDArray[np.float64]

    def shares(self, g: NDArray) -> NDArray[np.float64]:
        """Weights that interpolate values at the frictions to others, (len(g), frictions)."""
        return barycentric(self.g, self.weights, g)


@dataclass(frozen=True)
class Sampled:
    """Parts of a punch at a speed, or at several, at some frictions.

    Attributes:
        forces: in Y at the contact nodes, (..., parts, frictions, nodes); those in X are g times these.
        slopes: of both displacements along X at places on the surface, none where they are not needed,
            (..., 2, parts, frictions, places).
        rounding: error of slopes of u by rounding, (..., parts, frictions, places).
        fields: displacements, this rank's unknowns, none where they are not needed,
            (..., parts, frictions, unknowns).
    """

    forces: NDArray[np.float64]
    slopes: NDArray[np.float64]
    rounding: NDArray[np.float64]
    fields: NDArray[np.float64]

    def scaled(self, forces: NDArray, slopes: NDArray) -> "Sampled":
        """Numbers times factors of nodal forces, (frictions, nodes), and slopes, (frictions, places)."""
        return Sampled(self.forces * forces, self.slopes * slopes, self.rounding * slopes, self.fields)

    def numbers(self) -> Iterator[NDArray[np.float64]]:
        """All numbers that a fit needs, part by part, (..., n); the rounding is not among them."""
        for part in range(self.forces.shape[-3]):
            for values in (self.forces[..., part, :, :], self.slopes[..., part, :, :]):
                yield values.reshape(*values.shape[:-3], -1)
            fields = self.fields[..., part, :, :]
            yield fields.reshape(*fields.shape[:-2], -1)


def together(several: Sequence[Sampled], shares: NDArray) -> Sampled:
    """Sum of the numbers of several speeds with weights ``shares``, (len(several),)."""

    def total(name: str, of: NDArray) -> NDArray:
        return np.asarray(
            sum(share * getattr(sample, name) for share, sample in zip(of, several) if share)
        )

    rounding = total("rounding", np.abs(shares))
    return Sampled(total("forces", shares), total("slopes", shares), rounding, total("fields", shares))


def sampled(punch: Punch, at: Frictions, slopes: Slopes, with_fields: bool = False) -> Sampled:
    """A punch's parts at some frictions.

    Args:
        punch: the punch, solved for these frictions.
        at: the frictions.
        slopes: of its fields.
        with_fields: keep the displacements.
    """
    parts, first, fields = punch.parts(at.g), 0, punch.fields
    of_slopes, noise, displacements = [], [], []
    for part in parts:
        own = slice(first, first + part.weights.shape[1])
        weights = np.zeros((len(at.g), len(fields)))
        weights[:, own] = part.weights
        of_slopes.append(slopes.of(weights))
        noise.append(slopes.rounding(weights))
        u = np.array([field.array_r if with_fields else [] for field in fields[own]])
        displacements.append(part.weights @ u)
        first = own.stop
    forces = np.array([part.normal for part in parts])
    return Sampled(forces, np.array(of_slopes).swapaxes(0, 1), np.array(noise), np.array(displacements))


class FittedPunch(Punch):
    """All states of the punch with friction at a speed to which its parts were interpolated.

    Args:
        space: the finite element space.
        response: of the half-plane.
        at: frictions at which the parts are known.
        samples: the parts there.
    """

    def __init__(self, space: Space, response: HalfPlane, at: Frictions, samples: Sampled) -> None:
        self.space, self.response = space, response
        self._at, self._samples = at, samples
        each = np.concatenate(list(samples.fields))
        #: Displacements of every part at every friction.
        self.fields = [PETSc.Vec().createWithArray(row.copy(), comm=space.comm) for row in each]

    @property
    def slopes(self) -> Slopes:
        """Slopes of the fields at the places on the surface."""
        # Part after part, of both displacements.
        basis = np.concatenate(list(np.moveaxis(self._samples.slopes, 1, 0)), axis=1)
        return Slopes(basis.swapaxes(1, 2), np.concatenate(list(self._samples.rounding)).T)

    def parts(self, g: NDArray[np.float64], shapes: int | None = None) -> list[Part]:
        shares = self._at.shares(g)
        forces = self._samples.forces[: None if shapes is None else 1 + shapes]
        # No equations are assembled here from which tangential forces could be read.
        return [Part(shares, normal[:, None]) for normal in forces]

    def release(self) -> None:
        """Free the fields."""
        for field in self.fields:
            field.destroy()

    destroy = release
