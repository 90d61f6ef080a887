"""A signal that comes while a process ends changes neither its status nor what it says."""

import sys

import pytest
from support import SCENE, finished

#: With a signal when a function is entered: a job ends its ranks as soon as one says that it has failed.
SCRIPT = """
import os, pkgutil, signal, sys
module, name = sys.argv[1].rsplit(".", 1)
owner = pkgutil.resolve_name(f"galinx.app.{module}")
true = getattr(owner, name)

def hit(*given, **named):
    setattr(owner, name, true)
    os.kill(os.getpid(), signal.SIGTERM)
    return true(*given, **named)

setattr(owner, name, hit)
sys.argv = ["galinx", *sys.argv[2:]]
from galinx.__main__ import main
main()
"""
NOT_THERE = "error: cannot read no.toml: No such file or directory\n"
INTERRUPTED = "error: interrupted; nothing was written\n"


def ended(function, *words):
    """Status and messages of a command that gets a signal when a function of ``app`` is entered."""
    done = finished([sys.executable, "-c", SCRIPT, function, *words])
    return done.returncode, done.stderr


def test_a_failure_is_said_to_its_end():
    assert ended("ranks.from_environment", "plan", "no.toml") == (2, NOT_THERE)


@pytest.mark.parametrize(
    "function", ["process._check_machine", "cli._run", "scene.read.read", "process.too_late"]
)
def test_before_that_it_is_interrupted_wherever_it_is(function):
    assert ended(function, "plan", str(SCENE)) == (3, INTERRUPTED)


def test_a_failure_that_is_not_said_yet_is_interrupted():
    assert ended("process.too_late", "plan", "no.toml") == (3, INTERRUPTED)
