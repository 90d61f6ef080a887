"""Uniform half-planes under any contact pressure: stresses by its Hilbert transform and potential."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from galinx.solvers.contact.closed_form import FlatPunch
from galinx.solvers.contact.yielding import InSolid
from galinx.solvers.solids.isotropic import Isotropic, MovingFrame


@dataclass(frozen=True)
class LoadedHalfPlane:
    """Half-plane at a speed under a pressure and friction g; stresses over N/(2a), positions over a."""

    response: Any
    g: Any
    pressure: Any

    def σ_XX(self, r):
        """In-plane stress on the surface."""
        return self.response.in_plane(self.g, self.pressure.σ_YY(r), self.pressure.hilbert(r))

    def inside(self, X, Y):
        """σ_XX, σ_YY, σ_XY at points with Y < 0."""
        return self.response.inside(self.pressure, self.g, np.asarray(X), np.asarray(Y))

    def stresses(self, X, Y):
        """σ_XX, σ_YY, σ_XY at points with Y <= 0, those of the surface among them."""
        X, Y = np.asarray(X, dtype=float), np.asarray(Y, dtype=float)
        on, σ_YY = Y == 0.0, self.pressure.σ_YY(X)
        surface = np.broadcast_arrays(self.σ_XX(X), σ_YY, self.g * σ_YY)
        return np.where(on, surface, self.inside(X, np.where(on, -1.0, Y)))


def punch_of(entry, g):
    """A flat punch on the solid and at the speed of an entry of the references."""
    solid = Isotropic(193e9, float(entry["nu"]), 7860.0, entry["plane"])
    return FlatPunch(MovingFrame(solid.κ, float(entry["c"])), float(g))


def under(punch):
    """The half-plane under a flat punch."""
    return LoadedHalfPlane(punch.response, punch.g, punch)


def yield_of(body, stresses, response, g, local=None):
    """Yield of states with frictions g, (states,), by the stresses at points, as a solution has it."""
    return body.strength(InSolid(response, g, local, body.half_width, stresses))
