"""Scenes: sections, values with units, materials, templates."""
