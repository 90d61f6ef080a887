"""The flow from a plan to an archive."""
