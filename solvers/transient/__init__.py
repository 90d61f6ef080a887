"""A flat punch that starts to slide: integral equation in time, independent of the finite elements."""
