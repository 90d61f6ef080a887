"""The digest of an archive, in the room that HDF5 leaves to others at a file's start.

It is of every byte that follows, so names, shapes, types, units and attributes are covered like numbers.
HDF5 itself crashes over some damaged files: what is sealed is verified before HDF5 opens it.
"""

import hashlib
import re
from pathlib import Path

from galinx.postprocess.errors import UnreadableArchive

#: Bytes of that room, HDF5's user block; the smallest that there can be.
ROOM = 512
#: What it says; by hand: ``tail -c +513 ARCHIVE | sha256sum``.
_TITLE, _WORDS = "galinx archive\n", "sha256 of all bytes after the first 512:\n{}\n"
#: How every HDF5 file begins that has no user block.
_HDF5 = b"\x89HDF\r\n\x1a\n"
#: What the beginning of a scene has, comments and a title before it, and no control character.
_SCENE = re.compile(rb"\A[^\0-\x08\x0e-\x1f]*^\s*(?:\[[\w.]+\]|\w+\s*=)", re.MULTILINE)


def put(path: Path, seal: bytes | None = None) -> None:
    """Seal a file that was made with this room.

    Args:
        path: the file, closed.
        seal: what :func:`made` gave for it; made here if not given.

    Raises:
        OSError: the file system refused.
    """
    seal = seal or made(path)
    with path.open("r+b") as file:
        file.write(seal)


def is_sealed(path: Path) -> bool:
    """Is there a seal, which fits? Archives of schema version 1 have none.

    Raises:
        OSError: the file cannot be read.
        UnreadableArchive: the seal does not fit what follows, or this is no HDF5 file.
    """
    with path.open("rb") as file:
        start = file.read(ROOM)
    if start.startswith(_HDF5):
        return False
    if b"\0" not in start and _SCENE.search(start):
        raise UnreadableArchive(
            f"{path} is a scene or another text, expected an archive of results; the command run makes "
            "one of a scene"
        )
    if not start.startswith(_TITLE.encode()):
        raise UnreadableArchive(
            f"{path} begins neither as an archive of galinx does nor as HDF5: it is something else, or "
            "damaged; expected a file that galinx wrote"
        )
    if start != made(path):
        raise UnreadableArchive(
            f"{path} is damaged: its bytes are not those that its digest is of; one was changed since it "
            "was written, or it was cut short; take another copy, or run again"
        )
    return True


def made(path: Path) -> bytes:
    """The seal that fits a file.

    Raises:
        OSError: the file cannot be read.
    """
    with path.open("rb", buffering=0) as file:
        file.seek(ROOM)
        digest = hashlib.file_digest(file, "sha256").hexdigest()
    return (_TITLE + _WORDS.format(digest)).encode().ljust(ROOM, b"\0")
