"""Solids of the tests of layers, in the numbers of the program and of the reference."""

import mpmath as mp
import numpy as np

from galinx.solvers.contact.equation import Equation, SolvedContact, converged
from galinx.solvers.layers.kernel import Kernel
from galinx.solvers.solids.isotropic import Isotropic

COAT, SUBSTRATE = Isotropic(7.5, 0.3, 1.2), Isotropic(2.5, 0.25, 1.0)


def flat(r):
    return np.zeros_like(r)


def equation(solid, V2, g, slope=flat, tolerance=1e-13):
    """Of a punch of half-width 1 at the speed √V2."""
    response = solid.response(V2**0.5 / solid.c_s)
    return Equation(response, Kernel(response.stack(1.0), tolerance), g, slope)


def converged_pressure(equation, tolerance):
    """Contact with the pressure of an equation, to a relative tolerance."""
    return converged(equation, lambda at: SolvedContact(equation.g, equation.pressure(at)), tolerance)


def constants(solid):
    """c11, c12, c16, c22, c26, c66 of any solid, by Hooke's law."""
    response = solid.response(0.0)
    columns = [[[1.0, 0.0], [0.0, 0.0]], [[0.0, 0.0], [0.0, 1.0]], [[0.0, 1.0], [0.0, 0.0]]]
    C = solid.μ * np.array([response.stresses(np.array(one)) for one in columns])
    return [mp.mpf(float(C[i])) for i in ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))]
