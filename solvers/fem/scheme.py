"""The scheme of steps in time: diagonally implicit Runge-Kutta of order four, stages of second order.

ESDIRK4(3)6L[2]SA of Kennedy and Carpenter, stiffly accurate and L-stable: the last stage is the end of
the step, and the first one the end of that before.
"""

#: On the diagonal, so that one matrix serves all stages.
γ = 0.25
#: Stages below the first.
A = (
    (1 / 4,),
    (8611 / 62500, -1743 / 31250),
    (5012029 / 34652500, -654441 / 2922500, 174375 / 388108),
    (15267082809 / 155376265600, -71443401 / 120774400, 730878875 / 902184768, 2285395 / 8070912),
    (82889 / 524892, 0.0, 15625 / 83664, 69875 / 102672, -2260 / 8211),
)
TIMES = (0.5, 83 / 250, 31 / 50, 17 / 20, 1.0)
