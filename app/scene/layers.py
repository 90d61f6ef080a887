"""Layers of a scene, [[layer]], from the top down."""

from collections.abc import Mapping
from itertools import pairwise
from typing import Any

from galinx.app.scene.excerpt import excerpt
from galinx.app.scene.keys import Key, ModelSection
from galinx.app.scene.materials import LIBRARY
from galinx.app.scene.values import Choice, Number
from galinx.solvers.layers.layered import GRADINGS, Layer
from galinx.solvers.parameters import Range, made
from galinx.solvers.solids import SOLIDS, Isotropic, Solid

#: The most layers of a scene.
MOST = 10
_POSITIVE = Range(above=0.0)


class Constants:
    """Constants of a solid at the lower face, `{ E = 2.5e9, nu = 0.3 }`; the others are as on top."""

    def __call__(self, value: Any) -> dict[str, Any]:
        if not isinstance(value, dict) or not value:
            raise ValueError(f"found {excerpt(value)}, expected constants, as in {{ E = 2.5e9 }}")
        return value

    def schema(self) -> dict[str, Any]:
        return {"type": "object", "minProperties": 1}


class Depths:
    """Rows `[depth, E, nu, rho]` from the upper face, depth 0, downwards; linear between them."""

    units = ("m", "Pa", "", "kg/m^3")

    def __call__(self, value: Any) -> tuple[tuple[float, ...], ...]:
        expected = "at least 2 rows [depth, E, nu, rho], depths rising from 0"
        if not isinstance(value, list) or len(value) < 2:
            raise ValueError(f"found {excerpt(value)}, expected {expected}")
        for row in value:
            if not isinstance(row, list) or len(row) != len(self.units):
                raise ValueError(f"found {excerpt(row)} among the rows, expected {expected}")
        kinds = [Number(unit) for unit in self.units]
        rows = tuple(tuple(kind(entry) for kind, entry in zip(kinds, row)) for row in value)
        depths = [row[0] for row in rows]
        if depths[0] != 0.0 or any(low >= high for low, high in pairwise(depths)):
            raise ValueError(f"found the depths {excerpt(depths)}, expected {expected}")
        return rows

    def schema(self) -> dict[str, Any]:
        row = {"type": "array", "items": Number().schema(), "minItems": 4, "maxItems": 4}
        return {"type": "array", "items": row, "minItems": 2}


_KEYS = {
    "thickness": Key(Number("m", _POSITIVE), "thickness", None, without="the last depth of `properties`"),
    "material": Key(
        Choice(LIBRARY), "name of a known solid, gives `kind` and constants", None,
        "what is written beside it replaces the material's",
    ),
    "to": Key(
        Constants(), "constants at the lower face", None,
        "the layer is graded; those at its upper face stand beside it", without="as at the upper face",
    ),
    "grading": Key(
        Choice(GRADINGS), "how constants change with depth", "linear",
        '`"exponential"`: their logarithms are linear; `"power"`: (depth/thickness)^exponent',
    ),
    "exponent": Key(
        Number("", Range(at_least=1.0, at_most=10.0)), 'of `grading = "power"`', 1.0,
    ),
    "properties": Key(
        Depths(), "constants by depth, `[[depth, E, nu, rho], …]`", None,
        "instead of `thickness`, constants and `to`; isotropic, linear between the rows",
    ),
}  # fmt: skip


class LayerSections:
    """Any number of tables [[layer]]."""

    heading = "[[{}]]"

    def __init__(self) -> None:
        self._one = ModelSection(
            "kind", "isotropic", SOLIDS, _layer, _KEYS, or_else=", or material, or properties"
        )

    @property
    def alternatives(self) -> dict[str, dict[str, Key]]:
        """Keys that a layer can have, by kind of its solid."""
        return self._one.alternatives

    @property
    def or_else(self) -> str:
        """What else would do where a key is missing."""
        return self._one.or_else

    def keys(self, given: Mapping[str, Any]) -> dict[str, Key]:
        """Keys that a layer with these values can have."""
        return self._one.keys(given)

    def read(self, name: str, given: Any, faults: list[str]) -> tuple[Layer, ...]:
        """The layers; faults are added."""
        if given == {}:
            return ()
        if not isinstance(given, list) or not all(isinstance(one, dict) for one in given):
            faults.append(
                f"{name}: found {excerpt(given)}, expected tables [[{name}]], from the top down"
            )
            return ()
        if len(given) > MOST:
            faults.append(f"{name}: found {len(given)} layers, expected at most {MOST}")
            return ()
        found: list[Layer] = []
        for number, one in enumerate(given, 1):
            found += self._read(f"{name} {number}", one, faults)
        return tuple(found)

    def _read(self, name: str, given: dict[str, Any], faults: list[str]) -> list[Layer]:
        if isinstance(given.get("properties"), list):
            return self._tabulated(name, given, faults)
        material = given.get("material")
        known = LIBRARY.get(material) if isinstance(material, str) else None
        constants = {"kind": known.kind} | known.values if known else {}
        if material is not None and not known:  # its constants are not missing: one fault
            constants = next(iter(LIBRARY.values())).values
        kept = constants | given
        layer = self._one.read(name, kept, faults)
        if layer is None or layer.bottom is None:
            return [] if layer is None else [Layer(layer.thickness, layer.solid)]
        own = {key: value for key, value in kept.items() if key not in _KEYS or key == "thickness"}
        bottom = self._one.read(f"{name}.to", own | layer.bottom, faults)
        if bottom is None:
            return []
        try:
            return [Layer(layer.thickness, layer.solid, bottom.solid, layer.grading, layer.exponent)]
        except ValueError as error:
            faults.append(f"{name}: {error}")
            return []

    def _tabulated(self, name: str, given: dict[str, Any], faults: list[str]) -> list[Layer]:
        if others := sorted(given.keys() - {"properties", "kind", "plane"}):
            faults.append(f"{name}: properties tells {', '.join(others)}, too; take one of them away")
            return []
        if given.get("kind", "isotropic") != "isotropic":
            faults.append(
                f"{name}.kind: found {excerpt(given['kind'])}, expected isotropic with properties"
            )
            return []
        try:
            rows = _KEYS["properties"].kind(given["properties"])
            solids = [
                made(Isotropic, dict(zip(("E", "nu", "rho"), row[1:])) | _plane(given)) for row in rows
            ]
        except ValueError as error:
            faults.append(f"{name}.properties: {error}")
            return []
        return [
            Layer(lower[0] - upper[0], one, None if one == other else other)
            for (upper, lower), (one, other) in zip(pairwise(rows), pairwise(solids))
        ]


def _plane(given: Mapping[str, Any]) -> dict[str, Any]:
    return {"plane": given["plane"]} if "plane" in given else {}


def _layer(
    kind: type[Solid], values: dict[str, Any], thickness: float | None, material: str | None,
    to: Any, grading: str, exponent: float, properties: Any,
) -> Any:  # fmt: skip
    """What one table says; the lower face's constants are still to be read."""
    if thickness is None:
        raise ValueError('missing thickness, as in thickness = "2 µm"')
    if to is None and (grading != "linear" or exponent != 1.0):
        raise ValueError("grading and exponent need to = {…}, the constants at the lower face")
    if grading != "power" and exponent != 1.0:
        raise ValueError(f'found exponent with grading = "{grading}", expected grading = "power"')
    return _Read(thickness, made(kind, values), to, grading, exponent)


class _Read:
    """A layer whose lower face is still in the scene's words."""

    def __init__(
        self, thickness: float, solid: Solid, bottom: Any, grading: str, exponent: float
    ) -> None:
        self.thickness, self.solid, self.bottom = thickness, solid, bottom
        self.grading, self.exponent = grading, exponent
