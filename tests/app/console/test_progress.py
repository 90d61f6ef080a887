"""What a run tells while it goes on."""

from galinx.app.console import Progress


def test_warnings_are_heard_however_quiet_the_run_is(capsys, tmp_path):
    for n, options in enumerate(({}, {"quiet": True}, {"verbose": True})):
        with Progress(**options, log=tmp_path / f"{n}.log") as progress:
            progress.warn("a mesh is damaged")
        assert capsys.readouterr().err == "warning: a mesh is damaged\n"
        assert "warning: a mesh is damaged" in (tmp_path / f"{n}.log").read_text(encoding="utf-8")


def test_a_warning_does_not_tear_the_bar(capsys, monkeypatch):
    monkeypatch.setattr("sys.stderr.isatty", lambda: True)
    with Progress() as progress:
        progress.say("at work")
        progress.warn("a form [of 3] is damaged")
    assert "warning: a form [of 3] is damaged" in capsys.readouterr().err
