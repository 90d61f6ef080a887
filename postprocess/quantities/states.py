"""Quantities with one value a state."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.solvers.contact import FREE_ENDS, INTENSITIES, OWN_PRESSURE, VARYING
from galinx.solvers.contact.solution import FLAT, PUNCH, SOLVED
from galinx.solvers.contact.stresses import flatness
from galinx.solvers.parameters import Range

from .quantity import (
    ALONE,
    ANYWHERE,
    CLOSED_FORM,
    CONTACT,
    EDGE,
    FEM,
    INNER,
    LOCAL,
    NOT_NEGATIVE,
    OVER_C_S,
    QUANTITIES,
    SIE,
    STATE,
    SWEPT,
    X_OVER_A,
    Quantity,
    by_method,
    entry,
)

_CONTACT = "contact"
#: Methods in the order of the table.
_METHODS = (CLOSED_FORM, SIE, FEM)

MOTION = Quantity(
    "states/motion", "none", "name of the stroke: forward (FM) or backward (BM) motion, numbered",
    (STATE,), symbol="motion",
)  # fmt: skip
POSITION = Quantity(
    "states/X_over_L", "1", "position on the stroke over the pre-sliding displacement", (STATE,),
    symbol="X/L", range=Range(at_least=0.0, at_most=1.0),
)  # fmt: skip
SPEED = Quantity(
    "states/c", "1", "speed over shear wave speed", (STATE,),
    symbol="c", range=Range(at_least=0.0, below=1.0), scale=OVER_C_S,
)  # fmt: skip
LOAD = Quantity(
    "states/load", "N/m", "normal load per depth N, where states differ in it", (STATE,), symbol="N",
    range=Range(above=0.0),
)  # fmt: skip
FRICTION = Quantity(
    "states/f", "1",
    "friction coefficient F/N, positive in forward motion; where it varies along X its mean over X, "
    "between free ends that at rest",
    (STATE,),
)  # fmt: skip
RATIO = Quantity(
    "states/g", "1", "sigma_XY/sigma_YY under the punch, its mean as that of f where it varies", (STATE,)
)
LARGEST_RATIO = Quantity(
    "states/g_largest", "1", "sigma_XY/sigma_YY of the largest size along X", (STATE,),
    lambda s, body: body.largest_ratios(s.g, s.half_width), LOCAL, VARYING,
)  # fmt: skip
INNER_STATE = Quantity(
    "states/inner_state", "1", "inner state of the friction law, as its page says",
    (STATE, INNER),
)  # fmt: skip
VELOCITY = Quantity("states/speed", "m/s", "speed", (STATE,), range=NOT_NEGATIVE)
SPEED_LIMIT = Quantity(
    "states/speed_limit", "m/s", "speed of the wave along the surface, below which a punch has to be",
    (STATE,), range=NOT_NEGATIVE,
)  # fmt: skip

#: Exponents of the pressure at X = a and X = -a, by name.
_EXPONENTS = {"alpha": "exponent of the pressure at X = a", "beta": "exponent of the pressure at X = -a"}
ALPHA, BETA = (
    Quantity(f"states/{name}", "1", f"{about}, local analysis", (STATE,), of, LOCAL, PUNCH)
    for (name, about), of in zip(_EXPONENTS.items(), (lambda s, _: s.local.α, lambda s, _: s.local.β))
)

K_I_BOTH = Quantity(
    "states/closed_form/K_I", "1",
    "stress intensity factor, normalised, both ends of a flat punch (Eq 58)",
    (STATE,), lambda s, _: s.K_I[:, 0], CLOSED_FORM, requires=(SOLVED, PUNCH), scale=EDGE,
)  # fmt: skip


def _intensity(side: str, at: str, i: int) -> dict[str, Quantity]:
    about = f"stress intensity factor at {at}, normalised"
    return by_method(
        f"K_I_{side}", "1", about, lambda s, _: s.K_I[:, i], {
            CLOSED_FORM: {"requires": (SOLVED,)},
            FEM: {"mode": _CONTACT, "about": f"{about}, Jacobi moments"},
            SIE: {"requires": (SOLVED,), "about": f"{about}, layered half-plane"},
        }, scale=EDGE,
    )  # fmt: skip


K_I_LEFT, K_I_RIGHT = _intensity("left", "X = -a", 0), _intensity("right", "X = a", 1)

FITTED_ALPHA, FITTED_BETA = (
    Quantity(
        f"states/fem/{name}", "1", f"{about}, fitted from the raw pressure", (STATE,),
        entry(lambda s: s.exponents, ..., i), FEM, _CONTACT, nan_allowed=ANYWHERE,
        requires=(PUNCH,),
    )
    for i, (name, about) in enumerate(_EXPONENTS.items())
)  # fmt: skip
NORMAL_FORCE = Quantity(
    "states/fem/normal_force", "N/m", "resultant of the nodal normal forces under the punch", (STATE,),
    lambda s, body: s.normal_force * body.force, FEM, accuracy=True,
)  # fmt: skip
TANGENTIAL_FORCE = Quantity(
    "states/fem/tangential_force", "N/m", "resultant of the nodal tangential forces under the punch",
    (STATE,), lambda s, body: s.tangential_force * body.force, FEM,
)  # fmt: skip
INDENTATION = Quantity(
    "states/fem/v0", "m", "indentation relative to the surface far away", (STATE,),
    lambda s, body: s.v0 * body.displacement, FEM, _CONTACT,
)  # fmt: skip
ESTIMATE = by_method(
    "estimate", "1", "estimated relative error of K_I, sigma_YY and its moments, no closed form used",
    lambda s, _: s.estimates[INTENSITIES], {
        FEM: {"mode": _CONTACT},
        SIE: {
            "about": "estimated relative error of K_I and pressure, by fewer unknowns and the kernel's "
            "error", "requires": (SOLVED,),
        },
    }, range=NOT_NEGATIVE, accuracy=True,
)  # fmt: skip
FITTED = Quantity(
    "states/fem/fitted", "1",
    "1 where a fit through other speeds gives the state, 0 where its speed was solved",
    (STATE,), lambda s, _: s.fitted, FEM, SWEPT, range=Range(at_least=0.0, at_most=1.0), accuracy=True,
)  # fmt: skip


HALF_WIDTH = by_method(
    "half_width", "m", "half-width of the contact, over which the state's lengths are",
    lambda s, _: s.half_width, _METHODS, mode=FREE_ENDS, range=Range(above=0.0), scale=CONTACT,
)  # fmt: skip
CENTRE = by_method(
    "centre", "m", "middle of the contact, from the punch's axis; the state's positions are from there",
    lambda s, _: s.centre, _METHODS, mode=FREE_ENDS, scale=CONTACT,
)  # fmt: skip
LARGEST = by_method(
    "largest_pressure", "N/(2a)", "largest contact pressure; NaN where it is infinite",
    lambda s, _: s.largest[0], _METHODS, mode=FREE_ENDS, nan_allowed=ANYWHERE, range=Range(above=0.0),
)  # fmt: skip
LARGEST_X = by_method(
    "largest_pressure_position", "1",
    "place of the largest contact pressure, over the half-width; NaN where it is infinite",
    lambda s, _: s.largest[1], _METHODS, mode=FREE_ENDS, nan_allowed=ANYWHERE,
    range=Range(at_least=-1.0, at_most=1.0), scale=X_OVER_A,
)  # fmt: skip

#: Resultants of a prescribed pressure, by method.
RESULTANT = by_method(
    "normal_force", "N/m", "resultant of the prescribed pressure",
    lambda s, body: s.normal_force * body.force, (CLOSED_FORM, SIE), mode=OWN_PRESSURE, accuracy=True,
)  # fmt: skip

#: Resultant and centre of the tractions where friction varies along the contact, by method.
RESULTANT_RATIO = by_method(
    "resultant_ratio", "1", "resultant of sigma_XY over that of sigma_YY",
    lambda s, _: s.resultant_ratio, _METHODS, mode=VARYING,
)  # fmt: skip
PRESSURE_CENTRE = by_method(
    "pressure_centre", "1", "centre of pressure over the half-width",
    lambda s, _: s.pressure_centre, _METHODS, mode=VARYING, scale=X_OVER_A,
)  # fmt: skip


def off_by(fem: NDArray, exact: NDArray) -> NDArray[np.float64]:
    """Larger relative error of the stress intensity factors at both ends, (2, states); (states,)."""
    # At a free end it is 0, and small where a tilted punch is about to lift off: a tenth of the larger.
    size = np.maximum(np.abs(exact), 0.1 * np.abs(exact).max(axis=0))
    return np.max(np.abs(fem - exact) / np.where(size > 0.0, size, 1.0), axis=0)


def _true_error(data: Mapping[str, Any]) -> NDArray[np.float64]:
    ends = K_I_LEFT, K_I_RIGHT
    return off_by(*(np.array([data[row[by].path] for row in ends]) for by in (FEM, CLOSED_FORM)))


TRUE_ERROR = Quantity(
    "states/fem/true_error", "1", "relative error of K_I against the closed form, larger end", (STATE,),
    method=FEM, mode=_CONTACT, of_data=_true_error,
    needs=tuple(row[by].path for row in (K_I_LEFT, K_I_RIGHT) for by in (CLOSED_FORM, FEM)),
    range=NOT_NEGATIVE, accuracy=True,
)  # fmt: skip
#: Residuals of one method alone, by method.
RESIDUAL = by_method(
    "residual", "1",
    "residual of the integral equation at the contact pressure, by a rule of its own, over the "
    "pressure's part in it",
    lambda s, _: s.residual, (CLOSED_FORM, FEM), mode=ALONE, range=NOT_NEGATIVE, accuracy=True,
    requires=(SOLVED,),
)  # fmt: skip
SLOPE = Quantity(
    "states/fem/slope_under_punch", "1",
    "largest |v,X| for |X| <= 0.9 a over the largest for 1.1 a <= |X| <= 5 a",
    (STATE,), lambda s, _: flatness(s.surface), FEM, asked_by="surface",
    range=NOT_NEGATIVE, accuracy=True, requires=(FLAT,),
)  # fmt: skip

QUANTITIES.add_all(globals())
