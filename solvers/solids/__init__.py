"""Elastic solids and their response at speed."""
