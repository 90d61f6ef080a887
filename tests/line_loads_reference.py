"""Stresses below a contact by summing line loads over its pressure: no line of the program.

A line load ∫σ_YY = 1, ∫σ_XY = g at t gives, by Stroh's eigenvectors, stresses that are sums over both
planes z = X + pY of amplitudes over (t - z); the pressure of a free contact is a principal value. All
integrals are Gauss's rule in panels of the coordinate x = log((1 + t)/(1 - t)), which halve towards the
places that integrands feel.
"""

import mpmath as mp
import numpy as np
from scipy.optimize import fsolve
from stroh import Stroh

#: Where panels end that need not halve, and the shortest of the others: beyond |x| = 12 all is powers
#: of e^x, and beyond 300 it is nothing.
_ENDS = np.concatenate(
    [np.arange(-300.0, -12.0, 8.0), np.linspace(-12.0, 12.0, 17), np.arange(20.0, 301.0, 8.0)]
)
_SHORTEST = 1e-13


class Rule:
    """A rule over -1 < t < 1 with distances from both ends that lose no digits.

    Args:
        at: positions towards which panels halve, each with the size to which they do in x.
        nodes: of a panel; rules with other numbers have no position in common.
    """

    def __init__(self, at=(), nodes=16):
        τ, weights = np.polynomial.legendre.leggauss(nodes)
        places = [(float(np.arctanh(t) * 2.0), size) for t, size in at if abs(t) < 1.0]
        ends = {*_ENDS}
        for x, size in places:
            steps = 0.5 ** np.arange(0, max(1.0, np.ceil(-np.log2(max(size, _SHORTEST)))))
            ends |= {x, *(x + steps), *(x - steps)}
        ends = np.array(sorted(ends))
        middle, half = (ends[1:] + ends[:-1]) / 2.0, np.diff(ends) / 2.0
        x = (middle[:, None] + half[:, None] * τ).ravel()
        self.left, self.right = 2.0 / (1.0 + np.exp(-x)), 2.0 / (1.0 + np.exp(x))
        self.t = np.where(x < 0.0, self.left - 1.0, 1.0 - self.right)
        self.w = (half[:, None] * weights).ravel() * self.left * self.right / 2.0


class Lines:
    """Line loads on a half-plane at a speed, friction included.

    Args:
        C: c11, c12, c16, c22, c26, c66 over c66.
        c: speed over √(c66/ρ).
        g: σ_XY/σ_YY.
    """

    def __init__(self, C, c, g):
        with mp.workdps(40):
            stroh = Stroh(C, c)
            weights = stroh.B**-1 * mp.matrix([mp.mpf(float(g)), 1])
            amplitudes = []
            for k, p in enumerate(stroh.p):
                a, b, f = stroh.A[:, k], stroh.B[:, k], -weights[k] / (2j * mp.pi)
                XX = -p * b[0] + stroh.inertia * a[0]
                amplitudes.append([complex(2 * part * f) for part in (XX, b[1], b[0])])
            n, _, n12, q = (float(x) for x in stroh.surface)
        self.p, self.amplitudes = [complex(p) for p in stroh.p], np.array(amplitudes)
        #: n + g n₁₂ and g q of N̂ H[σ_YY] - Q σ_YY = μ v,X under the punch.
        self.n, self.Q = n + g * n12, g * q

    def feet(self, X, Y):
        """Where points are seen from, and how far they are from there: for rules."""
        return [(float(z.real), 0.3 * abs(z.imag)) for p in self.p for z in X + p * Y]

    def stresses(self, rule, σ, X, Y):
        """σ_XX, σ_YY, σ_XY at points (n,) below a pressure σ_YY at a rule's positions, (3, n)."""
        found = 0.0
        for p, amplitude in zip(self.p, self.amplitudes):
            cauchy = ((rule.w * σ) / (rule.t - (X + p * Y)[:, None])).sum(axis=1)
            found = found + (amplitude[:, None] * cauchy).real
        return found


class FreeContact:
    """A contact [-1, 1] with free ends below any slope.

    Args:
        lines: the half-plane.
        slope: of the profile at X.
        kinks: X at which it or its derivatives jump.
        load: N/μ, of the length that X is in.
        start: guesses of centre and half-width.
    """

    def __init__(self, lines, slope, kinks, load, start):
        self._lines, self._slope, self._kinks = lines, slope, kinks
        self.a = float(mp.acot(lines.Q / lines.n) / mp.pi) % 1.0

        def off(guess):
            self.m, self.h = guess[0] * start[1], guess[1] * start[1]
            rule = self.rule()
            f = self.f(rule)
            lift, turn = (
                (rule.w * f / self._weight(rule)).sum(),
                (rule.w * rule.t * f / self._weight(rule)).sum(),
            )
            return [lift, self.h * np.sin(np.pi * self.a) / lines.n * turn / load - 1.0]

        off(fsolve(off, [start[0] / start[1], 1.0], xtol=1e-14))
        self._unit = 2.0 * self.h / load

    def rule(self, more=()):
        return Rule([*self._graded, *more])

    @property
    def _graded(self):
        return [((x - self.m) / self.h, 0.0) for x in self._kinks]

    def f(self, rule):
        return self._slope(self.m + self.h * rule.t)

    def _weight(self, rule):
        return rule.right**self.a * rule.left ** (1.0 - self.a)

    def σ_YY(self, at):
        """Over N/(2h) at the positions of a rule."""
        own, f_at, w_at = Rule(self._graded, 14), self.f(at), self._weight(at)
        f, density = self.f(own), own.w / self._weight(own)
        value = np.empty(len(at.t))
        for first in range(0, len(value), 500):
            some = slice(first, first + 500)
            between = _between(own, at, some)  # none but next to a kink, where all this has no weight
            value[some] = (
                np.divide(f - f_at[some, None], between, where=between != 0.0, out=0.0 * between)
                @ density
            )
        value -= f_at * np.pi / np.tan(np.pi * self.a) / w_at
        n, Q = self._lines.n, self._lines.Q
        return -(Q * f_at + n / np.pi * w_at * value) / (n**2 + Q**2) * self._unit


def _between(rule, at, some):
    """t - s, by the distances from the nearer end."""
    left = rule.left - at.left[some, None]
    return np.where(rule.t < 0.0, left, at.right[some, None] - rule.right)
