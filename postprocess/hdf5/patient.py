"""A file that HDF5 can always write to: it crashes where a disk refuses what it holds."""

import io
from pathlib import Path
from typing import Any


class PatientFile(io.RawIOBase):
    """A new file that takes every write, and keeps in memory what the disk refuses.

    Attributes:
        refusal: why the disk refused, None as long as it did not.
    """

    def __init__(self, path: Path) -> None:
        super().__init__()
        self._file = io.FileIO(path, "w+")
        self._kept: dict[int, bytes] = {}
        self.refusal: OSError | None = None

    def readable(self) -> bool:
        return True

    writable = seekable = readable

    def seek(self, offset: int, whence: int = io.SEEK_SET) -> int:
        return self._file.seek(offset, whence)

    def tell(self) -> int:
        return self._file.tell()

    def write(self, data: Any) -> int:
        start, view = self._file.tell(), memoryview(data).cast("B")
        done = 0
        try:
            while done < len(view) and self.refusal is None:
                done += self._file.write(view[done:])  # a disk that becomes full takes a part
        except OSError as error:
            self.refusal = error
        if done < len(view):
            self._kept[start + done] = bytes(view[done:])
            self._file.seek(start + len(view))
        return len(view)

    def readinto(self, buffer: Any) -> int:
        start, view = self._file.tell(), memoryview(buffer).cast("B")
        found = self._file.readinto(view) or 0
        view[found:] = bytes(len(view) - found)
        for offset, data in self._kept.items():
            first, last = max(offset, start), min(offset + len(data), start + len(view))
            if first < last:
                view[first - start : last - start] = data[first - offset : last - offset]
        self._file.seek(start + len(view))
        return len(view)

    def truncate(self, size: int | None = None) -> int:
        try:
            return self._file.truncate(size)
        except OSError as error:
            self.refusal = self.refusal or error
            return size or 0

    def close(self) -> None:
        self._file.close()
        super().close()
