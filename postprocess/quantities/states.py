"""Quantities with one value a state."""

from collections.abc import Callable, Mapping
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
    OVER_C_S,
    QUANTITIES,
    SIE,
    STATE,
    SWEPT,
    X_OVER_A,
    Quantity,
)

_CONTACT, _NOT_NEGATIVE = "contact", Range(at_least=0.0)

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
FRICTION = Quantity("states/f", "1", "friction coefficient F/N, positive in forward motion", (STATE,))
RATIO = Quantity("states/g", "1", "sigma_XY/sigma_YY under the punch", (STATE,))
INNER_STATE = Quantity(
    "states/inner_state", "1", "inner state of the friction law, as its page says", (STATE, INNER)
)
VELOCITY = Quantity("states/speed", "m/s", "speed", (STATE,), range=_NOT_NEGATIVE)
SPEED_LIMIT = Quantity(
    "states/speed_limit", "m/s", "speed of the wave along the surface, below which a punch has to be",
    (STATE,), range=_NOT_NEGATIVE,
)  # fmt: skip

ALPHA = Quantity(
    "states/alpha", "1", "exponent of the pressure at X = a, local analysis", (STATE,),
    lambda s, _: s.local.α, LOCAL, PUNCH,
)  # fmt: skip
BETA = Quantity(
    "states/beta", "1", "exponent of the pressure at X = -a, local analysis", (STATE,),
    lambda s, _: s.local.β, LOCAL, PUNCH,
)  # fmt: skip

K_I_BOTH = Quantity(
    "states/closed_form/K_I", "1",
    "normalised stress intensity factor, both ends of a flat punch (Eq 58)",
    (STATE,), lambda s, _: s.K_I[:, 0], CLOSED_FORM, requires=(SOLVED, PUNCH), scale=EDGE,
)  # fmt: skip
K_I_LEFT = {
    CLOSED_FORM: Quantity(
        "states/closed_form/K_I_left", "1", "normalised stress intensity factor at X = -a", (STATE,),
        lambda s, _: s.K_I[:, 0], CLOSED_FORM, requires=(SOLVED,), scale=EDGE,
    ),
    FEM: Quantity(
        "states/fem/K_I_left", "1", "normalised stress intensity factor at X = -a, Jacobi moments",
        (STATE,), lambda s, _: s.K_I[:, 0], FEM, _CONTACT, compared=("K_I",), scale=EDGE,
    ),
}  # fmt: skip
K_I_RIGHT = {
    CLOSED_FORM: Quantity(
        "states/closed_form/K_I_right", "1", "normalised stress intensity factor at X = a", (STATE,),
        lambda s, _: s.K_I[:, 1], CLOSED_FORM, requires=(SOLVED,), scale=EDGE,
    ),
    FEM: Quantity(
        "states/fem/K_I_right", "1", "normalised stress intensity factor at X = a, Jacobi moments",
        (STATE,), lambda s, _: s.K_I[:, 1], FEM, _CONTACT, compared=("K_I",), scale=EDGE,
    ),
}  # fmt: skip

FITTED_ALPHA = Quantity(
    "states/fem/alpha", "1", "exponent of the pressure at X = a, fitted from the raw pressure", (STATE,),
    lambda s, _: s.exponents[:, 0], FEM, _CONTACT, nan_allowed=ANYWHERE, compared=("exponents",),
    requires=(PUNCH,),
)  # fmt: skip
FITTED_BETA = Quantity(
    "states/fem/beta", "1", "exponent of the pressure at X = -a, fitted from the raw pressure", (STATE,),
    lambda s, _: s.exponents[:, 1], FEM, _CONTACT, nan_allowed=ANYWHERE, compared=("exponents",),
    requires=(PUNCH,),
)  # fmt: skip
NORMAL_FORCE = Quantity(
    "states/fem/normal_force", "N/m", "resultant of the nodal normal forces under the punch", (STATE,),
    lambda s, body: s.normal_force * body.force, FEM, compared=("force balance",), accuracy=True,
)  # fmt: skip
TANGENTIAL_FORCE = Quantity(
    "states/fem/tangential_force", "N/m", "resultant of the nodal tangential forces under the punch",
    (STATE,), lambda s, body: s.tangential_force * body.force, FEM, compared=("force balance",),
)  # fmt: skip
INDENTATION = Quantity(
    "states/fem/v0", "m", "indentation relative to the surface far away", (STATE,),
    lambda s, body: s.v0 * body.displacement, FEM, _CONTACT,
)  # fmt: skip
ESTIMATE = Quantity(
    "states/fem/estimate", "1",
    "estimated relative error of K_I, sigma_YY and its moments, no closed form used",
    (STATE,), lambda s, _: s.estimates[INTENSITIES], FEM, _CONTACT, compared=("estimate",),
    range=_NOT_NEGATIVE, accuracy=True,
)  # fmt: skip
FITTED = Quantity(
    "states/fem/fitted", "1",
    "1 where a fit through other speeds gives the state, 0 where its speed was solved",
    (STATE,), lambda s, _: s.fitted, FEM, SWEPT, range=Range(at_least=0.0, at_most=1.0), accuracy=True,
)  # fmt: skip


def _of_free_contact(
    name: str, unit: str, about: str, of: Callable[[Any], NDArray], compared: str = "", **options: Any
) -> dict[str, Quantity]:
    """Quantity of contacts with free ends, by all methods."""
    rules = (compared, f"{compared} over layers") if compared else ()
    return {
        method: Quantity(
            f"states/{method}/{name}", unit, about, (STATE,), lambda s, _: of(s), method, FREE_ENDS,
            compared=rules * (method == FEM), **options,
        )
        for method in (CLOSED_FORM, SIE, FEM)
    }  # fmt: skip


HALF_WIDTH = _of_free_contact(
    "half_width", "m", "half-width of the contact, over which the state's lengths are",
    lambda s: s.half_width, "ends", range=Range(above=0.0), scale=CONTACT,
)  # fmt: skip
CENTRE = _of_free_contact(
    "centre", "m", "middle of the contact, from the punch's axis; the state's positions are from there",
    lambda s: s.centre, "ends", scale=CONTACT,
)  # fmt: skip
LARGEST = _of_free_contact(
    "largest_pressure", "N/(2a)", "largest contact pressure; NaN where it is infinite",
    lambda s: s.largest[0], "largest pressure", nan_allowed=ANYWHERE, range=Range(above=0.0),
)  # fmt: skip
LARGEST_X = _of_free_contact(
    "largest_pressure_position", "1",
    "place of the largest contact pressure, over the half-width; NaN where it is infinite",
    lambda s: s.largest[1], nan_allowed=ANYWHERE, range=Range(at_least=-1.0, at_most=1.0), scale=X_OVER_A,
)  # fmt: skip

#: Resultants of a prescribed pressure, by method.
RESULTANT = {
    method: Quantity(
        f"states/{method}/normal_force", "N/m", "resultant of the prescribed pressure", (STATE,),
        lambda s, body: s.normal_force * body.force, method, OWN_PRESSURE, compared=(rule,),
        accuracy=True,
    )
    for method, rule in ((CLOSED_FORM, "resultant"), (SIE, "resultant over layers"))
}  # fmt: skip


def _attribute(name: str) -> Callable[[Any, Any], NDArray]:
    return lambda solution, _: np.asarray(getattr(solution, name))


#: Resultant and centre of the tractions where friction varies along the contact, by method.
RESULTANT_RATIO, PRESSURE_CENTRE = (
    {
        method: Quantity(
            f"states/{method}/{name}", "1", about, (STATE,), _attribute(name),
            method, VARYING, compared=(name,) * (method == FEM), scale=scale,
        )
        for method in (CLOSED_FORM, FEM)
    }
    for name, about, scale in (
        ("resultant_ratio", "resultant of sigma_XY over that of sigma_YY", ""),
        ("pressure_centre", "centre of pressure over the half-width", X_OVER_A),
    )
)  # fmt: skip

#: Share of the larger intensity below which an error is over this share rather than over itself.
_VANISHING = 0.1


def K_I_error(data: Mapping[str, Any]) -> NDArray[np.float64]:
    """Larger relative error of both stress intensity factors against the integral equation, (states,)."""
    fem, exact = (
        np.array([data[side[method].path] for side in (K_I_LEFT, K_I_RIGHT)])
        for method in (FEM, CLOSED_FORM)
    )
    # At a free end it is 0, and small where a tilted punch is about to lift off.
    size = np.maximum(np.abs(exact), _VANISHING * np.abs(exact).max(axis=0))
    return np.max(np.abs(fem - exact) / np.where(size > 0.0, size, 1.0), axis=0)


TRUE_ERROR = Quantity(
    "states/fem/true_error", "1", "relative error of K_I against the closed form, larger end", (STATE,),
    method=FEM, mode=_CONTACT, of_data=K_I_error,
    needs=tuple(row.path for side in (K_I_LEFT, K_I_RIGHT) for row in side.values()),
    range=_NOT_NEGATIVE, accuracy=True,
)  # fmt: skip
#: Residuals of one method alone, by method.
RESIDUAL = {
    method: Quantity(
        f"states/{method}/residual", "1",
        "residual of the integral equation at the contact pressure, by a rule of its own, over the "
        "pressure's part in it",
        (STATE,), lambda s, _: s.residual, method, ALONE, compared=(rule,), range=_NOT_NEGATIVE,
        accuracy=True, requires=(SOLVED,),
    )
    for method, rule in ((CLOSED_FORM, "residual"), (FEM, "residual of finite elements"))
}  # fmt: skip
SLOPE = Quantity(
    "states/fem/slope_under_punch", "1",
    "largest |v,X| for |X| <= 0.9 a over the largest for 1.1 a <= |X| <= 5 a",
    (STATE,), lambda s, _: flatness(s.surface), FEM, asked_by="surface",
    compared=("slope under the punch",), range=_NOT_NEGATIVE, accuracy=True, requires=(FLAT,),
)  # fmt: skip

QUANTITIES.add_all(globals())
