"""Layers as finite elements see them: constants cell by cell, and how the far boundary moves."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.polynomial.chebyshev import chebvander
from numpy.typing import NDArray
from scipy.special import log1p  # NumPy's loses digits for small complex arguments

from galinx.solvers.errors import SolveError
from galinx.solvers.layers.layered import LayeredResponse
from galinx.solvers.layers.medium import Medium, inverse
from galinx.solvers.panel import chebyshev_points, interpolation
from galinx.solvers.solids.solid import Solid

#: Columns of tables of constants: stiffness row by row, and the speed.
_COLUMNS = {name: i for i, name in enumerate(("c11", "c12", "c16", "c22", "c26", "c66", "c"))}
#: Points at which a graded solid is tabulated at first and at most, and what may be left between them.
_FEW, _MANY, _LEFT = 9, 257, 1e-13

#: Share of a depth by which it is no longer that of an interface.
_BESIDE = 1e-12


@dataclass(frozen=True)
class LayersInCells(LayeredResponse):
    """The same as finite elements see it, whose cells have constants of their own.

    See :class:`galinx.solvers.solids.solid.ByCells`.

    Attributes:
        a: length that lengths are divided by [m].
    """

    a: float = 1.0

    #: Meshes along interfaces are drawn in the plane itself.
    contraction = 1j  # type: ignore[assignment]

    def constants(self, names: Sequence[str]) -> list[NDArray[np.float64]]:
        return [np.stack([table[_COLUMNS[name]] for name in names], axis=-1) for table in self._tables]

    @cached_property
    def _tables(self) -> list[NDArray[np.float64]]:
        """Of each solid the columns of ``_COLUMNS`` at points of its share of change, (7, n)."""
        layers = [
            _tabulated(lambda s, layer=layer: self._column(layer.at(s)), layer.bottom is None)
            for layer in self.solid.layers
        ]
        return [*layers, _tabulated(lambda _: self._column(self.solid.substrate), True)]

    def _column(self, solid: Solid) -> NDArray[np.float64]:
        """Stiffness over the surface's μ, and the speed over the surface's wave speed by density."""
        C = stiffness(solid) / self.solid.μ
        return np.append(C[np.triu_indices(3)], self.c * (solid.ρ / self.solid.ρ) ** 0.5)

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
            here = solid == i
            values = interpolation(self.share(i, Y[here]), self._tables[i].shape[1]) @ self._tables[i].T
            some = np.empty((len(values), 3, 3))
            some[:, row, column] = some[:, column, row] = values[:, :-1]
            C[here] = some
        strain = np.stack([G[..., 0, 0], G[..., 1, 1], G[..., 0, 1] + G[..., 1, 0]], axis=-1)
        return np.moveaxis(np.einsum("nij,...nj->...ni", C, strain, optimize=True), -1, 0)

    def far(self, X: NDArray, Y: NDArray) -> NDArray[np.float64]:
        medium = self.medium(self.solid.substrate)
        return line_load(medium, X, Y) * np.array(-2.0)


def _tabulated(of: Callable[[float], NDArray], uniform: bool) -> NDArray[np.float64]:
    """What a solid's constants are at points of its share of change, (columns, points).

    Raises:
        SolveError: they change too much.
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
    """σ_XX, σ_YY, σ_XY by ε_XX, ε_YY, 2ε_XY [Pa], (3, 3)."""
    response = solid.response(0.0)
    strains = np.array([[[1.0, 0.0], [0.0, 0.0]], [[0.0, 0.0], [0.0, 1.0]], [[0.0, 1.0], [0.0, 0.0]]])
    return np.asarray(solid.μ * response.stresses(strains))


def line_load(medium: Medium, X: NDArray, Y: NDArray) -> NDArray[np.float64]:
    """Displacements under moving line loads at the origin, ∫σ_YY = 1 and ∫σ_XY = 1: (2, 2, n).

    u = Im[log(X + Y G) 𝐘 t]/π, the logarithm of a matrix by that of its eigenvalues; up to a translation.
    """
    p, other = medium.response.roots.each
    z = X + p * np.minimum(Y, 0.0) - 0.0j
    z = np.where(Y < 0.0, z, X + np.where(X < 0.0, -1e-300j, 0.0))
    step = (other - p) * Y / z
    log, change = np.log(z), np.where(step == 0.0, Y / z, log1p(step) / np.where(step == 0, 1, other - p))
    beyond = medium.G - p * np.eye(2)
    Y_surface = inverse(medium.modulus * np.asarray(medium.response.L))
    found = []
    for t in ([0.0, 1.0], [1.0, 0.0]):
        one, two = Y_surface @ t, beyond @ Y_surface @ t
        found.append([(log * one[i] + change * two[i]).imag / np.pi for i in (0, 1)])
    return np.array(found)
