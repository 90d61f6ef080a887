"""A cylinder drawn over a coated half-plane at rest: it shares no line with the program.

Airy's stress function of a wave e^(ikx) is (A + Bky)e^(-ky), y the depth, with growing terms too in the
coating. The pressure is linear between points of an even grid; points that would pull are given up.
"""

import numpy as np
from scipy.special import roots_jacobi


def waves(k, solid, depth, below):
    """(σ_xx, σ_yy, σ_xy, ∂u_x/∂x, ∂u_y/∂x) of the functions of one solid, at a depth under its top.

    `below` is the thickness, from whose lower face growing functions are counted, or None.
    """
    E, ν = solid
    μ, z = E / (2 * (1 + ν)), k * depth
    decay = np.exp(-z)
    # f and its derivatives over k, k², k³.
    f = [[decay, -decay, decay, -decay], [z * decay, (1 - z) * decay, (z - 2) * decay, (3 - z) * decay]]
    if below is not None:
        z = k * (depth - below)
        grow = np.exp(z)
        f += [[grow, grow, grow, grow], [z * grow, (1 + z) * grow, (z + 2) * grow, (z + 3) * grow]]
    f = np.moveaxis(np.array(f), -1, 0)  # wave, function, derivative
    f0, f1, f2, f3 = np.moveaxis(f, -1, 0)
    xx, yy, xy = f2, -f0, -1j * f1
    along = ((1 - ν) * f2 + ν * f0) / (2 * μ)
    slope = 1j * (-f1 / μ + ((1 - ν) * f3 + ν * f1) / (2 * μ))
    return np.stack([xx, yy, xy, along, slope], axis=1)  # wave, quantity, function


class Coated:
    """Stresses and slopes of a coated half-plane under e^(ikx) loads."""

    def __init__(self, coating, substrate, thickness, k):
        self.coating, self.substrate, self.thickness, self.k = coating, substrate, thickness, k
        M = np.zeros((len(k), 6, 6), dtype=complex)
        M[:, :2, :4] = waves(k, coating, 0.0, thickness)[:, 1:3]
        M[:, 2:, :4] = waves(k, coating, thickness, thickness)[:, 1:]
        M[:, 2:, 4:] = -waves(k, substrate, 0.0, None)[:, 1:]
        scale = np.array([1, 1, 1, 1, coating[0], coating[0]])
        loads = np.broadcast_to(np.eye(6)[:, :2], (len(k), 6, 2))
        self.amplitudes = np.linalg.solve(M * scale[:, None], loads)

    def at(self, depth, substrate=False):
        """σ_xx, σ_yy, σ_xy, ∂u_x/∂x and ∂u_y/∂x, wave × 5 × 2, under unit σ_yy and σ_xy on top."""
        if substrate:
            return waves(self.k, self.substrate, depth - self.thickness, None) @ self.amplitudes[:, 4:]
        return waves(self.k, self.coating, depth, self.thickness) @ self.amplitudes[:, :4]


class DrawnCylinder:
    """A cylinder pressed on by a line load and drawn, with Coulomb's friction.

    Args:
        coating, substrate: E and Poisson's ratio.
        thickness, radius, load, friction: the surface is drawn towards larger x.
        step, number: of the even grid, whose loads repeat.
        width: the contact is narrower than twice it.
    """

    def __init__(self, coating, substrate, thickness, radius, load, friction, step, number, width):
        self.k = 2 * np.pi * np.fft.rfftfreq(number, step)
        self.k[0] = 1e-6 * self.k[1]  # what does not vary is the limit of long waves
        self.step, self.number, self.friction = step, number, friction
        self.body = Coated(coating, substrate, thickness, self.k)
        self.x = (np.arange(number) - number // 2) * step
        self.hat = np.sinc(self.k * step / (2 * np.pi)) ** 2
        self.pressure = np.zeros(number)
        self._press(radius, load, width)

    def _response(self, waves):
        """Of a pressure p (σ_yy = -p) and the friction f p on it."""
        # On a surface whose solid lies at y > 0, σ_xy = -t for the traction t along x.
        return -waves[..., 0] - self.friction * waves[..., 1]

    def _press(self, radius, load, width):
        # u_y grows into the solid; the gap closes where ∂u_y/∂x = -x/R.
        depths = self._response(self.body.at(0.0))[:, 4] / (1j * self.k) * self.hat
        depths[0] = 0.0  # a constant, which the cylinder's place takes up
        one = np.fft.irfft(depths, self.number)
        active = np.flatnonzero(np.abs(self.x) < width)
        while True:
            # Points, then the depth at which the cylinder stands, under which the load is whole.
            n = len(active)
            A = np.zeros((n + 1, n + 1))
            A[:n, :n] = one[(active[:, None] - active[None, :]) % self.number]
            A[:n, n], A[n, :n] = -1.0, self.step
            b = np.append(-(self.x[active] ** 2) / (2 * radius), load)
            p = np.linalg.solve(A, b)[:n]
            if (p >= 0).all():
                break
            active = active[p >= 0]
        self.pressure[active] = p
        self.spectrum = np.fft.rfft(self.pressure) * self.hat
        # Short waves say how the pressure goes to zero: like a power of the distance from either end.
        slope = self._response(self.body.at(0.0))[-1, 4]
        a = 0.5 - np.arctan(slope.real / slope.imag) / np.pi
        self.exponents, ends = (a, 1 - a), []
        for exponent, near in zip(self.exponents, (active[3:30], active[-30:-3]), strict=True):
            line = np.polyfit(self.x[near] - self.x[near[0]], self.pressure[near] ** (1 / exponent), 3)
            ends.append(self.x[near[0]] + min(np.roots(line), key=abs).real)
        self.ends = tuple(ends)

    def stresses(self, depth, substrate=False):
        """σ_xx, σ_yy, σ_xy on the grid, 3 × number."""
        response = self._response(self.body.at(depth, substrate))
        return np.array([np.fft.irfft(response[:, i] * self.spectrum, self.number) for i in range(3)])

    def tension_at_trailing_end(self):
        """σ_xx at the first end: of a half-plane of the coating by quadrature, the rest by waves."""
        plain = Coated(self.body.coating, self.body.coating, self.body.thickness, self.k)
        a, b = self.exponents
        inside = self.pressure > 0
        m, h = sum(self.ends) / 2, (self.ends[1] - self.ends[0]) / 2
        s = ((self.x[inside] - m) / h)[5:-5]
        root = (1 - s) ** b * (1 + s) ** a
        smooth = np.polynomial.Polynomial.fit(s, self.pressure[inside][5:-5] / root, 14)
        # ∫ p/(s + 1) ds.
        s, weights = roots_jacobi(20, b, a - 1)
        half_plane = 2 * self.friction / np.pi * weights @ smooth(s)
        rest = self._response(self.body.at(0.0) - plain.at(0.0))[:, 0] * self.spectrum
        return half_plane + np.interp(self.ends[0], self.x, np.fft.irfft(rest, self.number))


def von_mises(σ, ν):
    """In plane strain."""
    xx, yy, xy = σ
    zz = ν * (xx + yy)
    return np.sqrt(((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) / 2 + 3 * xy**2)
