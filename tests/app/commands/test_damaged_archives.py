"""Whatever happens to an archive, every command that reads it says so: no traceback, no crash, no number.

GALINX_THOROUGH=1 tries as many as a release does.
"""

import errno
import json
import os
import random

import h5py
import numpy as np
import pytest
from support import THOROUGH, here
from tampering import archived, gone, numbers, opened, texts

from galinx.app.cli import cli
from galinx.postprocess.errors import UnreadableArchive
from galinx.postprocess.hdf5 import archive
from galinx.postprocess.quantities import large, table
from galinx.postprocess.quantities.quantity import NUMBER, TEXT, WHOLE
from galinx.postprocess.quantities.runs import LINE
from galinx.postprocess.schema import ATTRIBUTES, FIRST

FLIPS, TAMPERED = (5000, 2000) if THOROUGH else (12, 20)
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


def refused(path, capsys, which=COMMANDS):
    """The message of every command; all refuse, print nothing and write nothing."""
    before = sorted(os.listdir(path.parent))
    messages = set()
    for name, *options in which:
        with pytest.raises(UnreadableArchive) as caught:
            cli.main([name, str(path), *options], standalone_mode=False)
        messages.add(str(caught.value))
    assert capsys.readouterr().out == "" and sorted(os.listdir(path.parent)) == before
    assert len(messages) == 1
    return messages.pop()


def test_flipped_bits(content, path, capsys):
    choose = random.Random(1)
    for _ in range(FLIPS):
        damaged = bytearray(content)
        damaged[choose.randrange(len(content))] ^= 1 << choose.randrange(8)
        path.write_bytes(damaged)
        assert "damaged" in refused(path, capsys)


def test_the_status_of_a_damaged_archive(content, path):
    damaged = bytearray(content)
    damaged[len(content) // 2] ^= 1
    path.write_bytes(damaged)
    for name, *options in COMMANDS:
        done = here(name, path, *options)
        assert done.returncode == 2 and done.stdout == ""
        assert done.stderr.startswith("error: ") and len(done.stderr.splitlines()) == 1


def again(file, name, data):
    """Another dataset in the place of one."""
    (texts if data.dtype.kind in "OU" else numbers)(name, data)(file)


def other_type(file, name, choose):
    data = np.asarray(file[name][()])
    row = table()[name]
    kinds = {TEXT: ["f8", "i8"], WHOLE: ["f8", "i4", "U"], NUMBER: ["f4", ">f8", "i8", "U", "c16"]}
    if row.type == TEXT:
        again(file, name, np.zeros(data.shape, choose.choice(kinds[TEXT])))
    else:
        with np.errstate(invalid="ignore"):
            again(file, name, data.astype(choose.choice(kinds[row.type])))


def other_shape(file, name, choose):
    data = np.asarray(file[name].asstr()[()] if table()[name].type == TEXT else file[name][()])
    ways = [lambda: data[None], lambda: np.array([data, data])]
    if data.ndim and table()[name].over != (LINE,):
        ways += [lambda: data[:-1], lambda: np.concatenate([data, data[:1]]), lambda: data[:0]]
        ways += [lambda: data[0], lambda: np.moveaxis(data[..., None], -1, 0)]
    again(file, name, np.asarray(choose.choice(ways)()))


def other_value(file, name, choose):
    row = table()[name]
    if row.type == TEXT:
        again(file, name, np.zeros(file[name].shape))
    else:
        place = tuple(choose.randrange(n) for n in file[name].shape)
        file[name][place] = -7 if row.type == WHOLE else choose.choice([np.inf, -np.inf])


def renamed(file, name, choose):
    file.move(name, choose.choice([name + "_", name.upper(), f"{name}s", f"other/{name}"]))


DATASETS = (
    other_type,
    other_shape,
    other_value,
    renamed,
    lambda file, name, choose: file.pop(name),
    lambda file, name, choose: file[name].attrs.__setitem__(
        "units", choose.choice(["inch", "", 1.0, b"\xff", [1, 2], h5py.Empty("f")])
    ),
    lambda file, name, choose: file[name].attrs.__delitem__(choose.choice(["units", "long_name"])),
    lambda file, name, choose: file[name].attrs.__setitem__(choose.choice(["scale", "unitS"]), 2.0),
)

NO_TEXT = (1.5, True, [1.0, 2.0], np.bytes_(b"\xff\xfe"), h5py.Empty("f"), np.array(["a", "b"], object))
NO_NUMBER = ("1", True, [1.0, 2.0], h5py.Empty("f"))
WRONG = (
    dict.fromkeys(
        ("datasets", "solid", "rules", "comparisons", "verdict_reasons", "warnings", "versions"),
        (*NO_TEXT, "{", "3", "null", "[[]]", '{"a": []}', "", "[" * 5000),
    )
    | {
        "complete": (False, 1, 0, "no", "True", [True, True]),
        "speed_limit": NO_NUMBER,
        "schema_version": ("2", 1, 0, -1, 5, 1.5, [2, 2]),
        "verdict": (*NO_TEXT, "pass", "PASSED", "", "PASS "),
        "program": (*NO_TEXT, "Galinx", ""),
        "scene_sha256": (*NO_TEXT, "0" * 64, ""),
        "created": (*NO_TEXT, "today", ""),
    }
    | dict.fromkeys(("load", "half_width", "c_s"), (*NO_NUMBER, np.nan, np.inf))
)


def tampered(file, choose):
    """Change something that no archive has; what was done."""
    if choose.random() < 0.7:
        names = []
        file.visititems(lambda name, item: names.append(name) if isinstance(item, h5py.Dataset) else None)
        name, change = choose.choice(names), choose.choice(DATASETS)
        change(file, name, choose)
        return f"{getattr(change, '__name__', change)} {name}"
    name = choose.choice(sorted(file.attrs))
    how = choose.choice(["lost", "renamed", "value", "value"])
    found = file.attrs[name]
    if how == "value":
        value = choose.choice(WRONG.get(name, NO_TEXT))
        del file.attrs[name]
        file.attrs[name] = value
        return f"{name} = {value!r:.40}"
    del file.attrs[name]
    if how == "renamed":
        file.attrs[name.upper()] = found
    return f"{name} {how}"


def test_tampered_archives(content, path, capsys):
    choose = random.Random(2)
    for i in range(TAMPERED):
        path.write_bytes(content)
        sealed = i % 5 > 0
        with opened(path, sealed) as file:
            done = tampered(file, choose)
        stresses = sealed and done.startswith("other_value") and large(done.split()[-1])
        which = COMMANDS[:3] if stresses else COMMANDS
        try:
            message = refused(path, capsys, which if THOROUGH else [choose.choice(which)])
        except BaseException as error:
            raise AssertionError(f"trial {i}: {done}: {error!r}") from error
        assert sealed or "damaged" in message


def test_an_archive_of_an_earlier_layout_is_read(map_run, path, monkeypatch):
    monkeypatch.setattr(archive, "VERSION", FIRST)
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


def test_an_archive_without_its_digest_is_refused(content, path, capsys):
    path.write_bytes(content[archive.ROOM :])
    assert "does not begin as an archive of galinx does" in refused(path, capsys)


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
