"""Figures of results: each is panels of curves and maps, drawn by one renderer."""
