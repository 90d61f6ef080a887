"""Finite elements in dolfinx for the moving-frame equations: forms, space, punch, surface."""

import os

# PETSc would take signals for crashes and abort: SIGTERM has to let a run keep what is finished.
os.environ["PETSC_OPTIONS"] = f"-no_signal_handler {os.environ.get('PETSC_OPTIONS', '')}"

# A PETSc from PyPI finds its MPI only where that is loaded already.
from mpi4py import MPI  # noqa: F401
