"""Meshes of the half-plane, by name: confocal (default), graded and box."""
