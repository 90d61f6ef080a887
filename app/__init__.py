"""From scenes to archives, reports and figures, and the command line."""
