"""Failures of archives, apart from the library that reads them so that naming one costs nothing."""


class UnreadableArchive(Exception):
    """No archive, a damaged one, or one of a newer layout; the message says what to do."""


class UnwritableArchive(Exception):
    """The file system refused an archive or another file; the message says why."""


class Occupied(Exception):
    """What is there may not be replaced; the message says what it is, and what to do."""


class ArchiveInUse(UnwritableArchive):
    """Another run is writing the same archive."""


class LeftOver(UnwritableArchive):
    """An interrupted run left something; the message says what can be done with it."""
