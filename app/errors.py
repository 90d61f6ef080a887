"""Failures with an exit status of their own."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager


class BadInput(Exception):
    """The user's input cannot be used; the message says what was found and what to do (status 2)."""


class MachineFailure(Exception):
    """The machine refused: a file, a package, memory (status 3)."""


@contextmanager
def finite_elements_installed() -> Iterator[None]:
    """For a block of imports: says what to do where a library is missing.

    Raises:
        MachineFailure: one is.
    """
    try:
        yield
    except ImportError as error:
        raise MachineFailure(f"finite elements: {unavailable(error)}") from error


def unavailable(error: ImportError) -> str:
    """What to do where a library is missing, or is there and cannot be loaded."""
    if isinstance(error, ModuleNotFoundError):
        return (
            f"{error.name} is not installed for {sys.executable}; in galinx's folder ./run.sh installs "
            "what is missing on Debian, pip install '.[fem]' elsewhere; see docs/install.md there"
        )
    return f"a library cannot be loaded: {error}"


#: Exit statuses of every command.
GOOD, FAILED_VERDICT, BAD_INPUT, FAILURE = 0, 1, 2, 3
