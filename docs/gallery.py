"""Writes the pictures of the gallery: ``PYTHONPATH=. python3 docs/gallery.py``, a minute.

The page itself is written by ``docs/make.py``, which ``./run.sh docs`` runs.
"""

import sys
from pathlib import Path
from typing import Any

DOCS = Path(__file__).resolve().parent

#: What stands for a figure that ``./run.sh`` makes of the study, and those of another name.
STUDY = "study"
CALLED = {"box": "fig4"}
#: Drawn for other pages: figures of the study, and the pictures' names.
ELSEWHERE = {"fig1": "problem", "fig3": "procedure", "laws": "laws_on_stresses"}

#: Scene, the figure of its archive that is shown, and what to see there.
SHOWN = {
    "fig2": (STUDY, "Friction rises from 0, turns on the way back, and closes its loop."),
    "fig6": (STUDY, "Speed does nothing; μ_C sets the height, σ₀l/N how soon, δ how round."),
    "sinusoidal": (STUDY, "The same loop by a sinusoidal motion, and what becomes of it over time."),
    "fig5": (STUDY, "Pressure and tension lead at the trailing edge, X = -a in forward motion."),
    "fig7": (STUDY, "Slow lines, fast markers: the pressure hardly changes, the in-plane stress does."),
    "study_in_time": ("stresses", "The same stroke in time: over before much has changed."),
    "study_in_time_slow": ("stresses", "The slow stroke in time, compressed: steady all the same."),
    "high_speed": ("surface", "From rest to c = 0.9: what σ_XX does where the pressure hardly changes."),
    "fig8": (STUDY, "A larger μ_C leans the pressure to one end and raises the tension there."),
    "fig9": (STUDY, "A stiffer contact comes nearer to full slip at the same place of the stroke."),
    "fig10": (STUDY, "Dahl's exponent acts through f alone, and little."),
    "parameter_study": ("parameters", "What K_I and the exponents make of μ_C, at three speeds."),
    "inside": ("inside", "Stresses below the punch, slow and fast, on one scale."),
    "fibres": ("inside", "Stresses follow the stiff fibres of a carbon/epoxy ply deep into it."),
    "cylinder": ("surface", "A cylinder: the pressure ends at 0, and friction moves the contact back."),
    "along": ("along", "Bristles that enter the contact at rest: the pressure goes to the leading end."),
    "elastic_punch": ("surface", "A steel cylinder on aluminium: both deform, at rest and at speed."),
    "shoulders": ("surface", "A flat base with rounded shoulders, on which the contact ends."),
    "coating": ("interfaces", "What a hard coating hands down; tension in it at the trailing edge."),
    "minor_loops": ("friction", "Springs with sliders close small loops and remember where they turned."),
    "velocity_steps": ("friction", "Rate and state: what is there at once, and what comes with slip."),
    "slider": ("slider", "Stick-slip: the mass waits for the spring, and goes three times as fast."),
    "tables4_5": ("degrees", "Ten times more accurate with every degree: how the error is known."),
    "graded": ("mesh", "A mesh of straight cells, graded towards the edges."),
    "box": (STUDY, "The study's block, whole and near the punch."),
    "own_material": ("surface", "Acrylic glass at 1 mm/s, 100 m/s and 800 m/s."),
}  # fmt: skip

#: Figure of each scene of recipes.md, or of a scene by its name in scenes/.
RECIPES = {
    "cylinder": "surface", "coated": "parameters", "crystal": "parameters", "wedge": "surface",
    "elastic": "parameters", "loop": "surface", "start": "time", "stick_slip": "slider",
    "fast": "parameters", "bristles": "along", "small": "along",
}  # fmt: skip
_TEMPLATES = {"start": "start_from_rest", "stick_slip": "slider"}

_HEAD = """\
# Gallery

The headings name scenes in `scenes/`; `./run.sh init` says what each is about. Below each picture is the
file that `plot` makes of the scene's archive, or `./run.sh` in `results/`. Copy a scene and change it:

```console
./run.sh init fig8 -o mine.toml
./run.sh run mine.toml --set "friction.mu_c=[0.2, 0.5, 0.8]"
./run.sh plot mine.h5 -o figures
```
"""


def page() -> str:
    """The page: the scenes of ``SHOWN`` with a picture and what to see there, then the others."""
    from galinx.app.scene.library import templates

    known = templates()
    parts = [_HEAD]
    for name, (figure, seen) in SHOWN.items():
        parts.append(
            f"## `{name}`\n\n"
            f"[![{name}](figures/gallery/{name}.png)](figures/gallery/{name}.png)\n\n"
            f"*{seen}* `{_called(name, figure)}`\n"
        )
    others = ", ".join(f"`{name}`" for name in known if name not in SHOWN)
    parts.append(f"## Other scenes\n\n{others}.\n")
    return "\n".join(parts)


def _called(name: str, figure: str) -> str:
    """A figure's file, without its ending."""
    return f"results/{CALLED.get(name, name)}" if figure == STUDY else f"{name}_{figure}"


def _recipe(name: str) -> Any:
    """Scene of a recipe: as its page has it, with the law that is fitted to the measured loop."""
    from galinx import fit, template
    from galinx.app.scene.read import parse

    if name in _TEMPLATES:
        return template(_TEMPLATES[name])
    page = (DOCS / "recipes.md").read_text(encoding="utf-8")
    text = page.partition(f"# {name}.toml\n")[2].partition("```")[0]
    if name == "loop":
        law = fit(str(DOCS.parent / "scenes" / "slip.csv"), "dahl", fix={"delta": 1.0})
        values = {key: law.parameters[key] for key in ("mu_c", "sigma0_over_load")}
        text = text.replace("mu_c = 0.5", f"mu_c = {values['mu_c']}").replace(
            '"10000 1/m"', f"{values['sigma0_over_load']}"
        )
    return parse(text, name)


def main(*names: str) -> None:
    """Compute the scenes and draw what is shown, of some scenes alone where they are named."""
    from galinx import compute, template
    from galinx.app.figures.files import content
    from galinx.app.study.drawings import of_study

    folder = DOCS / "figures" / "gallery"
    folder.mkdir(parents=True, exist_ok=True)
    study = compute(template("study"))
    drawn = {drawing.name: drawing.figure for drawing in of_study(study.data, study.scene)}
    pictures = {f"../{called}": drawn[name] for name, called in ELSEWHERE.items()}
    for name, (wanted, _) in SHOWN.items():
        if wanted == STUDY:
            pictures[name] = drawn[CALLED.get(name, name)]
        elif not names or name in names:
            pictures[name] = compute(template(name)).figure(wanted)
    (DOCS / "figures" / "recipes").mkdir(parents=True, exist_ok=True)
    for name, figure in RECIPES.items():
        if not names or name in names:
            pictures[f"../recipes/{name}"] = compute(_recipe(name)).figure(figure)
    for name, figure in pictures.items():
        (folder / f"{name}.png").write_bytes(content(figure, "png", 110))
        print(f"written: docs/figures/gallery/{name}.png", flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
