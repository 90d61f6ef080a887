"""Stresses on the surface and inside."""

from galinx.postprocess import compare
from galinx.postprocess.quantities.quantity import INSIDE, POINT, STATE, Quantity

_SURFACE, _INSIDE = "surface", "interior"

_ON_SURFACE = (
    Quantity("surface/X_over_a", "1", "position on the surface over the half-width", (POINT,),
             asked_by=_SURFACE),
    Quantity("surface/closed_form/sigma_YY", "N/(2a)", "contact stress, NaN outside the contact (Eq 55)",
             (STATE, POINT), lambda s, _: s.surface.σ_YY, "closed_form", asked_by=_SURFACE,
             nan_allowed="beside"),
    Quantity("surface/closed_form/sigma_XX", "N/(2a)", "in-plane stress on the surface (Eq 32)",
             (STATE, POINT), lambda s, _: s.surface.σ_XX, "closed_form", asked_by=_SURFACE),
    Quantity("surface/fem/sigma_YY", "N/(2a)",
             "contact stress from Jacobi moments of the nodal forces, NaN outside the contact",
             (STATE, POINT), lambda s, _: s.surface.σ_YY, "fem", asked_by=_SURFACE, nan_allowed="beside",
             compared=(compare.TENSION, compare.PRESSURE)),
    Quantity("surface/fem/sigma_YY_raw", "N/(2a)",
             "contact stress from the nodal forces through the mass matrix, NaN outside the contact",
             (STATE, POINT), lambda s, _: s.surface.raw, "fem", "contact", _SURFACE,
             nan_allowed="beside"),
    Quantity("surface/fem/sigma_XX", "N/(2a)", "in-plane stress on the surface",
             (STATE, POINT), lambda s, _: s.surface.σ_XX, "fem", asked_by=_SURFACE,
             compared=(compare.IN_PLANE,)),
)  # fmt: skip

_POSITIONS_INSIDE = (
    Quantity("interior/X_over_a", "1", "positions inside, along the surface, over the half-width",
             (INSIDE,), asked_by=_INSIDE),
    Quantity("interior/Y_over_a", "1", "positions inside, outwards, over the half-width; negative",
             (INSIDE,), asked_by=_INSIDE),
    Quantity("interior/map", "1",
             "rows and columns of the grid that the first points inside form, by rows", asked_by=_INSIDE),
)  # fmt: skip


def _component(method: str, source: str, i: int, ij: str, what: str) -> Quantity:
    return Quantity(
        f"interior/{method}/sigma_{ij}", "N/(2a)", f"{what} inside, {source}", (STATE, INSIDE),
        lambda s, _: s.inside[i], method, asked_by=_INSIDE,
        compared=(compare.INSIDE,) * (method == "fem"),
    )  # fmt: skip


_COMPONENTS = tuple(
    _component(method, source, i, ij, what)
    for method, source in (("closed_form", "from the potentials"), ("fem", "from the displacement"))
    for i, (ij, what) in enumerate(
        (
            ("XX", "in-plane normal stress along X"),
            ("YY", "normal stress along Y"),
            ("XY", "shear stress"),
        )
    )
)

ROWS = (*_ON_SURFACE, *_POSITIONS_INSIDE, *_COMPONENTS)
