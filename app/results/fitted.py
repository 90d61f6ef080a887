"""A law fitted to measured friction: as a section of a scene, and drawn."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from galinx.app.errors import BadInput
from galinx.app.results.measured import Measured, read
from galinx.app.scene.excerpt import nearest, short
from galinx.app.scene.tables import Rows
from galinx.app.scene.units import to_si
from galinx.app.scene.values import Choice, Number
from galinx.postprocess.figures.fitted import fitted_figure
from galinx.solvers.friction import LAWS
from galinx.solvers.friction.fit import Found, fit, moves
from galinx.solvers.parameters import parameters


def fitted(
    name: str, data: Path, fixed: list[str], started: list[str], speed: str, rows: int
) -> tuple[Measured, Found]:
    """Fit a law to a table.

    Args:
        name: of the law.
        data: the table.
        fixed, started: ``KEY=VALUE`` of parameters that are known, and that the search begins with.
        speed: of a table of slips, with its unit.
        rows: of a law's table.

    Raises:
        BadInput: there is no such law, the table is none, or the law cannot be fitted to it.
    """
    if name not in LAWS:
        raise BadInput(f"friction law {short(name)!r}: there is none{nearest(name, LAWS)}")
    kind, measured = LAWS[name], read(data)
    if measured.timed and speed:
        raise BadInput("--speed: found one, but the table tells the time; leave it away")
    if not measured.timed and kind.depends_on_speed and not speed:
        raise BadInput(f"{kind.about} depends on the speed: give --speed, as in --speed '1 mm/s'")
    try:
        if speed:
            V = Number("m/s")(speed)
            if V <= 0.0:
                raise ValueError(f"--speed: found {V:g} m/s, expected > 0")
            measured = replace(measured, t=measured.t / V)
        way = moves(measured.t, measured.X, kind.depends_on_speed)
        found = fit(kind, way, measured.f, _values(name, fixed), _values(name, started), rows)
    except ValueError as error:
        raise BadInput(f"{data}, {name}: {error}") from None
    return measured, found


def _values(name: str, words: list[str]) -> dict[str, Any]:
    """Parameters by key from ``KEY=VALUE``.

    Raises:
        ValueError: one of them is none.
    """
    known = parameters(LAWS[name])
    found: dict[str, Any] = {}
    for word in words:
        key, equals, text = word.partition("=")
        key = key.strip()
        if not equals or key not in known:
            raise ValueError(f"found {short(word)!r}, expected KEY=VALUE with {', '.join(known)}")
        parameter = known[key]
        try:
            if parameter.options:
                found[key] = Choice(parameter.options)(text.strip())
            elif parameter.columns:
                found[key] = Rows(parameter.columns)(json.loads(text))
            else:
                found[key] = to_si(_number(text), parameter.unit)
                if found[key] not in parameter.range:
                    raise ValueError(f"found {found[key]:g}, expected {parameter.range}")
        except ValueError as error:
            raise ValueError(f"{key}: {error}") from None
    return found


def _number(text: str) -> float | str:
    try:
        return float(text)
    except ValueError:
        return text.strip()


def section(name: str, data: Path, measured: Measured, found: Found) -> str:
    """The section of a scene, with what each number is good for."""
    known, residual = parameters(type(found.law)), found.f - measured.f
    rms = float(np.sqrt(np.nanmean(residual**2)))
    errors = dict(zip(found.names, found.deviations.tolist()))
    lines = [
        f"# Fitted by galinx: {type(found.law).about} to {np.isfinite(residual).sum()} samples",
        f"# of {data.name}; root mean square of the residuals of f: {rms:.3g} (dimensionless);",
        "# ± is one standard deviation",
        "[friction]",
        f"model = {json.dumps(name)}",
    ]
    for key, value in found.values.items():
        unit = known[key].unit
        text = f"{value:.9g} {unit}" if unit else value
        if known[key].columns:
            text = [[float(f"{number:.9g}") for number in row] for row in value]
        elif not unit and not isinstance(value, str):
            text = float(f"{value:.9g}")
        said = _deviation(key, errors, unit or "dimensionless" * (not known[key].options))
        lines.append(f"{key} = {json.dumps(text)}{said}")
    return "\n".join(lines) + "\n"


def _deviation(key: str, errors: dict[str, float], unit: str) -> str:
    """A comment: how far a number may be off, or that it was given."""
    mine = {name: value for name, value in errors.items() if name.partition("[")[0] == key}
    if not mine:
        return f"  # {unit + ', ' if unit else ''}given"
    told = ", ".join("not determined" if np.isnan(value) else f"± {value:.2g}" for value in mine.values())
    return f"  # {unit if key in mine else 'in SI'}, {told}"


def figure(measured: Measured, found: Found) -> Any:
    """Measured and fitted friction, and what lies between."""
    return fitted_figure(measured.t, measured.X, measured.f, found.f, measured.timed)
