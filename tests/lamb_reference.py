"""Lamb's problem, exactly: the surface of an isotropic half-plane under a uniform strip of pressure.

A line load δ(X) δ(t) along Y makes, after Cagniard and de Hoop, at the distance x and the time t

    v = F(x/t)/(π t),  F(C) = Re β_d C²/R,       u = F_u(x/t)/(π t),  F_u(C) = -Im (e - 2 β_s β_d)/R,

R = 4 β_s β_d - e², e = 2 - C², β = √(1 - C²/c²) = i√(C²/c² - 1) beyond its speed; lengths, times and
stresses over a, a/c_s and μ. Integrated over -1 < X < 1, moving at c, with Φ the integral of F over C
and principal values at the Rayleigh speed, where F_u has π times a residue.
"""

from itertools import pairwise

import numpy as np

_t, _w = np.polynomial.legendre.leggauss(80)


class Lamb:
    """The half-plane.

    Args:
        fast: c_d/c_s.
    """

    def __init__(self, fast):
        self.fast, self.k = fast, fast**-2
        low, high = 0.5, 1.0
        for _ in range(80):
            middle = (low + high) / 2.0
            low, high = (middle, high) if self.R(middle).real > 0.0 else (low, middle)
        self.c_R = low
        step = 1e-5
        self.slope = ((self.R(low + step) - self.R(low - step)) / (2.0 * step)).real

    def β(self, C, k):
        return np.sqrt(np.asarray(1.0 - k * C * C, dtype=complex))  # +i√ for a negative number

    def R(self, C):
        return C * C * self.r(C)

    def r(self, C):
        """R/C², which loses no digits at slow speeds."""
        k = self.k
        return 4.0 - C * C - 4.0 * (1.0 + k - k * C * C) / (1.0 + self.β(C, 1.0) * self.β(C, k))

    def F(self, C):
        """Of v and of u, (2, ...)."""
        r, bs, bd = self.r(C), self.β(C, 1.0), self.β(C, self.k)
        e = 2.0 - C * C
        return np.array([(bd / r).real, -((e - 2.0 * bs * bd) / r / np.maximum(C, 1.0) ** 2).imag])

    def Φ(self, C):
        """Integrals from 0 to speeds C (n,) of any sign, (2, n)."""
        size = np.minimum(np.abs(C), self.fast * (1.0 - 1e-15))
        slow, beyond = np.minimum(size, 1.0), np.maximum(size, 1.0)
        # Up to the shear wave C = sin θ; what is left without the pole is smooth.
        θ_R, end = np.arcsin(self.c_R), np.arcsin(slow)
        residue = self.β(self.c_R, self.k).real * self.c_R**2 / self.slope
        θ = end[..., None] * (1.0 + _t) / 2.0
        with np.errstate(all="ignore"):
            smooth = np.nan_to_num(self.F(np.sin(θ))[0] * np.cos(θ) - residue / (θ - θ_R))
        v = (smooth @ _w) * end / 2.0 + residue * np.log(np.maximum(np.abs(1.0 - end / θ_R), 1e-300))
        product = (self.β(self.c_R, 1.0) * self.β(self.c_R, self.k)).real
        u = -np.pi * (2.0 - self.c_R**2 - 2.0 * product) / self.slope * (size > self.c_R)
        # From there to the pressure wave C² = 1 + (c_d² - 1) sin²φ.
        wide = self.fast**2 - 1.0
        φ = np.arcsin(np.sqrt((beyond**2 - 1.0) / wide))[..., None] * (1.0 + _t) / 2.0
        of_φ = np.sqrt(1.0 + wide * np.sin(φ) ** 2)
        slopes = wide * np.sin(φ) * np.cos(φ) / of_φ * (φ[..., -1:] / (1.0 + _t[-1])) * _w
        both = (self.F(of_φ) * slopes).sum(axis=-1)
        return np.array([np.sign(C) * (v + both[0]), u + both[1]])

    def strip(self, X, t, c=0.0, history=None):
        """v and u at X (n,) and a time, (2, n); ``history`` is the load's share over time, with the times
        between which it is smooth, or None for one that is suddenly there."""
        load, knots = history or (np.ones_like, ())
        return np.array([self._at(float(x), t, c, load, knots) for x in X]).T / -np.pi

    def _at(self, X, t, c, load, knots):
        speeds = np.array([-self.fast, -1.0, -self.c_R, self.c_R, 1.0, self.fast])
        fronts = [(X + side) / (C - c) for side in (1.0, -1.0) for C in speeds]
        cuts = np.unique([0.0, t, *(one for one in (*fronts, *(t - np.array(knots))) if 0.0 < one < t)])
        total = np.zeros(2)
        for a, b in pairwise(cuts):
            # Logarithms at both ends: a double exponential rule.
            y = np.linspace(-3.2, 3.2, 161)
            grown = np.pi / 2.0 * np.sinh(y)
            τ = a + (b - a) / (1.0 + np.exp(-2.0 * grown))
            weights = (y[1] - y[0]) * np.pi / 4.0 * (b - a) * np.cosh(y) / np.cosh(grown) ** 2
            keep = (τ > a) & (τ < b)
            τ, weights = τ[keep], weights[keep]
            total += (self.Φ(c + (X + 1.0) / τ) - self.Φ(c + (X - 1.0) / τ)) @ (weights * load(t - τ))
        return total
