"""The report of an archive: one HTML page that needs nothing else."""

import json
from typing import Any

import numpy as np

from galinx.app.console.program import program
from galinx.app.results.drawings import Drawing
from galinx.app.scene.scene import Scene
from galinx.app.study.published import (
    INTENSITIES,
    intensities,
    intensity_rows,
    like_the_studys,
)
from galinx.postprocess.figures.canvas import in_a_page
from galinx.postprocess.page import render
from galinx.postprocess.quantities import runs, states
from galinx.postprocess.tables import Sheet, states_sheet


class Report:
    """A report in the making.

    Args:
        data, attributes: an archive.
        scene: the archive's.
        sheets: tables before that of the states; the published ones where the archive has their states.
    """

    def __init__(
        self,
        data: dict[str, Any],
        attributes: dict[str, Any],
        scene: Scene,
        sheets: list[Sheet] | None = None,
    ) -> None:
        self._data, self._attributes, self._scene = data, attributes, scene
        self._sheets = _published(data, scene) if sheets is None else sheets
        self._pictures: list[dict[str, Any]] = []

    def add(self, drawing: Drawing) -> None:
        """Take a figure in; it can be saved elsewhere afterwards."""
        source = in_a_page(drawing.figure, drawing.pixels)
        self._pictures.append({"source": source, "caption": drawing.caption, "pixels": drawing.pixels})

    def text(self) -> str:
        """The page."""
        attributes, data = self._attributes, self._data
        comparisons = json.loads(attributes["comparisons"])
        seconds = data[runs.SECONDS.path]
        longest = max(float(seconds.max()), 1e-9)
        return render(
            {
                "title": attributes["title"] or "A sliding punch",
                "verdict": attributes["verdict"],
                "summary": self._summary(),
                "warnings": json.loads(attributes["warnings"]),
                "reasons": json.loads(attributes["verdict_reasons"]),
                "comparisons": [(text, f"{value:.1e}") for text, value in comparisons.items()],
                "sheets": [*self._sheets, states_sheet(data, "States")],
                "pictures": self._pictures,
                "times": [
                    (name, f"{value:.3f}", f"{100.0 * value / longest:.1f}")
                    for name, value in zip(data[runs.STEPS.path].tolist(), seconds.tolist())
                ],
                "done": data[runs.DONE.path].tolist(),
                "skipped": data[runs.SKIPPED.path].tolist(),
                "versions": _versions(attributes),
                "scene": data[runs.SCENE.path],
                "program": program(),
            }
        )

    def _summary(self) -> str:
        data, scene = self._data, self._scene
        speeds = np.unique(data[states.SPEED.path])
        moving = f"{speeds[0]:g}" if len(speeds) == 1 else f"{speeds[0]:g} to {speeds[-1]:g}"
        count = len(data[states.FRICTION.path])
        text = (
            f"{count} friction state{'s' * (count > 1)} of a rigid {scene.punch.profile.words()}, load "
            f"{scene.punch.load:g} N/m, that slides at c = {moving} (over the shear wave speed) on a "
            f"half-plane with {scene.solid.words()}."
        )
        if runs.RECORD["unknowns"].path in data:
            cells, degree, unknowns = (
                int(data[runs.RECORD[name].path].max()) for name in ("cells", "degree", "unknowns")
            )
            text += (
                f" Finite elements: {scene.solve.mesh} mesh, {cells} cells of degree up to {degree}, "
                f"{unknowns} unknowns, tolerance {scene.solve.tolerance:g}."
            )
        return text


def _published(data: dict[str, Any], scene: Scene) -> list[Sheet]:
    """The study's tables that the archive has all states of, for the study's solid."""
    if not like_the_studys(scene.solid):
        return []
    found = {name: intensity_rows(name, data) for name in INTENSITIES}
    return [intensities(name, rows) for name, rows in found.items() if rows]


def _versions(attributes: dict[str, Any]) -> str:
    told = {"galinx": attributes["version"], **json.loads(attributes.get("versions", "{}"))}
    text = ", ".join(f"{name} {version}" for name, version in told.items())
    return f"{text}; {attributes.get('machine', 'machine unknown')}; {attributes.get('created', '')}"
