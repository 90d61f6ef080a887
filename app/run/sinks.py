"""Where results go."""

from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.quantities import declared


class Sink(Protocol):
    """Where results go: an archive in the making, or memory.

    Every path has to be in the table of quantities; an unknown one raises KeyError.
    """

    def put(self, name: str, value: Any) -> None:
        """A whole dataset."""

    def reserve(self, name: str, shape: tuple[int, ...]) -> None:
        """Room for a dataset that comes by rows."""

    def write(self, name: str, rows: slice, values: NDArray) -> None:
        """Rows of a reserved dataset."""


class Memory(dict[str, Any]):
    """A sink that keeps the datasets by path, as an archive would give them back."""

    def put(self, name: str, value: Any) -> None:
        self[declared(name).path] = np.array(value, dtype=object) if isinstance(value, list) else value

    def reserve(self, name: str, shape: tuple[int, ...]) -> None:
        self[declared(name).path] = np.full(shape, np.nan)

    def write(self, name: str, rows: slice, values: NDArray) -> None:
        self[name][rows] = values


class Nowhere:
    """The sink of ranks other than 0."""

    def put(self, name: str, value: Any) -> None:
        declared(name)

    def reserve(self, name: str, shape: tuple[int, ...]) -> None:
        declared(name)

    def write(self, name: str, rows: slice, values: NDArray) -> None:
        pass
