"""Quantities with one value a state."""

from galinx.postprocess import compare
from galinx.postprocess.quantities.quantity import LOCAL, STATE, Quantity
from galinx.postprocess.stresses import flatness

_WHICH = (
    Quantity("states/motion", "none", "name of the stroke: forward (FM) or backward (BM) motion, numbered",
             (STATE,), symbol="motion"),
    Quantity("states/X_over_L", "1", "position on the stroke over the pre-sliding displacement", (STATE,),
             symbol="X/L"),
    Quantity("states/c", "1", "speed over shear wave speed", (STATE,), symbol="c"),
    Quantity("states/f", "1", "friction coefficient F/N, positive in forward motion", (STATE,)),
    Quantity("states/g", "1", "sigma_XY/sigma_YY under the punch", (STATE,)),
)  # fmt: skip

_LOCAL = (
    Quantity("states/alpha", "1", "exponent of the pressure at X = a, local analysis", (STATE,),
             lambda s, _: s.local.α, LOCAL),
    Quantity("states/beta", "1", "exponent of the pressure at X = -a, local analysis", (STATE,),
             lambda s, _: s.local.β, LOCAL),
)  # fmt: skip

_CLOSED_FORM = (
    Quantity("states/closed_form/K_I", "1", "normalised stress intensity factor, both ends (Eq 58)",
             (STATE,), lambda s, _: s.K_I[:, 0], "closed_form"),
    Quantity("states/closed_form/K_I_left", "1", "normalised stress intensity factor at X = -a",
             (STATE,), lambda s, _: s.K_I[:, 0], "closed_form"),
    Quantity("states/closed_form/K_I_right", "1", "normalised stress intensity factor at X = a",
             (STATE,), lambda s, _: s.K_I[:, 1], "closed_form"),
)  # fmt: skip

_FINITE_ELEMENTS = (
    Quantity("states/fem/K_I_left", "1", "normalised stress intensity factor at X = -a, Jacobi moments",
             (STATE,), lambda s, _: s.K_I[:, 0], "fem", "contact", compared=(compare.K_I,)),
    Quantity("states/fem/K_I_right", "1", "normalised stress intensity factor at X = a, Jacobi moments",
             (STATE,), lambda s, _: s.K_I[:, 1], "fem", "contact", compared=(compare.K_I,)),
    Quantity("states/fem/alpha", "1", "exponent of the pressure at X = a, fitted from the raw pressure",
             (STATE,), lambda s, _: s.exponents[:, 0], "fem", "contact", nan_allowed="anywhere",
             compared=(compare.EXPONENTS,)),
    Quantity("states/fem/beta", "1", "exponent of the pressure at X = -a, fitted from the raw pressure",
             (STATE,), lambda s, _: s.exponents[:, 1], "fem", "contact", nan_allowed="anywhere",
             compared=(compare.EXPONENTS,)),
    Quantity("states/fem/normal_force", "N/m", "resultant of the nodal normal forces under the punch",
             (STATE,), lambda s, body: s.normal_force * body.force, "fem", compared=(compare.BALANCE,)),
    Quantity("states/fem/tangential_force", "N/m",
             "resultant of the nodal tangential forces under the punch",
             (STATE,), lambda s, body: s.tangential_force * body.force, "fem",
             compared=(compare.BALANCE,)),
    Quantity("states/fem/v0", "m", "indentation relative to the far boundary",
             (STATE,), lambda s, body: s.v0 * body.displacement, "fem", "contact"),
    Quantity("states/fem/estimate", "1",
             "estimated relative error of K_I and moments, no closed form used",
             (STATE,), lambda s, _: s.estimate, "fem", "contact", compared=(compare.ESTIMATE,)),
    Quantity("states/fem/true_error", "1", "relative error of K_I against the closed form, larger end",
             (STATE,), method="fem", mode="contact", of_data=compare.K_I_error, needs=compare.K_I.needs),
    Quantity("states/fem/slope_under_punch", "1",
             "largest |v,X| for |X| <= 0.9 a over the largest for 1.1 a <= |X| <= 5 a",
             (STATE,), lambda s, _: flatness(s.surface), "fem", asked_by="surface",
             compared=(compare.SLOPE,)),
)  # fmt: skip

ROWS = (*_WHICH, *_LOCAL, *_CLOSED_FORM, *_FINITE_ELEMENTS)
