"""How far finite elements and closed form agree, and whether the forces balance."""

from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess import scale
from galinx.postprocess.finite import not_finite
from galinx.postprocess.quantities import states as of
from galinx.postprocess.quantities import stresses as at
from galinx.postprocess.quantities import yielding as to
from galinx.postprocess.quantities.quantity import CLOSED_FORM, FEM, Quantity
from galinx.postprocess.rule import Comparison, Rule, largest_of
from galinx.postprocess.rules_of_ends import OF_ENDS, extremes_of
from galinx.postprocess.rules_of_layers import ON_LAYERS
from galinx.postprocess.tips import next_to_tips
from galinx.registry import Registry
from galinx.solvers.contact import under_punch


def comparisons(data: dict[str, Any], load: Any, names: Iterable[str]) -> list[Comparison]:
    """Every comparison that some states' data allow, in the order of ``RULES``.

    Args:
        data: datasets by path.
        load: N per depth [N/m], or that of each state, (states,).
        names: of the rules of the quantities that the data hold.
    """
    found, wanted = [], set(names)
    for name, rule in RULES.items():
        if name in wanted and all(row.path in data for row in rule.needs):
            value = rule.measure(data, load)
            if value is not None:
                found.append(Comparison(name, rule.text, float(value)))
    return found


def _imbalance(data: dict[str, Any], load: Any) -> float:
    normal, tangential = (data[row.path] for row in (of.NORMAL_FORCE, of.TANGENTIAL_FORCE))
    off = np.maximum(np.abs(normal / load + 1.0), np.abs(tangential / load + data[of.RATIO.path]))
    return off.max()


def _resultant(other: str) -> Callable[[dict[str, Any], Any], float]:
    def measure(data: dict[str, Any], load: Any) -> float:
        rows = (of.NORMAL_FORCE, of.TANGENTIAL_FORCE, of.RESULTANT[other], of.RATIO)
        normal, tangential, exact, g = (data[row.path] for row in rows)
        off = np.maximum(np.abs(normal - exact), np.abs(tangential - g * exact))
        return float((off / np.maximum(np.abs(exact), load)).max())

    return measure


def _intensities(data: dict[str, Any], _: float) -> float | None:
    """Ends that are found have none."""
    some = any(data[side[CLOSED_FORM].path].any() for side in (of.K_I_LEFT, of.K_I_RIGHT))
    return float(of.K_I_error(data).max()) if some else None


def _exponents(data: dict[str, Any], _: float) -> float | None:
    pairs = (of.FITTED_ALPHA, of.ALPHA), (of.FITTED_BETA, of.BETA)
    off = np.abs([data[fitted.path] - data[local.path] for fitted, local in pairs])
    return float(np.nanmax(off)) if np.isfinite(off).any() else None  # NaN: none could be fitted


def _tension(data: dict[str, Any], _: float) -> float | None:
    """A punch cannot pull; what was computed is not what would happen, and it is not clipped."""
    largest = float(np.nanmax(data[at.PRESSURE[FEM].path], initial=0.0))
    return largest if largest > 0.0 else None


def _both(data: dict[str, Any], rows: dict[str, Quantity], where: NDArray) -> tuple[NDArray, NDArray]:
    return data[rows[FEM].path][:, where], data[rows[CLOSED_FORM].path][:, where]


def _pressure(data: dict[str, Any], _: float) -> float:
    fem, exact = _both(data, at.PRESSURE, under_punch(data[at.SURFACE_X.path]))
    return (np.abs(fem - exact) / np.maximum(np.abs(exact), _VANISHING)).max()


def _found_pressure(data: dict[str, Any], _: float) -> float:
    """Over each state's largest; next to a tip, where it is infinite, nothing is compared."""
    under = under_punch(data[at.SURFACE_X.path])
    fem, exact = _both(data, at.PRESSURE, under)
    left_out = next_to_tips(data)[:, under]
    size = np.where(left_out, 0.0, np.abs(exact)).max(axis=1, keepdims=True)
    return (np.where(left_out, 0.0, np.abs(fem - exact)) / size).max()


def _in_plane(data: dict[str, Any], _: float) -> float:
    """Next to a tip inside the contact nothing is compared; edges stand for themselves."""
    fem, exact = (data[row.path] for row in (at.IN_PLANE[FEM], at.IN_PLANE[CLOSED_FORM]))
    off = np.abs(fem - exact) / scale.of_in_plane(exact, data[at.SURFACE_X.path])
    return np.where(next_to_tips(data, 1.0 - scale.NEAR_TIP), 0.0, off).max()


def _inside(data: dict[str, Any], _: float) -> float:
    fem, exact = ([data[row.path] for row in at.STRESSES_INSIDE[method]] for method in (FEM, CLOSED_FORM))
    places = (data[row.path] for row in (at.INSIDE_X, at.INSIDE_Y))
    off = scale.largest(one - other for one, other in zip(fem, exact))
    return (off / scale.of_inside(exact, *places)).max()


def _largest_stresses(data: dict[str, Any], _: float) -> float | None:
    pairs = [(data[row[FEM].path], data[row[CLOSED_FORM].path]) for row in (to.VON_MISES, to.SHEAR)]
    off = np.abs([fem / exact - 1.0 for fem, exact in pairs])
    return float(np.nanmax(off)) if np.isfinite(off).any() else None  # NaN: all are infinite


def _yielded_zone(data: dict[str, Any], _: float) -> float | None:
    """As a stress: at a distance d from an edge that is a power of d."""
    off = []
    for rows, exponent in ((to.REACH_LEFT, of.BETA), (to.REACH_RIGHT, of.ALPHA)):
        power = -data[exponent.path]
        fem, exact = (np.maximum(data[row.path], _NO_REACH) ** power for row in rows.values())
        off.append(np.abs(fem / exact - 1.0))
    return float(np.nanmax(off)) if np.isfinite(off).any() else None  # NaN: no solid carries that


def _depth(data: dict[str, Any], _: float) -> float | None:
    fem, exact = (data[row.path] for row in to.DEPTH.values())
    off = np.abs(fem - exact)
    return float(np.nanmax(off)) if np.isfinite(off).any() else None


def _not_finite(data: dict[str, Any], _: float) -> float | None:
    return 1.0 if not_finite(data) else None


#: Distance over a from an edge that is as good as none.
_NO_REACH = 1e-300

#: Pressure over N/(2a) below which it is not compared with itself: it may vanish under a profile.
_VANISHING = 0.1

#: The rule by which every quantity is judged.
FINITE = "finite"

#: A balance of nodal forces further off than its limit, over N, is a fault whatever the tolerance.
BALANCE = Rule(
    "nodal forces against the load, over N",
    (of.NORMAL_FORCE, of.TANGENTIAL_FORCE, of.RATIO), _imbalance, limit=1e-9,
)  # fmt: skip

#: Rules by the name that quantities give, in the order in which they are told.
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
        # Where the pressure was put in there is no raw one, and nothing to compare.
        "sigma_YY": Rule(
            "σ_YY pointwise, relative",
            (at.RAW_PRESSURE, at.PRESSURE[CLOSED_FORM], at.SURFACE_X), _pressure, tolerances=1.0,
        ),
        # Where exponents are not assumed; at a sharp edge the rule before is the stricter one.
        "sigma_YY of found ends": Rule(
            "σ_YY of contacts whose ends are found, over the largest further than 0.02 a from a tip",
            (*at.PRESSURE.values(), at.SURFACE_X, of.LARGEST[CLOSED_FORM]), _found_pressure,
            tolerances=10.0,
        ),
        "sigma_XX": Rule(
            "σ_XX pointwise, over itself or the largest",
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
            "stresses inside, over themselves or the largest",
            (*at.STRESSES_INSIDE[FEM], *at.STRESSES_INSIDE[CLOSED_FORM], at.INSIDE_X, at.INSIDE_Y),
            _inside, tolerances=1.0, own_pressure=True,
        ),
        "estimate inside": Rule(
            "estimated error of stresses inside, relative", (at.ESTIMATE_INSIDE,),
            largest_of(at.ESTIMATE_INSIDE), tolerances=1.0, own_pressure=True,
        ),
        "largest stresses": Rule(
            "largest von Mises and shear stress, relative",
            (*to.VON_MISES.values(), *to.SHEAR.values()), _largest_stresses, tolerances=1.0,
            own_pressure=True,
        ),
        "yielded zone": Rule(
            "distance from the edges within which yield is passed, as a stress, relative",
            (*to.REACH_LEFT.values(), *to.REACH_RIGHT.values(), of.ALPHA, of.BETA), _yielded_zone,
            tolerances=1.0,
        ),
        "depth of yield": Rule(
            "depth of the yielded zone, over a",
            (*to.DEPTH.values(),), _depth, own_pressure=True,
        ),
        "estimate of yield": Rule(
            "estimated error of stresses in which yield is looked for, relative", (to.ESTIMATE_YIELD,),
            largest_of(to.ESTIMATE_YIELD), tolerances=1.0, own_pressure=True,
        ),
        # In the traction mode v,X under the punch has to vanish; it is a derivative of the displacement
        # and so has about half the digits of the moments that the tolerance speaks of.
        "slope under the punch": Rule(
            "v,X under the punch over that beside it",
            (of.SLOPE,), largest_of(of.SLOPE), tolerances=10.0, mode="traction",
        ),
    },
    Rule,
)  # fmt: skip
