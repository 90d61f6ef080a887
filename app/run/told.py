"""What every archive tells of its scene, in SI."""

import json
from typing import Any

from galinx.app.scene.scene import Scene
from galinx.solvers.parameters import values
from galinx.solvers.solids import SOLIDS, Solid


def of_scene(scene: Scene) -> dict[str, Any]:
    """Attributes of an archive's root that say what slides over what."""
    half_plane, solid = scene.half_plane, scene.solid
    known = _solid(half_plane.solid)
    if half_plane.yield_strength:
        known["yield_strength"] = half_plane.yield_strength
    if scene.layers:
        known |= {f"layer {i}": layer.words() for i, layer in enumerate(scene.layers, 1)}
    return {
        "title": scene.title,
        "material": half_plane.material or "",
        "solid": json.dumps(known, ensure_ascii=False),
        "half_width": scene.body.half_width,
        "load": scene.punch.load,
        "c_s": solid.c_s,
        "speed_limit": solid.limit() * solid.c_s,
    }


def _solid(solid: Solid) -> dict[str, Any]:
    kind = next((name for name, known in SOLIDS.items() if known is type(solid)), "")
    return {"kind": kind, **values(solid)}
