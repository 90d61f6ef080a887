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

    found, h = {}, other.get("states/half_width")
    of_ends = [np.abs(one[f"states/{name}"] - other[f"states/{name}"]) / h
               for name in ("half_width", "centre") if h is not None]  # fmt: skip
    if "states/K_I_left" in other:
        K = [np.array([of[f"states/K_I_{end}"] for end in ("left", "right")]) for of in (one, other)]
        size = np.where(K[1] == 0.0, np.maximum(np.abs(K[1]).max(axis=0), 1e-300), K[1])
        of_ends += [*np.abs((K[0] - K[1]) / size)]
    if of_ends and "surface/sigma_YY" in one:
        σ = np.nan_to_num(other["surface/sigma_YY"])
        off = (np.nan_to_num(one["surface/sigma_YY"]) - σ) / stresses.of_in_plane(
            σ, data["surface/X_over_a"]
        )
        # Next to ends a pressure may be off by half more than what stands for all of it.
        of_ends.append(largest(off) / 1.5)
    if of_ends:
        found[""] = np.max(of_ends, axis=0)
    if "surface/sigma_XX" in one:
        σ = other["surface/sigma_XX"]
        size = stresses.of_in_plane(σ, data["surface/X_over_a"])
        off = (one["surface/sigma_XX"] - σ) / size
        for row in np.flatnonzero(np.isnan(other.get("states/largest_pressure", np.zeros(len(off))))):
            # Next to a tip, the place of the largest sample, stresses are infinite.
            X = data["surface/X_over_a"]
            off[row, np.abs(X - X[np.abs(σ[row]).argmax()]) < stresses.NEAR_TIP] = 0.0
        found["_sigma_XX"] = largest(off)
    if "interior/sigma_XX" in one and "interior/sigma_XX" in other:
        σ = [np.array([of[f"interior/sigma_{ij}"] for ij in ("XX", "YY", "XY")]) for of in (one, other)]
        size = stresses.of_inside(σ[1], data["interior/X_over_a"], data["interior/Y_over_a"])
        found["_inside"] = np.max([largest((a - b) / size) for a, b in zip(*σ)], axis=0)
    if "interfaces/sigma_YY" in one:
        σ = [np.array([of[f"interfaces/{part}"] for part in PARTS]) for of in (one, other)]
        found["_interfaces"] = largest(np.moveaxis((σ[0] - σ[1]) / stresses.of_interfaces(σ[1]), 1, 0))
    return found


def check(data, tolerance, exact="sie"):
    """Finite elements are within what both methods say, and both within the tolerance; the differences.

    Args:
        data: of a result.
        tolerance: of its scene; infinite where its verdict may be FAIL.
        exact: name of the other method.
    """
    found = differences(of_method(data, "fem"), of_method(data, exact), data)
    assert found
    for what, off in found.items():
        estimates = [data.get(f"states/{by}/estimate{what}", 0.0) for by in ("fem", exact)]
        assert np.all(off <= sum(estimates)), what
        assert 0.0 < off.max() <= tolerance and np.max(estimates[0]) <= tolerance, what
    return found
