"""Results in Python, their checks, and what is made of them: pages, figures, tables, files for
ParaView."""
