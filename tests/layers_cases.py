"""Solids of the tests of layers, in the numbers of the program and of the reference."""

import mpmath as mp
import numpy as np
from random_solids import orthotropic

from galinx.solvers.contact.equation import Equation, SolvedContact, converged
from galinx.solvers.layers.kernel import Kernel
from galinx.solvers.layers.layered import Layer, Layered
from galinx.solvers.solids.isotropic import Isotropic

COAT, SUBSTRATE = Isotropic(7.5, 0.3, 1.2), Isotropic(2.5, 0.25, 1.0)


def equation(solid, V2, g, tolerance=1e-13):
    """Of a flat punch of half-width 1 at the speed √V2."""
    response = solid.response(V2**0.5 / solid.c_s)
    return Equation(response, Kernel(response.stack(1.0), tolerance), g, np.zeros_like)


def converged_pressure(equation, tolerance):
    """Contact with the pressure of an equation, to a relative tolerance."""
    return converged(equation, lambda at: SolvedContact(equation.g, equation.pressure(at)), tolerance)


def constants(solid):
    """c11, c12, c16, c22, c26, c66 of any solid, by Hooke's law."""
    response = solid.response(0.0)
    columns = [[[1.0, 0.0], [0.0, 0.0]], [[0.0, 0.0], [0.0, 1.0]], [[0.0, 1.0], [0.0, 0.0]]]
    C = solid.μ * np.array([response.stresses(np.array(one)) for one in columns])
    return [mp.mpf(float(C[i])) for i in ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))]


def random_stack(seed, graded=False):
    """Layers of random solids, moduli up to 400 times apart, and a speed below the limit."""
    rng = np.random.default_rng(seed)

    def solid(stiffness):
        if rng.random() < 0.5:
            return Isotropic(stiffness, rng.uniform(0.0, 0.45), rng.uniform(0.5, 2.0))
        one = orthotropic(rng, 10.0)
        scale = stiffness / one.E2
        return type(one)(
            one.E1 * scale, one.E2 * scale, one.E3 * scale, one.ν12, one.ν13, one.ν23, one.G12 * scale,
            rng.uniform(0.5, 2.0), one.angle, "strain",
        )  # fmt: skip

    layers = []
    for _ in range(rng.integers(1, 6)):
        top = solid(20.0 ** rng.uniform(-1.0, 1.0))
        bottom = None
        if graded and isinstance(top, Isotropic):
            bottom = Isotropic(top.E * 4.0 ** rng.uniform(-1.0, 1.0), rng.uniform(0.0, 0.45), top.ρ)
        layers.append(Layer(20.0 ** rng.uniform(-1.0, 1.0), top, bottom))
    whole = Layered(tuple(layers), solid(1.0))
    return whole, rng.uniform(0.1, 0.98) * whole.limit()
