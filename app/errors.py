"""Failures with an exit status of their own."""


class BadInput(Exception):
    """The user's input cannot be used; the message says what was found and what to do (status 2)."""


class MachineFailure(Exception):
    """The machine refused: a file, a package, memory (status 3)."""


#: Exit statuses of every command.
GOOD, FAILED_VERDICT, BAD_INPUT, FAILURE = 0, 1, 2, 3
