"""What is there is not lost, and what a command reads is not written over."""

import os
import socket

import numpy as np
import pytest
from support import at_most, full_disk

from galinx import compute, template
from galinx.app.console import Progress, new_console, print_sheet
from galinx.app.figures import files
from galinx.app.figures.render import Panel
from galinx.app.results.csv import pieces
from galinx.postprocess.errors import Occupied, UnwritableArchive
from galinx.postprocess.hdf5 import vtkhdf
from galinx.postprocess.hdf5.vtkhdf import Piece
from galinx.postprocess.tables import Sheet
from galinx.postprocess.target import (
    ARCHIVE,
    FIELDS,
    GIF,
    LOG,
    PAGE,
    PDF,
    PNG,
    SVG,
    TABLE,
    TABLES,
    Folder,
    Target,
)  # fmt: skip

FOREIGN = b"precious"


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A file of each kind, by kind, of a scene whose title takes after all of them."""
    folder = tmp_path_factory.mktemp("made")
    result = compute(template("table1", {"title": "galinx VTKHDF Table 1 %PDF-"}))
    result.save(folder / "a.h5")
    result.report(folder / "a.html")
    pdf, png, svg = result.plot(folder, "a", formats="pdf, png, svg")[:3]
    moving = files.Film(lambda frame: [Panel(title=f"frame {frame}")], 2)
    (folder / "a.gif").write_bytes(files.film_content(moving, "gif", 30))
    square = Piece(np.zeros((4, 2)), np.arange(4)[None], {"u": np.zeros(4)})
    vtkhdf.write(Target(folder / "a.hdf"), [vtkhdf.Step(0.0, [square])], {"u": ("m", "galinx")})
    with (folder / "tables.txt").open("w") as file:
        print_sheet(new_console(file), Sheet("Table 1. Dahl's law", ("",), [("0.7",)]))
    with (folder / "a.csv").open("w") as file:
        file.writelines(pieces(folder / "a.h5"))
    with Progress(log=folder / "a.log") as progress:
        progress.note("scene: a.toml")
    paths = {ARCHIVE: folder / "a.h5", PAGE: folder / "a.html", PDF: pdf, PNG: png, SVG: svg}
    paths |= {GIF: folder / "a.gif", TABLE: folder / "a.csv", TABLES: folder / "tables.txt"}
    return paths | {FIELDS: folder / "a.hdf", LOG: folder / "a.log"}


def test_each_kind_knows_its_own_files_and_no_other(made, tmp_path):
    for kind in made:
        assert [other.noun for other, path in made.items() if kind.of(path)] == [kind.noun]
    (tmp_path / "empty").touch()
    assert [kind for kind in made if kind.of(tmp_path / "empty")] == [LOG]


def test_what_one_makes_is_made_again_and_all_else_is_kept(made, tmp_path):
    for kind, path in made.items():
        own, foreign = tmp_path / "own", tmp_path / "foreign"
        own.write_bytes(path.read_bytes())
        foreign.write_bytes(FOREIGN)
        Target(own, kind).write(b"new")
        assert own.read_bytes() == b"new"
        with pytest.raises(Occupied, match=f"foreign exists and is not {kind.noun}; name "):
            Target(foreign, kind)
        assert foreign.read_bytes() == FOREIGN
    with pytest.raises(Occupied, match=r"own exists; name another file with -o, or add --overwrite"):
        Target(own)
    Target(own, overwrite=True).write(b"newer")
    Target(foreign, PAGE, overwrite=True).write(b"newer")
    assert own.read_bytes() == foreign.read_bytes() == b"newer"
    assert sorted(os.listdir(tmp_path)) == ["foreign", "own"]


@pytest.mark.parametrize(
    "kind, name, expected",
    [
        (FIELDS, "a.vtu", ".hdf or .vtkhdf for a file of fields"),
        (PAGE, "a.pdf", ".html or .htm for a report"), (TABLE, "a.xlsx", ".csv or .txt for a table"),
        (FIELDS, "a.b.txt", ".hdf or .vtkhdf"),
    ],
)  # fmt: skip
def test_an_ending_says_what_a_file_is(tmp_path, kind, name, expected):
    with pytest.raises(Occupied, match=rf"{name} ends with \.\w+, expected {expected}"):
        Target(tmp_path / name, kind, overwrite=True)
    for good in (kind.endings[0], kind.endings[1].upper(), ""):
        assert Target(tmp_path / f"a{good}", kind).place == tmp_path / f"a{good}"


@pytest.mark.parametrize("overwrite", [False, True])
def test_only_files_are_replaced(tmp_path, overwrite):
    os.mkfifo(tmp_path / "fifo")
    (tmp_path / "folder").mkdir()
    (tmp_path / "null").symlink_to("/dev/null")
    (tmp_path / "dangling").symlink_to("nowhere")
    (tmp_path / "loop").symlink_to("loop")
    (tmp_path / "file").touch()
    expected = {
        "fifo": "is a FIFO, expected a file", "folder": "is a folder, expected", "null": "is a device",
        "socket": "is a socket", "dangling": "is a link to nowhere, which cannot be reached",
        "loop": "is a link to loop", "missing/a": "missing does not exist; make it",
        "file/a": "file does not exist", "..": "is a folder",
    }  # fmt: skip
    with socket.socket(socket.AF_UNIX) as server:
        server.bind(str(tmp_path / "socket"))
        before = sorted(os.listdir(tmp_path))
        for name, message in expected.items():
            for kind in (None, PAGE, LOG):
                with at_most(5.0), pytest.raises(Occupied, match=message):
                    Target(tmp_path / name, kind, overwrite)
    assert sorted(os.listdir(tmp_path)) == before


def test_a_link_is_followed_and_stays(tmp_path):
    (tmp_path / "there").mkdir()
    (tmp_path / "there" / "a").write_bytes(FOREIGN)
    (tmp_path / "link").symlink_to("there/a")
    with pytest.raises(Occupied, match="link exists"):
        Target(tmp_path / "link")
    Target(tmp_path / "link", overwrite=True).write(b"new")
    assert (tmp_path / "link").is_symlink() and (tmp_path / "there" / "a").read_bytes() == b"new"
    assert os.listdir(tmp_path / "there") == ["a"]


def test_inputs_are_never_written_over(tmp_path):
    own = tmp_path / "in"
    own.write_bytes(FOREIGN)
    (tmp_path / "hard").hardlink_to(own)
    (tmp_path / "soft").symlink_to(own)
    (tmp_path / "there").symlink_to(tmp_path)
    for name in ("in", "hard", "soft", "there/in"):
        for read in (own, tmp_path / "hard", tmp_path / "soft"):
            with pytest.raises(Occupied, match="is also a file that this command reads or writes"):
                Target(tmp_path / name, overwrite=True, inputs=[tmp_path / "missing", read])
    with pytest.raises(Occupied, match="also"):  # what is not there yet, as a log may be
        Target(tmp_path / "there" / "new", inputs=[tmp_path / "new"])
    Target(tmp_path / "new", inputs=[own])


def test_what_appears_or_changes_meanwhile_is_kept(made, tmp_path):
    path = tmp_path / "a"
    target = Target(path, PAGE)
    path.write_bytes(FOREIGN)
    with pytest.raises(UnwritableArchive, match=r"something appeared there meanwhile.*; move it away"):
        target.write(b"new")
    assert path.read_bytes() == FOREIGN
    path.write_bytes(made[PAGE].read_bytes())
    target = Target(path, PAGE)
    path.unlink()
    path.write_bytes(FOREIGN)
    with pytest.raises(UnwritableArchive, match="meanwhile"):
        target.write(b"new")
    assert path.read_bytes() == FOREIGN
    target = Target(path, PAGE, overwrite=True)
    path.unlink()
    os.mkfifo(path)
    with at_most(5.0), pytest.raises(UnwritableArchive, match="meanwhile"):
        target.write(b"new")
    assert path.is_fifo() and os.listdir(tmp_path) == ["a"]


def test_a_file_of_pieces_is_written_whole_or_not_at_all(tmp_path):
    (tmp_path / "a").write_bytes(FOREIGN)
    target = Target(tmp_path / "a", overwrite=True)

    def failing():
        yield b"one"
        assert (tmp_path / "a").read_bytes() == FOREIGN
        raise ValueError

    with pytest.raises(ValueError):
        target.write(failing())
    with full_disk(100), pytest.raises(UnwritableArchive, match=r"a: File too large; .* are free"):
        target.write(b"x" for _ in range(100_000))
    assert (tmp_path / "a").read_bytes() == FOREIGN and os.listdir(tmp_path) == ["a"]
    target.write(iter([b"one", b"two"]))
    assert (tmp_path / "a").read_bytes() == b"onetwo" and os.listdir(tmp_path) == ["a"]


def test_a_folder_is_made_and_nothing_else_is_taken_for_one(tmp_path):
    Folder(tmp_path / "a" / "b").target("c", PAGE).write(b"new")
    assert (tmp_path / "a" / "b" / "c").read_bytes() == b"new"
    (tmp_path / "link").symlink_to("nowhere")
    for name in ("a/b/c", "a/b/c/d", "link"):
        with pytest.raises(Occupied, match="is not a folder, expected one"):
            Folder(tmp_path / name)
    with pytest.raises(Occupied, match="also"):
        Folder(tmp_path / "a", inputs=[tmp_path / "a" / "in"]).target("in", PAGE)


def test_a_log_that_cannot_grow_ends_and_the_run_goes_on(tmp_path, capsys):
    log = tmp_path / "a.log"
    with Progress(log=log) as progress:
        progress.note("one")
        before = log.read_bytes()
        with full_disk(len(before) + 5):
            progress.note("two")
            progress.note("three")
    assert log.read_bytes() == before and before.endswith(b" one\n")
    assert capsys.readouterr().err == f"warning: the log {log} ends here: File too large\n"
    with Progress(log=log) as progress:
        progress.note("four")
    assert log.read_bytes().startswith(before) and log.read_bytes().endswith(b" four\n")
