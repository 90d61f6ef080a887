"""Flutter threshold of a scene's solids: of layers over the wavelength, of a solid with axes over their
angle, of two elastic bodies over the speed of the plate."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from galinx.postprocess.quantities.states import RATIO
from galinx.postprocess.quantities.validity import SIGNS
from galinx.solvers.layers.flutter import thresholds_by_length
from galinx.solvers.solids import Solid

from ..errors import BadInput
from ..scene.scene import Scene
from .choice import Archive, Drawing
from .render import JOINED, Curve, Panel, Size, note, render
from .style import COLUMN, GREY, Look, looks

#: Wavelengths over the thickness of all layers, angles [°], and speeds over the limit.
_LENGTHS, _ANGLES, _SPEEDS = np.geomspace(1.0, 100.0, 17), np.linspace(-90.0, 90.0, 37), 25


def has_flutter(of: Archive) -> bool:
    """True where the threshold depends on wavelength, angle or speed."""
    scene = of.scene
    return bool(scene.layers or scene.elastic_punch or hasattr(scene.half_plane.solid, "angle"))


def flutter(of: Archive) -> Drawing:
    """Figure of the threshold by the sign of σ_XY/σ_YY, and the largest friction of the archive.

    Raises:
        BadInput: a layer is graded.
    """
    x, values, label, words = _thresholds(of.scene)
    shown = np.where(np.isinf(values), np.nan, values)
    alike = np.allclose(shown[0], shown[1], rtol=1e-6, equal_nan=True)
    names = (
        ("either sign",) if alike else tuple(rf"$\sigma_{{XY}}/\sigma_{{YY}}$ {sign}" for sign in SIGNS)
    )
    curves = [Curve(x, y, look, name, JOINED) for y, name, look in zip(shown, names, looks(len(names)))]
    g = float(np.abs(of.data[RATIO.path]).max())
    most = max(1.1 * g, float(np.nanmax(shown, initial=0.0)) * 1.05)
    panel = Panel(
        label, r"flutter threshold of $|\sigma_{XY}/\sigma_{YY}|$", curves=curves, at_y=(g,),
        ylim=(0.0, most), log="x" * bool(of.scene.layers), xlim=(x[0], x[-1]),
    )  # fmt: skip
    notes = [note(Look(GREY, "-", ""), f"this archive: at most {g:.3g}", width=0.4)]
    caption = (
        f"Least |σ_XY/σ_YY| from which on waves along the interface grow, {words}; no curve where none "
        f"grow. The grey line is the largest |σ_XY/σ_YY| of the states, {g:.3g}."
    )
    return Drawing("flutter", caption, render([panel], of.size or Size(COLUMN), notes=notes, high=0.72))


def _thresholds(scene: Scene) -> tuple[NDArray, NDArray, str, str]:
    """Numbers x, thresholds of both signs, (2, n), the name of x, and what the thresholds are over."""
    solid: Solid = scene.solid
    if scene.layers:
        length = _LENGTHS * float(solid.depths[-1])
        try:
            values = thresholds_by_length(solid, length)
        except ValueError as error:
            raise BadInput(f"flutter: {error}") from error
        own = ", ".join(f"{g:.3g}" for g in dict.fromkeys(solid.flutter()))
        words = (
            "over the length of the waves. Those much shorter than the layers grow without bound from "
            f"the threshold of the uppermost solid on, {own}; echoes of the interfaces let others grow "
            "at less friction, at a bounded rate"
        )
        return _LENGTHS, values, "wavelength over thickness of the layers", words
    if scene.elastic_punch:
        c = np.linspace(0.0, 0.99 * solid.limit(), _SPEEDS)
        values = np.array([solid.flutter(speed) for speed in c.tolist()]).T
        return c, values, "speed of the plate $c = V/c_s$", "over the speed of the plate"
    plate: Solid = scene.half_plane.solid
    each = [replace(plate, angle=angle).flutter() for angle in _ANGLES.tolist()]  # type: ignore[type-var]
    return _ANGLES, np.array(each).T, "angle from X to the axis (°)", "over the angle of the solid"
