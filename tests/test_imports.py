"""What importing galinx leaves of the process that does: its variables and its signals."""

import sys

from support import finished

#: Imports every module but those that run a program, and prints what that changed.
SCRIPT = """
import importlib, os, pkgutil, signal

def caught():
    words = open("/proc/self/status").read().split()
    mask = int(words[words.index("SigCgt:") + 1], 16)
    return {number for number in (signal.SIGTERM, signal.SIGHUP) if mask >> number - 1 & 1}

before, signals = dict(os.environ), caught()
import galinx
names = [module.name for module in pkgutil.walk_packages(galinx.__path__, "galinx.")]
for name in names:
    if not name.endswith("__main__"):
        importlib.import_module(name)
from petsc4py import PETSc
PETSc.Vec().createSeq(3).destroy()
assert "galinx.solvers.fem.space" in names and len(names) > 150, names
print({name for name, _ in before.items() ^ os.environ.items()}, caught() - signals,
      PETSc.Options("galinx_").getString("word", ""))
"""


def test_importing_galinx_changes_no_variable_and_takes_no_signal():
    """PETSc would take SIGTERM for a crash; options that a user gives it are read all the same."""
    done = finished([sys.executable, "-c", SCRIPT], PETSC_OPTIONS="-galinx_word given")
    assert done.returncode == 0, done.stderr
    assert done.stdout == "set() set() given\n"
