"""States of a punch with friction as sums of its parts, whatever these were found by."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray
from petsc4py import PETSc

from galinx.solvers.fem.space import Space
from galinx.solvers.solids.solid import Response


@dataclass(frozen=True)
class Part:
    """Combinations of fields of a punch; lengths over a, stresses over N/(2a), so forces over N/2.

    Attributes:
        weights: of the fields, (states, fields).
        forces: of each field, consistent nodal forces of σ_XY and σ_YY at the contact nodes, read off the
            assembled equations, (fields, 2, nodes); of σ_YY alone, (fields, 1, nodes), where none were.
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
    """Several friction states.

    Attributes:
        g: σ_XY/σ_YY under the punch, (states,).
        v0: indentation over N/(2μ), (states,), relative to the surface at :data:`.line_loads.DATUM`, or
            to a far boundary that is held.
    """

    g: NDArray[np.float64]
    v0: NDArray[np.float64]

    @cached_property
    def tangential(self) -> NDArray[np.float64]:
        """Nodal forces of σ_XY, (states, nodes): what the equations say, or g times the normal ones."""
        known = self.forces.shape[1] == 2
        return self.weights @ self.forces[:, 0] if known else self.g[:, None] * self.normal


class Punch:
    """All friction states of a punch at one speed, which are sums of its parts.

    Attributes:
        space: the finite element space.
        response: of the half-plane.
    """

    space: Space
    response: Response

    @property
    def fields(self) -> Sequence[PETSc.Vec]:
        """Displacements of the parts, those of one after those of the other."""
        raise NotImplementedError

    def parts(self, g: NDArray[np.float64], shapes: int | None = None) -> list[Part]:
        """Of states with σ_XY = g σ_YY: the flat punch at v = -1, and each shape where it is held.

        Args:
            g: values of σ_XY/σ_YY, (states,).
            shapes: that are wanted, all of them if not given.
        """
        raise NotImplementedError

    def release(self) -> None:
        """Free factor and fields; states that were asked for before can be asked for again."""
        raise NotImplementedError

    def destroy(self) -> None:
        """Free factor and fields."""
        raise NotImplementedError

    def states(self, g: ArrayLike, flat: bool = False, share: ArrayLike = 1.0) -> ContactStates:
        """The states with σ_XY = g σ_YY under the punch and the load ∫σ_YY = -N.

        Args:
            g: values of σ_XY/σ_YY.
            flat: of a flat punch, whatever the profile is.
            share: by what the profile's heights are multiplied, of each state: less over a larger load.
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
        parts: of :meth:`Punch.parts`.
        amplitudes: of each, (states, parts); the first is the indentation v₀.
    """
    weights = [amplitudes[:, [i]] * part.weights for i, part in enumerate(parts)]
    forces = np.concatenate([part.forces for part in parts])
    return ContactStates(np.concatenate(weights, axis=1), forces, g, amplitudes[:, 0])
