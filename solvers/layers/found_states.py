"""Contacts over layers that were found: with so many unknowns, settled, and of some frictions."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.layers.contact import Found, change
from galinx.solvers.layers.kinked import Kinked
from galinx.solvers.layers.panelled import PanelledPressure
from galinx.solvers.layers.pressure import Pressure
from galinx.solvers.layers.states import Frictions

#: Distances from a free end at which pressures are compared besides, places between, and how much more
#: they have to agree there.
_NEXT_TO_END, _ACROSS, _MORE_AT_ENDS = np.geomspace(1e-6, 1e-2, 5), np.linspace(-0.9, 0.9, 20), 10.0


@dataclass(frozen=True)
class Contact(Found):
    """A pressure with the contact that it was found for; lengths are over one that all states share.

    Attributes:
        half_width: of the contact.
        centre: its middle, from the punch's axis.
        free: were the left and the right end found?
    """

    half_width: float = 1.0
    centre: float = 0.0
    free: tuple[bool, bool] = (True, True)


@dataclass(frozen=True)
class Tried:
    """A contact with so many unknowns.

    Attributes:
        h, m: half-width and middle.
        pressure: the contact's.
        left: share of it that was taken away so that no intensity is left at free ends.
        free: were the left and the right end found?
    """

    h: float
    m: float
    pressure: Pressure
    left: float = 0.0
    free: tuple[bool, bool] = (True, True)

    def moved(self, before: "Tried") -> float:
        """What changed since then: the lengths, and the pressure, next to free ends with a factor.

        In-plane stresses follow it with one there.
        """
        lengths = max(abs(self.h - before.h), abs(self.m - before.m)) / self.h
        ends = [side * (1.0 - _NEXT_TO_END) for side, free in zip((-1.0, 1.0), self.free) if free]
        at = np.concatenate([*ends, _ACROSS])
        one, other = (
            (1.0 - at) ** p.α * (1.0 + at) ** p.β * p.series(at) for p in (before.settled, self.settled)
        )
        near = np.abs(one - other)[: -len(_ACROSS)].max(initial=0.0) / np.abs(other).max()
        return max(change(before.settled, self.settled), lengths, _MORE_AT_ENDS * float(near))

    @cached_property
    def settled(self) -> Pressure:
        """The pressure, made to vanish at free ends where panels leave digits."""
        pressure, free = self.pressure, self.free
        if isinstance(pressure, Kinked) and isinstance(pressure.more, PanelledPressure):
            return replace(pressure, more=pressure.more.vanishing(free))
        return pressure.vanishing(free) if isinstance(pressure, PanelledPressure) else pressure


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

    @cached_property
    def free(self) -> NDArray[np.float64]:
        """1 where the left and the right end were found, 0 at others, (nodes, 2)."""
        return np.array([one.free for one in self.each], dtype=float)

    @cached_property
    def tips(self) -> NDArray[np.float64]:
        """Places at which the pressure is infinite inside the contact, (nodes, k); infinity for none."""
        each = [one.pressure.tips for one in self.each]
        found = np.full((len(each), max(map(len, each))), np.inf)
        for row, tips in zip(found, each):
            row[: len(tips)] = tips
        return found

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
