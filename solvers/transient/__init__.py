"""A flat punch whose load and friction change in time: integral equation, independent of the finite elements."""
