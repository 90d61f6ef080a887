"""Which state is which: the product of speeds, loads, laws and places, in the order of archives."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Order:
    """States by speed, load, law and place on the strokes, the last fastest.

    Attributes:
        given: speeds over c_s that strokes have which have none of their own.
        loads: [N/m].
        laws: their number.
        own: speeds over c_s of the states along all strokes, NaN where that is the given one, (places,).
    """

    given: tuple[float, ...]
    loads: tuple[float, ...]
    laws: int
    own: NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.given) * self.states

    @property
    def states(self) -> int:
        """At each given speed."""
        return len(self.loads) * self.laws * len(self.own)

    @property
    def shape(self) -> tuple[int, int, int, int]:
        """Numbers of speeds, loads, laws and places."""
        return len(self.given), len(self.loads), self.laws, len(self.own)

    @property
    def c(self) -> NDArray[np.float64]:
        """Speed of every state over c_s, (states,)."""
        speeds = np.where(np.isnan(self.own), np.array(self.given)[:, None], self.own)
        return np.repeat(speeds, self.shape[1] * self.laws, axis=0).ravel()

    @cached_property
    def speeds(self) -> tuple[float, ...]:
        """All speeds over c_s, each once, as states meet them first."""
        if self._given_alone:
            return self.given
        met = np.where(np.isnan(self.own), np.array(self.given)[:, None], self.own)
        return tuple(dict.fromkeys(met.ravel().tolist()))

    @property
    def _given_alone(self) -> bool:
        return bool(np.isnan(self.own).all())

    def runs(self) -> Iterator[tuple[slice, ...]]:
        """Numbers of the states of every speed, as runs of states that follow one another."""
        if self._given_alone:
            for i in range(len(self.given)):
                yield (slice(i * self.states, (i + 1) * self.states),)
            return
        # A state's speed is the same under every load and law: few places tell all.
        c = self.c
        first = np.flatnonzero(np.diff(c, prepend=np.nan))
        by_speed: dict[float, list[slice]] = {}
        for start, stop in zip(first.tolist(), [*first[1:].tolist(), len(c)]):
            by_speed.setdefault(float(c[start]), []).append(slice(start, stop))
        for speed in self.speeds:
            yield tuple(by_speed[speed])

    def load(self, rows: slice) -> NDArray[np.float64]:
        """Load of some states [N/m]."""
        per_load = self.laws * len(self.own)
        return np.array(self.loads)[np.arange(rows.start, rows.stop) // per_load % len(self.loads)]
