"""What a scene says, section by section; numbers are in SI."""

import hashlib
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np

from galinx.app.scene.values import Spread
from galinx.postprocess.quantities.quantity import OWN_PRESSURE
from galinx.solvers.friction import FrictionLaw
from galinx.solvers.parameters import made
from galinx.solvers.profiles import Profile
from galinx.solvers.solids import Solid


@dataclass(frozen=True)
class Punch:
    """[punch]: a profile, pressed on by ``load`` [N/m]."""

    profile: Profile
    load: float


@dataclass(frozen=True)
class Friction:
    """[friction]: laws, how they are integrated over strokes of ``pre_sliding`` [m], the sign of σ_XY.

    Attributes:
        law: the class of the laws.
        parameters: values of each of its parameters by key; their product is computed.
    """

    law: type[FrictionLaw]
    parameters: dict[str, tuple[Any, ...]]
    pre_sliding: float
    integrator: str
    sign: str

    def laws(self) -> list[tuple[dict[str, Any], FrictionLaw]]:
        """Every law with its parameters by key; the last parameter changes fastest.

        Raises:
            ValueError: a law refuses its parameters.
        """
        all_values = [dict(zip(self.parameters, values)) for values in product(*self.parameters.values())]
        return [(values, made(self.law, values)) for values in all_values]

    @property
    def stress_ratio(self) -> float:
        """σ_XY/σ_YY under the punch over f."""
        return -1.0 if self.sign == "physical" else 1.0


@dataclass(frozen=True)
class Motion:
    """[motion]: ``c`` over the wave speed or ``speed`` [m/s], the other None; strokes and positions."""

    c: tuple[float, ...] | None
    speed: tuple[float, ...] | None
    strokes: tuple[str, ...]
    X_over_L: tuple[float, ...]


@dataclass(frozen=True)
class Solve:
    """[solve]: methods and what they are given, see the keys."""

    methods: tuple[str, ...]
    tolerance: float
    mesh: str
    mode: str
    degree: int | None
    cuts: int
    solver: str
    pressure: Any

    @property
    def own_pressure(self) -> bool:
        """Is a pressure of the user's own put in?"""
        return self.mode == "traction" and self.pressure != "closed_form"

    @property
    def modes(self) -> tuple[str, ...]:
        """Words by which quantities and rules say that they are of this mode."""
        return ("", self.mode, *(OWN_PRESSURE,) * self.own_pressure)


@dataclass(frozen=True)
class Output:
    """[output]: words for quantities, and where stresses inside are wanted, over a."""

    quantities: tuple[str, ...]
    points: tuple[tuple[float, float], ...] = ()
    map: tuple[Spread, Spread] | None = None

    @property
    def inside(self) -> tuple[tuple[float, float], ...]:
        """All points inside: first the map's, by rows of Y, then the single ones."""
        if self.map is None:
            return self.points
        X, Y = (np.linspace(axis.first, axis.last, axis.count) for axis in self.map)
        return (*((x, y) for y in Y.tolist() for x in X.tolist()), *self.points)


@dataclass(frozen=True)
class Scene:
    """A checked scene; numbers are in SI.

    Attributes:
        title: free text.
        text: the TOML it came from, byte for byte as archived.
        solid, punch, friction, motion, solve, output: its sections.
    """

    title: str
    text: str
    solid: Solid
    punch: Punch
    friction: Friction
    motion: Motion
    solve: Solve
    output: Output

    @property
    def sha256(self) -> str:
        """Hash of the scene's text."""
        return hashlib.sha256(self.text.encode()).hexdigest()
