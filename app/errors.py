"""Failures with an exit status of their own."""

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
        raise MachineFailure(
            f"finite elements need {error.name}, which is not installed; "
            "./run.sh in galinx's folder installs what is missing, or see its docs/install.md"
        ) from error


#: Exit statuses of every command.
GOOD, FAILED_VERDICT, BAD_INPUT, FAILURE = 0, 1, 2, 3
