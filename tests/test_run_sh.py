"""The script that starts everything, where it cannot."""

import os
import subprocess

from support import HOME, SCENE, clean_environment


def test_without_rights_the_command_for_an_administrator_is_shown(tmp_path):
    for name, text in (("dpkg-query", "exit 1"), ("id", "echo 1000")):
        (tmp_path / name).write_text(f"#!/bin/sh\n{text}\n", encoding="utf-8")
        (tmp_path / name).chmod(0o755)
    path = f"{tmp_path}:{os.environ['PATH']}"
    environment = clean_environment() | {"PATH": path}
    environment.pop("GALINX_PYTHON", None)  # nothing is installed for another Python
    done = subprocess.run(
        [str(HOME / "run.sh"), "plan", str(SCENE)], env=environment,
        capture_output=True, text=True, timeout=60,
    )  # fmt: skip
    assert done.returncode == 3
    assert "apt-get install --no-install-recommends python3-dolfinx" in done.stderr
