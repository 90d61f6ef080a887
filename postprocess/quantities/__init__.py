"""The one table of archived quantities: archives, checks, comparisons, plans and pages follow from it."""

from collections.abc import Collection, Iterator
from difflib import get_close_matches

# Each adds its own; tables have them in this order.
# isort: off
from . import runs, states  # noqa: F401
from . import stresses, validity, yielding  # noqa: F401
from . import over_time, layers  # noqa: F401

# isort: on
from galinx.solvers.friction import LAWS
from galinx.solvers.parameters import parameters

from .quantity import (
    ALONG,
    FRICTION_ALONE,
    INSIDE,
    INTENSITIES,
    POINT,
    QUANTITIES,
    STATE,
    Quantity,
)

__all__ = ["QUANTITIES", "WORDS", "Quantity", "column", "declared", "table"]


def column(name: str) -> str:
    """Path of a column of the states: a parameter of the law, or what else tells states apart."""
    return f"states/{name}"


def table() -> dict[str, Quantity]:
    """Every quantity by its path, the parameters of all known friction laws among them."""
    of_laws = {
        column(key): Quantity(
            column(key), "none" if known.options else known.unit or "1", known.about, (STATE,),
            symbol=known.symbol or key, range=known.range,
        )
        for law in LAWS.values()
        for key, known in parameters(law).items()
        if known.single
    }  # fmt: skip
    return of_laws | QUANTITIES


def declared(path: str) -> Quantity:
    """The quantity of a path.

    Raises:
        KeyError: there is none; the message names the nearest.
    """
    known = table()
    if path not in known:
        close = get_close_matches(path, known, 1)
        hint = f"; did you mean {close[0]}?" if close else ""
        raise KeyError(f"{path} is in no row of the table of quantities{hint}")
    return known[path]


def of_states(path: str) -> bool:
    """Does a dataset hold values of states, or the positions of some?"""
    return path.split("/")[0] in ("states", "surface", "interior", "interfaces")


def large(path: str) -> bool:
    """Does it hold a value at every point of every state?"""
    row = table().get(path)
    return row is not None and STATE in row.over and bool({POINT, INSIDE, ALONG} & set(row.over))


class _Words(Collection[str]):
    """Words of a scene's output.quantities, those of users' quantities among them."""

    def __iter__(self) -> Iterator[str]:
        asked = (quantity.asked_by for quantity in QUANTITIES.values() if quantity.asked_by)
        return iter(dict.fromkeys([FRICTION_ALONE, INTENSITIES, *asked]))

    def __len__(self) -> int:
        return len(list(iter(self)))

    def __contains__(self, word: object) -> bool:
        return word in list(iter(self))


WORDS = _Words()
