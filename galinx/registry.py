"""Models by the name that scenes use."""

from collections.abc import Mapping
from typing import TypeVar

from galinx.texts import unseen

Model = TypeVar("Model")


class Registry(dict[str, Model]):
    """Models by name, to which anybody may add.

    Args:
        noun: what a model is, for messages.
        models: the first ones.
    """

    def __init__(self, noun: str, models: Mapping[str, Model] | None = None) -> None:
        super().__init__(models or {})
        self.noun = noun

    def register(self, name: str, model: Model) -> Model:
        """Add a model of one's own, and return it.

        Raises:
            ValueError: the name is taken: two models of one name could not be told apart in archives; or
                it has a control character, which these cannot hold.
        """
        if fault := unseen(name):
            raise ValueError(f"the {self.noun} {name!r}: {fault}")
        if self.get(name, model) is not model:
            raise ValueError(f"the {self.noun} {name!r} exists; give yours another name")
        self[name] = model
        return model
