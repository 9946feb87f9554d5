"""Names of the models of shorted turns, the same in programs, files and tables."""

from enum import StrEnum


class Model(StrEnum):
    """How shorted turns are modelled."""

    SPLIT_WINDING = "split-winding"
    SHORTED_WINDING = "shorted-winding"
