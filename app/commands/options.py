"""Arguments and options that several commands have."""

import os
from collections.abc import Callable
from functools import wraps
from pathlib import Path
from typing import Any

import click

from galinx.postprocess.errors import Occupied
from galinx.postprocess.target import LOG, NO_ARCHIVES, Target, check_archive_name

from .. import ranks
from ..console import Progress
from ..errors import BadInput

#: Bytes that file systems allow a name, less those of the ending of what is kept beside an archive.
_LONGEST = 255 - len(".work.")


class _Path(click.Path):
    """A path; one that no file can have is bad input, not a failure of the machine.

    Args:
        of: ``"file"`` for a file alone, whose name does not end with a slash; ``"archive"`` for one whose
            name says no other kind of file; ``"folder"`` for a folder, whose name does not say a file:
            that is one of somebody who expects a single file.
    """

    def __init__(self, of: str = "") -> None:
        super().__init__(path_type=Path)
        self._of = of

    def convert(self, value: Any, param: Any, ctx: Any) -> Any:
        for name in Path(value).parts:
            if len(os.fsencode(name)) > _LONGEST:
                self.fail(f"found a name of {len(os.fsencode(name))} bytes, expected at most {_LONGEST}")
        if self._of in ("file", "archive") and str(value).endswith(os.sep):
            self.fail(f"found {value!r}, the name of a folder; expected a file's, as in {value}NAME")
        path = super().convert(value, param, ctx)
        of_file = path.suffix.lower() in {*NO_ARCHIVES, ".h5", ".hdf"}
        if self._of == "folder" and of_file and not path.is_dir():
            self.fail(f"{value}: found a name that ends with {path.suffix}, expected a folder for files")
        if self._of == "archive":
            try:
                check_archive_name(path)
            except Occupied as error:
                self.fail(str(error))
        return path


FILE, FOLDER, ARCHIVE, PATH = _Path("file"), _Path("folder"), _Path("archive"), _Path()

scene = click.argument("scene", type=FILE)
archive = click.argument("archive", type=FILE)


def changes(command: Any) -> Any:
    """Options ``--set`` and ``--unset``."""
    with_unset = click.option(
        "--unset", multiple=True, metavar="KEY",
        help="Take a key of the scene away, as in --unset motion.c; may be repeated.",
    )(command)  # fmt: skip
    return click.option(
        "--set", "changes", multiple=True, metavar="KEY=VALUE",
        help="Another value, as in --set friction.mu_c=0.5; may be repeated.",
    )(with_unset)  # fmt: skip


def read(path: Path, changes: tuple[str, ...], unset: tuple[str, ...]) -> Any:
    """The scene of a file with its changes, whose reader is imported where there are any.

    Raises:
        BadInput: the scene has a fault, or only one of several ranks could read it.
    """
    from ..scene.read import read

    if ranks.size() > 1 and path.exists() and not (path.is_file() or path.is_dir()):
        raise BadInput(f"only one of several ranks could read {path}; expected a file")
    if not (changes or unset):
        return read(path)
    from ..scene.changes import from_words

    return read(path, from_words(changes, unset))


dimensionless = click.option(
    "--dimensionless", is_flag=True,
    help="Stresses over N/(2a), places over a, speeds over c_s, loads, v₀ in SI, of motions over N, "
    "N/(2μ); default: MPa, mm, m/s.",
)  # fmt: skip

figures_to = click.option(
    "-o", "to", type=PATH, default=Path("."), show_default=True,
    help="Folder, which is made, or a file: its ending is the format.",
)  # fmt: skip

overwrite = click.option(
    "--overwrite", is_flag=True, help="Replace what has that name, whatever kind of file it is."
)


def inputs(*files: Path | None) -> tuple[Path, ...]:
    """Files that nothing may be written over: the given ones but None, users' models, and the log."""
    log = click.get_current_context().params.get("log")
    return tuple(file for file in (*files, *_extensions(), log) if file)


def _extensions() -> tuple[Path, ...]:
    return click.get_current_context().find_root().params.get("extensions", ())


def folder(default: str) -> Callable[[Any], Any]:
    """Option ``-o FOLDER``."""
    return click.option(
        "-o", "folder", type=FOLDER, default=Path(default), show_default=True,
        help="Folder; it is made.",
    )  # fmt: skip


def talk(command: Any) -> Any:
    """Options ``--quiet``, ``--verbose`` and ``--log``; the command gets a ``progress``."""

    @wraps(command)
    def with_progress(quiet: bool, verbose: bool, log: Path | None, **others: Any) -> Any:
        if quiet and verbose:
            raise click.UsageError("--quiet and --verbose exclude each other; keep one")
        if log:
            read = [others["scene"]] if "scene" in others else []
            Target(log, LOG, inputs=[*read, *_extensions()])
        return command(progress=Progress(quiet, verbose, log), quiet=quiet, **others)

    for option in (
        click.option("--log", type=FILE, help="Add every step, with its time, to this file."),
        click.option("-v", "--verbose", is_flag=True, help="Every step as a line on the error stream."),
        click.option("-q", "--quiet", is_flag=True, help="Warnings and errors only."),
    ):
        with_progress = option(with_progress)
    return with_progress
