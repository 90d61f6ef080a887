"""Wall time by step."""

import subprocess
import sys
import time

from support import HOME, clean_environment

from galinx import clock
from galinx.clock import Clock


def test_steps_add_up_to_all_that_went_by(monkeypatch):
    now = [0.0]
    monkeypatch.setattr(clock, "perf_counter", lambda: now[0])
    told = Clock("rest", seconds=0.5)

    def passes(seconds):
        now[0] += seconds

    passes(1.0)
    with told("outer"):
        passes(2.0)
        with told("inner"):
            passes(4.0)
        passes(8.0)
        with told("inner"):
            passes(16.0)
    passes(32.0)
    told.lap()
    assert told == {"rest": 33.5, "outer": 10.0, "inner": 20.0}
    assert sum(told.values()) == now[0] + 0.5


def test_a_process_knows_its_age():
    program = "import time; time.sleep(0.5); from galinx.clock import age; print(age())"
    started = time.monotonic()
    done = subprocess.run(
        [sys.executable, "-c", program], env=clean_environment() | {"PYTHONPATH": str(HOME)},
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert 0.5 < float(done.stdout) <= time.monotonic() - started + 0.02
