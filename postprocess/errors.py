"""Failures of archives, apart from the library that reads them so that naming one costs nothing."""


class UnreadableArchive(Exception):
    """No archive, a damaged or changed one, or one of a newer layout; the message says what to do."""


class UnwritableArchive(Exception):
    """The file system refused an archive or another file; the message says why."""


class Occupied(Exception):
    """A file cannot have that name: what is there may not be replaced, or the ending is another's."""


class ArchiveInUse(UnwritableArchive):
    """Another run is writing the same archive."""


class LeftOver(UnwritableArchive):
    """An interrupted run left something; the message says what can be done with it."""
