"""Panels as charts of plotly, and stresses of all states behind a slider.

What is drawn on paper is drawn on a page by the same panels: hover, zoom and legends are plotly's.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.colors import to_hex
from numpy.typing import NDArray

from galinx.postprocess.quantities.quantity import FEM, METHODS, POINT, STATE
from galinx.postprocess.quantities.stresses import SURFACE_X
from galinx.solvers.contact.edges import under_punch
from galinx.texts import folded, plain

from .choice import Archive
from .render import DOTS, JOINED, LINE, MARKERS, Curve, Panel
from .states import spread
from .stresses import SHOWN, Fields, has_map, limits, place_of, position_name, surface_stresses

#: Most numbers of all states along the surface, and in maps: pages stay below 6 MB.
_NUMBERS = 80_000
#: Characters of a line along a chart's height.
_LINE = 34
_MODES = {LINE: "lines", MARKERS: "markers", JOINED: "lines+markers", DOTS: "markers"}
_SYMBOLS = {"o": "circle-open", "s": "square-open", "^": "triangle-up-open", "D": "diamond-open",
            "x": "x", "_": "line-ew-open", ".": "circle"}  # fmt: skip
_DASHES = {"-": "solid", "--": "dash", ":": "dot", "none": "solid"}


def charts(panels: Sequence[Panel]) -> list[dict[str, Any]]:
    """Panels of curves as charts of plotly, {data, layout} each; none for maps."""
    return [_chart(panel) for panel in panels if panel.curves and not panel.map]


def _chart(panel: Panel) -> dict[str, Any]:
    unit = f" ({panel.unit})" if panel.unit else ""
    traces = [_trace(curve) for curve in panel.curves]
    layout: dict[str, Any] = {
        "title": {"text": plain(panel.title)} if panel.title else {},
        "xaxis": _axis(plain(panel.x or ""), panel.xlim, "x" in panel.log),
        "yaxis": _axis(_lines(plain(panel.y or "") + unit), panel.ylim, "y" in panel.log),
        "shapes": [_band(*ends) for ends in panel.bands],
    }
    layout["shapes"] += [_line("x", x) for x in panel.at_x] + [_line("y", y) for y in panel.at_y]
    return {"data": traces, "layout": layout}


def _trace(curve: Curve) -> dict[str, Any]:
    line = curve.look.line
    dash = line if isinstance(line, str) else ",".join(f"{2.0 * part:g}px" for part in line[1])
    return {
        "x": numbers(curve.x), "y": numbers(curve.y), "mode": _MODES[curve.form],
        "name": plain(curve.label) or METHODS[FEM] * (curve.form == MARKERS),
        "showlegend": bool(curve.label),
        "line": {"color": to_hex(curve.look.colour), "width": 1.6 * curve.width,
                 "dash": _DASHES.get(dash, dash)},
        "marker": {"color": to_hex(curve.look.colour), "size": 3 if curve.form == DOTS else 6,
                   "symbol": _SYMBOLS.get(curve.look.marker, "circle-open")},
    }  # fmt: skip


def _axis(title: str, ends: tuple[float, float] | None, logarithmic: bool) -> dict[str, Any]:
    axis: dict[str, Any] = {"title": {"text": title}}
    if logarithmic:
        axis["type"] = "log"
    elif ends:
        axis["range"] = [float(f"{end:.6g}") for end in ends]
    return axis


def _lines(title: str) -> str:
    """Title of a vertical axis, in lines that are no longer than a chart is high."""
    return folded(title, _LINE).replace("\n", "<br>")


def _band(low: float, high: float) -> dict[str, Any]:
    return {"type": "rect", "yref": "paper", "x0": low, "x1": high, "y0": 0, "y1": 1, "layer": "below",
            "line": {"width": 0}, "fillcolor": "rgba(128,128,128,0.13)"}  # fmt: skip


def _line(axis: str, at: float) -> dict[str, Any]:
    other = "y" if axis == "x" else "x"
    return {"type": "line", f"{other}ref": "paper", f"{axis}0": at, f"{axis}1": at, f"{other}0": 0,
            f"{other}1": 1, "layer": "below", "line": {"width": 1, "color": "#999"}}  # fmt: skip


def numbers(values: Any, digits: int = 5) -> list[Any]:
    """Numbers with so many digits, None for those that are none."""
    flat = np.asarray(values, dtype=float).tolist()
    return [float(f"{value:.{digits}g}") if np.isfinite(value) else None for value in flat]


def explorer(of: Archive) -> dict[str, Any] | None:
    """Stresses of states behind a slider, along the surface and below it; None where there are none.

    Returns:
        ``states``: their labels; ``surface``: a chart for each stress with its curves by state and
        method, whose positions are ``place`` over ``X``; ``maps``: the grid and the values by stress and
        state.
    """
    on_surface, below = bool(of.by_method(STATE, POINT)), has_map(of)
    if not on_surface and not below:
        return None
    labels, sizes = of.labels, [1]
    if on_surface:
        stresses = surface_stresses(of)
        sizes.append(len(of.data[SURFACE_X.path]) * sum(map(len, stresses.values())))
    if below:
        fields = Fields(of)
        names = [name for name in ("von_mises", *SHOWN) if name in fields.names]
        sizes.append(len(names) * fields.grid()[0].size * fields.grid()[1].size)
    shown = spread(labels.all.tolist(), max(1, _NUMBERS // max(sizes)))
    varied = labels.varied()
    made: dict[str, Any] = {
        "states": [f"state {i}{': ' * bool(varied)}{labels.text(i, varied)}" for i in shown],
        "place": [[float(f"{z:.9g}") for z in place_of(of, i)] for i in shown],
        "x": plain(position_name(of)), "of": len(labels.all), "surface": [], "maps": None,
    }  # fmt: skip
    if on_surface:
        X = of.data[SURFACE_X.path]
        order = np.argsort(X, kind="stable")
        edge = np.flatnonzero(np.diff(under_punch(X[order]).astype(int))) + 1
        made["X"] = numbers(np.insert(X[order], edge, np.nan), 9)
        for label, values in stresses.items():
            drawn = next(iter(values.values()))[shown]
            made["surface"].append({
                "label": _lines(plain(label)), "range": numbers(limits(X, drawn)),
                "curves": {
                    METHODS[method]: [numbers(np.insert(y[i][order], edge, np.nan)) for i in shown]
                    for method, y in values.items()
                },
            })  # fmt: skip
    if below:
        X, Y = fields.grid()
        method = fields.methods[0]
        made["maps"] = {
            "X": numbers(X), "Y": numbers(Y), "depth": plain(position_name(of, "")).replace("X", "Y"),
            "stresses": [_map(fields, name, method, shown) for name in names],
        }  # fmt: skip
    return made


def _map(fields: Fields, name: str, method: str, shown: Sequence[int]) -> dict[str, Any]:
    values: list[NDArray] = [fields.values(name, method, i) for i in shown]
    limit = float(np.quantile(np.abs(values), 0.985)) or 1.0
    return {
        "label": plain(fields.label(name)), "limit": float(f"{limit:.3g}"),
        "signed": name.startswith("sigma"),
        "values": [[numbers(row, 4) for row in of_state] for of_state in values],
    }  # fmt: skip
