"""The one place where text goes to a terminal: what would command it is shown instead."""

import io
import re
import shutil
import sys
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from typing import Any

#: Control characters but for tabs and ends of lines, what turns the direction of writing or breaks lines,
#: and what names of files have for bytes that are not UTF-8.
_COMMANDS = re.compile(
    "[\x00-\x08\x0b-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069\ud800-\udfff]"
)

#: Columns in which a table can be read.
_NARROWEST = 40


def width() -> int:
    """Columns of the terminal, 80 where it is none; never so few that nothing could be read."""
    return max(shutil.get_terminal_size().columns, _NARROWEST)


def plain(text: str) -> str:
    r"""A text whose control characters are written out, ``\u001b`` for ESC as in JSON."""
    return _COMMANDS.sub(lambda found: f"\\u{ord(found[0]):04x}", text)


class Output(io.FileIO):
    """The output below Python's buffers: where it cannot be written, the message names it."""

    def __init__(self, number: int) -> None:
        super().__init__(number, "w", closefd=False)

    def write(self, data: Any) -> int:
        try:
            return super().write(data)
        except BrokenPipeError:
            raise
        except OSError as error:
            raise OSError(
                f"cannot write the output: {error.strerror}; make room, or send it elsewhere"
            ) from None


class PlainStream:
    """A text stream that is written plain text only.

    Args:
        bare: where the text goes; also for those who write control characters of their own.
    """

    def __init__(self, bare: Any) -> None:
        self.bare = bare

    def write(self, text: str) -> int:
        self.bare.write(plain(text))
        return len(text)

    def writelines(self, lines: list[str]) -> None:
        for line in lines:
            self.write(line)

    def __getattr__(self, name: str) -> Any:
        return getattr(self.bare, name)


def bare(stream: Any) -> Any:
    """The stream below, for colours and bars; texts of others have to be made plain before."""
    return getattr(stream, "bare", stream)


@contextmanager
def plain_streams() -> Iterator[None]:
    """For a block: whoever prints, what reaches the output and error streams is plain."""
    out, err = (stream and PlainStream(stream) for stream in (sys.stdout, sys.stderr))
    with redirect_stdout(out), redirect_stderr(err):
        yield
