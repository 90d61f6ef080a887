"""Whatever happens to an archive, every command that reads it says so: no traceback, no crash, no number.

GALINX_THOROUGH=1 tries as many as a release does.
"""

import errno
import json
import os

import pytest
from support import here
from tampering import archived, gone, opened

from galinx.app.cli import cli
from galinx.postprocess import schema
from galinx.postprocess.hdf5 import archive
from galinx.postprocess.schema import ATTRIBUTES, FIRST

#: Those that read all of an archive come first.
COMMANDS = (
    ("check",), ("report",), ("plot",), ("csv",), ("show",), ("show", "--json"), ("fields",),
)  # fmt: skip


@pytest.fixture(scope="module")
def content(map_run, tmp_path_factory):
    """The bytes of an archive that has every figure."""
    return archived(map_run, tmp_path_factory.mktemp("whole"))


@pytest.fixture
def path(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path / "a.h5"


def test_the_status_of_a_damaged_archive(content, path):
    damaged = bytearray(content)
    damaged[len(content) // 2] ^= 1
    path.write_bytes(damaged)
    for name, *options in COMMANDS:
        done = here(name, path, *options)
        assert done.returncode == 2 and done.stdout == ""
        assert done.stderr.startswith("error: ") and len(done.stderr.splitlines()) == 1


def test_an_archive_of_an_earlier_layout_is_read(map_run, path, monkeypatch):
    monkeypatch.setattr(schema, "VERSION", FIRST)
    map_run.save(path)
    came_later = {"states/speed", "states/wave_crossings"}
    with opened(path) as file:
        for name in came_later | {n for n, row in ATTRIBUTES.items() if row.since > FIRST}:
            gone(name)(file)
        listed = [name for name in json.loads(file.attrs["datasets"]) if name not in came_later]
        file.attrs["datasets"] = json.dumps(listed)
    data, attributes = archive.read(path)
    assert attributes["schema_version"] == FIRST and data.keys() == map_run.data.keys() - came_later
    assert cli.main(["check", str(path)], standalone_mode=False) == 0


def test_an_archive_that_may_not_be_read_is_bad_input(path, content, monkeypatch):
    path.write_bytes(content)
    own = type(path).open

    def refused(self, *arguments, **options):
        if self.name == path.name:
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(self))
        return own(self, *arguments, **options)

    monkeypatch.setattr(type(path), "open", refused)
    for command, *options in COMMANDS:
        done = here(command, path, *options, cwd=path.parent)
        assert (done.returncode, done.stderr.splitlines()[-1]) == (
            2,
            f"error: cannot read {path}: Permission denied",
        )
