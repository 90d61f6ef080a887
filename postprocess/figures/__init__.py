"""Figures, the one room that meets matplotlib: pure functions from arrays to figures."""
