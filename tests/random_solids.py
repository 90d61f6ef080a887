"""Random solids of every kind, and a frame of one in the numbers of the reference."""

import numpy as np

from galinx.solvers.solids.isotropic import Isotropic
from galinx.solvers.solids.plane import Anisotropic, Cubic, Orthotropic


def orthotropic(rng, stiffest=40.0):
    E1, angle, plane = 10.0 ** rng.uniform(0.0, np.log10(stiffest)), rng.uniform(-180.0, 180.0), "strain"
    ν12, ν13, ν23 = rng.uniform(0.0, 0.35, 3)
    plane = rng.choice(["strain", "stress"])
    return Orthotropic(
        E1, 1.0, rng.uniform(0.7, 1.0), ν12, ν13, ν23, rng.uniform(0.2, 0.6), 1.0, angle, plane
    )


def cubic(rng):
    c12, shear = rng.uniform(-0.2, 0.8), 10.0 ** rng.uniform(-1.0, 0.5)
    plane = rng.choice(["strain", "stress"])
    return Cubic(1.0, c12, shear * (1.0 - c12) / 2.0, 1.0, rng.uniform(-180.0, 180.0), plane)


def anisotropic(rng):
    root = rng.normal(size=(3, 3))
    C = root @ root.T + 0.3 * np.eye(3)
    return Anisotropic(tuple(C[np.triu_indices(3)].tolist()), 1.0)


def isotropic_like(rng):
    """An isotropic solid as an anisotropic one, and one that is nearly so: roots meet, or nearly."""
    ν, off = rng.uniform(0.0, 0.45), 10.0 ** rng.uniform(-16.0, -3.0)
    return Orthotropic(1.0 + off, 1.0, 1.0, ν, ν, ν, 0.5 / (1.0 + ν), 1.0, rng.uniform(-180.0, 180.0))


KINDS = (orthotropic, cubic, anisotropic, isotropic_like)


def random_solid(seed):
    """A solid by its number; kinds take turns."""
    return KINDS[seed % len(KINDS)](np.random.default_rng(seed))


def stiffness(response):
    """c11, c12, c16, c22, c26, c66 over c66."""
    return response.C[np.triu_indices(3)].tolist()


def isotropic_as(kind, solid: Isotropic, angle=0.0):
    """An isotropic solid given as one of another kind, at an angle."""
    E, ν, ρ, plane = solid.E, solid.ν, solid.ρ, solid.plane
    G = solid.μ
    if kind == "orthotropic":
        return Orthotropic(E, E, E, ν, ν, ν, G, ρ, angle, plane)
    λ = E * ν / ((1.0 + ν) * (1.0 - 2.0 * ν))
    if kind == "cubic":
        return Cubic(λ + 2.0 * G, λ, G, ρ, angle, plane)
    if plane == "stress":
        λ = 2.0 * G * λ / (λ + 2.0 * G)
    return Anisotropic((λ + 2.0 * G, λ, 0.0, λ + 2.0 * G, 0.0, G), ρ, (λ, λ, 0.0), plane)
