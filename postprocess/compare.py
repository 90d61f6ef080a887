"""Comparisons of finite elements with other methods, and the figures by which they are judged.

Each rule measures one figure. Rules compare finite elements with the closed form, or on layers with the
integral equation, in stress intensities, stresses, ends of the contact and yield. They hold nodal forces
against their balance, and judge the estimated errors of each method. Rules are registered by name; one
applies where all quantities that it needs are computed.

Nothing is compared next to a tip of a punch, where stresses are infinite. A NaN or an infinity is a fault
wherever the table of quantities does not allow it.
"""

import json
import tomllib
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.registry import Registry
from galinx.solvers.contact import stresses
from galinx.solvers.contact.edges import under_punch

from .quantities import layers as on_layers
from .quantities import over_time as in_time
from .quantities import preferred, runs, table, validity
from .quantities import states as of
from .quantities import stresses as at
from .quantities import yielding as to
from .quantities.quantity import ANYWHERE, BESIDE, CLOSED_FORM, FEM, METHODS, NEVER, SIE, STATE, Quantity


@dataclass(frozen=True)
class Rule:
    """Rule of comparison: the quantities compared, the figure measured, and its limit for a PASS.

    Attributes:
        text: meaning of the figure in words.
        needs: the quantities that are compared.
        measure: function of the datasets by path and the load N per depth [N/m], a number or (states,),
            that gives the figure, dimensionless; None where there is nothing to compare.
        limit: largest value of a PASS, whatever the tolerance; None where that is no fixed number.
        tolerances: largest value of a PASS over the scene's tolerance; None where it does not depend on
            that.
        mode: mode of solution in which the rule is applied, as of a quantity; "" for every mode.
        own_pressure: True where the rule is applied under a prescribed pressure, too.
        remedy: change of a scene that does not pass; "" where that is another tolerance, if any.
    """

    text: str
    needs: tuple[Quantity, ...]
    measure: Callable[[dict[str, Any], Any], float | None]
    limit: float | None = None
    tolerances: float | None = None
    mode: str = ""
    own_pressure: bool = False
    remedy: str = ""

    def allowed(self, tolerance: float) -> float | None:
        """Largest value of a PASS; None where the figure is reported and not judged."""
        by_tolerance = None if self.tolerances is None else self.tolerances * tolerance
        return min((of for of in (self.limit, by_tolerance) if of is not None), default=None)


#: Tension over N/(2a) up to which that of a formula is rounding.
_ROUNDED = 1e-12


def pull(by: str, largest: Quantity, remedy: str, limit: float = 1e-3) -> Rule:
    """Rule that the punch does not pull: it would lift off there.

    Args:
        by: beginning of the text, what the tension is of.
        largest: the largest tension over N/(2a).
        remedy: change of a scene that does not pass.
        limit: largest value of a PASS, however coarse the tolerance.
    """

    def measure(data: dict[str, Any], _: Any) -> float | None:
        tension = float(np.nanmax(data[largest.path], initial=0.0))
        return tension if tension > _ROUNDED * (largest.method != FEM) else None

    return Rule(
        f"tension under the punch{by}, over N/(2a)", (largest,), measure, limit, 1.0, own_pressure=True,
        remedy=f"the punch would lift off; {remedy}",
    )  # fmt: skip


#: Change of a scene in which a punch in steady motion pulls.
_PRESS = "let a load, profile or friction press everywhere"


def _off_tips(data: Mapping[str, Any], inside: float = 1.0) -> NDArray[np.bool_]:
    """False next to tips, where the pressure is infinite, by states and positions, (states, n).

    Args:
        data: datasets by path.
        inside: distance over a from the middle of the contact; infinite pressures farther out do not
            count.
    """
    X = data[at.SURFACE_X.path]
    rows = ((of.LARGEST[method].path, at.PRESSURE[method].path) for method in (CLOSED_FORM, SIE))
    largest_pressure, pressure = next((row for row in rows if data.keys() >= {*row}), ("", ""))
    if not pressure:
        return np.ones((1, len(X)), dtype=bool)
    infinite = np.isnan(data[largest_pressure])[:, None] & (np.abs(X) < inside)
    σ_YY = np.pad(np.where(under_punch(X), np.abs(data[pressure]), 0.0), ((0, 0), (1, 1)))
    tips = infinite & (σ_YY[:, 1:-1] >= np.maximum(σ_YY[:, :-2], σ_YY[:, 2:]))
    return ~(tips @ (np.abs(X[:, None] - X) < stresses.NEAR_TIP))


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
            bad &= np.isinf(values) | under_punch(data[at.SURFACE_X.path])
        if bad.any():
            paths.append(path)
    return paths


#: Quantity by method, or several.
_Rows = Mapping[str, Any]


def _of(rows: Iterable[_Rows], method: str) -> list[Quantity]:
    each = (row[method] for row in rows)
    return [member for entry in each for member in (entry if isinstance(entry, tuple) else (entry,))]


def against(
    other: str,
    measure: Callable[[list[NDArray], list[NDArray], dict[str, Any], Any], float | None],
    text: str,
    *rows: _Rows,
    beside: tuple[Quantity, ...] = (),
    tolerances: float | None = 1.0,
    own_pressure: bool = False,
) -> Rule:
    """Rule that compares finite elements with another method.

    Args:
        other: the other method.
        measure: function of the quantities by finite elements and by the other method, (states, …) each,
            of all datasets by path, and of the load.
        text: meaning of the figure in words.
        rows: the quantities that are compared, by method.
        beside: further quantities that the measure needs.
        tolerances: largest value of a PASS over the scene's tolerance; None where it is not judged.
        own_pressure: True where the rule is applied under a prescribed pressure, too.
    """
    of_fem, of_other = _of(rows, FEM), _of(rows, other)

    def measured(data: dict[str, Any], load: Any) -> float | None:
        fem, exact = ([data[row.path] for row in own] for own in (of_fem, of_other))
        return measure(fem, exact, data, load)

    needs = (*of_fem, *of_other, *beside)
    return Rule(text, needs, measured, tolerances=tolerances, own_pressure=own_pressure)


def _worst(off: NDArray) -> float | None:
    """Largest error; None where all are NaN: what is compared is infinite, or could not be fitted."""
    return float(np.nanmax(off)) if np.isfinite(off).any() else None


def _relative(fem: Any, exact: Any, *_: Any) -> float | None:
    return _worst(np.abs(np.divide(fem, exact) - 1.0))


def _relative_everywhere(fem: Any, exact: Any, *_: Any) -> float:
    return np.max(np.abs(np.divide(fem, exact) - 1.0))


def _over(size: Callable[[NDArray], Any]) -> Callable[..., float]:
    """Measure of the largest difference over a size of the exact values."""
    return lambda fem, exact, *_: (np.abs(np.subtract(fem, exact)) / size(np.array(exact))).max()


def _intensities(fem: Any, exact: Any, *_: Any) -> float | None:
    """Largest error of K_I at both ends, relative; None for free ends, at which it vanishes."""
    return of.off_by(np.array(fem), np.array(exact)).max() if np.any(exact) else None


def _pressure(fem: Any, exact: Any, data: dict[str, Any], _: Any) -> float | None:
    if of.HALF_WIDTH[SIE].path in data:
        return None  # the ends are free, and another rule compares
    under = under_punch(data[at.SURFACE_X.path])
    # Where a pressure is smaller than a tenth of the mean, its error is relative to that.
    off = np.abs(np.subtract(fem, exact)) / np.maximum(np.abs(exact), 0.1)
    return off[..., under].max()


def _pressure_between_free_ends(fem: Any, exact: Any, data: dict[str, Any], _: Any) -> float:
    """Largest error of σ_YY relative to each state's largest, not next to tips, where it is infinite."""
    there = under_punch(data[at.SURFACE_X.path]) & _off_tips(data)
    size = np.where(there, np.abs(exact[0]), 0.0).max(axis=-1, keepdims=True)
    return (np.where(there, np.abs(fem[0] - exact[0]), 0.0) / size).max()


def _in_plane(fem: Any, exact: Any, data: dict[str, Any], _: Any) -> float:
    """Largest error of σ_XX relative to its size, but not next to tips inside the contact."""
    off = np.abs(fem[0] - exact[0]) / stresses.of_in_plane(exact[0], data[at.SURFACE_X.path])
    return np.where(_off_tips(data, 1.0 - stresses.NEAR_TIP), off, 0.0).max()


def _inside(fem: Any, exact: Any, data: dict[str, Any], _: Any) -> float:
    places = (data[row.path] for row in (at.INSIDE_X, at.INSIDE_Y))
    off = stresses.largest(σ_fem - σ for σ_fem, σ in zip(fem, exact))  # one at a time: maps are large
    return (off / stresses.of_inside(exact, *places)).max()


def _yielded_zone(fem: Any, exact: Any, data: dict[str, Any], _: Any) -> float | None:
    """Largest relative error of stresses that the reach d of yield stands for: they are a power of d."""
    power = -np.array([data[row.path] for row in (of.BETA, of.ALPHA)])
    return _relative(np.maximum(fem, _NO_REACH) ** power, np.maximum(exact, _NO_REACH) ** power)


def _depth(fem: Any, exact: Any, data: dict[str, Any], load: Any) -> float | None:
    """Largest relative error of the stresses that depths d of yield stand for.

    At sharp edges they are a power of d. Elsewhere, with the load N₁ of first yield, the logarithm of the
    stress over the strength falls from ln(N/N₁) at the place of the largest to 0 at d. Where N₁ is 0, the
    stress is a logarithm of the distance from a jump of the pressure, which any load makes yield: zones
    there may be minute, and d itself over a counts. Where N₁ is not known, the square of the difference
    of d stands for it, as next to the place of the largest.
    """
    if to.REACH_LEFT[FEM].path in data:
        power = -np.minimum(data[of.ALPHA.path], data[of.BETA.path])
        return _relative((np.maximum(fem, _NO_REACH) / np.maximum(exact, _NO_REACH)) ** power, np.ones(1))
    apart, deep = np.abs(np.subtract(fem, exact)), np.maximum(np.maximum(fem, exact), _NO_REACH)
    method = next((method for method in (CLOSED_FORM, SIE) if to.FIRST_LOAD[method].path in data), None)
    if method is None:
        return _worst((apart / deep) ** 2)
    first, top = (data[row[method].path] for row in (to.FIRST_LOAD, to.VON_MISES_Y))
    below = np.maximum(deep + top, _NO_REACH)  # the place of the largest stress, Y < 0
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.minimum(apart / below, 1.0)
        return _worst(np.where(first > 0.0, np.maximum(np.log(load / first), 0.0) * share, apart))


#: Distance over a from an edge that counts as none.
_NO_REACH = 1e-300


def comparisons(data: dict[str, Any], load: Any, names: Iterable[str]) -> dict[str, float]:
    """Figure of every rule that the data of states allow, by the rule's name, in the order of ``RULES``.

    Args:
        data: datasets by path.
        load: N per depth [N/m], a number or (states,).
        names: names of the rules that the quantities in the data have.
    """
    figures, applicable = dict[str, float](), set(names)
    for name, rule in RULES.items():
        if name in applicable and all(row.path in data for row in rule.needs):
            value = rule.measure(data, load)
            if value is not None:
                figures[name] = float(value)
    return figures


def _imbalance(data: dict[str, Any], load: Any) -> float:
    normal, tangential = (data[row.path] for row in (of.NORMAL_FORCE, of.TANGENTIAL_FORCE))
    ratio = data.get(of.RESULTANT_RATIO[FEM].path, data[of.RATIO.path])
    return np.maximum(np.abs(normal / load + 1.0), np.abs(tangential / load + ratio)).max()


def _resultant(other: str) -> Callable[[dict[str, Any], Any], float]:
    def measure(data: dict[str, Any], load: Any) -> float:
        rows = (of.NORMAL_FORCE, of.TANGENTIAL_FORCE, of.RESULTANT[other], of.RATIO)
        normal, tangential, exact, g = (data[row.path] for row in rows)
        off = np.maximum(np.abs(normal - exact), np.abs(tangential - g * exact))
        return float((off / np.maximum(np.abs(exact), load)).max())

    return measure


def _exponents(data: dict[str, Any], _: float) -> float | None:
    pairs = (of.FITTED_ALPHA, of.ALPHA), (of.FITTED_BETA, of.BETA)
    return _worst(np.abs([data[fitted.path] - data[local.path] for fitted, local in pairs]))


def largest(row: Quantity, text: str, tolerances: float | None = 1.0, **options: Any) -> Rule:
    """Rule on the largest value of a quantity over all states."""
    return Rule(
        text, (row,), lambda data, _: float(data[row.path].max()), tolerances=tolerances, **options
    )  # fmt: skip


def _estimate(row: Quantity, what: str, own_pressure: bool = True) -> Rule:
    return largest(row, f"estimated error of {what}, relative", own_pressure=own_pressure)


#: Name of the rule that applies to every quantity.
FINITE = "finite"

#: Balance of nodal forces; its limit, relative to N, holds at every tolerance.
BALANCE = Rule(
    "nodal forces against the load, over N",
    (of.NORMAL_FORCE, of.TANGENTIAL_FORCE, of.RATIO), _imbalance, limit=1e-9,
)  # fmt: skip

#: The integral equation in texts of rules.
_SIE = " against the integral equation"


def _both(
    name: str, measure: Callable[..., float | None], text: str, *rows: _Rows,
    over_layers: str = "", **options: Any,
) -> dict[str, Rule]:  # fmt: skip
    """Rules by name against the closed form, and over layers against the integral equation.

    Args:
        name: of the first; the other's goes on with "over layers".
        measure, rows, options: see :func:`against`.
        text: meaning of the figure in words; braces stand for the integral equation.
        over_layers: that of the other rule, where it is another.
    """
    return {
        name: against(CLOSED_FORM, measure, text.format(""), *rows, **options),
        f"{name} over layers": against(
            SIE, measure, (over_layers or text).format(_SIE), *rows, **options
        ),
    }


#: Rules by the name that quantities give, in the order in which they are reported.
RULES: Registry[Rule] = Registry(
    "rule of comparison",
    {
        "force balance": BALANCE,
        **{
            f"resultant{name}": Rule(
                f"nodal forces against the resultant of the pressure{name}, over it or N",
                (of.NORMAL_FORCE, of.TANGENTIAL_FORCE, of.RESULTANT[method], of.RATIO),
                _resultant(method), limit=BALANCE.limit, own_pressure=True,
            )
            for method, name in ((CLOSED_FORM, ""), (SIE, " over layers"))
        },
        FINITE: Rule(
            "values that are not finite where they have to be: 1 for some",
            (), lambda data, _: 1.0 if not_finite(data) else None, limit=0.0, own_pressure=True,
        ),
        "residual": largest(
            of.RESIDUAL[CLOSED_FORM],
            "residual of the integral equation at the closed form's pressure, relative", None, limit=1e-8,
        ),
        "residual of finite elements": largest(
            of.RESIDUAL[FEM],
            "residual of the integral equation at the finite elements' pressure, relative", 10.0,
        ),
        "residual inside": largest(
            at.RESIDUAL_INSIDE, "stresses inside against line loads and equilibrium, over the largest",
            None, limit=1e-8, own_pressure=True,
        ),
        **_both("K_I", _intensities, "K_I at both ends{}, relative", of.K_I_LEFT, of.K_I_RIGHT),
        "estimate": _estimate(of.ESTIMATE[FEM], "K_I and moments", False),
        **_both("resultant_ratio", _over(np.ones_like),
                "resultant of σ_XY over that of σ_YY{}, absolute", of.RESULTANT_RATIO),
        **_both("pressure_centre", _over(np.ones_like), "centre of pressure{}, over a",
                of.PRESSURE_CENTRE),
        "sigma_YY over layers": against(
            SIE, _pressure, f"σ_YY{_SIE}, relative to itself or a tenth of the mean",
            at.PRESSURE, beside=(at.SURFACE_X,),
        ),
        "estimate of the integral equation": _estimate(
            of.ESTIMATE[SIE], "the integral equation", False
        ),
        "stresses at interfaces": against(
            SIE, _over(stresses.of_interfaces),
            f"stresses at interfaces{_SIE}, over the largest along each",
            on_layers.INTERFACES, own_pressure=True,
        ),
        **{
            f"estimate at interfaces, {method}": _estimate(
                on_layers.ESTIMATE_AT_INTERFACES[method], f"stresses at interfaces by {name}"
            )
            for method, name in ((FEM, "finite elements"), (SIE, "the integral equation"))
        },
        "estimate of sigma_XX, sie": _estimate(
            at.ESTIMATE_IN_PLANE[SIE], "σ_XX of the integral equation"
        ),
        "estimate inside, sie": _estimate(
            at.ESTIMATE_INSIDE[SIE], "stresses inside of the integral equation"
        ),
        **_both("ends", _over(lambda exact: exact[0]), "ends of the contact{}, over its half-width",
                of.HALF_WIDTH, of.CENTRE),
        **_both("largest pressure", _relative, "largest contact pressure{}, relative", of.LARGEST),
        "exponents": Rule(
            "fitted edge exponents, absolute",
            (of.FITTED_ALPHA, of.FITTED_BETA, of.ALPHA, of.BETA), _exponents,
        ),
        "tension": pull("", validity.TENSION[FEM], _PRESS, 0.0),
        "tension, sie": pull(", by the integral equation", validity.TENSION[SIE], _PRESS),
        "tension, closed form": pull(", in closed form", validity.TENSION[CLOSED_FORM], _PRESS),
        # Under a prescribed pressure there is no raw one, and nothing to compare.
        "sigma_YY": against(
            CLOSED_FORM, _pressure, "σ_YY pointwise, relative",
            at.PRESSURE, beside=(at.RAW_PRESSURE, at.SURFACE_X),
        ),
        # For free ends, where no exponent is assumed; at a sharp edge sigma_YY is the stricter rule.
        **_both(
            "sigma_YY of found ends", _pressure_between_free_ends,
            "σ_YY of contacts with free ends, over the largest further than 0.02 a from a tip",
            at.PRESSURE, of.LARGEST, beside=(at.SURFACE_X,), tolerances=10.0,
            over_layers="σ_YY of contacts with free ends{}, over the largest",
        ),
        **_both(
            "sigma_XX", _in_plane, "σ_XX pointwise, relative to itself or the largest",
            at.IN_PLANE, beside=(at.SURFACE_X,), own_pressure=True,
            over_layers="σ_XX{}, relative to itself or the largest",
        ),
        **_both(
            "extremes of sigma_XX", _over(lambda exact: np.abs(exact).max(axis=0)),
            "highest and lowest σ_XX{}, over the larger of them",
            at.HIGHEST, at.LOWEST, own_pressure=True,
        ),
        "estimate of sigma_XX": _estimate(at.ESTIMATE_IN_PLANE[FEM], "σ_XX"),
        **_both("stresses inside", _inside, "stresses inside{}, relative to themselves or the largest",
                at.STRESSES_INSIDE, beside=(at.INSIDE_X, at.INSIDE_Y), own_pressure=True),
        **_both(
            "stresses in the punch", _inside,
            "stresses in the elastic punch{}, relative to themselves or the largest",
            {method: of_all[:3] for method, of_all in at.STRESSES_IN_PUNCH.items()},
            beside=(at.INSIDE_X, at.INSIDE_Y),
        ),
        "estimate inside": _estimate(at.ESTIMATE_INSIDE[FEM], "stresses inside"),
        "largest stresses": against(
            CLOSED_FORM, _relative, "largest von Mises and shear stress, relative",
            to.VON_MISES, to.SHEAR, own_pressure=True,
        ),
        **_both("largest stresses of the punch", _relative,
                "largest von Mises stress of the elastic punch{}, relative", to.PUNCH_VON_MISES),
        "largest stresses over layers": against(
            SIE, _relative_everywhere, f"largest von Mises stress{_SIE}, relative", to.VON_MISES
        ),
        "largest shear": against(SIE, _relative, f"largest shear stress{_SIE}, relative", to.SHEAR),
        "largest stresses of layers": against(
            SIE, _relative_everywhere, f"largest von Mises stress of each layer{_SIE}, relative",
            to.OF_LAYERS,
        ),
        "yielded zone": against(
            CLOSED_FORM, _yielded_zone,
            "distance from the edges within which yield is passed, as a stress, relative",
            to.REACH_LEFT, to.REACH_RIGHT, beside=(of.ALPHA, of.BETA),
        ),
        **_both("depth of yield", _depth, "depth of the yielded zone{}, as a stress, relative",
                to.DEPTH, own_pressure=True),
        "estimate of yield": _estimate(to.ESTIMATE_YIELD, "stresses from which yield is computed"),
        # In the traction mode v,X under the punch has to vanish. It is a derivative of the displacement,
        # with about half the digits of the moments to which the tolerance refers.
        "slope under the punch": largest(
            of.SLOPE, "v,X under the punch over that beside it", 10.0, mode="traction"
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


def checked(data: Mapping[str, Any], attributes: Mapping[str, Any]) -> str:
    """Quality of checked numbers in one line: the worst of all figures of a kind.

    Args:
        data: datasets by path; those of motions in time say up to when two methods compute them.
        attributes: attributes of the archive's root.
    """
    figures = judged(attributes)
    agree, line_loads = "two methods agree to", "stresses inside against line loads"
    kinds: dict[str, list[float]] = {
        kind: [] for kind in (agree, "estimated error", "residual", line_loads)
    }
    by_text = {rule.text: rule for rule in RULES.values()}
    for text, (value, _) in figures.items():
        kind = next((kind for kind in kinds if text.startswith(kind)), "")
        if text in by_text and len({row.method for row in by_text[text].needs} - {""}) > 1:
            kind = agree
        if kind:
            kinds[kind].append(value)
    limits = [limit for text, (_, limit) in figures.items() if "nodal forces" not in text]
    parts = [f"{kind} {max(values):.0e}" for kind, values in kinds.items() if values]
    if not parts and not any(f"/{method}/" in path for method in METHODS for path in data):
        return "numbers not checked: friction alone, by its law"
    if not parts:
        return "numbers not checked: one method alone, and nothing to compare it with"
    usual = max(set(limits), key=limits.count)
    line = f"numbers checked: {', '.join(parts)}, wanted {usual:.0e} (dimensionless)"
    paths = [row.path for row in (in_time.TIMES, in_time.V0[SIE], in_time.V0[FEM])]
    if any(path not in data for path in paths):
        return line
    t, sie = (np.asarray(data[path]) for path in paths[:2])
    solved = np.isfinite(sie).all(axis=0)
    if solved.all():
        return line
    return (
        f"{line}; motions in time by two methods only to t = {t[solved].max(initial=0.0):.6g} a/c_s, "
        "where the punch turns round, and later by finite elements alone"
    )


def failed(data: Mapping[str, Any], attributes: Mapping[str, Any]) -> list[str]:
    """Failures: by how much, where, and what to do; none for another verdict than FAIL.

    Args:
        data: datasets by path; where stresses along the surface are not among them, no state is named.
        attributes: attributes of the archive's root.
    """
    if attributes["verdict"] != "FAIL":
        return []
    lines, figures = [], judged(attributes)
    over = {text: pair for text, pair in figures.items() if not pair[0] <= pair[1]}
    for text, (value, limit) in sorted(over.items(), key=lambda item: -item[1][0] / (item[1][1] or 1.0)):
        times = f", {value / limit:.3g} times what is wanted, {limit:g}" if limit else ""
        lines.append(f"{text}: {value:.3g}{times}{_worst_state(text, data, attributes)}")
    lines += [r for r in json.loads(attributes["verdict_reasons"]) if r.startswith("not solved")]
    rules = {rule.text: rule for rule in RULES.values() if rule.text in over}
    remedies = dict.fromkeys(rule.remedy for rule in rules.values() if rule.remedy)
    lines += [f"what to do: {remedy}" for remedy in remedies]
    # Tolerances that are wanted, and that would be enough, of figures whose limits follow the tolerance.
    shares = {text: of.tolerances for text, of in rules.items() if of.tolerances and not of.remedy}
    needed, enough = ([over[text][i] / share for text, share in shares.items()] for i in (1, 0))
    if needed:
        lines.append(f"what to do: {_finer(min(needed), data, attributes)}")
        loosest = 10.0 ** np.ceil(np.log10(max(enough)))
        most = 1e-2 if in_time.TIMES.path in data else 0.1  # that a scene may have
        if len(needed) == len(over) and loosest <= most:
            lines[-1] += f"; {loosest:.0e} accepts it"
    elif over and not remedies:
        lines.append("no solve.tolerance changes this: it has a limit of its own")
    return lines


def _finer(needed: float, data: Mapping[str, Any], attributes: Mapping[str, Any]) -> str:
    """Change of a scene that may make an error smaller than its tolerance does, in words."""
    solve = tomllib.loads(str(data.get(runs.SCENE.path, ""))).get("solve", {})
    for key in ("degree", "mesh"):
        if key in solve and solve[key] != "confocal":
            return f"leave solve.{key} away, and finite elements follow the tolerance"
    if in_time.DIRECTION.path in data and np.ptp(data[in_time.DIRECTION.path], axis=-1).any():
        return "a time.end before the punch turns round; behind a turn finer steps hardly help"
    warnings = attributes.get("warnings", "")
    if "would remain on any cells" in warnings or "the outer boundary of" in warnings:
        return "no finer solve.tolerance helps, as finite elements have no more digits here"
    return f"--set solve.tolerance={needed / 10.0:.0e} may pass"


def _worst_state(text: str, data: Mapping[str, Any], attributes: Mapping[str, Any]) -> str:
    """State in which a comparison has its largest figure, in words; "" where that is not known."""
    rule = next((rule for rule in RULES.values() if rule.text == text), None)
    count, load = len(data[of.SPEED.path]), data.get(of.LOAD.path, attributes["load"])
    if rule is None or count < 2 or any(row.path not in data for row in rule.needs):
        return ""
    if not all(STATE in row.over for row in rule.needs if row.method):
        return ""
    rows = table()
    figures = []
    for i in range(count):
        single = {
            path: values[i : i + 1] if path in rows and STATE in rows[path].over else values
            for path, values in data.items()
        }
        figures.append(rule.measure(single, load[i : i + 1] if np.ndim(load) else load) or 0.0)
    i = int(np.nanargmax(figures))
    # Where friction varies along the contact the number of a state is not that of its force.
    varies = preferred(data, of.RESULTANT_RATIO)
    f = "" if varies else f", f = {data[of.FRICTION.path][i]:.4g}"
    return f", in state {i} (c = {data[of.SPEED.path][i]:.4g}{f})"
