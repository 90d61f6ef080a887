"""A flat punch that slides at constant speed under a load that oscillates: its dynamic stiffness.

Loads and indentations are the real parts of N̂ e^(iωt) and v̂₀ e^(iωt) about those of steady motion, and
friction stays σ_XY = g σ_YY. At low frequencies v̂₀ is a logarithm of ω, as a half-plane has no static
indentation; at high ones plane waves go straight down.
"""

from dataclasses import dataclass
from math import ceil

import numpy as np
from numpy.typing import NDArray

from ..solids.admittance import Admittance
from ..solids.half_plane import HalfPlane
from .transform import Transformed

#: Polynomials of the pressure without waves, and for each radian of the shortest wave along the
#: contact's half-width; share of them that a second solution has, by which the error is estimated.
_TERMS, _PER_RADIAN, _FEWER = 18, 1.0, 0.75
#: Radians of the shortest wave along the half-width at most, and in a panel of distances.
MOST, _TURN = 60.0, 4.0
#: Frequencies are solved together where one is so many times another at most.
_BAND = 3.0


@dataclass(frozen=True)
class Oscillation:
    """Answers of a punch to loads that oscillate, (frequencies,) each.

    Attributes:
        ω: angular frequencies over c_s/a.
        flexibility: v̂₀/N̂ over 1/(2μ), complex.
        centre: centre of the pressure's amplitude over a, complex.
        error: relative error of the flexibility, estimated by fewer polynomials.
    """

    ω: NDArray[np.float64]
    flexibility: NDArray[np.complex128]
    centre: NDArray[np.complex128]
    error: NDArray[np.float64]

    @property
    def stiffness(self) -> NDArray[np.complex128]:
        """Dynamic stiffness N̂/v̂₀ over 2μ, complex, (frequencies,)."""
        return 1.0 / self.flexibility


class OscillatingPunch:
    """A flat punch under loads that oscillate, at one speed and any friction.

    Args:
        response: of steady motion at that speed.
        rayleigh: speed of the wave along the surface over c_s.
        ω: angular frequencies over c_s/a, > 0, growing.
        way: ±1, in which the punch moves along X.

    Raises:
        ValueError: a wave along the contact is too short.
    """

    def __init__(self, response: HalfPlane, rayleigh: float, ω: NDArray, way: int = 1) -> None:
        if (last := float(ω.max())) > (most := highest(response, rayleigh)):
            raise ValueError(
                f"found a frequency of {last:.4g} c_s/a, expected at most {most:.4g} c_s/a at c = "
                f"{response.c:.4g}: the wave ahead of the punch is too short beyond"
            )
        self._ω, self._response = ω, response
        band = np.floor(np.log(ω.max() / ω) / np.log(_BAND))
        self._bands = []
        for number in np.unique(band)[::-1]:
            shortest = float(ω[band == number].max()) / (rayleigh - response.c)
            terms = ceil(_TERMS + _PER_RADIAN * shortest)
            s = 1j * ω[band == number]
            self._bands.append((terms, Transformed(response, rayleigh, s, terms, _TURN / shortest, way)))

    def oscillation(self, g: float) -> Oscillation:
        """Answers at all frequencies where σ_XY = g σ_YY under the punch."""
        parts = []
        for terms, transformed in self._bands:
            basis = transformed.basis(g)
            amplitudes, from_fewer = transformed.answers(basis, (terms, ceil(_FEWER * terms)))
            moments = amplitudes[:, :-1] @ basis.moments
            parts.append((amplitudes[:, -1], moments[:, 1] / moments[:, 0], from_fewer[:, -1]))
        v, centre, other = (np.concatenate(values) for values in zip(*parts))
        return Oscillation(self._ω, v, centre, np.abs(v - other) / np.abs(v))

    def plane_waves(self, g: float) -> float:
        """Limit of the stiffness over iω at high frequencies, over 2μ: c_d/c_s of an isotropic solid."""
        slopes = np.linalg.inv(Admittance.of(self._response).impedance)[1]
        return float(1.0 / (slopes[1] + g * slopes[0]))


def highest(response: HalfPlane, rayleigh: float) -> float:
    """Highest angular frequency over c_s/a that can be solved at a speed."""
    return MOST * (rayleigh - response.c)
