"""Maps of stresses inside of some of an archive's states."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from galinx.app.pictures.choice import Choice, one_of
from galinx.app.pictures.drawing import Drawing, by_method, there
from galinx.app.pictures.told import C, Told, not_shown
from galinx.app.scene.scene import Scene
from galinx.postprocess.figures.maps import Map, maps_figure
from galinx.postprocess.figures.style import COLUMN, PAGE
from galinx.postprocess.figures.typeset import folded, number, plain
from galinx.postprocess.quantities import strata as layers
from galinx.postprocess.quantities import stresses
from galinx.postprocess.quantities.quantity import INSIDE, METHODS, STATE
from galinx.postprocess.stresses import maximum_shear, von_mises
from galinx.solvers.layers.layered import Layered

#: Name and symbol of what maps show unasked.
_SHOWN = {
    "sigma_XX": ("in-plane stress", r"\sigma_{XX}"),
    "sigma_YY": ("normal stress", r"\sigma_{YY}"),
    "sigma_XY": ("shear stress", r"\sigma_{XY}"),
    "von_mises": ("von Mises", r"\sigma_{\mathrm{vM}}"),
    "max_shear": ("largest shear", r"\tau_{\mathrm{max}}"),
}
#: Columns of states on a page, and the least width for one with its difference [in].
_STATES, _LEAST = 2, 1.6


class Fields:
    """Stresses inside on the grid of an archive.

    Args:
        data, scene: the archive's.
        choice: what is wanted.
    """

    def __init__(self, data: dict[str, Any], scene: Scene, choice: Choice) -> None:
        self._data, self._scene, self._choice = data, scene, choice
        method = choice.method
        self._shape = tuple(data[stresses.MAP.path].tolist())
        self._known = by_method(data, (STATE, INSIDE), method)
        self.methods = [name for name in METHODS if any(name in rows for rows in self._known.values())]

    @property
    def names(self) -> list[str]:
        """Of all there is."""
        return list(
            dict.fromkeys([*self._known, *(name for name in _SHOWN if self._of_components(name))])
        )

    @property
    def interfaces(self) -> tuple[float, ...]:
        """Depths over a of the lower faces of layers."""
        body, solid = self._scene.body, self._scene.solid
        if body.found:  # over every state's own half-width they are elsewhere
            return ()
        return tuple((solid.depths / body.half_width).tolist()) if isinstance(solid, Layered) else ()

    def grid(self) -> tuple[NDArray, NDArray]:
        """Positions over a along both axes."""
        X, Y = (self._on_grid(self._data[row.path]) for row in (stresses.INSIDE_X, stresses.INSIDE_Y))
        return X[0], Y[:, 0]

    def values(self, name: str, method: str, state: int) -> NDArray:
        """One quantity of a state, (rows, columns)."""
        if name in self._known:
            row = self._known[name][method]
            return self._choice.scale_of(row, state) * self._on_grid(self._data[row.path][state])
        XX, YY, XY = (
            self._choice.scale_of(row, state) * self._on_grid(self._data[row.path][state])
            for row in (stresses.STRESSES_INSIDE | layers.STRESSES_INSIDE)[method]
        )
        if name == "max_shear":
            return maximum_shear(XX, YY, XY)
        return von_mises(XX, YY, XY, self._scene.solid.σ_ZZ(XX, YY, XY))

    def label(self, name: str, alone: bool) -> str:
        """Of its colours."""
        if name not in _SHOWN:
            return self._choice.called(next(iter(self._known[name].values())))
        called, symbol = _SHOWN[name]
        return self._choice.label(called, symbol, " " if alone else "\n")

    def _of_components(self, name: str) -> bool:
        return (
            name not in self._known and len({"sigma_XX", "sigma_YY", "sigma_XY"} & set(self._known)) == 3
        )

    def _on_grid(self, values: NDArray) -> NDArray:
        return values[: np.prod(self._shape)].reshape(self._shape)


def has_map(data: dict[str, Any], method: str = "") -> bool:
    """Does an archive hold a map of stresses?"""
    return there(data, stresses.MAP) and bool(by_method(data, (STATE, INSIDE), method))


def inside(data: dict[str, Any], scene: Scene, choice: Choice) -> Drawing:
    """Stresses inside at the slowest and the fastest speed, and how far both methods are apart."""
    fields, told = Fields(data, scene, choice), Told(data, scene)
    X, Y = fields.grid()
    names = [one_of("quantity", name, fields.names) for name in choice.quantities]
    names = names or [name for name in _SHOWN if name in fields.names]
    some = list(choice.states) or _states(told)
    alone = len(names) == len(some) == 1
    apart = told.varied(some) or ([C] if C in told.varied() or alone else [])
    width = choice.size.width if choice.size else COLUMN if len(some) == 1 else PAGE
    shown, differences = _maps(fields, names, some)
    largest = max((float(np.abs(off).max()) for off in differences), default=0.0)
    columns = 2 * len(some)
    if len(names) == 1 or width < columns * _LEAST:
        differences, columns = [], len(some)
    titles = [folded(told.label(i, apart), int((width - 1.0) / columns / 0.062)) for i in some]
    figure = maps_figure(X, Y, shown, titles, differences, choice.size, choice.frames(some))
    caption = _caption(told, some, fields, largest)
    how = f"--figure inside --states{'' if alone else ', single maps with --quantity'}"
    return Drawing("inside", caption, figure, True, not_shown(told, some, how, choice.states))


def _maps(fields: Fields, names: list[str], some: list[int]) -> tuple[list[Map], list[NDArray]]:
    """What is mapped, and where both methods are known their differences over the largest values."""
    shown, differences = [], []
    for name in names:
        values, *others = (
            np.array([fields.values(name, method, i) for i in some]) for method in fields.methods
        )
        label = fields.label(name, len(names) == 1)
        shown.append(Map(label, values, bool(values.min() < 0.0), fields.interfaces))
        differences += [(other - values) / np.abs(values).max() for other in others]
    return shown, differences


def _caption(told: Told, some: list[int], fields: Fields, largest: float) -> str:
    fixed = [name for name in told.parameters if name not in told.varied(some)]
    method = METHODS[fields.methods[0]]
    text = (
        f"Stresses inside below the punch (black bar), {method}, at {told.text(some[0], fixed)}. They "
        "spread from the edges; beyond an arrow at the end of a bar its colours are clipped."
    )
    if fields.interfaces:
        text += " Dashed lines are the interfaces."
    if largest:
        text += (
            f" Finite elements differ by at most {plain(f'${number(largest, 2)}$')} of the largest value."
        )
    return text


def _states(told: Told) -> list[int]:
    """The first and the last of what varies most slowly, others at one of their values."""
    varied = told.varied()
    some = told.where(told.all, **told.fixed(varied[1:], told.all))
    return sorted({int(some[0]), int(some[-1])})[:_STATES]
