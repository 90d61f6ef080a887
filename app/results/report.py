"""The report of an archive: one HTML page that needs nothing else.

The verdict and a row of results for every state come first, then one large chart with a slider over the
states, then the other figures. Charts are plotly's, which the page holds once.
"""

import json
from collections import Counter
from typing import Any

import numpy as np

from galinx.postprocess.compare import checked
from galinx.postprocess.page import render
from galinx.postprocess.quantities import runs, states
from galinx.postprocess.tables import (
    BESIDE,
    Sheet,
    limits_sheet,
    solved_speeds,
    starts_sheet,
    state_columns,
    states_sheet,
)
from galinx.postprocess.units import Units, engineering
from galinx.texts import counted

from ..console import program
from ..figures.choice import Archive, Choice, Drawing
from ..figures.files import embedded, in_a_page
from ..figures.interactive import charts, explorer
from ..scene.scene import Scene
from ..study.published import (
    INTENSITIES,
    has_study_digits,
    intensities,
    intensity_rows,
    limit_of_steady_motion,
)

#: Width of tables of few states in characters: the states stand side by side.
_WIDE = 100
#: Most cells of the table: a page stays below 6 MB.
_CELLS = 60_000


def summary(data: dict[str, Any], scene: Scene) -> str:
    """Scene and finite elements of an archive, in two sentences with units."""
    count, c = len(data[states.FRICTION.path]), np.unique(data[states.SPEED.path])
    solid, c_s = scene.solid, scene.solid.c_s
    moving = " to ".join(f"{v:.4g}" for v in sorted({c[0], c[-1]}))
    speed = " to ".join(f"{v * c_s:.4g}" for v in sorted({c[0], c[-1]}))
    ends = sorted({min(scene.punch.loads), max(scene.punch.loads)})
    load = " to ".join(engineering(N, "N/m") for N in ends)
    text = (
        f"{count} friction state{'s' * (count > 1)} of a rigid {scene.punch.profile.words()}, load "
        f"{load}, that slides at {speed} m/s, c = {moving} of the shear "
        f"wave speed {c_s:.4g} m/s, on a half-plane with {solid.words()}."
    )
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
    same = [column for column in columns if column.constant and count > 1 and not column.place]
    shown = [column for column in columns if column not in same]
    kept = min(count, _CELLS // (len(shown) + 1))
    heads: list[dict[str, Any]] = [{"head": "state", "name": "state", "csv": "state", "digits": None}]
    heads += [
        {"head": c.label, "name": c.name or c.head, "csv": c.label, "digits": c.digits} for c in shown
    ]  # fmt: skip
    cells = [list(range(kept)), *([_cell(value) for value in c.values[:kept]] for c in shown)]
    note = counted(count, "state")
    if same:
        note += f"; the same in all: {', '.join(f'{c.head} {c.words(0)}' for c in same if c.words(0))}"
    if kept < count:
        note += f"; the first {kept} are here, the command csv writes all"
    return {"columns": heads, "note": f"{note}.", "data": {"columns": heads, "rows": list(zip(*cells))}}


def _cell(value: Any) -> Any:
    if isinstance(value, str):
        return value
    return float(f"{value:.12g}") if np.isfinite(value) else None


#: Meanings of a report's terms; those that it does not use are left out.
TERMS = (
    ("a, N", "half-width of the contact, and load per unit of depth"),
    ("c", "speed over the shear wave speed of the solid, dimensionless"),
    ("closed form", "solution of the singular integral equation by formulas; needs no mesh"),
    ("friction f", "friction coefficient: friction force over load, positive in forward motion"),
    ("FM, BM", "forward and backward motion: strokes, numbered"),
    ("K_I", "stress intensity factor: strength of the pressure's singularity at an edge of the punch"),
    ("von Mises", "what a solid in this state of stress bears like a bar under tension; it yields where "
     "that is its yield strength"),
    ("X/L", "place on a stroke over the pre-sliding displacement L, along which friction builds up"),
    ("indentation", "relative to the surface 100 a away, or 100 times the length over which layers "
     "are seen: in the plane it grows with that distance like a logarithm"),
    ("estimate", "error of finite elements measured on other degrees, the closed form not used"),
    ("verdict", "PASS where every comparison is within what is allowed; not judged where one method "
     "alone was asked for"),
    ("σ_XX, σ_YY, σ_XY", "in-plane, normal and shear stress: X along the motion, Y out of the solid; "
     "tension is positive"),
)  # fmt: skip


class Report:
    """A report in the making.

    Args:
        data, attributes: datasets by path, and attributes of the root, of an archive.
        scene: of the archive.
        sheets: tables of accuracy; the published ones where the archive has their states.
        dimensionless: stresses over N/(2a), lengths over a, speeds over c_s.
    """

    def __init__(
        self,
        data: dict[str, Any],
        attributes: dict[str, Any],
        scene: Scene,
        sheets: list[Sheet] | None = None,
        dimensionless: bool = False,
    ) -> None:
        self._data, self._attributes, self._scene = data, attributes, scene
        self._sheets = _published(data, scene) if sheets is None else sheets
        self._units = Units(scene.body, data, dimensionless)
        self._pictures: list[dict[str, Any]] = []

    def add(self, drawing: Drawing, png: bytes | None = None) -> None:
        """Add a figure; it can be saved elsewhere afterwards.

        Args:
            drawing: which.
            png: its file's bytes; without it curves are charts, and all else is drawn for the page.
        """
        made = [] if png is not None else charts(getattr(drawing.figure, "panels", ()))
        picture: dict[str, Any] = {
            "caption": drawing.full_caption,
            "charts": (),
            "source": "",
            "width": None,
        }
        picture |= {"pixels": drawing.pixels, "name": drawing.name}
        if made:
            picture["charts"] = made
        elif png is None or drawing.pixels:
            picture |= {"source": in_a_page(drawing.figure, drawing.pixels)}
        else:  # as wide as it would be if it were drawn for the page
            width = round(96.0 * drawing.figure.get_figwidth())
            picture |= {"source": embedded(png), "width": width}
        self._pictures.append(picture)

    def text(self) -> str:
        """The page as HTML."""
        attributes, data, scene = self._attributes, self._data, self._scene
        seconds = data[runs.SECONDS.path]
        longest = max(float(seconds.max()), 1e-9)
        large = explorer(Archive(data, scene, Choice(units=self._units)))
        # The large chart shows these.
        covered = {"surface"} if large and large["surface"] else set()
        covered |= {"inside"} if large and large["maps"] else set()
        pictures = [{**p} for p in self._pictures if p["name"] not in covered]
        made: list[dict[str, Any]] = []
        for picture in pictures:
            first = len(made)
            made += picture["charts"]
            picture["charts"] = range(first, len(made))
        few = len(data[states.FRICTION.path]) <= BESIDE
        tables = [states_sheet(data, self._units, "Every state", _WIDE)] if few else []
        tables += [f(data, self._units, _WIDE * few) for f in (starts_sheet, limits_sheet)]
        content = {
            "title": attributes["title"] or "A sliding punch",
            "verdict": attributes["verdict"],
            "checked": checked(attributes),
            "summary": summary(data, scene),
            "warnings": json.loads(attributes["warnings"]),
            "reasons": json.loads(attributes["verdict_reasons"]),
            "tables": [sheet for sheet in tables if sheet.rows],
            "sheets": self._sheets,
            "states": None if few else states_table(data, self._units),
            "explorer": large,
            "charts": made,
            "pictures": pictures,
            "times": [
                (name, f"{value:.3f}", f"{100.0 * value / longest:.1f}")
                for name, value in zip(data[runs.STEPS.path].tolist(), seconds.tolist())
            ],
            "done": list(Counter(data[runs.DONE.path].tolist()).items()),
            "skipped": data[runs.SKIPPED.path].tolist(),
            "versions": _versions(attributes),
            "scene": data[runs.SCENE.path],
            "program": program(),
        }
        shown = [picture["caption"] for picture in pictures]
        words = str(content | {"pictures": shown, "charts": [], "explorer": large and "σ_XX, a, c, X/L"})
        terms = [(t, meaning) for t, meaning in TERMS if any(word in words for word in t.split(", "))]
        return render(content | {"terms": terms})


def _published(data: dict[str, Any], scene: Scene) -> list[Sheet]:
    """The study's tables that the archive has all states of, for the study's solid."""
    if not has_study_digits(scene.solid):
        return []
    a, rows_by_name = scene.body.half_width, {name: intensity_rows(name, data) for name in INTENSITIES}
    return [
        intensities(name, rows, limit_of_steady_motion(name, data, a))
        for name, rows in rows_by_name.items()
        if rows
    ]


def _versions(attributes: dict[str, Any]) -> str:
    versions = {"galinx": attributes["version"], **json.loads(attributes["versions"])}
    text = ", ".join(f"{name} {version}" for name, version in versions.items())
    return f"{text}; {attributes['machine']}; {attributes.get('created', 'not archived')}"
