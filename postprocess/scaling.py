"""How quantities are told: as archived, or scaled."""

from collections.abc import Callable
from typing import NamedTuple

from galinx.postprocess.quantities import Quantity, validity, yielding


class Scaled(NamedTuple):
    """What a quantity is called where it is told, its unit, and what its numbers are multiplied by."""

    name: str
    unit: str
    factor: float

    @property
    def head(self) -> str:
        """Of a column."""
        return self.name if self.unit == "none" else f"{self.name} [{self.unit}]"


#: How a quantity of some name is told; None where it is not, since another becomes the same.
Scaling = Callable[[Quantity, str], Scaled | None]


def as_archived(row: Quantity, name: str) -> Scaled:
    """In its own unit."""
    return Scaled(name, row.unit, 1.0)


#: Numbers of states that are lengths over the half-width.
LENGTHS = (
    *validity.STRAINED,
    *(where for _, where in validity.TENSION.values()),
    *(row for rows in yielding.OVER_HALF_WIDTH for row in rows.values()),
)
