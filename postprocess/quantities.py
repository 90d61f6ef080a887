"""The one table of archived quantities: path, unit and long name."""

#: Path in the archive -> (unit, long name). "1" means dimensionless.
FIELDS: dict[str, tuple[str, str]] = {
    "scene/text": ("none", "scene as given (TOML)"),
    "states/motion": ("none", "name of the stroke: forward (FM) or backward (BM) motion, numbered"),
    "states/X_over_L": ("1", "position on the stroke over the pre-sliding displacement"),
    "states/c": ("1", "speed over shear wave speed"),
    "states/mu_c": ("1", "Coulomb's friction coefficient"),
    "states/sigma0_over_load": ("1/m", "stiffness of Dahl's law over load, sigma0 l/N"),
    "states/delta": ("1", "exponent of Dahl's law"),
    "states/f": ("1", "friction coefficient F/N, positive in forward motion"),
    "states/g": ("1", "sigma_XY/sigma_YY under the punch"),
    "states/alpha": ("1", "exponent of the pressure at X = a, local analysis"),
    "states/beta": ("1", "exponent of the pressure at X = -a, local analysis"),
    "states/closed_form/K_I": ("1", "normalised stress intensity factor, both ends (Eq 58)"),
    "states/fem/K_I_left": ("1", "normalised stress intensity factor at X = -a, Jacobi moments"),
    "states/fem/K_I_right": ("1", "normalised stress intensity factor at X = a, Jacobi moments"),
    "states/fem/alpha": ("1", "exponent of the pressure at X = a, fitted from the raw pressure"),
    "states/fem/beta": ("1", "exponent of the pressure at X = -a, fitted from the raw pressure"),
    "states/fem/normal_force": ("N/m", "resultant of the nodal normal forces under the punch"),
    "states/fem/tangential_force": ("N/m", "resultant of the nodal tangential forces under the punch"),
    "states/fem/v0": ("m", "indentation relative to the far boundary"),
    "states/fem/estimate": ("1", "estimated relative error of K_I and moments, no closed form used"),
    "states/fem/true_error": ("1", "relative error of K_I against the closed form, larger end"),
    "states/fem/slope_under_punch": (
        "1",
        "largest |v,X| for |X| <= 0.9 a over the largest for 1.1 a <= |X| <= 5 a",
    ),
    "surface/X_over_a": ("1", "position on the surface over the half-width"),
    "surface/closed_form/sigma_YY": ("N/(2a)", "contact stress, NaN outside the contact (Eq 55)"),
    "surface/closed_form/sigma_XX": ("N/(2a)", "in-plane stress on the surface (Eq 32)"),
    "surface/fem/sigma_YY": (
        "N/(2a)",
        "contact stress from Jacobi moments of the nodal forces, NaN outside the contact",
    ),
    "surface/fem/sigma_YY_raw": (
        "N/(2a)",
        "contact stress from the nodal forces through the mass matrix, NaN outside the contact",
    ),
    "surface/fem/sigma_XX": ("N/(2a)", "in-plane stress on the surface"),
    "interior/X_over_a": ("1", "positions inside, along the surface, over the half-width"),
    "interior/Y_over_a": ("1", "positions inside, outwards, over the half-width; negative"),
    "interior/map": ("1", "rows and columns of the grid that the first points inside form, by rows"),
    **{
        f"interior/{method}/sigma_{ij}": ("N/(2a)", f"{what} inside, {source}")
        for method, source in (("closed_form", "from the potentials"), ("fem", "from the displacement"))
        for ij, what in (
            ("XX", "in-plane normal stress along X"),
            ("YY", "normal stress along Y"),
            ("XY", "shear stress"),
        )
    },
    "run/fem/c": ("1", "speeds with finite elements, over shear wave speed"),
    "run/fem/cells": ("1", "cells of the mesh"),
    "run/fem/unknowns": ("1", "unknowns"),
    "run/fem/degree": ("1", "polynomial degree"),
    "run/fem/change_by_degree": (
        "1",
        "largest relative change of K_I and moments from the degree before, by degree; 0: not computed",
    ),
    "run/fem/factorisations": ("1", "factorisations"),
    "run/fem/back_substitutions": ("1", "back-substitutions"),
    "run/fem/iterations": ("1", "most steps of conjugate gradients in a solve; 0: direct solver"),
    "run/fem/largest_residual": ("1", "largest |b - Ax|/|b| of a back-substitution"),
    "run/fem/largest_condition": (
        "1",
        "largest condition number of a matrix, estimated by MUMPS; 0 if all were too large",
    ),
    "run/failures": ("none", "speeds that could not be solved, and why"),
    "run/done": ("none", "steps done"),
    "run/skipped": ("none", "steps skipped, and why"),
    "run/seconds": ("s", "wall time of the steps done, in the order of run/steps"),
    "run/steps": ("none", "names of the timed steps"),
}
