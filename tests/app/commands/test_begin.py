"""Commands to begin with: init, schema."""

from support import HOME, here

from galinx.app.scene.library import templates
from galinx.app.scene.read import read


def test_init_writes_a_scene_once(tmp_path):
    assert here("init", "own_material", "-o", "mine.toml", cwd=tmp_path).returncode == 0
    scene = read(tmp_path / "mine.toml")
    assert scene.solid.E == 3.3e9 and "#:schema" not in scene.text
    before = (tmp_path / "mine.toml").read_bytes()
    again = here("init", "tables4_5", "-o", "mine.toml", cwd=tmp_path)
    assert again.returncode == 2 and "exists" in again.stderr
    assert (tmp_path / "mine.toml").read_bytes() == before
    unknown = here("init", "fig99", cwd=tmp_path)
    assert unknown.returncode == 2 and "did you mean fig9?" in unknown.stderr
    unknown = here("init", "zzz", cwd=tmp_path)
    assert unknown.returncode == 2 and "own_material" in unknown.stderr
    listed = here("init", cwd=tmp_path).stdout
    assert all(name in listed for name in templates())


def test_the_schema_is_what_the_command_prints():
    assert here("schema").stdout == (HOME / "scenes" / "scene.schema.json").read_text(encoding="utf-8")
