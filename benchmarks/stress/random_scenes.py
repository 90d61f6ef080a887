"""Random scenes: is the estimate an upper bound of the true error, and a tight one?"""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray
from row import Row, Verdict, scene
from scipy.stats import binom

from galinx.app.console import Progress
from galinx.app.methods import METHODS
from galinx.app.plan.plan import make_plan
from galinx.app.plan.states import enumerate_states
from galinx.app.scene.read import parse
from galinx.app.scene.scene import Scene
from galinx.clock import Clock
from galinx.postprocess.quantities.quantity import CLOSED_FORM, FEM
from galinx.solvers.contact import BELOW, INTENSITIES, ON_SURFACE
from galinx.solvers.contact import stresses as scale
from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.solids.isotropic import Isotropic

#: Largest ratio of estimate to true error, of the median scene and of any above ``ROUNDING``.
MEDIAN, MOST, ROUNDING = 10.0, 100.0, 1e-11

#: Chance, at most, that the median's verdict fails where more scenes than these would show that it holds.
_CHANCE = 0.01

#: Positions X/a at which σ_YY is compared.
_ACROSS = np.cos(np.pi * np.arange(1, 8) / 8.0)

#: Every so many scenes ask for stresses as well.
_STRESSES = 4


@dataclass(frozen=True)
class Truth:
    """What is known of one state by both methods.

    Attributes:
        pressure: estimated error of K_I, σ_YY and its moments, and the larger of those of K_I and σ_YY.
        K_I: the true one of K_I alone, which can be right by accident.
        stresses: estimated and true errors of σ_XX on the surface and of stresses inside, as asked for.
    """

    pressure: tuple[float, float]
    K_I: float
    stresses: tuple[tuple[float, float], ...]


@dataclass
class Ratios:
    """Estimates over true errors.

    Attributes:
        found: of K_I and σ_YY, one a scene.
        K_I: of K_I alone.
        above_rounding: of those whose estimate is above rounding.
        stresses: of σ_XX on the surface and of stresses inside.
    """

    found: list[float] = field(default_factory=list)
    K_I: list[float] = field(default_factory=list)
    above_rounding: list[float] = field(default_factory=list)
    stresses: list[float] = field(default_factory=list)

    def take(self, truth: Truth) -> None:
        """Take what is known of one state."""
        estimate, _ = truth.pressure
        self.found.append(_over(*truth.pressure))
        self.K_I.append(_over(estimate, truth.K_I))
        if estimate > ROUNDING:
            self.above_rounding.append(self.found[-1])
        self.stresses.extend(_over(*pair) for pair in truth.stresses)

    def words(self) -> str:
        """Least, median and largest ratio, the largest of K_I alone, and the least of stresses."""
        stresses = f"; of stresses at least {min(self.stresses):.2f}" if self.stresses else ""
        least, median, most = min(self.found), float(np.median(self.found)), max(self.found)
        alone = f"of K_I alone {np.median(self.K_I):.1f}, up to {max(self.K_I):.1f}"
        return f"{least:.2f} to {most:.1f}, median {median:.1f}; {alone}{stresses}"


def verdicts(ratios: dict[str, Ratios]) -> tuple[Verdict, ...]:
    """What all kinds of scenes together are to keep, with the figures of each."""
    found, above, stresses = (
        [value for kind in ratios.values() for value in getattr(kind, name)]
        for name in ("found", "above_rounding", "stresses")
    )
    told = "; ".join(f"{kind} {each.words()}" for kind, each in ratios.items())
    most = max(above, default=0.0)
    return (
        Verdict(f"estimates over true errors: {told}", min(found) >= 1.0),
        _of_median(found),
        Verdict(f"largest of those above {ROUNDING:g}: {most:.1f}, allowed {MOST:g}", most <= MOST),
        Verdict("estimates of stresses are bounds", min(stresses, default=1.0) >= 1.0),
    )


def _of_median(found: list[float]) -> Verdict:
    """Is the median small enough? The sign test says so: that of a few scenes is no evidence.

    Of scenes whose median is allowed, no more than half have a larger ratio, but for chance.
    """
    larger, count = sum(value > MEDIAN for value in found), len(found)
    allowed = int(binom.ppf(1.0 - _CHANCE, count, 0.5))
    return Verdict(
        f"median {np.median(found):.1f}, allowed {MEDIAN:g}: {larger} of {count} scenes have more, "
        f"by chance {allowed} may",
        larger <= allowed,
    )


def random_scenes(seed: int = 1, scenes: int = 300) -> Row:
    """Random solids, speeds, frictions and tolerances on every mesh.

    Args:
        seed: of the random numbers.
        scenes: how many, a quarter of each kind.
    """
    rng, kinds = np.random.default_rng(seed), ("confocal", "graded", "box", "fixed degree")
    each = max(scenes // len(kinds), 1)
    ratios = {kind: Ratios() for kind in kinds}
    for i in range(each):
        for kind in kinds:
            ratios[kind].take(known(parse(scene(**_drawn(rng, kind, stresses=i % _STRESSES == 0)))))
    return Row(
        "random", f"{each} random scenes of each kind, seed {seed}", "scenes with less (1)",
        (np.arange(each) + 0.5) / each, "estimate over true error of K_I and σ_YY (1)",
        {kind: np.sort(ratios[kind].found) for kind in kinds},
        verdicts(ratios), log_x=False,
    )  # fmt: skip


def _drawn(rng: np.random.Generator, kind: str, stresses: bool) -> dict[str, Any]:
    """Parameters of a scene with one state."""
    ν, plane = float(rng.uniform(-0.9, 0.5)), str(rng.choice(["strain", "stress"]))
    solid = Isotropic(193e9, ν, 7860.0, plane)
    share = rng.choice([0.0, rng.uniform(0.0, 0.995), 1.0 - 10.0 ** rng.uniform(-2.3, -0.5)])
    g = rng.choice([rng.uniform(0.0, 1.2), 10.0 ** rng.uniform(-6.0, 0.0)])
    tolerance = 10.0 ** rng.uniform(-9.0, -2.0)
    # So stiff a law has reached μ_C: f = μ_C.
    drawn: dict[str, Any] = {
        "nu": ν, "plane": plane, "c": [float(share) * solid.limit()], "mu_c": float(g),
        "stiffness": 1e9, "X_over_L": [1.0], "strokes": '["forward"]', "tolerance": float(tolerance),
        "mesh": "confocal" if kind == "fixed degree" else kind,
    }  # fmt: skip
    if kind == "box":
        drawn["tolerance"] = float(10.0 ** rng.uniform(-2.5, -1.5))
    if kind == "fixed degree":
        drawn["fixed"] = f", degree = {rng.integers(2, 9)}, cuts = 4"
    words = ["sif"]
    if stresses:
        words += ["surface"]
        if not solid.nearly_incompressible:
            words += ["interior"]
            drawn["points"] = _points(rng).tolist()
    return drawn | {"quantities": str(words).replace("'", '"')}


def _points(rng: np.random.Generator) -> NDArray[np.float64]:
    """Places inside, at all distances from both edges and the middle."""
    r, angle = 10.0 ** rng.uniform(-5.0, 1.0, 12), rng.uniform(0.02, np.pi - 0.02, 12)
    return np.column_stack([rng.choice([-1.0, 0.0, 1.0], 12) + r * np.cos(angle), -r * np.sin(angle)])


def known(asked: Scene) -> Truth:
    """Solve the one state of a scene by both methods."""
    plan, g = make_plan(asked), enumerate_states(asked).g
    (task,) = plan.tasks
    with (
        METHODS[FEM].made(plan, Progress(), Clock()).at(task, g) as elements,
        METHODS[CLOSED_FORM].made(plan, Progress(), Clock()).at(task, g) as formula,
    ):
        found: Any = elements.states(g)
        exact: Any = formula.states(g)
        local, places = FlatPunch(task.response, g), task.places
        K_I = float(np.abs(found.K_I / exact.K_I - 1.0).max())
        σ_YY = found.solved[0].pressure.σ_YY(_ACROSS) / local.σ_YY(_ACROSS)
        stresses = []
        if plan.asks(ON_SURFACE):
            σ_XX = exact.surface.σ_XX
            size = scale.of_in_plane(σ_XX, places.X)
            stresses.append((ON_SURFACE, np.abs(found.surface.σ_XX - σ_XX) / size))
        if plan.asks(BELOW):
            size = scale.of_inside(exact.inside, *places.points.T)
            stresses.append((BELOW, np.abs(found.inside - exact.inside) / size))
        estimates = {word: float(values.max()) for word, values in found.estimates.items()}
        return Truth(
            (estimates[INTENSITIES], max(K_I, float(np.abs(σ_YY - 1.0).max()))),
            K_I,
            tuple((estimates[word], float(error.max())) for word, error in stresses),
        )


def _over(estimate: float, true: float) -> float:
    return estimate / max(true, np.finfo(float).tiny)
