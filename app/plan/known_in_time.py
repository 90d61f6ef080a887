"""Of which scenes motions in time are known."""

from galinx.app.errors import BadInput
from galinx.app.scene.scene import Scene
from galinx.solvers.layers.layered import Layered
from galinx.solvers.profiles.flat import Flat
from galinx.solvers.transient.admittance import InPlane

#: Tolerances that can be reached.
_TIGHTEST, _COARSEST = 1e-5, 1e-2
#: Least thickness of a layer over a.
_THINNEST = 0.1


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
    if isinstance(solid, Layered):
        faults += _of_layers(scene, solid)
    elif not isinstance(solid.response(0.0), InPlane):
        faults.append("a start from rest is known of galinx's own solids, not of your own")
    if solid.nearly_incompressible:
        faults.append("a start from rest is known where ν is not near 1/2: pressure waves are too fast")
    if not isinstance(scene.punch.profile, Flat):
        faults.append("a start from rest is known of flat punches")
    if scene.time and scene.time.by_law and any(leg.speed is not None or leg.rest for leg in scene.legs):
        faults.append("strokes with a speed or a rest of their own are not followed in time")
    if scene.solve.mode != "contact":
        faults.append('a start from rest needs solve.mode = "contact"')
    if faults:
        raise BadInput("time: " + "; ".join(faults))


def _of_layers(scene: Scene, solid: Layered) -> list[str]:
    """What of layers is not known."""
    faults = []
    if any(layer.bottom for layer in solid.layers):
        faults.append("layers: found a graded one, expected uniform ones for motions in time")
    thinnest = min(layer.thickness for layer in solid.layers) / scene.body.half_width
    if thinnest < _THINNEST:
        faults.append(
            f"layers: found a thickness of {thinnest:.4g} a, expected at least {_THINNEST:g} a, the "
            "punch's half-width, for motions in time"
        )
    if not all(isinstance(one.response(0.0), InPlane) for one in solid.solids):
        faults.append("layers: found a solid of your own, expected galinx's for motions in time")
    if scene.time and scene.time.steady:
        faults.append('time.start: found "steady" over layers, expected "rest"')
    return faults
