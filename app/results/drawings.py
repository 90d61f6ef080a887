"""Which figures an archive has, and what is on each: all is read from it, nothing computed again."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from galinx.app.plan.plan import make_plan
from galinx.app.scene.scene import Scene
from galinx.meshes.cells import edges
from galinx.postprocess.figures.canvas import COLOURS
from galinx.postprocess.figures.lines import degrees_figure
from galinx.postprocess.figures.loops import Loop, loops_figure
from galinx.postprocess.figures.maps import Row, maps_figure
from galinx.postprocess.figures.mesh import mesh_figure
from galinx.postprocess.figures.surface import Column, surface_figure
from galinx.postprocess.named import parameters
from galinx.postprocess.quantities import Quantity, column, runs, states, stresses
from galinx.postprocess.quantities.quantity import CLOSED_FORM, FEM
from galinx.postprocess.stresses import maximum_shear, von_mises

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
    loops = Loops(data)
    yield Drawing("friction", "Friction along the strokes.", loops_figure([("", loops.distinct())]))
    surface = (stresses.PRESSURE, stresses.IN_PLANE)
    if all(any(there(data, row) for row in rows.values()) for rows in surface):
        yield _surface(data, loops)
    if there(data, stresses.MAP) and _methods_inside(data):
        yield inside(data, scene)
    if there(data, runs.CHANGES, runs.RECORD["c"], runs.RECORD["degree"], states.ESTIMATE):
        yield _degrees(data)
    if make_plan(scene).fem:
        yield mesh(scene)


def there(data: dict[str, Any], *rows: Quantity) -> bool:
    """Does an archive hold all of these?"""
    return all(row.path in data for row in rows)


def _methods_inside(data: dict[str, Any]) -> dict[str, str]:
    """Methods whose stresses inside an archive holds, by what they are called."""
    known = (("closed form", CLOSED_FORM), ("finite elements", FEM))
    return {label: name for label, name in known if there(data, *stresses.STRESSES_INSIDE[name])}


def mesh(scene: Scene) -> Drawing:
    """The mesh that a scene's finite elements use; it is laid out again, nothing is solved."""
    fem = make_plan(scene).fem
    assert fem
    lines = edges(fem.kind, fem.kind.build(fem.refinement, fem.cuts))
    caption = f"The {fem.mesh} mesh under the punch (thick) and, nearer and nearer, its edge X = a."
    return Drawing("mesh", caption, mesh_figure(lines))


class Told:
    """What tells an archive's states apart, and how a legend says it.

    Args:
        data: the archive's.
    """

    def __init__(self, data: dict[str, Any]) -> None:
        self._data = data
        self.parameters = {path.rpartition("/")[2]: row for path, row in parameters(data).items()}

    @property
    def law(self) -> list[str]:
        """Names of the friction law's parameters."""
        return [name for name in self.parameters if name not in ("c", "motion", "X_over_L")]

    def varied(self, some: NDArray | slice = slice(None)) -> list[str]:
        """Parameters that differ between some states."""
        return [name for name in self.parameters if len(np.unique(self.values(name)[some])) > 1]

    def values(self, name: str) -> NDArray:
        """A parameter of all states."""
        return self._data[column(name)]

    def label(self, state: int, names: Sequence[str]) -> str:
        """Some parameters of a state."""
        return ", ".join(_told(self.parameters[name], self.values(name)[state]) for name in names)


def _told(row: Quantity, value: Any) -> str:
    if isinstance(value, str):
        return value
    return f"${row.symbol}$ = {value:g}{row.unit.removeprefix('1')}"


class Loops:
    """Friction loops of an archive's states; states with the same law share theirs.

    Args:
        data: the archive's.
    """

    def __init__(self, data: dict[str, Any]) -> None:
        self._data, self._told = data, Told(data)
        _, self._first = np.unique(data[runs.LOOP_OF_STATE.path], return_index=True)
        varied = self._told.varied(self._first)
        # The speed tells loops apart only where the law depends on it.
        self._names = [name for name in ("c", *self._told.law) if name in varied]
        self._known: dict[int, Loop] = {}

    def of(self, state: int) -> Loop | None:
        """The loop that a state lies on, None where the archive has too many to hold it."""
        row = int(self._data[runs.LOOP_OF_STATE.path][state])
        if row < 0:
            return None
        if row not in self._known:
            label = self._told.label(state, self._names) or "the law"
            self._known[row] = Loop(
                label, self._data[runs.LOOP_X.path], self._data[runs.LOOP_F.path][row]
            )
        return self._known[row]

    def of_all(self, some: Sequence[int]) -> list[Loop]:
        """The loops of some states, none at all where one is missing."""
        found = [self.of(state) for state in some]
        return [loop for loop in found if loop] if all(found) else []

    def distinct(self) -> list[Loop]:
        """The first loops, of different laws."""
        return [loop for state in self._first.tolist() if (loop := self.of(state))][:_CURVES]


def _surface(data: dict[str, Any], loops: Loops) -> Drawing:
    """A column for each speed, or else for each value of what varies most slowly."""
    everything, told = np.arange(len(data[states.FRICTION.path])), Told(data)
    varied = told.varied()
    by = varied[0] if len(varied) > 1 or "c" in varied else None
    groups = (
        [np.flatnonzero(told.values(by) == value) for value in np.unique(told.values(by))]
        if by
        else [everything]
    )
    columns, hidden = [], 0
    for group in groups[:_COLUMNS]:
        shown = group[:_CURVES].tolist()
        hidden += len(group) - len(shown)
        names = [name for name in varied if name != by]
        title = told.label(shown[0], [by] if by else [])
        labels = [told.label(i, names) or "the state" for i in shown]
        columns.append(Column(title, shown, labels, loops.of_all(shown)))
    hidden += sum(map(len, groups[_COLUMNS:]))
    caption = (
        "Contact stress and in-plane stress along the surface, and where on its loop each curve sits."
    )
    if hidden:
        caption += f" {hidden} more states are in the archive."
    return Drawing("surface", caption, surface_figure(data, columns))


def inside(data: dict[str, Any], scene: Scene) -> Drawing:
    """Stresses inside at the slowest and the fastest speed: both methods and their difference."""
    shape = tuple(data[stresses.MAP.path].tolist())
    X, Y = (
        data[row.path][: np.prod(shape)].reshape(shape) for row in (stresses.INSIDE_X, stresses.INSIDE_Y)
    )
    speeds = np.unique(data[states.SPEED.path])
    rows = []
    for c in speeds[[0, -1]] if len(speeds) > 1 else speeds:
        state = int(np.argmax(data[states.SPEED.path] == c))
        found = {
            label: _components(data, scene, method, state, shape)
            for label, method in _methods_inside(data).items()
        }
        scale = next(iter(found.values()))
        rows += [Row(f"c = {c:g}\n{label}", values, scale) for label, values in found.items()]
        if len(found) == 2:
            exact, fem = found.values()
            rows.append(Row(f"c = {c:g}\ndifference", fem - exact, scale, difference=True))
    told = Told(data)
    caption = (
        "Stresses inside below the punch (black bar): "
        f"{told.label(0, ['motion', 'X_over_L', *told.law])}; the rows of a speed share their colours."
    )
    return Drawing("inside", caption, maps_figure(X[0], Y[:, 0], rows), pixels=True)


def _components(
    data: dict[str, Any], scene: Scene, method: str, state: int, shape: tuple[int, ...]
) -> NDArray[np.float64]:
    XX, YY, XY = (
        data[row.path][state, : np.prod(shape)].reshape(shape) for row in stresses.STRESSES_INSIDE[method]
    )
    ZZ = scene.solid.σ_ZZ(XX, YY, XY)
    return np.array([XX, YY, XY, von_mises(XX, YY, XY, ZZ), maximum_shear(XX, YY, XY)])


def _degrees(data: dict[str, Any]) -> Drawing:
    c, c_of = data[runs.RECORD["c"].path], data[states.SPEED.path]

    def largest(row: Quantity) -> NDArray:
        return np.array([data[row.path][c_of == speed].max() for speed in c])

    figure = degrees_figure(
        c,
        data[runs.CHANGES.path],
        data[runs.RECORD["degree"].path],
        largest(states.ESTIMATE),
        largest(states.TRUE_ERROR) if there(data, states.TRUE_ERROR) else None,
    )
    return Drawing("degrees", "How the numbers settle as the polynomial degree rises.", figure)
