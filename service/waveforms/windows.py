"""A part of a recording for the screen: its samples, or the extremes of intervals where they are many."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from core.recordings.envelope import Extremes, interval_starts
from service.waveforms.opened import Opened, ShownChannel

ALIGNMENT: Final = 4
"""Bytes of a number; the head is filled up to a multiple, so that browsers take the figures as they are."""

Figures = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class WindowChannel:
    """A channel over the window: `lowest` and `highest` are the same where each value is a sample."""

    name: str
    group: str
    phase: str | None
    unit: str
    lowest: Figures
    highest: Figures


@dataclass(frozen=True, slots=True)
class SampleWindow:
    """A part of a recording.

    first_s, last_s: times of its first and last sample after the first one of the recording [s].
    times_s: of each value [s].  samples: how many it has.  is_envelope: whether a value stands for several.
    """

    first_s: float
    last_s: float
    times_s: Figures
    samples: int
    is_envelope: bool
    channels: tuple[WindowChannel, ...]


def window_of(
    shown: Opened, points: int, from_s: float | None = None, to_s: float | None = None
) -> SampleWindow:
    """Return the part from one time to another, at least two samples where there are as many.

    points: values a channel, at most.
    """
    times = shown.recording.time_s
    first, last = between(times, from_s, to_s)
    values = [(channel, shown.values(channel, first, last)) for channel in shown.channels]
    return window_of_values(times[first:last], values, points)


def window_of_values(
    times_s: Figures, values: Sequence[tuple[ShownChannel, Figures]], points: int
) -> SampleWindow:
    """Return a window of values that were cut out already."""
    count = times_s.size
    is_envelope = count > points
    starts = interval_starts(count, points) if is_envelope else np.arange(count)
    channels = tuple(_channel(channel, samples, starts, is_envelope) for channel, samples in values)
    return SampleWindow(
        first_s=float(times_s[0]) if count else 0.0,
        last_s=float(times_s[-1]) if count else 0.0,
        times_s=times_s[starts],
        samples=count,
        is_envelope=is_envelope,
        channels=channels,
    )


def between(times: Figures, from_s: float | None, to_s: float | None) -> tuple[int, int]:
    """Return the samples [first, last) that cover a time, at least two where there are as many."""
    first = 0 if from_s is None else int(np.searchsorted(times, from_s, side="right")) - 1
    last = times.size if to_s is None else int(np.searchsorted(times, to_s, side="left")) + 1
    first = min(max(first, 0), max(times.size - 2, 0))
    return first, min(max(last, first + 2), times.size)


def _channel(
    channel: ShownChannel, samples: Figures, starts: NDArray[np.intp], is_envelope: bool
) -> WindowChannel:
    lowest = highest = samples
    if is_envelope:
        extremes = Extremes.empty(1, starts)
        extremes.put(0, samples[:, np.newaxis])
        lowest, highest = extremes.lowest[0], extremes.highest[0]
    return WindowChannel(channel.name, channel.group, channel.phase, channel.unit, lowest, highest)


def encoded(window: SampleWindow, about: Mapping[str, object] | None = None) -> bytes:
    """Return the window as a head in JSON and columns of single-precision numbers.

    Four bytes have the length of the head (unsigned, little-endian). The head is JSON in UTF-8, filled with
    spaces. Then follow the columns that it names, each of `count` little-endian single-precision numbers, NaN
    where a sample is missing. Times count from `first_s`, so that they keep their digits.
    """
    columns: list[dict[str, object]] = [{"of": "time", "unit": "s"}]
    arrays = [window.times_s - window.first_s]
    for one in window.channels:
        names = {"name": one.name, "group": one.group, "phase": one.phase, "unit": one.unit}
        if window.is_envelope:
            columns += [{**names, "of": "minimum"}, {**names, "of": "maximum"}]
            arrays += [one.lowest, one.highest]
        else:
            columns.append({**names, "of": "value"})
            arrays.append(one.lowest)
    head = {
        **(about or {}),
        "first_s": window.first_s,
        "last_s": window.last_s,
        "samples": window.samples,
        "count": int(window.times_s.size),
        "columns": columns,
    }
    text = json.dumps(head, separators=(",", ":"), allow_nan=False).encode()
    text += b" " * (-len(text) % ALIGNMENT)
    body = b"".join(np.ascontiguousarray(one, dtype="<f4").tobytes() for one in arrays)
    return len(text).to_bytes(ALIGNMENT, "little") + text + body
