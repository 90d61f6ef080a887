"""A scene that has no answer is refused before anything is computed, in words that say what to write."""

import re

import numpy as np
import pytest
from support import scene_of

from galinx.app.errors import BadInput
from galinx.app.plan.variants import make_plans

CLOSED, SIE, FEM = ({"solve.methods": [method]} for method in ("closed_form", "sie", "fem"))
_APART = {"friction.sigma0_over_load": None, "friction.sigma0": "1.5922 N/µm/mm"}
_SPEED = {"motion.c": None, "motion.speed": "1 m/s"}
_TRACTION = {"solve.mode": "traction"}
_HUMP = [[-1, -1], [0, -1], [0.05, -4], [0.1, -1], [1, -1]]
_LAW = {"time.friction": "law"}
_POINT = {"output.quantities": ["interior"], "output.points": [[0.0, -0.5]]}
_MANY = {"from": 1, "to": 2, "number": 500}
_LONG = {"from": 0.01, "to": 0.9, "number": 1000}
_PRODUCT = ("friction.mu_c", "friction.delta", "motion.X_over_L", "motion.c")
_RATE = {"model": "rate_and_state", "reference_friction": 0.6, "reference_speed": 1e-6, "a": 0.01,
         "b": 0.015, "critical_slip": 1e-7}  # fmt: skip
_NO_WIDTH = {"punch.half_width": None}
_WEDGE = _NO_WIDTH | {"punch.profile": "wedge", "punch.slope": 0.005}
_PARABOLA = _NO_WIDTH | {"punch.profile": "parabolic", "punch.radius": "20 mm"}
_TABLE = [[-1e-3, 1e-6], [0.0, 0.0], [1e-3, 2e-6], [2e-3, 1e-6], [3e-3, 9e-6]]
_TABULATED = {"along": [[-1, 0.2], [1, 0.5]]}
#: Friction along the contact, in the section of a scene that has no other.
_ALONG = {"friction": _TABULATED, "motion.strokes": None, "motion.X_over_L": None, "motion.c": 0.3}
_DAHL = {"state": "advected", "model": "dahl", "mu_c": 0.5, "sigma0_over_load": 1e4}
_COULOMB = {"friction": {"model": "coulomb", "mu_c": 0.4}, "motion.c": None, "motion.speed": 1}
_PATH = _COULOMB | {"motion.speed": None, "motion.strokes": None, "motion.X_over_L": None}
_SLIDER = {"mass": 2, "stiffness": "8 N/m^2", "drive_speed": "0.1 m/s", "duration": "20 s"}
_SLIDES = {"slider": _SLIDER, "output.quantities": ["friction", "slider"]}
_ROWS = [{"properties": [[0, "7.5 GPa", 0.3, 1200], ["1 mm", "2.5 GPa", 0.25, 1000]]}]
_ELASTIC = {"punch.solid": {"E": 3e9, "nu": 0.38, "rho": 1200}}
_FIBRES = {
    "solid": {"kind": "anisotropic", "rho": 1500, "stiffness": ["10 GPa", 3e9, 1e9, "5 GPa", 0, "2 GPa"]},
}
_SKEW = {
    "solid": {"kind": "orthotropic", "E1": 14e9, "E2": 1e9, "E3": 1e9, "nu12": 0.3, "nu13": 0.3,
              "nu23": 0.4, "G12": 0.5e9, "rho": 1500.0, "angle": 45.0},
}  # fmt: skip


def _strokes(*strokes, **more):
    return _COULOMB | {"motion.strokes": list(strokes)} | {f"motion.{k}": v for k, v in more.items()}


#: By the template: what is changed, and what is said, with … for what stands between.
FAULTS = {
    "tables4_5": [
        ({"solid.nu": None, "solid.nuu": 0.25}, "did you mean nu"),
        ({"punch.load": "100 N"}, "(a force), expected a force per depth, such as 100 N/mm"),
        ({"solid.poissons_ratio": 0.3}, "no such key; did you mean nu (Poisson's ratio)?"),
        (_SPEED | {"motion.speed": -1}, 'found -1, expected >= 0; …motion.strokes = ["backward"]'),
        ({"motion.velocity": 1.0}, "no such key; did you mean speed (velocity V)?"),
        ({"solid.E": "210 Gpa"}, "unknown unit 'Gpa' (did you mean GPa?), expected"),
        (_SPEED | {"motion.speed": 1, "solid.E": 210}, "expected less…solid.E = 210 Pa is unusual"),
        ({"sloid.nu": 0.25}, "did you mean solid"),
        ({"solid.nu": None}, "solid.nu: missing"),
        ({"solid.material": "STEEL"}, "has 1 fault:…found 'STEEL', …; did you mean steel?"),
        ({"solid.material": "gold"}, "has 1 fault:…rubber or PTFE"),
        ({"friction.model": "amontons"}, "dahl"),
        ({"friction.model": "stribeck"}, "mu_s: missing"),
        ({"friction.sigma0": 1e9}, "has 1 fault…sigma0 and sigma0_over_load exclude each other"),
        (_APART | {"punch.load": [1e3, 2e3]}, "has 1 fault…found 2 loads, expected one punch.load"),
        (_APART | {"friction.sigma0": "5 kg"}, "has 1 fault…(a mass), expected"),
        (_APART | {"punch.load": "1 m"}, "has 1 fault…punch.load"),
        (_APART | {"friction.model": "coulomb"}, "friction.sigma0: no such key"),
        ({"friction.vary": [{"mu": 0.3}]}, "found the key 'mu' in table 1; did you mean mu_c?"),
        ({"friction.vary": [{}, {"sign": "eq25"}]}, "'sign' in table 2; valid: mu_c"),
        ({"friction.vary": [{"mu_c": [0.1, -3]}]}, "in table 1, mu_c: found -3, expected > 0"),
        ({"friction.vary": [{"mu_c": []}]}, "in table 1, mu_c: found an empty list"),
        ({"friction": {"model": "maxwell_slip", "elements": [[1e4, 0.1]],
                       "vary": [{"elements": [[1e3, 0.2]]}]}},
         "friction.vary…found tables: 1, expected none: the law's own parameters are lists"),
        ({"friction.vary": 3}, "found 3, expected tables [[friction.vary]]"),
        ({"friction.vary": [{"mu_c": _MANY, "delta": _MANY}]},
         "vary: found 250000 laws, expected at most 100000"),
        ({"friction.mu_c": 0.1, "friction.sigma0_over_load": 6e4, "friction.integrator": "rk4"}, "exact"),
        ({"friction.delta": 0.5, "friction.integrator": "rk4"}, "no limit of stable steps"),
        ({"friction": {"model": "stribeck", "mu_c": 0.1, "mu_s": 0.2, "stribeck_velocity": 1.0,
                       "integrator": "rk4"}}, "known for Stribeck's curve"),
        ({"friction": {"model": "maxwell_slip", "elements": [[1e4, 0.0], [1e4, 0.5]]}},
         "elements = [[10000.0, 0.0], [10000.0, 0.5]]"),
        ({"output.quantities": ["interior"], "output.points": [[1.0, -1e-170]]},
         "found Y/a = -1e-170, expected Y/a < 0, by 1e-12 at least"),
        (CLOSED | dict.fromkeys(_PRODUCT, _LONG), "3e+12 states…shorten"),
        ({"friction": _RATE, "motion.c": 0}, "friction: found the speed 0 m/s"),
        ({"friction": {"model": "table", "shape": [[1e-6, 0.1], [2e-6, 0.2]]}},
         "friction: shape: found the slips"),
        ({"motion.c": 0.95}, "Rayleigh speed c_R = 0.919402"),
        ({"motion.speed": "1 m/s"}, "exclude each other"),
        ({"motion.c": None}, "motion: expected c"),
        (_SPEED | {"motion.speed": ["4 km/s", "5 km/s"]},
         "motion.speed = 4000, 5000 m/s: expected less than the Rayleigh speed 2881.39 m/s (by"),
        (_SPEED | {"motion.speed": "4 km/s"} | CLOSED,
         "motion.speed = 4000 m/s: expected less than the shear wave speed 3133.99 m/s"),
        (_SPEED | {"motion.speed": "3.1 km/s"}, "c_R = 0.919402 (over c_s), 2881.39 m/s"),
        (_SPEED | {"motion.strokes": [{"to": 0.8}, {"to": 0.2, "speed": "2950 m/s"}]}, "Rayleigh speed"),
        (_SPEED | {"motion.strokes": [{"to": 0.8}, {"to": 0.2, "speed": "4 km/s"}]}, "shear wave speed"),
        ({"motion.strokes": ["foward"]}, "did you mean forward?"),
        (_strokes({"to": 0}), "stroke 1 goes to 0 L, where it begins"),
        (_strokes({"to": 1.5}), "in a stroke, to: found 1.5"),
        (_strokes({"two": 1}), "found the key 'two' in a stroke"),
        (_strokes({"speed": 1}), "found a stroke without to"),
        (_strokes({"to": 0.1}, X_over_L=0.5), "no position that a stroke passes"),
        (_strokes({"to": 1, "speed": 1e9}), "found a stroke at 1e"),
        (_PATH | {"motion.path": [[0, 0], [1, 1e-5]], "motion.speed": 1}, "path gives the speed"),
        (_PATH | {"motion.path": [[0, 0], [0, 1e-5]]}, "times that do not grow"),
        (_PATH | {"motion.path": [[0, 0], [1, 1e-3]]}, "the position 0.001 m, expected 0 to"),
        (_PATH | {"motion.path": [[0, 0], [1, 0]]}, "found one position in all rows"),
        (_PATH | {"motion.path": [[0, 0]]}, "expected at least 2 rows"),
        (_PATH | {"motion.path": [[0, 0], [1, 1e-4]], "motion.strokes": ["backward"], "motion.rest": 9},
         "path gives strokes, positions and rests; take strokes and rest away"),
        (_PATH | {"motion.path": [[0, 0, 1], [1, 1, 1]]}, "rows of 2 numbers"),
        (_SLIDES | {"slider": None}, "go together"),
        (_SLIDES | {"output.quantities": ["friction"]}, "go together"),
        (
            _SLIDES | {"slider": {"mass": 1, "stiffness": 1}},
            "slider.drive_speed: missing…slider.duration: missing",
        ),
        ({"solve.methods": ["fme"]}, "expected closed_form, sie or fem; did you mean fem?"),
        ({"solve.methods": []}, "solve.methods is empty"),
        ({"solve.cuts": 4}, "found 4 without solve.degree"),
        ({"solve.degree": 2, "solve.cuts": 4} | _TRACTION, "contact"),
        ({"solve.degree": 2, "solve.cuts": 4, "solid.nu": 0.5}, "two degrees less"),
        ({"solve.solver": "gamg", "solid.nu": 0.5}, "indefinite"),
        ({"solve.pressure": [[-1, -1], [1, -1]]}, "traction"),
        (_TRACTION | {"solve.pressure": [[-1, -1], [1, -1]], "solve.methods": ["sie"]}, "knows the"),
        (_TRACTION | {"solve.pressure": [[-1, -1], [0.5, -1]]}, "X/a = 1"),
        ({"output.quantities": ["interfaces"]} | CLOSED, "expected [[layer]]"),
        ({"output.quantities": ["yield"]}, '"yield": expected solid.yield_strength'),
        ({"output.quantities": ["yield"], "solid.material": "BK7"}, "expected solid.yield_strength"),
        (_POINT | FEM | {"solid.nu": 0.5}, "expected ν <= 0.49"),
        (_POINT | {"solid.nu": [0.3, 0.5]}, "of another kind"),
        (FEM | {"solid.material": "T302", "solid.nu": 0.5, "output.quantities": ["sif", "yield"]},
         "output.quantities: found …expected ν <= 0.49"),
        (_POINT | {"output.points": [[0.0, -90.0]], "solve.mesh": "box"},
         "coordinate of 90 a, expected at most 60 a with the box mesh"),
        (CLOSED | {"solve.mesh": "box"}, "whose walls finite elements alone have…or add fem to"),
        (_WEDGE | {"solve.mesh": "box"}, "whose walls finite elements alone have…meshes of its own"),
        (_WEDGE | FEM | {"solve.degree": 6}, 'fem: …mesh = "confocal", and no degree'),
        (_PARABOLA | _TRACTION, "whose contact ends where the pressure says"),
        (_NO_WIDTH | {"punch.profile": "table", "punch.shape": _TABLE},
         "not convex at X = 0.001 m…two contacts"),
        (_ALONG | {"friction": _TABULATED | {"mu": 0.3}}, "take mu away"),
        (_ALONG | {"friction": {"along": [[-0.9, 0.2], [1, 0.5]]}}, "from X/a = -1 to X/a = 1"),
        (_ALONG | {"friction": {"along": [[-1, -0.2], [1, 0.5]]}}, "none below 0"),
        (_ALONG | {"friction": {"along": [[-1, 0], [1, 0]]}}, "not all 0"),
        (_ALONG | FEM | {"friction": {"along": [[-1, 0.2], [0, 0.3], [0.0005, 0.3], [1, 0.5]]}},
         "0.001 of another; closed_form takes it"),
        (_ALONG | {"friction": {"model": "table", "shape": [[0, -0.4], [1, 0.4]], "state": "advected"}},
         "f = -0.4, which drives the slip"),
        (_ALONG | {"time": {"end": 3}, "output.quantities": ["time"]}, "in time"),
        (_ALONG | {"friction": _DAHL, "motion.strokes": ["forward", "backward"]}, "strokes"),
        (_ALONG | {"friction": _DAHL, "solve.mesh": "box"}, 'mesh = "box"'),
        (_ALONG | {"friction": _DAHL | {"integrator": "rk4"}}, "integrator with an advected state"),
        (_ELASTIC | _PARABOLA | {"punch.solid": {"E": 3e9, "nu": 0.38, "rho": 1200, "speed": 2000.0}},
         "expected less than 894.03"),
        (_ELASTIC | {"punch.solid": {"E": 3e9, "nu": 0.38, "rho": 1200, "plane": "stress"}},
         "punch.solid.plane"),
        (_ELASTIC | {"layer": [{"thickness": 1e-3, "material": "TiN"}]}, "layer"),
        (_ELASTIC | _TRACTION | FEM, "solve.mode"),
        (_ALONG | {"punch.solid": {"material": "steel", "speed": "10 m/s"}, "friction": _DAHL},
         "bristles that a rolling punch carries along, too"),
        ({"punch.solid": {"nu": 0.38, "rho": 1200}}, "punch.solid.E: missing"),
        (_ELASTIC | {"motion.c": 0.95}, "along the plate's surface"),
        (_FIBRES | CLOSED | {"solid": _FIBRES["solid"] | {"yield_strength": "100 MPa"},
                    "output.quantities": ["yield"]}, "stiffness_Z"),
        (_SKEW | CLOSED | {"motion.c": 0.999}, "nothing decays with depth"),
        (_PARABOLA | CLOSED | {"motion.c": 0.95}, "nothing holds the punch up there; take lower speeds"),
        (_SKEW | {"motion.c": 0.4276}, "m/s: the finite element form is indefinite"),
    ],
    "traction": [
        ({"solve.pressure": _HUMP, "solve.mesh": mesh},
         f'solve.mesh: found "{mesh}"…expected "confocal" or "graded"') for mesh in ("box", "uniform")
    ] + [
        ({"solve.pressure": _HUMP, "solve.mesh": "graded", "solid.nu": 0.5},
         "ν = 0.5…expected …confocal… or ν <= 0.49"),
        ({"solve.pressure": _HUMP, "solve.solver": "gamg"}, "where one factorisation solves all"),
        ({"solve.pressure": [[-1, -1], [0, -1], [1e-10, -2], [1, 0]]}, "differ by 1e-10, expected at"),
        ({"solve.pressure": [[-1, 0], [0.5, 0], [1, 0]]}, "found no pressure but 0"),
    ],
    "coating": [
        ({"layer[0].nu": 0.6}, "1 fault:…layer[0].nu (Poisson's ratio): found 0.6"),
        ({"layer[0].thickness": None}, "1 fault:…layer[0]: missing thickness"),
        ({"solid.plane": "stress"}, '1 fault:…layer[0].plane: found "strain", expected that of [solid]'),
        ({"layer[0].grading": "power"}, "1 fault:…grading and exponent need to"),
        ({"layer[0].to": {}}, "1 fault:…expected constants"),
        ({"layer[0].to": {"E": -1}}, "1 fault:…layer[0].to.E (Young's modulus): found -1"),
        ({"layer[0].to": {"plane": "stress"}}, "1 fault:…the same plane"),
        ({"layer[0].thick": 1}, "1 fault:…layer[0].thick: no such key"),
        ({"output.quantities": ["interior"], "output.points": [[0.3, -1e-5]], "solve.methods": ["sie"]},
         "a point 1e-05 a below the surface of layers, expected at least 0.0001 a"),
        ({"layer[0].material": "unobtainium"}, "1 fault:…layer[0].material"),
        ({"layer": [{"thickness": 1e-3, "material": "TiN"}] * 11},
         "1 fault:…found 11 layers, expected at most 10"),
        ({"layer": 3}, "1 fault:…layer: found 3, expected tables [[layer]]"),
        ({"layer": [{"properties": [[0, 1, 0.3, 1]]}]}, "1 fault:…at least 2 rows"),
        ({"layer": [{"properties": [[0, 1, 0.3, 1]] * 2}]}, "1 fault:…depths rising from 0"),
        ({"layer": [_ROWS[0] | {"thickness": 1}]}, "1 fault:…properties gives thickness, too"),
        (CLOSED, "none of them solves this contact: closed_form: the solid has layers"),
        (_TRACTION, 'layer: …solve.mode is "traction"'),
        (FEM | {"solve.degree": 5},
         "layer: …solve.degree is 5, but layers have meshes and degrees of their own"),
        ({"solve.methods": ["sie", "fem"], "solve.mesh": "graded"},
         'layer: …solve.mesh is "graded", but layers have'),
        ({"motion.speed": "947.2 m/s"}, "speed limit of the layers …919.402 m/s"),
        ({"punch.tilt": "0.01 deg"}, 'punch: missing load, as in load = "100 N/mm"'),
        ({"solve.methods": ["sie", "fem"], "solve.mode": "traction",
          "solve.pressure": np.column_stack([np.linspace(-1.0, 1.0, 40), -np.ones(40)]).tolist()},
         "expected at most 12, 0.02 apart"),
        ({"output.quantities": ["sif", "yield"], "solid.yield_strength": 6e8},
         "two free ends and no tip"),
    ],
    "cylinder": [
        ({"punch.profile": ["flat", "parabolic"]}, "expected flat, parabolic"),
        ({"solid.E": []}, "found an empty list"),
        ({"solid.nu": [0.2, 0.7]}, "solid.nu (Poisson's ratio): found 0.7"),
        ({"layer.thickness": 1e-6}, "the scene has no layer…write a table [[layer]]"),
    ],
    "start_from_rest": [
        ({"solve.tolerance": 1e-7}, "found 1e-07, expected 1e-05 to 0.01"),
        (CLOSED, "neither fem nor sie"),
        ({"motion.c": 0.95}, "is not below the Rayleigh speed"),
        ({"friction.mu_c": [0.4, 1.2]}, "reaches 1.2 at c = 0.6 (over c_s), and from 1 on"),
        ({"time.end": 200.0, "solve.tolerance": 1e-5}, "unknowns"),
        ({"solid.nu": 0.495}, "ν is not near 1/2"),
        ({"friction.mu_c": [0.01 * i for i in range(1, 30)]}, "expected at most 24"),
        ({"output.quantities": ["friction"]}, "go together"),
        ({"time.step": "coarse"}, "time.step"),
        ({"punch.tilt": 0.1}, "tilted by 0.1° counterclockwise; a start from rest is computed for level"),
        ({"solve.assembler": "dolfinx"}, 'time: found solve.assembler = "dolfinx", but motions in time'),
        ({"solve.degree": 4, "solve.mesh": "box", "output.quantities": ["time"]},
         'time: found solve.mesh = "box" and solve.degree = 4, but motions in time have meshes'),
        ({"time.load": [[0.0, 0.5], [1.0, 1.0]]}, "expected 0 where it starts at rest"),
        ({"time.load": [[0.0, 0.0], [1.0, -1.0]]}, "the punch stays down"),
        ({"time.load": [[0.0, 0.0]]}, "found one time, expected a later one"),
        ({"time.start": "steady", "time.load_ramp": 2.0}, "where the load is on from t = 0"),
        ({"time.load": [[1.0, 0.0], [0.5, 1.0]]}, "expected 0 first, then ever later ones"),
        (_LAW, "the strokes are over at"),
        ({"time.every": 20.0}, "expected at least 0.025 and at most end = 10"),
        (_LAW | {"motion.c": [0.1, 0.2]}, "found 2 speeds"),
        (_LAW | {"motion.rest": 1.0, "motion.strokes": ["forward", "backward"]}, "a rest of their own"),
        (_LAW | SIE | {"friction.pre_sliding": "2 mm", "punch.half_width": "1 mm", "time.end": 4.0,
                       "motion.strokes": ["forward", "backward"]},
         "the punch turns round at 3.33333 a/c_s"),
    ],
}  # fmt: skip
#: A coating that starts from rest.
_COATED = {
    "time": {"end": 2.0, "load_ramp": 2.0}, "motion.speed": None, "motion.c": 0.3, "friction.mu_c": 0.4,
    "solve.methods": ["sie", "fem"], "solve.tolerance": 1e-2, "output.quantities": ["friction", "time"],
}  # fmt: skip
FAULTS["coating"] += [
    (_COATED | {"time": {"end": 2.0, "start": "steady"}}, 'found "steady" over layers, expected "rest"'),
    (_COATED | {"punch.half_width": "20 mm"}, "found a thickness of 0.05 a, expected at least 0.1 a"),
]
CASES = [(name, *fault) for name, faults in FAULTS.items() for fault in faults]


@pytest.mark.parametrize("name, changes, message", CASES, ids=[case[-1][:40] for case in CASES])
def test_each_fault_has_its_message(name, changes, message):
    expected = ".*".join(map(re.escape, message.split("…")))
    with pytest.raises(BadInput, match=re.compile(expected, re.DOTALL)):
        make_plans(scene_of(name, changes))
