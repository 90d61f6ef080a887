"""Pressures over layers under punches whose slope, or its derivative, jumps.

What a kink does to the pressure is of the surface's solid alone: with f the slope less the mean by which
the pressure σ₀ of :mod:`galinx.solvers.sie.panels` vanishes at both ends, what layers add is a pressure
under that mean and what σ₀ bends them by, -∫ K(r - t) σ₀(t) dt, which no kink makes rough.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.layers.contact import Equation, Resolution
from galinx.solvers.layers.ends import Punch, finest, vanishing
from galinx.solvers.layers.panelled import PanelledPressure, Panels
from galinx.solvers.layers.pressure import Pressure
from galinx.solvers.profiles import cusp, jumps
from galinx.solvers.sie.ends import Balance
from galinx.solvers.sie.found import NEXT_TO_TIP
from galinx.solvers.sie.panels import FreeEnds

#: Positions on which kernels are held at once, over those of a rule.
_TOGETHER = 200


@dataclass(frozen=True)
class Kinked:
    """See :class:`galinx.solvers.layers.pressure.Pressure`.

    Attributes:
        alone: σ₀, that on the surface's solid alone.
        more: what layers add to it.
        places: of the kinks.
        finest: longest panel on which integrals of σ₀ with kernels are done.
        rough: have kernels a logarithm at 0?
        tips: those of the kinks at which the pressure is infinite.
    """

    alone: FreeEnds
    more: Pressure
    places: tuple[float, ...]
    finest: float
    rough: bool
    tips: tuple[float, ...]

    @property
    def near(self) -> float:
        return self.more.near

    @property
    def α(self) -> float:
        return self.more.α

    @property
    def β(self) -> float:
        return self.more.β

    @cached_property
    def _alone(self) -> PanelledPressure:
        return on_panels(self.alone, self.α, self.β, self.finest, self.places)

    def series(self, r: NDArray) -> NDArray[np.float64]:
        return without_weight(self.alone, self.α, self.β, self._off(r)) + self.more.series(r)

    def rest(self, r: NDArray, near: float) -> NDArray[np.float64]:
        found, under = self.more.rest(r, near), np.abs(r) < 1.0
        # cot(πα) = Q/n turns σ₀ under the punch into f/n.
        found[under] += self.alone.slope(r[under]) / self.alone.n
        found[~under] += self.alone.hilbert(r[~under])
        return found

    def integral(self, kernel: Callable[[NDArray], NDArray], r: NDArray) -> NDArray[np.float64]:
        return self.more.integral(kernel, r) + integral(self._alone, kernel, r, self.rough)

    def points(self, finest: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        fine = on_panels(self.alone, self.α, self.β, min(finest, self.finest), self.places)
        t, σ = self.more.points(finest)
        return np.append(t, fine.panels.t), np.append(σ, fine.panels.weights * fine.p)

    def _off(self, r: NDArray) -> NDArray[np.float64]:
        """Positions, none where the pressure is infinite."""
        for tip in self.tips:
            side = np.where(r < tip, -1.0, 1.0)
            r = np.where(np.abs(r - tip) < NEXT_TO_TIP, tip + side * NEXT_TO_TIP, r)
        return r


def without_weight(alone: FreeEnds, α: float, β: float, r: NDArray) -> NDArray[np.float64]:
    """σ₀ over the weight (1 - r)^α (1 + r)^β, which is 0 from both ends on."""
    r, inside = np.asarray(r, dtype=float), np.abs(r) < 1.0
    found, at = np.zeros_like(r), r[inside]
    found[inside] = alone.σ_YY(at) * (1.0 - at) ** -α * (1.0 + at) ** -β
    return found


def on_panels(
    alone: FreeEnds, α: float, β: float, finest: float, places: tuple[float, ...]
) -> PanelledPressure:
    """σ₀ by its values on panels that get shorter towards its kinks."""
    panels = Panels(α, β, finest, places)
    return PanelledPressure(panels, without_weight(alone, α, β, panels.t))


def integral(
    pressure: PanelledPressure, kernel: Callable[[NDArray], NDArray], r: NDArray, rough: bool
) -> NDArray[np.float64]:
    """∫ kernel(r - t) σ(t) dt, (len(r), functions)."""
    if rough:
        return pressure.integral(kernel, r)
    t, σ = pressure.panels.t, pressure.panels.weights * pressure.p
    some = [r[first : first + _TOGETHER] for first in range(0, len(r), _TOGETHER)]
    return np.concatenate([np.einsum("rtf,t->rf", kernel(part[:, None] - t), σ) for part in some])


def kinked(
    equation: Equation, resolution: Resolution, punch: Punch, m: float, h: float
) -> tuple[Kinked, float]:
    """The pressure of a contact with kinks, and what :func:`galinx.solvers.layers.ends.vanishing` tells.

    Args:
        equation: of the contact, with its slope.
        resolution: how finely it is solved.
        punch: the punch.
        m, h: middle and half-width.
    """
    a, profile, places = 1.0 + equation.α, punch.profile, punch.kinks(m, h)
    panels = Balance(profile, a, np.nan).panels(punch.unit * m, punch.unit * h)
    whole = equation.slope(panels.t)
    mean = float(panels.weights @ whole / panels.weights.sum())

    def slope(r: NDArray) -> NDArray[np.float64]:
        return equation.slope(r) - mean

    alone = FreeEnds(
        panels, whole - mean, slope, equation.n, equation.g * float(equation.response.q),
        (places, cusp(profile)),
    )  # fmt: skip
    carried = -np.sin(np.pi * a) / equation.n * float(panels.weights @ (panels.t * (whole - mean)))
    longest, rough = finest(resolution), equation.kernel.rough
    known = on_panels(alone, equation.α, equation.β, longest, places)

    def of_layers(r: NDArray) -> NDArray[np.float64]:
        by_kernel = integral(known, equation.kernel, r, rough)
        return mean - by_kernel[:, 3] - equation.g * by_kernel[:, 2]

    more = Equation(equation.response, equation.kernel, equation.g, of_layers, places)
    tips = places if jumps(profile) else ()
    added, left = vanishing(more, resolution, -2.0 - carried)
    return Kinked(alone, added, places, longest, rough, tips), left
