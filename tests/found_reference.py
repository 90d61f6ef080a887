"""Contacts with free ends in many digits, by quadrature and by textbook formulas: no line of the program.

With a, b = 1 - a the exponents, N̂ = n + g n₁₂, Q = g q, w = (1 - s)^a (1 + s)^b and a slope P'(X):

    ∫ P'(m + h s)/w ds = 0,    N = h (sin πa/N̂) ∫ s P'(m + h s)/w ds,
    σ_YY = -[Q P' + (N̂/π) w ⨍ P'/(w (t - s)) dt]/(N̂² + Q²).
"""

import mpmath as mp

DIGITS = 20


def exponents(n, q, n12, g):
    """a and b: the flat punch's exponents and one."""
    cot = mp.mpf(g) * q / (n + mp.mpf(g) * n12)
    a = mp.mpf(1) / 2 - mp.atan(cot) / mp.pi
    return a, 1 - a


def parabola(n, q, n12, g, radius, load):
    """Half-width, centre, largest pressure over N/(2h) and its place, by the exact formulas."""
    a, b = exponents(n, q, n12, g)
    N̂ = n + mp.mpf(g) * n12
    h = mp.sqrt(load * radius * N̂ / (2 * mp.pi * a * b))
    p0 = h * mp.sin(mp.pi * a) / (radius * N̂)
    top = (1 - (b - a)) ** a * (1 + (b - a)) ** b
    return h, h * (b - a), p0 * top * 2 * h / load, b - a


class Contact:
    """A contact of half-width h around m under a slope that is smooth between kinks."""

    def __init__(self, constants, g, slope, kinks, m, h):
        self.n, self.q, self.n12 = constants
        self.g, self.slope, self.m, self.h = mp.mpf(g), slope, mp.mpf(m), mp.mpf(h)
        self.a, self.b = exponents(*constants, g)
        self.N̂, self.Q = self.n + self.g * self.n12, self.g * self.q
        self.at = sorted((mp.mpf(x) - self.m) / self.h for x in kinks)

    def f(self, s):
        return self.slope(self.m + self.h * s)

    def _integral(self, F, *more):
        places = [-1, *(x for x in sorted([*self.at, *more]) if -1 < x < 1), 1]
        return mp.quad(F, places)

    def _over_w(self, s):
        return (1 - s) ** -self.a * (1 + s) ** -self.b

    @property
    def lift(self):
        return self._integral(lambda s: self.f(s) * self._over_w(s))

    @property
    def load(self):
        moment = self._integral(lambda s: s * self.f(s) * self._over_w(s))
        return self.h * mp.sin(mp.pi * self.a) / self.N̂ * moment

    def σ_YY(self, s):
        """Over N/(2h)."""
        s = mp.mpf(s)
        w, here = 1 / self._over_w(s), self.f(s)

        def divided(t):  # the rule's outermost nodes, of no weight, may be rounded to s
            return (self.f(t) - here) / (t - s) * self._over_w(t) if t != s else mp.mpf(0)

        rest = self._integral(divided, s)
        # ⨍ dt/(w (t - s)) = -π cot(πa)/w
        value = rest - here * mp.pi * mp.cot(mp.pi * self.a) / w
        σ = -(self.Q * here + self.N̂ / mp.pi * w * value) / (self.N̂**2 + self.Q**2)
        return σ * 2 * self.h / self.load


def solved(constants, g, slope, kinks, load, near):
    """The contact that carries a load N/μ, from a centre and a half-width near by."""
    with mp.workdps(DIGITS):
        scale = mp.mpf(near[1])

        def off(x, y):
            contact = Contact(constants, g, slope, kinks, x * scale, y * scale)
            return [contact.lift, contact.load / load - 1]

        x, y = mp.findroot(off, (near[0] / near[1], 1.0), tol=1e-20)
        return Contact(constants, g, slope, kinks, x * scale, y * scale)
