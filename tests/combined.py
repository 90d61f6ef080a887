"""Small scenes of every kind: what the registries hold, combined, mirrored and in other units.

A kind of solid or of profile that is registered and has no sample here fails ``test_matrix.py``, so that
none is left out. A sample is written in SI, as a scene has it.
"""

import itertools
import json
import re
from dataclasses import dataclass, replace

import numpy as np
from support import THOROUGH

from galinx.postprocess.quantities import WORDS, declared
from galinx.postprocess.quantities.over_time import TIME
from galinx.postprocess.quantities.quantity import FRICTION_ALONE, TEXT
from galinx.postprocess.quantities.runs import SLIDER
from galinx.solvers.contact import AT_INTERFACES, BELOW, YIELD
from galinx.solvers.parameters import parameters
from galinx.solvers.profiles import PROFILES
from galinx.solvers.solids import SOLIDS

#: Solids by name, as in a scene's [solid]: at least one of every registered kind.
SOLID = {
    "isotropic": {"kind": "isotropic", "E": 1e9, "nu": 0.3, "rho": 1000.0},
    "sheet": {"kind": "isotropic", "E": 1e9, "nu": 0.25, "rho": 1000.0, "plane": "stress"},
    "nearly incompressible": {"kind": "isotropic", "E": 1e9, "nu": 0.4999, "rho": 1000.0},
    "orthotropic": {
        "kind": "orthotropic", "E1": 3e9, "E2": 0.8e9, "E3": 1e9, "nu12": 0.3, "nu13": 0.3, "nu23": 0.35,
        "G12": 0.4e9, "rho": 1000.0, "angle": 30.0,
    },
    "upright fibres": {
        "kind": "orthotropic", "E1": 9e9, "E2": 0.9e9, "E3": 0.9e9, "nu12": 0.3, "nu13": 0.3,
        "nu23": 0.4, "G12": 0.45e9, "rho": 1000.0, "angle": 90.0,
    },
    "cubic": {"kind": "cubic", "c11": 1.66e9, "c12": 0.64e9, "c44": 0.8e9, "rho": 1000.0, "angle": 25.0},
    "anisotropic": {
        "kind": "anisotropic", "stiffness": [2e9, 0.6e9, 0.4e9, 1.2e9, 0.2e9, 0.5e9], "rho": 1000.0,
        "stiffness_Z": [0.5e9, 0.4e9, 0.1e9],
    },
}  # fmt: skip

#: Layers by name, from the top down, over the first solid; every registered kind is one, too.
LAYERS = {
    "graded": [
        {"kind": "isotropic", "thickness": 0.8e-3, "E": 2e9, "nu": 0.3, "rho": 1100.0,
         "to": {"E": 1e9, "nu": 0.3, "rho": 1000.0}}
    ],
    "two layers": [
        {"kind": "isotropic", "thickness": 0.5e-3, "E": 2e9, "nu": 0.25, "rho": 1300.0},
        {"kind": "isotropic", "thickness": 1e-3, "E": 0.7e9, "nu": 0.35, "rho": 900.0},
    ],
} | {
    # All but the sheet: one solid cannot be in plane stress, the other in plane strain. In an order by
    # which the cubic punch, which takes longest of all, does not meet the stiffest fibres.
    f"{name} layer": [{"thickness": 0.9e-3} | SOLID[name]]
    for name in (
        "isotropic", "nearly incompressible", "orthotropic", "cubic", "upright fibres", "anisotropic",
    )
}  # fmt: skip

#: Profiles by name, as in a scene's [punch]: at least one of every registered kind.
PROFILE = {
    "flat": {"profile": "flat", "half_width": 1e-3},
    "tilted": {"profile": "flat", "half_width": 1e-3, "tilt": 0.1},
    "lifted": {"profile": "flat", "half_width": 1e-3, "tilt": -1.0},
    "cubic": {"profile": "power", "exponent": 3.0, "coefficient": 5e3},
    "parabolic": {"profile": "parabolic", "radius": 0.1},
    "cusp": {"profile": "power", "exponent": 1.5, "coefficient": 0.17},
    "rounded flat": {"profile": "rounded_flat", "flat_half_width": 0.5e-3, "radius": 0.05},
    "wedge": {"profile": "wedge", "slope": 7e-3},
    "table": {
        "profile": "table",
        "shape": [[-5e-3, 2e-4], [-2e-3, 3e-5], [-1e-3, 5e-6], [0.0, 0.0], [2e-3, 2e-5], [6e-3, 3e-4]],
    },
    "rolling": {
        "profile": "parabolic", "radius": 0.1,
        "solid": {"kind": "isotropic", "E": 2e9, "nu": 0.35, "rho": 1200.0, "speed": 40.0},
    },
}  # fmt: skip

#: Pressures that are put in, under a flat punch; None for that of the closed form.
PRESSURE = {
    "tractions": None,
    "own pressure": [[-1.0, -0.5], [0.2, -1.5], [1.0, 0.0]],
    "own pressure with jumps": [[-1.0, -1.0], [1.0, -0.6]],
}

#: Words of output.quantities that speak of steady contact.
QUANTITIES = tuple(word for word in WORDS if word not in (FRICTION_ALONE, SLIDER, TIME))
#: Punches with kinks, under which what yields takes seconds to find: that is asked before a release.
_SLOW = () if THOROUGH else ("cubic", "cusp", "rounded flat", "table")
#: What a uniform solid, and layers, are solved by.
METHODS = {False: ("closed_form", "fem"), True: ("sie", "fem")}

#: Parameters that change their sign in a mirror X → -X, and the entries of a list that do.
_TURNED = {"angle": True, "tilt": True, "stiffness": (2, 4), "stiffness_Z": (2,)}

#: Ends of datasets' names: of places over a, of what a mirror exchanges, of what changes its sign there.
_PLACES = ("_over_a", "_position", "yield_depth", "reach_left", "reach_right", "centre")
_SIDES = (
    ("left", "right"),
    ("alpha", "beta"),
    ("sigma_XY_max", "sigma_XY_min"),
    ("flutter_positive", "flutter_negative"),
)
_OTHER = {one: other for pair in _SIDES for one, other in (pair, pair[::-1])}
_SIDE = re.compile("|".join(_OTHER))
_ODD = re.compile(
    r"/(f|g|centre|tangential_force|(punch_)?sigma_XY(_max|_min)?|\w+_position|\w*X_over_a)$"
)

#: Factors of units in the scaled scene: all dimensionless numbers stay.
_LENGTH, _MODULUS, _DENSITY = 1e-3, 70.0, 3.0
_SPEED = (_MODULUS / _DENSITY) ** 0.5
UNITS = {
    "": 1.0, "1": 1.0, "deg": 1.0, "rad": 1.0, "N/(2a)": 1.0, "none": 1.0,
    "m": _LENGTH, "1/m": 1.0 / _LENGTH, "Pa": _MODULUS, "kg/m^3": _DENSITY, "m/s": _SPEED,
    "N/m": _MODULUS * _LENGTH, "s": _LENGTH / _SPEED, "J/m": _MODULUS * _LENGTH**2,
    "W/m": _MODULUS * _LENGTH * _SPEED, "N/m^2": _MODULUS,
}  # fmt: skip


@dataclass(frozen=True)
class Case:
    """A scene: names of samples, words and methods.

    Attributes:
        solid: of ``SOLID`` or ``LAYERS``.
        punch: of ``PROFILE`` or ``PRESSURE``.
        words: of output.quantities.
        methods: that are asked for.
        mirrored, scaled: is it the mirror image, is it in other units?
        tolerance: of the scene.
        c: speed over that of shear waves.
        strokes: of the motion, a state each.
    """

    solid: str
    punch: str
    words: tuple[str, ...]
    methods: tuple[str, ...]
    mirrored: bool = False
    scaled: bool = False
    tolerance: float = 1e-3
    c: float = 0.25
    strokes: tuple[str, ...] = ("forward", "backward")

    def __str__(self):
        return f"{self.solid}, {self.punch}" + ("" if len(self.words) > 1 else f", {self.words[0]}")

    def but(self, **changes):
        """The same with other attributes."""
        return replace(self, **changes)

    @property
    def layered(self):
        return self.solid in LAYERS

    @property
    def by_finite_elements(self):
        """Do these solve it? They take no nearly incompressible layer."""
        return not (self.layered and self.solid.startswith("nearly incompressible"))

    def text(self):
        """The scene in TOML."""
        solid = self.of(SOLID.get(self.solid, SOLID["isotropic"]))
        layers = [self.of(one) for one in LAYERS.get(self.solid, ())]
        solve = {"methods": list(self.methods), "tolerance": self.tolerance}
        punch = self.of(PROFILE.get(self.punch, PROFILE["flat"]))
        if self.punch in PRESSURE:
            solve["mode"] = "traction"
            if rows := PRESSURE[self.punch]:
                solve["pressure"] = [[-X, σ] for X, σ in reversed(rows)] if self.mirrored else rows
        output = {"quantities": [FRICTION_ALONE, *self.words]}
        if BELOW in self.words:
            points = [[0.2, -0.4], [-0.9, -0.15], [1.3, -0.8], [0.0, -2.5]]
            output["points"] = [[-X, Y] for X, Y in points] if self.mirrored else points
        sections = {
            "solid": solid | {"yield_strength": 1e7 * self._unit("Pa")},
            "punch": punch | {"load": 8e3 * self._unit("N/m")},
            "friction": {"model": "coulomb", "mu_c": 0.4, "pre_sliding": 1e-4 * self._unit("m")},
            "motion": {"c": self.c, "strokes": list(self.strokes), "X_over_L": [0.5]},
            "solve": solve,
            "output": output,
        }
        tables = [f"[{name}]\n{_lines(values)}" for name, values in sections.items()]
        return "\n".join([*tables, *(f"[[layer]]\n{_lines(one)}" for one in layers)])

    def of(self, given):
        """A sample, mirrored and scaled as this case is."""
        kind = SOLIDS[given["kind"]] if "kind" in given else PROFILES[given["profile"]]
        known, found = parameters(kind), {}
        for key, value in given.items():
            if key == "to":
                value = self.of({"kind": given["kind"]} | value)
                del value["kind"]
            elif key == "solid":
                value = self.of(value)
            elif key in ("thickness", "speed"):
                value *= self._unit("m" if key == "thickness" else "m/s")
            elif key in known:
                value = self._of_parameter(key, known[key], value, given)
            found[key] = value
        return found

    def _of_parameter(self, key, known, value, given):
        turned, scale = _TURNED.get(key) if self.mirrored else None, self._scale(key, known, given)
        if known.columns:
            rows = [[-row[0], *row[1:]] for row in reversed(value)] if self.mirrored else value
            return [[x * self._unit(unit) for x, unit in zip(row, known.columns)] for row in rows]
        if isinstance(value, list):
            signs = [-1.0 if turned and i in turned else 1.0 for i in range(len(value))]
            return [sign * scale * x for sign, x in zip(signs, value)]
        return value if isinstance(value, str) else (-1.0 if turned else 1.0) * scale * value

    def _unit(self, unit):
        return UNITS[unit] if self.scaled else 1.0

    def _scale(self, key, known, given):
        if self.scaled and key == "coefficient":  # a length to the power 1 - k, written as a number
            return _LENGTH ** (1.0 - given["exponent"])
        return self._unit(known.unit)


def _lines(values):
    return "\n".join(f"{key} = {_toml(value)}" for key, value in values.items()) + "\n"


def _toml(value):
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key} = {_toml(entry)}" for key, entry in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_toml, value)) + "]"
    return json.dumps(value)


def words_of(solid, punch, method="fem"):
    """Words that a solid, with or without layers, can be asked under a punch.

    Integral equations take long below layers, which finite elements say every day.
    """
    not_for = {YIELD} if solid in LAYERS else {AT_INTERFACES}
    not_for |= {YIELD} if punch in _SLOW else set()
    if method == "fem" and solid == "nearly incompressible":
        not_for |= {BELOW, YIELD}  # refused, see the test of that
    if method == "exact" and solid in LAYERS and not THOROUGH:
        not_for |= {BELOW}
    return tuple(word for word in QUANTITIES if word not in not_for)


def cases(first=None):
    """Every solid under every punch, for all that both can be asked for, by both methods.

    Args:
        first: only one case of every solid, and every punch in turn from this one, then quick ones: one
            under which no layers come to tractions of the closed form, which has none.
    """
    solids, punches = (*SOLID, *LAYERS), (*PROFILE, *PRESSURE)
    pairs = itertools.product(solids, punches)
    if first:
        start = punches.index(first)
        pairs = zip(solids, (*punches[start:], *punches[:start], "parabolic", "flat", "own pressure"))
    for solid, punch in pairs:
        if solid not in LAYERS or punch != "tractions":
            yield Case(solid, punch, words_of(solid, punch), METHODS[solid in LAYERS])


def mirrored(name):
    """Name of a dataset in the mirror, and the sign with which its values come back."""
    sign = -1.0 if _ODD.search(name) else 1.0
    return _SIDE.sub(lambda found: _OTHER[found[0]], name), sign


def answers(data):
    """Datasets of states by path, without what says how good others are.

    The exponents that are fitted to raw nodal forces say so, too.
    """
    sections = ("states", "surface", "interior", "interfaces")
    quality = ("estimate", "error", "residual", "fem/alpha", "fem/beta", "slope_under")
    return {
        name: values
        for name, values in data.items()
        if name.split("/")[0] in sections
        and declared(name).type != TEXT
        and not any(word in name for word in quality)
    }


def check_same(one, two, allowed, name):
    """Values of states agree, pointwise or over the median of a state's size.

    Places over a, of what is largest or begins, agree to the root of that: they are flat there.
    """
    one, two = (np.reshape(values, (len(values), -1)) for values in (one, two))
    np.testing.assert_array_equal(np.isnan(one), np.isnan(two), err_msg=name)
    np.testing.assert_array_equal(np.isinf(one), np.isinf(two), err_msg=name)
    for first, second in zip(one, two):
        there = np.isfinite(first)
        first, second = first[there], second[there]
        if name.endswith(_PLACES):
            np.testing.assert_allclose(second, first, rtol=0.0, atol=allowed**0.5, err_msg=name)
        elif first.size:
            size = np.abs(first)
            apart = np.abs(first - second) / np.maximum(size + np.median(size), 1e-300)
            assert apart.max() <= allowed, f"{name}: {apart.max():.2g}"
