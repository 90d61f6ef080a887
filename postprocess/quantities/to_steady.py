"""How far starts from rest are from steady motion, one row for each."""

from galinx.postprocess.quantities.over_time import START, TIME
from galinx.postprocess.quantities.quantity import ANYWHERE, FEM, QUANTITIES, SIE, Quantity
from galinx.solvers.parameters import Range

#: Shares of steady motion within which something is told to be.
SHARES = (0.1, 0.01, 0.001)
#: Their dimension.
SHARE = "10, 1 and 0.1 %"

_HOW = {FEM: "finite elements", SIE: "integral equation"}
_NOT_NEGATIVE = Range(at_least=0.0)

OFF = {
    method: Quantity(
        f"time/{method}/off_steady", "1",
        "distance from steady motion at the end, the largest of the differences of K_I at both ends, "
        f"over that of steady motion, and of the centre of the pressure, over the half-width, {told}",
        (START,), asked_by=TIME, nan_allowed=ANYWHERE, range=_NOT_NEGATIVE, method=method,
    )
    for method, told in _HOW.items()
}  # fmt: skip
WITHIN = {
    method: Quantity(
        f"time/{method}/steady_within", "a/c_s",
        "time from which on that is at most 0.1, 0.01 and 0.001; where it is later than the last of "
        "/time/t what is left is taken to fall like 1/t if it does so in the second half of the motion, "
        f"NaN where that is too short to tell, {told}",
        (START, SHARE), asked_by=TIME, nan_allowed=ANYWHERE, range=_NOT_NEGATIVE, method=method,
    )
    for method, told in _HOW.items()
}  # fmt: skip
APPROACH = Quantity(
    "time/steady_within_1_percent", "a/c_s",
    "time from which on a start is within 1 % of steady motion, the formula for late times, under a load "
    "that came on at once; none over layers",
    (START,), asked_by=TIME, range=_NOT_NEGATIVE, nan_allowed=ANYWHERE,
)  # fmt: skip

QUANTITIES.add_all(globals())
