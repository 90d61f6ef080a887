"""Writes what the program itself knows: docs/commands.md, docs/scene.md, scenes/scene.schema.json.

``./run.sh docs`` runs it before it builds the pages; alone: ``PYTHONPATH=. python3 docs/make.py``.
mkdocs loads it as a hook, so the program is imported only where pages are made.
"""

import json
from pathlib import Path
from textwrap import fill
from typing import Any

HOME = Path(__file__).resolve().parent.parent

_COMMANDS = """\
# Commands

Written by `docs/make.py` from the program; `./run.sh COMMAND --help` prints the same. Every command
has the option `-h` or `--help`.

`./run.sh` without a command reproduces the study, like `./run.sh paper -o results`. Paths are relative to
the folder you are in. Exit status:

| status | meaning |
|---|---|
| 0 | good |
| 1 | the verdict is FAIL, or an archive has faults |
| 2 | bad input: the message says which key or option, and what was expected |
| 3 | failure of program or machine |

Words that `run.sh` knows besides the commands:

| word | what it does |
|---|---|
| `./run.sh test` | run all tests, those on two ranks included |
| `./run.sh bench` | measure run time against error, see [Benchmarks](benchmarks.md) |
| `./run.sh docs` | write these reference pages and build all pages as HTML into `site/` |
| `./run.sh -n RANKS COMMAND …` | run a command on several MPI ranks of this machine |
"""

_SCENE = """\
# Scenes

Written by `docs/make.py` from the classes that check scenes.

A scene is a TOML file that says what is to be computed. The shortest one:

```toml
[solid]
material = "steel"
[friction]
mu_c = 0.5                       # dimensionless
sigma0_over_load = "25000 1/m"
[motion]
c = 0.3                          # over the shear wave speed
```

- A number is in the unit of its row. A text carries its own unit: `"193 GPa"`, `"1 mm"`, `"1.5 mm/s"`.
  A unit of another dimension is an error.
- `c` or `speed`, `mu_c`, `sigma0_over_load` and `delta` may be lists. All their combinations are
  computed, each on all `strokes` at all `X_over_L`. Every combination is a state. States are numbered
  from 0; `c` changes most slowly, then `mu_c`, `sigma0_over_load`, `delta`, stroke and position.
- A key that the program does not know is an error, with the nearest known key in the message.
- Strokes are called FM1, FM2, … (forward) and BM1, BM2, … (backward) in results.

Editors that read JSON schemas for TOML complete and check scenes by `scenes/scene.schema.json`, the
output of `./run.sh schema`. The first line of the scenes in `scenes/` names it.

`title` stands before the sections: free text, shown above tables and figures.
"""

#: What a row says beyond the program's own short meaning.
_NOTES = {
    "solid.plane": '`"stress"` is a thin sheet',
    "solid.material": "E, nu or rho written beside it replace the material's",
    "punch.half_width": "dimensionless results do not depend on it",
    "punch.load": "dimensionless results do not depend on it",
    "friction.sigma0_over_load": "the slope of f over slip where f = 0",
    "friction.delta": "below 1, full slip is reached after a finite slip",
    "friction.pre_sliding": "the length of a stroke",
    "friction.integrator": '`"rk4"`: Runge-Kutta with 20 steps a stroke, refused where it is unstable',
    "friction.sign": '`"physical"`: σ_XY = -f σ_YY; `"eq25"`: σ_XY = f σ_YY, the mirror image',
    "motion.c": "finite elements want it below the Rayleigh speed",
    "motion.speed": "divided by the shear wave speed of the solid",
    "motion.X_over_L": "on the same axis in both directions",
    "solve.methods": "an empty list where only friction is asked for",
    "solve.tolerance": "the polynomial degree rises until the measured error is below it",
    "solve.mesh": '`"box"` is the block of the study, with walls at 100 a',
    "solve.mode": '`"traction"`: pressure put in, see [Theory](theory.md)',
    "solve.pressure": "for the mode traction",
    "output.quantities": "`sif`: K_I and exponents; `surface`: stresses on Y = 0; `interior`: inside",
    "output.points": 'needs the quantity `"interior"`; Y/a < 0',
    "output.map": 'needs the quantity `"interior"`; Y/a < 0',
}

_CHOICES = {
    "motion.c": "one of `c` and `speed`",
    "motion.speed": "one of `c` and `speed`",
    "solid.material": "none",
    "output.map": "none",
    "output.points": "none",
}
_CONSTANTS = ("solid.E", "solid.nu", "solid.rho")


def commands_page() -> str:
    """Every command: what it does, usage, example, options."""
    import click

    from galinx.app.cli import cli

    parts = [_COMMANDS]
    for name, command in cli.commands.items():
        context = click.Context(command, info_name=f"./run.sh {name}", help_option_names=[])
        about, _, example = (command.help or "").partition("Example:")
        usage = " ".join([context.info_name or "", *command.collect_usage_pieces(context)])
        options = (p for p in command.params if isinstance(p, click.Option))
        rows = [record for p in options if (record := p.get_help_record(context))]
        parts.append(f"## {name}\n\n{fill(_plain(about), 106)}\n\nUsage: `{usage}`\n")
        if example:
            parts.append(f"Example:\n\n    {' '.join(example.split())}\n")
        if rows:
            parts.append(_table(("option", "meaning"), [(f"`{names}`", text) for names, text in rows]))
    return "\n".join(parts)


def scene_page() -> str:
    """Every section and key of a scene, and the known materials."""
    import attrs

    from galinx.app.scene.materials import LIBRARY
    from galinx.app.scene.schema import schema
    from galinx.app.scene.sections import SECTIONS

    known = {f"{name}.{field.name}" for name, kind in SECTIONS.items() for field in attrs.fields(kind)}
    stale = ({*_NOTES, *_CHOICES, *_CONSTANTS}) - known
    if stale:
        raise ValueError(f"docs/make.py speaks of keys that scenes do not have: {', '.join(stale)}")
    properties = schema()["properties"]
    parts = [_SCENE]
    for name, kind in SECTIONS.items():
        described = properties[name]["properties"]
        rows = [_row(name, field, described[field.name]) for field in attrs.fields(kind)]
        heads = ("key", "value", "default", "allowed", "meaning")
        parts += [f"## [{name}]\n", _table(heads, rows)]
    parts.append("## Materials\n\nNames for `solid.material`; `./run.sh materials` prints them.\n")
    rows = [(f"`{n}`", m.about, m.E, f"{m.nu:g}", m.rho, m.source) for n, m in LIBRARY.items()]
    parts.append(_table(("name", "solid", "E", "ν (dimensionless)", "ρ", "source"), rows))
    return "\n".join(parts)


def schema_text() -> str:
    """The JSON schema of scenes as ``./run.sh schema`` prints it."""
    from galinx.app.scene.schema import schema

    return json.dumps(schema(), ensure_ascii=False, indent=1) + "\n"


def pages() -> dict[Path, str]:
    """All files that are made, and their text."""
    return {
        HOME / "docs" / "commands.md": commands_page(),
        HOME / "docs" / "scene.md": scene_page(),
        HOME / "scenes" / "scene.schema.json": schema_text(),
    }


def on_files(files: Any, **_: Any) -> Any:
    """For mkdocs: the site holds pages, pictures and the notebook, no programs."""
    for file in list(files):
        if file.src_path.endswith((".py", ".pyc")):
            files.remove(file)
    return files


def _row(section: str, field: Any, described: dict[str, Any]) -> tuple[str, ...]:
    path, convert, about = f"{section}.{field.name}", field.metadata["convert"], field.metadata["doc"]
    if path in _CHOICES:
        default = _CHOICES[path]
    elif "default" in described:
        default = f"`{json.dumps(described['default'], ensure_ascii=False)}`"
    else:
        default = "required, or `material`" if path in _CONSTANTS else "required"
    meaning = "; ".join(filter(None, (about, _NOTES.get(path))))
    return f"`{field.name}`", _value(convert), default, _allowed(described), meaning


def _value(convert: Any) -> str:
    """What kind of value a key wants."""
    text = _plain(type(convert).__doc__ or "").replace("``", "`").rstrip(".")
    unit = getattr(convert, "unit", None)
    if unit is not None:
        several = " or a list" if type(convert).__name__ == "Numbers" else ""
        return f"number [{unit or 'dimensionless'}]{several}"
    return text[0].lower() + text[1:] if text[:2] != "`{" else text


def _allowed(described: Any) -> str:
    """The limits in an entry of the schema, wherever they stand."""
    signs = {"exclusiveMinimum": ">", "minimum": ">=", "exclusiveMaximum": "<", "maximum": "<="}
    if isinstance(described, list):
        return next(filter(None, map(_allowed, described)), "")
    if not isinstance(described, dict):
        return ""
    if "enum" in described:
        return ", ".join(f'`"{value}"`' for value in described["enum"])
    limits = [f"{sign} {described[key]:g}" for key, sign in signs.items() if key in described]
    inner = (value for key, value in described.items() if key in ("anyOf", "items"))
    return ", ".join(limits) or next(filter(None, map(_allowed, inner)), "")


def _plain(text: str) -> str:
    return " ".join(text.split())


def _table(heads: tuple[str, ...], rows: list[tuple[str, ...]]) -> str:
    lines = [heads, ("---",) * len(heads)] + [[c.replace("|", "\\|") for c in row] for row in rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"


if __name__ == "__main__":
    for path, text in pages().items():
        path.write_text(text, encoding="utf-8")
        print(f"written: {path.relative_to(HOME)}")
