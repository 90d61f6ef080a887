"""Warnings where the answers of a run do not hold, from quantities that are archived for each state."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from math import isfinite
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .quantities import validity as of
from .quantities.states import HALF_WIDTH, LARGEST_RATIO, RATIO, SPEED
from .units import engineering

#: Wave crossings of the contact in a stroke below which steady motion is not reached.
FEW = 30.0

#: Paths of the flutter thresholds of σ_XY/σ_YY.
THRESHOLDS = tuple(row.path for row in of.FLUTTER.values())
#: Width over a beyond which a zone at an edge is reported.
WIDE = 0.01


def own_crossings(crossed: NDArray, data: Mapping[str, Any]) -> dict[str, NDArray[np.float64]]:
    """Wave crossings of contacts whose half-widths a method has solved, by path; empty without any.

    Args:
        crossed: half the way of a wave during each state's stroke [m], L/(2c), (states,).
        data: datasets of the states by path.
    """
    widths = [data[row.path] for row in HALF_WIDTH.values() if row.path in data]
    a = np.full(len(crossed), np.nan)
    for values in widths:
        a = np.where(np.isnan(a), values, a)
    return {of.CROSSINGS.path: crossed / a} if widths else {}


@dataclass(frozen=True)
class Steady:
    """Time that a start from rest takes to come near steady motion, compared with that of a stroke.

    Attributes:
        within: function of the speed over c_s and σ_XY/σ_YY that gives the time over a/c_s from which on
            K_I and the pressure's centre are within 1 % of those of steady motion; infinite where they
            never are.
        unit: a/c_s [s].
    """

    within: Callable[[float, float], float]
    unit: float

    def words(self, c: float, g: float, crossings: float, too_short: bool = False) -> str:
        """Comparison with the time of a stroke, in words; "" where motion never is steady.

        Args:
            c, g: speed over c_s and σ_XY/σ_YY.
            crossings: number of times that a shear wave crosses the contact during the stroke.
            too_short: return "" for a stroke that is long enough, too.
        """
        needed, lasts = self.within(c, g), 2.0 * crossings
        if not isfinite(needed) or (too_short and lasts >= needed):
            return ""
        return (
            f"from rest it takes {needed:.3g} a/c_s ({engineering(needed * self.unit, 's', 3)}) to come "
            f"within 1 % of it, at c = {c:.4g}, and the stroke lasts {lasts:.3g} a/c_s "
            f"({engineering(lasts * self.unit, 's', 3)})"
        )


class Validity:
    """Warnings where answers do not hold, collected from datasets that come in parts.

    Args:
        steady: time that a start from rest takes to come near steady motion; None where it is unknown.
    """

    def __init__(self, steady: Steady | None = None) -> None:
        self._steady = steady
        #: The shortest stroke, which has few crossings, and the fastest that has enough, if any: speed
        #: over c_s, σ_XY/σ_YY and wave crossings.
        self._shortest: list[tuple[float, float, float]] = []
        self._fastest: list[tuple[float, float, float]] = []
        self._states: dict[str, int] = {}
        self._worst: dict[str, float] = {}
        self._where = 0.0
        #: Thresholds of |σ_XY/σ_YY| that a state passes.
        self._steep: set[float] = set()

    def see(self, data: Mapping[str, Any]) -> None:
        """Take datasets by path of further states into account."""
        if of.CROSSINGS.path in data:
            often = data[of.CROSSINGS.path]
            self._count("crossings", often < FEW, -often)
            rows = (SPEED, RATIO, of.CROSSINGS) if self._steady else ()
            strokes = [*zip(*(data[row.path].tolist() for row in rows))]
            short = [*self._shortest, *(stroke for stroke in strokes if stroke[2] < FEW)]
            long = [*self._fastest, *(stroke for stroke in strokes if FEW <= stroke[2] < np.inf)]
            self._shortest = sorted(short, key=lambda stroke: (stroke[2], -abs(stroke[1])))[:1]
            self._fastest = sorted(long, key=lambda stroke: (-stroke[0], -abs(stroke[1])))[:1]
        if RATIO.path in data and all(path in data for path in THRESHOLDS):
            g = data.get(LARGEST_RATIO.path, data[RATIO.path])
            threshold = np.where(g > 0.0, *(data[of.FLUTTER[sign].path] for sign in of.SIGNS))
            steep = (np.abs(g) >= threshold) & (g != 0.0)
            self._count("ratio", steep, np.abs(g))
            self._steep |= {*threshold[steep].tolist()}
        for name, ends in (("slip", of.SLIP_REVERSED), ("strain", of.STRAIN)):
            if ends[0].path in data:
                width = np.max([data[end.path] for end in ends], axis=0)
                self._count(name, width > WIDE, width)
        if methods := [method for method, row in of.TENSION.items() if row.path in data]:
            each, where = (
                np.array([data[rows[method].path] for method in methods])
                for rows in (of.TENSION, of.TENSION_X)
            )
            tension = np.nanmax(each, axis=0, initial=0.0)
            if tension.max(initial=0.0) > self._worst.get("tension", 0.0):
                self._where = float(where.flat[np.nanargmax(each)])
            self._count("tension", tension > 0.0, tension)

    def _count(self, name: str, bad: NDArray, size: NDArray) -> None:
        if bad.any():
            self._states[name] = self._states.get(name, 0) + int(bad.sum())
            self._worst[name] = max(self._worst.get(name, -np.inf), float(np.max(size[bad])))

    def words(self) -> Iterator[str]:
        """Warnings, one sentence for each assumption that does not hold."""
        worst = {name: f"{self._worst[name]:.3g}" for name in self._worst}
        states = {name: f"{n} state{'s' * (n > 1)}" for name, n in self._states.items()}
        if "crossings" in worst:
            text = short = ""
            if self._steady and self._shortest:
                text, short = (
                    self._steady.words(*self._shortest[0], too_short=only) for only in (False, True)
                )
            reached = "comes near only towards its end" if text and not short else "does not reach"
            yield (
                "in a stroke a shear wave crosses the contact "
                f"{-self._worst['crossings']:.2g} times at the least, and less than {FEW:g} times in "
                f"{states['crossings']}: the reported steady state is a limit that such a stroke "
                f"{reached}" + f"; {text}" * bool(text)
            )
        fast = self._steady.words(*self._fastest[0], True) if self._steady and self._fastest else ""
        if fast:
            yield f"the steady state is reported, but {fast}"
        if "ratio" in worst:
            up_to, steep = f"|σ_XY/σ_YY| is up to {worst['ratio']}", sorted(self._steep)
            if steep != [0.0]:
                least = " to ".join(dict.fromkeys(f"{end:.3g}" for end in (steep[0], steep[-1])))
                yield (
                    f"{up_to}, not below the flutter threshold, {least}, in {states['ratio']}: such an "
                    "interface may flutter at short waves"
                )
            else:
                yield (
                    f"{up_to} in {states['ratio']}: short waves between these two bodies grow under any "
                    "friction; such an interface may flutter"
                )
        if "slip" in worst:
            yield (
                f"slip has turned round up to {worst['slip']} a from an edge, beyond {WIDE:g} a in "
                f"{states['slip']}: friction points the other way there"
            )
        if "strain" in worst:
            yield (
                f"strains are beyond 5 % up to {worst['strain']} a from an edge, beyond {WIDE:g} a in "
                f"{states['strain']}: the solid is not linear there"
            )
        if "tension" in worst:
            yield (
                f"the punch would have to pull, by up to {worst['tension']} N/(2a), at X/a = "
                f"{self._where:.4g}, in {states['tension']}: it would lift off there"
            )
