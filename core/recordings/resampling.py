"""Recordings of relays that sample in step with the line, brought to evenly spaced samples."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from core.recordings.errors import RecordingError
from core.recordings.skew import POINTS, even_stretches
from core.recordings.waveform import Digitals, Recording

WIDEST_SPREAD = 0.1
"""Deviation of the steps between samples from their mean: more is a change of rate, no relay that follows the
line."""


def evenly_spaced(recording: Recording) -> Recording:
    """Return the recording with evenly spaced samples.

    An even recording is returned as it is. Else Lagrange interpolation through the six nearest samples gives
    as many instants of one mean rate; states are those of the nearest sample.

    Parameters
    ----------
    recording : Recording
        The recording.

    Returns
    -------
    Recording
        The even recording.

    Raises
    ------
    RecordingError
        If there is a gap or the rate changes, across which nothing is interpolated.
    """
    instants = recording.instants_s
    if instants is None:
        return recording
    steps = np.diff(instants)
    stretches = len(list(even_stretches(instants)))
    if stretches != 1 or np.ptp(steps) > WIDEST_SPREAD * steps.mean():
        raise RecordingError(
            recording.source,
            "sampling",
            expected="one sampling rate and no gap in the time stamps",
            found=f"steps of {steps.min() * 1e6:,.0f} to {steps.max() * 1e6:,.0f} us between samples"
            if steps.size
            else "a single sample",
        )
    even = np.linspace(0.0, instants[-1], instants.size)
    position = np.interp(even, instants, np.arange(instants.size))
    nearest = np.rint(position).astype(np.intp)
    digitals, trigger_index = recording.digitals, recording.trigger_index
    return replace(
        recording,
        samples=_interpolated(recording.samples, position),
        sample_rate_hz=float(1 / steps.mean()),
        trigger_index=None if trigger_index is None else int(np.argmin(np.abs(position - trigger_index))),
        digitals=None if digitals is None else Digitals(digitals.names, digitals.packed[nearest]),
        instants_s=None,
    )


def _interpolated(samples: NDArray[np.float64], position: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return values at fractional sample numbers, shape (channels, positions).

    The time between samples is even enough over six of them for the number to stand for it.
    """
    count = samples.shape[1]
    points = min(POINTS, count)
    first = np.clip(np.floor(position).astype(np.intp) - (points - 1) // 2, 0, count - points)
    offset = position - first
    values = np.zeros((samples.shape[0], position.size))
    for j in range(points):
        weight = np.ones(position.size)
        for k in range(points):
            if k != j:
                weight *= (offset - k) / (j - k)
        values += weight * samples[:, first + j]
    return values
