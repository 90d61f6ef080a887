"""The one door to archives: what is not as it was written, or does not fit the schema, is refused."""

import h5py
import numpy as np
import pytest
from tampering import another, archived, attribute, gone, lost, opened, renamed, unit

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
    told = {
        name: value for name, value in exact_run.attributes.items() if name not in ("created", "datasets")
    }
    assert {name: attributes[name] for name in told} == told
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


UNKNOWN = {
    "dataset renamed": (renamed("states/f", "states/F"), "'states/F': not in the table"),
    "section renamed": (renamed("run", "ruN"), "'run/seconds': missing"),
    "dataset lost": (gone("states/alpha"), "'states/alpha': missing"),
    "dataset of all archives lost": (lost("states/motion"), "'states/motion': missing, expected it in"),
    "attribute lost": (gone("verdict"), "attribute verdict: missing, expected PASS"),
    "a row less": (another("states/f", lambda found: found[:-1]), "found 11 states, expected 12"),
    "an axis more": (another("states/f", lambda found: found[None]), r"\(1, 12\), expected numbers"),
    "texts": (another("states/f", lambda _: "texts"), "'states/f': found numbers of kind 'O'"),
    "another unit": (unit("states/speed", "km/s"), "found unit 'km/s', expected 'm/s'"),
    "an attribute of another kind": (attribute("load", "{}"), "found '{}', expected a finite number"),
    "a list of numbers": (attribute("warnings", "[1]"), "warnings: found .* expected a JSON list of"),
    "layout of words": (attribute("schema_version", "2"), "schema_version: found '2', expected 2 to 4"),
    "layout before the first": (attribute("schema_version", 1), "schema_version: found 1"),
    "newer": (attribute("schema_version", 99), "install a newer one"),
    "foreign": (attribute("program", "other"), "not an archive of galinx"),
}  # fmt: skip


@pytest.mark.parametrize("how", UNKNOWN)
def test_what_this_program_does_not_know_is_named_though_its_digest_fits(path, how):
    change, message = UNKNOWN[how]
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


def test_a_dataset_that_is_asked_for_and_missing_is_named(path):
    with opened(path) as file:
        lost("states/alpha")(file)
    data, _ = reader.read(path)
    with pytest.raises(UnreadableArchive, match="'states/alpha' is missing") as caught:
        data["states/alpha"]
    assert isinstance(caught.value, KeyError) and str(caught.value).startswith(str(path))
    with (
        reader.opened(path) as archive,
        pytest.raises(UnreadableArchive, match="'states/alpha' is missing"),
    ):
        archive.rows(slice(2), ["states/alpha"])
