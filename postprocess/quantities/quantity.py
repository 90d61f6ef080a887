"""Quantity of an archive: what it is, how it is read off a solution and judged; and the table of all."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from numpy.typing import NDArray

from galinx.registry import Registry
from galinx.solvers.contact import CLOSED_FORM, FEM, INTENSITIES, SIE
from galinx.solvers.parameters import Range
from galinx.texts import unseen

#: Dimensions of datasets, in words.
STATE, POINT, INSIDE, SPEED, LOOP, STEP = (
    "states", "points", "points inside", "speeds", "loops", "positions",
)  # fmt: skip
#: Of layered solids.
INTERFACE, ALONG = "interfaces", "points along interfaces"
#: The layers, from the top down, and the solid below.
LAYER = "layers and solid below"
#: Inner variables of a friction law, and strokes.
INNER, STROKE = "inner variables", "strokes"

#: Types of datasets.
TEXT, WHOLE, NUMBER = "text", "int64", "float64"

#: Source of quantities by the local analysis of the punch's edges, which needs no solution.
LOCAL = "local"
#: Methods that solve, in words.
METHODS = {CLOSED_FORM: "closed form", SIE: "integral equation", FEM: "finite elements"}

#: Places where NaN is an answer.
NEVER, BESIDE, ANYWHERE = "never", "beside the punch", "anywhere"

#: Mode of one method alone, the numbers of which are compared with no other's.
ALONE = "one method"

#: Mode of so many speeds that some of them may give the others by a fit.
SWEPT = "fitted speeds"

#: Word of a scene's output.quantities that asks for no dataset of its own, beside ``INTENSITIES``.
FRICTION_ALONE = "friction"


NOT_NEGATIVE = Range(at_least=0.0)

#: What a dimensionless quantity is over: the half-width; the half-width, along X from the contact's
#: middle; the wave speed; the load; load and half-width to the power of an edge's exponent.
#: ``CONTACT`` is a length of the contact in m.
OVER_A, X_OVER_A, OVER_C_S, OVER_N, EDGE = "a", "X", "c_s", "N", "edge"
CONTACT = "contact"


@dataclass(frozen=True)
class Quantity:
    """Archived quantity: what it is, when it is computed, how it is read off a solution and judged.

    Attributes:
        path: of its dataset in an archive.
        unit: "1" for dimensionless, "none" for texts.
        about: what it is; the dataset's long name, up to its first comma that of axes.
        over: its dimensions.
        of: reads it off a solution of a body (see :mod:`galinx.solvers.contact.solution`), one value
            a state; None where the run itself gives it.
        method: of the solution: ``"closed_form"``, ``"fem"``, ``"local"``, or one of the user's own.
        mode: ``"contact"``, ``"traction"``, ``OWN_PRESSURE``, ``PUNCH``, ``FOUND``, ``FINITE``,
            ``ALONE`` or ``SWEPT`` where only that one gives it.
        asked_by: word of output.quantities; "" where every solution gives it.
        of_data: computes it from other datasets of some states, which ``needs`` names, instead of ``of``.
        needs: paths.
        nan_allowed: ``NEVER``, ``BESIDE`` the punch, or ``ANYWHERE``.
        symbol: of a parameter that tells states apart, in LaTeX; "" for anything else.
        whole: its numbers are integers. None that a solution gives: NaN says that there is none.
        range: where its numbers may lie.
        accuracy: it says how good other numbers are, and nothing of the contact.
        scale: what it is over where its unit does not say so: ``OVER_A``, ``X_OVER_A``, ``OVER_C_S``,
            ``OVER_N``, ``EDGE``, or ``CONTACT`` in m; see :mod:`galinx.postprocess.units`.
        requires: what a contact may lack, see :attr:`galinx.solvers.contact.solution.Contact.lacks`.
    """

    path: str
    unit: str
    about: str
    over: tuple[str, ...] = ()
    of: Callable[[Any, Any], NDArray] | None = None
    method: str = ""
    mode: str = ""
    asked_by: str = ""
    of_data: Callable[[dict[str, Any]], NDArray] | None = None
    needs: tuple[str, ...] = ()
    nan_allowed: str = NEVER
    symbol: str = ""
    whole: bool = False
    range: Range = Range()
    accuracy: bool = False
    scale: str = ""
    requires: tuple[str, ...] = ()

    @property
    def type(self) -> str:
        """Type of its dataset: ``TEXT``, ``WHOLE`` or ``NUMBER``."""
        return TEXT if self.unit == "none" else WHOLE if self.whole else NUMBER

    @property
    def solved(self) -> bool:
        """True where it comes from a solution, part by part."""
        return self.of is not None or self.of_data is not None


def entry(of: Callable[[Any], NDArray], *index: Any) -> Callable[[Any, Any], NDArray]:
    """Function that reads an entry of a solution's array, as ``of`` of a quantity."""
    return lambda solution, _: of(solution)[index]


def by_method(
    name: str, unit: str, about: str, of: Callable[[Any, Any], NDArray] | None,
    own: Mapping[str, Mapping[str, Any]] | Sequence[str], section: str = "states", **options: Any,
) -> dict[str, Quantity]:  # fmt: skip
    """Quantity that several methods give, by method; one value a state unless ``over`` is given.

    Args:
        name, section: of its path, ``section/METHOD/name``.
        unit, about, of: as of a quantity.
        own: the methods, or what each has of its own, other attributes by name, by method.
        options: further attributes, the same for all methods.
    """
    common: dict[str, Any] = {"unit": unit, "about": about, "over": (STATE,), "of": of} | options
    attributes = own if isinstance(own, Mapping) else {method: {} for method in own}
    return {
        method: Quantity(**common | {"path": f"{section}/{method}/{name}", "method": method, **each})
        for method, each in attributes.items()
    }


#: Words of a scene's output.quantities, those of users' quantities among them; values mean nothing.
WORDS = dict.fromkeys((FRICTION_ALONE, INTENSITIES))


class Table(Registry[Quantity]):
    """Quantities by their path."""

    def add(self, quantity: Quantity) -> Quantity:
        """Add a quantity, and return it.

        Raises:
            TypeError: it is no quantity, or its dimensions are a text.
            ValueError: its path is taken, or a text of it has a control character.
        """
        self.check(getattr(quantity, "path", ""), quantity)
        if isinstance(quantity.over, str):
            over = f"over = {quantity.over!r}, expected a tuple"
            raise TypeError(f"the {self.noun} {quantity.path}: {over}")
        for text in (quantity.unit, quantity.about):
            if fault := unseen(text):
                raise ValueError(f"the {self.noun} {quantity.path}, {text!r}: {fault}")
        self.register(quantity.path, quantity)
        if quantity.asked_by:
            WORDS[quantity.asked_by] = None
        return quantity

    def add_all(self, names: Mapping[str, Any]) -> None:
        """Add all quantities among a module's names, single ones and those by method."""
        for value in list(names.values()):
            for entry in value.values() if isinstance(value, dict) else (value,):
                for row in entry if isinstance(entry, tuple) else (entry,):
                    if isinstance(row, Quantity):
                        self.add(row)


#: All quantities but the parameters of friction laws; every module adds its own.
QUANTITIES = Table("quantity", kind=Quantity)
