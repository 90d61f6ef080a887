"""Comparisons of finite elements with other methods, and the figures by which they are judged.

Each rule measures one figure. Rules compare finite elements with the closed form, or on layers with the
integral equation, in stress intensities, stresses, ends of the contact and yield. They hold nodal forces
against their balance, and judge the estimated errors of each method. Rules are registered by name, and
quantities name those that apply to them.

Nothing is compared next to a tip of a punch, where stresses are infinite. A NaN or an infinity is a fault
wherever the table of quantities does not allow it.
"""

import json
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.registry import Registry
from galinx.solvers.contact import stresses
from galinx.solvers.contact.edges import under_punch

from .quantities import layers as on_layers
from .quantities import states as of
from .quantities import stresses as at
from .quantities import table
from .quantities import yielding as to
from .quantities.quantity import (
    ANYWHERE,
    BESIDE,
    CLOSED_FORM,
    FEM,
    NEVER,
    SIE,
    STATE,
    Quantity,
)
from .quantities.states import LARGEST
from .quantities.stresses import PRESSURE, SURFACE_X


@dataclass(frozen=True)
class Comparison:
    """Figure of disagreement between two results.

    Attributes:
        name: name of the rule that measured it.
        text: its meaning in words, by which archives and reports list it.
        value: the figure, dimensionless.
    """

    name: str
    text: str
    value: float


@dataclass(frozen=True)
class Rule:
    """Rule of comparison: the quantities compared, the figure measured, and its limit for a PASS.

    Attributes:
        text: meaning of the figure in words.
        needs: the quantities that are compared.
        measure: function of the datasets by path and the load N per depth [N/m], a number or (states,),
            that gives the figure, dimensionless; None where there is nothing to compare.
        limit: largest value of a PASS; None where that is no fixed number.
        tolerances: largest value of a PASS over the scene's tolerance; None where it does not depend on
            that.
        mode: mode of solution in which the rule is applied, as of a quantity; "" for every mode.
        own_pressure: True where the rule is applied under a prescribed pressure, too.
    """

    text: str
    needs: tuple[Quantity, ...]
    measure: Callable[[dict[str, Any], Any], float | None]
    limit: float | None = None
    tolerances: float | None = None
    mode: str = ""
    own_pressure: bool = False

    def allowed(self, tolerance: float) -> float | None:
        """Largest value of a PASS; None where the figure is reported and not judged."""
        return self.limit if self.tolerances is None else self.tolerances * tolerance


def largest_of(row: Quantity) -> Callable[[dict[str, Any], Any], float]:
    """Measure of a rule: the largest value of a quantity over all states."""
    return lambda data, _: float(data[row.path].max())


def next_to_tips(data: Mapping[str, Any], inside: float = 1.0) -> NDArray[np.bool_]:
    """Mask of positions next to an infinite pressure of the closed form, (states, n).

    Args:
        data: datasets by path.
        inside: distance over a from the middle of the contact; infinite pressures farther out do not
            count.
    """
    X = data[SURFACE_X.path]
    if LARGEST[CLOSED_FORM].path not in data or PRESSURE[CLOSED_FORM].path not in data:
        return np.zeros((1, len(X)), dtype=bool)
    infinite = np.isnan(data[LARGEST[CLOSED_FORM].path])[:, None]
    σ_YY = np.where(under_punch(X), data[PRESSURE[CLOSED_FORM].path], 0.0)
    tips = X[np.abs(σ_YY).argmax(axis=1)][:, None]
    return infinite & (np.abs(tips) < inside) & ~stresses.off_tips(X, tips)


def not_finite(data: dict[str, Any]) -> list[str]:
    """Paths of datasets with a value that is not finite and that the table of quantities does not allow.

    Args:
        data: datasets of any states by path, the positions on the surface among them.
    """
    rows, paths = table(), []
    for path, values in data.items():
        if np.asarray(values).dtype.kind != "f":
            continue
        allowed = rows[path].nan_allowed if path in rows else NEVER
        bad = ~np.isfinite(values)
        if allowed == ANYWHERE:
            bad = np.isinf(values)
        elif allowed == BESIDE:
            bad &= np.isinf(values) | under_punch(data[SURFACE_X.path])
        if bad.any():
            paths.append(path)
    return paths


def _ends(other: str) -> Callable[[dict[str, Any], Any], float]:
    def measure(data: dict[str, Any], _: Any) -> float:
        size = data[of.HALF_WIDTH[other].path]
        off = [data[row[FEM].path] - data[row[other].path] for row in (of.HALF_WIDTH, of.CENTRE)]
        return float((np.abs(off) / size).max())

    return measure


def _largest_pressure(other: str) -> Callable[[dict[str, Any], Any], float | None]:
    def measure(data: dict[str, Any], _: Any) -> float | None:
        fem, exact = (data[of.LARGEST[method].path] for method in (FEM, other))
        off = np.abs(fem / exact - 1.0)
        return float(np.nanmax(off)) if np.isfinite(off).any() else None  # NaN: it is infinite

    return measure


def extremes_of(other: str) -> Callable[[dict[str, Any], Any], float]:
    """Measure of a rule: error of highest and lowest σ_XX against another method, dimensionless."""

    def measure(data: dict[str, Any], _: Any) -> float:
        rows = (at.HIGHEST, at.LOWEST) if other == CLOSED_FORM else (on_layers.HIGHEST, on_layers.LOWEST)
        exact = np.array([data[row[other].path] for row in rows])
        fem = np.array([data[row[FEM].path] for row in (at.HIGHEST, at.LOWEST)])
        return float((np.abs(fem - exact) / np.abs(exact).max(axis=0)).max())

    return measure


def _rules(other: str, name: str, against: str) -> dict[str, Rule]:
    def of_both(*rows: dict[str, Any]) -> tuple[Any, ...]:
        return tuple(row[method] for row in rows for method in (other, FEM))

    return {
        f"ends{name}": Rule(
            f"ends of the contact{against}, over its half-width", of_both(of.HALF_WIDTH, of.CENTRE),
            _ends(other), tolerances=1.0,
        ),
        f"largest pressure{name}": Rule(
            f"largest contact pressure{against}, relative", of_both(of.LARGEST),
            _largest_pressure(other), tolerances=1.0,
        ),
    }  # fmt: skip


#: Rules by the name that quantities give.
OF_ENDS: dict[str, Rule] = {
    **_rules(CLOSED_FORM, "", ""),
    **_rules(SIE, " over layers", " against the integral equation"),
}


#: Share of the larger intensity, or of the mean pressure; where a value is smaller, its error is relative
#: to this share instead.
_VANISHING = 0.1


def _intensities_of_layers(data: dict[str, Any], _: float) -> float | None:
    """Largest error of K_I at both ends, relative; None for free ends, at which it vanishes."""
    sides = of.K_I_LEFT | on_layers.K_I_LEFT, of.K_I_RIGHT | on_layers.K_I_RIGHT
    fem, sie = (np.array([data[side[method].path] for side in sides]) for method in (FEM, SIE))
    if not sie.any():
        return None
    size = np.maximum(np.abs(sie), _VANISHING * np.abs(sie).max(axis=0))
    return float((np.abs(fem - sie) / size).max())


def _pressures(data: dict[str, Any]) -> tuple[Any, Any]:
    under = under_punch(data[at.SURFACE_X.path])
    return data[at.PRESSURE[FEM].path][:, under], data[on_layers.PRESSURE[SIE].path][:, under]


def _pressure_between_free_ends_on_layers(data: dict[str, Any], _: float) -> float:
    """Largest error of σ_YY relative to each state's largest: it vanishes next to free ends."""
    fem, sie = _pressures(data)
    return float((np.abs(fem - sie) / np.abs(sie).max(axis=1, keepdims=True)).max())


def _pressure_of_layers(data: dict[str, Any], _: float) -> float | None:
    if of.HALF_WIDTH[SIE].path in data:
        return None
    fem, sie = _pressures(data)
    return float((np.abs(fem - sie) / np.maximum(np.abs(sie), _VANISHING)).max())


def _in_plane_of_layers(data: dict[str, Any], _: float) -> float:
    fem, sie = (data[row.path] for row in (at.IN_PLANE[FEM], on_layers.IN_PLANE[SIE]))
    return (np.abs(fem - sie) / stresses.of_in_plane(sie, data[at.SURFACE_X.path])).max()


def _at_interfaces(data: dict[str, Any], _: float) -> float:
    fem, sie = (np.array([data[row.path] for row in on_layers.INTERFACES[by]]) for by in (FEM, SIE))
    return float((np.abs(fem - sie) / stresses.of_interfaces(sie)).max())


def _inside_layers(data: dict[str, Any], _: float) -> float:
    rows = at.STRESSES_INSIDE[FEM], on_layers.STRESSES_INSIDE[SIE]
    fem, sie = ([data[row.path] for row in of_method] for of_method in rows)
    places = (data[row.path] for row in (at.INSIDE_X, at.INSIDE_Y))
    off = stresses.largest(σ_fem - σ_sie for σ_fem, σ_sie in zip(fem, sie))
    return float((off / stresses.of_inside(sie, *places)).max())


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
        "σ_YY against the integral equation, relative to itself or a tenth of the mean",
        (at.PRESSURE[FEM], on_layers.PRESSURE[SIE], at.SURFACE_X), _pressure_of_layers,
        tolerances=1.0,
    ),
    # As on uniform solids under contacts with free ends.
    "sigma_YY of found ends over layers": Rule(
        "σ_YY of contacts with free ends against the integral equation, over the largest",
        (at.PRESSURE[FEM], on_layers.PRESSURE[SIE], at.SURFACE_X, of.LARGEST[SIE]),
        _pressure_between_free_ends_on_layers, tolerances=10.0,
    ),
    "sigma_XX of layers": Rule(
        "σ_XX against the integral equation, relative to itself or the largest",
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
        "stresses inside against the integral equation, relative to themselves or the largest",
        (*at.STRESSES_INSIDE[FEM], *on_layers.STRESSES_INSIDE[SIE], at.INSIDE_X, at.INSIDE_Y),
        _inside_layers,
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


def comparisons(data: dict[str, Any], load: Any, names: Iterable[str]) -> list[Comparison]:
    """Every comparison that the data of states allow, in the order of ``RULES``.

    Args:
        data: datasets by path.
        load: N per depth [N/m], a number or (states,).
        names: names of the rules that the quantities in the data have.
    """
    figures, applicable = [], set(names)
    for name, rule in RULES.items():
        if name in applicable and all(row.path in data for row in rule.needs):
            value = rule.measure(data, load)
            if value is not None:
                figures.append(Comparison(name, rule.text, float(value)))
    return figures


def _imbalance(data: dict[str, Any], load: Any) -> float:
    normal, tangential = (data[row.path] for row in (of.NORMAL_FORCE, of.TANGENTIAL_FORCE))
    ratio = data.get(of.RESULTANT_RATIO[FEM].path, data[of.RATIO.path])
    return np.maximum(np.abs(normal / load + 1.0), np.abs(tangential / load + ratio)).max()


def _apart(rows: Mapping[str, Quantity]) -> Callable[[dict[str, Any], Any], float]:
    def measure(data: dict[str, Any], _: Any) -> float:
        return float(np.abs(data[rows[FEM].path] - data[rows[CLOSED_FORM].path]).max())

    return measure


def _resultant(other: str) -> Callable[[dict[str, Any], Any], float]:
    def measure(data: dict[str, Any], load: Any) -> float:
        rows = (of.NORMAL_FORCE, of.TANGENTIAL_FORCE, of.RESULTANT[other], of.RATIO)
        normal, tangential, exact, g = (data[row.path] for row in rows)
        off = np.maximum(np.abs(normal - exact), np.abs(tangential - g * exact))
        return float((off / np.maximum(np.abs(exact), load)).max())

    return measure


def _intensities(data: dict[str, Any], _: float) -> float | None:
    """Largest error of K_I at both ends, relative; None for free ends, at which it vanishes."""
    any_sharp = any(data[side[CLOSED_FORM].path].any() for side in (of.K_I_LEFT, of.K_I_RIGHT))
    return float(of.K_I_error(data).max()) if any_sharp else None


def _exponents(data: dict[str, Any], _: float) -> float | None:
    pairs = (of.FITTED_ALPHA, of.ALPHA), (of.FITTED_BETA, of.BETA)
    off = np.abs([data[fitted.path] - data[local.path] for fitted, local in pairs])
    return float(np.nanmax(off)) if np.isfinite(off).any() else None  # NaN: none could be fitted


def _tension(data: dict[str, Any], _: float) -> float | None:
    """Largest tension under the punch over N/(2a), None without any; a punch would lift off there."""
    largest = float(np.nanmax(data[at.PRESSURE[FEM].path], initial=0.0))
    return largest if largest > 0.0 else None


def _both(data: dict[str, Any], rows: dict[str, Quantity], where: NDArray) -> tuple[NDArray, NDArray]:
    return data[rows[FEM].path][:, where], data[rows[CLOSED_FORM].path][:, where]


def _pressure(data: dict[str, Any], _: float) -> float:
    fem, exact = _both(data, at.PRESSURE, under_punch(data[at.SURFACE_X.path]))
    return (np.abs(fem - exact) / np.maximum(np.abs(exact), _VANISHING)).max()


def _pressure_between_free_ends(data: dict[str, Any], _: float) -> float:
    """Largest error of σ_YY relative to each state's largest, not next to tips, where it is infinite."""
    under = under_punch(data[at.SURFACE_X.path])
    fem, exact = _both(data, at.PRESSURE, under)
    left_out = next_to_tips(data)[:, under]
    size = np.where(left_out, 0.0, np.abs(exact)).max(axis=1, keepdims=True)
    return (np.where(left_out, 0.0, np.abs(fem - exact)) / size).max()


def _in_plane(data: dict[str, Any], _: float) -> float:
    """Largest error of σ_XX relative to its size, but not next to tips inside the contact."""
    fem, exact = (data[row.path] for row in (at.IN_PLANE[FEM], at.IN_PLANE[CLOSED_FORM]))
    off = np.abs(fem - exact) / stresses.of_in_plane(exact, data[at.SURFACE_X.path])
    return np.where(next_to_tips(data, 1.0 - stresses.NEAR_TIP), 0.0, off).max()


def _inside(data: dict[str, Any], _: float) -> float:
    fem, exact = ([data[row.path] for row in at.STRESSES_INSIDE[method]] for method in (FEM, CLOSED_FORM))
    places = (data[row.path] for row in (at.INSIDE_X, at.INSIDE_Y))
    off = stresses.largest(σ_fem - σ for σ_fem, σ in zip(fem, exact))
    return (off / stresses.of_inside(exact, *places)).max()


def _largest_stresses(data: dict[str, Any], _: float) -> float | None:
    pairs = [(data[row[FEM].path], data[row[CLOSED_FORM].path]) for row in (to.VON_MISES, to.SHEAR)]
    off = np.abs([fem / exact - 1.0 for fem, exact in pairs])
    return float(np.nanmax(off)) if np.isfinite(off).any() else None  # NaN: all are infinite


def _largest_on_layers(rows: Mapping[str, Any]) -> Callable[[dict[str, Any], Any], float]:
    def measure(data: dict[str, Any], _: Any) -> float:
        fem, exact = (data[rows[method].path] for method in (FEM, SIE))
        return float(np.max(np.abs(fem / exact - 1.0)))

    return measure


def _yielded_zone(data: dict[str, Any], _: float) -> float | None:
    """Largest relative error of stresses that the reach d of yield stands for: they are a power of d."""
    off = []
    for rows, exponent in ((to.REACH_LEFT, of.BETA), (to.REACH_RIGHT, of.ALPHA)):
        power = -data[exponent.path]
        fem, exact = (np.maximum(data[row.path], _NO_REACH) ** power for row in rows.values())
        off.append(np.abs(fem / exact - 1.0))
    return float(np.nanmax(off)) if np.isfinite(off).any() else None  # NaN: no solid carries that


def _depth(data: dict[str, Any], load: Any) -> float | None:
    """Largest relative error of the stresses that depths d of yield stand for.

    At sharp edges they are a power of d. Elsewhere, with the load N₁ of first yield, the logarithm of the
    stress over the strength falls from ln(N/N₁) at the place of the largest to 0 at d. Where N₁ is 0, the
    stress is a logarithm of the distance from a jump of the pressure, which any load makes yield: zones
    there may be minute, and d itself over a counts. Where N₁ is not known, the square of the difference
    of d stands for it, as next to the place of the largest.
    """
    exact, fem = (data[to.DEPTH[method].path] for method in (CLOSED_FORM, FEM))
    deep = np.maximum(np.maximum(fem, exact), _NO_REACH)
    off = np.abs(fem - exact) / deep
    if to.REACH_LEFT[FEM].path in data:
        power = -np.minimum(data[of.ALPHA.path], data[of.BETA.path])
        off = np.abs((np.maximum(fem, _NO_REACH) / np.maximum(exact, _NO_REACH)) ** power - 1.0)
    elif to.FIRST_LOAD[CLOSED_FORM].path in data:
        first, top = (data[row[CLOSED_FORM].path] for row in (to.FIRST_LOAD, to.VON_MISES_Y))
        below = np.maximum(deep + top, _NO_REACH)  # the place of the largest stress, Y < 0
        with np.errstate(divide="ignore", invalid="ignore"):
            share = np.minimum(np.abs(fem - exact) / below, 1.0)
            off = np.where(
                first > 0.0, np.maximum(np.log(load / first), 0.0) * share, np.abs(fem - exact)
            )
    else:
        off = off**2
    return float(np.nanmax(off)) if np.isfinite(off).any() else None  # NaN: no solid carries that


def _not_finite(data: dict[str, Any], _: float) -> float | None:
    return 1.0 if not_finite(data) else None


#: Distance over a from an edge that counts as none.
_NO_REACH = 1e-300

#: Name of the rule that applies to every quantity.
FINITE = "finite"

#: Balance of nodal forces; its limit, relative to N, holds at every tolerance.
BALANCE = Rule(
    "nodal forces against the load, over N",
    (of.NORMAL_FORCE, of.TANGENTIAL_FORCE, of.RATIO), _imbalance, limit=1e-9,
)  # fmt: skip

#: Rules by the name that quantities give, in the order in which they are reported.
RULES: Registry[Rule] = Registry(
    "rule of comparison",
    {
        "force balance": BALANCE,
        **{
            next(iter(row.compared)): Rule(
                f"nodal forces against the resultant of the pressure{name}, over it or N",
                (of.NORMAL_FORCE, of.TANGENTIAL_FORCE, row, of.RATIO), _resultant(method),
                limit=BALANCE.limit, own_pressure=True,
            )
            for (method, row), name in zip(of.RESULTANT.items(), ("", " over layers"))
        },
        FINITE: Rule(
            "values that are not finite where they have to be: 1 for some",
            (), _not_finite, limit=0.0, own_pressure=True,
        ),
        "residual": Rule(
            "residual of the integral equation at the closed form's pressure, relative",
            (of.RESIDUAL[CLOSED_FORM],), largest_of(of.RESIDUAL[CLOSED_FORM]), limit=1e-8,
        ),
        "residual of finite elements": Rule(
            "residual of the integral equation at the finite elements' pressure, relative",
            (of.RESIDUAL[FEM],), largest_of(of.RESIDUAL[FEM]), tolerances=10.0,
        ),
        "residual inside": Rule(
            "stresses inside against line loads and equilibrium, over the largest",
            (at.RESIDUAL_INSIDE,), largest_of(at.RESIDUAL_INSIDE), limit=1e-8, own_pressure=True,
        ),
        "K_I": Rule(
            "K_I at both ends, relative",
            (*of.K_I_LEFT.values(), *of.K_I_RIGHT.values()),
            _intensities, tolerances=1.0,
        ),
        "estimate": Rule(
            "estimated error of K_I and moments, relative",
            (of.ESTIMATE,), largest_of(of.ESTIMATE), tolerances=1.0,
        ),
        "resultant_ratio": Rule(
            "resultant of σ_XY over that of σ_YY, absolute",
            tuple(of.RESULTANT_RATIO.values()), _apart(of.RESULTANT_RATIO), tolerances=1.0,
        ),
        "pressure_centre": Rule(
            "centre of pressure, over a",
            tuple(of.PRESSURE_CENTRE.values()), _apart(of.PRESSURE_CENTRE), tolerances=1.0,
        ),
        **ON_LAYERS,
        **OF_ENDS,
        "exponents": Rule(
            "fitted edge exponents, absolute",
            (of.FITTED_ALPHA, of.FITTED_BETA, of.ALPHA, of.BETA), _exponents,
        ),
        "tension": Rule(
            "tension under the punch, over N/(2a)",
            (at.PRESSURE[FEM],), _tension, limit=0.0, own_pressure=True,
        ),
        # Under a prescribed pressure there is no raw one, and nothing to compare.
        "sigma_YY": Rule(
            "σ_YY pointwise, relative",
            (at.RAW_PRESSURE, at.PRESSURE[CLOSED_FORM], at.SURFACE_X), _pressure, tolerances=1.0,
        ),
        # For free ends, where no exponent is assumed; at a sharp edge sigma_YY is the stricter rule.
        "sigma_YY of found ends": Rule(
            "σ_YY of contacts with free ends, over the largest further than 0.02 a from a tip",
            (*at.PRESSURE.values(), at.SURFACE_X, of.LARGEST[CLOSED_FORM]), _pressure_between_free_ends,
            tolerances=10.0,
        ),
        "sigma_XX": Rule(
            "σ_XX pointwise, relative to itself or the largest",
            (*at.IN_PLANE.values(), at.SURFACE_X), _in_plane, tolerances=1.0, own_pressure=True,
        ),
        "extremes of sigma_XX": Rule(
            "highest and lowest σ_XX, over the larger of them",
            (*at.HIGHEST.values(), *at.LOWEST.values()), extremes_of(CLOSED_FORM), tolerances=1.0,
            own_pressure=True,
        ),
        "estimate of sigma_XX": Rule(
            "estimated error of σ_XX, relative", (at.ESTIMATE_IN_PLANE,),
            largest_of(at.ESTIMATE_IN_PLANE), tolerances=1.0, own_pressure=True,
        ),
        "stresses inside": Rule(
            "stresses inside, relative to themselves or the largest",
            (*at.STRESSES_INSIDE[FEM], *at.STRESSES_INSIDE[CLOSED_FORM], at.INSIDE_X, at.INSIDE_Y),
            _inside, tolerances=1.0, own_pressure=True,
        ),
        "estimate inside": Rule(
            "estimated error of stresses inside, relative", (at.ESTIMATE_INSIDE,),
            largest_of(at.ESTIMATE_INSIDE), tolerances=1.0, own_pressure=True,
        ),
        "largest stresses": Rule(
            "largest von Mises and shear stress, relative",
            tuple(row[method] for row in (to.VON_MISES, to.SHEAR) for method in (CLOSED_FORM, FEM)),
            _largest_stresses, tolerances=1.0, own_pressure=True,
        ),
        "largest stresses over layers": Rule(
            "largest von Mises stress against the integral equation, relative",
            (to.VON_MISES[SIE], to.VON_MISES[FEM]), _largest_on_layers(to.VON_MISES), tolerances=1.0,
        ),
        "largest stresses of layers": Rule(
            "largest von Mises stress of each layer against the integral equation, relative",
            (*to.OF_LAYERS.values(),), _largest_on_layers(to.OF_LAYERS), tolerances=1.0,
        ),
        "yielded zone": Rule(
            "distance from the edges within which yield is passed, as a stress, relative",
            (*to.REACH_LEFT.values(), *to.REACH_RIGHT.values(), of.ALPHA, of.BETA), _yielded_zone,
            tolerances=1.0,
        ),
        "depth of yield": Rule(
            "depth of the yielded zone, as a stress, relative",
            (*to.DEPTH.values(),), _depth, tolerances=1.0, own_pressure=True,
        ),
        "estimate of yield": Rule(
            "estimated error of stresses from which yield is computed, relative", (to.ESTIMATE_YIELD,),
            largest_of(to.ESTIMATE_YIELD), tolerances=1.0, own_pressure=True,
        ),
        # In the traction mode v,X under the punch has to vanish. It is a derivative of the displacement,
        # with about half the digits of the moments to which the tolerance refers.
        "slope under the punch": Rule(
            "v,X under the punch over that beside it",
            (of.SLOPE,), largest_of(of.SLOPE), tolerances=10.0, mode="traction",
        ),
    },
    Rule,
)  # fmt: skip


_AT_MOST = ", at most "


def judged(attributes: Mapping[str, Any]) -> dict[str, tuple[float, float]]:
    """Figure and its limit for a PASS, by the comparison's text, of an archive's verdict."""
    worst, reasons = json.loads(attributes["comparisons"]), json.loads(attributes["verdict_reasons"])
    limits = {text: reason for reason in reasons for text in worst if reason.startswith(f"{text}: ")}
    return {
        text: (worst[text], float(reason.rpartition(_AT_MOST)[2]))
        for text, reason in limits.items()
        if _AT_MOST in reason
    }


def checked(attributes: Mapping[str, Any]) -> str:
    """How well numbers were checked, in one line: the worst of all figures of a kind."""
    figures = judged(attributes)
    kinds: dict[str, list[float]] = {"two methods agree to": [], "estimated error": [], "residual": []}
    for text, (value, _) in figures.items():
        if "nodal forces" not in text and "not finite" not in text:
            words = ("estimated error", "residual")
            kinds[next((word for word in words if text.startswith(word)), "two methods agree to")].append(
                value
            )
    limits = [limit for text, (_, limit) in figures.items() if "nodal forces" not in text]
    parts = [f"{kind} {max(values):.0e}" for kind, values in kinds.items() if values]
    if not parts:
        return "numbers not checked: one method alone, and nothing to compare it with"
    wanted = max(set(limits), key=limits.count)
    return f"numbers checked: {', '.join(parts)}, wanted {wanted:.0e} (dimensionless)"


def failed(data: Mapping[str, Any], attributes: Mapping[str, Any]) -> list[str]:
    """What failed, by how much, where, and what to do; none for another verdict than FAIL.

    Args:
        data: datasets by path; where stresses along the surface are not among them, no state is named.
        attributes: attributes of the archive's root.
    """
    if attributes["verdict"] != "FAIL":
        return []
    lines, figures = [], judged(attributes)
    over = {text: pair for text, pair in figures.items() if not pair[0] <= pair[1]}
    for text, (value, limit) in sorted(over.items(), key=lambda item: -item[1][0] / (item[1][1] or 1.0)):
        times = f", {value / limit:.2g} times what is wanted, {limit:g}" if limit else ""
        lines.append(f"{text}: {value:.1e}{times}{_worst_state(text, data, attributes)}")
    lines += [r for r in json.loads(attributes["verdict_reasons"]) if r.startswith("not solved")]
    if over:
        value, limit = max(over.values(), key=lambda pair: pair[0] / (pair[1] or 1.0))
        limits = [limit for _, limit in figures.values()]
        wanted = max(limits, key=limits.count)
        enough = 10.0 ** np.ceil(np.log10(wanted * max(value / (limit or 1.0), 1.0)))
        lines.append(
            f"what to do: --set solve.tolerance={wanted / 10.0:.0e} computes finer and may pass; "
            "another solve.degree or solve.mesh shows which method is off; "
            f"--set solve.tolerance={enough:.0e} accepts it"
        )
    return lines


def _worst_state(text: str, data: Mapping[str, Any], attributes: Mapping[str, Any]) -> str:
    """State in which a comparison has its largest figure, in words; "" where that is not known."""
    rule = next((rule for rule in RULES.values() if rule.text == text), None)
    count, load = len(data[of.SPEED.path]), data.get(of.LOAD.path, attributes["load"])
    if rule is None or count < 2 or any(row.path not in data for row in rule.needs):
        return ""
    rows = table()
    figures = []
    for i in range(count):
        one = {
            path: values[i : i + 1] if path in rows and STATE in rows[path].over else values
            for path, values in data.items()
        }
        figures.append(rule.measure(one, load[i : i + 1] if np.ndim(load) else load) or 0.0)
    i = int(np.nanargmax(figures))
    c, f = data[of.SPEED.path][i], data[of.FRICTION.path][i]
    return f", in state {i} (c = {c:.4g}, f = {f:.4g})"
