"""Plans of all variants of a scene with swept numbers, and what an archive of all of them holds.

A scene without swept numbers is the only variant of itself. States of an archive are those of the first
variant, then those of the second, and so on.
"""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.quantities import layers
from galinx.postprocess.quantities.runs import LOOP_F, LOOP_OF_STATE, LOOP_X
from galinx.postprocess.quantities.swept import HALF_WIDTH, INTERFACE_DEPTHS, WAVE_SPEED
from galinx.texts import counted

from ..errors import BadInput, listed
from ..scene.scene import Scene, with_unit
from .elements import lacking
from .plan import FRICTION, Plan, lines, make_plan, positions
from .states import States, order


def make_plans(scene: Scene, done: Callable[[int, int], None] = lambda laws, of: None) -> list[Plan]:
    """Plans of all variants of a scene, with friction; no contact is solved yet.

    Args:
        scene: the scene.
        done: called with the number of laws whose friction is computed, and with that of all laws.

    Raises:
        BadInput: an output has no answer by the scene's methods, or not the same answers in all variants.
    """
    states = sum(len(order(variant)) for variant in scene.each)
    if lack := lacking(FRICTION * states):
        raise BadInput(
            f"the scene's lists multiply to {states:.3g} states, whose friction needs {lack}: shorten "
            "them, or make several scenes"
        )
    plans, at, first = list[Plan](), positions(scene.each), (0, 0)
    for variant in scene.each:
        try:
            plans.append(plan := make_plan(variant, done, at, first))
        except BadInput as error:
            raise BadInput(f"with {variant.variant}: {error}" if variant.swept else str(error)) from None
        first = first[0] + plan.states, first[1] + len(plan.order.speeds)
    # An archive has one set of quantities for all states.
    kinds = [({quantity.path for quantity in plan.quantities}, plan.states) for plan in plans]
    for kind, plan in zip(kinds, plans):
        if kind != kinds[0]:
            extra = listed(sorted(kind[0] ^ kinds[0][0])[:3]) or "another number of states"
            raise BadInput(
                f"sweep: with {plan.scene.variant} the contact is of another kind than with "
                f"{plans[0].scene.variant}: {extra} is there for one of them only; make two scenes of it"
            )
    return plans


def joined_states(plans: Sequence[Plan]) -> States:
    """Friction states of all variants, those of the first one first."""
    each, counts = [plan.friction for plan in plans], [plan.states for plan in plans]
    if len(plans) == 1:
        return each[0]
    columns = {
        name: np.concatenate([states.columns[name] for states in each]) for name in each[0].columns
    }
    scenes = [plan.scene for plan in plans]
    values = {WAVE_SPEED: [scene.solid.c_s for scene in scenes]}
    if not scenes[0].body.found:
        values = {HALF_WIDTH: [scene.body.half_width for scene in scenes]} | values
    for row, of_each in values.items():  # a column where an archive of a single problem has one number
        if len(set(of_each)) > 1:
            columns[row.path.partition("/")[2]] = np.repeat(of_each, counts)
    others = {path: [states.others[path] for states in each] for path in each[0].others}
    before = np.cumsum([0, *map(len, others[LOOP_F.path][:-1])]).tolist()
    rows = zip(others[LOOP_OF_STATE.path], before)
    others[LOOP_OF_STATE.path] = [np.where(row < 0, -1, row + n) for row, n in rows]
    del others[LOOP_X.path][1:]
    crossed = np.concatenate([states.crossed for states in each])
    return States(columns, {path: np.concatenate(values) for path, values in others.items()}, crossed)


def joined_positions(plans: Sequence[Plan]) -> dict[str, NDArray]:
    """Datasets of positions of archived stresses, by path."""
    each = [plan.positions for plan in plans]
    positions = dict(each[0])
    for row in layers.DEPTHS.values():
        if row.path in positions and any(
            not np.array_equal(own[row.path], each[0][row.path]) for own in each
        ):
            del positions[row.path]
            depths = [plan.scene.solid.depths for plan in plans]
            positions[INTERFACE_DEPTHS.path] = np.repeat(depths, [plan.states for plan in plans], axis=0)
    return positions


def lines_of(plans: Sequence[Plan]) -> list[str]:
    """Plans of all variants in words, one step a line; steps are those of the first variant."""
    steps = lines(plans[0])
    if len(plans) == 1:
        return steps
    values = {key: [plan.scene.swept[key] for plan in plans] for key in plans[0].scene.swept}
    several = "; ".join(
        f"{len(set(each))} values of {key}, {with_unit(key, min(each))} to {with_unit(key, max(each))}"
        for key, each in values.items()
    )
    return [f"sweep: {counted(len(plans), 'variant')}: {several}; each of them:", *steps]


def of_state(scene: Scene, number: int) -> tuple[Scene, int]:
    """Scene of a state, and the state's number among those of that scene.

    Args:
        scene: with or without swept numbers.
        number: of the state among those of all variants; one beyond these is left to the last variant.
    """
    count = len(order(scene.each[0]))
    which = min(max(number, 0) // count, len(scene.each) - 1)
    return scene.each[which], number - which * count
