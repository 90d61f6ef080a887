"""A flat punch whose load changes in time: integral equation, independent of the finite elements."""
