"""Where nothing is compared: next to the tip of a punch, at which stresses are infinite."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess import scale
from galinx.postprocess.quantities.quantity import CLOSED_FORM
from galinx.postprocess.quantities.states import LARGEST
from galinx.postprocess.quantities.stresses import PRESSURE, SURFACE_X
from galinx.solvers.contact import under_punch


def next_to_tips(data: Mapping[str, Any], inside: float = 1.0) -> NDArray[np.bool_]:
    """Which positions on the surface are next to an infinite pressure of the closed form, (states, n).

    Args:
        data: datasets by path.
        inside: that pressure is further in than this, over a.
    """
    X = data[SURFACE_X.path]
    if LARGEST[CLOSED_FORM].path not in data or PRESSURE[CLOSED_FORM].path not in data:
        return np.zeros((1, len(X)), dtype=bool)
    infinite = np.isnan(data[LARGEST[CLOSED_FORM].path])[:, None]
    σ_YY = np.where(under_punch(X), data[PRESSURE[CLOSED_FORM].path], 0.0)
    tips = X[np.abs(σ_YY).argmax(axis=1)][:, None]
    return infinite & (np.abs(tips) < inside) & ~scale.off_tips(X, tips)
