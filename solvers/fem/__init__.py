"""Finite elements in dolfinx for the moving-frame equations: forms, space, punch, contacts, sweeps."""

import petsc4py

# A PETSc from PyPI finds its MPI only where that is loaded already.
from mpi4py import MPI  # noqa: F401

# PETSc would take signals for crashes and abort: SIGTERM has to let a run keep what is finished. Where
# PETSc was initialised before, this does nothing; PETSC_OPTIONS of the environment are read as well.
petsc4py.init(["-no_signal_handler"])
