"""Half-plane under a prescribed pressure: the cheaper mode, in which the pressure is known beforehand.

:class:`LoadedHalfPlane` has the fields of tractions at one speed. :class:`LinearLoads` has those of the
two linear loads of an interval, from which the field of any pressure that is linear between knots is
summed (:class:`Pieces`). The half-plane has no length of its own, so the interval is [-1, 1] and one mesh
serves pieces of every width. No kink of the pressure lies inside a cell, however narrow the piece is.

Displacements are known relative to each cell's own place, to the last digits of how the cell deforms:
next to an end of the interval a cell is a billionth of the distance that all of it moves.
"""

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc

from ..rays import NEAR, rays
from ..solids.solid import Response
from .boundary import FarBoundary
from .fields import forces, gradients_at, shapes
from .linear import LinearSolver
from .space import Space, Traction


class LoadedHalfPlane:
    """Half-plane without punch at one speed: one factor for many loads, which the far boundary follows.

    Args:
        space: the finite element space.
        response: of the half-plane, at a speed below its limit.
        corrected: also compute corrections of the fields.
    """

    def __init__(self, space: Space, response: Response, corrected: bool = False) -> None:
        self.space, self.response = space, response
        A = space.assemble(response)
        self._far = FarBoundary(space, response, A)
        A = space.held(A, response, ("far",))
        self.factor = LinearSolver(A, space.clock, definite=not space.mixed)
        #: Two displacement fields a load: of σ_YY, and of σ_XY equal to it.
        self.fields: list[PETSc.Vec] = []
        #: ∫ σ_YY d(X/a) over N/(2a) of each load.
        self.resultants: list[float] = []
        #: Correction of each field, whose last digit is one of the motion of the whole half-plane.
        self.corrections: list[PETSc.Vec] = []
        self._corrected = corrected
        if self._far.loads:
            self._far.set_fields(self.factor.solve_all(self._far.loads))

    def load(self, σ_YY: Traction, knots: NDArray | tuple[float, ...] = ()) -> None:
        """Add the fields of σ_YY alone and of σ_XY = σ_YY alone, and the discrete load's resultant.

        Args:
            σ_YY: the load.
            knots: positions X over a, under the punch, between which it is smooth.
        """
        load, comm = self.space.nodal_forces(σ_YY, knots), self.space.comm
        X = self.space.chart.surface_position(load.s)
        resultant = comm.allreduce(float(load.forces.sum()))
        moments = comm.allreduce(self._far.tests(X) @ load.forces)
        for component in (1, 0):
            b = self.factor.A.createVecLeft()
            b.setValues(load.numbers + component, load.forces, addv=PETSc.InsertMode.ADD_VALUES)
            b.assemble()
            self.fields.append(self.factor.solve(b))
            if self._far.fields:
                self.fields[-1].maxpy(moments.tolist(), self._far.fields[1 - component :: 2])
            if self._corrected:
                self.corrections.append(self._correction(self.fields[-1], b))
            b.destroy()
        self.resultants.append(resultant)

    def _correction(self, field: PETSc.Vec, load: PETSc.Vec) -> PETSc.Vec:
        """Field of the load less the forces of the cells' deformation."""
        residual = forces(self.space, self.response, field)
        residual.aypx(-1.0, load)
        residual.setValues(self.space.far_dofs, np.zeros(len(self.space.far_dofs)))
        residual.assemble()
        correction = self.factor.solve(residual)
        residual.destroy()
        return correction

    def destroy(self) -> None:
        """Free factor and fields."""
        for held in (self.factor, self._far, *self.fields, *self.corrections):
            held.destroy()


#: Fields: of σ_YY that falls from 1 at -1 to 0 at 1 and of σ_XY equal to it, and of their mirror images.
FIELDS = 4


class LinearLoads:
    """Displacement gradients under linear loads of an interval, ``FIELDS`` in all. Collective.

    Args:
        space: the finite element space.
        response: of the half-plane, at a speed below its limit.

    Attributes:
        resultants: ∫ σ_YY dX of the discrete loads of the first and of the second kind, 1 each.
        factor: of the linear system, freed; its counts of solves and residuals remain.
    """

    def __init__(self, space: Space, response: Response) -> None:
        self.space, self.response = space, response
        with space.keeping(response):
            loaded = LoadedHalfPlane(space, response, corrected=True)
            try:
                loaded.load(lambda left, right: right / 2.0)
                loaded.load(lambda left, right: left / 2.0)
                self._shapes = shapes(space, response, loaded.fields, loaded.corrections)
            finally:
                loaded.destroy()
        self.resultants, self.factor = np.array(loaded.resultants), loaded.factor

    def gradients(self, points: NDArray) -> NDArray[np.float64]:
        """μ ∂u_i/∂X_j over the load's largest stress, at points (n, 2) with Y <= 0: (n, 2, 2, FIELDS).

        Raises:
            MeshError: a point lies outside the mesh.
        """
        return gradients_at(self.space, self.response, points, lambda cells: self._shapes[cells])


#: Pieces that meet have at most this ratio of widths, so that both meshes resolve what cancels there.
_RATIO = 8.0

#: Pairs of a piece and a point that are evaluated at once; keeps memory within some ten megabytes.
_AT_ONCE = 50_000


class Pieces:
    """Prescribed pressure, linear between knots, cut into pieces.

    Args:
        knots: positions X over a that grow, (n,).
        values: σ_YY there over N/(2a), (n,).
    """

    def __init__(self, knots: NDArray, values: NDArray) -> None:
        #: Ends of the pieces: the knots, and more where a narrow piece meets a wide one.
        self.knots = _graded(knots)
        self.values = np.interp(self.knots, knots, values)

    def resultant(self, loads: LinearLoads) -> float:
        """∫ σ_YY d(X/a) over N/(2a) of the discrete loads."""
        return float(self._half @ self._ends @ loads.resultants)

    def gradients(self, loads: LinearLoads, points: NDArray) -> NDArray[np.float64]:
        """μ ∂u_i/∂X_j over N/(2a) of σ_YY alone and of σ_XY equal to it, at points (n, 2) over a, Y <= 0.

        Collective.

        Returns:
            Array (n, 2, 2, 2).
        """
        half, jumps = self._half, np.zeros(len(self.knots), dtype=bool)
        jumps[[0, -1]] = self.values[[0, -1]] != 0.0
        near = NEAR * np.minimum(np.append(half, np.inf), np.append(np.inf, half))
        from_points = rays(points, self.knots, near, jumps)
        result = np.zeros((len(from_points.origins), 2, 2, 2))
        loaded = np.flatnonzero(self._ends.any(axis=1))
        together = max(1, _AT_ONCE // max(len(from_points.origins), 1))
        for start in range(0, len(loaded), together):
            pieces = loaded[start : start + together]
            places = self._places(pieces, from_points.origins, from_points.offsets)
            G = loads.gradients(places.reshape(-1, 2)).reshape(*places.shape[:2], 2, 2, 2, FIELDS // 2)
            result += np.einsum("pe,pnijed->nijd", self._ends[pieces], G)
        return from_points.continued(result)

    @property
    def _half(self) -> NDArray[np.float64]:
        return np.diff(self.knots) / 2.0

    @property
    def _ends(self) -> NDArray[np.float64]:
        """σ_YY at both ends of each piece, (pieces, 2)."""
        return np.column_stack([self.values[:-1], self.values[1:]])

    def _places(self, pieces: NDArray, origins: NDArray, offsets: NDArray) -> NDArray[np.float64]:
        """Places in the pieces' own coordinates, measured from the nearer end, (pieces, n, 2)."""
        half = self._half[pieces][:, None]
        from_left, from_right = (
            ((origins - self.knots[pieces + i][:, None]) + offsets[:, 0]) / half for i in (0, 1)
        )
        w = np.where(np.abs(from_left) < np.abs(from_right), from_left - 1.0, from_right + 1.0)
        return np.stack([w, offsets[:, 1] / half], axis=-1)


def _graded(knots: NDArray) -> NDArray[np.float64]:
    """Knots among which no interval is more than ``_RATIO`` times as wide as its neighbour."""
    ends = [float(knot) for knot in knots]
    for direction in (1, -1):  # narrow ones to the left of wide ones, then to the right
        ends = sorted(ends) if direction == 1 else sorted(ends, reverse=True)
        graded = ends[:2]
        for knot in ends[2:]:
            width = abs(graded[-1] - graded[-2])
            while abs(knot - graded[-1]) > _RATIO * width:
                width *= _RATIO / 2.0
                graded.append(graded[-1] + direction * width)
            graded.append(knot)
        ends = graded
    return np.array(sorted(ends))
