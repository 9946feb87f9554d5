"""The models of shorted turns by their names."""

from collections.abc import Mapping
from typing import Final

from core.machines.base import StatorModel
from core.machines.shorted_winding import ShortedWinding
from core.machines.split_winding import SplitWinding

MODELS: Final[Mapping[str, StatorModel]] = {model.name: model for model in (SplitWinding(), ShortedWinding())}
