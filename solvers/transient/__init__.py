"""A flat punch whose load and friction change: integral equation, independent of the finite elements."""
