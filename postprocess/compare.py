"""How far finite elements and closed form agree, and whether the forces balance."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

#: Names of the comparisons, as archives and tests refer to them.
BALANCE, K_I, ESTIMATE, PRESSURE, IN_PLANE, INSIDE, EXPONENTS, SLOPE, TENSION = (
    "force balance",
    "K_I",
    "estimate",
    "sigma_YY",
    "sigma_XX",
    "stresses inside",
    "exponents",
    "slope under the punch",
    "tension",
)


@dataclass(frozen=True)
class Comparison:
    """One figure of disagreement: its short ``name``, what it says, and the ``value`` (1)."""

    name: str
    text: str
    value: float


def comparisons(data: dict[str, Any], load: float) -> list[Comparison]:
    """Every comparison that an archive's data allow.

    Args:
        data: datasets by path.
        load: N per depth [N/m].
    """
    found = []
    if "states/fem/normal_force" in data:
        normal, tangential = (data[f"states/fem/{name}_force"] for name in ("normal", "tangential"))
        off = np.maximum(np.abs(normal / load + 1.0), np.abs(tangential / load + data["states/g"]))
        found.append(Comparison(BALANCE, "nodal forces against the load, over N", off.max()))
    if "states/fem/K_I_left" in data and "states/closed_form/K_I" in data:
        found.append(Comparison(K_I, "K_I at both ends, relative", K_I_error(data).max()))
    if "states/fem/estimate" in data:
        text = "estimated error of K_I and moments, relative"
        found.append(Comparison(ESTIMATE, text, data["states/fem/estimate"].max()))
    if "states/fem/alpha" in data:
        off = [data[f"states/fem/{name}"] - data[f"states/{name}"] for name in ("alpha", "beta")]
        found.append(Comparison(EXPONENTS, "fitted edge exponents, absolute", np.abs(off).max()))
    if "surface/fem/sigma_YY" in data and np.nanmax(data["surface/fem/sigma_YY"], initial=0.0) > 0.0:
        # A punch cannot pull; what was computed is not what would happen, and it is not clipped.
        value = float(np.nanmax(data["surface/fem/sigma_YY"]))
        found.append(Comparison(TENSION, "tension under the punch, over N/(2a)", value))
    if "surface/fem/sigma_XX" in data and "surface/closed_form/sigma_XX" in data:
        found += _on_surface(data)
    if "interior/fem/sigma_XX" in data and "interior/closed_form/sigma_XX" in data:
        fem, exact = (
            np.array([data[f"interior/{method}/sigma_{ij}"] for ij in ("XX", "YY", "XY")])
            for method in ("fem", "closed_form")
        )
        error = np.abs(fem - exact).max(axis=(0, 2)) / np.abs(exact).max(axis=(0, 2))
        text = "stresses inside, over the largest of a state"
        found.append(Comparison(INSIDE, text, error.max()))
    if "states/fem/slope_under_punch" in data:
        value = data["states/fem/slope_under_punch"].max()
        found.append(Comparison(SLOPE, "v,X under the punch over that beside it", value))
    return found


def K_I_error(data: dict[str, Any]) -> NDArray[np.float64]:
    """Larger relative error of the two stress intensity factors against the closed form, (states,)."""
    exact = data["states/closed_form/K_I"]
    left, right = (data[f"states/fem/K_I_{side}"] / exact - 1.0 for side in ("left", "right"))
    return np.maximum(np.abs(left), np.abs(right))


def _on_surface(data: dict[str, Any]) -> list[Comparison]:
    X = np.abs(data["surface/X_over_a"])
    found = []
    if "surface/fem/sigma_YY_raw" in data:  # elsewhere the pressure was put in
        inside = 1.0 - X >= 1e-4
        fem, exact = (data[f"surface/{m}/sigma_YY"][:, inside] for m in ("fem", "closed_form"))
        text = "σ_YY pointwise for 1 - |X/a| >= 1e-4, relative"
        found.append(Comparison(PRESSURE, text, np.abs(fem / exact - 1.0).max()))
    off_edges = np.abs(1.0 - X) >= 1e-2
    fem, exact = (data[f"surface/{m}/sigma_XX"][:, off_edges] for m in ("fem", "closed_form"))
    error = np.abs(fem - exact).max(axis=1) / np.abs(exact).max(axis=1)
    text = "σ_XX for |1 - |X/a|| >= 1e-2, over its largest value there"
    return [*found, Comparison(IN_PLANE, text, error.max())]
