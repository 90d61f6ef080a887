"""What an archive says of a contact, in a few lines with units: the results that a report begins with."""

from collections.abc import Iterator
from dataclasses import dataclass
from math import floor, log10
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.results.si import in_si, stress_of_states
from galinx.app.scene.scene import Scene
from galinx.postprocess.quantities import runs, states, stresses, validity, yielding
from galinx.postprocess.quantities import strata as layers
from galinx.postprocess.quantities.quantity import CLOSED_FORM, FEM, SIE, Quantity
from galinx.postprocess.scale import NEAR
from galinx.postprocess.tables import solved_speeds
from galinx.solvers.contact import from_edge

#: Of units, and where the one stands that means nothing.
_PREFIXES, _MIDDLE = "pnµm kMGT", 4


#: By method.
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


def answers(data: dict[str, Any], scene: Scene) -> list[Answer]:
    """The results that an archive has, finite elements first where there are both methods."""
    return [
        *_of_states(data),
        *_of_contact(data, scene),
        *_of_surface(data, scene),
        *_of_interfaces(data, scene),
        *_of_limits(data, scene),
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


def _of_contact(data: dict[str, Any], scene: Scene) -> Iterator[Answer]:
    """Of contacts whose ends are found."""
    for row in _either(data, states.HALF_WIDTH):
        yield Answer("Half-width of the contact", *_span(data[row.path], "m"))
    for row in _either(data, states.CENTRE):
        yield Answer("Middle of the contact, from the punch's axis", *_span(data[row.path], "m"))
    for row in _either(data, states.LARGEST):
        pressure = stress_of_states(data, scene)[:, 0] * data[row.path]
        if np.isfinite(pressure).any():
            yield Answer("Largest contact pressure", *_span(pressure, "Pa"))


def _of_surface(data: dict[str, Any], scene: Scene) -> Iterator[Answer]:
    if stresses.SURFACE_X.path not in data:
        return
    stress, X = stress_of_states(data, scene), data[stresses.SURFACE_X.path]
    for row in _either(data, stresses.PRESSURE | layers.PRESSURE):
        middle = int(np.abs(X).argmin())
        pressure = -stress[:, 0] * data[row.path][:, middle]
        yield Answer(f"Contact pressure at X/a = {X[middle]:.2g}", *_span(pressure, "Pa"))
    away = from_edge(X) >= NEAR
    for row in _either(data, stresses.IN_PLANE | layers.IN_PLANE):
        σ, places = stress * data[row.path][:, away], X[away]
        beyond = f"further than {NEAR:g} a from the edges"
        for name, at in (("tension", σ.argmax()), ("compression", σ.argmin())):
            state, point = np.unravel_index(int(at), σ.shape)
            if (σ[state, point] > 0.0) == (name == "tension"):
                yield Answer(
                    f"Largest in-plane {name} σ_XX on the surface, {beyond}",
                    _engineering(abs(float(σ[state, point])), "Pa"),
                    f"state {state}, X/a = {places[point]:.4g}",
                )


def _of_interfaces(data: dict[str, Any], scene: Scene) -> Iterator[Answer]:
    """What may part a layer from what it lies on: shear, and tension across and along."""
    method = next((name for name in (FEM, SIE) if layers.INTERFACES[name][0].path in data), None)
    if method is None:
        return
    stress, X = stress_of_states(data, scene), data[layers.ALONG_X.path]
    YY, XY, above, below = (stress[..., None] * data[row.path] for row in layers.INTERFACES[method])
    depths = np.cumsum([layer.thickness for layer in scene.layers])
    for i, depth in enumerate(depths.tolist()):
        parts = {
            "shear |σ_XY| at": np.abs(XY), "tension σ_YY at": YY,
            "in-plane tension σ_XX just above": above, "in-plane tension σ_XX just below": below,
        }  # fmt: skip
        where = f"the interface {_engineering(depth, 'm')} deep"
        for name, σ in parts.items():
            state, point = np.unravel_index(int(σ[:, i].argmax()), σ[:, i].shape)
            if (largest := float(σ[state, i, point])) > 0.0:
                yield Answer(
                    f"Largest {name} {where}",
                    _engineering(largest, "Pa"),
                    f"state {state}, X/a = {X[point]:.4g}",
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


def _of_limits(data: dict[str, Any], scene: Scene) -> Iterator[Answer]:
    for name, rows in _LIMITS:
        for row in _either(data, rows):
            told = in_si(row, "", scene, data)
            if told and np.nanmax(np.abs(data[row.path]), initial=0.0) > 0.0:
                form = "{:.4g}" if told.unit == "1" else ""
                yield Answer(name, *_span(told.of(data[row.path]), told.unit, form))


def _either(data: dict[str, Any], rows: dict[str, Quantity]) -> list[Quantity]:
    """One of several methods."""
    return [
        rows[method] for method in (FEM, CLOSED_FORM, SIE) if method in rows and rows[method].path in data
    ][:1]


def _span(values: NDArray, unit: str, form: str = "") -> tuple[str, str]:
    """Smallest and largest of the states, and which these are."""
    if not np.isfinite(values).any():
        return "none", ""
    low, high = int(np.nanargmin(values)), int(np.nanargmax(values))
    return _words(float(values[low]), float(values[high]), low, high, unit, form)


def _words(least: float, most: float, low: int, high: int, unit: str, form: str) -> tuple[str, str]:
    told = [form.format(value) if form else _engineering(value, unit) for value in (least, most)]
    if told[0] == told[1]:
        return told[0], ""
    return " to ".join(told), f"states {low} and {high}"


def _engineering(value: float, unit: str) -> str:
    """With four digits and a prefix: 113.8 GPa."""
    if value == 0.0:
        return f"0 {unit}"
    size = floor(log10(abs(float(f"{value:.3e}"))))
    thousands = min(max(size // 3, -_MIDDLE), len(_PREFIXES) - 1 - _MIDDLE)
    told = f"{value / 1000.0**thousands:.{max(3 + 3 * thousands - size, 0)}f}"
    return f"{told} {_PREFIXES[thousands + _MIDDLE].strip()}{unit}".replace("-", "−")


def summary(data: dict[str, Any], scene: Scene) -> str:
    """What was computed, in two sentences with units."""
    count, c = len(data[states.FRICTION.path]), np.unique(data[states.SPEED.path])
    solid, c_s = scene.solid, scene.solid.c_s
    moving = " to ".join(f"{v:.4g}" for v in sorted({c[0], c[-1]}))
    speed = " to ".join(f"{v * c_s:.4g}" for v in sorted({c[0], c[-1]}))
    ends = sorted({min(scene.punch.loads), max(scene.punch.loads)})
    load = " to ".join(_engineering(N, "N/m") for N in ends)
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
        if told := solved_speeds(data):
            text += f" {told.capitalize()}."
    return text
