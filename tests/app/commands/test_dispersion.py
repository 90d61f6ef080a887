"""The command that tells how fast waves along layers run."""

from support import HOME, command


def test_dispersion_of_a_scene(tmp_path):
    done = command("dispersion", HOME / "scenes" / "coating.toml", "-o", tmp_path / "waves.png")
    assert done.returncode == 0, done.stderr
    assert "highest speed of a punch: 919.40169 m/s" in done.stdout
    assert (tmp_path / "waves.png").stat().st_size > 10_000
    rows = [line.split() for line in done.stdout.splitlines()[1:] if line[0].isdigit()]
    assert len(rows) == 28 and 919.4 < float(rows[0][2]) < 935.0 and rows[-1][2] == "none"
    assert "\nto 100     to 6.28319e-05  none\n" in done.stdout  # and no row for each wave that leaks
    assert "none: no wave of that length is slower than the waves inside" in done.stdout


def test_a_scene_without_layers_has_one_speed(tmp_path):
    done = command("dispersion", HOME / "scenes" / "tables4_5.toml", "-o", tmp_path)
    assert done.returncode == 2 and "found no layers" in done.stderr
    assert not list(tmp_path.iterdir())
