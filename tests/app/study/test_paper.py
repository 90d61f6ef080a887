"""The whole study in one command."""

from support import command


def test_the_study_is_reproduced(tmp_path):
    done = command("-n", "2", "paper", "-o", tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "verdict: PASS" in done.stdout and done.stdout.count(" ≤ 0.01 ") == 8
    names = [*(f"fig{n}" for n in (2, 5, 6, 7, 8, 9, 10)), "inside", "mesh"]
    figures = {f"{name}.{kind}" for name in names for kind in ("pdf", "png")}
    assert figures | {"study.h5", "inside.h5", "tables.txt", "report.html"} == {
        p.name for p in tmp_path.iterdir()
    }
