"""Stresses below a pressure on an isotropic solid, by its potential in two planes: a reference.

Plain arithmetic, which takes numbers of any precision and symbols. The code's own field is a function of
a matrix, for every kind of solid; here are the formulas of the isotropic one, which a proof may follow.
"""


def field(frame, g, s_s, h_s, s, h):
    """σ_XX, σ_YY, σ_XY of a potential Φ at z_s and z_d, z_j = X + i β_j Y.

    Args:
        frame: constants κ, c, k, β_s, β_d, r and q of the moving frame.
        g: σ_XY/σ_YY on the surface.
        s_s, h_s: -Im and Re of Φ(z_s).
        s, h: -Im and Re of (Φ(z_d) - Φ(z_s))/c².
    """
    k, β_s, β_d, r, q, κ = frame.k, frame.β_s, frame.β_d, frame.r, frame.q, frame.κ
    c2 = frame.c**2
    e = 2 - c2  # 1 + β_s²
    u_X = (e * s + β_s * g * (2 * h + h_s)) / r + q * s_s
    v_Y = (
        -(β_d**2) * e * s
        + β_d * (β_d - 2 * (1 - k) / (β_d + β_s)) * s_s
        + β_s * g * ((2 * k - 1) * h_s - 2 * β_d**2 * h)
    ) / r
    σ_XY = g * (4 * β_s * β_d * s / r + s_s) - 2 * β_d * e * h / r
    # (u,X + v,Y)/(κ - 1), in which κ - 1 has cancelled: it stays what it is up to ν = 1/2.
    S = 1 + β_s * β_d
    of_s_s = 2 * (1 - c2) / S - c2 + 2 * (β_d + β_s * c2 / S) / (β_d + β_s)
    dilatation = (c2 * (e * s + 2 * g * β_s * h) + 2 * β_s * g * h_s + of_s_s * s_s) / ((κ + 1) * r)
    return u_X - v_Y + 2 * dilatation, v_Y - u_X + 2 * dilatation, σ_XY  # Eqs 6-7
