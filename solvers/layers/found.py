"""Contacts over layers whose ends are found, by the singular integral equation.

The equation of a contact from m - h to m + h whose ends were sharp edges is linear in the slope there:
under a parabola, of (m + h r)/R. The intensities at both ends vanish for one sum of three pressures, that
of a flat punch and those under the slopes 1 and r; their shares tell m and the load that makes a contact
of the half-width h. It grows with h, which is found for the load that is wanted.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.errors import SolveError
from galinx.solvers.layers.contact import (
    FIRST,
    Equation,
    Found,
    Resolution,
    change,
    check_exponents,
    ever_finer,
    met,
    not_met,
)
from galinx.solvers.layers.kernel import REACH, Kernel, Scaled
from galinx.solvers.layers.layered import Layered
from galinx.solvers.layers.panelled import PanelledPressure
from galinx.solvers.layers.pressure import Pressure
from galinx.solvers.layers.states import Frictions, Speed
from galinx.solvers.profiles.parabolic import Parabolic

#: Slopes under a parabola, the flat punch's first.
SHAPES = (np.zeros_like, np.ones_like, np.asarray)
#: Steps in which a half-width is found, the largest of its logarithm, and what is rounding of it.
_STEPS, _LARGEST, _ROUNDING = 60, 1.5, 1e-13
#: By how much the load's logarithm grows with that of the half-width, before it is known.
_GROWTH = 2.0
#: Accuracy of a half-width that others are told over.
_AT_REST = 1e-5
#: How much farther kernels are tabulated than the largest contact so far asks for.
_FARTHER = 1.5


@dataclass(frozen=True)
class Parabola:
    """A parabolic punch and its load.

    Attributes:
        radius: over the length that lengths are over.
        compression: N/μ over that length.
    """

    radius: float
    compression: float

    def balanced(self, K: NDArray, h: float) -> tuple[NDArray[np.float64], float, float]:
        """What leaves no intensity at both ends of a contact of the half-width h.

        Args:
            K: intensities of the flat punch's pressure and of those under the slopes 1 and r, (2, 3).
            h: half-width.

        Returns:
            The amplitudes of these three, the middle, and the logarithm of the load that it takes over
            the wanted one; infinite where it takes tension.
        """
        shift, bend = np.linalg.solve(K[:, 1:], -K[:, 0])
        # The slope over N/(2h) is (2h/(N/μ)) (m + h r)/R.
        taken = 2.0 * h**2 / (self.radius * bend) if bend > 0.0 else np.inf
        return (
            np.array([1.0, shift, bend]),
            float(h * shift / bend),
            float(np.log(taken / self.compression)),
        )


@dataclass(frozen=True)
class Contact(Found):
    """A pressure with the contact that it was found for; lengths are over one that all states share.

    Attributes:
        half_width: of the contact.
        centre: its middle, from the punch's axis.
    """

    half_width: float = 1.0
    centre: float = 0.0


@dataclass(frozen=True)
class FoundSpeed(Speed):
    """What all frictions at a speed share, of a punch whose contact ends where the pressure says.

    Attributes:
        punch: the punch; ``slope`` of :class:`Speed` is not asked.
        every: is each friction solved, however many there are?
    """

    punch: Any = None
    every: bool = False

    @cached_property
    def _kernels(self) -> list[Kernel]:
        return [Kernel(self.stack, self.tolerance / 1e3)]

    @property
    def kernel(self) -> Kernel:
        """With lengths over the shared one."""
        return self._kernels[-1]

    def scaled(self, h: float) -> Scaled:
        """The kernel of a contact of the half-width h; a longer table is made where one is needed."""
        if (needed := REACH * h) > self.kernel.reach:
            self._kernels.append(replace(self.kernel, reach=_FARTHER * needed))
        return Scaled(self.kernel, h)

    def solved(self, g: NDArray) -> tuple[Frictions, NDArray[np.float64]]:
        if self.every:
            return Contacts(g, self._each(g)), np.zeros(1)
        return super().solved(g)

    def _together(self, g: NDArray, each: list[Any]) -> Frictions:
        return Contacts(g, each)

    def _each(self, g: NDArray) -> list[Found]:
        found: list[Found] = []
        h = 1.0
        for value in g.tolist():
            one = self.contact(value, h)
            h = one.half_width
            found.append(one)
        return found

    def contact(self, g: float, h: float = 1.0) -> Contact:
        """The contact with a friction.

        Args:
            g: σ_XY/σ_YY.
            h: half-width near by.

        Raises:
            SolveError: no contact carries the load, or it is not resolved.
        """
        check_exponents(Equation(self.response, self.kernel, g, self.slope))
        before, left = None, np.inf
        for resolution in ever_finer(self.kernel.rough, FIRST):
            h, m, pressure = self._balanced(g, h, resolution)
            if before is not None:
                h_before, m_before, pressure_before = before
                moved = max(abs(h - h_before), abs(m - m_before)) / h
                left = max(change(pressure_before, pressure), moved)
                if met(left, self.tolerance):
                    return Contact(pressure, pressure_before, left, h, m)
            before = h, m, pressure
        raise not_met(left, self.tolerance)

    def _balanced(self, g: float, h: float, resolution: Resolution) -> tuple[float, float, Pressure]:
        """Half-width, middle and pressure with so many unknowns."""

        def at(x: float) -> tuple[float, Any, float]:
            h = float(np.exp(x))
            equation = Equation(self.response, self.scaled(h), g, self.slope)
            parts = equation.parts(resolution, SHAPES, (-2.0, 0.0, 0.0))
            amplitudes, m, off = self.punch.balanced(parts.ends, h)
            return off, (parts, amplitudes), m

        x, (parts, amplitudes), m = balanced(at, float(np.log(h)))
        pressure = parts.pressure(amplitudes)
        if isinstance(pressure, PanelledPressure):
            pressure = pressure.vanishing()
        return float(np.exp(x)), m, pressure


def balanced(at: Callable[[float], tuple[float, Any, float]], x: float) -> tuple[float, Any, float]:
    """Where a growing function vanishes, by secants; what else it gives there.

    Args:
        at: of the logarithm of a half-width gives that of the load over the wanted one, and more.
        x: to begin with.

    Raises:
        SolveError: it does not vanish.
    """
    growth, before = _GROWTH, None
    for _ in range(_STEPS):
        off, *more = at(x)
        if before is not None and np.isfinite(off) and x != before[0]:
            secant = (off - before[1]) / (x - before[0])
            growth = secant if 0.3 < secant < 20.0 else growth
        step = -off / growth if np.isfinite(off) else -_LARGEST
        step = float(np.clip(step, -_LARGEST, _LARGEST))
        if abs(step) <= _ROUNDING or (
            before is not None and abs(off) <= 1e-12 and abs(off) >= abs(before[1])
        ):
            return x, more[0], more[1]
        before, x = (x, off), x + step
    raise SolveError(
        f"no contact over the layers was found that carries the load: in {_STEPS} steps its half-width "
        f"came to {np.exp(x):.6g} of that at rest, and is not settled; take a speed farther from the "
        "limit"
    )


@dataclass(frozen=True)
class Contacts(Frictions):
    """Contacts with some frictions, from which those with others are interpolated."""

    each: list[Any]

    @cached_property
    def half_width(self) -> NDArray[np.float64]:
        """Of every contact, (nodes,)."""
        return np.array([one.half_width for one in self.each])

    @cached_property
    def centre(self) -> NDArray[np.float64]:
        """Middle of every contact, (nodes,)."""
        return np.array([one.centre for one in self.each])

    def of_each(self, what: Callable[[Pressure, float, float], NDArray]) -> NDArray[np.float64]:
        """What is read off every pressure, its friction and half-width, and off that with fewer unknowns,
        (2, nodes, ...)."""
        nodes = list(zip(self.each, self.g.tolist(), self.half_width.tolist()))
        return np.array(
            [
                [what(one.pressure, g, h) for one, g, h in nodes],
                [what(one.before, g, h) for one, g, h in nodes],
            ]
        )

    @property
    def smooth(self) -> NDArray[np.float64]:
        lengths = np.column_stack([self.half_width, self.centre]) / self.half_width.max()
        pressures = super().smooth
        return np.column_stack([pressures / np.abs(pressures).max(), lengths])


@lru_cache(maxsize=256)
def half_width_at_rest(solid: Layered, punch: Parabolic, compression: float) -> float:
    """Half-width [m] of a contact at rest without friction, to some digits: what others are told over.

    Args:
        solid: the layers.
        punch: the parabola.
        compression: N/μ [m].
    """
    response = solid.response(0.0)
    # That on the surface's solid alone is near enough to measure lengths by.
    unit = float((2.0 * compression * punch.radius * response.n / np.pi) ** 0.5)
    parabola = Parabola(punch.radius / unit, compression / unit)
    speed = FoundSpeed(response, response.stack(unit), np.zeros_like, _AT_REST, parabola)
    return unit * speed.contact(0.0).half_width
