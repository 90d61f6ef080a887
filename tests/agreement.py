"""How far two methods are apart in each state, beside what both say of their errors."""

import numpy as np

from galinx.solvers.contact import stresses

#: Stresses at interfaces, in the order of their sizes.
PARTS = ("sigma_YY", "sigma_XY", "sigma_XX_above", "sigma_XX_below")


def of_method(data, method):
    """Datasets of a method by path, without its name."""
    return {
        path.replace(f"/{method}/", "/"): array for path, array in data.items() if f"/{method}/" in path
    }


def differences(one, other, data):
    """Relative differences by the ending of the estimate's name, (states,) each.

    Args:
        one: datasets of :func:`of_method`.
        other: those that differences are over.
        data: places that both have.
    """

    def largest(off):
        return np.abs(off).reshape(len(off), -1).max(axis=1)

    ends = ("states/half_width", "states/centre") if "states/half_width" in other else ()
    found = {
        "": np.max([np.abs(one[path] - other[path]) / other[ends[0]] for path in ends], axis=0)
        if ends
        else np.max([np.abs(one[f"states/K_I_{end}"] / other[f"states/K_I_{end}"] - 1.0)
                     for end in ("left", "right")], axis=0)
    }  # fmt: skip
    if "surface/sigma_XX" in one:
        σ = other["surface/sigma_XX"]
        size = stresses.of_in_plane(σ, data["surface/X_over_a"])
        found["_sigma_XX"] = largest((one["surface/sigma_XX"] - σ) / size)
    if "interior/sigma_XX" in one:
        σ = [np.array([of[f"interior/sigma_{ij}"] for ij in ("XX", "YY", "XY")]) for of in (one, other)]
        size = stresses.of_inside(σ[1], data["interior/X_over_a"], data["interior/Y_over_a"])
        found["_inside"] = np.max([largest((a - b) / size) for a, b in zip(*σ)], axis=0)
    if "interfaces/sigma_YY" in one:
        σ = [np.array([of[f"interfaces/{part}"] for part in PARTS]) for of in (one, other)]
        found["_interfaces"] = largest(np.moveaxis((σ[0] - σ[1]) / stresses.of_interfaces(σ[1]), 1, 0))
    return found


def check(data, tolerance, exact="sie"):
    """Finite elements are within the tolerance, and within what both methods say; the differences."""
    found = differences(of_method(data, "fem"), of_method(data, exact), data)
    for what, off in found.items():
        estimates = [data.get(f"states/{by}/estimate{what}", 0.0) for by in ("fem", exact)]
        assert np.all(off <= sum(estimates)), what
        assert 0.0 < off.max() <= tolerance and np.max(estimates[0]) <= tolerance, what
    return found
