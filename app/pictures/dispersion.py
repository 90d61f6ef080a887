"""The slowest waves along a scene's layers."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.errors import BadInput
from galinx.app.pictures.drawing import Drawing
from galinx.app.scene.scene import Scene
from galinx.postprocess.figures.dispersion import dispersion_figure
from galinx.solvers.layers.layered import Layered
from galinx.solvers.layers.speed import dispersion

#: Wavenumbers times the thickness of all layers; fewer where a layer is graded.
_kH, _FEWER = np.geomspace(0.03, 100.0, 61), 4
#: Relative accuracy of speeds.
_ACCURACY = 1e-7


@dataclass(frozen=True)
class Curve:
    """The dispersion of the slowest wave.

    Attributes:
        kH: wavenumber times the thickness of all layers, (n,).
        length: of the waves [m], (n,).
        speed: [m/s], NaN where none is slower than the waves inside, (n,).
        limit: highest speed of a punch [m/s].
        ends: of waves along the substrate, and along the surface's solid [m/s].
    """

    kH: NDArray[np.float64]
    length: NDArray[np.float64]
    speed: NDArray[np.float64]
    limit: float
    ends: tuple[float, float]

    @property
    def leaks(self) -> bool:
        """Is there a length of which no wave is slower than those inside?"""
        return bool(np.isnan(self.speed).any())


def curve(scene: Scene) -> Curve:
    """Of a scene's layers.

    Raises:
        BadInput: it has none.
    """
    solid = scene.solid
    if not isinstance(solid, Layered):
        raise BadInput(
            "layer: found no layers; along a uniform solid waves of all lengths run alike, at "
            f"{solid.limit() * solid.c_s:.6g} m/s"
        )
    graded = any(layer.bottom for layer in solid.layers)
    kH, H = _kH[:: _FEWER if graded else 1], float(solid.depths[-1])

    def stack(c: float) -> Any:
        return solid.response(c).stack(H, 1e-8)

    c = dispersion(stack, 1.0, kH, _ACCURACY)
    ends = (solid.substrate.limit() * solid.substrate.c_s, solid.surface.limit() * solid.c_s)
    return Curve(kH, 2.0 * np.pi * H / kH, c * solid.c_s, solid.limit() * solid.c_s, ends)


def drawing(known: Curve) -> Drawing:
    """The curve as a figure."""
    figure = dispersion_figure(known.kH, known.speed, known.limit, known.ends)
    caption = (
        "Speed of the slowest wave along the layers over its wavenumber k times the thickness H of all "
        f"layers. The dashed line is the highest speed of a punch, {known.limit:.6g} m/s; circles are "
        "the waves along the substrate alone (left) and along the solid of the surface (right). Where "
        "there is no curve no such wave is slower than the waves inside one of the solids."
    )
    return Drawing("dispersion", caption, figure)
