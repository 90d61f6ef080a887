"""The report of an archive: one HTML page that needs nothing else.

The verdict and a row of results for every state come first, then charts of stresses with a slider over
the states, then the other figures. What is drawn on paper is drawn on a page by the same panels: hover,
zoom and legends are those of plotly, which the page holds once.
"""

import json
import re
from base64 import b64encode
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from functools import cache
from gzip import compress
from pathlib import Path
from typing import Any
from unicodedata import normalize

import numpy as np
from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup, escape
from plotly.offline import get_plotlyjs

from galinx.postprocess.compare import checked, failed
from galinx.postprocess.quantities import runs, states
from galinx.postprocess.quantities.quantity import FEM, METHODS
from galinx.postprocess.quantities.swept import WAVE_SPEED
from galinx.postprocess.tables import BESIDE, Sheet, shared, sheets, solved_speeds, state_columns
from galinx.postprocess.units import Units, engineering
from galinx.texts import counted, folded, plain

from ..console import program
from ..figures.choice import Archive, Choice, Drawing, spread
from ..figures.files import content, embedded
from ..figures.render import DOTS, JOINED, LINE, MARKERS, Curve, Panel, point_along
from ..figures.stresses import SHOWN, Fields, map_names, stresses_along, surface_panels
from ..plan.plan import by_reason
from ..scene.scene import Scene
from ..study.published import has_study_digits, intensity_sheets

#: Width of tables of few states in characters: the states stand side by side.
_WIDE = 100
#: Most cells of the table, and most numbers of all states in one chart: a page stays below 6 MB.
_CELLS, _NUMBERS = 60_000, 60_000

#: Names of stresses, factors and coefficients, as archives, verdicts and figures write them.
_INDEXED = re.compile(r"\b(K|N|F|P|c|v|μ|σ|sigma|τ|κ|δ)_([A-Za-z0-9]{1,3})\b")
#: A symbol with an index, which the choice of a form cannot typeset.
_SYMBOL = re.compile(r" \w_\w+")
#: Powers of ten as numbers in programs and as plain text write them.
_POWER = re.compile(r"(?<![\w.])(-?\d(?:\.\d+)?)e([+-]\d+)\b")
_RAISED = re.compile(" × 10([⁻⁰¹²³⁴-⁹]+)")
#: Exponents, as in m^(-β), and signs of numbers.
_EXPONENT, _NEGATIVE = re.compile(r"\^\(([^()]*)\)"), re.compile(r"(?<![\w.)\]}-])-(?=[\dσ]|a\b)")


def markup(text: str) -> Markup:
    """Markup of a text with its symbols set: K_I, σ_XX, ``$\\mu_C$`` and 4.8e-07 with indices and powers.

    Whatever else the text holds is escaped.
    """

    def power(digits: str) -> str:
        return f"&#8239;×&#8239;10<sup>{digits}</sup>"

    page = str(escape(plain(text))).replace("sigma_", "σ_")
    page = _RAISED.sub(lambda match: power(normalize("NFKC", match[1])), page)
    page = _EXPONENT.sub(lambda match: f"<sup>{match[1].replace('-', '−')}</sup>", page)
    page = _NEGATIVE.sub("−", page)
    page = _INDEXED.sub(r"<i>\1</i><sub>\2</sub>", page)
    return Markup(_POWER.sub(lambda match: match[1] + power(str(int(match[2])).replace("-", "−")), page))


@cache
def _plotly() -> str:
    """plotly.js, compressed, as text; browsers unpack it."""
    return b64encode(compress(get_plotlyjs().encode(), 6, mtime=0)).decode()


_MODES = {LINE: "lines", MARKERS: "markers", JOINED: "lines+markers", DOTS: "markers"}
_SYMBOLS = {"o": "circle-open", "s": "square-open", "^": "triangle-up-open", "D": "diamond-open",
            "x": "x", "_": "line-ew-open", ".": "circle"}  # fmt: skip
_DASHES = {"-": "solid", "--": "dash", ":": "dot", "none": "solid"}


def chart(panel: Panel) -> dict[str, Any]:
    """Panel as a chart of plotly: its data and its layout."""
    unit, shown = f" ({panel.unit})" if panel.unit else "", panel.map
    data = [_trace(curve) for curve in panel.curves]
    layout: dict[str, Any] = {
        "title": {"text": _label(panel.title)} if panel.title else {},
        "xaxis": _axis(_label(panel.x or ""), panel.xlim, "x" in panel.log),
        # In lines of 30 letters, which are no longer than a chart is high.
        "yaxis": _axis(_label(folded((panel.y or "") + unit, 30)), panel.ylim, "y" in panel.log),
        "shapes": [_shape("y", "rect", "x", *band) for band in panel.bands]
        + [_shape("y", "line", "x", x, x) for x in panel.at_x]
        + [_shape("x", "line", "y", y, y) for y in panel.at_y],
    }
    if arrows := [_arrow(panel, curve, share) for curve in panel.curves for share in curve.arrows]:
        layout["annotations"] = arrows
    if panel.whole:
        layout["xaxis"]["dtick"] = 1
    if shown:
        label = _label(shown.label)
        data.append({
            "type": "heatmap", "x": _numbers(shown.X), "y": _numbers(shown.Y), "zsmooth": "best",
            "z": [_numbers(row, 4) for row in shown.values], "zmax": float(f"{shown.limit:.3g}"),
            "zmin": -float(f"{shown.limit:.3g}") if shown.signed else 0,
            "colorscale": "RdBu" if shown.signed else "Viridis",
            "colorbar": {"title": {"text": label, "side": "right"}, "thickness": 14},
            "hovertemplate": f"X = %{{x:.4g}}, Y = %{{y:.4g}}<br>%{{z:.4g}}<extra>{label}</extra>",
        })  # fmt: skip
        # As long as the map, however narrow the page is.
        layout["xaxis"] |= {"constrain": "domain"}
        layout["yaxis"] |= {"scaleanchor": "x", "constrain": "domain", "constraintoward": "top"}
    return {"data": data, "layout": layout}


def _label(text: str) -> str:
    """Text of a chart, which knows the markup of indices and lines, from one with formulas in TeX."""
    return str(markup(text)).replace("\n", "<br>")


def _trace(curve: Curve) -> dict[str, Any]:
    dash, colour = curve.look.line, curve.look.colour
    dash = dash if isinstance(dash, str) else ",".join(f"{2.0 * part:g}px" for part in dash[1])
    return {
        "x": _numbers(curve.x, 10), "y": _numbers(curve.y), "mode": _MODES[curve.form],
        "name": _label(curve.label) or METHODS[FEM] * (curve.form == MARKERS),
        "showlegend": bool(curve.label),
        "line": {"color": colour, "width": 1.6 * curve.width, "dash": _DASHES.get(dash, dash)},
        "marker": {"color": colour, "size": 3 if curve.form == DOTS else 6,
                   "symbol": _SYMBOLS.get(curve.look.marker, "circle-open")},
    }  # fmt: skip


def _arrow(panel: Panel, curve: Curve, share: float) -> dict[str, Any]:
    """Arrow along a curve, at a share of its length on the panel's axes."""
    points = np.array([curve.x, curve.y])
    at = point_along(points, share, [*map(np.ptp, (panel.xlim or curve.x, panel.ylim or curve.y))])
    (ax, x), (ay, y) = points[:, [max(at - 2, 0), at + 1]].tolist()  # one step may be too short to see
    return {
        "x": x, "y": y, "ax": ax, "ay": ay, "axref": "x", "ayref": "y", "text": "", "arrowhead": 2,
        "arrowcolor": curve.look.colour, "arrowsize": 1.5,
    }  # fmt: skip


def _axis(title: str, ends: tuple[float, float] | None, logarithmic: bool) -> dict[str, Any]:
    # Powers of ten, for prefixes would stand before units that have some.
    axis: dict[str, Any] = {"title": {"text": title}, "exponentformat": "power"}
    if logarithmic:
        return axis | {"type": "log"}
    return axis | ({"range": _numbers(ends, 6)} if ends else {})


def _shape(across: str, kind: str, axis: str, low: float, high: float) -> dict[str, Any]:
    """Grey line or band all across a chart."""
    return {
        "type": kind, f"{across}ref": "paper", f"{axis}0": low, f"{axis}1": high, f"{across}0": 0,
        f"{across}1": 1, "layer": "below", "fillcolor": "rgba(128,128,128,0.13)",
        "line": {"width": int(kind == "line"), "color": "#999"},
    }  # fmt: skip


def _numbers(values: Any, digits: int = 5) -> list[Any]:
    """Numbers with so many digits, None for those that are none."""
    flat = np.asarray(values, dtype=float).tolist()
    return [float(f"{value:.{digits}g}") if np.isfinite(value) else None for value in flat]


def explorer(of: Archive) -> dict[str, Any] | None:
    """Stresses of states behind a slider, along the surface and below it; None where there are none.

    Returns:
        ``states``: labels in HTML; ``of``: number of all with a solution; ``surface``: for each stress a
        chart a state; ``maps``: name and charts of each stress inside.
    """
    below, surface = map_names(of), stresses_along(of)
    if not surface and not below:
        return None
    fields = Fields(of) if below else None
    inside = fields.X.size * fields.Y.size if fields else 1
    sizes = [inside, *(4 * len(along.X) for along in surface.values())]
    shown = spread(of.selected().tolist(), max(1, _NUMBERS // max(sizes)))
    varied = of.varied()
    made: dict[str, Any] = {
        "states": [str(markup(f"state {i}{': ' * bool(varied)}{of.text(i, varied)}")) for i in shown],
        "of": len(of.selected()), "surface": [], "maps": [],
    }  # fmt: skip
    for along in surface.values():
        label = METHODS[min(along.values, key=lambda method: method == FEM)]  # that of the line
        charts = [chart(panel) for panel in surface_panels(along, shown, label)]
        for trace in (trace for drawn in charts for trace in drawn["data"]):
            trace["showlegend"] = bool(trace["name"])
        made["surface"].append(charts)
    for name in (name for name in ("von_mises", *SHOWN) if name in below):
        assert fields
        charts = [chart(panel) for panel in fields.panels(name, shown)]
        words = _SYMBOL.sub("", plain(fields.label(name)))
        made["maps"].append({"label": words, "charts": charts})
    return made


def summary(data: dict[str, Any], scene: Scene) -> str:
    """Scene and finite elements of an archive, in two sentences with units."""
    count, solid = len(data[states.FRICTION.path]), scene.solid

    def range_of(values: Any) -> str:
        return " to ".join(dict.fromkeys(f"{value:.4g}" for value in (np.min(values), np.max(values))))

    c, c_s = data[states.SPEED.path], data.get(WAVE_SPEED.path, solid.c_s)
    moving, speed = range_of(c), range_of(c * c_s)
    load = " to ".join(
        engineering(N, "N/m") for N in sorted({min(scene.punch.loads), max(scene.punch.loads)})
    )
    kind = "an elastic" if scene.elastic_punch else "a rigid"
    text = (
        f"{count} friction state{'s' * (count > 1)} of {kind} {scene.punch.profile.words()}, load "
        f"{load}, that slides at {speed} m/s, c = {moving} of the shear "
        f"wave speed {range_of(c_s)} m/s, on a half-plane with {solid.words()}."
    )
    if scene.swept:
        text += f" Constants are those of the first state; others differ in {' and '.join(scene.swept)}."
    record = [runs.RECORD[name].path for name in ("cells", "degree", "unknowns")]
    if all(path in data for path in record):
        cells, degree, unknowns = (int(data[path].max()) for path in record)
        mesh = "layered" if scene.layers else scene.solve.mesh
        text += (
            f" Finite elements: {mesh} mesh, {cells} cells of degree up to {degree}, "
            f"{unknowns} unknowns, tolerance {scene.solve.tolerance:g}."
        )
        if solved := solved_speeds(data):
            text += f" {solved.capitalize()}."
    return text


def states_table(data: dict[str, Any], units: Units) -> dict[str, Any]:
    """Table of results, a row a state, with the columns of :func:`state_columns`.

    What is the same in all states of several stands in its note.
    """
    columns, count = state_columns(data, units), len(data[states.FRICTION.path])
    same = shared(columns)
    shown = [column for column in columns if column not in same]
    kept = min(count, _CELLS // (len(shown) + 1))
    heads = [{"head": "state", "name": "state", "csv": "state", "digits": None}] + [
        {"head": c.label, "name": c.name or c.head, "csv": c.label, "digits": c.digits} for c in shown
    ]
    cells = [list(range(kept))]
    for column in shown:
        values = column.shown(kept)
        cells.append(values if isinstance(values[0], str) else _numbers(values, 12))
    note = counted(count, "state")
    if same:
        note += f"; the same in all: {', '.join(f'{c.head} {c.words(0)}' for c in same if c.words(0))}"
    if kept < count:
        note += f"; the first {kept} are here, the command csv writes all"
    return {"columns": heads, "note": f"{note}.", "data": {"columns": heads, "rows": list(zip(*cells))}}


#: Meanings of a report's terms; those that it does not use are left out.
TERMS = (
    ("a, N", "half-width of the contact, and load per unit of depth"),
    ("c", "speed over the shear wave speed of the solid, or of its uppermost layer, dimensionless"),
    ("closed form", "solution of the singular integral equation by formulas; needs no mesh"),
    ("friction f", "friction coefficient: friction force over load, positive in forward motion"),
    ("FM, BM", "forward and backward motion: strokes, numbered"),
    ("K_I", "stress intensity factor: strength of the pressure's singularity at an edge of the punch"),
    ("von Mises", "what a solid in this state of stress bears like a bar under tension; it yields where "
     "that is its yield strength"),
    ("X/L", "place on a stroke over the pre-sliding displacement L, along which friction builds up"),
    ("indentation", "of steady states relative to the surface 100 a away, or 100 times the length over "
     "which layers are seen: in the plane it grows with that distance like a logarithm; of motions in "
     "time since the punch touched, or since steady motion"),
    ("estimate", "error that a method measures alone: finite elements on other degrees, the integral "
     "equation with other numbers of unknowns"),
    ("verdict", "PASS where every comparison and every estimate is within what is allowed; not judged "
     "where there is none, as of friction alone"),
    ("σ_XX, σ_YY, σ_XY", "in-plane, normal and shear stress: X along the motion, Y out of the solid; "
     "tension is positive"),
)  # fmt: skip


def picture(drawing: Drawing, png: bytes | None = None) -> dict[str, Any]:
    """A figure as a page shows it; the figure can be saved elsewhere afterwards.

    Args:
        drawing: which.
        png: its file's bytes; without it curves are charts, and all else is drawn for the page.
    """
    panels: Sequence[Panel] = getattr(drawing.figure, "panels", ())
    charts = [chart(panel) for panel in panels if panel.curves and not panel.map]
    source, width = "", None
    if png is not None and not drawing.pixels:  # as wide as it would be if it were drawn for the page
        source, charts, width = embedded(png), [], round(96.0 * drawing.figure.get_figwidth())
    elif drawing.pixels:
        source, charts = embedded(content(drawing.figure, "png", 160)), []
    elif not charts:
        source = embedded(content(drawing.figure, "svg", transparent=True), "svg+xml")
    return {
        "name": drawing.name, "caption": drawing.caption, "left_out": drawing.left_out,
        "all": drawing.full_caption, "pixels": drawing.pixels, "charts": charts, "source": source,
        "width": width,
    }  # fmt: skip


def page(
    result: Any, drawings: Iterable[Drawing], accuracy: Sequence[Sheet] | None = None,
    dimensionless: bool = False, pixels: Mapping[str, bytes] | None = None,
) -> str:  # fmt: skip
    """A report as HTML.

    Args:
        result: a :class:`galinx.app.results.result.Result`.
        drawings: figures.
        accuracy: tables of accuracy; the published ones where the archive has their states.
        dimensionless: stresses over N/(2a), lengths over a, speeds over c_s.
        pixels: files of figures as PNG by their name, as :func:`picture` takes them.
    """
    data, attributes, scene = result.data, result.attributes, result.scene
    units, seconds = result.units(dimensionless), data[runs.SECONDS.path]
    longest = max(float(seconds.max()), 1e-9)
    large = explorer(Archive(data, scene, Choice(units=units)))
    # Charts with the slider show these.
    covered = {"surface": large and large["surface"], "inside": large and large["maps"]}
    shown = [
        picture(each, (pixels or {}).get(each.name)) for each in drawings if not covered.get(each.name)
    ]
    few = len(data[states.FRICTION.path]) <= BESIDE
    title = "Every state" if few else None  # many have a table of their own, to search
    tables = sheets(data, units, title, _WIDE * few, not scene.steady)
    # The study's tables that the archive has all states of, for the study's solid.
    own = has_study_digits(scene.solid)
    intensities = intensity_sheets(data, scene.body.half_width) if own else []
    versions = {"galinx": attributes["version"], **json.loads(attributes["versions"])}
    parts = {
        "title": attributes["title"] or "A sliding punch",
        "verdict": attributes["verdict"],
        "checked": checked(data, attributes),
        "failed": failed(data, attributes),
        "summary": summary(data, scene),
        "warnings": json.loads(attributes["warnings"]),
        "reasons": json.loads(attributes["verdict_reasons"]),
        "tables": tables,
        "sheets": intensities if accuracy is None else accuracy,
        "states": None if few else states_table(data, units),
        "explorer": large,
        "answers": [each for each in shown if each["name"] not in ("degrees", "mesh")],
        "numerics": [each for each in shown if each["name"] in ("degrees", "mesh")],
        "times": [
            (name, f"{value:.3f}", f"{100.0 * value / longest:.1f}")
            for name, value in zip(data[runs.STEPS.path].tolist(), seconds.tolist())
        ],
        "done": list(Counter(data[runs.DONE.path].tolist()).items()),
        "skipped": by_reason(data[runs.SKIPPED.path].tolist()),
        "versions": f"{', '.join(map(' '.join, versions.items()))}; {attributes['machine']}; "
        + attributes.get("created", "not archived"),
        "scene": data[runs.SCENE.path],
        "program": program(),
    }
    captions = [each["caption"] for each in shown]
    words = str(parts | {"answers": captions, "numerics": "", "explorer": large and "σ_XX, a, c, X/L"})
    terms = [(t, meaning) for t, meaning in TERMS if any(word in words for word in t.split(", "))]
    environment = Environment(
        loader=FileSystemLoader(Path(__file__).parent), autoescape=True, undefined=StrictUndefined
    )
    environment.filters["typeset"] = markup
    template = environment.get_template("page.html")
    return template.render(parts | {"terms": terms, "plotly": _plotly()})
