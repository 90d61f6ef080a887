"""Shared data of the tests: published tables, reference values, and one run of Tables 4-5."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

HOME = Path(__file__).parent.parent


@pytest.fixture(scope="session")
def published():
    """The study's printed tables."""
    return json.loads((HOME / "app" / "study" / "published_tables.json").read_text(encoding="utf-8"))


@pytest.fixture(scope="session")
def references():
    """Closed-form values computed with 40 digits."""
    path = HOME / "tests" / "reference" / "closed_form_values.json"
    return json.loads(path.read_text(encoding="utf-8"))


@pytest.fixture(scope="session")
def tables_run():
    """Datasets and attributes of scenes/tables4_5.toml."""
    return run_scene("tables4_5")


def run_scene(name, *changes):
    """Compute a scene of scenes/, its text changed by (old, new) pairs first."""
    from galinx.app.run.collector import Memory
    from galinx.app.run.compute import compute
    from galinx.app.scene.scene import parse

    text = (HOME / "scenes" / f"{name}.toml").read_text(encoding="utf-8")
    for old, new in changes:
        assert old in text, f"{old!r} is not in scenes/{name}.toml"
        text = text.replace(old, new)
    data = Memory()
    return data, compute(parse(text), data)


def command(*arguments, cwd=HOME):
    """Run ``./run.sh ARGUMENTS``; returns the finished process with its output as text."""
    return subprocess.run(
        [str(HOME / "run.sh"), *map(str, arguments)],
        cwd=cwd, env=clean_environment(), capture_output=True, text=True, timeout=300,
        stdin=subprocess.DEVNULL,
    )  # fmt: skip


def mpirun(ranks, *arguments):
    """The command that starts this Python on some ranks."""
    beside = Path(sys.executable).with_name("mpirun")
    program = str(beside) if beside.exists() else "mpirun"
    return [program, "-n", str(ranks), sys.executable, *map(str, arguments)]


def clean_environment():
    """The environment without what MPI leaves there, which a second mpirun would trip over."""
    mpi = ("OMPI_", "PMIX_", "PMI_", "PRTE_", "ORTE_", "HYDRA_", "HYDI_", "MPIR_")
    kept = {name: value for name, value in os.environ.items() if not name.startswith(mpi)}
    return kept | {
        "OMPI_ALLOW_RUN_AS_ROOT": "1",
        "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
        "OMPI_MCA_rmaps_base_oversubscribe": "1",
        "PRTE_MCA_rmaps_default_mapping_policy": ":oversubscribe",
        "PYTHONPATH": str(HOME),
    }
