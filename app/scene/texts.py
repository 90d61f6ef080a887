"""Every text of a scene is looked at before any work: HDF5 refuses some at the end."""

from collections import deque
from collections.abc import Iterator
from typing import Any

from galinx.texts import unseen


def control_characters(tree: dict[str, Any]) -> Iterator[str]:
    """A fault for each text or key of a scene with a control character; its place is named."""
    waiting: deque[tuple[str, Any]] = deque([("", tree)])  # deeper than Python's calls may be
    while waiting:
        place, value = waiting.popleft()
        if isinstance(value, str):
            if fault := unseen(value):
                yield f"{place}: {fault}"
        elif isinstance(value, list):
            texts = (str, list, dict)
            waiting += ((f"{place}[{i}]", one) for i, one in enumerate(value) if isinstance(one, texts))
        elif isinstance(value, dict):
            for key, one in value.items():
                inside = f"{place}.{repr(key)[1:-1]}".removeprefix(".")
                if fault := unseen(key):
                    yield f"the key {inside}: {fault}"
                waiting.append((inside, one))
