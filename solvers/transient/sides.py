"""Responses ahead of and behind a load that moves, of uniform solids and of layers."""

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.layers.in_cells import LayersInCells
from galinx.solvers.transient.admittance import Admittance
from galinx.solvers.transient.kernel import Kernel
from galinx.solvers.transient.layered import Echoes, Sheets


class Side(Protocol):
    """Of a line load on one side, in the mirror image behind it: see :class:`.kernel.Kernel`."""

    def __call__(self, x: NDArray, s: complex, slopes: bool = False) -> NDArray[np.complex128]: ...


@dataclass(frozen=True)
class OnLayers:
    """That of the solid at the surface, and echoes.

    Attributes:
        uniform: of a half-plane of that solid.
        echoes: of the layers.
    """

    uniform: Side
    echoes: Echoes

    def __call__(self, x: NDArray, s: complex, slopes: bool = False) -> NDArray[np.complex128]:
        """Of both, (4, n)."""
        return np.asarray(self.uniform(x, s, slopes) + self.echoes(x, s, slopes))


def fastest(response: Any) -> float:
    """Largest speed of a wave inside over c_s."""
    of = Sheets if isinstance(response, LayersInCells) else Admittance
    return of.of(response).fastest


def both_sides(response: Any, rayleigh: float, way: int) -> tuple[Side, Side]:
    """On the sides towards +X and -X of a load that moves over a solid.

    Args:
        response: of the solid at the load's speed, :class:`LayersInCells` of layers.
        rayleigh: of the wave along the surface of a uniform solid over c_s.
        way: ±1, in which the load moves along X.

    Raises:
        ValueError: the solid's waves are not known.
    """
    if not isinstance(response, LayersInCells):
        surface, V = Admittance.of(response), way * response.c
        return Kernel(surface, V, rayleigh), Kernel(surface.mirrored, -V, rayleigh)
    sheets, V = Sheets.of(response), way * response.c
    alone = both_sides(response.surface, response.solid.surface.limit(), way)
    right, left = (
        OnLayers(one, Echoes(of, c)) for one, of, c in zip(alone, (sheets, sheets.mirrored), (V, -V))
    )
    return right, left
