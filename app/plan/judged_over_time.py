"""Rules by which motions in time are judged."""

from galinx.postprocess.compare_over_time import BOTH, OF_FEM
from galinx.postprocess.energy_over_time import BALANCE, WORKS
from galinx.postprocess.surface_over_time import ALONG, AT_ENDS
from galinx.postprocess.surface_over_time import OF_FEM as OF_SURFACE

#: All of them.
IN_TIME = frozenset({BOTH, OF_FEM, WORKS, BALANCE, AT_ENDS, ALONG, OF_SURFACE})


def rules(both: bool, steady: bool, surface: bool, sharp: bool) -> frozenset[str]:
    """Names of those for finite elements.

    Args:
        both: does the integral equation follow these motions, too?
        steady: do they begin in steady motion?
        surface: is the surface looked at?
        sharp: are there waves that no cell holds? Of these the estimate is told, and nothing promised.
    """
    found = {OF_FEM, *(BOTH,) * both, *(WORKS, AT_ENDS) * (both and not steady)}
    if surface:
        found |= {BALANCE, *(ALONG,) * both, *(OF_SURFACE,) * (not sharp)}
    return frozenset(found)
