"""Units of a result: every quantity in SI with prefixes chosen once, or dimensionless as archived.

Archives keep stresses over N/(2a), lengths over a and speeds over c_s, each state over its own contact.
This is the only place where they become MPa, µm and m/s: tables, figures, pages and CSV ask
:class:`Units`. In a result all stresses have one unit, all lengths of the contact have one, and so on.
"""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.contact.solution import Contact
from galinx.texts import significant as number
from galinx.texts import with_prefix

from .quantities import Quantity, of_any_method, of_states, over_time, preferred, states, swept, table
from .quantities.quantity import CONTACT, EDGE, OVER_A, OVER_C_S, OVER_N, X_OVER_A


class Scaled(NamedTuple):
    """Name, unit and scale with which a quantity is written.

    Numbers are multiplied by the factor, then the offset is added. Both are numbers, or arrays (states,)
    where contacts of states differ.
    """

    name: str
    unit: str
    factor: Any = 1.0
    offset: Any = 0.0

    @property
    def head(self) -> str:
        """Head of a column: name and unit, which is 1 for dimensionless."""
        return self.name if self.unit == "none" else f"{self.name} [{self.unit}]"

    def of(self, values: NDArray, states: Any = slice(None)) -> NDArray:
        """Values in this scale, (states, …).

        Args:
            values: values as archived, (states, …); (…) for all states where the scale is a number.
            states: numbers of the states that have values; all by default.
        """
        if np.ndim(self.factor) or np.ndim(self.offset):
            shape = np.broadcast_shapes(np.shape(self.factor), np.shape(self.offset))
            factor, offset = (
                np.broadcast_to(scale, shape)[states].reshape(-1, *(1,) * (np.ndim(values) - 1))
                for scale in (self.factor, self.offset)
            )
            return values * factor + offset
        if self.unit == "none" or (self.factor == 1.0 and not self.offset):
            return values
        return self.factor * values + self.offset

    def text(self, value: float, digits: int = 4) -> str:
        """A value in this scale with its unit: ``1206 MPa``."""
        return f"{number(value, digits)}{'' if self.unit in ('1', 'none') else f' {self.unit}'}"


#: Units with prefixes by that of SI, with their size, and the least number that one is used from.
_PREFIXED: dict[str, tuple[tuple[str, float, float], ...]] = {
    "Pa": (("Pa", 1.0, 0.0), ("kPa", 1e3, 0.5), ("MPa", 1e6, 0.1), ("GPa", 1e9, 20.0)),
    "m": (("nm", 1e-9, 0.0), ("µm", 1e-6, 0.1), ("mm", 1e-3, 0.5), ("m", 1.0, 1.0)),
    "N/m": (("N/m", 1.0, 0.0), ("N/mm", 1e3, 0.1), ("kN/mm", 1e6, 10.0)),
    "m/s": (("nm/s", 1e-9, 0.0), ("µm/s", 1e-6, 0.5), ("mm/s", 1e-3, 0.5), ("m/s", 1.0, 0.5)),
    "s": (("ns", 1e-9, 0.0), ("µs", 1e-6, 0.1), ("ms", 1e-3, 0.1), ("s", 1.0, 0.1)),
    "J/m": (
        ("nJ/m", 1e-9, 0.0), ("µJ/m", 1e-6, 0.5), ("mJ/m", 1e-3, 0.5), ("J/m", 1.0, 0.5),
        ("kJ/m", 1e3, 1.0),
    ),
    "N/m^2": (("N/m²", 1.0, 0.0), ("kN/m²", 1e3, 0.5), ("N/mm²", 1e6, 0.1), ("kN/mm²", 1e9, 1.0)),
}  # fmt: skip


def prefixed(unit: str, size: float) -> tuple[str, float]:
    """Unit with a prefix that suits numbers of a size in an SI unit, and how much of SI it is.

    Units without prefixes of engineers stay.
    """
    best = unit, 1.0
    for name, factor, least in _PREFIXED.get(unit, ()):
        if size >= least * factor:
            best = name, factor
    return best


def solved(values: Any) -> NDArray[np.float64]:
    """Numbers without NaN, which stands for a state without a solution; 1 if all are."""
    values = np.ravel(values)
    return values[~np.isnan(values)] if not np.all(np.isnan(values)) else np.ones(1)


class Units:
    """Units of a result, the same for every quantity of a kind.

    Args:
        contact: punch and half-plane of the scene, under its first load.
        data: datasets by path; those of one value a state, with the contacts of states where they differ.
        dimensionless: quantities as archived, over N/(2a), a and c_s.
        beside: units of other results, which these share: prefixes suit the largest of all.

    Attributes:
        contact, data, dimensionless, beside: as given.
        half_width, middle: of contacts [m], numbers, or (states,) where contacts of states differ.
        load: per depth [N/m], a number, or (states,) where states differ in it.
        c_s: shear wave speed [m/s], a number, or (states,) where solids of states differ.
    """

    def __init__(
        self, contact: Contact, data: Mapping[str, Any], dimensionless: bool = False,
        beside: "Sequence[Units]" = (),
    ) -> None:  # fmt: skip
        self.dimensionless, self.beside = dimensionless, beside
        self.contact, self.data = contact, data
        self.half_width: Any = data.get(swept.HALF_WIDTH.path, contact.half_width)
        self.middle: Any = 0.0
        width, middle = preferred(data, states.HALF_WIDTH), preferred(data, states.CENTRE)
        if width and middle:
            self.half_width = of_any_method(data, states.HALF_WIDTH, width)
            self.middle = of_any_method(data, states.CENTRE, middle)
        self.c_s: Any = data.get(swept.WAVE_SPEED.path, contact.solid.c_s)
        self.load: Any = data.get(states.LOAD.path, contact.load)

    def __call__(self, row: Quantity, name: str | None = None) -> Scaled | None:
        """Name, unit and scale of a quantity; None for one that equals another one in these units.

        Args:
            row: in the table of quantities.
            name: its name as archived; that in its path by default.
        """
        name = row.path.partition("/")[2].replace("/", "_") if name is None else name
        if row is states.VELOCITY:  # c in m/s
            return None
        if row.unit == "none":
            return Scaled(name, row.unit)
        if self.dimensionless:
            return self.scale(row.scale if row.scale == CONTACT else row.unit)._replace(name=name)
        if row.scale == EDGE:
            return self._intensity(row, name)
        scaled = self.scale(row.scale or row.unit, row)
        if row.scale == OVER_C_S:
            name = "speed" if name == "c" else name
        return scaled._replace(name=name.removesuffix("_over_a"))

    def scale(self, kind: str, row: Quantity | None = None) -> Scaled:
        """Unit and scale of a kind of quantities, without a name.

        Args:
            kind: a unit of the table of quantities, as ``"N/(2a)"``, or a scale, as
                :data:`galinx.postprocess.quantities.quantity.X_OVER_A`.
            row: quantity whose unit this is; None for one of states.
        """
        if self.dimensionless:
            # One for all states, whose own are among the lengths, and for what is compared.
            a, N = self._first.half_width, self._first.load
            over = {CONTACT: ("a", 1.0 / a), "J/m": ("N*a", 1.0 / (N * a))}
            archived = dict.fromkeys((OVER_A, X_OVER_A, OVER_C_S, OVER_N), ("1", 1.0))
            return Scaled("", *(over | archived).get(kind, (kind, 1.0)))
        unit, factor, offset, size = self._in_si(kind, row)
        sizes = [size, *(other._in_si(kind, row)[3] for other in self.beside)]
        name, of_si = prefixed(unit, float(max(sizes)) or 1.0)
        return Scaled("", name, factor / of_si, offset / of_si)

    def _in_si(self, kind: str, row: Quantity | None) -> tuple[str, Any, Any, Any]:
        """SI unit of a kind of quantities, factor and offset to it, and a size for its prefix."""
        contact, of_states_ = self.contact, row is None or of_states(row.path)
        a, N = (self.half_width, self.load) if of_states_ else (contact.half_width, contact.load)
        offset: Any = 0.0
        if kind == "N/(2a)":
            unit, factor, size = "Pa", N / (2.0 * a), np.median(solved(self.load / self.half_width)) / 2.0
        elif kind in (OVER_A, X_OVER_A, CONTACT):
            unit, factor = "m", (1.0 if kind == CONTACT else a)
            size = max(np.max(np.abs(solved(length))) for length in (self.half_width, self.middle))
            offset = self.middle if kind == X_OVER_A and of_states_ else 0.0
        elif kind == OVER_C_S:
            unit, factor = "m/s", (self.c_s if of_states_ else contact.solid.c_s)
            size = np.max(self.c_s * self.data.get(states.SPEED.path, 1.0))
        elif kind in ("N/m", OVER_N):
            unit, factor, size = "N/m", (N if kind == OVER_N else 1.0), np.median(self.load)
        elif kind == "a/c_s":
            unit, factor = "s", contact.half_width / contact.solid.c_s
            size = factor * np.max(self.data.get(over_time.TIMES.path, 1.0))
        elif kind == "N/(2mu)":
            unit, factor = "m", contact.displacement
            size = factor * (self._largest(kind, row) or 1.0)
        elif kind in ("N^2/(4mu)", "N*a"):
            unit, size = "J/m", contact.load * contact.displacement / 2.0
            factor = size if kind != "N*a" else contact.load * contact.half_width
        else:
            unit, factor, size = kind, 1.0, self._largest(kind, row)
        return unit, factor, offset, size

    @property
    def _first(self) -> Contact:
        return self.beside[0].contact if self.beside else self.contact

    @property
    def of_a(self) -> str:
        """Half-width over which lengths are that are not over that of their own contact, in words."""
        a = number(self._first.half_width)
        return f"a = {a} m, that of the first contact at rest without friction"

    @property
    def stress(self) -> Scaled:
        """Scale of stresses of states: MPa for N/(2a)."""
        return self.scale("N/(2a)")

    @property
    def position(self) -> Scaled:
        """Scale of positions along X over a, from the contact's middle: µm from the punch's axis."""
        return self.scale(X_OVER_A)

    def _largest(self, kind: str, row: Quantity | None) -> float:
        """Largest number of the quantities of a unit in the section of a row; 0 for none."""
        if row is None:
            return 1.0
        section = row.path.partition("/")[0]
        if section == "run":  # seconds of work
            return 1.0
        values = [
            self.data[path]
            for path, other in table().items()
            if other.unit == kind and not other.scale and path.startswith(f"{section}/")
            and not other.symbol and path in self.data
        ]  # fmt: skip
        if row.symbol:
            values = [self.data[row.path]] if row.path in self.data else []
        finite = [np.abs(v[np.isfinite(v)]).max(initial=0.0) for v in map(np.asarray, values)]
        return float(max(finite, default=0.0))

    def _intensity(self, row: Quantity, name: str) -> Scaled | None:
        """K_I: the limit of the pressure times (2π distance)^(-exponent), whose unit has that power.

        The dimensionless one is the limit of the pressure over N/a and the weight (1 - r)^α (1 + r)^β of
        a flat punch.
        """
        if row is states.K_I_BOTH:  # the ends differ, each by its own exponent
            return None
        side = states.BETA if row.path.endswith("left") else states.ALPHA
        if side.path not in self.data:
            return Scaled(name, "1")
        exponent, a = self.data[side.path], self.half_width
        stress = self.scale("N/(2a)")
        symbol = {states.ALPHA.path: "α", states.BETA.path: "β"}[side.path]
        root = np.allclose(exponent, -0.5, rtol=0.0, atol=1e-9)
        unit = f"{stress.unit}√m" if root else f"{stress.unit}·m^(-{symbol})"
        return Scaled(name, unit, stress.factor * (4.0 * np.pi * a) ** -exponent)


def engineering(value: float, unit: str, digits: int = 4) -> str:
    """Number with four digits and a prefix of its own: 113.8 GPa; N/mm for loads, 7850 kg/m^3."""
    if unit in ("m", "s", "Pa", "m/s"):
        return with_prefix(value, unit, digits)
    name, of_si = prefixed(unit, abs(value))
    return f"{number(value / of_si, digits)} {name}"
