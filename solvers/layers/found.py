"""Contacts over layers whose ends are found, by the singular integral equation.

Where both ends are free, two conditions on the slope alone tell the middle and the load that makes a
contact of the half-width h (:mod:`galinx.solvers.layers.ends`). Where an edge of a tilted punch lifts
off, the contact starts at the other one, and no intensity is left at its end for one sum of two
pressures, that of a flat punch and that under the slope 1. The load grows with h, which is found for the
one wanted.
"""

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
    check_exponents,
    ever_finer,
    met,
    not_met,
)
from galinx.solvers.layers.ends import Punch, balanced, conditions, vanishing
from galinx.solvers.layers.found_states import Contact, Contacts, Tried
from galinx.solvers.layers.kernel import REACH, Kernel, Scaled
from galinx.solvers.layers.kinked import kinked
from galinx.solvers.layers.layered import Layered
from galinx.solvers.layers.states import Frictions, Speed
from galinx.solvers.profiles import check_reach, kinks
from galinx.solvers.profiles.flat import Flat
from galinx.solvers.sie.closed_form import FlatPunch
from galinx.solvers.sie.found import Exponents, contacts
from galinx.solvers.sie.found import local_exponents as of_the_surface

#: Accuracy of a half-width that others are told over.
_AT_REST = 1e-5
#: And with which it is told whether an edge has lifted off.
_OF_ENDS = 1e-6
#: How much farther kernels are tabulated than the largest contact so far asks for.
_FARTHER = 1.5


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
        # Kinks move over the contact with friction, and edges lift off at one: nothing is smooth in it.
        if self.every or len(kinks(self.punch.profile)) or isinstance(self.punch.profile, Flat):
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
        check_exponents(self._equation(g, 1.0))
        before, left = None, np.inf
        for resolution in ever_finer(self.kernel.rough, FIRST):
            now = self._tried(g, h, resolution)
            h = now.h
            if before is not None:
                left = max(now.moved(before), now.left)
                if met(left, self.tolerance):
                    unit = self.punch.unit
                    check_reach(self.punch.profile, unit * (now.m - h), unit * (now.m + h))
                    return Contact(now.settled, before.settled, left, h, now.m, now.free)
            before = now
        raise not_met(left, self.tolerance)

    def _equation(self, g: float, h: float, slope: Any = np.zeros_like) -> Equation:
        return Equation(self.response, self.scaled(h), g, slope)

    def _tried(self, g: float, h: float, resolution: Resolution) -> Tried:
        """With so many unknowns."""
        if isinstance(self.punch.profile, Flat):
            return self._tilted(g, h, resolution)

        h, m = self._lengths(g, h, resolution)
        equation = self._equation(g, h, self.punch.slope(m, h))
        if self.punch.kinks(m, h):
            return Tried(h, m, *kinked(equation, resolution, self.punch, m, h))
        return Tried(h, m, *vanishing(equation, resolution))

    def _lengths(self, g: float, h: float, resolution: Resolution) -> tuple[float, float]:
        """Half-width and middle between two free ends."""

        def at(x: float) -> tuple[float, float]:
            h = float(np.exp(x))
            here = conditions(self._equation(g, h), resolution, self.punch, h)
            m = here.middle()
            return here.off(m), m

        x, m = balanced(at, float(np.log(h)))
        return float(np.exp(x)), m

    def half_width(self) -> float:
        """Of the contact without friction; its pressure is not asked.

        Raises:
            SolveError: no contact carries the load, or it is not resolved.
        """
        h, left = 1.0, np.inf
        for resolution in ever_finer(self.kernel.rough, FIRST):
            before = h
            if isinstance(self.punch.profile, Flat):
                h = self._tilted(0.0, h, resolution).h
            else:
                h, _ = self._lengths(0.0, h, resolution)
            left = abs(h / before - 1.0)
            if met(left, self.tolerance):
                return h
        raise not_met(left, self.tolerance)

    def _tilted(self, g: float, h: float, resolution: Resolution) -> Tried:
        """Of a tilted flat punch, the higher edge of which may have lifted off."""
        punch = self.punch
        whole, rise = punch.profile.half_width / punch.unit, punch.profile.rise
        side = 1 if rise > 0.0 else 0

        def at(x: float) -> tuple[float, Any]:
            h = float(np.exp(x))
            parts = self._equation(g, h).parts(resolution, (np.zeros_like, np.ones_like), (-2.0, 0.0))
            flat, bent = parts.ends[side]
            # The slope over N/(2h) that leaves no intensity is (2h/(N/μ)) θ.
            share = -flat / bent / rise
            taken = 2.0 * h * punch.unit / (share * punch.compression)
            return float(np.log(taken)) if share > 0.0 else np.inf, (parts, -flat / bent)

        off, (parts, _) = at(float(np.log(whole)))
        if off <= 0.0:
            slope = 2.0 * whole * punch.unit / punch.compression * rise
            return Tried(whole, 0.0, parts.pressure(np.array([1.0, slope])), free=(False, False))
        x, (parts, slope) = balanced(at, float(np.log(min(h, whole))))
        h, pressure = float(np.exp(x)), parts.pressure(np.array([1.0, slope]))
        m = float(np.sign(rise)) * (h - whole)
        return Tried(h, m, pressure, free=(side == 0, side == 1))


def local_exponents(
    response: Any, g: NDArray, profile: Any, unit: float, compression: NDArray
) -> Exponents | FlatPunch:
    """What the local analysis says of the ends: those of the surface's solid, one more at free ends.

    Args:
        response: of the layers at a speed.
        g: σ_XY/σ_YY, (states,).
        profile: of the punch.
        unit: length to solve with where that is needed [m].
        compression: N/μ of all or of each [m].
    """
    if not (isinstance(profile, Flat) and profile.rise):
        return of_the_surface(response, g, profile, compression)
    flat, free = FlatPunch(response, g), np.zeros((len(g), 2))
    each = np.broadcast_to(compression, g.shape)
    for N in np.unique(each).tolist():
        punch, some = Punch(profile, unit, N), each == N
        speed = FoundSpeed(response, response.stack(unit), np.zeros_like, _OF_ENDS, punch)
        try:
            free[some] = [speed.contact(value).free for value in g[some].tolist()]
        except SolveError:
            continue  # told of by the method that solves
    left, right = free.T
    return Exponents(flat.α + right, flat.β + left)


@lru_cache(maxsize=256)
def half_width_at_rest(solid: Layered, profile: Any, compression: float) -> float:
    """Half-width [m] of a contact at rest without friction, to some digits: what others are told over.

    Args:
        solid: the layers.
        profile: of the punch.
        compression: N/μ [m].

    Raises:
        SolveError: no contact carries the load.
    """
    response = solid.response(0.0)
    # That on the surface's solid alone is near enough to measure lengths by.
    (unit,) = contacts(response, np.zeros(1), profile, compression).of("half_width").tolist()
    punch = Punch(profile, unit, compression)
    speed = FoundSpeed(response, response.stack(unit), np.zeros_like, _AT_REST, punch)
    return unit * speed.half_width()
