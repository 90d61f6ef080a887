"""Prescribed pressures by finite elements at one speed, the degree raised by the measured error.

The pressure is the user's own, σ_XY = g σ_YY: over a uniform half-plane piece by piece between its knots
(:class:`PiecesLevel`), over layers as a whole on cells graded towards its knots (:class:`WholeLevel`). In
mode ``traction`` it is that of a flat punch by its closed form (:class:`FormulaLevel`).
"""

from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..contact.closed_form import FlatPunch
from ..contact.prescribed_pressure import LinearPressure
from ..contact.pressure import Pressure
from ..contact.solution import Task
from ..contact.stresses import Places, Surface, Turns, turns_at_knots
from ..rays import NEAR, rays
from .discretisation import Discretisation
from .displacement import Displacement
from .fields import Gradients, Slopes
from .ladder import Level
from .punch import ContactStates
from .solution import SolvedStates
from .space import Space
from .traction import LinearLoads, LoadedHalfPlane, Pieces


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
        return self.rounding_of_stresses(self.fields_of(self.states(g)))


class PiecesLevel(LoadsLevel):
    """Pressure of the user's own, piece by piece on the mesh of a single one."""

    def _solve(self) -> None:
        self._pieces = Pieces(self.prescribed.knots, self.prescribed.values)
        self._loads = LinearLoads(self.space, self.task.response)
        self.factor = self._loads.factor
        self.resultants = np.array([self._pieces.resultant(self._loads)])

    def displacement_at(self, task: Task) -> Displacement:
        return PiecesDisplacement(task, self.space, self._pieces, self._loads)

    def close(self) -> None:
        """Free nothing: the fields of pieces are arrays."""


class PiecesDisplacement(Displacement):
    """Displacement under pieces of a pressure; see :class:`Displacement`.

    Args:
        task: the speed, and the places.
        space: space of the mesh of a single piece.
        pieces: pieces of the pressure.
        loads: linear loads that make up the pieces.
    """

    def __init__(self, task: Task, space: Space, pieces: Pieces, loads: LinearLoads) -> None:
        super().__init__(task, space, ())
        self._pieces, self._loads = pieces, loads

    def _at(self, points: NDArray, side: int = 1) -> Gradients:
        return Gradients([lambda: self._pieces.gradients(self._loads, points)])

    @cached_property
    def slopes(self) -> Slopes:
        X = self._task.places.X
        basis = self._at(np.column_stack([X, np.zeros(len(X))])).of_fields()[:, :, 0]
        return Slopes(np.moveaxis(basis, 1, 0), np.zeros((len(X), basis.shape[-1])))
