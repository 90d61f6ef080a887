"""The verdict on a run."""

import numpy as np

from galinx.app.plan.plan import has_closed_form
from galinx.app.scene.scene import Scene
from galinx.postprocess import compare

#: A balance of nodal forces further off than this, over N, is a fault whatever the tolerance.
BALANCE_LIMIT = 1e-9

#: In the traction mode v,X under the punch has to vanish; it is a derivative of the displacement and
#: so has about half the digits of the moments that the tolerance speaks of.
SLOPE_FACTOR = 10.0


class Judge:
    """Watches parts of results and says PASS or FAIL; keeps the worst of every comparison.

    Attributes:
        worst: largest value by the comparison's text, dimensionless.
        failures: what could not be solved, and why.
    """

    def __init__(self, scene: Scene) -> None:
        self.worst: dict[str, float] = {}
        self.failures: list[str] = []
        tolerance = scene.solve.tolerance
        self._limits = {compare.BALANCE: BALANCE_LIMIT, compare.K_I: tolerance}
        self._limits[compare.ESTIMATE] = tolerance
        if scene.solve.mode == "traction":
            self._limits[compare.SLOPE] = SLOPE_FACTOR * tolerance
        if not has_closed_form(scene):
            self._limits = {}
        self._limits[compare.TENSION] = 0.0
        self._judged: dict[str, float] = {}

    def see(self, comparisons: list[compare.Comparison]) -> None:
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
        reasons += [f"not solved, {text}" for text in self.failures]
        return "PASS" if good else "FAIL", reasons
