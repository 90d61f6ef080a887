"""Models by the name that scenes use."""

from collections.abc import Mapping
from dataclasses import is_dataclass
from typing import Any, TypeVar

from galinx.texts import unseen

Model = TypeVar("Model")


class Registry(dict[str, Model]):
    """Models by name, to which anybody may add.

    Args:
        noun: of a model, for messages.
        models: the first ones.
        kind: the class that models are instances of, or the protocol that they, classes themselves,
            follow; anything is a model if not given.
    """

    def __init__(
        self, noun: str, models: Mapping[str, Model] | None = None, kind: type | None = None
    ) -> None:
        super().__init__(models or {})
        self.noun, self._kind = noun, kind

    def register(self, name: str, model: Model) -> Model:
        """Add a model of one's own, and return it.

        Raises:
            TypeError: the name is no text, or the model not of the kind; the message says what it lacks.
            ValueError: the name is taken: two models of one name could not be told apart in archives; or
                it is blank, begins or ends so, or has a control character, which these cannot hold.
        """
        self.check(name, model)
        blank = name.strip() != (name or " ")
        if fault := unseen(name) or "expected a name, without blanks around it" * blank:
            raise ValueError(f"the {self.noun} {name!r}: {fault}")
        if self.get(name, model) is not model:
            raise ValueError(f"the {self.noun} {name!r} exists; give yours another name")
        self[name] = model
        return model

    def __missing__(self, name: Any) -> Model:
        raise KeyError(f"the {self.noun} {name!r}: there is none; valid: {', '.join(self)}")

    def check(self, name: str, model: Any) -> None:
        """Check that a model can be registered.

        Raises:
            TypeError: the name is no text, or the model not of the kind.
        """
        if not isinstance(name, str):
            raise TypeError(f"the {self.noun} {name!r}: expected a text for its name")
        if self._kind and (fault := _unlike(model, self._kind)):
            raise TypeError(f"the {self.noun} {name!r}: {fault}")


def _unlike(model: Any, kind: type) -> str:
    """Reason why a model is not of a kind; "" where it is."""
    if not getattr(kind, "_is_protocol", False):
        expected = f"an instance of {kind.__name__}"
        return "" if isinstance(model, kind) else f"found {model!r:.80}, expected {expected}"
    if not isinstance(model, type):
        return f"found {model!r:.80}, expected a class with the members of {kind.__name__}"
    there = {*dir(model), *getattr(model, "__dataclass_fields__", ())}
    members = {name for name in (*vars(kind), *kind.__annotations__) if not name.startswith("_")}
    lacking = sorted((members - there) | {*getattr(model, "__abstractmethods__", ())})
    if lacking:
        return f"{model.__name__} lacks {', '.join(lacking)} of {kind.__name__}"
    return "" if is_dataclass(model) else f"{model.__name__} is no dataclass; write @dataclass above it"
