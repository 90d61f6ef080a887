"""Friction and stresses from the formulas of the study, by nothing of the program."""

import numpy as np


def f_of(mu, sigma, delta, motion, X, L=1e-4):
    """Dahl's friction at X over L of a stroke, all strokes before it gone to their end."""
    f = 0.0
    for name, s in (("FM1", 1), ("BM1", -1), ("FM2", 1)):
        way = L * ((X if s > 0 else 1.0 - X) if name == motion else 1.0)
        y = 1.0 - s * f / mu
        if delta == 1.0:
            y *= np.exp(-sigma * way / mu)
        else:
            power = y ** (1.0 - delta) - (1.0 - delta) * sigma * way / mu
            y = power ** (1.0 / (1.0 - delta)) if power > 0.0 else 0.0
        f = s * mu * (1.0 - y)
        if name == motion:
            return f
    raise AssertionError(motion)


K = 1.0 / 3.0  # (κ - 1)/(κ + 1) at κ = 2


def constants(c):
    """n, q, m of the moving frame at κ = 2, with all digits at slow speeds."""
    s, d = np.sqrt(1.0 - c * c), np.sqrt(1.0 - K * c * c)
    fraction = 4.0 * (1.0 + K - K * c * c) / (1.0 + s * d)
    r = 4.0 - c * c - fraction
    return d / r, (fraction / 2.0 - 1.0) / r, s / r


def exponent(f, c):
    """α with cot(πα) = g q/n, g = -f."""
    n, q, _ = constants(c)
    return -0.5 + np.arctan(f * q / n) / np.pi


def stresses(x, f, c):
    """σ_YY and σ_XX over N/(2a) of the sliding flat punch (Eqs 32, 38-43, 55)."""
    (n, q, m), α, g = constants(c), exponent(f, c), -f
    size, under = 2.0 * np.sin(np.pi * α) / np.pi, np.abs(x) < 1.0
    weight = np.abs(1.0 - x) ** α * np.abs(1.0 + x) ** (-1.0 - α)
    σ_YY = np.where(under, size * weight, 0.0)
    hilbert = np.where(under, g * q / n * σ_YY, 2.0 / np.pi * np.sign(x) * weight)
    σ_XX = (1.0 + 8.0 * q) / 3.0 * σ_YY + 8.0 * m / 3.0 * g * hilbert
    return np.where(under, σ_YY, np.nan), σ_XX
