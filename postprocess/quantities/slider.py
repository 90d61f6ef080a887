"""How a slider moves: a mass that is pulled through a spring, one for each load and law."""

from galinx.postprocess.quantities.quantity import ANYWHERE, QUANTITIES, Quantity
from galinx.solvers.parameters import Range

#: Word of output.quantities.
SLIDER = "slider"

#: Dimensions: laws, times, and steps of a cycle.
LAW, TIME, CYCLE = "laws", "times", "steps of a cycle"

_ANY, _NOT_NEGATIVE = Range(), Range(at_least=0.0)


def _row(name: str, unit: str, about: str, over: tuple[str, ...], range: Range = _ANY) -> Quantity:
    nan = ANYWHERE if TIME not in over else "never"
    return Quantity(
        f"slider/{name}", unit, about, over, asked_by=SLIDER, nan_allowed=nan, range=range
    )  # fmt: skip


TIMES = _row("time", "s", "times", (TIME,), _NOT_NEGATIVE)
POSITION = _row("position", "m", "position of the slider", (LAW, TIME))
VELOCITY = _row("velocity", "m/s", "velocity of the slider", (LAW, TIME))
FRICTION = _row("f", "1", "friction coefficient of the slider, the spring's pull over N where it sticks",
                (LAW, TIME))  # fmt: skip
CYCLE_VELOCITY = _row(
    "cycle_velocity", "m/s", "velocity in the last cycle of stick-slip; NaN for none", (LAW, CYCLE)
)
CYCLE_FRICTION = _row(
    "cycle_f", "1", "friction coefficient in the last cycle of stick-slip; NaN for none", (LAW, CYCLE)
)
OUTCOME = Quantity(
    "slider/outcome", "none",
    "what becomes of the slider: stick-slip, swings about the drive, slides steadily, one slip only, "
    "does not break away, or no whole cycle yet",
    (LAW,), asked_by=SLIDER,
)  # fmt: skip
PERIOD = _row("period", "s", "period of stick-slip, the last; NaN for none", (LAW,), _NOT_NEGATIVE)
SLIP = _row("slip_per_cycle", "m", "slip per cycle of stick-slip; NaN for none", (LAW,))
PEAK = _row("peak_velocity", "m/s", "peak velocity in a cycle of stick-slip; NaN for none", (LAW,))
LEAST = _row("least_velocity", "m/s", "least velocity in a cycle of stick-slip; NaN for none", (LAW,))

QUANTITIES.add_all(globals())
