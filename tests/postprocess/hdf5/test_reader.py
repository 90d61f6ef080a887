"""The one door to archives: what is not as it was written, or does not fit the schema, is refused."""

import json

import h5py
import numpy as np
import pytest
from tampering import archived, attribute, gone, made, numbers, opened, renamed, value

from galinx.postprocess import schema
from galinx.postprocess.errors import UnreadableArchive
from galinx.postprocess.hdf5 import archive
from galinx.postprocess.hdf5 import archive as reader


@pytest.fixture(scope="module")
def whole(exact_run, tmp_path_factory):
    """The bytes of an archive."""
    return archived(exact_run, tmp_path_factory.mktemp("whole"))


@pytest.fixture
def path(whole, tmp_path):
    """An archive that may be changed."""
    (tmp_path / "a.h5").write_bytes(whole)
    return tmp_path / "a.h5"


def test_round_trip(exact_run, path):
    data, attributes = reader.read(path)
    assert data.keys() == exact_run.data.keys()
    for name, values in exact_run.data.items():
        np.testing.assert_array_equal(data[name], values)
    assert attributes.items() >= exact_run.attributes.items()
    assert attributes["schema_version"] == schema.VERSION
    assert "surface/closed_form/sigma_XX" not in reader.read(path, stresses=False)[0]
    with reader.opened(path) as archive:
        some = archive.rows(slice(3, 5))
    assert some["states/f"].tolist() == exact_run.data["states/f"][3:5].tolist()
    assert len(some["surface/closed_form/sigma_XX"]) == 2 and len(some["surface/X_over_a"]) == 217


def test_every_flipped_bit_is_found_before_hdf5_opens_the_file(path, monkeypatch):
    content = path.read_bytes()

    def refuse(*_, **__):
        raise AssertionError("HDF5 met a damaged file")

    monkeypatch.setattr(h5py, "File", refuse)
    choose = np.random.default_rng(0)
    places = [*range(80), *choose.integers(len(content), size=120)]
    for byte, bit in zip(places, choose.integers(8, size=200)):
        damaged = bytearray(content)
        damaged[byte] ^= 1 << bit
        path.write_bytes(damaged)
        with pytest.raises(UnreadableArchive, match="damaged"):
            reader.read(path)


@pytest.mark.parametrize(
    "change",
    [
        lambda content: content[:-200],
        lambda content: content[:600],
        lambda content: content[:100],
        lambda content: content + b"\0",
        lambda content: content[:4096] + bytes(512) + content[4608:],
        lambda content: content[reader.ROOM :],
        lambda content: b"hello",
        lambda content: b"",
    ],
)
def test_files_that_are_no_whole_archives(path, change):
    path.write_bytes(change(path.read_bytes()))
    with pytest.raises(UnreadableArchive, match="damaged"):
        reader.read(path)


def test_what_is_no_file_is_said(tmp_path):
    for name in ("missing.h5", "."):
        with pytest.raises(UnreadableArchive, match="is not a file"):
            reader.read(tmp_path / name)


def unit(name, found):
    def apply(file):
        file[name].attrs["units"] = found

    return apply


def a_link(file):
    del file["states/g"]
    file["states/g"] = h5py.SoftLink("/states/f")


def a_group(file):
    del file["states/g"]
    file.create_group("states/g")


def unlisted(file):
    file.attrs["datasets"] = json.dumps(
        [name for name in json.loads(file.attrs["datasets"]) if name != "states/alpha"]
    )


def invalid(file):
    del file["run/done"]
    file.create_dataset("run/done", data=[b"\xff"], dtype=h5py.string_dtype()).attrs.update(
        {"units": "none", "long_name": "steps done"}
    )


def without_values(file):
    """Room for a great many states, of which none is in the file."""
    del file["states/f"]
    dataset = file.create_dataset("states/f", (12,), float, chunks=(12,), fletcher32=True)
    dataset.attrs.update({"units": "1", "long_name": "f"})


TAMPERED = {
    # names
    "dataset renamed": (renamed("states/f", "states/F"), "'states/F': not in the table"),
    "section renamed": (renamed("run", "ruN"), "'run/seconds': missing"),
    "dataset lost": (gone("states/f"), "'states/f': missing"),
    "optional dataset lost": (gone("states/alpha"), "'states/alpha': missing"),
    "section lost": (gone("run"), "'run/done': missing"),
    "dataset not listed": (unlisted, "states/alpha: not in the attribute datasets"),
    "link": (a_link, "'states/g': missing"),
    "group": (a_group, "'states/g': missing"),
    # types
    "less precise": (numbers("states/f", np.zeros(12, "f4")), "states/f: found float32"),
    "other order of bytes": (numbers("states/f", np.zeros(12, ">f8")), "states/f: found >f8"),
    "whole numbers": (numbers("states/f", np.zeros(12, int)), "states/f: found int64"),
    "no whole numbers": (numbers("loops/of_state", np.zeros(12)), "loops/of_state: found float64"),
    "texts": (made("states/f", ["0.1"] * 12), "states/f: found text"),
    "no texts": (numbers("states/motion", np.zeros(12)), "states/motion: found float64, expected text"),
    "no checksum": (made("states/f", np.zeros(12)), "states/f: found no checksum"),
    "no values": (without_values, "states/f: found no checksum or not all of its values"),
    "no room": (made("states/f", h5py.Empty("f8")), "states/f: found no checksum or not all of"),
    "no UTF-8": (invalid, "not a whole HDF5 file"),
    # shapes
    "a row lost": (numbers("states/f", np.zeros(11)), r"states/f: found shape \(11,\), expected \(12,\)"),
    "a row more": (made("states/motion", ["FM1"] * 13), r"states/motion: found shape \(13,\)"),
    "turned": (
        numbers("surface/closed_form/sigma_XX", np.zeros((217, 12))),
        r"surface/closed_form/sigma_XX: found shape \(217, 12\), expected \(12, 217\): states × points",
    ),
    "a dimension more": (numbers("states/f", np.zeros((12, 1))), r"states/f: found shape \(12, 1\)"),
    "a single number": (made("states/f", 0.1), r"states/f: found shape \(\)"),
    "nothing": (made("run/steps", [], dtype=h5py.string_dtype()), r"run/steps: found shape \(0,\)"),
    "lines of no text": (made("run/done", "x", dtype=h5py.string_dtype()), r"run/done: found shape \(\)"),
    # units
    "unit": (unit("states/f", "m"), "states/f: found units 'm', expected '1'"),
    "unit of numbers": (unit("states/f", 1.0), "states/f: found units 1.0"),
    "unit lost": (lambda file: file["states/f"].attrs.clear(), "states/f: found units None"),
    # values
    "NaN": (value("states/f", np.nan), "states/f: found a number that is not finite"),
    "infinity": (value("surface/closed_form/sigma_XX", np.inf, (0, 5)), "sigma_XX: found a number that"),
    "beyond its range": (value("states/c", 1.5), "states/c: found 1.5, expected numbers >= 0, < 1"),
    "below its range": (value("run/seconds", -1.0), "run/seconds: found -1, expected numbers >= 0"),
    "parameter": (value("states/mu_c", -0.7), "states/mu_c: found -0.7"),
    "row of no loop": (value("loops/of_state", 7), "loops/of_state: found a row beyond the 1"),
    "scene": (made("scene/text", "title = 'x'\n"), "scene/text: found a text of the hash"),
    # attributes
    "verdict": (attribute("verdict", "pass"), "attribute verdict: found 'pass', expected PASS"),
    "verdict lost": (gone("verdict"), "attribute verdict: missing, expected PASS"),
    "incomplete": (attribute("complete", False), "attribute complete: found False, expected true"),
    "complete in words": (attribute("complete", "no"), "attribute complete: found 'no', expected true"),
    "no JSON": (attribute("warnings", "[1, "), "attribute warnings: found '.1, ', expected a JSON list"),
    "other JSON": (attribute("comparisons", "[]"), "attribute comparisons: found '..', expected a"),
    "endless number": (attribute("comparisons", '{"x": 1' + 400 * "0" + "}"), "comparisons: found"),
    "deep JSON": (attribute("warnings", "[" * 20000), "attribute warnings: found"),
    "texts of no text": (attribute("rules", '["\\ud800"]'), "attribute rules: found"),
    "load": (attribute("load", "55300"), "attribute load: found '55300', expected a finite number"),
    "load of many": (attribute("load", [1.0, 2.0]), "attribute load: found array"),
    "not even empty": (attribute("title", h5py.Empty("f")), "attribute title: found"),
    "moment": (attribute("created", "yesterday"), "attribute created: found 'yesterday'"),
    "one more": (attribute("colour", "red"), "attribute 'colour': no archive has one"),
    "layout of words": (attribute("schema_version", "2"), "schema_version: found '2', expected 2 to 4"),
    "layout before the first": (attribute("schema_version", 1), "schema_version: found 1"),
    "newer": (attribute("schema_version", 99), "install a newer one"),
    "foreign": (attribute("program", "other"), "not an archive of galinx"),
}  # fmt: skip


@pytest.mark.parametrize("how", TAMPERED)
def test_what_was_changed_is_named_though_its_digest_was_made_again(path, how):
    change, message = TAMPERED[how]
    with opened(path, sealed=False) as file:
        change(file)
    with pytest.raises(UnreadableArchive, match="damaged"):
        reader.read(path)
    archive.put(path)
    with pytest.raises(UnreadableArchive, match=message):
        reader.read(path)


def test_many_faults_are_one_message(path):
    with opened(path) as file:
        del file["states"]
    with pytest.raises(UnreadableArchive, match=r"and \d+ more$") as caught:
        reader.read(path)
    assert len(str(caught.value).splitlines()) == 10


def test_an_archive_that_says_itself_what_is_not_finite_is_read(path):
    with opened(path) as file:
        file["states/alpha"][0] = np.nan
        told = json.loads(file.attrs["comparisons"])
        told["values that are not finite where they have to be: 1 for some"] = 1.0
        file.attrs["comparisons"] = json.dumps(told)
    assert np.isnan(reader.read(path)[0]["states/alpha"][0])
    with opened(path) as file:
        file["states/f"][0] = np.nan
    with pytest.raises(UnreadableArchive, match="states/f: found a number that is not finite"):
        reader.read(path)
