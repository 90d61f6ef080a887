"""Files that appear whole or not at all, and files that are read without waiting for anybody."""

import errno
import os
import secrets
import stat
from contextlib import suppress
from pathlib import Path

#: Names of open descriptors: whoever started the program chose them, be it a pipe or a terminal.
_OPEN = ("/dev/stdin", "/dev/fd/", "/proc/self/fd/")
#: Errors of file systems without hard links when one is made.
_NO_LINKS = {errno.EPERM, errno.EOPNOTSUPP, errno.ENOSYS}

#: Hidden names of files in the making.
_unfinished: set[Path] = set()


class NewFile:
    """A file in the making: it has a hidden name until :meth:`publish` gives it its own.

    Use it as a context manager and write to ``temporary``; a file that is not published is removed.

    Args:
        path: final name, not that of a link.
        folder: where it is written, on the same file system; beside its final name if not given.

    Attributes:
        temporary: hidden name, ``.*.partial``; the file is there, and empty.

    Raises:
        OSError: the file system refused.
    """

    def __init__(self, path: Path, folder: Path | None = None) -> None:
        self.path = path
        # Not made of the final name, to which nothing may be added where it is as long as can be.
        self.temporary = (folder or path.parent) / f".{os.getpid()}-{secrets.token_hex(4)}.partial"

    def __enter__(self) -> "NewFile":
        _unfinished.add(self.temporary)
        os.close(os.open(self.temporary, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, 0o666))
        return self

    def __exit__(self, *_: object) -> None:
        with suppress(OSError):
            self.temporary.unlink()
        _unfinished.discard(self.temporary)

    def publish(self, replace: bool) -> None:
        """Bring the file to the disk, then give it its name, at once.

        Args:
            replace: a file of that name; its permissions are kept.

        Raises:
            FileExistsError: the name exists, and ``replace`` is false.
            OSError: the file system refused; the file that was there before is still there.
        """
        if replace:
            with suppress(FileNotFoundError):
                os.chmod(self.temporary, stat.S_IMODE(os.stat(self.path).st_mode))
        synchronise(self.temporary)
        if replace:
            os.replace(self.temporary, self.path)
        else:
            self._link()
        with suppress(OSError):  # some file systems cannot synchronise folders
            synchronise(self.path.parent)

    def _link(self) -> None:
        """Take a name that is free: a rename would replace a file that appeared a moment ago."""
        try:
            os.link(self.temporary, self.path)
        except OSError as error:
            if error.errno not in _NO_LINKS:
                raise
            os.close(os.open(self.path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC))
            os.replace(self.temporary, self.path)


def write(path: Path, data: bytes, replace: bool = True) -> None:
    """Write a file beside its name, bring it to the disk, and give it its name at once.

    Raises:
        FileExistsError: the name exists, and ``replace`` is false.
        OSError: the file system refused; the file that was there before is still there, and no other.
    """
    with NewFile(path) as new:
        new.temporary.write_bytes(data)
        new.publish(replace)


def give_up() -> None:
    """Remove all files in the making, for a process that ends where it stands."""
    for path in _unfinished:
        with suppress(OSError):
            path.unlink()


def synchronise(path: Path) -> None:
    """Wait until a file, or the names in a folder, are on the disk.

    Raises:
        OSError: the file system refused.
    """
    handle = os.open(path, os.O_RDONLY | os.O_CLOEXEC)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


def expect_file(path: Path) -> None:
    """Check that a file is a regular one, before it is opened: opening a FIFO would wait for a writer.

    Raises:
        OSError: it is not there, or is a folder, FIFO, device or socket.
    """
    mode = os.stat(path).st_mode
    if not stat.S_ISREG(mode):
        number = errno.EISDIR if stat.S_ISDIR(mode) else errno.EINVAL
        raise OSError(number, f"it is {noun(mode)}, expected a file")


def read(path: Path, most: int = -1) -> bytes:
    """Content of a regular file, or of standard input and other open descriptors by their names.

    Args:
        path: the file.
        most: largest number of bytes to read; all if negative.

    Raises:
        OSError: it cannot be read, or is a folder, FIFO, device or socket.
    """
    if not str(path).startswith(_OPEN):
        expect_file(path)
    with open(path, "rb") as file:
        return file.read(most)


def noun(mode: int) -> str:
    """Noun with its article for a kind of file, by its ``st_mode``."""
    if stat.S_ISDIR(mode):
        return "a folder"
    if stat.S_ISFIFO(mode):
        return "a FIFO"
    if stat.S_ISSOCK(mode):
        return "a socket"
    return "a file" if stat.S_ISREG(mode) else "a device"
