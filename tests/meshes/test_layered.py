"""Lengths over which fields change in layers."""

import numpy as np
import pytest

from galinx.meshes.layered import OnLayers, between, fitted

ISOTROPIC = (1j,)
OBLIQUE = (0.6 + 0.8j, -2.0 + 0.5j)


def test_fields_of_solids_at_rest_change_over_the_depth():
    layers = OnLayers(depths=(1.0, 3.0), roots=(ISOTROPIC,) * 3)
    assert [layers.change(depth) for depth in (0.5, 1.0, 2.0, 7.0)] == pytest.approx([0.5, 1.0, 2.0, 7.0])
    assert layers.aside == 1.0


def test_oblique_planes_bring_the_edges_nearer():
    layers = OnLayers(depths=(1.0,), roots=(OBLIQUE, (0.1j,)))
    share = 0.5 / abs(-2.0 + 0.5j)
    assert layers.aside == pytest.approx(share)
    # The nearest edge along Y is where |Y + .../p| is least.
    seen = [abs(p.imag * 0.6) / abs(p) for p in OBLIQUE]
    assert layers.change(0.6) == pytest.approx(min(seen))
    # Below, of what has come through: Im p of the layer and of what is below it, over |p|.
    assert layers.change(1.0) == pytest.approx(0.5 / 0.1)
    assert layers.change(4.0) == pytest.approx((0.5 + 3.0 * 0.1) / 0.1)


@pytest.mark.parametrize("seed", range(20))
def test_rows_are_no_higher_than_their_share_and_stop_at_interfaces(seed):
    rng = np.random.default_rng(seed)
    depths = tuple(np.cumsum(10.0 ** rng.uniform(-1.5, 1.0, rng.integers(1, 5))).tolist())
    roots = tuple(
        tuple((rng.uniform(-1.0, 1.0, 2) + 1j * rng.uniform(0.1, 2.0, 2)).tolist())
        for _ in range(len(depths) + 1)
    )
    layers, first, last = OnLayers(depths=depths, roots=roots), 0.3 * depths[0], 4.0 * depths[-1]
    rows = np.append(layers.rows(first, last, 1.2), last)
    height = np.diff(rows)
    assert rows[0] == first and np.all(height > 0.0)
    assert set(depths) <= set(rows.tolist())
    allowed = np.array([1.2 * layers.change(row) for row in rows[:-1]])
    assert np.all(height <= allowed * (1.0 + 1e-6))
    # No row could be spared.
    layer_of_row = np.searchsorted(depths, rows[:-1], side="right")
    for layer in range(len(depths) + 1):
        inside = layer_of_row == layer
        fewer = len(fitted(layers.change, rows[:-1][inside][0], rows[1:][inside][-1], 1.2))
        assert fewer == inside.sum()


def test_graded_layers_have_rows_as_their_constants_change():
    plain, graded = (
        OnLayers(depths=(4.0, 5.0), roots=(ISOTROPIC,) * 3, changes=changes)
        for changes in ((), (np.inf, 0.25))
    )
    assert [graded.change(depth) for depth in (2.0, 4.5, 6.0)] == pytest.approx([2.0, 0.25, 6.0])
    assert plain.change(4.5) == pytest.approx(4.5)
    rows = graded.rows(1.0, 8.0, 1.2)
    assert np.diff(rows[(rows >= 4.0) & (rows <= 5.0)]).max() <= 0.3 + 1e-6


def test_lines_grow_by_no_more_than_the_factor():
    lines = np.append(between(0.2, 31.0, 2.5), 31.0)
    growth = lines[1:] / lines[:-1]
    assert np.ptp(growth) < 1e-12 and 2.5**0.8 < growth[0] <= 2.5
    assert len(between(1.0, 1.0, 2.0)) == 0
