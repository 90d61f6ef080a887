"""Of which scenes motions in time are known."""

from galinx.app.errors import BadInput
from galinx.app.scene.scene import Scene
from galinx.solvers.profiles.flat import Flat
from galinx.solvers.transient.admittance import InPlane

#: Tolerances that can be reached.
_TIGHTEST, _COARSEST = 1e-5, 1e-2


def check_in_time(scene: Scene, methods: tuple[str, ...]) -> None:
    """Refuse scenes whose motions are not known.

    Args:
        scene: the scene.
        methods: those of its methods that follow motions in time.

    Raises:
        BadInput: it says why.
    """
    solid, tolerance = scene.solid, scene.solve.tolerance
    faults = []
    if not methods:
        faults.append("solve.methods has neither fem nor sie, which follow a start from rest")
    if not _TIGHTEST <= tolerance <= _COARSEST:
        faults.append(
            f"solve.tolerance: found {tolerance:g}, expected {_TIGHTEST:g} to {_COARSEST:g}, as in 1e-3"
        )
    if not isinstance(solid.response(0.0), InPlane):
        faults.append("a start from rest is known of uniform solids, without layers")
    elif solid.nearly_incompressible:
        faults.append("a start from rest is known where ν is not near 1/2: pressure waves are too fast")
    if not isinstance(scene.punch.profile, Flat):
        faults.append("a start from rest is known of flat punches")
    if scene.time and scene.time.by_law and any(leg.speed is not None or leg.rest for leg in scene.legs):
        faults.append("strokes with a speed or a rest of their own are not followed in time")
    if scene.solve.mode != "contact":
        faults.append('a start from rest needs solve.mode = "contact"')
    if faults:
        raise BadInput("time: " + "; ".join(faults))
