"""What a run tells while it goes on."""

from galinx.app.console import Progress


def test_warnings_are_heard_however_quiet_the_run_is(capsys, tmp_path):
    for n, options in enumerate(({}, {"quiet": True}, {"verbose": True})):
        with Progress(**options, log=tmp_path / f"{n}.log") as progress:
            progress.warn("a mesh is damaged")
        assert capsys.readouterr().err == "warning: a mesh is damaged\n"
        assert "warning: a mesh is damaged" in (tmp_path / f"{n}.log").read_text(encoding="utf-8")
