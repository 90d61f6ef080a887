"""What a comparison is, and by which figure it is judged."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from galinx.postprocess.quantities.quantity import Quantity


@dataclass(frozen=True)
class Comparison:
    """One figure of disagreement: its short ``name``, what it says, and the ``value`` (1)."""

    name: str
    text: str
    value: float


@dataclass(frozen=True)
class Rule:
    """How quantities are compared, and what decides the verdict.

    Attributes:
        text: what the figure says.
        needs: the quantities that are compared.
        measure: the figure (1) from datasets by path and the load N per depth [N/m], that of each state
            where they differ in it; None where there is nothing to say.
        limit: largest value of a PASS; None where it is no fixed one.
        tolerances: the same in units of the scene's tolerance.
        mode: in which it is judged, as of a quantity; "" for each.
        own_pressure: judged also where the pressure is the user's own.
    """

    text: str
    needs: tuple[Quantity, ...]
    measure: Callable[[dict[str, Any], Any], float | None]
    limit: float | None = None
    tolerances: float | None = None
    mode: str = ""
    own_pressure: bool = False

    def allowed(self, tolerance: float) -> float | None:
        """Largest value of a PASS; None where the figure is only told."""
        return self.limit if self.tolerances is None else self.tolerances * tolerance


def largest_of(row: Quantity) -> Callable[[dict[str, Any], Any], float]:
    """The figure that is the largest of a quantity."""
    return lambda data, _: float(data[row.path].max())
