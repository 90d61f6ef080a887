"""Flutter of layers by wavelength: the friction from which on waves of one length grow on a rigid flat.

The threshold is that of :mod:`galinx.solvers.solids.flutter`, with the stiffness of the surface at this
wavenumber. Waves shorter than a layer do not come to the threshold of its solid: echoes of its lower face
let them grow at less friction, at a rate that does not rise with the wavenumber. That of the solid itself
is where the rate has no bound. Where a wave without friction runs in a slow layer, the threshold is 0.

At speeds far above those of the solids waves go to and fro across the layers, in an isotropic one without
shear, in a turned crystal with it. Of these, which have no end, those are counted whose echoes have a
phase of at most 200, some 16 wavelengths across the layers: each is a thickness vibration that grows.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..solids.flutter import Side, thresholds
from ..solids.solid import Solid
from .layered import Layered, LayersAtSpeed
from .stiffness import Medium, Uniform

#: Distance of speeds from the real axis over their size, which selects waves that carry energy away; a
#: threshold below which it is 0.
_OFF_AXIS, _ZERO = 1e-9, 1e-6


@dataclass(frozen=True)
class LayeredSide(Side):
    """Layers below an interface, seen by waves of one length; units are those of the uppermost solid.

    Attributes:
        parts: layers from the top down and the substrate, each with its thickness times the wavenumber.
    """

    parts: tuple[tuple[Side, float], ...] = ()

    @classmethod
    def of_length(cls, solid: Layered, length: float) -> "LayeredSide":
        """Layers seen by waves of a length [m].

        Raises:
            ValueError: a layer is graded.
        """
        if any(layer.bottom is not None for layer in solid.layers):
            raise ValueError("found a graded layer, expected uniform ones")
        parts = []
        for part in solid.parts:
            side = Side.of(part.solid)
            compliance, c_s = side.compliance * solid.μ, side.c_s / solid.c_s
            scaled = replace(side, compliance=compliance, c_s=c_s)
            parts.append((scaled, 2.0 * np.pi * part.thickness / length))
        return cls(parts[0][0].admittance, parts=tuple(parts))

    @property
    def echo(self) -> float:
        slowest = (side.c_s * np.abs(side.admittance.meeting).min() for side, _ in self.parts)
        return float(2.0 * sum(H / c for (_, H), c in zip(self.parts[:-1], slowest)))

    @property
    def meeting(self) -> NDArray[np.float64]:
        return np.concatenate([side.meeting for side, _ in self.parts])

    def stiffness(self, C: NDArray) -> NDArray[np.complex128]:
        C = np.where(np.imag(C) == 0.0, C * (1.0 - 1j * _OFF_AXIS * np.sign(np.real(C))), C)
        # The stiffness of layers is that at k > 0, whose fields are the conjugates.
        media = []
        for side, _ in self.parts:
            up, down = (side.admittance.waves(speed / side.c_s) for speed in (C.conj(), C))
            media.append(Medium(up, 1.0 / side.compliance, down.conjugate))
        layers = [Uniform(medium, H) for medium, (_, H) in zip(media[:-1], self.parts)]
        L = 1j * LayersAtSpeed(layers, media[-1]).stiffness(np.ones(len(C))).conj()
        return np.array([L[:, 0, 0], L[:, 1, 0], L[:, 0, 0] * L[:, 1, 1] - L[:, 0, 1] * L[:, 1, 0]])


def thresholds_by_length(solid: Solid, length: NDArray) -> NDArray[np.float64]:
    """Flutter thresholds of uniform layers for σ_XY/σ_YY > 0 and < 0, infinite for none, (2, n).

    Args:
        solid: the layers.
        length: of the waves [m], (n,).

    Raises:
        ValueError: a layer is graded.
    """
    assert isinstance(solid, Layered)
    with np.errstate(all="ignore"):
        each = [thresholds(LayeredSide.of_length(solid, value)) for value in length.tolist()]
    g = np.transpose(each)
    return np.where(g < _ZERO, 0.0, g)
