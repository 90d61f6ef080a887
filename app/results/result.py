"""Results in Python: everything the command line does in a few lines, with or without files.

In a notebook a result shows its title, verdict and states as HTML.
"""

import json
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import nullcontext
from functools import cached_property
from html import escape
from pathlib import Path
from typing import Any

import numpy as np

from galinx.postprocess.compare import checked, failed
from galinx.postprocess.quantities import of_states, runs, states, table
from galinx.postprocess.quantities.quantity import ALONG, INNER, INSIDE, INTERFACE, LAYER, POINT, STATE
from galinx.postprocess.quantities.stresses import INSIDE_X, INSIDE_Y, SURFACE_X
from galinx.postprocess.tables import Column, parameters, state_columns, states_sheet
from galinx.postprocess.target import FIELDS, PAGE, Target, check_archive_name
from galinx.postprocess.units import Units

from ..console import Progress
from ..errors import BadInput, require_one_of, short
from ..run.flow import Memory
from ..run.flow import compute as compute_into
from ..scene import read as scenes
from ..scene.scene import Scene

#: Names of an xarray.Dataset's dimensions, and of the positions along them.
_DIMENSIONS = {
    STATE: "state", POINT: "X_over_a", INSIDE: "point", INNER: "inner",
    INTERFACE: "interface", ALONG: "along", LAYER: "layer",
}  # fmt: skip
_POSITIONS = {
    SURFACE_X.path: "X_over_a",
    INSIDE_X.path: "inside_X_over_a",
    INSIDE_Y.path: "inside_Y_over_a",
}


#: States that a range of them may have.
_SEVERAL = 10_000


def numbers(text: str) -> list[int]:
    """Numbers of states, as ``0,4,7`` or ``0-5``.

    Raises:
        BadInput: these are none.
    """
    states: list[int] = []
    for word in text.split(","):
        ends = re.fullmatch(r"\s*(\d{1,9})(?:\s*-\s*(\d{1,9}))?\s*", word)
        if not ends:
            raise BadInput(f"--states: found {short(word)!r}, expected numbers, as in 0,4,7 or 0-5")
        first, last = int(ends[1]), int(ends[2] or ends[1])
        if not first <= last < first + _SEVERAL:
            raise BadInput(
                f"--states: found {word}, expected a range that grows, of up to {_SEVERAL} states"
            )
        states += range(first, last + 1)
    return list(dict.fromkeys(states))


def _lines(texts: Iterable[str]) -> str:
    """Lines of small print as HTML, "" for none."""
    text = "<br>".join(map(escape, texts))
    return f"<p><small>{text}</small></p>" if text else ""


class Result:
    """Result of computing a scene.

    Args:
        data: datasets by their path in an archive; units and meanings in ``docs/archive.md``.
        attributes: those of an archive's root.
        inputs: files that it was read from; nothing is written over them.
    """

    def __init__(
        self, data: dict[str, Any], attributes: dict[str, Any], inputs: tuple[Path, ...] = ()
    ) -> None:
        self.data, self.attributes, self.inputs = data, attributes, inputs

    def __repr__(self) -> str:
        count = len(self.data[states.FRICTION.path])
        plural = "s" * (count > 1)
        return f"<galinx result {self.attributes['title']!r}: {count} state{plural}, {self.verdict}>"

    def _repr_html_(self) -> str:
        """Verdict and states as HTML without scripts or styles of its own, for notebooks."""
        sheet = states_sheet(self.data, self.units(), self.attributes["title"])
        head, *rows = (
            "<tr>" + "".join(f"<{tag}>{escape(cell)}</{tag}>" for cell in row) + "</tr>"
            for tag, row in [("th", sheet.columns), *(("td", row) for row in sheet.rows)]
        )
        table_ = f"<table><thead>{head}</thead><tbody>{''.join(rows)}</tbody></table>"
        warnings = [f"warning: {text}" for text in json.loads(self.attributes["warnings"])]
        notes = [*sheet.notes, *failed(self.data, self.attributes), checked(self.data, self.attributes)]
        colour = {"PASS": "#1a7f37", "FAIL": "#c1121f"}.get(self.verdict, "inherit")
        return (
            f"<p><b>{escape(sheet.title or 'galinx')}</b>: "
            f'<b style="color: {colour}">{escape(self.verdict)}</b></p>'
            f"{_lines(warnings)}{table_}{_lines(notes)}"
        )

    @cached_property
    def scene(self) -> Scene:
        """The scene that was computed."""
        return scenes.parse(self.data[runs.SCENE.path], "the scene of the archive")

    @property
    def verdict(self) -> str:
        """``"PASS"``, ``"FAIL"`` or ``"not judged"``."""
        return self.attributes["verdict"]

    @property
    def comparisons(self) -> dict[str, float]:
        """Largest difference over all states by what was compared, dimensionless."""
        return json.loads(self.attributes["comparisons"])

    @cached_property
    def dataset(self) -> Any:
        """An xarray.Dataset over the dimension ``state``, with units and long names.

        Variables are named like the paths of an archive, with ``_`` for ``/`` and without ``states``. The
        parameters that differ between states are coordinates.
        """
        import xarray  # slow to import

        rows, apart = table(), parameters(self.data)
        variables: dict[str, Any] = {}
        coordinates: dict[str, Any] = dict.fromkeys(path.rpartition("/")[2] for path in apart)
        for path, values in self.data.items():
            row = rows.get(path)
            if not row or not of_states(path) or not row.over or not set(row.over) <= _DIMENSIONS.keys():
                continue
            dims = tuple(_DIMENSIONS[dimension] for dimension in row.over)
            named = dims, values, {"units": row.unit, "long_name": row.about}
            section, *rest = path.split("/")
            if path in _POSITIONS:
                coordinates[_POSITIONS[path]] = named
            elif path in apart:
                coordinates[rest[0]] = named
            else:
                variables["_".join(rest if section == "states" else (section, *rest))] = named
        kept = {name: self.attributes[name] for name in ("title", "version", "verdict")}
        return xarray.Dataset(variables, coordinates, kept)

    @cached_property
    def grid(self) -> Any:
        """xarray.Dataset over the scene's parameters: ``grid.fem_K_I_right.sel(c=0.6, motion="FM1")``."""
        flat = self.dataset
        if self.scene.motion.speed is not None:  # c follows from it and the solid
            flat = flat.reset_coords("c").set_coords("speed")
        apart = [name for name in flat.coords if flat[name].dims == ("state",)]
        return flat.set_index(state=apart).unstack("state")

    def units(self, dimensionless: bool = False) -> Units:
        """Units of all quantities: SI with prefixes, or as archived over N/(2a), a and c_s."""
        return Units(self.scene.body, self.data, dimensionless)

    def table(self, dimensionless: bool = False) -> list[Column]:
        """One row a state: columns with head, unit and values.

        They are those that ``run``, ``show``, ``csv`` and the page show.
        """
        return state_columns(self.data, self.units(dimensionless))

    def drawings(self, dimensionless: bool = False, **options: Any) -> Iterator[Any]:
        """Figures of the result, as :class:`galinx.app.figures.choice.Drawing`.

        Args:
            dimensionless: stresses over N/(2a), positions over a.
            options: as of :meth:`choice`.

        Raises:
            BadInput: the result lacks a chosen figure or quantity, or an option is no such thing.
        """
        from ..figures.archive import of_archive

        return of_archive(self.data, self.scene, self.choice(dimensionless, **options))

    def choice(
        self, dimensionless: bool = False, figures: str | Sequence[str] = (),
        states: str | int | Sequence[int] = (), quantities: str | Sequence[str] = (), method: str = "",
        x: str = "", y: str | Sequence[str] = (), by: str = "", size: Any = "",
        measured: Any = None,
    ) -> Any:  # fmt: skip
        """Choice of what figures show, a :class:`galinx.app.figures.choice.Choice`.

        Several names or numbers may be a text as on the command line, or a list.

        Args:
            dimensionless: stresses over N/(2a), positions over a.
            figures, states, quantities, method, x, y, by: see ``plot`` of the command line; what is left
                out is chosen automatically.
            size: ``"85mm"``, or a :class:`galinx.app.figures.render.Size`.
            measured: points that lie over figures: a file, or what
                :func:`galinx.app.figures.measured.read` gave.

        Raises:
            BadInput: an option is no such thing.
        """
        from ..figures import choice
        from ..figures.measured import read

        figures, quantities, y = (choice.words(names) for names in (figures, quantities, y))
        if isinstance(states, str):
            states = numbers(states) if states else ()
        states = tuple(_whole(states))
        if not isinstance(size, choice.Size | None):
            size = choice.size(str(size))
        if isinstance(measured, str | Path):
            measured = read(Path(measured))
        units = self.units(dimensionless)
        return choice.Choice(figures, states, quantities, method, x, y, by, size, units, measured)

    def figure(self, name: str = "", **options: Any) -> Any:
        """One of the figures, as a matplotlib figure, which notebooks show.

        Args:
            name: of a drawing, as ``"friction"`` or ``"surface"``; that one if not given, or that of
                friction where there are no stresses.
            options: as in :meth:`drawings`, where ``figures`` is another word for the name.

        Raises:
            BadInput: the result has no such figure, or several are named.
        """
        from ..figures.archive import names
        from ..figures.choice import words
        from ..figures.files import content

        usual = "surface" if "surface" in names(self.data, self.scene) else "friction"
        chosen = words(options.pop("figures", "")) or words(name or usual)
        if len(chosen) > 1 or (name and chosen != words(name)):
            several = ", ".join(dict.fromkeys([*words(name), *chosen]))
            raise BadInput(f"found the figures {several}, expected one; plot(folder) writes several")
        (drawing,) = self.drawings(figures=chosen, **options)
        figure: Any = drawing.figure  # notebooks know how to show figures of pyplot alone
        figure._repr_png_ = lambda: content(figure, "png", 110)
        return figure

    def plot(
        self, to: Path | str | None = None, name: str = "galinx", overwrite: bool = False,
        formats: str | Sequence[str] = (), dpi: int = 0, dimensionless: bool = False, **options: Any,
    ) -> Any:  # fmt: skip
        """Write figures into a folder, which is made, or one into a file; their paths.

        Without a place nothing is written, and the figure is returned that :meth:`figure` gives.

        Args:
            to: a folder, or a file whose ending is its format.
            name: what names in a folder begin with.
            overwrite: files that are no figures of galinx are replaced, too.
            formats: ``"pdf"``, ``"png"``, ``"svg"``; of films ``"mp4"``, ``"gif"``.
            dpi: dots per inch of what is made of pixels.
            dimensionless: stresses over N/(2a), positions over a.
            options: as in :meth:`drawings`.

        Raises:
            BadInput: the result lacks a chosen figure or quantity, or there is no such format.
            Occupied: another file than a figure of galinx is there, and ``overwrite`` is false.
            UnwritableArchive: the file system refused.
        """
        if to is None:
            if name != "galinx" or formats or dpi:
                raise BadInput(
                    "name, formats and dpi are of files: expected a folder or a file before them; figure "
                    "takes the name of a figure"
                )
            return self.figure(dimensionless=dimensionless, **options)
        from ..figures.archive import write
        from ..figures.choice import words
        from ..figures.files import Files

        choice = self.choice(dimensionless, **options)
        files = Files(Path(to), name, words(formats), dpi, overwrite, self.inputs)
        return [file.path for file in write(self.data, self.scene, choice, files)]

    def report(self, path: Path | str, overwrite: bool = False, dimensionless: bool = False) -> None:
        """Write a self-contained HTML page, in SI or dimensionless.

        Raises:
            Occupied: another file than a report of galinx is there, and ``overwrite`` is false.
            UnwritableArchive: the file system refused.
        """
        from .report import page

        target = Target(Path(path), PAGE, overwrite, self.inputs)
        drawings = self.drawings(dimensionless, figures=("all",))
        target.write(page(self, drawings, dimensionless=dimensionless).encode())

    def fields(
        self,
        path: Path | str,
        state: int | Sequence[int] = 0,
        extent: float = 10.0,
        overwrite: bool = False,
    ) -> None:
        """Write displacement and stresses of states for ParaView (VTKHDF); collective under MPI.

        Args:
            path: the file, ``.hdf`` or ``.vtkhdf``.
            state: which, from 0; several become a series, which ParaView knows from 5.12 on.
            extent: how far from the punch's centre, over a; cells that reach further are cut there.
            overwrite: a file that holds no fields of galinx is replaced, too.

        Raises:
            BadInput: no such state, or finite elements have no answer there.
            Occupied: the ending is another kind's, or another file is there, and ``overwrite`` is false.
            UnwritableArchive: the file system refused.
        """
        from .fields import write_fields

        target = Target(Path(path), FIELDS, overwrite, self.inputs)
        numbers = _whole(state)
        write_fields(self.scene, numbers, target, extent, [*map(self._degree, numbers)])

    def displacement(self, state: int = 0, extent: float = 10.0) -> Any:
        """The displacement of a state as a dolfinx function, to go on with in dolfinx; on one rank only.

        The state is solved once more by finite elements, at the degree that was used. Of the function
        ``u``, ``u.function_space.mesh`` is the mesh of the solid, in m, the punch's centre at the origin
        and the solid below; ``u`` itself is in m, relative to the surface 100 a away.

        Args:
            state: which, from 0.
            extent: how far from the punch's centre the mesh reaches at least, over a.

        Raises:
            BadInput: no such state, finite elements have no answer there, or there are several ranks.
            MachineFailure: dolfinx is not installed.
        """
        from .fields import displacement

        (number,) = _whole(state)
        return displacement(self.scene, number, self._degree(number), extent)

    def save(self, path: Path | str, overwrite: bool = False) -> None:
        """Write an archive.

        Raises:
            BadInput: the result was loaded without its stresses.
            Occupied: the file exists and ``overwrite`` is false, its folder does not, or the ending is
                that of another kind of file.
            UnwritableArchive: the file system refused.
        """
        from galinx.postprocess.hdf5.archive import Writer

        missing = {*json.loads(self.attributes.get("datasets", "[]"))} - self.data.keys()
        if missing:
            raise BadInput("this result was loaded without stresses; load it with them to save it")
        check_archive_name(Path(path))
        with Writer(Target(Path(path), None, overwrite, self.inputs)) as writer:
            for name, value in self.data.items():
                writer.put(name, value)
            writer.finish(self.attributes)

    def _degree(self, number: int) -> int | None:
        """Degree that was used at a state's speed, None without finite elements."""
        degrees = self.data.get(runs.RECORD["degree"].path, ())
        solved = runs.states_of_speeds(self.data, len(self.scene.each)) if len(degrees) else ()
        return next((int(p) or None for p, numbers in zip(degrees, solved) if number in numbers), None)


def _whole(states: Any) -> list[int]:
    """Numbers of states, from one or several.

    Raises:
        BadInput: some are no whole numbers.
    """
    numbers = np.atleast_1d(states).ravel().tolist()
    if strange := [number for number in numbers if type(number) is not int]:
        raise BadInput(f"states: found {strange[0]!r:.60}, expected whole numbers")
    return numbers


def read_scene(path: Path | str, changes: dict[str, Any] | None = None) -> Scene:
    """A scene from a file, with other values by ``"section.key"``.

    Raises:
        BadInput: the file cannot be read, or the scene has faults; all are listed.
    """
    return scenes.read(Path(path), changes)


def template(name: str, changes: dict[str, Any] | None = None) -> Scene:
    """One of the scenes to begin with, with other values by ``"section.key"``.

    Raises:
        BadInput: no such scene, or the changed one has faults.
    """
    from ..scene.changes import changed
    from ..scene.library import templates

    available = templates()
    text = available[require_one_of("template", name, available)]
    if not isinstance(changes, Mapping | None):
        raise BadInput(f"template: found {changes!r:.60}, expected values by key, as {{'motion.c': 0.3}}")
    return scenes.parse(changed(text, changes or {}), name)


def compute(scene: Scene | Path | str, progress: bool = False) -> Result:
    """Compute a scene in memory.

    Args:
        scene: the scene, or its file.
        progress: show a bar on a terminal.

    Raises:
        BadInput: the file cannot be read, or the scene has faults or asks for what has no answer.
        SolveError: no speed could be solved.
    """
    scene = scene if isinstance(scene, Scene) else read_scene(scene)
    data = Memory()
    with Progress() if progress else nullcontext() as shown:
        attributes = compute_into(scene, data, shown)
    return Result(dict(data), attributes)


def load(path: Path | str, stresses: bool = True) -> Result:
    """An archive's result; ``stresses`` on the surface and inside can be left out.

    Raises:
        UnreadableArchive: no archive, a damaged one, one that does not fit the schema, or of a newer one.
    """
    from galinx.postprocess.hdf5.archive import read

    return Result(*read(Path(path), stresses), (Path(path),))
