"""The report of an archive: one HTML page that needs nothing else."""

import json
from collections import Counter
from typing import Any

from galinx.app.console.program import program
from galinx.app.results.answers import answers, summary
from galinx.app.results.drawings import Drawing
from galinx.app.results.si import scaling
from galinx.app.results.tabulated import curves, states_table
from galinx.app.scene.scene import Scene
from galinx.app.study.published import (
    INTENSITIES,
    intensities,
    intensity_rows,
    like_the_studys,
    limit_of_steady_motion,
)
from galinx.postprocess.figures.canvas import embedded, in_a_page
from galinx.postprocess.page import render
from galinx.postprocess.quantities import runs
from galinx.postprocess.tables import Sheet, starts_sheet

#: What words of a report mean; those that it does not use are left out.
TERMS = (
    ("a, N", "half-width of the punch, and load per unit of depth"),
    ("c", "speed over the shear wave speed of the solid, dimensionless"),
    ("closed form", "solution of the singular integral equation by formulas; needs no mesh"),
    ("f", "friction coefficient: friction force over load, positive in forward motion"),
    ("FM, BM", "forward and backward motion: strokes, numbered"),
    ("K_I", "stress intensity factor: strength of the pressure's singularity at an edge of the punch, "
     "dimensionless by N and a"),
    ("von Mises stress", "what a solid in this state of stress bears like a bar under tension; it yields "
     "where that is its yield strength"),
    ("X/L", "place on a stroke over the pre-sliding displacement L, along which friction builds up"),
    ("v_0", "indentation, relative to the surface 100 a away, or 100 times the length over which layers "
     "are seen: in the plane it grows with that distance like a logarithm"),
    ("estimate", "error of finite elements measured on other degrees, the closed form not used"),
    ("verdict", "PASS where every comparison above is within what is allowed; not judged where one "
     "method alone was asked for"),
    ("σ_XX, σ_YY, σ_XY", "in-plane, normal and shear stress: X along the motion, Y out of the solid; "
     "tension is positive"),
)  # fmt: skip


class Report:
    """A report in the making.

    Args:
        data, attributes: an archive.
        scene: the archive's.
        sheets: tables before that of the states; the published ones where the archive has their states.
        si: are the table of states and the curves in SI?
    """

    def __init__(
        self,
        data: dict[str, Any],
        attributes: dict[str, Any],
        scene: Scene,
        sheets: list[Sheet] | None = None,
        si: bool = False,
    ) -> None:
        self._data, self._attributes, self._scene = data, attributes, scene
        self._sheets = _published(data, scene) if sheets is None else sheets
        self._scaling = scaling(scene if si else None, data)
        self._pictures: list[dict[str, Any]] = []

    def add(self, drawing: Drawing, png: bytes | None = None) -> None:
        """Take a figure in; it can be saved elsewhere afterwards.

        Args:
            drawing: which.
            png: lines as a file's bytes, where there is one already; else they are drawn for the page, as
                maps always are, whose files are large.
        """
        picture = {"caption": drawing.told, "pixels": drawing.pixels, "width": None}
        if png is None or drawing.pixels:
            picture["source"] = in_a_page(drawing.figure, drawing.pixels)
        else:  # as wide as it would be if it were drawn for the page
            picture |= {"source": embedded(png), "width": round(96.0 * drawing.figure.get_figwidth())}
        self._pictures.append(picture)

    def text(self) -> str:
        """The page."""
        attributes, data, scene = self._attributes, self._data, self._scene
        seconds, unit = data[runs.SECONDS.path], attributes["half_width"] / attributes["c_s"]
        longest = max(float(seconds.max()), 1e-9)
        content = {
            "title": attributes["title"] or "A sliding punch",
            "verdict": attributes["verdict"],
            "summary": summary(data, scene),
            "warnings": json.loads(attributes["warnings"]),
            "answers": answers(data, scene),
            "reasons": json.loads(attributes["verdict_reasons"]),
            "starts": [sheet for sheet in (starts_sheet(data, unit),) if sheet.rows],
            "sheets": self._sheets,
            "states": states_table(data, self._scaling),
            "curves": curves(data, self._scaling),
            "pictures": self._pictures,
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
        words = str(content | {"pictures": [picture["caption"] for picture in self._pictures]})
        terms = [(term, told) for term, told in TERMS if any(word in words for word in term.split(", "))]
        return render(content | {"terms": terms})


def _published(data: dict[str, Any], scene: Scene) -> list[Sheet]:
    """The study's tables that the archive has all states of, for the study's solid."""
    if not like_the_studys(scene.solid):
        return []
    a, found = scene.body.half_width, {name: intensity_rows(name, data) for name in INTENSITIES}
    return [
        intensities(name, rows, limit_of_steady_motion(name, data, a))
        for name, rows in found.items()
        if rows
    ]


def _versions(attributes: dict[str, Any]) -> str:
    told = {"galinx": attributes["version"], **json.loads(attributes["versions"])}
    text = ", ".join(f"{name} {version}" for name, version in told.items())
    return f"{text}; {attributes['machine']}; {attributes.get('created', 'not archived')}"
