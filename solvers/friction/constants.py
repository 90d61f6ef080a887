"""Constants that several friction laws have, each as the field of a dataclass."""

from typing import Any

from galinx.solvers.parameters import parameter


def coulomb_coefficient() -> Any:
    """μ_C, dimensionless."""
    return parameter("mu_c", "Coulomb's coefficient μ_C", symbol=r"\mu_C", above=0.0, usual=(1e-4, 10.0))
