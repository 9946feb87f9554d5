"""The models of shorted turns by their names."""

from collections.abc import Mapping
from typing import Final

from core.machines.base import StatorModel
from core.machines.model_names import Model
from core.machines.shorted_winding import ShortedWinding
from core.machines.split_winding import SplitWinding

MODELS: Final[Mapping[str, StatorModel]] = {
    Model.COIL: SplitWinding(),
    Model.SPLIT_WINDING: SplitWinding(),
    Model.SHORTED_WINDING: ShortedWinding(),
}
"""Turns in a coil are a split winding whose candidates have an axis and a leakage."""
