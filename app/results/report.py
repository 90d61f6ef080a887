"""The report of an archive: one HTML page that needs nothing else.

It begins with the results in a few lines with units; its table of states and its curves of stresses are
written as the scripts of the page read them.
"""

import json
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.page import render
from galinx.postprocess.quantities import (
    Quantity,
    layers,
    of_states,
    runs,
    states,
    stresses,
    table,
    validity,
    yielding,
)
from galinx.postprocess.quantities.quantity import CLOSED_FORM, FEM, METHODS, SIE, STATE, TEXT
from galinx.postprocess.tables import Sheet, parameters, solved_speeds, starts_sheet
from galinx.postprocess.units import Scaled, Scaling, Units, as_archived, engineering
from galinx.texts import counted, plain

from ..console import program
from ..figures.choice import Drawing
from ..figures.files import embedded, in_a_page
from ..scene.scene import Scene
from ..study.published import (
    INTENSITIES,
    has_study_digits,
    intensities,
    intensity_rows,
    limit_of_steady_motion,
)

#: By method.
_LOWEST = stresses.LOWEST | layers.LOWEST
_K_I_LEFT, _K_I_RIGHT = states.K_I_LEFT | layers.K_I_LEFT, states.K_I_RIGHT | layers.K_I_RIGHT


@dataclass(frozen=True)
class Answer:
    """A result in words.

    Attributes:
        name: what it is.
        value: with its unit.
        where: state and place.
    """

    name: str
    value: str
    where: str = ""


def answers(data: dict[str, Any], scene: Scene, units: Units) -> list[Answer]:
    """The results that an archive has, finite elements first where there are both methods."""
    return [
        *_of_states(data),
        *_of_contact(data, units),
        *_of_surface(data, scene, units),
        *_of_interfaces(data, scene, units),
        *_of_limits(data, units),
    ]


def _of_states(data: dict[str, Any]) -> Iterator[Answer]:
    f = data[states.FRICTION.path]
    yield Answer("Friction coefficient f, positive in forward motion", *_span(f, "", "{:+.4f}"))
    intensities = [data[row.path] for row in (*_either(data, _K_I_LEFT), *_either(data, _K_I_RIGHT))]
    if intensities and np.any(intensities):
        both = np.array(intensities)
        smallest, largest = both.min(axis=0), both.max(axis=0)
        low, high = int(smallest.argmin()), int(largest.argmax())
        yield Answer(
            "Stress intensity factor K_I at the edges, dimensionless",
            *_words(smallest[low], largest[high], low, high, "", "{:.4f}"),
        )
    if states.INDENTATION.path in data:
        name = "Indentation v_0 relative to the surface far away"
        yield Answer(name, *_span(data[states.INDENTATION.path], "m"))


def _of_contact(data: dict[str, Any], units: Units) -> Iterator[Answer]:
    """Half-widths, middles and largest pressures of contacts with free ends."""
    for row in _either(data, states.HALF_WIDTH):
        yield Answer("Half-width of the contact", *_span(data[row.path], "m"))
    for row in _either(data, states.CENTRE):
        yield Answer("Middle of the contact, from the punch's axis", *_span(data[row.path], "m"))
    for row in _either(data, states.LARGEST):
        if np.isfinite(data[row.path]).any():
            yield Answer("Largest contact pressure", *_scaled_span(data[row.path], units.stress))


def _of_surface(data: dict[str, Any], scene: Scene, units: Units) -> Iterator[Answer]:
    if stresses.SURFACE_X.path not in data:
        return
    stress, X = units.stress, data[stresses.SURFACE_X.path]
    for row in _either(data, stresses.PRESSURE | layers.PRESSURE):
        middle = int(np.abs(X).argmin())
        pressure = -data[row.path][:, middle]
        yield Answer(f"Contact pressure at X/a = {X[middle]:.2g}", *_scaled_span(pressure, stress))
    beyond = "" if scene.body.finite else ", further than 0.01 a from sharp edges and 0.02 a from tips"
    ends = (("tension", 1.0, stresses.HIGHEST | layers.HIGHEST), ("compression", -1.0, _LOWEST))
    for name, sign, rows in ends:
        for row in _either(data, rows):
            σ = sign * stress.of(data[row.path])
            if (largest := float(σ.max())) > 0.0:
                what = f"Largest in-plane {name} σ_XX on the surface{beyond}"
                yield Answer(what, _text(largest, stress.unit), f"state {int(σ.argmax())}")


def _of_interfaces(data: dict[str, Any], scene: Scene, units: Units) -> Iterator[Answer]:
    """Largest stresses that may part a layer from what it lies on: shear and tension."""
    method = next((name for name in (FEM, SIE) if layers.INTERFACES[name][0].path in data), None)
    if method is None:
        return
    stress, rows = units.stress, layers.INTERFACE_EXTREMES[method]
    # Of σ_YY, σ_XY and σ_XX above and below: the largest value, its place, the smallest and its place.
    normal, shear, above, below = (rows[first : first + 4] for first in range(0, 16, 4))
    parts = (
        ("shear |σ_XY| at", ((1.0, shear[0], shear[1]), (-1.0, shear[2], shear[3]))),
        ("tension σ_YY at", ((1.0, normal[0], normal[1]),)),
        ("in-plane tension σ_XX just above", ((1.0, above[0], above[1]),)),
        ("in-plane tension σ_XX just below", ((1.0, below[0], below[1]),)),
    )
    depths = np.cumsum([layer.thickness for layer in scene.layers])
    for i, depth in enumerate(depths.tolist()):
        where = f"the interface {engineering(depth, 'm')} deep"
        for name, ends in parts:
            σ = np.array([sign * stress.of(data[row.path][:, i]) for sign, row, _ in ends])
            end, state = np.unravel_index(int(σ.argmax()), σ.shape)
            if (largest := float(σ[end, state])) > 0.0:
                place = data[ends[end][2].path]
                at = units(ends[end][2], "X") or as_archived(ends[end][2], "X")
                X = float(at.of(place)[state, i])
                yield Answer(
                    f"Largest {name} {where}",
                    _text(largest, stress.unit),
                    f"state {state}, X = {at.text(X)}",
                )


#: Where the solid yields, and where answers do not hold, by method.
_LIMITS: tuple[tuple[str, dict[str, Quantity]], ...] = (
    ("Largest von Mises stress", yielding.VON_MISES),
    ("Largest shear stress in the plane", yielding.SHEAR),
    ("Load at first yield", yielding.FIRST_LOAD),
    ("Yield passed up to, from the edge X = −a", yielding.REACH_LEFT),
    ("Yield passed up to, from the edge X = a", yielding.REACH_RIGHT),
    ("Depth of the yielded zone", yielding.DEPTH),
    (
        "Tension under the punch",
        {method: rows[0] for method, rows in (validity.TENSION | layers.TENSION).items()},
    ),
    ("Wave crossings of the contact in a stroke", {CLOSED_FORM: validity.CROSSINGS}),
    ("Slip turned round up to, from X = −a", {CLOSED_FORM: validity.SLIP_REVERSED[0]}),
    ("Slip turned round up to, from X = a", {CLOSED_FORM: validity.SLIP_REVERSED[1]}),
    ("Strain beyond 5 % up to, from X = −a", {CLOSED_FORM: validity.STRAIN[0]}),
    ("Strain beyond 5 % up to, from X = a", {CLOSED_FORM: validity.STRAIN[1]}),
)


def _of_limits(data: dict[str, Any], units: Units) -> Iterator[Answer]:
    for name, rows in _LIMITS:
        for row in _either(data, rows):
            scaled = units(row, "")
            if scaled and np.nanmax(np.abs(data[row.path]), initial=0.0) > 0.0:
                yield Answer(name, *_scaled_span(data[row.path], scaled))


def _either(data: dict[str, Any], rows: dict[str, Quantity]) -> list[Quantity]:
    """Quantity by the first method that the archive has, as a list of one or none."""
    return [
        rows[method] for method in (FEM, CLOSED_FORM, SIE) if method in rows and rows[method].path in data
    ][:1]


def _scaled_span(values: NDArray, scaled: Scaled) -> tuple[str, str]:
    return _span(scaled.of(values), "", "{:.4g}" + f" {scaled.unit}" * (scaled.unit != "1"))


def _text(value: float, unit: str) -> str:
    return f"{value:.4g}" + f" {unit}" * (unit != "1")


def _span(values: NDArray, unit: str, form: str = "") -> tuple[str, str]:
    """Smallest and largest value of the states, and the numbers of these states."""
    if not np.isfinite(values).any():
        return "none", ""
    low, high = int(np.nanargmin(values)), int(np.nanargmax(values))
    return _words(float(values[low]), float(values[high]), low, high, unit, form)


def _words(least: float, most: float, low: int, high: int, unit: str, form: str) -> tuple[str, str]:
    texts = [form.format(value) if form else engineering(value, unit) for value in (least, most)]
    if texts[0] == texts[1]:
        return texts[0], ""
    return " to ".join(texts), f"states {low} and {high}"


def summary(data: dict[str, Any], scene: Scene) -> str:
    """Scene and finite elements of an archive, in two sentences with units."""
    count, c = len(data[states.FRICTION.path]), np.unique(data[states.SPEED.path])
    solid, c_s = scene.solid, scene.solid.c_s
    moving = " to ".join(f"{v:.4g}" for v in sorted({c[0], c[-1]}))
    speed = " to ".join(f"{v * c_s:.4g}" for v in sorted({c[0], c[-1]}))
    ends = sorted({min(scene.punch.loads), max(scene.punch.loads)})
    load = " to ".join(engineering(N, "N/m") for N in ends)
    text = (
        f"{count} friction state{'s' * (count > 1)} of a rigid {scene.punch.profile.words()}, load "
        f"{load}, that slides at {speed} m/s, c = {moving} of the shear "
        f"wave speed {c_s:.4g} m/s, on a half-plane with {solid.words()}."
    )
    record = [runs.RECORD[name].path for name in ("cells", "degree", "unknowns")]
    if all(path in data for path in record):
        cells, degree, unknowns = (int(data[path].max()) for path in record)
        mesh = "layered" if scene.layers else scene.solve.mesh
        text += (
            f" Finite elements: {mesh} mesh, {cells} cells of degree up to {degree}, "
            f"{unknowns} unknowns, tolerance {scene.solve.tolerance:g}."
        )
        if solved := solved_speeds(data):
            text += f" {solved.capitalize()}."
    return text


#: Most cells of the table, and numbers of the curves: a page stays below 5 MB.
_CELLS, _NUMBERS = 60_000, 250_000

#: Digits that are shown; errors have fewer.
_DIGITS, _OF_ERRORS = 6, 2


def states_table(data: dict[str, Any], scaling: Scaling = as_archived) -> dict[str, Any]:
    """Table of all states with every quantity of one value a state, parameters that differ first.

    Args:
        data: datasets by path.
        scaling: names and units of the columns.
    """
    apart = parameters(data)
    others = [
        row
        for path, row in table().items()
        if of_states(path)
        and path in data
        and row.over == (STATE,)
        and path not in apart
        and scaling(row, "")
    ]
    rows = [*apart.values(), *others]
    constant = [row for row in apart.values() if len(np.unique(data[row.path])) == 1]
    shown = [row for row in rows if row not in constant]
    count = len(data[rows[0].path])
    kept = min(count, _CELLS // (len(shown) + 1))
    columns = [{"head": "state", "name": "state", "csv": "state", "about": "number", "digits": None}]
    columns += [_column(row, scaling) for row in shown]
    cells = [
        list(range(kept)),
        *(_plain(_scaled(row, data[row.path][:kept], scaling), 12) for row in shown),
    ]
    same = ", ".join(f"{_head(row)} = {data[row.path][0]:g}" for row in constant if row.type != TEXT)
    note = f"{counted(count, 'state')}; click on a head to sort."
    note += f" The same in all: {same}." * bool(same)
    if kept < count:
        note += f" The first {kept} are here; the command csv writes all."
    heads = [{"head": column["head"], "about": column["about"]} for column in columns]
    return {"columns": heads, "note": note, "data": {"columns": columns, "rows": list(zip(*cells))}}


def curves(data: dict[str, Any], scaling: Scaling = as_archived) -> dict[str, Any] | None:
    """Stresses on the surface of states, by method and quantity; None where there are none.

    Args:
        data: datasets by path.
        scaling: units of the stresses.
    """
    quantities = {
        "σ_XX": stresses.IN_PLANE | layers.IN_PLANE, "σ_YY": stresses.PRESSURE | layers.PRESSURE
    }  # fmt: skip
    methods = [m for m in METHODS if all(rows[m].path in data for rows in quantities.values())]
    if not methods:
        return None
    X = data[stresses.SURFACE_X.path]
    order, apart = np.argsort(X, kind="stable"), parameters(data)
    count = len(data[next(iter(apart))])
    most = max(_NUMBERS // (len(X) * len(methods) * len(quantities)), 1)
    shown = np.unique(np.linspace(0, count - 1, min(count, most)).astype(int))
    scaled = scaling(quantities["σ_XX"][methods[0]], "")
    in_units = scaled is not None and scaled.unit != "N/(2a)"
    factors = scaled.factor * np.ones(count) if scaled else np.ones(count)
    values = [
        [
            [_plain(factors[i] * data[rows[method].path][i][order], 5) for i in shown.tolist()]
            for rows in quantities.values()
        ]
        for method in methods
    ]
    varied = [row for row in apart.values() if len(np.unique(data[row.path])) > 1]
    names = [
        ", ".join([str(i), *(_value(row, data[row.path][i]) for row in varied)]) for i in shown.tolist()
    ]
    note = f"In {scaled.unit}." if scaled and in_units else "Over N/(2a)."
    note += f" {len(shown)} of {count} states." * (len(shown) < count)
    return {
        "note": note,
        "data": {
            "unit": f"[{scaled.unit}]" if scaled and in_units else "/ (N/2a)",
            "X": _plain(X[order], 9), "states": names, "quantities": list(quantities),
            "methods": [METHODS[method] for method in methods], "values": values,
        },
    }  # fmt: skip


def _scaled(row: Quantity, values: NDArray, scaling: Scaling) -> NDArray:
    scaled = scaling(row, "")
    return values if scaled is None else scaled.of(values, slice(len(values)))


def _column(row: Quantity, scaling: Scaling) -> dict[str, Any]:
    name = row.path.partition("/")[2].replace("/", "_")
    scaled = scaling(row, name) or as_archived(row, name)
    head = _head(row)
    if scaled.name != name:
        head = scaled.name if row.symbol else head.replace(" over a", "")
    unit = "" if scaled.unit in ("1", "none") else f" [{scaled.unit}]"
    error = "error" in row.path or "estimate" in row.path
    digits = None if row.type == TEXT else _OF_ERRORS if error else _DIGITS
    return {
        "head": head + unit,
        "name": scaled.name,
        "csv": scaled.name + unit,
        "about": row.about,
        "digits": digits,
    }


def _head(row: Quantity) -> str:
    """A column's head: the symbol, or the name with its method."""
    if row.symbol:
        return f"${row.symbol}$"
    method, _, name = row.path.partition("/")[2].rpartition("/")
    called = {"v0": "v_0", "alpha": "α", "beta": "β"}.get(
        name, name.replace("_", " ").replace("K I", "K_I")
    )
    return called + {CLOSED_FORM: ", exact", SIE: ", SIE", FEM: ", FE"}.get(method, "")


def _value(row: Quantity, value: Any) -> str:
    return str(value) if row.type == TEXT else plain(f"${row.symbol}$ = {value:.4g}")


def _plain(values: NDArray, digits: int) -> list[Any]:
    """Numbers with so many digits, None for NaN; texts stay."""
    if values.dtype.kind in "OSU":
        return [str(value) for value in values.tolist()]
    return [None if value != value else float(f"{value:.{digits}g}") for value in values.tolist()]


#: Meanings of a report's terms; those that it does not use are left out.
TERMS = (
    ("a, N", "half-width of the punch, and load per unit of depth"),
    ("c", "speed over the shear wave speed of the solid, dimensionless"),
    ("closed form", "solution of the singular integral equation by formulas; needs no mesh"),
    ("f", "friction coefficient: friction force over load, positive in forward motion"),
    ("FM, BM", "forward and backward motion: strokes, numbered"),
    ("K_I", "stress intensity factor: strength of the pressure's singularity at an edge of the punch, "
     "dimensionless by N and a"),
    ("von Mises stress", "what a solid in this state of stress bears like a bar under tension; it yields "
     "where that is its yield strength"),
    ("X/L", "place on a stroke over the pre-sliding displacement L, along which friction builds up"),
    ("v_0", "indentation, relative to the surface 100 a away, or 100 times the length over which layers "
     "are seen: in the plane it grows with that distance like a logarithm"),
    ("estimate", "error of finite elements measured on other degrees, the closed form not used"),
    ("verdict", "PASS where every comparison above is within what is allowed; not judged where one "
     "method alone was asked for"),
    ("σ_XX, σ_YY, σ_XY", "in-plane, normal and shear stress: X along the motion, Y out of the solid; "
     "tension is positive"),
)  # fmt: skip


class Report:
    """A report in the making.

    Args:
        data, attributes: datasets by path, and attributes of the root, of an archive.
        scene: of the archive.
        sheets: tables before that of the states; the published ones where the archive has their states.
        dimensionless: stresses over N/(2a), lengths over a and speeds over c_s.
    """

    def __init__(
        self,
        data: dict[str, Any],
        attributes: dict[str, Any],
        scene: Scene,
        sheets: list[Sheet] | None = None,
        dimensionless: bool = False,
    ) -> None:
        self._data, self._attributes, self._scene = data, attributes, scene
        self._sheets = _published(data, scene) if sheets is None else sheets
        self._units = Units(scene.body, data, dimensionless)
        self._pictures: list[dict[str, Any]] = []

    def add(self, drawing: Drawing, png: bytes | None = None) -> None:
        """Add a figure; it can be saved elsewhere afterwards.

        Args:
            drawing: which.
            png: lines as a file's bytes, where there is one already; else they are drawn for the page, as
                maps always are, whose files are large.
        """
        picture = {"caption": drawing.full_caption, "pixels": drawing.pixels, "width": None}
        if png is None or drawing.pixels:
            picture["source"] = in_a_page(drawing.figure, drawing.pixels)
        else:  # as wide as it would be if it were drawn for the page
            picture |= {"source": embedded(png), "width": round(96.0 * drawing.figure.get_figwidth())}
        self._pictures.append(picture)

    def text(self) -> str:
        """The page as HTML."""
        attributes, data, scene = self._attributes, self._data, self._scene
        seconds, unit = data[runs.SECONDS.path], attributes["half_width"] / attributes["c_s"]
        longest = max(float(seconds.max()), 1e-9)
        content = {
            "title": attributes["title"] or "A sliding punch",
            "verdict": attributes["verdict"],
            "summary": summary(data, scene),
            "warnings": json.loads(attributes["warnings"]),
            "answers": answers(data, scene, self._units),
            "reasons": json.loads(attributes["verdict_reasons"]),
            "starts": [sheet for sheet in (starts_sheet(data, unit),) if sheet.rows],
            "sheets": self._sheets,
            "states": states_table(data, self._units),
            "curves": curves(data, self._units),
            "pictures": self._pictures,
            "times": [
                (name, f"{value:.3f}", f"{100.0 * value / longest:.1f}")
                for name, value in zip(data[runs.STEPS.path].tolist(), seconds.tolist())
            ],
            "done": list(Counter(data[runs.DONE.path].tolist()).items()),
            "skipped": data[runs.SKIPPED.path].tolist(),
            "versions": _versions(attributes),
            "scene": data[runs.SCENE.path],
            "program": program(),
        }
        words = str(content | {"pictures": [picture["caption"] for picture in self._pictures]})
        terms = [
            (term, meaning) for term, meaning in TERMS if any(word in words for word in term.split(", "))
        ]
        return render(content | {"terms": terms})


def _published(data: dict[str, Any], scene: Scene) -> list[Sheet]:
    """The study's tables that the archive has all states of, for the study's solid."""
    if not has_study_digits(scene.solid):
        return []
    a, rows_by_name = scene.body.half_width, {name: intensity_rows(name, data) for name in INTENSITIES}
    return [
        intensities(name, rows, limit_of_steady_motion(name, data, a))
        for name, rows in rows_by_name.items()
        if rows
    ]


def _versions(attributes: dict[str, Any]) -> str:
    versions = {"galinx": attributes["version"], **json.loads(attributes["versions"])}
    text = ", ".join(f"{name} {version}" for name, version in versions.items())
    return f"{text}; {attributes['machine']}; {attributes.get('created', 'not archived')}"
