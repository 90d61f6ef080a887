"""Where a NaN or an infinity is no answer."""

from typing import Any

import numpy as np

from galinx.postprocess.quantities import table
from galinx.postprocess.quantities.quantity import ANYWHERE, BESIDE, NEVER
from galinx.postprocess.quantities.stresses import SURFACE_X
from galinx.solvers.contact import under_punch


def not_finite(data: dict[str, Any]) -> list[str]:
    """Paths of datasets with a value that is not finite and that the table of quantities does not allow.

    Args:
        data: datasets of some states by path, the positions on the surface among them.
    """
    known, found = table(), []
    for path, values in data.items():
        if np.asarray(values).dtype.kind != "f":
            continue
        allowed = known[path].nan_allowed if path in known else NEVER
        bad = ~np.isfinite(values)
        if allowed == ANYWHERE:
            bad = np.isinf(values)
        elif allowed == BESIDE:
            bad &= np.isinf(values) | under_punch(data[SURFACE_X.path])
        if bad.any():
            found.append(path)
    return found
