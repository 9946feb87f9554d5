"""The envelope of a recording: the smallest and largest samples of intervals of equal length, for drawing."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from core.recordings.waveform import Channel, Recording

IntervalsOf = Callable[[int, int], int]
"""Number of intervals for a number of channels and a number of samples."""


@dataclass(frozen=True, slots=True)
class Envelope:
    """The smallest and largest samples of each interval; no peak is lost.

    Parameters
    ----------
    channels : tuple of Channel
        The channels.
    lowest, highest : ndarray, shape (channels, intervals)
        Extremes, each row in its channel's SI unit; NaN where all samples of the interval are missing.
    times_s : ndarray, shape (intervals,)
        Time of the first sample of each interval after the first sample of the recording [s].
    start_time_ns : int
        UTC of the first sample [ns since 1970].
    trigger_time_ns : int
        UTC of the trigger, or of the first sample where the file names no trigger [ns since 1970].
    sample_rate_hz : float
        Sampling rate of the recording [Hz].
    samples : int
        Number of samples of the recording.
    """

    channels: tuple[Channel, ...]
    lowest: NDArray[np.float64]
    highest: NDArray[np.float64]
    times_s: NDArray[np.float64]
    start_time_ns: int
    trigger_time_ns: int
    sample_rate_hz: float
    samples: int


def interval_starts(samples: int, intervals: int) -> NDArray[np.intp]:
    """Divide samples into intervals of equal length, within a sample.

    Parameters
    ----------
    samples : int
        Number of samples.
    intervals : int
        Most intervals; there are no more than samples.

    Returns
    -------
    ndarray of int, shape (intervals,)
        First sample of each interval.
    """
    starts = np.linspace(0, samples, num=min(intervals, samples), endpoint=False)
    return np.unique(starts.astype(np.intp))


def envelope_of(recording: Recording, intervals_of: IntervalsOf) -> Envelope:
    """Return the envelope of a recording.

    Parameters
    ----------
    recording : Recording
        The recording.
    intervals_of : callable
        Number of intervals for a number of channels and a number of samples.

    Returns
    -------
    Envelope
        The envelope.
    """
    channels, count = recording.samples.shape
    starts = interval_starts(count, intervals_of(channels, count))
    extremes = Extremes.empty(channels, starts)
    extremes.put(0, recording.samples.T)
    return Envelope(
        channels=recording.channels,
        lowest=extremes.lowest,
        highest=extremes.highest,
        times_s=recording.time_s[starts],
        start_time_ns=recording.first_time_ns,
        trigger_time_ns=recording.trigger_time_ns,
        sample_rate_hz=recording.sample_rate_hz,
        samples=count,
    )


@dataclass(frozen=True, slots=True)
class Extremes:
    """The smallest and largest values of intervals, of samples that come block by block.

    Parameters
    ----------
    starts : ndarray of int, shape (intervals,)
        First sample of each interval, the first being 0.
    lowest, highest : ndarray, shape (channels, intervals)
        Extremes so far; NaN where there was none.
    """

    starts: NDArray[np.intp]
    lowest: NDArray[np.float64]
    highest: NDArray[np.float64]

    @classmethod
    def empty(cls, channels: int, starts: NDArray[np.intp]) -> "Extremes":
        """Return extremes of no samples.

        Parameters
        ----------
        channels : int
            Number of channels.
        starts : ndarray of int, shape (intervals,)
            First sample of each interval, the first being 0.

        Returns
        -------
        Extremes
            What waits for samples.
        """
        shape = (channels, starts.size)
        return cls(starts, np.full(shape, np.nan), np.full(shape, np.nan))

    def put(self, first: int, samples: NDArray[np.float64]) -> None:
        """Take a block.

        Parameters
        ----------
        first : int
            Number of samples before it.
        samples : ndarray, shape (samples, channels)
            Values, NaN where missing.
        """
        if samples.shape[0] == 0:
            return
        begin = int(np.searchsorted(self.starts, first, side="right")) - 1
        end = int(np.searchsorted(self.starts, first + samples.shape[0]))
        at = np.maximum(self.starts[begin:end] - first, 0)
        for extremes, of in ((self.lowest, np.fmin), (self.highest, np.fmax)):
            known = extremes[:, begin:end]
            of(known, of.reduceat(samples, at, axis=0).T, out=known)  # both pass over NaN
