"""How far finite elements and the integral equation agree over layers, and what each says of itself."""

from typing import Any

import numpy as np

from galinx.postprocess import scale
from galinx.postprocess.quantities import states as of
from galinx.postprocess.quantities import strata as on_layers
from galinx.postprocess.quantities import stresses as at
from galinx.postprocess.quantities.quantity import FEM, SIE, Quantity
from galinx.postprocess.rule import Rule, largest_of
from galinx.postprocess.rules_of_ends import extremes_of
from galinx.solvers.contact import under_punch

#: Share of the larger intensity, or of the mean pressure, below which the other is not measured against
#: itself.
_VANISHING = 0.1


def _intensities_of_layers(data: dict[str, Any], _: float) -> float | None:
    """Ends that are found have none."""
    sides = of.K_I_LEFT | on_layers.K_I_LEFT, of.K_I_RIGHT | on_layers.K_I_RIGHT
    fem, sie = (np.array([data[side[method].path] for side in sides]) for method in (FEM, SIE))
    if not sie.any():
        return None
    size = np.maximum(np.abs(sie), _VANISHING * np.abs(sie).max(axis=0))
    return float((np.abs(fem - sie) / size).max())


def _pressures(data: dict[str, Any]) -> tuple[Any, Any]:
    under = under_punch(data[at.SURFACE_X.path])
    return data[at.PRESSURE[FEM].path][:, under], data[on_layers.PRESSURE[SIE].path][:, under]


def _found_pressure_of_layers(data: dict[str, Any], _: float) -> float:
    """Over each state's largest: next to free ends it vanishes."""
    fem, sie = _pressures(data)
    return float((np.abs(fem - sie) / np.abs(sie).max(axis=1, keepdims=True)).max())


def _pressure_of_layers(data: dict[str, Any], _: float) -> float | None:
    if of.HALF_WIDTH[SIE].path in data:
        return None
    fem, sie = _pressures(data)
    return float((np.abs(fem - sie) / np.maximum(np.abs(sie), _VANISHING)).max())


def _in_plane_of_layers(data: dict[str, Any], _: float) -> float:
    fem, sie = (data[row.path] for row in (at.IN_PLANE[FEM], on_layers.IN_PLANE[SIE]))
    return (np.abs(fem - sie) / scale.of_in_plane(sie, data[at.SURFACE_X.path])).max()


def _at_interfaces(data: dict[str, Any], _: float) -> float:
    fem, sie = (np.array([data[row.path] for row in on_layers.INTERFACES[by]]) for by in (FEM, SIE))
    return float((np.abs(fem - sie) / scale.of_interfaces(sie)).max())


def _inside(data: dict[str, Any], _: float) -> float:
    rows = at.STRESSES_INSIDE[FEM], on_layers.STRESSES_INSIDE[SIE]
    fem, sie = ([data[row.path] for row in some] for some in rows)
    places = (data[row.path] for row in (at.INSIDE_X, at.INSIDE_Y))
    off = scale.largest(one - other for one, other in zip(fem, sie))
    return float((off / scale.of_inside(sie, *places)).max())


def _estimate(row: Quantity, what: str) -> Rule:
    text = f"estimated error of {what}, relative"
    return Rule(text, (row,), largest_of(row), tolerances=1.0, own_pressure=True)


#: Rules by the name that quantities give.
ON_LAYERS: dict[str, Rule] = {
    "K_I of layers": Rule(
        "K_I at both ends against the integral equation, relative",
        (*(side[FEM] for side in (of.K_I_LEFT, of.K_I_RIGHT)),
         *(side[SIE] for side in (on_layers.K_I_LEFT, on_layers.K_I_RIGHT))),
        _intensities_of_layers, tolerances=1.0,
    ),
    "sigma_YY of layers": Rule(
        "σ_YY against the integral equation, over itself or a tenth of the mean",
        (at.PRESSURE[FEM], on_layers.PRESSURE[SIE], at.SURFACE_X), _pressure_of_layers,
        tolerances=1.0,
    ),
    # As under punches on uniform solids whose ends are found.
    "sigma_YY of found ends over layers": Rule(
        "σ_YY of contacts whose ends are found against the integral equation, over the largest",
        (at.PRESSURE[FEM], on_layers.PRESSURE[SIE], at.SURFACE_X, of.LARGEST[SIE]),
        _found_pressure_of_layers, tolerances=10.0,
    ),
    "sigma_XX of layers": Rule(
        "σ_XX against the integral equation, over itself or the largest",
        (at.IN_PLANE[FEM], on_layers.IN_PLANE[SIE], at.SURFACE_X), _in_plane_of_layers,
        tolerances=1.0, own_pressure=True,
    ),
    "extremes of sigma_XX over layers": Rule(
        "highest and lowest σ_XX against the integral equation, over the larger of them",
        (at.HIGHEST[FEM], at.LOWEST[FEM], on_layers.HIGHEST[SIE], on_layers.LOWEST[SIE]),
        extremes_of(SIE), tolerances=1.0, own_pressure=True,
    ),
    "estimate of the integral equation": Rule(
        "estimated error of the integral equation over layers, relative",
        (on_layers.ESTIMATE,), largest_of(on_layers.ESTIMATE), tolerances=1.0,
    ),
    "stresses at interfaces": Rule(
        "stresses at interfaces against the integral equation, over the largest along each",
        (*on_layers.INTERFACES[FEM], *on_layers.INTERFACES[SIE]), _at_interfaces, tolerances=1.0,
        own_pressure=True,
    ),
    "stresses inside layers": Rule(
        "stresses inside against the integral equation, over themselves or the largest",
        (*at.STRESSES_INSIDE[FEM], *on_layers.STRESSES_INSIDE[SIE], at.INSIDE_X, at.INSIDE_Y), _inside,
        tolerances=1.0, own_pressure=True,
    ),
    "estimate at interfaces, fem": _estimate(
        on_layers.ESTIMATE_AT_INTERFACES[FEM], "stresses at interfaces by finite elements"
    ),
    "estimate at interfaces, sie": _estimate(
        on_layers.ESTIMATE_AT_INTERFACES[SIE], "stresses at interfaces by the integral equation"
    ),
    "estimate of sigma_XX, sie": _estimate(
        on_layers.ESTIMATE_IN_PLANE[SIE], "σ_XX of the integral equation over layers"
    ),
    "estimate inside, sie": _estimate(
        on_layers.ESTIMATE_INSIDE[SIE], "stresses inside of the integral equation over layers"
    ),
}  # fmt: skip
