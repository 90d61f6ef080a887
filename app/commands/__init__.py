"""Commands of the command line: to begin, to compute, and to look at what was computed."""
