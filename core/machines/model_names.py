"""Names of the models of shorted turns, the same in programs, files and tables."""

from enum import StrEnum


class Model(StrEnum):
    """How shorted turns are modelled."""

    COIL = "coil"
    """Turns inside one coil, on the coil's axis and with the coil's leakage; the others are special cases."""
    SPLIT_WINDING = "split-winding"
    SHORTED_WINDING = "shorted-winding"
