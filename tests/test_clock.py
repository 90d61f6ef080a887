"""Wall time by step."""

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
