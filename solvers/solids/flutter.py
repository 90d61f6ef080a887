"""Flutter thresholds: the friction from which on short waves along a sliding interface grow.

A solid slides on a rigid or an elastic one, under Coulomb friction: both stay in contact, and σ_XY =
g σ_YY on an infinite surface. Waves e^(ik(X - Ct)) obey the steady equations of each solid at the speed C
over it, so that with (u,X, v,X) = 𝐘 (σ_XY, σ_YY) below the interface and 𝐘' of the mirror image of the
solid above it, over whose surface the interface moves at V' where it moves at V over that below,

    A(C) + g B(C) = 0,   A = Y₂₂(C) + Y'₂₂(C - V + V'),   B = Y₂₁(C) - Y'₂₁(C - V + V').

A rigid body has 𝐘' = 0; then the threshold does not depend on the speed of sliding. Waves grow if Im C >
0, and at any length: the shorter, the faster (Renardy, J. Elasticity 27 (1992) 281; Martins, Guimarães
and Faria, J. Vib. Acoust. 117 (1995) 445). -A/B is meromorphic in the upper half of the C plane. Growing
waves have the real values that it takes there, on curves along which it is monotonic, and these curves
end on the real axis; the least of each sign is a value at such an end. The ends are the isolated speeds
at which -A/B is real and, on stretches where it is real everywhere because all waves leave the surface,
its extremes. Where a wave without friction runs along the interface of two elastic bodies, A vanishes:
under any friction of one sign it grows (Adams, J. Appl. Mech. 62 (1995) 867; Ranjith and Rice, J. Mech.
Phys. Solids 49 (2001) 341).
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import copysign, inf

import numpy as np
from numpy.typing import NDArray
from scipy.special import expit

from .admittance import Admittance
from .solid import Solid

#: Speeds sampled between two at which roots meet; largest step of the echoes' phase between two of them,
#: and their phase at the largest speed; parts of a step in which a sign changes, and how often again.
_SPEEDS, _STEP_OF_PHASE, _PHASE, _CLOSER, _TIMES = 500, 0.1, 200.0, 4, 20
#: Logarithm of the stretch over the distance of the first and the last sample from its ends.
_NEXT = 25.0
#: Imaginary part over the size above which a ratio is not real.
_REAL_RATIO = 1e-8
#: Share of the way to a stretch's end over which a slope is taken, and the least of the stretch.
_STEP, _LEAST = 1e-5, 1e-13
#: Size of A or B over that of both below which it vanishes.
_ZERO = 1e-10
#: Distance from the real axis over the speed at which the sign of -A/B is taken where A vanishes.
_OFF_AXIS = 1e-6


@dataclass(frozen=True)
class Side:
    """One of the bodies at an interface.

    Attributes:
        admittance: of its surface below the interface; of its mirror image for the body above.
        side: 1 for the body below the interface, -1 for the one above.
        compliance: 1/μ in the unit of both bodies.
        c_s: √(μ/ρ) in the unit of speeds.
        speed: of the interface over its surface, in the unit of speeds; below 0 to negative X.
    """

    admittance: Admittance
    side: int = 1
    compliance: float = 1.0
    c_s: float = 1.0
    speed: float = 0.0

    @classmethod
    def of(cls, solid: Solid, speed: float = 0.0, below: bool = True) -> "Side":
        """Uniform solid, over which the interface moves at a speed [m/s]; units are those of SI."""
        surface = Admittance.of(solid.response(0.0))
        if below:
            return cls(surface, 1, 1.0 / solid.μ, solid.c_s, speed)
        return cls(surface.mirrored, -1, 1.0 / solid.μ, solid.c_s, speed)

    @property
    def echo(self) -> float:
        """Growth with the speed of the phase of echoes from below the surface."""
        return 0.0

    @property
    def meeting(self) -> NDArray[np.float64]:
        """Real speeds in the interface's frame at which a decaying root meets a growing one."""
        speeds = self.c_s * self.admittance.meeting
        return np.concatenate([-speeds, speeds]) - self.speed

    def stiffness(self, C: NDArray) -> NDArray[np.complex128]:
        """L₁₁ and ±L₂₁ over μ, and det L/μ² times μ, at speeds in the interface's frame, (3, ...)."""
        L = self.admittance.waves((C + self.speed) / self.c_s).L
        det = L[:, 0, 0] * L[:, 1, 1] - L[:, 0, 1] * L[:, 1, 0]
        return np.array([L[:, 0, 0], self.side * L[:, 1, 0], det / self.compliance])


def thresholds(*sides: Side) -> tuple[float, float]:
    """Flutter thresholds: least g > 0 and least -g > 0 from which on waves grow; infinite for none.

    Args:
        sides: the solid below the interface, and the elastic one above it, if any.
    """
    ends = np.unique(np.concatenate([side.meeting for side in sides]))
    echo = sum(side.echo for side in sides)
    if echo:  # at ever larger speeds there are ever more of them
        far = max(_PHASE / echo, 2.0 * float(np.abs(ends).max()))
        ends = np.concatenate([[-far], ends, [far]])
    values = [g for low, high in pairwise(ends) for g in _values(sides, lambda x: x, low, high, echo)]
    if not echo:  # beyond the last speeds, by 1/C: from one infinity to the other
        values += _values(sides, lambda x: 1.0 / x, 1.0 / ends[0], 1.0 / ends[-1])
    positive, negative = ([abs(g) for g in values if copysign(1.0, g) == way] for way in (1.0, -1.0))
    return min(positive, default=inf), min(negative, default=inf)


def _ratio(sides: Sequence[Side], C: NDArray) -> NDArray[np.complex128]:
    """A and -B over their size, (2, ...), without the poles of both: times the determinants of L."""
    of = [side.stiffness(C) for side in sides]
    if len(of) == 1:
        pair = of[0][:2]
    else:
        (L11, L21, det), (M11, M21, other) = of
        pair = np.array([L11 * other + M11 * det, L21 * other + M21 * det])
    return np.asarray(pair / np.linalg.norm(pair, axis=0))


def _values(
    sides: Sequence[Side],
    speed: Callable[[NDArray], NDArray],
    start: float,
    end: float,
    echo: float = 0.0,
) -> list[float]:
    """-A/B at the ends of curves on a stretch of the real axis; a zero has the sign of its curve."""

    def pair(x: NDArray) -> NDArray[np.complex128]:
        return _ratio(sides, speed(x))

    def off(x: NDArray) -> NDArray[np.float64]:
        """Im(-A B*): 0 where the ratio is real."""
        A, B = pair(x)
        return np.asarray((A * B.conj()).imag)

    def turn(x: NDArray) -> NDArray[np.float64]:
        """Slope of the angle of -A/B, on a stretch where the ratio is real."""
        step = np.maximum(
            _STEP * np.minimum(np.abs(x - start), np.abs(end - x)), _LEAST * abs(end - start)
        )
        (A_before, B_before), (A_after, B_after) = pair(x - step), pair(x + step)
        return np.asarray((A_before.conj() * B_after - A_after * B_before.conj()).real / step)

    # Curves may end next to a speed at which roots meet; slopes have no digits there.
    even = np.linspace(0.0, 1.0, int((end - start) * echo / _STEP_OF_PHASE) + 2)[1:-1]
    x = start + np.union1d(expit(np.linspace(-_NEXT, _NEXT, _SPEEDS)), even) * (end - start)
    sign, at = off, off(x)
    if np.abs(at).max() <= _REAL_RATIO:
        within = (1.0 - np.cos(np.pi * (np.arange(_SPEEDS) + 0.5) / _SPEEDS)) / 2.0
        x = start + np.union1d(within, even) * (end - start)
        sign, at = turn, turn(x)
    i = np.flatnonzero((at[:-1] > 0.0) != (at[1:] > 0.0))
    if not len(i):
        return []
    low, high = x[i], x[i + 1]
    for _ in range(_TIMES):
        closer = low + (high - low) * np.linspace(0.0, 1.0, _CLOSER + 1)[:, None]
        beyond = (sign(closer.ravel()) > 0.0).reshape(closer.shape) != (at[i] > 0.0)
        first = np.maximum(beyond.argmax(axis=0), 1)
        low, high = (np.take_along_axis(closer, n[None], 0)[0] for n in (first - 1, first))
    C = speed((low + high) / 2.0)
    C = C[np.abs(_ratio(sides, C)[1]) >= _ZERO]
    A, B = _ratio(sides, C)
    # Where A vanishes fields at real speeds are those of Im C -> -0.
    A_off, B_off = _ratio(sides, C - 1j * _OFF_AXIS * np.abs(C))
    zero = np.copysign(0.0, (A_off * B_off.conj()).real)
    return np.where(np.abs(A) < _ZERO, zero, (A * B.conj()).real / np.abs(B) ** 2).tolist()
