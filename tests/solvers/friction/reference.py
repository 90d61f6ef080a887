"""Friction laws as papers print them, in time and with signed velocities, integrated step by step.

Nothing of galinx is imported here. A law is a function of its parameters, by the names that scenes use,
and of the motion, strokes (direction, speed, length, rest before it); it gives f at so many places of
each, evenly spaced from its start to its end, (strokes, places), and ∫ f v dt over each, (strokes,).
"""

from itertools import pairwise
from math import asinh, exp, log, pi, sin

import numpy as np
from scipy.integrate import solve_ivp

_PRECISE = {"method": "DOP853", "rtol": 3e-14, "atol": 1e-19}


def _advance(rhs, y, times, stop=None):
    """States at times, from y on, and time and state where ``stop`` rises through zero, or None."""
    if stop is not None:
        stop.terminal, stop.direction = True, 1.0
    found = [y]
    for start, end in pairwise(times):
        done = solve_ivp(rhs, (start, end), found[-1], events=stop, **_PRECISE)
        assert done.success
        if done.status == 1:
            return np.array(found), done.t_events[0][0], done.y_events[0][0]
        found.append(done.y[:, -1])
    return np.array(found), None, None


def _along(strokes, places, y, rhs, friction, pause=lambda y, seconds: y):
    """All strokes of a law whose rate is smooth: y' = rhs(y, v), f = friction(y, v)."""
    f, work = [], []
    for s, V, length, rest in strokes:
        y, v = pause(y, rest), s * V

        def whole(_, state, v=v):
            return np.append(rhs(state[:-1], v), friction(state[:-1], v) * v)

        states, _, _ = _advance(whole, np.append(y, 0.0), np.linspace(0.0, length / V, places))
        f.append([friction(state[:-1], v) for state in states])
        work.append(states[-1, -1])
        y = states[-1, :-1]
    return np.array(f), np.array(work)


def _curve(V, mu_c, mu_s, stribeck_velocity, stribeck_exponent, **_):
    return mu_c + (mu_s - mu_c) * exp(-((abs(V) / stribeck_velocity) ** stribeck_exponent))


def coulomb(strokes, places, mu_c):
    return _along(strokes, places, np.zeros(1), lambda y, v: 0.0 * y, lambda y, v: np.sign(v) * mu_c)


def stribeck(strokes, places, sigma2_over_load, **curve):
    def friction(y, v):
        return np.sign(v) * _curve(v, **curve) + sigma2_over_load * v

    return _along(strokes, places, np.zeros(1), lambda y, v: 0.0 * y, friction)


def dahl(strokes, places, mu_c, sigma0_over_load, delta):
    def rate(f, v):
        y = 1.0 - np.sign(v) * f / mu_c
        return sigma0_over_load * v * np.sign(y) * np.abs(y) ** delta

    return _along(strokes, places, np.zeros(1), rate, lambda f, v: f[0])


def lugre(strokes, places, sigma0_over_load, sigma1_over_load, sigma2_over_load, **curve):
    def rate(z, v):
        return v - sigma0_over_load * abs(v) * z / _curve(v, **curve)

    def friction(z, v):
        bristles = sigma0_over_load * z[0] + sigma1_over_load * rate(z[0], v)
        return bristles + sigma2_over_load * v

    return _along(strokes, places, np.zeros(1), rate, friction)


def rate_and_state(
    strokes, places, a, b, reference_speed, reference_friction, critical_slip, evolution, state0
):
    def rate(θ, v):
        turns = abs(v) * θ / critical_slip
        return 1.0 - turns if evolution == "ageing" else -turns * np.log(turns)

    def friction(θ, v):
        inner = (reference_friction + b * log(reference_speed * θ[0] / critical_slip)) / a
        return np.sign(v) * a * asinh(abs(v) / (2.0 * reference_speed) * exp(inner))

    def pause(θ, seconds):
        return θ + seconds if evolution == "ageing" else θ

    θ = np.array([state0 * critical_slip / reference_speed])
    return _along(strokes, places, θ, rate, friction, pause)


def _element(strokes, places, k, limit, attraction):
    """f of a spring with a slider; ``limit(V)`` that it bears, ``attraction(f, v)`` its rate in slip."""
    f, work, force, slipping = [], [], 0.0, 0.0
    for s, V, length, rest in strokes:
        if s != slipping or rest > 0.0:
            slipping = 0.0
        times, v = np.linspace(0.0, length / V, places), s * V
        if not slipping and s * force > limit(V):
            slipping = float(s)
        values, y = [], np.array([force, 0.0])
        if not slipping:
            found, at, y_at = _advance(
                lambda _, y, v=v: [k * v, y[0] * v], y, times,
                lambda _, y, s=s, V=V: s * y[0] - limit(V),
            )  # fmt: skip
            values, y, times = list(found[:, 0]), found[-1], times[len(found) :]
            if at is not None:
                slipping, y, times = float(s), y_at, np.append(at, times)
        else:
            at = 0.0
        if at is not None:
            found, _, _ = _advance(lambda _, y, v=v: [attraction(y[0], v), y[0] * v], y, times)
            values += list(found[len(values) > 0 :, 0])
            y = found[-1]
        f.append(values)
        work.append(y[1])
        force = y[0]
    return np.array(f), np.array(work)


def maxwell_slip(strokes, places, elements):
    parts = [
        _element(strokes, places, k, lambda V, μ=μ: μ, lambda f, v: 0.0) for k, μ in elements
    ]  # fmt: skip
    return sum(f for f, _ in parts), sum(work for _, work in parts)


def gms(strokes, places, elements, attraction_rate, **curve):
    total = sum(μ for _, μ in elements)
    parts = []
    for k, μ in elements:
        α = μ / total

        def limit(V, α=α):
            return α * _curve(V, **curve)

        def attraction(f, v, α=α):
            return np.sign(v) * attraction_rate * (α - abs(f) / _curve(v, **curve))

        parts.append(_element(strokes, places, k, limit, attraction))
    return sum(f for f, _ in parts), sum(work for _, work in parts)


def bouc_wen(strokes, places, mu_c, yield_displacement, exponent, gamma):
    """Integrated in two pieces where it comes from unloading to loading."""
    f, work, ζ = [], [], 0.0
    for s, V, length, _ in strokes:
        v, times, values = s * V, np.linspace(0.0, length / V, places), []

        def rates(_, y, v=v):
            turned = gamma + (1.0 - gamma) * np.sign(v * y[0])
            return [v / yield_displacement * (1.0 - abs(y[0]) ** exponent * turned), mu_c * y[0] * v]

        y, stop = np.array([ζ, 0.0]), (lambda _, y, s=s: s * y[0]) if s * ζ < 0.0 else None
        found, at, y_at = _advance(rates, y, times, stop)
        values = list(found[:, 0])
        if at is not None:
            y_at[0] = 0.0
            found, _, _ = _advance(rates, y_at, np.append(at, times[len(found) :]))
            values += list(found[1:, 0])
        f.append(mu_c * np.array(values))
        work.append(found[-1, 1])
        ζ = found[-1, 0]
    return np.array(f), np.array(work)


def elasto_plastic(
    strokes, places, sigma0_over_load, sigma1_over_load, sigma2_over_load, breakaway_ratio, **curve
):
    """w = s σ₀ z/(N g) over x = σ₀ d/g, in pieces: up to breakaway it is a straight line."""
    ζ, f, work = 0.0, [], []
    for s, V, length, _ in strokes:
        g = _curve(V, **curve)

        def slope(w):
            α = 0.0
            if breakaway_ratio < w < 1.0:
                middle = 0.5 * (1.0 + breakaway_ratio)
                α = 0.5 * (1.0 + sin(pi * (w - middle) / (1.0 - breakaway_ratio)))
            return 1.0 - (1.0 if w >= 1.0 else α) * w

        x, first = np.linspace(0.0, sigma0_over_load * length / g, places), s * ζ / g
        free = max(breakaway_ratio - first, 0.0)
        stuck = np.minimum(x, free)
        w, area = first + stuck, stuck * (first + 0.5 * stuck)
        if (beyond := x > free).any():
            start = np.array([first + free, area[-1]])
            states, _, _ = _advance(
                lambda _, y: np.array([slope(y[0]), y[0]]), start, np.append(free, x[beyond])
            )
            w[beyond], area[beyond] = states[1:].T
        f.append(s * (g * w + V * sigma1_over_load * np.array([slope(one) for one in w])))
        f[-1] = f[-1] + s * sigma2_over_load * V
        by_bristles = g * area[-1] + sigma1_over_load * V * (w[-1] - first)
        work.append(g / sigma0_over_load * by_bristles + sigma2_over_load * V * length)
        ζ = s * g * w[-1]
    return np.array(f), np.array(work)


def table(strokes, places, shape, shape_backward=()):
    """The slip since the reversal is integrated, f looked up."""
    forward = np.array(shape)
    backward = np.array(shape_backward) if shape_backward else forward * [1.0, -1.0]
    f, work, slip, last = [], [], 0.0, 0
    for s, _, length, _ in strokes:
        slip = slip if s == last else 0.0
        d, values = (forward if s > 0 else backward).T
        at = slip + np.linspace(0.0, length, places)
        f.append(np.interp(at, d, values))
        ends = np.unique(np.concatenate([[slip, slip + length], d[(d > slip) & (d < slip + length)]]))
        heights = np.interp(ends, d, values)
        work.append(s * (0.5 * (heights[1:] + heights[:-1]) * np.diff(ends)).sum())
        slip, last = slip + length, s
    return np.array(f), np.array(work)
