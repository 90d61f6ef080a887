"""Scenes: what is to be computed, as TOML with units, checked before any work starts."""

import difflib
import hashlib
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import attrs
from attrs import validators as is_

from app.errors import BadInput
from app.quantities import to_si

METHODS = ("closed_form", "fem")
QUANTITIES = ("friction", "sif", "surface", "interior")


def _number(unit: str = "") -> Callable[[Any], float]:
    return lambda value: to_si(value, unit)


def _numbers(unit: str = "") -> Callable[[Any], tuple[float, ...]]:
    """One number or a list of them."""
    return lambda value: tuple(
        to_si(entry, unit) for entry in (value if isinstance(value, list) else [value])
    )


def _names(value: Any) -> tuple[Any, ...]:
    if not isinstance(value, list):
        raise ValueError(f"found {value!r}, expected a list of names")
    return tuple(value)


def _text(value: Any) -> str:
    if not isinstance(value, str):
        raise ValueError(f"found {value!r}, expected a text")
    return value


def _pressure(value: Any) -> Any:
    if value == "closed_form":
        return value
    if not isinstance(value, list) or len(value) < 2:
        raise ValueError(f'found {value!r}, expected "closed_form" or a list of pairs [X/a, σ_YY/(N/2a)]')
    if not all(isinstance(pair, list) and len(pair) == 2 for pair in value):
        raise ValueError("expected a list of pairs [X/a, σ_YY/(N/2a)], dimensionless")
    pairs = tuple((to_si(x, ""), to_si(σ, "")) for x, σ in value)
    positions = [x for x, _ in pairs]
    if positions[0] != -1.0 or positions[-1] != 1.0 or positions != sorted(set(positions)):
        raise ValueError("expected positions that grow from X/a = -1 to X/a = 1")
    return pairs


def _points(value: Any) -> tuple[tuple[float, float], ...]:
    if not isinstance(value, list) or not all(isinstance(p, list) and len(p) == 2 for p in value):
        raise ValueError(f"found {value!r}, expected a list of pairs [X/a, Y/a]")
    points = tuple((to_si(X, ""), to_si(Y, "")) for X, Y in value)
    if outside := [Y for _, Y in points if Y >= 0.0]:
        raise ValueError(f"found Y/a = {outside[0]:g}, expected Y/a < 0: the solid lies below the punch")
    return points


def _each(*checks: Any) -> Any:
    return is_.and_(is_.min_len(1), is_.deep_iterable(is_.and_(*checks)))


def _key(convert: Callable, check: Any, doc: str, default: Any = attrs.NOTHING) -> Any:
    return attrs.field(default=default, validator=check, metadata={"doc": doc, "convert": convert})


_positive = is_.gt(0.0)


@attrs.frozen
class Solid:
    """[solid]"""

    E: float = _key(_number("Pa"), _positive, "Young's modulus")
    nu: float = _key(_number(), is_.and_(is_.gt(-1.0), is_.le(0.5)), "Poisson's ratio")
    rho: float = _key(_number("kg/m^3"), _positive, "density")
    plane: str = _key(_text, is_.in_(("strain", "stress")), "plane strain or stress", "strain")


@attrs.frozen
class Punch:
    """[punch]"""

    half_width: float = _key(_number("m"), _positive, "half-width a", 1e-3)
    load: float = _key(_number("N/m"), _positive, "normal load N per depth", 55.3e3)


@attrs.frozen
class Friction:
    """[friction]"""

    mu_c: tuple[float, ...] = _key(_numbers(), _each(_positive), "Coulomb's coefficient μ_C")
    sigma0_over_load: tuple[float, ...] = _key(_numbers("1/m"), _each(_positive), "σ₀ l/N")
    model: str = _key(_text, is_.in_(("dahl",)), "friction law", "dahl")
    delta: tuple[float, ...] = _key(_numbers(), _each(_positive), "Dahl's exponent", (1.0,))
    pre_sliding: float = _key(_number("m"), _positive, "pre-sliding displacement L", 1e-4)
    integrator: str = _key(_text, is_.in_(("exact", "rk4")), "integrator", "exact")
    sign: str = _key(_text, is_.in_(("physical", "eq25")), "sign of σ_XY", "physical")


@attrs.frozen
class Motion:
    """[motion]"""

    c: tuple[float, ...] | None = _key(
        _numbers(), is_.optional(_each(is_.ge(0.0), is_.lt(1.0))), "speed over c_s", None
    )
    speed: tuple[float, ...] | None = _key(
        _numbers("m/s"), is_.optional(_each(is_.ge(0.0))), "speed V", None
    )
    strokes: tuple[str, ...] = _key(
        _names,
        _each(is_.in_(("forward", "backward"))),
        "directions in order of time",
        ("forward", "backward", "forward"),
    )
    X_over_L: tuple[float, ...] = _key(
        _numbers(), _each(is_.ge(0.0), is_.le(1.0)), "positions on the stroke", (0.2, 0.8)
    )


@attrs.frozen
class Solve:
    """[solve]"""

    methods: tuple[str, ...] = _key(
        _names, is_.deep_iterable(is_.in_(METHODS)), "what solves the contact", METHODS
    )
    tolerance: float = _key(
        _number(),
        is_.and_(is_.ge(1e-10), is_.le(0.1)),
        "wanted relative accuracy of K_I and pressure moments",
        1e-6,
    )
    mesh: str = _key(_text, is_.in_(("confocal", "graded", "box")), "mesh", "confocal")
    mode: str = _key(_text, is_.in_(("contact", "traction")), "pressure unknown or put in", "contact")
    pressure: Any = _key(_pressure, None, "σ_YY of the traction mode", "closed_form")


@attrs.frozen
class Output:
    """[output]"""

    quantities: tuple[str, ...] = _key(
        _names, _each(is_.in_(QUANTITIES)), "what is asked for", QUANTITIES[:3]
    )
    points: tuple[tuple[float, float], ...] = _key(_points, None, "points inside, [X/a, Y/a]", ())


_SECTIONS: dict[str, type] = {
    "solid": Solid,
    "punch": Punch,
    "friction": Friction,
    "motion": Motion,
    "solve": Solve,
    "output": Output,
}


@attrs.frozen
class Scene:
    """A checked scene; numbers are in SI.

    Attributes:
        title: free text.
        text: the TOML it came from, byte for byte as archived.
        warnings: what looks unusual, one sentence each.
    """

    title: str
    text: str
    solid: Solid
    punch: Punch
    friction: Friction
    motion: Motion
    solve: Solve
    output: Output
    warnings: tuple[str, ...]

    @property
    def sha256(self) -> str:
        """Hash of the scene's text."""
        return hashlib.sha256(self.text.encode()).hexdigest()


def read(path: Path) -> Scene:
    """Read and check a scene file.

    Raises:
        BadInput: the file cannot be read, or the scene has faults; all are listed.
    """
    try:
        data = path.read_bytes()
    except IsADirectoryError:
        raise BadInput(f"{path} is a folder, expected a scene (TOML file)") from None
    except OSError as error:
        raise BadInput(f"cannot read {path}: {error.strerror}") from None
    try:
        text = data.decode("utf-8-sig").replace("\r\n", "\n")
    except UnicodeDecodeError as error:
        raise BadInput(f"{path} is not UTF-8 (byte {error.start}); save it as UTF-8") from None
    if not text.strip():
        raise BadInput(f"{path} is empty, expected a scene; scenes/ holds examples")
    return parse(text, str(path))


def parse(text: str, name: str = "scene") -> Scene:
    """Check a scene's text; ``name`` stands in messages.

    Raises:
        BadInput: with all faults of the scene in one message.
    """
    try:
        tree = tomllib.loads(text)
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        raise BadInput(f"{name} is not TOML: {error}") from None
    faults: list[str] = []
    title = tree.pop("title", "")
    if not isinstance(title, str):
        faults.append(f"title: found {title!r}, expected a text")
    for key in tree.keys() - _SECTIONS.keys():
        faults.append(f"[{key}]: no such section{_nearest(key, [*_SECTIONS, 'title'])}")
    sections = {
        section: _structure(section, kind, tree.get(section, {}), faults)
        for section, kind in _SECTIONS.items()
    }
    if not faults:
        scene = Scene(title, text, **sections, warnings=())
        faults = _contradictions(scene)
        if not faults:
            return attrs.evolve(scene, warnings=tuple(_oddities(scene)))
    lines = "\n".join(f"  {fault}" for fault in faults)
    raise BadInput(f"{name} has {len(faults)} fault{'s' * (len(faults) > 1)}:\n{lines}")


def _nearest(key: str, valid: list[str]) -> str:
    close = difflib.get_close_matches(key, valid, 1, 0.5)
    return f"; did you mean {close[0]}?" if close else f"; valid: {', '.join(valid)}"


def _structure(section: str, kind: type, given: Any, faults: list[str]) -> Any:
    """The section as its class, or None after adding its faults."""
    if not isinstance(given, dict):
        faults.append(f"{section}: found {given!r}, expected a section [{section}]")
        return None
    fields = {field.name: field for field in attrs.fields(kind)}
    found = [
        f"{section}.{key}: no such key{_nearest(key, [*fields])}" for key in given if key not in fields
    ]
    values = {}
    for key, field in fields.items():
        if key not in given:
            if field.default is attrs.NOTHING:
                found.append(f"{section}.{key}: missing; expected the {field.metadata['doc']}")
            continue
        try:
            values[key] = field.metadata["convert"](given[key])
            if field.validator:
                field.validator(None, field, values[key])
        except (ValueError, TypeError) as error:
            found.append(f"{section}.{key} ({field.metadata['doc']}): {error.args[0]}")
    faults += found
    return None if found else kind(**values)


def _contradictions(scene: Scene) -> list[str]:
    faults = []
    asked, solve = set(scene.output.quantities), scene.solve
    if scene.motion.c is not None and scene.motion.speed is not None:
        faults.append("motion: c and speed exclude each other; keep one")
    if scene.motion.c is None and scene.motion.speed is None:
        faults.append("motion: expected c (over the shear wave speed) or speed (m/s)")
    if asked - {"friction"} and not solve.methods:
        faults.append(
            "solve.methods is empty, but output.quantities asks for "
            f"{', '.join(sorted(asked - {'friction'}))}; name closed_form, fem or both"
        )
    if ("interior" in asked) != bool(scene.output.points):
        faults.append(
            'output: the quantity "interior" and output.points go together, as in '
            "points = [[0.0, -0.5], [1.0, -0.5]] (X/a, Y/a); give both or none"
        )
    if solve.pressure != "closed_form" and solve.mode != "traction":
        faults.append('solve.pressure needs solve.mode = "traction"')
    return faults


def _oddities(scene: Scene) -> list[str]:
    odd = []
    for key, value, unit, low, high in (
        ("solid.E", scene.solid.E, "Pa", 1e3, 2e12),
        ("solid.rho", scene.solid.rho, "kg/m^3", 1.0, 3e4),
        ("punch.half_width", scene.punch.half_width, "m", 1e-9, 10.0),
        ("friction.pre_sliding", scene.friction.pre_sliding, "m", 1e-10, 1.0),
    ):
        if not low <= value <= high:
            odd.append(f"{key} = {value:g} {unit} is unusual; is its unit as meant?")
    return odd
