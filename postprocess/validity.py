"""Where the answers of a run do not hold, in words; all of it is archived state by state."""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.quantities import validity as of
from galinx.postprocess.quantities.states import RATIO

#: Wave crossings in a stroke below which a steady state is not reached.
FEW = 30.0

#: Share of the half-width from which on a zone at an edge is told of.
WIDE = 0.01

#: σ_XY/σ_YY from which on an interface with Coulomb friction may flutter.
STEEP = 1.0


class Validity:
    """Watches the datasets of states, some at a time."""

    def __init__(self) -> None:
        self._states: dict[str, int] = {}
        self._worst: dict[str, float] = {}
        self._where = 0.0

    def see(self, data: Mapping[str, Any]) -> None:
        """Take datasets of some states into account, by path."""
        if of.CROSSINGS.path in data:
            often = data[of.CROSSINGS.path]
            self._count("crossings", often < FEW, -often)
        if RATIO.path in data:
            ratio = np.abs(data[RATIO.path])
            self._count("ratio", ratio >= STEEP, ratio)
        for name, ends in (("slip", of.SLIP_REVERSED), ("strain", of.STRAIN)):
            if ends[0].path in data:
                width = np.max([data[end.path] for end in ends], axis=0)
                self._count(name, width > WIDE, width)
        for size, where in of.TENSION.values():
            if size.path in data:
                tension = data[size.path]
                if np.nanmax(tension, initial=0.0) > self._worst.get("tension", 0.0):
                    self._where = float(data[where.path][np.nanargmax(tension)])
                self._count("tension", tension > 0.0, tension)

    def _count(self, name: str, bad: NDArray, size: NDArray) -> None:
        if bad.any():
            self._states[name] = self._states.get(name, 0) + int(bad.sum())
            self._worst[name] = max(self._worst.get(name, -np.inf), float(np.max(size[bad])))

    def words(self) -> list[str]:
        """A sentence for each thing that does not hold."""
        return [*self._words()]

    def _words(self) -> Iterator[str]:
        told = {name: f"{self._worst[name]:.3g}" for name in self._worst}
        some = {name: f"{n} state{'s' * (n > 1)}" for name, n in self._states.items()}
        if "crossings" in told:
            yield (
                "in a stroke a shear wave crosses the contact "
                f"{-self._worst['crossings']:.2g} times at the least, and less than {FEW:g} times in "
                f"{some['crossings']}: the steady state that is told is a limit which such a stroke does "
                "not reach"
            )
        if "ratio" in told:
            yield (
                f"|σ_XY/σ_YY| is up to {told['ratio']}, and at least {STEEP:g} in {some['ratio']}: such "
                "an interface may flutter at short waves"
            )
        if "slip" in told:
            yield (
                f"slip has turned round up to {told['slip']} a from an edge, beyond {WIDE:g} a in "
                f"{some['slip']}: friction points the other way there"
            )
        if "strain" in told:
            yield (
                f"strains are beyond 5 % up to {told['strain']} a from an edge, beyond {WIDE:g} a in "
                f"{some['strain']}: the solid is not linear there"
            )
        if "tension" in told:
            yield (
                f"the punch would have to pull, by up to {told['tension']} N/(2a), at X/a = "
                f"{self._where:.4g}, in {some['tension']}: it would lift off there"
            )
