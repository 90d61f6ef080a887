"""The verdict on a run."""

from collections.abc import Iterable
from math import inf

import numpy as np

from galinx.app.scene.scene import Scene
from galinx.postprocess.compare import RULES, Comparison
from galinx.postprocess.validity import Steady, Validity
from galinx.solvers.profiles.flat import Flat
from galinx.solvers.transient.admittance import InPlane
from galinx.solvers.transient.approach import approach

#: Speeds that could not be solved of which a verdict says why, at most.
_FAILURES = 10


def limits(scene: Scene, names: Iterable[str]) -> dict[str, float]:
    """Largest values of a PASS by the names of rules; what is only told is not among them."""
    rules = {name: RULES[name] for name in names if RULES[name].mode in scene.modes}
    allowed = {name: rule.allowed(scene.solve.tolerance) for name, rule in rules.items()}
    return {name: limit for name, limit in allowed.items() if limit is not None}


class Judge:
    """Watches parts of results and says PASS or FAIL; keeps the worst of every comparison.

    Args:
        scene: sets the tolerance.
        names: of the rules by which results are compared.

    Attributes:
        worst: largest value by the comparison's text, dimensionless.
        failures: what could not be solved, and why.
        validity: watches where what was solved does not hold.
    """

    def __init__(self, scene: Scene, names: Iterable[str]) -> None:
        self.worst: dict[str, float] = {}
        self.failures: list[str] = []
        self.validity = Validity(_steady(scene))
        self._limits = limits(scene, names)
        self._judged: dict[str, float] = {}

    def see(self, comparisons: list[Comparison]) -> None:
        """Take a part's comparisons into account; NaN is worse than any number."""
        for found in comparisons:
            value = float(np.max([self.worst.get(found.text, 0.0), found.value]))
            self.worst[found.text] = value
            if found.name in self._limits:
                self._judged[found.text] = self._limits[found.name]

    def verdict(self) -> tuple[str, list[str]]:
        """PASS or FAIL, with the figures; ``not judged`` where there is nothing to compare."""
        if not self._judged and not self.failures:
            return "not judged", []
        good = all(self.worst[text] <= limit for text, limit in self._judged.items())
        good = good and not self.failures
        reasons = [f"{text}: {self.worst[text]:.1e}, at most {x:g}" for text, x in self._judged.items()]
        reasons += [f"not solved, {text}" for text in self.failures[:_FAILURES]]
        if len(self.failures) > _FAILURES:
            reasons.append(f"not solved, and {len(self.failures) - _FAILURES} more speeds")
        return "PASS" if good else "FAIL", reasons


def _steady(scene: Scene) -> Steady | None:
    """Known of flat punches on uniform solids, below the speed of the wave along the surface."""
    solid = scene.solid
    if scene.layers or not isinstance(scene.punch.profile, Flat):
        return None
    if not isinstance(solid.response(0.0), InPlane):
        return None  # a user's own

    def within(c: float, g: float) -> float:
        return approach(solid, c, g).within(0.01) if c < solid.limit() else inf

    return Steady(within, scene.body.half_width / solid.c_s)
