"""The whole study on two ranks; on one, tests/docs/test_pages.py runs it as the README does."""

import pytest
from support import THOROUGH, command


@pytest.mark.skipif(not THOROUGH, reason="takes long: GALINX_THOROUGH=1")
def test_two_ranks_reproduce_the_study(tmp_path):
    done = command("-n", "2", "paper", "-o", tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "verdict: PASS" in done.stdout and done.stdout.count(" ≤ 0.01 ") == 8
    assert (tmp_path / "study.h5").is_file() and (tmp_path / "fig10.pdf").is_file()
