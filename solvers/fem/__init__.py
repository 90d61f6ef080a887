"""Finite elements in dolfinx for the moving-frame equations: forms, space, punch, surface."""
