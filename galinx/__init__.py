"""galinx: sliding contact at wave speed.

In Python::

    import galinx
    result = galinx.compute(galinx.template("tables4_5", {"friction.mu_c": 0.5}))
    result.dataset.fem_K_I_right

The rooms of the program, ``galinx.app``, ``galinx.solvers`` and so on, are the folders of those names
beside this one in the source tree, where they are linked to, and inside this one where it is installed.
"""

from importlib import import_module
from typing import Any

__version__ = "0.1.0"

#: Module of each public name, which is imported when the name is used.
_NAMES = {
    **dict.fromkeys(("Result", "compute", "load", "read_scene", "template"), "app.results.result"),
    "compare": "app.results.compared",
    "fit": "app.results.fitted",
    "Measured": "solvers.friction.fit",
    # Base classes of models, and the registries to which a model of one's own is added.
    **dict.fromkeys(("FrictionLaw", "LAWS"), "solvers.friction"),
    **dict.fromkeys(("SOLIDS", "Solid"), "solvers.solids"),
    **dict.fromkeys(("PROFILES", "Profile"), "solvers.profiles"),
    **dict.fromkeys(("MESHES", "MeshKind"), "meshes"),
    **dict.fromkeys(("QUANTITIES", "Quantity"), "postprocess.quantities"),
    **dict.fromkeys(("RULES", "Rule"), "postprocess.compare"),
    **dict.fromkeys(("METHODS", "MethodKind"), "app.methods"),
    **dict.fromkeys(("choice", "parameter"), "solvers.parameters"),
}

__all__ = [*_NAMES, "__version__"]


def __getattr__(name: str) -> Any:
    if name in _NAMES:
        return getattr(import_module(f"galinx.{_NAMES[name]}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)
