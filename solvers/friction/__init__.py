"""Friction laws, by the name that scenes use, and how they advance along strokes."""

from galinx.registry import Registry
from galinx.solvers.friction.dahl import Dahl
from galinx.solvers.friction.law import FrictionLaw
from galinx.solvers.parameters import parameters


class Laws(Registry[type[FrictionLaw]]):
    """Friction laws; parameters of one name are one column of archives, whatever the law."""

    def register(self, name: str, model: type[FrictionLaw]) -> type[FrictionLaw]:
        """Add a law of one's own, and return it.

        Raises:
            ValueError: the name is taken, or another law has that parameter in another unit.
        """
        for other, law in self.items():
            known = parameters(law)
            for key, parameter in parameters(model).items():
                if other != name and key in known and known[key].unit != parameter.unit:
                    raise ValueError(
                        f"the parameter {key!r} of the friction law {other!r} has the unit "
                        f"{known[key].unit or '1'!r}, {name!r} wants {parameter.unit or '1'!r}: name it "
                        "apart"
                    )
        return super().register(name, model)


LAWS = Laws("friction law", {"dahl": Dahl})
