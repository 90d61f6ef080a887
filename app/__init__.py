"""galinx from the outside: scenes, plans, runs and the command line."""

__version__ = "0.1.0"
