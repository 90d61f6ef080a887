"""A punch at a speed between others at which it was solved: what a fit says of these, put together.

At a solved speed the parts of a punch are sampled at some frictions, between which they are polynomials
in g to rounding. At another speed each number is a sum over the solved speeds, with the same shares for
all. What an edge's singularity does to a number is taken out before and put in again: a force or a slope
at a distance d goes as d^α with an exponent that changes with speed.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc

from galinx.solvers.fem.space import Space
from galinx.solvers.fem.states import Part, Punch
from galinx.solvers.rational import barycentric
from galinx.solvers.solids.solid import Response


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
        """What of the values there makes that at others, (len(g), frictions)."""
        return barycentric(self.g, self.weights, g)


@dataclass(frozen=True)
class Singular:
    """What edges do to numbers of each friction: these are a smooth factor times it.

    Attributes:
        forces: to nodal forces, (frictions, nodes).
        slopes: to slopes at the places on the surface, (frictions, places).
    """

    forces: NDArray[np.float64]
    slopes: NDArray[np.float64]


@dataclass(frozen=True)
class Sampled:
    """Parts of a punch at a speed, or at several, at some frictions.

    Attributes:
        forces: in Y at the contact nodes, (..., parts, frictions, nodes); those in X are g times these.
        slopes: of both displacements along X at places on the surface, none if nobody asks for them,
            (..., 2, parts, frictions, places).
        rounding: what the last digits can do to slopes of u, (..., parts, frictions, places).
        fields: displacements, this rank's unknowns, none if nobody asks for them,
            (..., parts, frictions, unknowns).
    """

    forces: NDArray[np.float64]
    slopes: NDArray[np.float64]
    rounding: NDArray[np.float64]
    fields: NDArray[np.float64]

    def smooth(self, singular: Singular) -> "Sampled":
        """The same without what edges do."""
        slopes, forces = self.slopes / singular.slopes, self.forces / singular.forces
        return Sampled(forces, slopes, self.rounding / singular.slopes, self.fields)

    def singular(self, singular: Singular) -> "Sampled":
        """Smooth numbers with what edges do."""
        slopes, forces = self.slopes * singular.slopes, self.forces * singular.forces
        return Sampled(forces, slopes, self.rounding * singular.slopes, self.fields)

    def numbers(self) -> Iterator[NDArray[np.float64]]:
        """All but the rounding, part by part, (..., n): what a fit is made of."""
        for part in range(self.forces.shape[-3]):
            for values in (self.forces[..., part, :, :], self.slopes[..., part, :, :]):
                yield values.reshape(*values.shape[:-3], -1)
            fields = self.fields[..., part, :, :]
            yield fields.reshape(*fields.shape[:-2], -1)


def together(several: Sequence[Sampled], shares: NDArray) -> Sampled:
    """The sum of some speeds' numbers with these shares, (len(several),)."""

    def total(name: str, of: NDArray) -> NDArray:
        return np.asarray(sum(share * getattr(one, name) for share, one in zip(of, several) if share))

    rounding = total("rounding", np.abs(shares))
    return Sampled(total("forces", shares), total("slopes", shares), rounding, total("fields", shares))


def sampled(punch: Punch, at: Frictions, slopes: Any = None, with_fields: bool = False) -> Sampled:
    """A punch's parts at some frictions.

    Args:
        punch: the punch, solved for these frictions.
        at: the frictions.
        slopes: of its fields, a :class:`.surface.SurfaceSlopes`; None where nobody asks for them.
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
    """All friction states of the punch at a speed where its parts are known from others.

    Args:
        space: the finite element space.
        response: of the half-plane.
        at: frictions at which the parts are known.
        known: the parts.
    """

    def __init__(self, space: Space, response: Response, at: Frictions, known: Sampled) -> None:
        self.space, self.response = space, response
        self._at, self._known = at, known
        self._fields = _Fields(np.concatenate(list(known.fields)), space)

    @property
    def fields(self) -> Sequence[PETSc.Vec]:
        """Displacements of every part at every friction; made where somebody asks for one."""
        return self._fields

    @property
    def slopes(self) -> "FittedSlopes":
        """Slopes of the fields at the places on the surface."""
        return FittedSlopes(self._known.slopes, self._known.rounding)

    def parts(self, g: NDArray[np.float64], shapes: int | None = None) -> list[Part]:
        shares = self._at.shares(g)
        known = self._known.forces[: None if shapes is None else 1 + shapes]
        # No equations are assembled here from which tangential forces could be read.
        return [Part(shares, normal[:, None]) for normal in known]

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
        """What the last digits of the fields can do to μ u,X of combinations, (states, n)."""
        return np.abs(weights) @ self._rounding[: weights.shape[1]]


class _Fields(Sequence[PETSc.Vec]):
    """Vectors of some numbers, (fields, unknowns), made when the first is asked for."""

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
