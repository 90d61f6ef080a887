"""Failures with an exit status of their own, and texts of messages: excerpts of values, hints at valid
words."""

import reprlib
import sys
from collections.abc import Collection, Iterable, Iterator
from contextlib import contextmanager
from difflib import get_close_matches
from math import log10


class BadInput(Exception):
    """The user's input cannot be used; the message says what was found and what to do (status 2)."""


class MachineFailure(Exception):
    """The machine refused: a file, a package, memory (status 3)."""


def text_of(data: bytes, path: object, expected: str) -> str:
    """Text of a file, in UTF-8.

    Args:
        data, path: the file's bytes and its name.
        expected: what it should be, in words.

    Raises:
        BadInput: it is no text, or in another code.
    """
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        if b"\0" in data and not data.startswith((b"\xff\xfe", b"\xfe\xff")):
            raise BadInput(f"{path} is no text file, expected {expected}") from None
        raise BadInput(f"{path} is not UTF-8 (byte {error.start}); save it as UTF-8") from None


@contextmanager
def finite_elements_installed() -> Iterator[None]:
    """Context of imports; its failure says what to do where a library is missing.

    Raises:
        MachineFailure: a library is missing.
    """
    try:
        yield
    except ImportError as error:
        raise MachineFailure(f"finite elements: {unavailable(error)}") from error


def unavailable(error: ImportError) -> str:
    """Message with what to do where a library is missing, or is there and cannot be loaded."""
    if isinstance(error, ModuleNotFoundError):
        return (
            f"{error.name} is not installed for {sys.executable}; in galinx's folder ./run.sh installs "
            "what is missing on Debian, pip install '.[fem]' elsewhere; see docs/install.md there"
        )
    return f"a library cannot be loaded: {error}"


#: Exit statuses of every command.
GOOD, FAILED_VERDICT, BAD_INPUT, FAILURE = 0, 1, 2, 3


class _Excerpt(reprlib.Repr):
    """Values as Python writes them, cut where they are long or deep."""

    def __init__(self) -> None:
        super().__init__()
        self.maxlevel, self.maxlist, self.maxdict = 3, 6, 6
        self.maxstring = self.maxother = 80

    def repr_int(self, x: int, level: int) -> str:
        bits = x.bit_length()  # Python itself refuses to write 4300 digits
        return repr(x) if bits <= 200 else f"a whole number of about {round(bits * log10(2.0))} digits"


#: A value for a message.
excerpt = _Excerpt().repr


def listed(texts: list[str], most: int = 8) -> str:
    """Texts with commas between them, the middle of many left out."""
    if len(texts) <= most:
        return ", ".join(texts)
    return f"{', '.join(texts[: most - 2])}, … {texts[-1]} ({len(texts)} in all)"


def short(text: str, most: int = 80) -> str:
    """A text, cut where it is long."""
    return text if len(text) <= most else f"{text[: most - 1]}…"


def meant(word: str, valid: Iterable[str]) -> str:
    """Hint at the nearest valid word for the end of a message; "" where nothing is near."""
    by_lower_case = {name.lower(): name for name in valid}
    one_of_two = 0.5 if len(word) == 2 else 0.6
    close = get_close_matches(short(word).lower(), by_lower_case, 1, one_of_two)
    return f"; did you mean {by_lower_case[close[0]]}?" if close else ""


def nearest(key: str, valid: Collection[str]) -> str:
    """Hint at the nearest valid word for the end of a message, or else at all valid words."""
    return meant(key, valid) or f"; valid: {', '.join(valid)}"


def require_one_of(what: str, word: str, valid: Collection[str]) -> str:
    """A word that is one of the valid ones.

    Raises:
        BadInput: it is not; the message names the nearest, or all.
    """
    if not isinstance(word, str):
        raise BadInput(f"{what}: found {excerpt(word)}, expected a text; valid: {', '.join(valid)}")
    if word in valid:
        return word
    raise BadInput(f"{what} {short(word)!r}: there is none{nearest(word, valid)}")
