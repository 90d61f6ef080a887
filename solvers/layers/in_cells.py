"""Layers in finite elements: constants cell by cell, and the motion of the far boundary.

Far from a load, layers on a substrate move as under line loads, and by what the layers add to that. With
t the loads of a field e^(ikX), Z₋ of the substrate, and through layers that are thin beside 1/k

    t' = k² A u - ik B t,   u' = -ik Bᵀ u + T⁻¹ t,   A = Q - R T⁻¹ Rᵀ,   B = R T⁻¹   (Y upwards),

the substrate, whose surface lies at the depth D, carries t + k E t and moves there by

    u = Z₋⁻¹ t/k + Z₋⁻¹ E t + O(k),   E = -∫ (A Z₋⁻¹ - i B) dY,

a height inside the layers by ∫ (T⁻¹ - i Bᵀ Z₋⁻¹) dY t more. The first term is the line load's
logarithm, the others fall like 1/X; the remainder falls like its square.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.polynomial.chebyshev import chebvander
from numpy.polynomial.legendre import leggauss
from numpy.typing import NDArray

from ..approximation import chebyshev_points, interpolation
from ..errors import SolveError
from ..solids.potentials import DATUM, LOADS, line_loads
from ..solids.solid import Solid
from .layered import Layer, LayeredResponse
from .stiffness import Medium, inverse


@dataclass(frozen=True)
class FarField:
    """Displacements of layers on a substrate far from line loads at the origin.

    Attributes:
        substrate: the half-plane below, at its speed.
        D: depth of its surface over a.
        through: ∫ A, ∫ B and ∫ T⁻¹ over the layers from -D up to a height over a, (3, 2, 2).
    """

    substrate: Medium
    D: float
    through: Callable[[float], NDArray[np.float64]]

    def __call__(self, X: NDArray, Y: NDArray) -> NDArray[np.float64]:
        """Displacements under ∫σ_YY = 1 and ∫σ_XY = 1, relative to a distant datum: (2, 2, n)."""
        below, datum = np.minimum(Y + self.D, 0.0), DATUM * max(1.0, self.length)
        (displacement,) = (
            line_loads(self.substrate.response, X, below, datum=datum) / self.substrate.modulus
        )
        z = X[:, None, None] * np.eye(2) + below[:, None, None] * self.substrate.G.conj()
        heights, which = np.unique(np.maximum(Y, -self.D), return_inverse=True)
        moved = [self._moved(height) for height in heights.tolist()]  # none on a rank without far nodes
        more = np.reshape(moved, (-1, 2, 2))[which]
        w = inverse(z) @ (self._below + more)
        for load, t in zip(displacement, LOADS):
            load += (1j * w @ t).real.T / np.pi
        return displacement

    @cached_property
    def _compliance(self) -> NDArray[np.complex128]:
        return inverse(self.substrate.down)

    @property
    def length(self) -> float:
        """Length over a on which the terms that layers add to the line load's vary."""
        moved, compliance, loaded = (
            float(np.linalg.norm(matrix, 2))
            for matrix in (self._moved(0.0), self._compliance, self._loaded)
        )
        return max(self.D, moved / compliance, loaded)

    @cached_property
    def _loaded(self) -> NDArray[np.complex128]:
        """Matrix E of the load on the substrate, (2, 2)."""
        A, B, _ = self.through(0.0)
        return np.asarray(1j * B - A @ self._compliance)

    @cached_property
    def _below(self) -> NDArray[np.complex128]:
        """Matrix Z₋⁻¹ E of the motion of the substrate, (2, 2)."""
        return np.asarray(self._compliance @ self._loaded)

    def _moved(self, height: float) -> NDArray[np.complex128]:
        """∫ (T⁻¹ - i Bᵀ Z₋⁻¹) dY from the substrate up to a height over a, (2, 2)."""
        _, B, T_inverse = self.through(height)
        return np.asarray(T_inverse - 1j * B.T @ self._compliance)


#: Columns of tables of constants: stiffness row by row, the speed, and the density.
_COLUMNS = {name: i for i, name in enumerate(("c11", "c12", "c16", "c22", "c26", "c66", "c", "ρ"))}
#: Points at which a graded solid is tabulated at first and at most, and its error between them.
_FEW, _MANY, _LEFT = 9, 257, 1e-13

#: Gauss's rule over a layer's thickness.
_τ, _w = leggauss(24)
#: Relative distance of a depth from an interface beyond which it is not that of the interface.
_BESIDE = 1e-12


@dataclass(frozen=True)
class LayersInCells(LayeredResponse):
    """Layers at a speed for finite elements, whose cells have constants of their own.

    See :class:`galinx.solvers.solids.solid.ByCells`.

    Attributes:
        a: unit of length [m].
    """

    a: float = 1.0

    #: Meshes along interfaces are drawn in the plane itself.
    contraction = 1j  # type: ignore[assignment]

    def constants(self, names: Sequence[str]) -> list[NDArray[np.float64]]:
        return [np.stack([table[_COLUMNS[name]] for name in names], axis=-1) for table in self._tables]

    @cached_property
    def _tables(self) -> list[NDArray[np.float64]]:
        """Tables of each solid: ``_COLUMNS`` at Chebyshev's points of its share of change, (8, n)."""
        layers = [*self.solid.layers, Layer(1.0, self.solid.substrate)]
        return [self._table(layer) for layer in layers]

    def _table(self, layer: Layer) -> NDArray[np.float64]:
        return _tabulated(lambda share: self._column(layer.at(share)), layer.bottom is None)

    def _column(self, solid: Solid) -> NDArray[np.float64]:
        """Stiffness over the surface's μ, the speed over its wave speed by density, and the density."""
        C, ρ = stiffness(solid) / self.solid.μ, solid.ρ / self.solid.ρ
        return np.append(C[np.triu_indices(3)], [self.c * ρ**0.5, ρ])

    @cached_property
    def _faces(self) -> NDArray[np.float64]:
        """Depths of the upper faces of all solids, over a."""
        return np.append(0.0, self.solid.depths / self.a)

    def solids(self, Y: NDArray, side: int = 1) -> NDArray[np.int64]:
        return np.maximum(np.searchsorted(self._faces, -Y * (1.0 - side * _BESIDE)) - 1, 0)

    def share(self, solid: int, Y: NDArray) -> NDArray[np.float64]:
        if solid == len(self.solid.layers):
            return np.zeros_like(Y)
        layer, top = self.solid.layers[solid], self._faces[solid]
        done = np.clip((-Y - top) * self.a / layer.thickness, 0.0, 1.0)
        return np.asarray(done**layer.power)

    def stresses_at(self, solid: NDArray, Y: NDArray, G: NDArray) -> NDArray[np.float64]:
        C = np.empty((len(Y), 3, 3))
        row, column = np.triu_indices(3)
        for i in np.unique(solid).tolist():
            points = solid == i
            values = interpolation(self.share(i, Y[points]), self._tables[i].shape[1]) @ self._tables[i].T
            stiffnesses = np.empty((len(values), 3, 3))
            stiffnesses[:, row, column] = stiffnesses[:, column, row] = values[:, : len(row)]
            C[points] = stiffnesses
        strain = np.stack([G[..., 0, 0], G[..., 1, 1], G[..., 0, 1] + G[..., 1, 0]], axis=-1)
        return np.moveaxis(np.einsum("nij,...nj->...ni", C, strain, optimize=True), -1, 0)

    def far(self, X: NDArray, Y: NDArray, terms: int) -> NDArray[np.float64]:
        return self.far_field(X, Y)[None]

    @cached_property
    def far_field(self) -> FarField:
        """Displacements far from line loads at the origin."""
        return FarField(self.medium(self.solid.substrate), float(self._faces[-1]), self._through)

    def _through(self, height: float) -> NDArray[np.float64]:
        """∫ A, ∫ B and ∫ T⁻¹ of the far field up to a height over a, (3, 2, 2)."""
        integrals = np.zeros((3, 2, 2))
        for i in range(len(self.solid.layers)):
            bottom, top = -self._faces[i + 1], min(-self._faces[i], height)
            if top <= bottom:
                continue
            Y = bottom + (top - bottom) * (_τ + 1.0) / 2.0
            of_share = interpolation(self.share(i, Y), self._tables[i].shape[1])
            c11, c12, c16, c22, c26, c66, c, _ = self._tables[i] @ of_share.T
            Q, R, T = (
                np.moveaxis(np.array(M), 2, 0)
                for M in ([[c11 - c**2, c16], [c16, c66 - c**2]], [[c16, c12], [c66, c26]],
                          [[c66, c26], [c26, c22]])
            )  # fmt: skip
            T_inverse = np.linalg.inv(T)
            B = R @ T_inverse
            parts = np.array([Q - B @ R.swapaxes(1, 2), B, T_inverse])
            integrals += (top - bottom) / 2.0 * np.einsum("q,nqij->nij", _w, parts)
        return integrals


def _tabulated(of: Callable[[float], NDArray], uniform: bool) -> NDArray[np.float64]:
    """Constants of a solid at Chebyshev's points of its share of change, (columns, points).

    Raises:
        SolveError: constants change too much.
    """
    count = 1 if uniform else _FEW
    while count <= _MANY:
        values = np.array([of(s) for s in chebyshev_points(count).tolist()])
        if uniform:
            return values.T
        c = np.linalg.solve(chebvander(2.0 * chebyshev_points(count) - 1.0, count - 1), values)
        if np.abs(c[-2:]).max() <= _LEFT * np.abs(values).max():
            return values.T
        count = 2 * count - 1
    raise SolveError("the solid of a graded layer changes too much to be followed by finite elements")


def stiffness(solid: Solid) -> NDArray[np.float64]:
    """Stiffness of σ_XX, σ_YY, σ_XY against ε_XX, ε_YY, 2ε_XY [Pa], (3, 3)."""
    response = solid.response(0.0)
    strains = np.array([[[1.0, 0.0], [0.0, 0.0]], [[0.0, 0.0], [0.0, 1.0]], [[0.0, 1.0], [0.0, 0.0]]])
    return np.asarray(solid.μ * response.stresses(strains))
