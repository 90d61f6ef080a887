"""Rational functions of one variable through values that are many functions' at once.

The barycentric form r(z) = Σ_k b_k(z) f_k, b_k(z) = (w_k/(z - z_k)) / Σ_j w_j/(z - z_j), passes through
the values f_k at the nodes z_k whatever the weights w_k are. Here one set of weights serves all functions:
as of the set-valued AAA algorithm (Nakatsukasa, Sète & Trefethen, SIAM J. Sci. Comput. 40, 2018; Lietaert,
Meerbergen, Pérez & Vandereycken, IMA J. Numer. Anal. 42, 2022) they make r(z) D(z) - N(z) smallest at the
samples that are no nodes.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


def barycentric(nodes: NDArray, weights: NDArray, z: NDArray) -> NDArray[np.float64]:
    """What of the values at nodes makes that at each z, (len(z), nodes); rows sum to 1.

    Args:
        nodes: all different, (nodes,).
        weights: of the barycentric form, (nodes,).
        z: where, (n,).
    """
    step = z[:, None] - nodes
    met = step == 0.0
    b = np.where(met.any(axis=1)[:, None], 1.0 * met, weights / np.where(met, 1.0, step))
    return np.asarray(b / b.sum(axis=1)[:, None])


def chebyshev_nodes(count: int, low: float, high: float) -> tuple[NDArray, NDArray]:
    """Chebyshev's nodes from low to high, and the barycentric weights of the polynomial through them."""
    angle = np.pi * (2.0 * np.arange(count) + 1.0) / (2.0 * count)
    nodes = (low + high) / 2.0 - (high - low) / 2.0 * np.cos(angle)
    return nodes, (-1.0) ** np.arange(count) * np.sin(angle)


def polynomial_weights(nodes: NDArray) -> NDArray[np.float64]:
    """Barycentric weights of the polynomial through values at any nodes, all different, (nodes,)."""
    step = nodes[:, None] - nodes + np.eye(len(nodes))
    logs = np.log(np.abs(step)).sum(axis=1)
    return np.asarray(np.prod(np.sign(step), axis=1) * np.exp(logs.min() - logs))


@dataclass(frozen=True)
class Rational:
    """A rational function through samples of many functions.

    Attributes:
        z: of the samples, (K,).
        nodes: which samples it passes through; the others determined its weights.
        weights: of the barycentric form, (nodes,).
    """

    z: NDArray[np.float64]
    nodes: NDArray[np.int64]
    weights: NDArray[np.float64]

    def shares(self, z: NDArray) -> NDArray[np.float64]:
        """What of the samples makes the values at each z, (len(z), K)."""
        shares = np.zeros((len(z), len(self.z)))
        shares[:, self.nodes] = barycentric(self.z[self.nodes], self.weights, z)
        return shares


def fitted(z: NDArray, values: NDArray) -> Rational:
    """The rational function whose nodes are all samples but one, the others' worst first.

    Args:
        z: of the samples, all different, (K,), K >= 3.
        values: of the functions there, (K, functions).
    """
    count = len(z)
    # A rotation of the functions among themselves changes no norm, and leaves at most K of them.
    values = np.linalg.qr(values.T, mode="r").T
    found, nodes = np.tile(values.mean(axis=0), (count, 1)), np.zeros(0, dtype=np.int64)
    weights = np.zeros(0)
    for _ in range(count - 1):
        error = np.linalg.norm(values - found, axis=1)
        error[nodes] = -1.0
        nodes = np.append(nodes, error.argmax())
        rest = np.setdiff1d(np.arange(count), nodes)
        loewner = (values[rest][:, None] - values[nodes]) / (z[rest][:, None] - z[nodes])[..., None]
        rows = loewner.transpose(0, 2, 1).reshape(-1, len(nodes))
        weights = np.linalg.svd(rows)[2][-1]
        found = barycentric(z[nodes], weights, z) @ values[nodes]
    return Rational(z, nodes, weights)


def leja(z: NDArray, first: int, count: int) -> list[int]:
    """So many of some points, each where the polynomial with zeros at those before is largest.

    Args:
        z: the points; those that are equal count once, (n,).
        first: number of the first.
        count: that are wanted; fewer where there are no more.
    """
    order, logs = [first], np.zeros(len(z))
    size = np.ptp(z) or 1.0
    while len(order) < count:
        with np.errstate(divide="ignore"):
            logs = logs + np.log(np.abs(z - z[order[-1]]) / size)
        if logs.max() == -np.inf:
            break
        order.append(int(logs.argmax()))
    return order
