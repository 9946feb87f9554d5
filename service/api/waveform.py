"""A recording for the screen: as many intervals as there are points to draw, no peak lost."""

from math import isfinite

import numpy as np
from numpy.typing import NDArray

from core.recordings import Recording
from service.api.schemas import Waveform, WaveformChannel
from service.api.times import rfc3339


def waveform_of(recording_id: str, recording: Recording, points: int) -> Waveform:
    """Return the smallest and largest sample of up to `points` intervals of equal length, within a sample."""
    count = recording.samples.shape[1]
    starts = np.unique(np.linspace(0, count, num=min(points, count), endpoint=False).astype(np.int64))
    lowest, highest = _envelope(recording.samples, starts)
    return Waveform(
        recording_id=recording_id,
        start_time=rfc3339(recording.start_time_ns),
        trigger_time=rfc3339(recording.trigger_time_ns),
        sample_rate_hz=recording.sample_rate_hz,
        samples=count,
        time_s=recording.time_s[starts].tolist(),
        channels=[
            WaveformChannel(
                name=channel.name,
                quantity=channel.quantity,
                phase=channel.phase,
                unit=channel.unit,
                minimum=_numbers(lowest[row]),
                maximum=_numbers(highest[row]),
            )
            for row, channel in enumerate(recording.channels)
        ],
    )


def _envelope(
    samples: NDArray[np.float64], starts: NDArray[np.int64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    if starts.size == 0:
        return samples, samples
    # fmin and fmax pass over samples the recorder missed (NaN).
    return np.fmin.reduceat(samples, starts, axis=1), np.fmax.reduceat(samples, starts, axis=1)


def _numbers(values: NDArray[np.float64]) -> list[float | None]:
    """Return the values as a list, with None for NaN, which JSON does not know."""
    return [value if isfinite(value) else None for value in values.tolist()]
