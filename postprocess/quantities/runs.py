"""What a run says of itself, and the friction loops that its states lie on."""

from galinx.postprocess.quantities.quantity import LOOP, SPEED, STATE, STEP, Quantity

_LOOPS = (
    Quantity("loops/X_over_L", "1", "positions along all strokes, in the order of travel", (STEP,)),
    Quantity("loops/of_state", "1", "row of loops/f that each state lies on, -1 for none", (STATE,)),
    Quantity("loops/f", "1", "friction coefficient there, a row for each law and speed", (LOOP, STEP)),
)

#: One value a speed that finite elements solved; the names are those of a method's record.
RECORD = tuple(
    Quantity(f"run/fem/{name}", "1", about, (SPEED,))
    for name, about in {
        "c": "speeds with finite elements, over shear wave speed",
        "cells": "cells of the mesh",
        "unknowns": "unknowns",
        "degree": "polynomial degree",
        "factorisations": "factorisations",
        "back_substitutions": "back-substitutions",
        "iterations": "most steps of conjugate gradients in a solve; 0: direct solver",
        "largest_residual": "largest |b - Ax|/|b| of a back-substitution",
        "largest_condition": "largest condition number of a matrix, estimated by MUMPS; 0 if all were too "
        "large",
    }.items()
)

_RUN = (
    Quantity("scene/text", "none", "scene as given (TOML)"),
    Quantity("run/fem/change_by_degree", "1",
             "largest relative change of K_I and moments from the degree before, by degree; 0: not computed",
             (SPEED, "degrees")),
    Quantity("run/failures", "none", "speeds that could not be solved, and why"),
    Quantity("run/done", "none", "steps done"),
    Quantity("run/skipped", "none", "steps skipped, and why"),
    Quantity("run/seconds", "s", "wall time of the steps done, in the order of run/steps"),
    Quantity("run/steps", "none", "names of the timed steps"),
)  # fmt: skip

ROWS = (*_LOOPS, *RECORD, *_RUN)
