"""How quantities are told: as archived, or scaled."""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.quantities import Quantity, states, validity, yielding


class Scaled(NamedTuple):
    """What a quantity is called where it is told, its unit, and how its numbers are told.

    They are multiplied by the factor, then the offset is added: one number, or one of each state,
    (states,), where contacts of states differ.
    """

    name: str
    unit: str
    factor: Any
    offset: Any = 0.0

    @property
    def head(self) -> str:
        """Of a column."""
        return self.name if self.unit == "none" else f"{self.name} [{self.unit}]"

    def of(self, values: NDArray, states: Any = slice(None)) -> NDArray:
        """Numbers as they are told.

        Args:
            values: as archived, (states, …).
            states: numbers of their states, where these are not all.
        """
        if np.ndim(self.factor):
            factor, offset = (
                np.broadcast_to(one, self.factor.shape)[states].reshape(-1, *(1,) * (values.ndim - 1))
                for one in (self.factor, self.offset)
            )
            return values * factor + offset
        return values if self.factor == 1.0 else self.factor * values


#: How a quantity of some name is told; None where it is not, since another becomes the same.
Scaling = Callable[[Quantity, str], Scaled | None]


def as_archived(row: Quantity, name: str) -> Scaled:
    """In its own unit."""
    return Scaled(name, row.unit, 1.0)


#: Numbers of states that are lengths over the half-width.
LENGTHS = (
    *validity.STRAINED,
    *states.LARGEST_X.values(),
    *(where for _, where in validity.TENSION.values()),
    *(row for rows in yielding.OVER_HALF_WIDTH for row in rows.values()),
)
