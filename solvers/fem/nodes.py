"""Nodes of a part of the surface."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class SurfaceNodes:
    """Nodes of a part of the surface, in order of X, the same on every rank.

    Attributes:
        s: surface coordinates in the mesh's chart, (n,).
        owned: positions in ``s`` of the nodes this rank owns.
        numbers: global numbers of their first unknowns, those along X; the second ones follow.
    """

    s: NDArray[np.float64]
    owned: NDArray[np.int64]
    numbers: NDArray[np.int32]

    def dofs(self, component: int) -> NDArray[np.int32]:
        """Global numbers of the owned unknowns, component 0 for u and 1 for v."""
        return self._dofs[component]

    @cached_property
    def _dofs(self) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
        return self.numbers, self.numbers + 1
