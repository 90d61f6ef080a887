"""Strain and tractions at a depth of a layered half-plane, by the pressure on top.

For the field e^(ikX) the tractions t on top displace it by Z⁻¹ t/k; what is carried down to a depth has
the stiffness Z of what is below there. These transforms fall like e^(-k d): kernels in X follow, as
regular as the depth d allows.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.layers.fourier import Transform, transform
from galinx.solvers.layers.kernel import ROUNDING, wavenumbers
from galinx.solvers.layers.medium import Medium, inverse
from galinx.solvers.layers.stack import Stack
from galinx.solvers.layers.table import Table, tabulated
from galinx.solvers.layers.uniform import Uniform

#: A depth over that of an interface that is still it.
_AT = 1e-12
#: Numbers of differences of positions that are looked up at once: some megabytes.
_AT_ONCE = 60_000


@dataclass(frozen=True)
class Level:
    """A depth.

    Attributes:
        stack: layers with their substrate.
        depth: over a, positive.
        reach: largest difference of positions over a.
        tolerance: relative.
    """

    stack: Stack
    depth: float
    reach: float
    tolerance: float

    @cached_property
    def _parts(self) -> tuple[Stack, int]:
        """The stack with an interface at the depth, and how many layers lie above that."""
        layers, top = list(self.stack.layers), 0.0
        for i, layer in enumerate(layers):
            bottom = top + layer.H
            if abs(bottom - self.depth) <= _AT * bottom:
                return self.stack, i + 1
            if self.depth < bottom:
                return Stack([*layers[:i], *layer.cut(self.depth - top), *layers[i + 1 :]],
                             self.stack.substrate), i + 1  # fmt: skip
            top = bottom
        more = Uniform(self.stack.substrate, self.depth - top)
        return Stack([*layers, more], self.stack.substrate), len(layers) + 1

    @property
    def media(self) -> tuple[Medium, Medium]:
        """The solids above and below the depth; the same one inside a layer."""
        stack, above = self._parts
        under = stack.layers[above].top if above < len(stack.layers) else stack.substrate
        return stack.layers[above - 1].bottom, under

    def _of(self, k: NDArray) -> NDArray:
        """u,X, σ_YY and σ_XY there by σ_XY and σ_YY on top, (n, 6)."""
        stack, above = self._parts
        under = stack.below(k)
        carried = inverse(stack.top.down + stack.layers[0].excess(k, under[0]))
        for layer, Z in zip(stack.layers[:above], under):
            carried = layer.carried(k, Z) @ carried
        tractions = under[above - 1] @ carried
        return np.stack(
            [*(1j * carried[:, 0].T), *tractions[:, 1].T, *tractions[:, 0].T], axis=-1
        )  # fmt: skip

    @property
    def _wanted(self) -> float:
        return max(self.tolerance / 100.0, ROUNDING)

    @cached_property
    def _transform(self) -> Transform:
        first = min(wavenumbers(self.stack), 1.0 / self.depth)
        return transform(self._of, first, self._wanted)

    @cached_property
    def _table(self) -> Table:
        allowed = self._wanted * self._transform.size / np.pi
        return tabulated(self._transform, self.depth / 4.0, self.reach, allowed)

    @property
    def error(self) -> float:
        """Absolute, of u,X, σ_YY and σ_XY under a pressure whose resultant is that of a punch, 2."""
        return 2.0 * (self._transform.error / np.pi + self._table.error)

    def read(
        self, t: NDArray, σ: NDArray, g: float, X: NDArray, size: float = 1.0
    ) -> NDArray[np.float64]:
        """u,X times μ, σ_YY and σ_XY at positions, (3, n).

        Args:
            t, σ: of the pressure's rule.
            g: σ_XY/σ_YY on top.
            X: positions.
            size: length over a that ``t`` and ``X`` are over, and stresses.
        """
        found, step = np.empty((len(X), 6)), max(_AT_ONCE // len(t), 1)
        for start in range(0, len(X), step):
            some = slice(start, start + step)
            found[some] = size * np.einsum("t,xtf->xf", σ, self._table(size * (X[some, None] - t)))
        by_shear, by_pressure = found[:, 0::2], found[:, 1::2]
        return np.asarray((g * by_shear + by_pressure).T)
