"""The study as a program: its tables and figures."""
