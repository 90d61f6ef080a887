"""Waves of a scene: the slowest ones along its layers, those that a punch sends out under loads that
oscillate, and those that grow along a sliding interface.

The slowest waves are described by their speed over the wavenumber, the punch by its dynamic stiffness
over the frequency of the load, flutter by its threshold: of layers over the wavelength, of a solid with
axes over their angle, of two elastic bodies over the speed of the plate.
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.meshes import MESHES
from galinx.postprocess.quantities.states import RATIO
from galinx.postprocess.quantities.validity import SIGNS
from galinx.solvers.layers.flutter import thresholds_by_length
from galinx.solvers.layers.layered import dispersion
from galinx.solvers.profiles.punches import is_level
from galinx.solvers.solids import Solid
from galinx.solvers.transient.harmonic import OscillatingPunch, Oscillation, highest
from galinx.texts import plain

from ..errors import BadInput
from ..plan.states import enumerate_states, headings
from ..scene.scene import Scene
from .choice import Archive, Drawing, drive_label, fewer, spread
from .render import JOINED, MARKERS, Curve, Panel, Size, note, render
from .style import COLUMN, GREY, Look, looks

#: Wavenumbers times the thickness of all layers; fewer where a layer is graded.
_kH, _FEWER = np.geomspace(0.03, 100.0, 61), 4


def _require_one(command: str, scene: Scene) -> None:
    """Raise BadInput for swept numbers, of which these answers would know the first alone."""
    if scene.variants:
        keys = ", ".join(scene.swept)
        raise BadInput(
            f"{command}: found several values of {keys}, expected one of each; choose by --set"
        )


def slowest_waves(scene: Scene) -> tuple[list[str], list[str], Drawing]:
    """Speed of the slowest wave along a scene's layers over its wavenumber: table, notes and figure.

    Raises:
        BadInput: it has none.
    """
    _require_one("dispersion", scene)
    solid: Any = scene.solid
    c_s, limit = solid.c_s, solid.limit() * solid.c_s
    if not scene.layers:
        raise BadInput(
            "layer: found no layers; along a uniform solid waves of all lengths run alike, at "
            f"{limit:.6g} m/s"
        )
    graded = any(layer.bottom for layer in solid.layers)
    kH, H = _kH[:: _FEWER if graded else 1], float(solid.depths[-1])

    def stack(c: float) -> Any:
        return solid.response(c).stack(H, 1e-8)

    # NaN where no wave is slower than the waves inside the solids.
    speed, length = c_s * dispersion(stack, 1.0, kH, accuracy=1e-7), 2.0 * np.pi * H / kH
    lines = ["kH (1)     wavelength (m)  speed (m/s)"]
    # Short waves that all leak are one line.
    shown = int(np.flatnonzero(np.isfinite(speed)).max(initial=-1)) + 2
    lines += [
        f"{x:<10.4g} {of:<15.6g} {'none' if np.isnan(v) else f'{v:.6g}'}"
        for x, of, v in zip(kH[:shown], length, speed)
    ]
    if shown < len(kH):
        lines.append(f"{f'to {kH[-1]:.4g}':<10} {f'to {length[-1]:.6g}':<15} none")
    notes = ["k is the wavenumber, H the thickness of all layers"]
    if np.isnan(speed).any():
        notes.append(
            "none: no wave of that length is slower than the waves inside all solids; one that is "
            "faster than those inside a layer, as a wave guided by it, is no limit of the punch"
        )
    notes.append(f"highest speed of a punch: {limit:.8g} m/s")
    # Waves along the substrate, and along the surface's solid.
    ends = np.array([solid.substrate.limit() * solid.substrate.c_s, solid.surface.limit() * c_s])
    look, places = looks(1)[0], kH[[0, -1]]
    highest = look._replace(colour=GREY, line="--")
    curves = [
        Curve(kH, speed, look, "slowest wave"),
        Curve(places, np.full(2, limit), highest, "highest speed of a punch", width=0.7),
        Curve(places, ends, look, "along either end's solid alone", MARKERS),
    ]
    panel = Panel(
        "wavenumber $kH$", "speed (m/s)", curves=curves, log="x", xlim=(places[0] / 1.1, places[1] * 1.1)
    )
    caption = (
        "Speed of the slowest wave along the layers over its wavenumber k times the thickness H of all "
        f"layers. The dashed line is the highest speed of a punch, {limit:.6g} m/s; circles are "
        "the waves along the substrate alone (left) and along the solid of the surface (right). Where "
        "there is no curve no such wave is slower than the waves inside one of the solids."
    )
    return lines, notes, Drawing("dispersion", caption, render([panel], Size(COLUMN), high=0.72))


#: Speeds with frictions that are solved at most, and curves that can be distinguished.
MOST, _CURVES = 24, 6


@dataclass(frozen=True)
class Answer:
    """Dynamic stiffness of a punch at a speed with a friction.

    Attributes:
        c: speed over c_s.
        g: σ_XY/σ_YY under the punch.
        way: ±1, in which it goes along X, 0 at rest.
        oscillation: dynamic stiffness over frequency.
        plane_waves: limit of the stiffness over iω at high frequencies, over 2μ a/c_s.
    """

    c: float
    g: float
    way: int
    oscillation: Oscillation
    plane_waves: float

    @property
    def words(self) -> str:
        """Speed, friction and way of the motion, as one line."""
        return plain(drive_label(self.c, self.g, self.way))


def answers(scene: Scene, first: float, last: float | None, count: int) -> list[Answer]:
    """Dynamic stiffness of a scene's punch at all its speeds and frictions.

    Args:
        scene: the scene.
        first, last: angular frequencies over c_s/a; None: the highest computable, at most 10.
        count: number of frequencies, evenly spaced in their logarithm.

    Raises:
        BadInput: there is no answer.
    """
    _require_one("response", scene)
    solid = scene.solid
    if scene.layers or solid.nearly_incompressible:
        cause = "layers" if scene.layers else "ν near 1/2"
        raise BadInput(f"response: found {cause}, expected a uniform solid that waves pass")
    if not is_level(scene.punch.profile):
        raise BadInput(f"response: found a {scene.punch.profile.words()}, expected a level flat punch")
    if scene.elastic_punch or scene.along or scene.solve.own_pressure:
        raise BadInput(
            "response: found an elastic punch, a prescribed pressure, or friction that varies along the "
            "contact, expected a rigid punch with one friction"
        )
    if MESHES[scene.solve.mesh].walls:
        raise BadInput(f'response: found solve.mesh = "{scene.solve.mesh}", expected no walls')
    states = enumerate_states(scene)
    ways = headings(scene, states.directions) * (states.columns["c"] > 0.0)
    different = np.unique(np.column_stack([states.columns["c"], ways, states.g]), axis=0)
    limit, c = solid.limit(), np.unique(different[:, 0]).tolist()
    if len(different) > MOST:
        raise BadInput(f"response: found {len(different)} speeds with frictions, expected at most {MOST}")
    if max(c) >= limit:
        raise BadInput(f"response: c = {max(c):g} is not below the Rayleigh speed {limit:.6g} (over c_s)")
    if last is None:
        last = min(10.0, *(highest(solid.response(speed), limit) for speed in c))
    if not first < last:
        raise BadInput(
            f"response: found frequencies from {first:g} to {last:g} c_s/a, expected them to grow"
        )
    ω, computed = np.geomspace(first, last, count), []
    for speed, way in np.unique(different[:, :2], axis=0).tolist():
        try:
            punch = OscillatingPunch(solid.response(speed), limit, ω, int(way) or 1)
        except ValueError as error:
            raise BadInput(f"response: {error}") from error
        frictions = different[(different[:, :2] == (speed, way)).all(axis=1), 2].tolist()
        computed += [
            Answer(speed, g, int(way), punch.oscillation(g), punch.plane_waves(g)) for g in frictions
        ]
    return computed


def table(scene: Scene, answer: Answer) -> list[str]:
    """Lines of a table of the dynamic stiffness in SI units."""
    oscillation, μ = answer.oscillation, scene.solid.μ
    hertz = oscillation.ω * scene.solid.c_s / (2.0 * np.pi * scene.punch.profile.half_width)  # type: ignore[attr-defined]
    lines = ["ω (c_s/a)  frequency (Hz)  Re N/v0 (Pa)  Im N/v0 (Pa)  |v0/N| (1/Pa)  phase (°)"]
    for ω, f, K in zip(oscillation.ω, hertz, 2.0 * μ * oscillation.stiffness):
        lag = -np.angle(K, deg=True)
        lines.append(
            f"{ω:<10.4g} {f:<15.6g} {K.real:<13.6g} {K.imag:<13.6g} {1.0 / abs(K):<14.6g} {lag:.2f}"
        )
    lines.append("per depth; the phase is that of v0")
    return [*lines, f"largest relative error, measured: {oscillation.error.max():.1e}"]


def response_drawing(computed: list[Answer]) -> Drawing:
    """Figure of stiffness and damping over frequency."""
    shown = spread(computed, _CURVES)
    panels, labels = list[Panel](), (
        r"stiffness $\mathrm{Re}\,(\hat N/\hat v_0)/2\mu$",
        r"damping $\mathrm{Im}\,(\hat N/\hat v_0)/2\mu\;/\;(\omega a/c_s)$",
    )  # fmt: skip
    for n, label in enumerate(labels):
        curves, styles = [], looks(len(shown))
        for answer, look in zip(shown, styles):
            K, ω = answer.oscillation.stiffness, answer.oscillation.ω
            name = drive_label(answer.c, answer.g, answer.way)
            curves.append(Curve(ω, (K.real, K.imag / ω)[n], look, name))
            if n == 1:
                far = np.full(2, answer.plane_waves)
                curves.append(Curve(ω[[0, -1]], far, look._replace(line="--"), width=0.5))
        panels.append(
            Panel(r"frequency $\omega a/c_s$", label, curves=curves, log="x", xlim=(ω[0], ω[-1]))
        )
    caption = (
        "Dynamic stiffness of the punch, N̂/v̂₀ of a load N̂ e^(iωt) about that of steady sliding: its "
        "real part, and its imaginary part over ω, which is what waves carry away. Dashed: plane waves "
        "straight down, to which the latter comes at high frequencies. At low ones the stiffness goes "
        "like 1/log ω: a half-plane has none of its own at rest."
    )
    missing = fewer(len(shown), len(computed), "speeds with frictions", "; choose by --set")
    return Drawing("response", caption, render(panels, high=0.72), left_out=missing)


#: Wavelengths over the thickness of all layers, angles [°], and speeds over the limit.
_LENGTHS, _ANGLES, _SPEEDS = np.geomspace(1.0, 100.0, 33), np.linspace(-90.0, 90.0, 37), 25


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
    same = np.allclose(shown[0], shown[1], rtol=1e-6, equal_nan=True)
    names = (
        ("either sign",) if same else tuple(rf"$\sigma_{{XY}}/\sigma_{{YY}}$ {sign}" for sign in SIGNS)
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
    if of.scene.swept:
        caption += (
            f" Solids are those of the first state; others differ in {' and '.join(of.scene.swept)}."
        )
    return Drawing(
        "flutter", caption, render([panel], of.choice.size or Size(COLUMN), notes=notes, high=0.72)
    )


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
            "at less friction, at a bounded rate. Waves to and fro across the layers count up to 16 "
            "wavelengths in their thickness"
        )
        return _LENGTHS, values, "wavelength over thickness of the layers", words
    if scene.elastic_punch:
        c = np.linspace(0.0, 0.99 * solid.limit(), _SPEEDS)
        ways = headings(scene, scene.legs[0].s, c)
        values = np.array([solid.flutter(speed) for speed in np.copysign(c, ways).tolist()]).T
        words = f"over the speed of the plate, the punch moving to {'+' if ways[-1] > 0 else '-'}X"
        if ways[0] != ways[-1]:
            words += ", but in the other direction where its own solid is faster than the plate"
        return c, values, "speed of the plate $c = V/c_s$", words
    plate: Solid = scene.half_plane.solid
    each = [replace(plate, angle=angle).flutter() for angle in _ANGLES.tolist()]  # type: ignore[type-var]
    return _ANGLES, np.array(each).T, "angle from X to the axis (°)", "over the angle of the solid"
