"""The stress matrix: extremes of every parameter, and whether the program keeps its word there."""
