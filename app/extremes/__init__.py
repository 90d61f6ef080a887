"""Extremes of every parameter, and whether the promises hold there."""
