"""What finite elements over layers need: meshes along interfaces, and how pressures are read off them."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.meshes import MeshKind, Wanted
from galinx.meshes.layered import OnLayers, on_layers
from galinx.postprocess.stretched import Stretch
from galinx.solvers.layers.layered import Layered
from galinx.solvers.rays import NEAR
from galinx.solvers.solids import Solid

#: How far apart a surface's fields may live so that cells are drawn together for both.
_APART = 0.8
#: Where less is left to the speed of a wave along the substrate no far boundary is far enough.
_LEAST_LEFT = 1e-6
#: Distance over a from a free end within which stresses are continued from farther away.
_NEAR_FREE_END = 1e-2
#: Moments more over solids that are graded from the surface on: few polynomials do not make up for what
#: functions of the ends add away from these.
_MORE_GRADED = 6
#: Loosest tolerance of meshes over them: on coarser ones these functions' moments are not sure.
_LOOSEST_GRADED = 1e-4


@dataclass(frozen=True)
class Tests:
    """By what a pressure over layers is read off nodal forces.

    Attributes:
        stretch: variable in which it is smooth.
        count: moments at the first degree; each degree more takes more, so that what they leave shows in
            the measured error.
    """

    stretch: Stretch
    count: int

    @property
    def a_degree(self) -> int:
        """Moments more for each degree more; those over graded solids depend on one another nearly."""
        return 1 if self.stretch.graded else 2


def tests_of(solid: Solid, kind: MeshKind, wanted: Wanted) -> Tests | None:
    """What a pressure over layers is read off by; None where there are none."""
    if not isinstance(kind, OnLayers) or not isinstance(solid, Layered):
        return None
    graded = graded_from_the_surface(solid)
    return Tests(Stretch(kind.length, graded), kind.moments(wanted) + _MORE_GRADED * graded)


def graded_from_the_surface(solid: Layered) -> bool:
    """Do constants change in the uppermost layer?"""
    return solid.layers[0].bottom not in (None, solid.layers[0].solid)


def wanted_of_graded(wanted: Wanted, solid: Layered) -> Wanted:
    """What a mesh has to be good for over layers, by whether the uppermost one is graded."""
    if not graded_from_the_surface(solid):
        return wanted
    return replace(wanted, tolerance=min(wanted.tolerance, _LOOSEST_GRADED))


def wanted_of_free_ends(wanted: Wanted) -> Wanted:
    """What a mesh has to be good for where stresses at the ends are finite.

    The parts that are added up until no intensity is left have one each.
    """
    if wanted.nearest is None:
        return wanted
    return replace(wanted, nearest=max(wanted.nearest, _NEAR_FREE_END))


def wanted_of_loads(wanted: Wanted) -> Wanted:
    """What a mesh has to be good for under a pressure that is put in, stresses next to whose knots are
    continued from farther away."""
    if wanted.nearest is None:
        return wanted
    return replace(wanted, nearest=max(wanted.nearest, NEAR))


def kind_of(depths: NDArray, responses: Sequence[Any], places: Sequence[float] = (-1.0, 1.0)) -> OnLayers:
    """The kind of mesh of layered solids, at some speeds.

    Args:
        depths: of the interfaces over a.
        responses: of the half-plane, one a speed.
        places: over a towards which cells are graded.
    """
    roots = [[p.imag for p in response.surface.roots.each] for response in responses]
    # Fields that live far apart have no middle.
    apart = max(response.spread for response in responses) > _APART
    return on_layers(
        depths.tolist(),
        drawn_together=float(np.min(roots)),
        wide=1.0 if apart else float(np.exp(np.mean(np.log(roots)))),
        far_length=max(response.far_field.length for response in responses),
        left=max(min(response.left_below for response in responses), _LEAST_LEFT),
        roots=_roots(responses),
        changes=tuple(length / responses[0].a for length in responses[0].solid.changes),
        places=tuple(places),
    )


def _roots(responses: Sequence[Any]) -> tuple[tuple[complex, ...], ...]:
    """p of every solid at the lowest and the highest speed, where they are farthest apart."""
    by_speed = sorted(responses, key=lambda response: response.c)
    each = [response.roots for response in (by_speed[0], by_speed[-1])]
    return tuple(one + other for one, other in zip(*each))
