"""Which figures an archive and the study have, and what is on each."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from galinx.app.plan.plan import INSIDE, make_plan
from galinx.app.scene.scene import Scene
from galinx.app.study.published import REFERENCE
from galinx.meshes.halfplane import MESHES, edges
from galinx.postprocess.figures.canvas import COLOURS
from galinx.postprocess.figures.lines import degrees_figure
from galinx.postprocess.figures.loops import Loop, loops_figure
from galinx.postprocess.figures.maps import Row, maps_figure
from galinx.postprocess.figures.mesh import mesh_figure
from galinx.postprocess.figures.surface import Column, surface_figure
from galinx.postprocess.stresses import maximum_shear, von_mises, σ_ZZ
from galinx.solvers.friction.dahl import Dahl
from galinx.solvers.friction.strokes import friction_along

#: What tells states apart, slowest first, and how a legend says it.
_PARAMETERS = {
    "c": "$c$ = {:g}",
    "mu_c": r"$\mu_C$ = {:g}",
    "sigma0_over_load": r"$\sigma_0 l/N$ = {:g}/m",
    "delta": r"$\delta_D$ = {:g}",
    "X_over_L": "$X/L$ = {:g}",
    "motion": "{}",
}
_LAW = ("mu_c", "sigma0_over_load", "delta")

#: Positions on a stroke at which loops are drawn.
_FINE = np.linspace(0.0, 1.0, 101)

#: More curves than this in one column are no figure.
_CURVES, _COLUMNS = len(COLOURS), 4


@dataclass(frozen=True)
class Drawing:
    """A figure with a name for files, a caption, and whether a page should hold it as pixels."""

    name: str
    caption: str
    figure: Figure
    pixels: bool = False


def of_archive(data: dict[str, Any], scene: Scene) -> Iterator[Drawing]:
    """Every figure that an archive's data allow, one after the other."""
    loops = _Loops(data, scene)
    yield Drawing("friction", "Friction along the strokes.", loops_figure([("", loops.distinct())]))
    if "surface/X_over_a" in data:
        yield _surface(data, loops)
    if "interior/map" in data:
        yield inside(data, scene)
    if "run/fem/change_by_degree" in data:
        yield _degrees(data)
    if "run/fem/degree" in data:
        yield mesh(scene)


def mesh(scene: Scene) -> Drawing:
    """The mesh that a scene's finite elements use; it is laid out again, nothing is solved."""
    kind = MESHES[scene.solve.mesh]
    plan = make_plan(scene)
    assert plan.refinement
    lines = edges(kind, kind.build(plan.refinement, plan.cuts))
    caption = (
        f"The {scene.solve.mesh} mesh under the punch (thick) and, nearer and nearer, its edge X = a."
    )
    return Drawing("mesh", caption, mesh_figure(lines))


class _Loops:
    """Friction loops of an archive's states; states with the same parameters share theirs."""

    def __init__(self, data: dict[str, Any], scene: Scene) -> None:
        self._data, self._scene = data, scene
        self._known: dict[tuple[float, ...], Loop] = {}
        self._varied = _varied(data, np.arange(len(data["states/f"])))

    def of(self, state: int) -> Loop:
        law = tuple(float(self._data[f"states/{name}"][state]) for name in _LAW)
        if law not in self._known:
            strokes = friction_along(
                Dahl(*law), self._scene.motion.strokes, self._scene.friction.pre_sliding, _FINE
            )
            label = _label(self._data, state, [name for name in _LAW if name in self._varied])
            X, f = (
                np.concatenate([getattr(stroke, name) for stroke in strokes])
                for name in ("X_over_L", "f")
            )
            self._known[law] = Loop(label or "Dahl's law", X, f)
        return self._known[law]

    def distinct(self) -> list[Loop]:
        laws = np.column_stack([self._data[f"states/{name}"] for name in _LAW])
        _, first = np.unique(laws, axis=0, return_index=True)
        return [self.of(state) for state in first[:_CURVES].tolist()]


def _varied(data: dict[str, Any], states: NDArray) -> list[str]:
    """Parameters that differ between some states."""
    return [name for name in _PARAMETERS if len(np.unique(data[f"states/{name}"][states])) > 1]


def _label(data: dict[str, Any], state: int, names: Sequence[str]) -> str:
    return ", ".join(_PARAMETERS[name].format(data[f"states/{name}"][state]) for name in names)


def _surface(data: dict[str, Any], loops: _Loops) -> Drawing:
    """A column for each speed, or else for each value of what varies most slowly."""
    everything = np.arange(len(data["states/f"]))
    varied = _varied(data, everything)
    by = varied[0] if len(varied) > 1 or "c" in varied else None
    groups = (
        [np.flatnonzero(data[f"states/{by}"] == value) for value in np.unique(data[f"states/{by}"])]
        if by
        else [everything]
    )
    columns, hidden = [], 0
    for states in groups[:_COLUMNS]:
        shown = states[:_CURVES].tolist()
        hidden += len(states) - len(shown)
        names = [name for name in varied if name != by]
        title = _label(data, shown[0], [by] if by else [])
        labels = [_label(data, i, names) or "the state" for i in shown]
        columns.append(Column(title, shown, labels, [loops.of(i) for i in shown]))
    hidden += sum(map(len, groups[_COLUMNS:]))
    caption = (
        "Contact stress and in-plane stress along the surface, and where on its loop each curve sits."
    )
    if hidden:
        caption += f" {hidden} more states are in the archive."
    return Drawing("surface", caption, surface_figure(data, columns))


def inside(data: dict[str, Any], scene: Scene) -> Drawing:
    """Stresses inside at the slowest and the fastest speed: both methods and their difference."""
    shape = tuple(data["interior/map"].tolist())
    X, Y = (data[f"interior/{name}_over_a"][: np.prod(shape)].reshape(shape) for name in ("X", "Y"))
    speeds = np.unique(data["states/c"])
    rows = []
    for c in speeds[[0, -1]] if len(speeds) > 1 else speeds:
        state = int(np.argmax(data["states/c"] == c))
        found = {
            label: _quantities(data, scene, method, state, shape)
            for label, method in (("closed form", "closed_form"), ("finite elements", "fem"))
            if f"interior/{method}/sigma_XX" in data
        }
        scale = next(iter(found.values()))
        rows += [Row(f"c = {c:g}\n{label}", values, scale) for label, values in found.items()]
        if len(found) == 2:
            exact, fem = found.values()
            rows.append(Row(f"c = {c:g}\ndifference", fem - exact, scale, difference=True))
    caption = (
        "Stresses inside below the punch (black bar): "
        f"{_label(data, 0, ['motion', 'X_over_L', *_LAW])}; the rows of a speed share their colours."
    )
    return Drawing("inside", caption, maps_figure(X[0], Y[:, 0], rows), pixels=True)


def _quantities(
    data: dict[str, Any], scene: Scene, method: str, state: int, shape: tuple[int, ...]
) -> NDArray[np.float64]:
    XX, YY, XY = (
        data[f"interior/{method}/sigma_{ij}"][state, : np.prod(shape)].reshape(shape) for ij in INSIDE
    )
    ZZ = σ_ZZ(scene.solid.nu, scene.solid.plane, XX, YY)
    return np.array([XX, YY, XY, von_mises(XX, YY, XY, ZZ), maximum_shear(XX, YY, XY)])


def _degrees(data: dict[str, Any]) -> Drawing:
    c, c_of = data["run/fem/c"], data["states/c"]

    def largest(name: str) -> NDArray:
        return np.array([data[name][c_of == speed].max() for speed in c])

    known = "states/fem/true_error" in data
    figure = degrees_figure(
        c,
        data["run/fem/change_by_degree"],
        data["run/fem/degree"],
        largest("states/fem/estimate"),
        largest("states/fem/true_error") if known else None,
    )
    return Drawing("degrees", "How the numbers settle as the polynomial degree rises.", figure)


#: The study's two speeds.
SLOW, FAST = 4.786e-7, 0.6


def of_study(data: dict[str, Any], scene: Scene) -> Iterator[Drawing]:
    """Figs 2 and 5-10 of the study from an archive of scenes/study.toml."""
    loops = _Loops(data, scene)
    reference = _first(data, **REFERENCE)
    yield Drawing(
        "fig2", "Fig 2. The friction loop.", loops_figure([("Dahl's law", [loops.of(reference)])])
    )
    yield _slow_or_fast("fig5", "Fig 5. Slow sliding", data, loops, SLOW)
    panels = []
    for name in _LAW:
        at = [_first(data, **(REFERENCE | {name: value})) for value in np.unique(data[f"states/{name}"])]
        panels.append(("", [_named(loops.of(i), _label(data, i, [name])) for i in at]))
    yield Drawing("fig6", "Fig 6. What the parameters do to the loop.", loops_figure(panels))
    yield _slow_or_fast("fig7", "Fig 7. Fast sliding", data, loops, FAST)
    for figure, name in zip(("fig8", "fig9", "fig10"), _LAW):
        columns = []
        for c in (SLOW, FAST):
            states = [
                _first(data, c=c, motion="FM1", X_over_L=0.8, **(REFERENCE | {name: value}))
                for value in np.unique(data[f"states/{name}"])
            ]
            columns.append(
                Column(
                    f"FM1, X/L = 0.8, c = {c:g}",
                    states,
                    [_label(data, i, [name]) for i in states],
                    [loops.of(i) for i in states],
                )
            )
        caption = f"Fig {figure[3:]}. What {_PARAMETERS[name].split(' =')[0]} does, slow and fast."
        yield Drawing(figure, caption.replace("$", ""), surface_figure(data, columns))


def _slow_or_fast(name: str, caption: str, data: dict[str, Any], loops: _Loops, c: float) -> Drawing:
    columns = []
    for X in np.unique(data["states/X_over_L"]):
        states = [_first(data, c=c, X_over_L=X, motion=m, **REFERENCE) for m in ("FM1", "BM1", "FM2")]
        labels = [str(data["states/motion"][i]) for i in states]
        columns.append(Column(f"c = {c:g}, X/L = {X:g}", states, labels, [loops.of(i) for i in states]))
    return Drawing(name, f"{caption}, at two places of three strokes.", surface_figure(data, columns))


def _named(loop: Loop, label: str) -> Loop:
    return Loop(label, loop.X_over_L, loop.f)


def _first(data: dict[str, Any], **values: Any) -> int:
    """The first state whose named parameters have the given values."""
    matches = np.all([data[f"states/{key}"] == value for key, value in values.items()], axis=0)
    return int(np.flatnonzero(matches)[0])
