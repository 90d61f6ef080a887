"""What a result was computed with."""

import platform
import sys

from galinx.app import ranks

#: Libraries that numbers depend on, by the module that knows the version.
_LIBRARIES = ("numpy", "scipy", "dolfinx", "petsc4py", "mpi4py", "gmsh", "h5py")


def libraries() -> dict[str, str]:
    """Versions of Python and of the libraries that were used so far: nothing is imported for this."""
    found = {"Python": platform.python_version()}
    for name in _LIBRARIES:
        version = getattr(sys.modules.get(name), "__version__", None)
        if version:
            found[name] = str(version)
    return found


def machine() -> str:
    """System and number of ranks."""
    count = ranks.size()
    return f"{platform.system()} {platform.machine()}, {count} rank{'s' * (count > 1)}"
