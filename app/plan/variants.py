"""Variants of a scene with swept numbers, each with its plan, its friction and its place in the archive.

A scene without swept numbers is the only variant of itself. States of an archive are those of the first
variant, then those of the second, and so on.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.quantities import layers
from galinx.postprocess.quantities.swept import HALF_WIDTH, INTERFACE_DEPTHS, WAVE_SPEED
from galinx.texts import counted

from ..errors import BadInput, listed
from ..scene.scene import Scene
from .plan import Plan, interface_grid, lines, make_plan, too_many
from .states import States, enumerate_states, order


@dataclass(frozen=True)
class Variant:
    """A scene among those of a sweep.

    Attributes:
        scene: of one value of every swept number.
        plan: its work.
        states: its friction states.
        first: number of its first state, and of its first speed, among those of all.
        alone: True where there are no others.
    """

    scene: Scene
    plan: Plan
    states: States
    first: tuple[int, int]
    alone: bool

    @property
    def rows(self) -> slice:
        """Rows of its states in the archive."""
        return slice(self.first[0], self.first[0] + self.plan.states)

    @property
    def speeds(self) -> slice:
        """Rows of its speeds in the record of finite elements."""
        return slice(self.first[1], self.first[1] + len(self.plan.tasks))


def make_variants(
    scene: Scene, done: Callable[[int, int], None] = lambda laws, of: None
) -> list[Variant]:
    """All variants of a scene with plans and friction; no contact is solved yet.

    Args:
        scene: the scene.
        done: called with the number of laws whose friction is computed, and with that of all laws.

    Raises:
        BadInput: an output has no answer by the scene's methods, or not the same answers in all variants.
    """
    scenes = scene.each
    for fault in too_many(sum(len(order(variant)) for variant in scenes)):
        raise BadInput(fault)
    plans, along = [], positions_along(scene)
    for variant in scenes:
        try:
            plans.append(make_plan(variant, done, along))
        except BadInput as error:
            raise BadInput(f"with {variant.variant}: {error}" if variant.swept else str(error)) from None
    # An archive has one set of quantities for all states.
    kinds = [({quantity.path for quantity in plan.quantities}, plan.states) for plan in plans]
    for kind, variant in zip(kinds, scenes):
        if kind != kinds[0]:
            some = listed(sorted(kind[0] ^ kinds[0][0])[:3]) or "another number of states"
            raise BadInput(
                f"sweep: with {variant.variant} the contact is of another kind than with "
                f"{scenes[0].variant}: {some} is there for one of them only; make two scenes of it"
            )
    variants: list[Variant] = []
    state = speed = 0
    for variant, plan in zip(scenes, plans):
        friction = plan.friction or enumerate_states(variant, done)
        variants.append(Variant(variant, plan, friction, (state, speed), len(scenes) == 1))
        state, speed = state + plan.states, speed + len(plan.tasks)
    return variants


#: Ratio of depths so near to each other that one grid suits both.
_NEAR = 1.5


def positions_along(scene: Scene) -> NDArray[np.float64] | None:
    """Positions along interfaces that suit all variants; None for a scene that is alone."""
    if not scene.variants or not scene.layers:
        return None
    depths = np.sort(
        [variant.solid.depths / variant.body.half_width for variant in scene.variants], axis=None
    )
    apart: list[float] = []  # depths that stand for all
    for depth in depths.tolist():
        if not apart or depth > _NEAR * apart[-1]:
            apart.append(depth)
    return interface_grid(scene.body, np.array([*apart[:-1], depths[-1]]))[1]


def joined_states(variants: Sequence[Variant]) -> States:
    """Friction states of all variants, those of the first one first."""
    if variants[0].alone:
        return variants[0].states
    each = [variant.states for variant in variants]
    columns = {
        name: np.concatenate([states.columns[name] for states in each]) for name in each[0].columns
    }
    starts = np.cumsum([0, *(len(states.loops) for states in each[:-1])])
    loop = [
        np.where(states.loop < 0, -1, states.loop + start) for states, start in zip(each, starts.tolist())
    ]
    return replace(
        each[0],
        columns=columns | _of_variants(variants),
        inner=np.concatenate([states.inner for states in each]),
        directions=np.concatenate([states.directions for states in each]),
        loop=np.concatenate(loop),
        loops=np.concatenate([states.loops for states in each]),
        works={path: np.concatenate([states.works[path] for states in each]) for path in each[0].works},
    )


def _of_variants(variants: Sequence[Variant]) -> dict[str, NDArray]:
    """Columns of what an archive of a single problem has once, where variants differ in it."""
    scenes, counts = zip(*((variant.scene, len(variant.states)) for variant in variants))
    values = {WAVE_SPEED: [scene.solid.c_s for scene in scenes]}
    if not scenes[0].body.found:
        values = {HALF_WIDTH: [scene.body.half_width for scene in scenes]} | values
    return {
        row.path.partition("/")[2]: np.repeat(each, counts)
        for row, each in values.items()
        if len(set(each)) > 1
    }


def joined_positions(variants: Sequence[Variant]) -> dict[str, NDArray]:
    """Datasets of positions of archived stresses, by path."""
    positions = dict(variants[0].plan.positions)
    each = [variant.plan.positions for variant in variants]
    for row in layers.DEPTHS.values():
        if row.path in positions and any(
            not np.array_equal(own[row.path], each[0][row.path]) for own in each
        ):
            del positions[row.path]
            depths = [variant.scene.solid.depths for variant in variants]
            counts = [len(variant.states) for variant in variants]
            positions[INTERFACE_DEPTHS.path] = np.repeat(depths, counts, axis=0)
    return positions


def lines_of(scene: Scene, variants: Sequence[Variant]) -> list[str]:
    """Plans of all variants in words, one step a line; steps are those of the first variant."""
    steps = lines(scene, variants[0].plan)
    if variants[0].alone:
        return steps
    values = {key: [variant.scene.swept[key] for variant in variants] for key in variants[0].scene.swept}
    several = "; ".join(
        f"{len(set(each))} values of {key}, {min(each):g} to {max(each):g}"
        for key, each in values.items()
    )
    return [f"sweep: {counted(len(variants), 'variant')}: {several} (SI); each of them:", *steps]


def of_state(scene: Scene, number: int) -> tuple[Scene, int]:
    """Scene of a state, and the state's number among those of that scene.

    Args:
        scene: with or without swept numbers.
        number: of the state among those of all variants; one beyond these is left to the last variant.
    """
    count = len(order(scene.each[0]))
    which = min(max(number, 0) // count, len(scene.each) - 1)
    return scene.each[which], number - which * count


def restricted(
    data: dict[str, Any], variant: Variant, over: Callable[[str], tuple[str, ...]]
) -> dict[str, Any]:
    """Datasets of a variant's states and speeds alone, by path.

    Args:
        data: datasets of all variants by path.
        variant: the variant.
        over: dimensions of a dataset.
    """
    if variant.alone:
        return data
    rows = {"states": variant.rows, "speeds": variant.speeds}
    return {
        path: values[rows[over(path)[0]]] if over(path)[:1] and over(path)[0] in rows else values
        for path, values in data.items()
    }
