"""Surface response of the moving frame from the Fourier solution, solved numerically (Eqs 17-21, 31, 33).

A reference of :class:`galinx.solvers.solids.isotropic.MovingFrame` that shares no formula with it: for
tractions exp(iX) the decaying solutions of Eqs 15-16 are found from their characteristic polynomial,
and the amplitudes from the two boundary conditions. The two roots meet as c → 0, so digits are lost
there.
"""

import numpy as np
from numpy.typing import NDArray


def surface_response(κ: float, c: float) -> tuple[float, float, float]:
    """n, q and m of ``MovingFrame``, dimensionless, with an error of about 1e-16/c².

    Args:
        κ: Kolosov's constant, κ > 1.
        c: speed over shear wave speed, 0 < c < 1.
    """
    K, coupling, λ = (κ + 1.0) / (κ - 1.0), 2.0 / (κ - 1.0), (3.0 - κ) / (κ - 1.0)
    P = K - c**2
    # u = A exp(iX + pY), v = B exp(iX + pY) in Eqs 15-16: a quadratic in p².
    squares = np.roots([K, coupling**2 - K * P - (1.0 - c**2), P * (1.0 - c**2)]).astype(complex)
    p = np.sqrt(squares)
    p = np.where(p.real < 0.0, -p, p)
    A = np.ones(2, dtype=complex)
    B = (P - p**2) / (1j * coupling * p) * A
    tractions = np.array([K * p * B + 1j * λ * A, p * A + 1j * B])  # σ_YY/μ, σ_XY/μ
    amplitudes: NDArray[np.complex128] = np.linalg.solve(tractions, np.eye(2))
    u_X, v_X = 1j * A @ amplitudes, 1j * B @ amplitudes
    # The Hilbert transform multiplies exp(iX) by i.
    return float(v_X[0].imag), float(u_X[0].real), float(u_X[1].imag)
