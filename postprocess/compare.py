"""How far finite elements and closed form agree, and whether the forces balance."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.contact import from_edge, under_punch


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
        name: short, as archives and tests refer to it.
        text: what the figure says.
        needs: paths of the datasets that are compared.
        measure: the figure (1) from datasets by path and the load N per depth [N/m]; None where there is
            nothing to say.
        limit: largest value of a PASS; None where it is no fixed one.
        tolerances: the same in units of the scene's tolerance.
        mode: of the finite elements in which it is judged; "" for each.
        own_pressure: judged also where the pressure is the user's own.
    """

    name: str
    text: str
    needs: tuple[str, ...]
    measure: Callable[[dict[str, Any], float], float | None]
    limit: float | None = None
    tolerances: float | None = None
    mode: str = ""
    own_pressure: bool = False

    def allowed(self, tolerance: float) -> float | None:
        """Largest value of a PASS; None where the figure is only told."""
        return self.limit if self.tolerances is None else self.tolerances * tolerance


def comparisons(data: dict[str, Any], load: float, rules: Iterable[Rule]) -> list[Comparison]:
    """Every comparison that some states' data allow, those of ``RULES`` first.

    Args:
        data: datasets by path.
        load: N per depth [N/m].
        rules: of the quantities that the data hold.
    """
    found, wanted = [], dict.fromkeys(rules)
    for rule in [*(rule for rule in RULES if rule in wanted), *(r for r in wanted if r not in RULES)]:
        if all(path in data for path in rule.needs):
            value = rule.measure(data, load)
            if value is not None:
                found.append(Comparison(rule.name, rule.text, float(value)))
    return found


def K_I_error(data: dict[str, Any]) -> NDArray[np.float64]:
    """Larger relative error of the two stress intensity factors against the integral equation, (states,)."""
    left, right = (
        data[f"states/fem/K_I_{side}"] / data[f"states/closed_form/K_I_{side}"] - 1.0
        for side in ("left", "right")
    )
    return np.maximum(np.abs(left), np.abs(right))


def _imbalance(data: dict[str, Any], load: float) -> float:
    normal, tangential = (data[f"states/fem/{name}_force"] for name in ("normal", "tangential"))
    off = np.maximum(np.abs(normal / load + 1.0), np.abs(tangential / load + data["states/g"]))
    return off.max()


def _exponents(data: dict[str, Any], _: float) -> float:
    off = [data[f"states/fem/{name}"] - data[f"states/{name}"] for name in ("alpha", "beta")]
    return np.abs(off).max()


def _tension(data: dict[str, Any], _: float) -> float | None:
    """A punch cannot pull; what was computed is not what would happen, and it is not clipped."""
    largest = float(np.nanmax(data["surface/fem/sigma_YY"], initial=0.0))
    return largest if largest > 0.0 else None


def _both(data: dict[str, Any], path: str, where: NDArray) -> tuple[NDArray, NDArray]:
    fem, exact = (data[f"surface/{method}/{path}"][:, where] for method in ("fem", "closed_form"))
    return fem, exact


def _pressure(data: dict[str, Any], _: float) -> float:
    X = data["surface/X_over_a"]
    fem, exact = _both(data, "sigma_YY", under_punch(X) & (from_edge(X) >= 1e-4))
    return np.abs(fem / exact - 1.0).max()


def _in_plane(data: dict[str, Any], _: float) -> float:
    fem, exact = _both(data, "sigma_XX", from_edge(data["surface/X_over_a"]) >= 1e-2)
    return (np.abs(fem - exact).max(axis=1) / np.abs(exact).max(axis=1)).max()


_INSIDE = tuple(
    tuple(f"interior/{method}/sigma_{ij}" for ij in ("XX", "YY", "XY"))
    for method in ("fem", "closed_form")
)


def _inside(data: dict[str, Any], _: float) -> float:
    fem, exact = (np.array([data[path] for path in paths]) for paths in _INSIDE)
    return (np.abs(fem - exact).max(axis=(0, 2)) / np.abs(exact).max(axis=(0, 2))).max()


_FORCES = ("states/fem/normal_force", "states/fem/tangential_force")
_INTENSITIES = tuple(
    f"states/{method}/K_I_{side}" for method in ("fem", "closed_form") for side in ("left", "right")
)
_SURFACES = ("surface/fem/sigma_XX", "surface/closed_form/sigma_XX", "surface/X_over_a")

#: A balance of nodal forces further off than its limit, over N, is a fault whatever the tolerance.
BALANCE = Rule(
    "force balance",
    "nodal forces against the load, over N",
    (*_FORCES, "states/g"),
    _imbalance,
    limit=1e-9,
)
K_I = Rule("K_I", "K_I at both ends, relative", _INTENSITIES,
           lambda data, _: K_I_error(data).max(), tolerances=1.0)  # fmt: skip
ESTIMATE = Rule("estimate", "estimated error of K_I and moments, relative", ("states/fem/estimate",),
                lambda data, _: data["states/fem/estimate"].max(), tolerances=1.0)  # fmt: skip
EXPONENTS = Rule("exponents", "fitted edge exponents, absolute",
                 ("states/fem/alpha", "states/fem/beta", "states/alpha", "states/beta"),
                 _exponents)  # fmt: skip
TENSION = Rule("tension", "tension under the punch, over N/(2a)", ("surface/fem/sigma_YY",), _tension,
               limit=0.0, own_pressure=True)  # fmt: skip
#: Where the pressure was put in there is no raw one, and nothing to compare.
PRESSURE = Rule("sigma_YY", "σ_YY pointwise for 1 - |X/a| >= 1e-4, relative",
                ("surface/fem/sigma_YY_raw", "surface/closed_form/sigma_YY", "surface/X_over_a"),
                _pressure)  # fmt: skip
IN_PLANE = Rule("sigma_XX", "σ_XX for |1 - |X/a|| >= 1e-2, over its largest value there", _SURFACES,
                _in_plane)  # fmt: skip
INSIDE = Rule(
    "stresses inside", "stresses inside, over the largest of a state", sum(_INSIDE, ()), _inside
)
#: In the traction mode v,X under the punch has to vanish; it is a derivative of the displacement and so
#: has about half the digits of the moments that the tolerance speaks of.
SLOPE = Rule("slope under the punch", "v,X under the punch over that beside it",
             ("states/fem/slope_under_punch",), lambda data, _: data["states/fem/slope_under_punch"].max(),
             tolerances=10.0, mode="traction")  # fmt: skip

#: In the order in which they are told.
RULES = (BALANCE, K_I, ESTIMATE, EXPONENTS, TENSION, PRESSURE, IN_PLANE, INSIDE, SLOPE)
