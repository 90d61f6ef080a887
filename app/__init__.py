"""galinx from the outside: scenes, plans, runs and the command line.

In Python::

    from app import compute, template
    result = compute(template("tables4_5", {"friction.mu_c": 0.5}))
    result.dataset.fem_K_I_right
"""

from typing import Any

__version__ = "0.1.0"

_RESULT = ("Result", "compute", "load", "read_scene", "template")

__all__ = [*_RESULT, "__version__"]


def __getattr__(name: str) -> Any:
    if name in _RESULT:
        from app import result  # imports that the command line does without

        return getattr(result, name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
