"""Failures of the mechanics, apart from the libraries that meet them."""


class SolveError(RuntimeError):
    """A solve has no usable result; the message says what was tried and what came of it."""


class NoContact(SolveError):
    """The contact of a state would be wider than what is known of the punch; others may be narrower."""


class MeshError(ValueError):
    """A mesh lacks a boundary or a region that the half-plane needs; the message names it."""


class CompilerError(Exception):
    """A form could not be compiled; the message says why."""
