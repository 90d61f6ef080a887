"""Arrays in a file that is read as it was written or not at all: it ends with a digest of the rest.

Before the digest come the length of a text, the text, which is JSON, and the arrays. The checksums of
NumPy's own files leave names and sizes out, and cost more.
"""

import hashlib
import json
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx import files

_SIZE, _LENGTH = hashlib.sha256().digest_size, 8


def packed(heading: Any, arrays: dict[str, NDArray]) -> Iterator[Any]:
    """Content of a file in consecutive pieces, whose digest is computed while they are written.

    Args:
        heading: description of the arrays, for JSON.
        arrays: by name, of numbers.
    """
    whole = {name: np.asarray(values, order="C") for name, values in arrays.items()}
    listed = [(name, values.dtype.str, values.shape) for name, values in whole.items()]
    text = json.dumps([heading, listed]).encode()
    pieces: list[Any] = [len(text).to_bytes(_LENGTH), text, *(values.data for values in whole.values())]
    with ThreadPoolExecutor(1) as beside:
        digest = beside.submit(_digest, pieces)
        yield from pieces
        yield digest.result()


def _digest(pieces: list[Any]) -> bytes:
    digest = hashlib.sha256()
    for piece in pieces:
        digest.update(piece)
    return digest.digest()


def read(path: Path) -> tuple[Any, dict[str, NDArray]] | None:
    """The heading and the arrays; None if there is no such file, or not as :func:`packed` made it.

    Data that do not fit their digest are not parsed. Any error of reading counts as no file.
    """
    try:
        data = files.read(path)
        if _digest([memoryview(data)[:-_SIZE]]) != data[-_SIZE:]:
            return None
        end = _LENGTH + int.from_bytes(data[:_LENGTH])
        heading, listed = json.loads(data[_LENGTH:end])
        arrays = {}
        for name, kind, shape in listed:
            arrays[name] = np.ndarray(shape, kind, data, end).copy()
            end += arrays[name].nbytes
        return heading, arrays
    except Exception:
        return None
