"""Run a scene: plan, compute, judge, archive."""

import json
from collections.abc import Callable
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np

from app import __version__
from app.errors import BadInput, MachineFailure
from app.plan import Plan, has_closed_form, lines, make_plan, surface_grid
from app.scene import Scene
from app.states import States, enumerate_states, solid_of
from postprocess import compare
from solvers.materials import MovingFrame
from solvers.sie.closed_form import FlatPunch

#: A balance of nodal forces further off than this, over N, is a fault whatever the tolerance.
BALANCE_LIMIT = 1e-9

#: In the traction mode v,X under the punch has to vanish; it is a derivative of the displacement and
#: so has about half the digits of the moments that the tolerance speaks of.
SLOPE_FACTOR = 10.0


def compute(
    scene: Scene, progress: Callable[[str], None] = lambda text: None
) -> tuple[dict[str, Any], dict[str, Any]]:
    """Compute what a scene asks for.

    Under MPI this is collective, and every rank returns the same.

    Returns:
        The archive's datasets by path, and its root attributes (verdict among them).

    Raises:
        BadInput: the scene asks for what has no answer.
    """
    plan = make_plan(scene)
    states = enumerate_states(scene)
    seconds: dict[str, float] = {}
    data: dict[str, Any] = {"scene/text": scene.text}
    for name in ("motion", "X_over_L", "c", "mu_c", "sigma0_over_load", "delta", "f", "g"):
        data[f"states/{name}"] = getattr(states, name)
    κ = solid_of(scene).κ
    punches = [FlatPunch(MovingFrame(κ, c), g) for c, g in zip(states.c, states.g)]
    data["states/alpha"] = np.array([punch.α for punch in punches])
    data["states/beta"] = np.array([punch.β for punch in punches])
    grid = surface_grid()
    if plan.surface:
        data["surface/X_over_a"] = grid
    if plan.closed_form:
        started = perf_counter()
        data["states/closed_form/K_I"] = np.array([punch.K_I for punch in punches])
        if plan.surface:
            outside = np.abs(grid) > 1.0
            data["surface/closed_form/sigma_YY"] = np.array(
                [np.where(outside, np.nan, punch.σ_YY(grid)) for punch in punches]
            )
            data["surface/closed_form/sigma_XX"] = np.array([punch.σ_XX(grid) for punch in punches])
        seconds["closed form"] = perf_counter() - started
    if plan.fem:
        seconds |= _finite_elements(scene, plan, states, grid, data, progress)
    verdict, reasons = judge(scene, data)
    data |= {
        "run/done": lines(scene, plan),
        "run/skipped": list(plan.skipped),
        "run/steps": list(seconds),
        "run/seconds": np.array(list(seconds.values()), dtype=float),
    }
    attributes = {
        "version": __version__,
        "scene_sha256": scene.sha256,
        "title": scene.title,
        "load": scene.punch.load,
        "verdict": verdict,
        "verdict_reasons": json.dumps(reasons, ensure_ascii=False),
        "warnings": json.dumps(plan.warnings, ensure_ascii=False),
    }
    return data, attributes


def _finite_elements(
    scene: Scene,
    plan: Plan,
    states: States,
    grid: np.ndarray,
    data: dict[str, Any],
    progress: Callable[[str], None],
) -> dict[str, float]:
    """Add the finite element datasets; returns the wall times."""
    started = perf_counter()
    try:
        from app import finite_elements
    except ImportError as error:
        raise MachineFailure(
            f"finite elements need {error.name}, which is not installed; "
            "run ./run.sh once, it installs what is missing"
        ) from error
    imports = perf_counter() - started
    results = finite_elements.solve(scene, plan, states, grid, progress)
    N, μ = scene.punch.load, solid_of(scene).μ
    fem: dict[str, Any] = {
        "normal_force": results.forces[:, 0] * N,
        "tangential_force": results.forces[:, 1] * N,
    }
    if scene.solve.mode == "contact":
        fem |= {
            "K_I_left": results.K_I[:, 0],
            "K_I_right": results.K_I[:, 1],
            "alpha": results.exponents[:, 0],
            "beta": results.exponents[:, 1],
            "v0": results.v0 * N / (2.0 * μ),
        }
    if plan.surface:
        fem["slope_under_punch"] = results.slope
        data["surface/fem/sigma_YY"] = results.σ_YY
        data["surface/fem/sigma_XX"] = results.σ_XX
        if scene.solve.mode == "contact":
            data["surface/fem/sigma_YY_raw"] = results.σ_YY_raw
    data |= {f"states/fem/{name}": value for name, value in fem.items()}
    data["run/fem/c"] = np.array([speed.c for speed in plan.speeds])
    data |= {f"run/fem/{name}": value for name, value in results.counts.items()}
    return {"import of dolfinx": imports, **results.seconds}


def judge(scene: Scene, data: dict[str, Any]) -> tuple[str, list[str]]:
    """PASS or FAIL, with the figures; ``not judged`` where there is nothing to compare."""
    tolerance = scene.solve.tolerance
    limits = {compare.BALANCE: BALANCE_LIMIT, compare.K_I: tolerance}
    if scene.solve.mode == "traction":
        limits[compare.SLOPE] = SLOPE_FACTOR * tolerance
    if not has_closed_form(scene):
        limits = {}
    judged = [c for c in compare.comparisons(data, scene.punch.load) if c.name in limits]
    if not judged:
        return "not judged", []
    good = all(c.value <= limits[c.name] for c in judged)  # also fails on NaN
    reasons = [f"{c.text}: {c.value:.1e}, at most {limits[c.name]:g}" for c in judged]
    return "PASS" if good else "FAIL", reasons


def check_output(path: Path, overwrite: bool) -> None:
    """Refuse an output that exists or cannot be written, before any work is done."""
    if path.is_dir():
        raise BadInput(f"{path} is a folder, expected a file name for the archive")
    if path.exists() and not overwrite:
        raise BadInput(f"{path} exists; name another file with -o, or add --overwrite")
    if not path.parent.is_dir():
        raise BadInput(f"the folder {path.parent} does not exist; make it, or choose another with -o")
