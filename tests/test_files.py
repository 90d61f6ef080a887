"""Files appear whole or not at all; nobody is waited for."""

import errno
import os
import socket
import stat
from pathlib import Path

import pytest
from support import at_most

from galinx import files


def test_what_is_written_is_there_and_nothing_else(tmp_path):
    files.write(tmp_path / "a", b"one", replace=False)
    files.write(tmp_path / "a", b"two")
    assert (tmp_path / "a").read_bytes() == b"two" and os.listdir(tmp_path) == ["a"]
    umask = os.umask(0o022)
    os.umask(umask)
    assert stat.S_IMODE((tmp_path / "a").stat().st_mode) == 0o666 & ~umask


def test_a_file_keeps_its_permissions_when_it_is_replaced(tmp_path):
    (tmp_path / "a").write_bytes(b"one")
    (tmp_path / "a").chmod(0o640)
    files.write(tmp_path / "a", b"two")
    assert stat.S_IMODE((tmp_path / "a").stat().st_mode) == 0o640


@pytest.mark.parametrize("links", [True, False])
def test_what_appeared_meanwhile_is_not_replaced(tmp_path, monkeypatch, links):
    if not links:

        def refuse(*_):
            raise OSError(errno.EPERM, "this file system has no hard links")

        monkeypatch.setattr(os, "link", refuse)
    with files.NewFile(tmp_path / "a") as new:
        new.temporary.write_bytes(b"mine")
        (tmp_path / "a").write_bytes(b"precious")
        with pytest.raises(FileExistsError):
            new.publish(replace=False)
    assert (tmp_path / "a").read_bytes() == b"precious" and os.listdir(tmp_path) == ["a"]
    files.write(tmp_path / "b", b"new", replace=False)
    assert (tmp_path / "b").read_bytes() == b"new" and sorted(os.listdir(tmp_path)) == ["a", "b"]


def test_it_is_on_the_disk_before_it_has_its_name(tmp_path, monkeypatch):
    done, rename, synchronise = [], os.replace, os.fsync
    monkeypatch.setattr(os, "fsync", lambda handle: (synchronise(handle), done.append("synchronised")))
    monkeypatch.setattr(os, "replace", lambda *names: (rename(*names), done.append("named")))
    files.write(tmp_path / "a", b"one")
    assert done == ["synchronised", "named", "synchronised"]


def test_nobody_is_waited_for(tmp_path):
    os.mkfifo(tmp_path / "fifo")
    with socket.socket(socket.AF_UNIX) as server:
        server.bind(str(tmp_path / "socket"))
        expected = {"fifo": "a FIFO", "socket": "a socket", ".": "a folder"}
        for name, what in expected.items():
            with at_most(5.0), pytest.raises(OSError, match=f"it is {what}, expected a file"):
                files.read(tmp_path / name)
    with pytest.raises(OSError, match="it is a device"):
        files.read(Path("/dev/zero"))


def test_open_descriptors_are_read_whatever_they_are(tmp_path):
    source, sink = os.pipe()
    os.write(sink, b"a scene")
    os.close(sink)
    assert files.read(Path(f"/dev/fd/{source}")) == b"a scene"
    os.close(source)
    (tmp_path / "a").write_bytes(b"12345")
    assert files.read(tmp_path / "a") == b"12345" and files.read(tmp_path / "a", 2) == b"12"
