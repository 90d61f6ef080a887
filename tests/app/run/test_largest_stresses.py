"""Largest stresses of both methods, against samples of the closed form that know nothing of a search."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from loaded import LoadedHalfPlane
from support import THOROUGH, computed, of_sections

import galinx
from galinx.app.plan.plan import surface_grid
from galinx.solvers.contact.closed_form import contacts
from galinx.solvers.contact.prescribed_pressure import LinearPressure
from galinx.solvers.contact.stresses import maximum_shear, von_mises
from galinx.solvers.profiles import cusp

#: Relative, of what a search may miss: anywhere, and next to a cusp of the pressure. Distance over a from
#: an end or a kink within which a place is that end or kink.
MISSED, NEXT_TO_CUSP, AT_TURN = 1e-6, 1e-4, 1e-10

PUNCHES = {
    "parabolic": lambda rng: {"radius": 0.02},
    "rounded_flat": lambda rng: {"flat_half_width": 10.0 ** rng.uniform(-5.0, -3.0), "radius": 0.02},
    "power": lambda rng: {"exponent": float(exponent(rng)), "coefficient": 0.5},
    "table": lambda rng: {"shape": table(rng)},
}


def exponent(rng):
    """With a cusp of the pressure, or without."""
    return rng.choice([rng.uniform(1.25, 2.0), rng.uniform(2.0, 5.0)])


def table(rng):
    """Points of a convex curve that no contact reaches beyond."""
    X = np.sort(np.concatenate([[-0.2, 0.2], rng.uniform(-2e-3, 2e-3, 5)]))
    return [[x, 12.0 * x**2] for x in X.tolist()]


def random_scene(seed, profile, methods, strokes):
    """States of a punch with free ends on an isotropic or orthotropic solid, two a stroke of two."""
    rng = np.random.default_rng(seed)
    plane = str(rng.choice(["strain", "stress"]))
    solid = {"E": 2e11, "nu": rng.uniform(0.0, 0.45), "rho": 7800, "plane": plane}
    if rng.random() < 0.4:
        solid = {
            "kind": "orthotropic", "E1": 10.0 ** rng.uniform(10.0, 11.3), "E2": 1e10, "E3": 1e10,
            "nu12": 0.25, "nu13": 0.25, "nu23": 0.3, "G12": rng.uniform(3e9, 7e9), "rho": 1600,
            "angle": rng.uniform(0.0, 180.0),
        }  # fmt: skip
    load, mu = 10.0 ** rng.uniform(4.0, 5.5), rng.uniform(0.0, 0.9, len(strokes)).tolist()
    share = rng.choice([0.0, rng.uniform(0.05, 0.9)])
    punch = {"load": load, "profile": profile} | PUNCHES[profile](np.random.default_rng(seed))

    def at(c):
        return of_sections(
            solid=solid | {"yield_strength": 3e8}, punch=punch,
            friction={"model": "coulomb", "mu_c": mu}, solve={"methods": methods},
            motion={"c": float(c), "X_over_L": [0.5], "strokes": list(strokes)},
            output={"quantities": ["sif", "surface", "yield"]},
        )  # fmt: skip

    return at(share * at(0.0).solid.limit())


def samples(rng, measure, X, Y, around, rounds=5):
    """Largest value of a measure at places, and at random ones around the best, nearer and nearer."""
    values = measure(X, Y)
    for k in range(rounds):
        best = rng.choice(np.argsort(-values)[: 60 if k == 0 else 20], around)
        size = 0.3 ** (k + 1) * np.maximum(np.hypot(np.abs(np.abs(X[best]) - 1.0), Y[best]), 1e-8)
        x, y = (at[best] + size * rng.normal(size=around) for at in (X, Y))
        y = np.where((Y[best] == 0.0) & (rng.random(around) < 0.7), 0.0, -np.abs(y))
        X, Y, values = (np.append(a, b) for a, b in ((X, x), (Y, y), (values, measure(x, y))))
    return values.max()


MEASURES = {
    "von_mises": lambda solid, *σ: von_mises(*σ, solid.σ_ZZ(*σ)),
    "max_shear": lambda solid, *σ: maximum_shear(*σ),
}


def turns_of(contact):
    """Free ends and kinks of a contact over its half-width, at which stresses are finite."""
    (group,) = contact.groups
    free = np.array([group.β[0], group.α[0]]) > 0.0
    return np.concatenate([np.array([-1.0, 1.0])[free], group.pressure.bends])


def sampled(contact, solid, rng, fine=2):
    """Largest von Mises and shear stress, highest and lowest σ_XX on the surface, largest pressure."""

    def σ(X, Y):
        return contact.stresses(X, Y)[:, 0]

    ξ = np.concatenate([[0.0], np.geomspace(1e-4, 3.0, 8 * fine)])
    η = np.unique(np.concatenate([np.linspace(-np.pi, 0.0, 25 * fine), -np.geomspace(1e-4, 0.1, 6)]))
    ξ, η = (grid.ravel() for grid in np.meshgrid(ξ, np.append(η, -np.pi - η[-8:-1])))
    z = np.cosh(ξ + 1j * η)
    beside = (ξ > 0.0) & (np.abs(z.imag) < 1e-14)
    turns = turns_of(contact)
    X, Y = np.append(z.real, turns), np.append(np.where((ξ == 0.0) | beside, 0.0, z.imag), 0.0 * turns)
    X0, none = np.append(X[Y == 0.0], np.cos(np.linspace(0.0, np.pi, 50 * fine**3 + 1))), np.zeros
    inside = X0[np.abs(X0) < 1.0]
    return np.array(
        [
            *(
                samples(rng, lambda X, Y: of(solid, *σ(X, Y)), X, Y, 125 * fine)  # noqa: B023
                for of in MEASURES.values()
            ),
            samples(rng, lambda X, Y: σ(X, 0.0 * Y)[0], X0, none(len(X0)), 125 * fine),
            -samples(rng, lambda X, Y: -σ(X, 0.0 * Y)[0], X0, none(len(X0)), 125 * fine),
            samples(rng, lambda X, Y: -σ(X, 0.0 * Y)[1], inside, none(len(inside)), 125 * fine),
        ]
    )


NAMES = ("von_mises", "max_shear", "sigma_XX_max", "sigma_XX_min", "largest_pressure")
#: Signs with which these are highest.
SIGNS = np.array([1.0, 1.0, 1.0, -1.0, 1.0])
BOTH = ["closed_form", "fem"]
STROKES = ("forward", "backward")
#: Seeds, methods and strokes; finite elements under most profiles take their time.
CASES = [
    *((seed, BOTH, STROKES[:1]) for seed in (0, 11)),
    *((seed, BOTH[:1], STROKES[:1]) for seed in (1, 2, 3)),
]
if THOROUGH:
    CASES = [(seed, BOTH, STROKES) for seed in range(50)]


@pytest.mark.parametrize("seed, methods, strokes", CASES, ids=[str(case[0]) for case in CASES])
def test_largest_values_are_those_of_samples(seed, methods, strokes):
    scene = random_scene(seed, tuple(PUNCHES)[seed % 4], methods, strokes)
    result = galinx.compute(scene)
    data, body = result.data, scene.body
    if any("kink" in text for text in data.get("run/failures", ())):
        pytest.skip("finite elements refuse a kink for being next to an end")
    response = scene.solid.response(float(data["states/c"][0]))
    allowed = NEXT_TO_CUSP if cusp(body.profile) else MISSED
    for i in range(len(data["states/g"])):
        contact = contacts(response, data["states/g"][i : i + 1], body.profile, body.compression)
        largest = sampled(contact, scene.solid, np.random.default_rng(seed), len(strokes))
        size = np.array([*largest[:2], *[np.abs(largest[2:]).max()] * 2, largest[4]])
        for method in methods:
            found = np.array([data[f"states/{method}/{name}"][i] for name in NAMES])
            missed = SIGNS * (largest - found) / size
            assert (missed <= allowed).all(), (method, missed)
            # In the plane samples may miss the top: there the largest has to be the stress at its place.
            assert (missed[2:] >= -allowed).all(), (method, missed)
            for name, value in zip(NAMES[:2], found):
                X, Y = (data[f"states/{method}/{name}_{axis}_over_a"][i : i + 1] for axis in "XY")
                # A cusp is as sharp as its place is exact: ends, and so X/a, have errors of 1e-12.
                turn = turns_of(contact)[[np.abs(turns_of(contact) - X).argmin()]]
                X = np.where((Y == 0.0) & (np.abs(turn - X) < AT_TURN), turn, X)
                there = MEASURES[name](scene.solid, *contact.stresses(X, Y)[:, 0])
                assert abs(there[0] / value - 1.0) <= allowed, (method, name)


def prescribed(rng):
    """Knots and values of a pressure, 0 at its ends or not."""
    knots = np.concatenate([[-1.0], np.sort(rng.uniform(-1.0, 1.0, rng.integers(1, 7))), [1.0]])
    values = -rng.uniform(0.0, 1.0, len(knots))
    values[[0, -1]] *= rng.integers(2)
    return knots, values


def in_plane_sampled(pressure, solid, c, g):
    """Highest and lowest σ_XX of a pressure, 0.01 a and more from where it jumps."""
    exact, knots = LoadedHalfPlane(solid.response(c), g, pressure), pressure.knots
    near = np.concatenate([sign * np.geomspace(1e-13, 1.0, 4000) for sign in (-1.0, 1.0)])
    X = np.concatenate([np.add.outer(knots, near).ravel(), knots, np.linspace(-4.0, 4.0, 10001)])
    jumps = knots[[0, -1]][pressure.values[[0, -1]] != 0.0]
    X = np.append(X, np.add.outer(jumps, [-0.01, 0.01]))
    X = X[(np.abs(X[:, None] - jumps) >= 0.01 - 1e-12).all(axis=1)]
    σ_XX = exact.σ_XX(X)
    return np.array([σ_XX.max(), σ_XX.min()])


@pytest.mark.parametrize("seed", range(60 if THOROUGH else 2))
def test_in_plane_stresses_of_a_pressure_are_largest_at_its_knots_and_beside_them(seed):
    """σ_XX has d log d at the distance d from a knot, which no polynomial through samples follows."""
    rng = np.random.default_rng(seed)
    knots, values = prescribed(rng)
    changes = {
        "solve.mode": "traction", "solve.pressure": np.column_stack([knots, values]).tolist(),
        "solve.tolerance": 1e-6, "solve.methods": BOTH, "solid.nu": float(rng.uniform(0.0, 0.45)),
        "motion.c": float(rng.uniform(0.0, 0.85)), "friction.mu_c": float(rng.uniform(0.0, 0.9)),
        "friction.sigma0_over_load": 1e7, "motion.X_over_L": 0.8, "output.quantities": ["surface"],
    }  # fmt: skip
    result = computed("traction", changes)
    for i, g in enumerate(result.data["states/g"].tolist()):
        c = float(result.data["states/c"][i])
        pressure = LinearPressure(knots, values)
        largest = in_plane_sampled(pressure, result.scene.solid, c, g)
        for method in BOTH:
            found = [result.data[f"states/{method}/sigma_XX_{end}"][i] for end in ("max", "min")]
            np.testing.assert_allclose(found, largest, rtol=0.0, atol=2e-6 * np.abs(largest).max())


@pytest.mark.parametrize(
    "layered, seed",
    product((True, False), range(12)) if THOROUGH else [(True, 0), (False, 0), (False, 1)],
)
def test_stresses_by_the_integral_equation_are_largest_where_samples_are(layered, seed, monkeypatch):
    """Between a kink of the punch and a free end a hundredth of the contact away, as everywhere."""
    rng = np.random.default_rng(seed)
    layer = [{"E": 4e11, "nu": 0.2, "rho": 5000, "thickness": 3e-4}] if layered else None
    rounded = {"profile": "rounded_flat", "flat_half_width": 1e-3, "radius": 0.02}
    punch = rng.choice([rounded, {"profile": "table", "shape": table(rng)}], p=[0.7, 0.3])
    scene = of_sections(
        solid={"material": "steel"}, layer=layer, punch=punch | {"load": 10.0 ** rng.uniform(2.5, 4.0)},
        friction={"mu": rng.uniform(0.2, 0.9)}, solve={"methods": ["sie"]},
        motion={"speed": rng.uniform(100.0, 2500.0), "strokes": [("forward", "backward")[seed % 2]]},
        output={"quantities": ["sif", "surface"]},
    )  # fmt: skip
    found = galinx.compute(scene).data
    near = np.logspace(-6.0, 0.0, 1500)
    X = np.unique(np.concatenate([near - 1.0, 1.0 - near]))
    monkeypatch.setattr("galinx.app.plan.plan.surface_grid", lambda *_, **kinks: X)
    sampled = galinx.compute(scene).data["surface/sie/sigma_XX"]
    size = np.abs(sampled).max()
    for name, sign in (("sigma_XX_min", -1.0), ("sigma_XX_max", 1.0)):
        missed = (sign * sampled).max(axis=1) - sign * found[f"states/sie/{name}"]
        assert missed.max() <= MISSED * size, name


#: A thin film under a punch, whose stresses vary within its thickness at edges and kinks alone.
FILM = """
[solid]
material = "bearing-steel"
[[layer]]
material = "TiN"
thickness = "2 um"
[punch]
profile = "parabolic"
radius = "10 mm"
load = "50 N/mm"
[friction]
mu = 0.3
[motion]
c = 0.0
[solve]
methods = ["sie"]
tolerance = 1e-3
[output]
quantities = ["interfaces"]
"""
WEDGE = FILM.replace('"parabolic"', '"wedge"').replace('radius = "10 mm"', "slope = 0.01")


@pytest.mark.parametrize(
    "text",
    [
        FILM.replace('load = "50 N/mm"', 'load = ["1 N/mm", "50 N/mm"]'),
        FILM.replace("c = 0.0", "c = 0.5"),
        WEDGE,
    ],
    ids=["two loads", "fast", "wedge"],
)  # fmt: skip
def test_stresses_along_a_thin_film_are_largest_where_close_positions_say(text, monkeypatch):
    """Positions were as fine as the least load wants them, and coarse at kinks."""
    data = computed(text).data
    near = np.add.outer([-1.0, 0.0, 1.0], np.linspace(-0.1, 0.1, 201))
    close = np.union1d(data["interfaces/X_over_a"], [*near.flat, *np.linspace(-1.1, 1.1, 601)])
    monkeypatch.setattr("galinx.app.plan.variants.positions", lambda scenes: (surface_grid(), close))
    finer = computed(text).data
    for name in ("sigma_YY", "sigma_XY", "sigma_XX_above", "sigma_XX_below"):
        curve = finer[f"interfaces/sie/{name}"][-1, 0]
        for end, value in (("max", curve.max()), ("min", curve.min())):
            largest = data[f"interfaces/sie/{name}_{end}"][-1, 0]
            assert largest == pytest.approx(value, abs=2e-4 * np.abs(curve).max())


def test_a_loose_tolerance_has_the_stresses_along_a_film_that_changes_little():
    """The pressure needs so few unknowns that their points were further apart than the film is thick."""
    film = FILM.replace('material = "TiN"', "E = 215e9\nnu = 0.3\nrho = 7800").replace("2 um", "0.5 um")
    film = film.replace('"interfaces"', '"surface"')
    loose, tight = (computed(film.replace("1e-3", tolerance)) for tolerance in ("1e-2", "1e-5"))
    assert loose.verdict == "PASS"
    for name in ("sigma_XX_min", "sigma_XX_max"):
        one, other = (result.data[f"states/sie/{name}"][0] for result in (loose, tight))
        assert one == pytest.approx(other, rel=1e-3)


@pytest.mark.parametrize("mu", [0.0, 0.34])
def test_next_to_a_tip_stresses_count_from_a_distance_on_which_is_no_position_of_the_surface(mu):
    """There they are lowest: without friction σ_XX = σ_YY = -(2/π) arccosh(1/0.02)."""
    data = galinx.compute(of_sections(
        solid={"material": "steel"}, punch={"profile": "wedge", "slope": 0.01, "load": 5e4},
        friction={"mu": mu}, motion={"c": 0.6 if mu else 0.0}, output={"quantities": ["surface"]},
        solve={"methods": BOTH},
    )).data  # fmt: skip
    for method in BOTH:
        X, centre, a = (
            data[f"states/{method}/{name}"][0]
            for name in ("sigma_XX_min_X_over_a", "centre", "half_width")
        )
        assert abs(X + centre / a) == pytest.approx(0.02, rel=1e-6)
        if not mu:
            lowest = data[f"states/{method}/sigma_XX_min"][0]
            assert lowest == pytest.approx(-2.0 / np.pi * np.arccosh(50.0), rel=1e-6)


@pytest.mark.parametrize("method", ["sie", "fem"])
def test_a_stiff_plate_is_stretched_most_far_beside_the_contact(method, monkeypatch):
    """Alumina on acrylic glass bends: tension and lift were sought within five half-widths only."""
    scene = (
        """
        [solid]
        material = "PMMA"
        [[layer]]
        material = "Al2O3"
        thickness = "0.5 mm"
        [punch]
        profile = "parabolic"
        radius = "50 mm"
        load = "100 N/mm"
        [friction]
        mu = 0.02
        [motion]
        c = 0.0
        [output]
        quantities = ["surface", "interfaces"]
        [solve]
        tolerance = 1e-3
        """
        + f'methods = ["{method}"]'
    )
    data = computed(scene).data
    X = np.union1d(surface_grid(), np.linspace(-60.05, 60.05, 1201))
    monkeypatch.setattr("galinx.app.plan.variants.positions", lambda scenes: (X, X))
    sampled = computed(scene).data
    size = np.abs(sampled[f"surface/{method}/sigma_XX"]).max()
    highest = sampled[f"surface/{method}/sigma_XX"].max()
    assert highest > 0.05 * size
    assert data[f"states/{method}/sigma_XX_max"][0] == pytest.approx(highest, abs=1e-5 * size)
    lift = sampled[f"interfaces/{method}/sigma_YY"].max()
    assert data[f"interfaces/{method}/sigma_YY_max"][0, 0] == pytest.approx(lift, rel=2e-3)


def test_low_friction_stretches_an_interface_many_depths_away(monkeypatch):
    """The tension that friction makes falls like 1/X, the compression under the load faster."""
    scene = of_sections(
        solid={"material": "steel"},
        layer=[{"thickness": 5e-5, "E": 3e12, "nu": 0.2, "rho": 5000.0}],
        punch={"profile": "parabolic", "radius": 0.02, "load": 1e5},
        friction={"model": "coulomb", "mu_c": 0.2}, motion={"c": 0.0},
        solve={"methods": ["sie"], "tolerance": 1e-5}, output={"quantities": ["interfaces"]},
    )  # fmt: skip
    data = galinx.compute(scene).data
    X = np.union1d(np.linspace(-2.0, 2.0, 401), np.linspace(-300.0, 300.0, 6001))
    monkeypatch.setattr("galinx.app.plan.variants.positions", lambda scenes: (surface_grid(), X))
    σ = galinx.compute(scene).data["interfaces/sie/sigma_XX_below"][0, 0]
    assert data["interfaces/sie/sigma_XX_below_max"][0, 0] == pytest.approx(σ.max(), rel=1e-5)
    assert X[σ.argmax()] < -45.0


def test_the_surface_of_a_layer_yields_beside_a_kink_as_that_of_the_same_solid_without():
    solid = {"E": 1e9, "nu": 0.3, "rho": 1000.0, "yield_strength": 1e7}
    blunt_wedge = [[-1e-2, 1e-4], [-2e-4, 1e-6], [0.0, 0.0], [2e-4, 1e-6], [1e-2, 1e-4]]
    asked = {
        "solid": solid, "friction": {"model": "coulomb", "mu_c": 0.6}, "motion": {"c": 0.0},
        "punch": {"profile": "table", "shape": blunt_wedge, "load": 8e3},
        "output": {"quantities": ["yield"]},
    }  # fmt: skip
    layer, by = [solid | {"thickness": 3e-3}], {"tolerance": 1e-2}
    layered = galinx.compute(of_sections(**asked, layer=layer, solve=by | {"methods": ["sie"]})).data
    uniform = galinx.compute(of_sections(**asked, solve=by | {"methods": ["closed_form"]})).data
    for name, allowed in (("von_mises", {"rel": 1e-6}), ("von_mises_X_over_a", {"abs": 1e-5})):
        of_layer = layered[f"states/sie/{name}"][0]
        assert of_layer == pytest.approx(uniform[f"states/closed_form/{name}"][0], **allowed)


@pytest.mark.parametrize("profile", ["flat", "parabolic"])
def test_the_largest_tension_at_a_step_of_friction_is_between_its_places(profile, monkeypatch):
    step = [[-1.0, 0.1], [0.33, 0.1], [0.34, 0.9], [1.0, 0.9]]
    punch = {"half_width": 1e-4} if profile == "flat" else {"profile": profile, "radius": 5e-3}
    scene = of_sections(
        solid={"material": "steel"}, punch=punch | {"load": 5e4}, friction={"along": step},
        motion={"c": 0.3}, output={"quantities": ["surface"]}, solve={"tolerance": 1e-4},
    )  # fmt: skip
    scene = replace(scene, solve=replace(scene.solve, methods=("closed_form", "sie")))
    data = galinx.compute(scene).data
    method = "closed_form" if profile == "flat" else "sie"
    X = np.union1d(np.linspace(0.32, 0.35, 3001), surface_grid())
    monkeypatch.setattr("galinx.app.plan.variants.positions", lambda scenes: (X, np.empty(0)))
    sampled = galinx.compute(scene).data[f"surface/{method}/sigma_XX"]
    highest = sampled[0, (np.abs(X) < 0.99) | (np.abs(X) > 1.01)].max()
    assert data[f"states/{method}/sigma_XX_max"][0] == pytest.approx(highest, rel=1e-3)
    assert abs(data[f"states/{method}/sigma_XX_max_X_over_a"][0] - 0.335) < 6e-3


def test_the_largest_tension_at_a_free_end_is_in_the_estimate():
    """It is a limit, which no place beside it shows; finite elements alone, at a loose tolerance."""
    solid = {"kind": "anisotropic", "rho": 2290.2283, "stiffness": [
        1e9, 209278208.51, 247977450.06, 880086620.03, -297495879.83, 465030864.38,
    ]}  # fmt: skip
    scene = {"solid": solid, "punch": {"profile": "parabolic", "radius": 0.02, "load": 1e5}}
    scene |= {"friction": {"mu": 0.3}, "motion": {"c": 0.5327}, "output": {"quantities": ["surface"]}}
    fem, exact = (
        computed(changes=scene | {"solve": {"methods": [method], "tolerance": 1e-3}}).data[
            f"states/{method}/sigma_XX_max"
        ]
        for method in ("fem", "closed_form")
    )
    np.testing.assert_allclose(fem, exact, rtol=1e-3)


CYLINDER, FLAT = {"profile": "parabolic", "radius": 1.0, "load": 3e5}, {"half_width": 1e-3, "load": 1e6}
QUARTIC = {"profile": "power", "exponent": 4, "coefficient": 2.26e6, "load": 3e5}


@pytest.mark.parametrize("nu, c, mu, punch, tolerance", [
    (-0.7364, 0.716682, 0.579, CYLINDER, 1e-3),
    (-0.9152, 0.70063, 0.458, CYLINDER, 1e-2),
    (-0.8242, 0.711974, 0.825, FLAT, 1e-3),
    (0.4976, 0.938136, 0.284, QUARTIC, 1e-3),
])  # fmt: skip
def test_near_the_speed_limit_loose_tolerances_are_met_as_tight_ones_are(nu, c, mu, punch, tolerance):
    """There fields are larger than stresses, and go with a small power of the distance from an end."""
    scene = {"solid": {"E": 2e11, "nu": nu, "rho": 8000.0}, "punch": punch, "friction": {"mu": mu}}
    scene |= {"motion": {"c": c}, "output": {"quantities": ["sif", "surface"]}}
    result = computed(changes=scene | {"solve": {"methods": BOTH, "tolerance": tolerance}})
    assert result.verdict == "PASS"
    assert result.comparisons["highest and lowest σ_XX, over the larger of them"] <= tolerance
