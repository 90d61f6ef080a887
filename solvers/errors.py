"""Failures of the mechanics, apart from the libraries that meet them."""


class SolveError(RuntimeError):
    """A linear solve gave nothing that can be used; the message says what was found."""


class MeshError(ValueError):
    """A mesh lacks what the half-plane needs; the message names it."""


class CompilerError(Exception):
    """A form could not be compiled; the message says why."""
