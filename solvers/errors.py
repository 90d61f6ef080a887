"""Failures of the mechanics, apart from the libraries that meet them."""


class SolveError(RuntimeError):
    """A solve has no usable result; the message says what was tried and what came of it."""


class NoContact(SolveError):
    """No contact that the punch is known over carries a state's load; other states may have one."""


class MeshError(ValueError):
    """A mesh lacks a boundary or a region that the half-plane needs; the message names it."""


class CompilerError(Exception):
    """A form could not be compiled; the message says why."""
