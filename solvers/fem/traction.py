"""Half-plane under a prescribed pressure: the cheaper mode, in which the pressure is known beforehand.

The pressure is the user's own, σ_XY = g σ_YY: over a uniform half-plane piece by piece between its knots
(:class:`PiecesLevel`), over layers as a whole on cells graded towards its knots (:class:`WholeLevel`). In
mode ``traction`` it is that of a flat punch by its closed form (:class:`FormulaLevel`).

:class:`LoadedHalfPlane` has the fields of tractions at one speed. :class:`LinearLoads` has those of the
two linear loads of an interval, from which the field of any pressure that is linear between knots is
summed (:class:`Pieces`). The half-plane has no length of its own, so the interval is [-1, 1] and one mesh
serves pieces of every width. No kink of the pressure lies inside a cell, however narrow the piece is.

All of the half-plane moves with a load, and next to an end of the interval a cell is a billionth of that
motion: in its displacement the deformation has lost its digits. A field and a small correction together
hold it, if they are added only after each cell's own motion was subtracted.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc

from ..contact.closed_form import FlatPunch
from ..contact.prescribed_pressure import LinearPressure
from ..contact.pressure import Pressure
from ..contact.solution import Task
from ..contact.stresses import Places, Surface, Turns, turns_at_knots
from ..rays import NEAR, rays
from ..solids.half_plane import HalfPlane
from .boundary import FarBoundary
from .discretisation import Discretisation
from .fields import Displacement, InteriorGradients
from .ladder import Level
from .linear import LinearSolver, vector
from .punch import ContactStates
from .solution import SolvedStates
from .space import Space, Traction


class LoadedHalfPlane:
    """Half-plane without punch at one speed: one factor for many loads, which the far boundary follows.

    Args:
        space: the finite element space.
        response: of the half-plane, at a speed below its limit.

    Attributes:
        fields: two displacement fields a load: of σ_YY, and of σ_XY equal to it.
        resultants: ∫ σ_YY d(X/a) over N/(2a) of each load.
    """

    def __init__(self, space: Space, response: HalfPlane) -> None:
        self.space, self.response = space, response
        A = space.assemble(response)
        self._far = FarBoundary(space, response, A)
        A = space.held(A, response, ("far",))
        self.factor = LinearSolver(A, space.clock, definite=not space.mixed)
        self._of_far = self.factor.solve(self._far.loads) if space.terms else self._far.loads
        self._first = A.getOwnershipRange()[0]
        self._loads: list[NDArray] = []
        self.fields: list[PETSc.Vec] = []
        self.resultants: list[float] = []

    def load(self, σ_YY: Traction, knots: NDArray | tuple[float, ...] = ()) -> None:
        """Add the fields of σ_YY alone and of σ_XY = σ_YY alone, and the discrete load's resultant.

        Args:
            σ_YY: the load.
            knots: positions X over a, under the punch, between which it is smooth.
        """
        (numbers, s, forces), comm = self.space.nodal_forces(σ_YY, knots), self.space.comm
        resultant = comm.allreduce(float(forces.sum()))
        moments = comm.allreduce(self._far.tests(self.space.chart.surface_position(s)) @ forces)
        for component in (1, 0):
            b = self.factor.A.createVecLeft()
            b.setValues(numbers + component, forces, addv=PETSc.InsertMode.ADD_VALUES)
            b.assemble()
            self._loads.append(np.array(b.array_r))
            b.destroy()
        x = self.factor.solve(np.column_stack(self._loads[-2:]))
        for component, column in zip((1, 0), x.T):
            moved = self._of_far[:, 1 - component :: 2] @ moments
            self.fields.append(vector(self.factor.A, column + moved))
        self.resultants.append(resultant)

    def correct(self) -> None:
        """Add the corrections of all fields as fields of loads without a resultant. Collective.

        The last digit of a field is one of the motion of the whole half-plane. Its correction is the
        field of its load less the forces of the cells' deformation.
        """
        residuals = np.column_stack(self._loads) - self._forces_of_deformation()
        residuals[self.space.far_dofs - self._first] = 0.0
        self.fields += [vector(self.factor.A, column) for column in self.factor.solve(residuals).T]
        self.resultants += [0.0] * len(self.resultants)

    def _forces_of_deformation(self) -> NDArray[np.float64]:
        """Nodal forces of the condensed fields, (rows, fields).

        Equal to the matrix times the fields, but without the rounding of the cells' own motion.
        """
        space, numbers = self.space, self.space.outer_numbers
        sums = [field.duplicate() for field in self.fields]
        deformed = _deformed(space, self.fields)
        for cells in space.pieces(len(numbers)):
            condensed = space.condensed(self.response, cells)
            for rows, S, u in zip(numbers[cells] // 2, condensed, deformed[cells]):
                forces = S @ u.reshape(len(S), -1)
                for total, column in zip(sums, forces.T):
                    total.setValuesBlocked(rows, column, addv=PETSc.InsertMode.ADD_VALUES)
        for total in sums:
            total.assemble()
        forces = np.column_stack([total.array_r for total in sums])
        for total in sums:
            total.destroy()
        return forces

    def destroy(self) -> None:
        """Free factor and fields."""
        for held in (self.factor, *self.fields):
            held.destroy()


def _deformed(space: Space, fields: Sequence[PETSc.Vec]) -> NDArray[np.float64]:
    """Outer values of all of this rank's cells, displacements less that of the cell's first node."""
    outer = space.fetch(fields, space.outer_numbers)
    displacement = outer[:, : len(space.kernel.outer)]
    displacement -= displacement[:, :1].copy()
    return outer


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

    def __init__(self, space: Space, response: HalfPlane) -> None:
        self.space, self.response = space, response
        loaded = LoadedHalfPlane(space, response)
        try:
            loaded.load(lambda left, right: right / 2.0)
            loaded.load(lambda left, right: left / 2.0)
            loaded.correct()
            outer = _deformed(space, loaded.fields[:FIELDS]) + _deformed(space, loaded.fields[FIELDS:])
            #: Values less those of a cell's first node, (cells, nodes of a cell, 2, FIELDS).
            self._shapes = np.concatenate([
                space.extended(outer[cells], response, np.arange(len(outer))[cells])
                for cells in [slice(0), *space.pieces(len(outer))]
            ])  # fmt: skip
        finally:
            loaded.destroy()
        self.resultants, self.factor = np.array(loaded.resultants[:2]), loaded.factor

    def gradients(self, points: NDArray) -> NDArray[np.float64]:
        """μ ∂u_i/∂X_j over the load's largest stress, at points (n, 2) with Y <= 0: (n, 2, 2, FIELDS).

        Raises:
            MeshError: a point lies outside the mesh.
        """
        values = self._shapes.__getitem__
        return InteriorGradients(self.space, self.response, values, points).of_fields()


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


class LoadsLevel(Level):
    """Half-plane under a prescribed pressure at one degree.

    Args:
        work, task, space, g: as of :class:`galinx.solvers.fem.ladder.Level`.

    Attributes:
        resultants: ∫ σ_YY d(X/a) over N/(2a) of the discrete loads; each load has two fields, of σ_YY
            alone and of an equal σ_XY.
    """

    resultants: NDArray[np.float64]
    mirrored = True

    def __init__(self, work: Discretisation, task: Task, space: Space, g: NDArray) -> None:
        super().__init__(work, task, space, g)
        self._solve()

    def _solve(self) -> None:
        """Solve for the fields of all loads."""
        self._loaded = loaded = LoadedHalfPlane(self.space, self.task.response)
        self._load(loaded)
        self.factor, self.fields = loaded.factor, loaded.fields
        self.resultants = np.array(loaded.resultants)

    def _load(self, loaded: LoadedHalfPlane) -> None:
        """Add the loads."""
        raise NotImplementedError

    @property
    def prescribed(self) -> LinearPressure:
        """Pressure of the user's own."""
        assert self.task.body.pressure
        return self.task.body.pressure

    def pressure(self, g: NDArray) -> Pressure:
        """Pressure of states with values g of σ_XY/σ_YY, (states,), or one of all."""
        return self.prescribed

    def weights(self, g: NDArray) -> NDArray[np.float64]:
        """Weights of the fields, (states, fields): 1 of σ_YY alone, g of an equal σ_XY."""
        return np.tile(np.column_stack([np.ones_like(g), g]), len(self.resultants))

    def states(self, g: NDArray, load: Any = None) -> SolvedStates:
        # The first field of a load has a normal resultant, the second an equal tangential one.
        units = np.array([[[0.0], [1.0]], [[1.0], [0.0]]])
        forces = np.asarray(np.kron(self.resultants[:, None, None], units), dtype=np.float64)
        body = self.task.body.loaded(load)
        contact = ContactStates(self.weights(g), forces, g, np.full(len(g), np.nan))
        return SolvedStates(
            self, body, contact.between(float(body.half_width), 0.0, False), self.pressure(g)
        )

    def turns(self, states: SolvedStates, surface: Surface) -> Turns | None:
        """Limits of stresses at knots, and between these."""
        g, weights = states.contact.g, states.contact.weights

        def σ_XX(X: NDArray) -> NDArray[np.float64]:
            at = self.displacement_at(replace(self.task, places=Places(X, np.empty((0, 2)))))
            return at.surface(g[:, None], weights, self.prescribed(X)).σ_XX

        return turns_at_knots(self.prescribed, g, σ_XX)

    def rounding(self, g: NDArray, load: Any = None) -> list[float]:
        """Zeros: the mirror image of a load is no load, so rounding is not measured."""
        return [0.0] * len(self.gauges(g[:1]))

    def close(self) -> None:
        self._loaded.destroy()


class FormulaLevel(LoadsLevel):
    """Flat punch's closed-form pressures, a load for each friction."""

    def _load(self, loaded: LoadedHalfPlane) -> None:
        for value in np.unique(self.g).tolist():
            loaded.load(FlatPunch(self.task.response, value).traction)

    def weights(self, g: NDArray) -> NDArray[np.float64]:
        own = g[:, None] == np.unique(self.g)
        return np.stack([own, g[:, None] * own], axis=2).reshape(len(g), -1)

    def pressure(self, g: NDArray) -> Pressure:
        return FlatPunch(self.task.response, g[:, None])

    def turns(self, states: SolvedStates, surface: Surface) -> None:
        return None


class WholeLevel(LoadsLevel):
    """Pressure of the user's own as a whole, on cells that end at its knots or are cut there.

    The corrections of the two fields are two fields more, a load without a resultant. The mirror image of
    the knots has another mesh.
    """

    mirrored = False

    def _load(self, loaded: LoadedHalfPlane) -> None:
        pressure = self.prescribed
        loaded.load(
            lambda left, right: pressure(np.where(left < right, left - 1.0, 1.0 - right)),
            pressure.knots[1:-1],
        )
        loaded.correct()

    def displacement_at(self, task: Task) -> Displacement:
        return Displacement(task, self.space, self.fields, continuation=self._continued)

    def _continued(self, X: NDArray) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Continuation of slopes to knots, see :class:`Displacement`."""
        knots, values = self.prescribed.knots, self.prescribed.values
        jumps = np.zeros(len(knots), dtype=bool)
        jumps[[0, -1]] = values[[0, -1]] != 0.0
        near = np.full(len(knots), NEAR)
        continuation = rays(np.column_stack([X, np.zeros_like(X)]), knots, near, jumps)
        samples = continuation.origins + continuation.offsets[:, 0]
        return samples, continuation.continued(np.eye(len(continuation.owner)))

    def rounding(self, g: NDArray, load: Any = None) -> list[float]:
        """Effect of rounding of the fields on each gauge of stresses, relative."""
        return self.rounding_of_stresses(self.states(g))


class PiecesLevel(LoadsLevel):
    """Pressure of the user's own, piece by piece on the mesh of a single one."""

    def _solve(self) -> None:
        self._pieces = Pieces(self.prescribed.knots, self.prescribed.values)
        self._loads = LinearLoads(self.space, self.task.response)
        self.factor = self._loads.factor
        self.resultants = np.array([self._pieces.resultant(self._loads)])

    def displacement_at(self, task: Task) -> Displacement:
        return Displacement(task, gradients=lambda points: self._pieces.gradients(self._loads, points))

    def close(self) -> None:
        """Free nothing: the fields of pieces are arrays."""
