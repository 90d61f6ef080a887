"""Arrays in a file that is as it was written, or as good as none: it begins with a digest of the rest.

After the digest come the length of a text, the text, which is JSON, and the arrays. The checksums of
NumPy's own files leave names and sizes out, and cost more.
"""

import hashlib
import json
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx import files

_DIGEST, _LENGTH = hashlib.sha256().digest_size, 8


def packed(told: Any, arrays: dict[str, NDArray]) -> list[Any]:
    """A file's content, in pieces that are to follow each other.

    Args:
        told: what is said of the arrays, for JSON.
        arrays: by name, of numbers.
    """
    whole = {name: np.asarray(values, order="C") for name, values in arrays.items()}
    listed = [(name, values.dtype.str, values.shape) for name, values in whole.items()]
    text = json.dumps([told, listed]).encode()
    pieces: list[Any] = [len(text).to_bytes(_LENGTH), text, *(values.data for values in whole.values())]
    digest = hashlib.sha256()
    for piece in pieces:
        digest.update(piece)
    return [digest.digest(), *pieces]


def read(path: Path) -> tuple[Any, dict[str, NDArray]] | None:
    """What was told and the arrays; None if there is no such file, or not what :func:`packed` gave.

    Nothing looks into what does not fit its digest. Whatever reading raises, the file is not there.
    """
    try:
        data = files.read(path)
        if hashlib.sha256(memoryview(data)[_DIGEST:]).digest() != data[:_DIGEST]:
            return None
        start = _DIGEST + _LENGTH
        end = start + int.from_bytes(data[_DIGEST:start])
        told, listed = json.loads(data[start:end])
        arrays = {}
        for name, kind, shape in listed:
            arrays[name] = np.ndarray(shape, kind, data, end).copy()
            end += arrays[name].nbytes
        return told, arrays
    except Exception:
        return None
