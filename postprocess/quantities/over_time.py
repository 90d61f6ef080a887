"""Quantities of motions in time, one row for each start: a punch is pressed on and slides.

Indentation, centre of the pressure, K_I, load and friction over time; distance from steady motion; works
and energies; and stresses on the surface, over time and at chosen times.
"""

from typing import Any

from .quantity import (
    ANYWHERE,
    FEM,
    NEVER,
    NOT_NEGATIVE,
    OVER_C_S,
    OVER_N,
    QUANTITIES,
    SIE,
    X_OVER_A,
    Quantity,
    by_method,
)

#: Word of output.quantities.
TIME = "time"

#: Dimensions: speeds with frictions, and times.
START, INSTANT = "starts", "instants"


def _row(name: str, unit: str, about: str, over: tuple[str, ...], **others: Any) -> Quantity:
    return Quantity(f"time/{name}", unit, about, over, asked_by=TIME, **others)


def _by_method(
    name: str, unit: str, about: str, over: tuple[str, ...] = (START, INSTANT), **others: Any
) -> dict[str, Quantity]:
    """Quantity by both methods; the integral equation has none from where the punch turns round."""
    own = {
        FEM: {"about": f"{about}, finite elements", "nan_allowed": NEVER},
        SIE: {"about": f"{about}, integral equation", "nan_allowed": ANYWHERE},
    }
    own = {method: attributes | others for method, attributes in own.items()}
    section, _, name = f"time/{name}".rpartition("/")
    return by_method(name, unit, about, None, own, section, over=over, asked_by=TIME)


SPEED = _row(
    "c", "1", "speed of the start over shear wave speed", (START,), range=NOT_NEGATIVE, scale=OVER_C_S
)
RATIO = _row("g", "1", "sigma_XY/sigma_YY under the punch of the start, at its end", (START,))
RATIOS = _row("ratio", "1", "sigma_XY/sigma_YY under the punch over time", (START, INSTANT))
DIRECTION = _row("direction", "1", "direction of motion along X over time, 1 or -1", (START, INSTANT))
TIMES = _row(
    "t", "a/c_s", "times since the punch touched, after each step", (INSTANT,), range=NOT_NEGATIVE
)
LOAD = _row("load", "1", "load at that time over N", (INSTANT,), range=NOT_NEGATIVE, scale=OVER_N)
STEADY_CENTRE = _row(
    "steady_centre", "1", "centre of the pressure in steady motion over the half-width", (START,),
    scale=X_OVER_A,
)  # fmt: skip
CENTRES = _row(
    "steady_centres", "1",
    "centre of the pressure over the half-width in steady motion at each moment's friction",
    (START, INSTANT), scale=X_OVER_A,
)  # fmt: skip
STEADY_K_I = _row(
    "steady_K_I", "1",
    "stress intensity factor in steady motion, both ends, closed form; none over layers", (START,),
    nan_allowed=ANYWHERE,
)  # fmt: skip

V0 = _by_method("v0", "N/(2mu)", "indentation since the punch touched")
CENTRE = _by_method(
    "centre_of_pressure", "1", "centre of the pressure over the half-width, towards +X",
    scale=X_OVER_A,
)  # fmt: skip
K_I_LEFT, K_I_RIGHT = (
    _by_method(
        f"K_I_{side}", "1", f"stress intensity factor over time at {at}, over N",
        nan_allowed=ANYWHERE,
    )
    for side, at in (("left", "X = -a"), ("right", "X = a"))
)  # fmt: skip
TENSION = _by_method(
    "tension", "N/(2a)",
    "largest tension under the punch further than 0.01 a from its ends, 0 for none",
    nan_allowed=ANYWHERE, range=NOT_NEGATIVE,
)  # fmt: skip
WORK = _row(
    "fem/work", "N^2/(4mu)", "work of the contact's forces by velocities seen from the punch",
    (START, INSTANT), method=FEM,
)  # fmt: skip
ENERGY = _row(
    "fem/energy", "N^2/(4mu)",
    "energy of the motion seen from the punch, strain and kinetic less that of transport",
    (START, INSTANT), method=FEM,
)  # fmt: skip
ABSORBED = _row(
    "fem/absorbed", "N^2/(4mu)", "energy of short waves damped in far cells",
    (START, INSTANT), method=FEM,
)  # fmt: skip
ESTIMATE = _row(
    "fem/estimate", "1",
    "estimated error over time of v0, centre times load, and K_I, over the largest of each, of the first "
    "two at least 0.01",
    (START,), range=NOT_NEGATIVE, method=FEM, accuracy=True,
)  # fmt: skip
RESIDUAL = _row(
    "sie/residual", "1",
    "error of the integral equation over time where it is alone: residual over the largest indentation, "
    "resultant's over the load, of K_I by fewer polynomials",
    (START,), range=NOT_NEGATIVE, method=SIE, accuracy=True,
)  # fmt: skip


#: Shares of steady motion within which a start is reported to be.
SHARES = (0.1, 0.01, 0.001)
#: Their dimension.
SHARE = "10, 1 and 0.1 %"

OFF = _by_method(
    "off_steady", "1",
    "distance at the end from steady motion under the load there, the largest difference of K_I, "
    "relative, and of the centre, over the half-width",
    (START,), nan_allowed=ANYWHERE, range=NOT_NEGATIVE,
)  # fmt: skip
WITHIN = _by_method(
    "steady_within", "a/c_s",
    "time from which on off_steady is at most 0.1, 0.01 and 0.001; beyond /time/t by a decay like "
    "1/t, NaN where the second half of the motion does not show it",
    (START, SHARE), nan_allowed=ANYWHERE, range=NOT_NEGATIVE,
)  # fmt: skip
APPROACH = _row(
    "steady_within_1_percent", "a/c_s",
    "time from which on a start under a sudden load is within 1 % of steady motion, by the formula for "
    "late times; none over layers",
    (START,), range=NOT_NEGATIVE, nan_allowed=ANYWHERE,
)  # fmt: skip

OF_LOAD = _by_method(
    "work_of_load", "N^2/(4mu)", "work of the load", nan_allowed=ANYWHERE
)  # fmt: skip
OF_FRICTION = _by_method(
    "work_of_friction", "N^2/(4mu)",
    "work of friction on the surface, by velocities seen from the punch", nan_allowed=ANYWHERE,
)  # fmt: skip
LEFT, RIGHT = (
    _by_method(
        f"sigma_XX_{side}", "N/(2a)", f"in-plane stress on the free surface at X = {X} a",
        nan_allowed=ANYWHERE,
    )
    for side, X in (("left", "-1.05"), ("right", "1.05"))
)  # fmt: skip

#: Dimension of places under the punch.
PLACE = "places"
PLACES = _row(
    "X_over_a", "1", "positions under the punch over the half-width", (PLACE,), method=SIE,
    scale=X_OVER_A,
)  # fmt: skip
PRESSURE = _row(
    "sie/sigma_YY", "N/(2a)", "contact stress, integral equation", (START, INSTANT, PLACE), method=SIE,
    nan_allowed=ANYWHERE,
)  # fmt: skip


#: In which box about the punch, that goes with it, energy is near.
_NEAR = "within 3 a of its middle and 2 a below it"


def _energy_row(name: str, about: str) -> Quantity:
    return _row(f"fem/{name}", "N^2/(4mu)", f"{about}, since t = 0", (START, INSTANT), method=FEM)


DISSIPATED = _row(
    "dissipated", "N*a", "work that friction takes to first order, f V load over time", (START, INSTANT)
)
CARRIED = _energy_row(
    "work_of_carrying",
    "work of carrying the solid past the punch, V times the change of its momentum",
)
STRAIN = _energy_row("strain_near", f"strain energy of the solid near the punch, {_NEAR}")
KINETIC = _energy_row("kinetic_near", f"kinetic energy of the solid near the punch, {_NEAR}")
RADIATED = _energy_row(
    "radiated",
    "strain and kinetic energy of the solid farther from the punch, damped waves included",
)


#: Dimensions: chosen times, and places.
OUTPUT, SURFACE_PLACE = "chosen times", "places along the surface"


SURFACE_TIMES = _row(
    "surface/t", "a/c_s", "times of the stresses along the surface", (OUTPUT,), range=NOT_NEGATIVE
)
SURFACE_PLACES = _row(
    "surface/X_over_a", "1", "positions along the surface over the half-width", (SURFACE_PLACE,),
    scale=X_OVER_A,
)  # fmt: skip
SURFACE_IN_PLANE, SURFACE_PRESSURE, SURFACE_SHEAR = (
    _by_method(
        f"surface/sigma_{ij}", "N/(2a)", f"{what} over time", (START, OUTPUT, SURFACE_PLACE)
    )
    for ij, what in (
        ("XX", "in-plane stress on the surface"), ("YY", "contact stress"), ("XY", "friction stress"),
    )
)  # fmt: skip
SURFACE_ESTIMATE = _row(
    "surface/fem/estimate", "1",
    "estimated error of sigma_XX and sigma_YY along the surface over time, further than 0.01 a from the "
    "edges, over the largest of each there",
    (START,), method=FEM, range=NOT_NEGATIVE, accuracy=True,
)  # fmt: skip

QUANTITIES.add_all(globals())
