"""Two elastic bodies in sliding contact: a plate, and a punch that is a half-plane above it.

The punch's half-plane, mirrored at Y = 0, is one below the surface: its stiffnesses c₁₆ and c₂₆ change
their sign, and so does the shear stress on it. The slopes of both surfaces add up to that of the punch's
profile, and so do their compliances, with n₁₂' of the mirrored punch:

    μ v,X = (n + n' μ/μ') H[σ_YY] + (n₁₂ - n₁₂' μ/μ') H[σ_XY] - (q - q' μ/μ') σ_XY

Like bodies at the same speed over the contact, rest among them, are not coupled (Dundurs, 1969). The
pressure and its ends are those of a rigid punch on a solid with these constants. Stresses in each body
follow from the pressure and that body's own constants. A plate may have layers.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import copysign
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from .flutter import Side, thresholds
from .half_plane import HalfPlane, UniformHalfPlane
from .solid import Composite, Solid


@dataclass(frozen=True)
class PairAtSpeed:
    """A plate at its speed under an elastic punch at its own; n, n₁₂ and q are those of both together.

    All else, as stresses, displacements and layers, is that of the plate.

    Attributes:
        plate: half-plane of the plate.
        punch: half-plane of the punch, mirrored at Y = 0.
        ratio: shear modulus of the plate's surface over that of the punch.
    """

    plate: HalfPlane
    punch: UniformHalfPlane
    ratio: float

    def __getattr__(self, name: str) -> Any:
        if name in ("plate", "punch", "ratio"):  # not set yet, as in a copy
            raise AttributeError(name)
        return getattr(self.plate, name)

    @cached_property
    def n(self) -> float:
        return self.plate.n + self.ratio * self.punch.n

    @cached_property
    def n12(self) -> float:
        return self.plate.n12 - self.ratio * self.punch.n12

    @cached_property
    def q(self) -> float:
        return self.plate.q - self.ratio * self.punch.q

    @property
    def margin(self) -> float:
        return min(self.plate.margin, self.punch.margin)

    @property
    def mirrored(self) -> bool:
        return self.plate.mirrored and self.punch.mirrored


@dataclass(frozen=True)
class Pair(Composite):
    """A plate and the solid of a punch; modulus, density and wave speed are those of the plate.

    Attributes:
        plate: uniform solid, or one with layers.
        punch: uniform solid, in the frame of the scene.
        speed: of the punch's solid over the contact [m/s]; 0 slides, a speed near the plate's rolls.
        punch_strength: uniaxial yield strength of the punch's solid [Pa]; None where it is not given.
    """

    about: ClassVar[str] = "a plate under an elastic punch"

    plate: Solid
    punch: Solid
    speed: float
    punch_strength: float | None = None

    @property
    def surface(self) -> Solid:
        return self.plate.surface

    @property
    def layers(self) -> Sequence[Any]:  # type: ignore[override]
        return self.plate.layers

    @property
    def depths(self) -> NDArray[np.float64]:
        return self.plate.depths

    @property
    def solids(self) -> Sequence[Solid]:
        return self.plate.solids

    def __getattr__(self, name: str) -> Any:
        # What plates with layers have besides.
        if name == "plate":  # not set yet, as in a copy
            raise AttributeError(name)
        return getattr(self.plate, name)

    @property
    def above(self) -> Solid:  # type: ignore[override]
        return self.punch

    @property
    def form(self) -> str:
        return self.plate.form if self.plate.form == self.punch.form else "anisotropic"

    @property
    def nearly_incompressible(self) -> bool:
        return self.plate.nearly_incompressible or self.punch.nearly_incompressible

    @property
    def knows_σ_ZZ(self) -> bool:
        return self.plate.knows_σ_ZZ

    @cached_property
    def _sides(self) -> tuple[Side, Side]:
        return Side.of(self.surface), Side.of(self.punch, below=False)

    def flutter(self, c: float = 0.0) -> tuple[float, float]:
        plate, punch = self._sides
        own = copysign(self.speed, c)
        return thresholds(replace(plate, speed=c * self.plate.c_s), replace(punch, speed=own))

    def limit(self) -> float:
        return self.plate.limit()

    @cached_property
    def _punch(self) -> UniformHalfPlane:
        return self.punch.response(self.speed / self.punch.c_s).surface.mirror_image

    def response(self, c: float, a: float = 1.0) -> PairAtSpeed:  # type: ignore[override]
        """Both half-planes, the plate's at a speed over its wave speed."""
        return PairAtSpeed(self.plate.response(c, a), self._punch, self.μ / self.punch.μ)

    def words(self) -> str:
        motion = f"at {self.speed:g} m/s over the contact" if self.speed else "at rest"
        return f"{self.plate.words()}, under a punch of {self.punch.words()}, {motion}"
