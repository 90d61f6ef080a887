"""Friction laws; a law is a callable of start value, direction and slip."""
