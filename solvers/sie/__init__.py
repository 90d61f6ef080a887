"""Singular integral equation of the flat punch: closed form, collocation, field."""
