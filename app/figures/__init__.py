"""Figures of results: each is panels of curves and maps, drawn by one renderer."""

import logging

# A home that cannot be written costs nothing but time: no reader of a figure needs to know.
logging.getLogger("matplotlib").addFilter(lambda record: "temporary" not in record.getMessage())
