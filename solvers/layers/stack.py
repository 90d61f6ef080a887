"""Layers on a substrate at one speed: the stiffness of their surface, and what it says of the speed."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.layers.medium import Medium, inverse, least


@dataclass(frozen=True)
class Stack:
    """Layers from the top down at a speed, lengths over a, stiffnesses over that of the surface's solid.

    Attributes:
        layers: see :class:`galinx.solvers.layers.uniform.Uniform` and ``graded.Graded``.
        substrate: the half-plane below them.
    """

    layers: Sequence[Any]
    substrate: Medium

    @property
    def top(self) -> Medium:
        """The solid at the surface."""
        return self.layers[0].top if self.layers else self.substrate

    @cached_property
    def depths(self) -> NDArray[np.float64]:
        """Of the interfaces, (layers,)."""
        return np.cumsum([layer.H for layer in self.layers])

    def below(self, k: NDArray) -> list[NDArray[Any]]:
        """Stiffness Z under every layer, from the top down, (n, 2, 2) each.

        Args:
            k: wavenumbers times a, (n,).
        """
        Z = np.broadcast_to(self.substrate.down, (len(k), 2, 2))
        found = [Z]
        for layer in self.layers[:0:-1]:
            Z = layer.top.down + layer.excess(k, Z)
            found.append(Z)
        return found[::-1]

    def excess(self, k: NDArray) -> NDArray[Any]:
        """Stiffness of the surface less that of a half-plane of the solid there, (n, 2, 2)."""
        if not self.layers:
            return np.zeros((len(k), 2, 2), dtype=complex)
        return np.asarray(self.layers[0].excess(k, self.below(k)[0]))

    def stiffness(self, k: NDArray) -> NDArray[Any]:
        """Z(k) of the surface, t = k Z u, Hermitian, (n, 2, 2)."""
        return self.top.down + self.excess(k)

    def admittance(self, k: NDArray) -> NDArray[Any]:
        """ΔŶ(k): u,X by tractions, less that of a half-plane of the surface's solid, (n, 2, 2).

        Ŷ = i Z⁻¹ and no difference of nearly equal numbers is taken.
        """
        δ = self.excess(k)
        Z = self.top.down
        return np.asarray(-1j * inverse(Z + δ) @ δ @ inverse(Z))

    def stands(self, k: NDArray) -> NDArray[np.float64]:
        """Smallest stiffness against a wave with each wavenumber, on the surface or inside, (n,).

        It falls with speed; where it is 0 that wave runs with the load, freely. Of waves that something
        below gives way to no more is asked.
        """
        for layer in self.layers:
            layer.check()
        found, going = np.full(len(k), np.inf), np.arange(len(k))
        Z = np.broadcast_to(self.substrate.down, (len(k), 2, 2))
        for layer in self.layers[::-1]:
            here = layer.stands(k[going], Z)
            found[going] = np.minimum(found[going], np.where(np.isnan(here), -np.inf, here))
            holds = found[going] > 0.0
            going = going[holds]
            if not len(going):
                return found
            Z = layer.top.down + layer.excess(k[going], Z[holds])
        surface = least(Z)
        found[going] = np.minimum(found[going], np.where(np.isnan(surface), -np.inf, surface))
        return found
