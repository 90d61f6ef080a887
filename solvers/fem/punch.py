"""Rigid punch with friction and two sharp edges on the finite element half-plane, its pressure unknown.

Trial functions have v = -v₀ + P on the contact nodes, test functions w_Y + g w_X = 0 there. Nodal
reactions are then the consistent contact forces; no penalty and no multiplier is needed. With the normal
displacement held and the tangential free, the matrix is symmetric and does not depend on g: if T r are
the normal reactions caused by tangential forces r, friction requires

    (I - g T) R = R₀.

The Krylov space of (T, R₀), made by Arnoldi's method, holds the contact forces of every g at that speed;
a profile P that is not flat has a space of its own. For few contact nodes T is formed as a matrix. For a
contact with free ends P is a combination of several shapes, each with a space of its own. Every state of
a punch with friction is a sum of these parts.

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
from ..solids.solid import Response
from .boundary import FarBoundary, forces_of_profile, ones, product, set_zero
from .linear import Factor, Multigrid
from .space import Space

#: Least relative residual of contact forces that can be required; the last digits are rounding.
LEAST = 1e-13
LIMIT = 120

#: Numbers of frictions up to which each is solved for itself; beyond, all share a triangular form.
_FEW = 40


class KrylovSpace:
    """The space of (T, R₀), by Arnoldi's method.

    Args:
        field: the punch without friction.
        forces: its forces in X and Y at the contact nodes, (2, n).
        refines: solutions are refined.
        left: relative residual of the contact forces that may remain, if it is above the least.

    Attributes:
        fields, forces: without friction first, then those of each tangential load.
        complete: the space holds every answer.
    """

    def __init__(self, field: PETSc.Vec, forces: NDArray, refines: bool, left: float) -> None:
        self.fields, self.forces, self.refines = [field], [forces], refines
        self._left = max(left, LEAST)
        self._size = np.linalg.norm(forces[1])
        self._V = [forces[1] / self._size]
        self._H = np.zeros((LIMIT + 1, LIMIT))
        self._triangle = np.empty((0, 0)), np.empty((0, 0))
        self.complete = False

    @property
    def last(self) -> NDArray[np.float64]:
        """The load that is not yet applied, (n,)."""
        return self._V[len(self.fields) - 1]

    def take(self, field: PETSc.Vec, forces: NDArray) -> None:
        """One Arnoldi step: the field and the forces that the last load causes."""
        j = len(self.fields) - 1
        self.fields.append(field)
        self.forces.append(forces)
        w = forces[1]
        for _ in range(2):  # twice is enough
            h = np.array(self._V) @ w
            self._H[: j + 1, j] += h
            w = w - np.array(self._V).T @ h
        self._H[j + 1, j] = np.linalg.norm(w)
        # A happy breakdown: the space holds every answer.
        self.complete = bool(self._H[j + 1, j] <= 1e-15 * np.linalg.norm(self._H[: j + 1, j]))
        if not self.complete:
            self._V.append(w / self._H[j + 1, j])

    def converged(self, g: NDArray) -> NDArray[np.float64] | None:
        """Coefficients y of R = V y for every g, (states, m); None where the space is too small.

        Raises:
            SolveError: the space has grown to its limit.
        """
        m = len(self.fields) - 1
        if not m:
            return None
        y, residuals = self.solve(g)
        worst = int(np.argmax(residuals))
        if self.complete or residuals[worst] <= self._left:
            return y
        if m == LIMIT:
            raise SolveError(
                f"the contact forces at g = {g[worst]:g} (dimensionless) did not converge in "
                f"{LIMIT} steps: residual {residuals[worst]:.3g}, expected {self._left:g}"
            )
        return None

    def solve(self, g: NDArray) -> tuple[NDArray, NDArray]:
        """Coefficients y of R = V y for every g, (states, m), and their relative residuals, (states,)."""
        m = len(self.fields) - 1
        if len(g) <= _FEW:
            first = np.zeros((len(g), m, 1))
            first[:, 0] = self._size
            y = np.linalg.solve(np.eye(m) - g[:, None, None] * self._H[:m, :m], first)[..., 0]
            return y, self._residuals(g, y)
        T, Q = self._triangle
        if len(T) != m:  # once for all g: Schur's form keeps the digits that eigenvectors may lose
            T, Q = self._triangle = schur(self._H[:m, :m], output="complex")
        solved = np.tile((self._size * Q[0].conj())[:, None], len(g))
        for i in reversed(range(m)):
            solved[i] += g * (T[i, i + 1 :] @ solved[i + 1 :])
            solved[i] /= 1.0 - g * T[i, i]
        y = (Q @ solved).real.T
        return y, self._residuals(g, y)

    def _residuals(self, g: NDArray, y: NDArray) -> NDArray[np.float64]:
        """Relative residuals of (I - g T) R = R₀ for coefficients y (states, m): (states,)."""
        m = y.shape[1]
        return np.asarray(np.abs(g * self._H[m, m - 1] * y[:, -1]) / np.linalg.norm(y, axis=1))


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
    """

    space: Space
    response: Response

    @property
    def fields(self) -> Sequence[PETSc.Vec]:
        """Displacements of the parts, part after part."""
        raise NotImplementedError

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

#: Nodes of a contact up to which loads at all of them at once cost less than one after the other.
_FEW_NODES = 64


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
        #: Krylov spaces of the flat punch, and of each shape.
        self._spaces = self._krylov_spaces(shaped, negligible)

    @property
    def fields(self) -> list[PETSc.Vec]:
        """Displacements of the basis: the punches without friction, each before its tangential loads."""
        return [field for space in self._spaces for field in space.fields]

    def prepare(self, g: NDArray[np.float64]) -> None:
        """Complete the basis for these values of σ_XY/σ_YY, sorted.

        The residual of the basis is a smooth function of g, so some values spread over all suffice.
        """
        spread = np.unique(np.linspace(0, len(g) - 1, _SPREAD).astype(int))
        self._contact_forces(self._spaces, g[spread])

    def parts(self, g: NDArray[np.float64], shapes: int | None = None) -> list[Part]:
        spaces = self._spaces[: None if shapes is None else 1 + shapes]
        return [self._of(space, g, y) for space, y in zip(spaces, self._contact_forces(spaces, g))]

    def _of(self, space: KrylovSpace, g: NDArray, y: NDArray) -> Part:
        """Part of a Krylov space at frictions g, by coefficients y (states, m) of its contact forces."""
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
            # Moments after the resultants have too little effect to need that.
            self._refine(fields[:2], loads[:2], [0.0, 0.0])
            self._boundary.set_fields(fields)
            X = self.space.chart.surface_position(contact.s)
            self._boundary.take(X, [self._reactions(field) for field in fields])

    def _krylov_spaces(self, forces: list[PETSc.Vec], negligible: float) -> list[KrylovSpace]:
        """Krylov spaces of the flat punch at v = -1 and of each shape, begun without friction.

        Args:
            forces: nodal forces of the held displacements; they are freed.
            negligible: see the class.
        """
        fields = self._displacements(forces)
        rough = [self._reactions(field) for field in fields]
        # Under the flat punch all of the contact moves by the same distance, and no other load acts.
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

        Spaces grow as they need, together where several do: one pass over the factor serves them.
        """
        if not np.any(g):
            return [np.zeros((len(g), 0)) for _ in spaces]
        coefficients: list[NDArray | None] = [None for _ in spaces]
        while True:
            for i, space in enumerate(spaces):
                if coefficients[i] is None:
                    coefficients[i] = space.converged(g)
            short = [space for space, y in zip(spaces, coefficients) if y is None]
            if not short:
                return [y for y in coefficients if y is not None]
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
            fields, forces = self._answers(self._tangential(list(np.eye(n))), [refines] * n)
            of_nodes = np.moveaxis(np.array(forces), 0, 2)
            self._nodal = np.array([field.array_r for field in fields]).T, of_nodes
            for field in fields:
                field.destroy()
        return self._nodal

    def _answers(
        self, loads: Sequence[PETSc.Vec], refines: Sequence[bool]
    ) -> tuple[list[PETSc.Vec], list[NDArray[np.float64]]]:
        """Displacements under loads, refined where ``refines`` says so, and forces; frees the loads."""
        fields = self._displacements(loads)
        refined = [i for i, refine in enumerate(refines) if refine]
        self._refine([fields[i] for i in refined], [loads[i] for i in refined], [0.0] * len(refined))
        for b in loads:
            b.destroy()
        return fields, [self._boundary.follow(field, self._reactions(field)) for field in fields]

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
        """Displacements under nodal forces, the effect of the held displacements included."""
        fields, held = self.factor.solve_all(forces), self.space.held_dofs
        for u, b in zip(fields, forces):
            u.setValues(held, b.getValues(held))  # an iterative solver only comes near them
            u.assemble()
        return fields

    def _refine(
        self, fields: Sequence[PETSc.Vec], loads: Sequence[PETSc.Vec | None], v: Sequence[float]
    ) -> None:
        """Solve once more for the residual forces of displacements.

        The contact moves far before the body deforms, the farther the nearer the Rayleigh speed, and what
        forces that motion seems to need is rounding. The residual is taken without it: the rest of the
        displacement is zero under a flat punch, and the far boundary moves instead.

        Args:
            fields: the displacements, in place.
            loads: nodal forces, those of a profile's held displacements among them.
            v: normal displacement of the contact where all of it moves by the same distance.
        """
        residuals = [self._residual(*of_one) for of_one in zip(fields, loads, v)]
        wrong = [(u, residual) for u, residual in zip(fields, residuals) if residual.norm() > 0.0]
        if wrong:
            for (u, _), correction in zip(wrong, self.factor.solve_all([b for _, b in wrong])):
                u.axpy(1.0, correction)
                correction.destroy()
        for residual in residuals:
            residual.destroy()

    def _residual(self, u: PETSc.Vec, load: PETSc.Vec | None, v: float) -> PETSc.Vec:
        """Residual forces of a displacement u under a load, see :meth:`_refine`."""
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
        """Mean displacement along X and Y of the contact nodes, over N/(2μ)."""
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
        forces = np.zeros((2, len(nodes.s)))
        w = self._without(u, self._contact_motion(u))
        for i, rows in enumerate(self._rows):
            force = rows.createVecLeft()
            rows.mult(w, force)
            forces[i, nodes.owned] = force.array_r
            force.destroy()
        w.destroy()
        comm.Allreduce(MPI.IN_PLACE, forces)
        return forces


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
class EdgeFactors:
    """Singular factors of the edges at each friction: numbers are a smooth factor times these.

    Attributes:
        forces: factors of nodal forces, (frictions, nodes).
        slopes: factors of slopes at places on the surface, (frictions, places).
    """

    forces: NDArray[np.float64]
    slopes: NDArray[np.float64]


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

    def smooth(self, singular: EdgeFactors) -> "Sampled":
        """Smooth numbers: these over the singular factors of the edges."""
        slopes, forces = self.slopes / singular.slopes, self.forces / singular.forces
        return Sampled(forces, slopes, self.rounding / singular.slopes, self.fields)

    def singular(self, singular: EdgeFactors) -> "Sampled":
        """Smooth numbers times the singular factors of the edges."""
        slopes, forces = self.slopes * singular.slopes, self.forces * singular.forces
        return Sampled(forces, slopes, self.rounding * singular.slopes, self.fields)

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


def sampled(punch: Punch, at: Frictions, slopes: Any = None, with_fields: bool = False) -> Sampled:
    """A punch's parts at some frictions.

    Args:
        punch: the punch, solved for these frictions.
        at: the frictions.
        slopes: of its fields, a :class:`.fields.SurfaceSlopes`; None where they are not needed.
        with_fields: keep the displacements.
    """
    parts, first, count = punch.parts(at.g), 0, len(at.g)
    forces = np.array([part.normal for part in parts])
    fields = punch.fields
    of_slopes: list[Any] = []
    noise: list[NDArray] = []
    displacements: list[NDArray] = []
    for part in parts:
        own = fields[first : first + part.weights.shape[1]]
        if slopes is not None:
            weights = np.zeros((count, len(fields)))
            weights[:, first : first + len(own)] = part.weights
            of_slopes.append(slopes.of(weights))
            noise.append(slopes.rounding(weights))
        if with_fields:
            displacements.append(part.weights @ np.array([field.array_r for field in own]))
        first += len(own)
    if slopes is None:
        of_slopes, noise = [np.empty((2, count, 0))] * len(parts), [np.empty((count, 0))] * len(parts)
    if not with_fields:
        displacements = [np.empty((count, 0))] * len(parts)
    return Sampled(forces, np.array(of_slopes).swapaxes(0, 1), np.array(noise), np.array(displacements))


class FittedPunch(Punch):
    """All states of the punch with friction at a speed to which its parts were interpolated.

    Args:
        space: the finite element space.
        response: of the half-plane.
        at: frictions at which the parts are known.
        samples: the parts there.
    """

    def __init__(self, space: Space, response: Response, at: Frictions, samples: Sampled) -> None:
        self.space, self.response = space, response
        self._at, self._samples = at, samples
        self._fields = _Fields(np.concatenate(list(samples.fields)), space)

    @property
    def fields(self) -> Sequence[PETSc.Vec]:
        """Displacements of every part at every friction; made when the first is accessed."""
        return self._fields

    @property
    def slopes(self) -> "FittedSlopes":
        """Slopes of the fields at the places on the surface."""
        return FittedSlopes(self._samples.slopes, self._samples.rounding)

    def parts(self, g: NDArray[np.float64], shapes: int | None = None) -> list[Part]:
        shares = self._at.shares(g)
        forces = self._samples.forces[: None if shapes is None else 1 + shapes]
        # No equations are assembled here from which tangential forces could be read.
        return [Part(shares, normal[:, None]) for normal in forces]

    def release(self) -> None:
        """Free the fields."""
        self._fields.destroy()

    destroy = release


class FittedSlopes:
    """Derivatives along X, on the surface, of combinations of fitted fields.

    Args:
        slopes, rounding: see :class:`Sampled`.
    """

    def __init__(self, slopes: NDArray, rounding: NDArray) -> None:
        self._basis = [np.concatenate(list(of_one)) for of_one in slopes]
        self._rounding = np.concatenate(list(rounding))

    def of(self, weights: NDArray) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """μ u,X and μ v,X over N/(2a) of combinations with weights (states, fields): (states, n)."""
        u_X, v_X = (weights @ basis[: weights.shape[1]] for basis in self._basis)
        return u_X, v_X

    def rounding(self, weights: NDArray) -> NDArray[np.float64]:
        """Error by rounding of μ u,X of combinations with weights (states, fields): (states, n)."""
        return np.abs(weights) @ self._rounding[: weights.shape[1]]


class _Fields(Sequence[PETSc.Vec]):
    """Vectors with given entries, (fields, unknowns), made when the first is accessed."""

    def __init__(self, numbers: NDArray, space: Space) -> None:
        self._numbers, self._space = numbers, space
        self._made: list[PETSc.Vec] = []

    def __len__(self) -> int:
        return len(self._numbers)

    def __getitem__(self, which: Any) -> Any:
        if not self._made:
            comm = self._space.comm
            self._made = [PETSc.Vec().createWithArray(row.copy(), comm=comm) for row in self._numbers]
        return self._made[which]

    def destroy(self) -> None:
        for field in self._made:
            field.destroy()
        self._made = []
