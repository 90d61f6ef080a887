"""Keys of a scene's sections, and what makes a section of them."""

import dataclasses
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from galinx.app.console.program import program
from galinx.app.scene.excerpt import excerpt, nearest, short
from galinx.app.scene.numbers import Numbers
from galinx.app.scene.tables import OneOrMore, Rows, Variations, Wrapped
from galinx.app.scene.values import Choice, Kind, Number, NumberList
from galinx.registry import Registry
from galinx.solvers.parameters import Parameter, fields, parameters

#: Stands for a default where a key has to be given.
REQUIRED: Any = dataclasses.MISSING


@dataclass(frozen=True)
class Key:
    """A key of a section.

    Attributes:
        kind: what its value is.
        about: what it means.
        default: value of a key that is not given.
        note: what documentation says beyond ``about``.
        without: what documentation says instead of a default of None.
        stands_for: a model's parameter that follows from this key; models without it do not have the key.
    """

    kind: Kind
    about: str
    default: Any = REQUIRED
    note: str = ""
    without: str = "none"
    stands_for: str = ""


class Section:
    """A section of a scene whose keys do not depend on one another.

    Args:
        build: makes the section from its values by key.
        keys: of the section.
        or_else: what else would do where a key is missing, for messages.
    """

    #: How the section stands in a scene.
    heading = "[{}]"

    def __init__(self, build: Callable[..., Any], keys: Mapping[str, Key], or_else: str = "") -> None:
        self.build, self._keys, self.or_else = build, dict(keys), or_else

    @property
    def alternatives(self) -> dict[str, dict[str, Key]]:
        """All keys that a section can have, by what it describes; here the one set there is."""
        return {"": self._keys}

    def keys(self, given: Mapping[str, Any]) -> dict[str, Key]:
        """Keys that a section with these values can have."""
        return self._keys

    def read(self, name: str, given: Any, faults: list[str]) -> Any:
        """What the section says, or None after adding its faults; ``name`` is the section's."""
        if not isinstance(given, dict):
            faults.append(f"{name}: found {excerpt(given)}, expected a section [{name}]")
            return None
        keys = self.keys(given)
        found = [
            f"{name}.{short(key)}: no such key{nearest(key, [*keys])}" for key in given if key not in keys
        ]
        values = {}
        for key, known in keys.items():
            if key not in given:
                if known.default is REQUIRED:
                    found.append(f"{name}.{key}: missing; expected the {known.about}{self.or_else}")
                else:
                    values[key] = known.default
                continue
            try:
                values[key] = known.kind(given[key])
            except ValueError as error:
                found.append(f"{name}.{key} ({known.about}): {error}")
        if not found:
            try:
                return self._made(values)
            except ValueError as error:  # values that a model refuses together
                found.append(f"{name}: {error}")
        faults += found
        return None

    def _made(self, values: dict[str, Any]) -> Any:
        return self.build(**values)


class ModelSection(Section):
    """A section that describes a model of a registry: the model's parameters are keys of the section.

    Args:
        chosen: key that names the model.
        default: the model of a section that names none.
        models: classes by name.
        build: makes the section from the model's class, the model's values by key, and the other values.
        keys: of the section besides, by name.
        several: a parameter may be a list.
        defaults: of parameters, in scenes.
        or_else: what else would do where a key is missing, for messages.
    """

    def __init__(
        self,
        chosen: str,
        default: str,
        models: Registry[Any],
        build: Callable[..., Any],
        keys: Mapping[str, Key],
        several: bool = False,
        defaults: Mapping[str, Any] | None = None,
        or_else: str = "",
    ) -> None:
        super().__init__(build, keys, or_else)
        self._chosen, self._default, self._models, self._several = chosen, default, models, several
        self._defaults = defaults or {}

    @property
    def alternatives(self) -> dict[str, dict[str, Key]]:
        return {name: self._of(name) for name in self._models}

    def keys(self, given: Mapping[str, Any]) -> dict[str, Key]:
        name = given.get(self._chosen)
        known = isinstance(name, str) and name in self._models
        return self._of(str(name) if known else self._default)

    def read(self, name: str, given: Any, faults: list[str]) -> Any:
        wanted = given.get(self._chosen) if isinstance(given, dict) else None
        if wanted is not None and (not isinstance(wanted, str) or wanted not in self._models):
            # Which other keys there are depends on it.
            try:
                Choice(self._models)(wanted)
            except ValueError as error:
                own = f"; one of your own is registered by a file, {program()} -x FILE.py …"
                faults.append(f"{name}.{self._chosen} ({self._models.noun}): {error}{own}")
            return None
        return super().read(name, given, faults)

    def _of(self, model: str) -> dict[str, Key]:
        kind = self._models[model]
        own = {key: self._key(known, kind) for key, known in parameters(kind).items()}
        chosen = Key(Choice(self._models), self._models.noun, self._default)
        besides = {key: known for key, known in self._keys.items() if known.stands_for in ("", *own)}
        keys = {**own, self._chosen: chosen, **besides}
        return keys | {"vary": self._variations(model)} if self._several else keys

    def _variations(self, model: str) -> Key:
        """Tables of parameters; rows of numbers, which all laws share, are not among these."""
        single = {
            name: [known for known in parameters(kind).values() if known.single]
            for name, kind in self._models.items()
        }
        own = {known.key: self._key(known, self._models[model]).kind for known in single[model]}
        every = tuple(dict.fromkeys(known.key for some in single.values() for known in some))
        return Key(
            Variations(own, every), "parameters of the laws, table by table", (),
            "instead of the product of the lists above: the product of each table, with what it leaves "
            "out as the section has it; laws that are in several tables are computed once",
        )  # fmt: skip

    def _key(self, known: Parameter, model: Any) -> Key:
        value: Kind
        if known.options:
            value = Choice(known.options)
        elif known.columns:
            value = Rows(known.columns)
        elif known.count:
            value = NumberList(known.unit, known.count)
        else:
            value = (Numbers if self._several else Number)(known.unit, known.range)
        default = self._defaults.get(known.key, fields(model)[known.key].default)
        if self._several:  # each then is a tuple of what laws have
            if isinstance(value, Choice):
                value = OneOrMore(value)
            elif not known.single:
                value = Wrapped(value)
            if default is not REQUIRED:
                default = (default,)
        return Key(value, known.about, default, known.note)

    def _made(self, values: dict[str, Any]) -> Any:
        model = self._models[values.pop(self._chosen)]
        own = {key: values.pop(key) for key in parameters(model)}
        return self.build(model, own, **values)
