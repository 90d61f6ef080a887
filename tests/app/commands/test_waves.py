"""Commands on waves: how fast those along layers run, what a punch answers to loads that oscillate."""

from support import HOME, here


def test_dispersion_of_a_scene(tmp_path):
    done = here("dispersion", HOME / "scenes" / "coating.toml", "-o", tmp_path / "waves.png")
    assert done.returncode == 0, done.stderr
    assert "highest speed of a punch: 919.40169 m/s" in done.stdout
    assert (tmp_path / "waves.png").stat().st_size > 10_000
    rows = [line.split() for line in done.stdout.splitlines()[1:] if line[0].isdigit()]
    assert len(rows) == 28 and 919.4 < float(rows[0][2]) < 935.0 and rows[-1][2] == "none"
    assert "\nto 100     to 6.28319e-05  none\n" in done.stdout  # and no row for each wave that leaks
    assert "none: no wave of that length is slower than the waves inside" in done.stdout


def test_a_scene_without_layers_has_one_speed(tmp_path):
    done = here("dispersion", HOME / "scenes" / "tables4_5.toml", "-o", tmp_path)
    assert done.returncode == 2 and "found no layers" in done.stderr
    assert not list(tmp_path.iterdir())


START = HOME / "scenes" / "start_from_rest.toml"


def numbers(text):
    return [[float(cell) for cell in line.split()] for line in text.splitlines() if line[:1].isdigit()]


def test_response_of_a_scene(tmp_path):
    words = ["--points", "3", "--from", "0.1", "--to", "2", "--set", "motion.c=[0.0, 0.5]"]
    done = here("response", START, "-o", tmp_path / "punch.png", *words)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "punch.png").stat().st_size > 10_000
    found = numbers(done.stdout)
    assert [row[0] for row in found] == [0.1, 0.4472, 2.0] * 2
    c_s, a = (200e9 / 2.5 / 7800.0) ** 0.5, 1e-3
    for ω, hertz, stiff, damping, flexible, lag in found:
        assert abs(hertz / (ω * c_s / a / 6.283185) - 1.0) < 1e-4
        assert abs(flexible * (stiff**2 + damping**2) ** 0.5 - 1.0) < 1e-4
        assert -90.0 < lag < 0.0  # it lags behind: waves take work


def test_what_has_no_answer_is_refused(tmp_path):
    for words, said in (
        (["--set", "motion.c=0.95"], "is not below the Rayleigh speed"),
        (["--to", "50", "--set", "motion.c=0.9"], "expected at most"),
        (["--from", "2", "--to", "1"], "expected them to grow"),
        (["--set", "solid.nu=0.499"], "expected a uniform solid"),
        (["--set", 'punch.solid.material="steel"'], "found an elastic punch"),
    ):
        done = here("response", START, "-o", tmp_path, *words)
        assert done.returncode == 2 and said in done.stderr, done.stderr
    hump = ["--set", "solve.pressure=[[-1, 0], [0, -2], [1, 0]]"]
    for name, words, said in (
        ("cylinder", [], "expected a level flat punch"),
        ("traction", hump, "found an elastic punch, a prescribed pressure"),
        ("box", [], 'found solve.mesh = "box", expected no walls'),
    ):
        done = here("response", HOME / "scenes" / f"{name}.toml", "-o", tmp_path, *words)
        assert done.returncode == 2 and said in done.stderr, done.stderr
    assert not list(tmp_path.iterdir())
