"""Which cells of a mesh are another one, moved and scaled: in a plane they have the same matrix.

The energy of a displacement does not change where lengths are scaled, nor does that of pressures over a
cell's size. Rings around an edge, each a share of the one outside it, and cells of one size cut from a
larger one need one matrix each kind, not one each cell.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.fem.chart import Chart
from galinx.solvers.solids.solid import ByCells, Response

#: Digits of a shape by which cells that may be alike are found; whether they are is looked at then.
_DIGITS = 3

#: How many roundings the vertices of cells that are alike may be apart.
_ROUNDINGS = 64.0


def alike(corners: NDArray, kinds: NDArray) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Cells that stand for others, and which of these each cell is like.

    Args:
        corners: vertices, (n, 4, 2 or 3).
        kinds: whole numbers that differ where cells have to be told apart whatever their shape, (n,).

    Returns:
        Arrays (m,) and (n,): numbers of the largest cell of each kind, and a place among these for each
        cell.
    """
    n = len(corners)
    relative = (corners - corners[:, :1]).reshape(n, -1)
    size = np.abs(relative).max(axis=1)
    shape = relative / size[:, None]
    key = np.column_stack([kinds, np.round(shape * 10**_DIGITS)])
    _, group = np.unique(key, axis=0, return_inverse=True)
    by_group = np.lexsort([-size, group])
    largest = by_group[np.flatnonzero(np.diff(group[by_group], prepend=-1))]
    model = largest[group]
    # Vertices of a small cell far from the origin have few digits of its shape.
    rounding = np.finfo(float).eps * np.abs(corners).reshape(n, -1).max(axis=1) / size
    alone = np.abs(shape - shape[model]).max(axis=1) > _ROUNDINGS * rounding
    model[alone] = np.flatnonzero(alone)
    return np.unique(model, return_inverse=True)


def standing_for(
    corners: NDArray, chart: Chart, response: Response, constants: Sequence[str]
) -> tuple[NDArray[np.int64], list[NDArray[np.int64]]]:
    """Cells whose matrices are those of all, and the cells that have the matrix of each.

    Args:
        corners: vertices in the chart, (n, 4, 3).
        chart: of the mesh.
        response: of the half-plane.
        constants: that the weak form has.
    """
    each = np.arange(len(corners))
    if not chart.similar or not len(each):
        return each, list(each[:, None])
    kinds = np.zeros_like(each)
    if isinstance(response, ByCells):
        solid = response.solids(corners[..., 1].mean(axis=1))
        graded = np.array([len(rows) > 1 for rows in response.constants(constants)])
        kinds = np.where(graded[solid], len(graded) + each, solid)
    models, like = alike(corners, kinds)
    return models, np.split(np.argsort(like, kind="stable"), np.cumsum(np.bincount(like))[:-1])
