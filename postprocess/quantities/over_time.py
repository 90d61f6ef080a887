"""What happens over time where a punch is pressed on and slides, one row for each start."""

from galinx.postprocess.quantities.quantity import ANYWHERE, FEM, NEVER, QUANTITIES, SIE, Quantity
from galinx.solvers.parameters import Range

#: Word of output.quantities.
TIME = "time"

#: Dimensions: speeds with frictions, and times.
START, INSTANT = "starts", "instants"

_ANY, _NOT_NEGATIVE = Range(), Range(at_least=0.0)


def _row(
    name: str, unit: str, about: str, over: tuple[str, ...], range: Range = _ANY, **others: object
) -> Quantity:
    return Quantity(f"time/{name}", unit, about, over, asked_by=TIME, range=range, **others)  # type: ignore[arg-type]


SPEED = _row("c", "1", "speed of the start over shear wave speed", (START,), _NOT_NEGATIVE)
RATIO = _row("g", "1", "sigma_XY/sigma_YY under the punch of the start, at its end", (START,))
RATIOS = _row("ratio", "1", "sigma_XY/sigma_YY under the punch over time", (START, INSTANT))
DIRECTION = _row("direction", "1", "direction of motion along X over time, 1 or -1", (START, INSTANT))
TIMES = _row("t", "a/c_s", "times since the punch touched", (INSTANT,), _NOT_NEGATIVE)
LOAD = _row("load", "1", "load at that time over N", (INSTANT,), _NOT_NEGATIVE)
STEADY_CENTRE = _row(
    "steady_centre", "1",
    "centre of the pressure in steady motion over the half-width, closed form, over layers by their "
    "integral equation",
    (START,),
)  # fmt: skip
CENTRES = _row(
    "steady_centres", "1",
    "centre of the pressure over the half-width if it were at once that of steady motion",
    (START, INSTANT),
)  # fmt: skip
STEADY_K_I = _row(
    "steady_K_I",
    "1",
    "stress intensity factor in steady motion, both ends, closed form; none over layers",
    (START,),
    nan_allowed=ANYWHERE,
)


def _by_method(name: str, unit: str, about: str, nan_allowed: str | None = None) -> dict[str, Quantity]:
    """By both; the integral equation says nothing from where the punch turns round."""
    how = {FEM: "finite elements", SIE: "integral equation"}
    untold = {FEM: NEVER, SIE: ANYWHERE}
    return {
        method: _row(
            f"{method}/{name}",
            unit,
            f"{about}, {told}",
            (START, INSTANT),
            method=method,
            nan_allowed=nan_allowed or untold[method],
        )
        for method, told in how.items()
    }


V0 = _by_method("v0", "N/(2mu)", "indentation since the punch touched")
CENTRE = _by_method("centre_of_pressure", "1", "centre of the pressure over the half-width, towards +X")
K_I_LEFT = _by_method(
    "K_I_left", "1", "stress intensity factor over time at X = -a by the final load", nan_allowed=ANYWHERE
)
K_I_RIGHT = _by_method(
    "K_I_right", "1", "stress intensity factor over time at X = a by the final load", nan_allowed=ANYWHERE
)
WORK = _row(
    "fem/work", "N^2/(4mu)", "work of the contact's forces by velocities seen from the punch",
    (START, INSTANT), method=FEM,
)  # fmt: skip
ENERGY = _row(
    "fem/energy", "N^2/(4mu)",
    "energy of the motion seen from the punch, kinetic and strain less that of being carried along",
    (START, INSTANT), method=FEM,
)  # fmt: skip
ABSORBED = _row(
    "fem/absorbed", "N^2/(4mu)", "energy of waves that cells far away are too large for",
    (START, INSTANT), method=FEM,
)  # fmt: skip
ESTIMATE = _row(
    "fem/estimate", "1",
    "estimated error over time of v0, centre times load, and K_I, over the largest of each",
    (START,), _NOT_NEGATIVE, method=FEM, accuracy=True,
)  # fmt: skip

QUANTITIES.add_all(globals())
