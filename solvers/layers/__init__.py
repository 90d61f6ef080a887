"""Half-planes of several layers, and of solids graded with depth."""
