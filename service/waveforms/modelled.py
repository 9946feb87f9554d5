"""The model's currents and the residual over a part of a recording, as a window of samples."""

import numpy as np

from core.signals.terminals import PHASES
from service.waveforms.opened import Group, ShownChannel
from service.waveforms.replaying import Replayed
from service.waveforms.windows import SampleWindow, between, window_of_values

MEASURED, MODELLED, RESIDUAL = "measured", "modelled", "residual"


def modelled_window(
    replayed: Replayed, points: int, from_s: float | None = None, to_s: float | None = None
) -> SampleWindow:
    """Return measured and modelled line currents and what is left, from one time to another."""
    count = replayed.measured_abc.shape[1]
    times = replayed.first_s + np.arange(count) / replayed.sample_rate_hz
    first, last = between(times, from_s, to_s)
    parts = {
        MEASURED: replayed.measured_abc,
        MODELLED: replayed.modelled_abc,
        RESIDUAL: replayed.measured_abc - replayed.modelled_abc,
    }
    values = [
        (ShownChannel(row, kind, Group.CURRENTS, phase, "A"), current[row, first:last].astype(np.float64))
        for kind, current in parts.items()
        for row, phase in enumerate(PHASES)
    ]
    return window_of_values(times[first:last], values, points)
