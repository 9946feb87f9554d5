"""The envelope of a COMTRADE record of any length, without its samples in memory."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from core.recordings.channel_roles import channel_roles
from core.recordings.comtrade.channels import channels_of, scale_counts
from core.recordings.comtrade.configuration import Configuration
from core.recordings.comtrade.files import decode, open_combined, open_record
from core.recordings.comtrade.time_axis import time_base, trigger_index
from core.recordings.envelope import Envelope, Extremes, IntervalsOf, interval_starts
from core.recordings.length import VALUES_BESIDE, check_length
from core.recordings.repairs import Repairs
from core.recordings.waveform import Recording

MOST_SAMPLES = 2_000_000
"""Their times are held in memory."""


def read_comtrade_envelope(path: Path, intervals_of: IntervalsOf, *, lenient: bool = False) -> Envelope:
    """Read the envelope of a COMTRADE record.

    Channels that were sampled one after another (skew) stay so: that is less than a sample, where an interval
    has several.

    Parameters
    ----------
    path : pathlib.Path
        Configuration file (.cfg) or combined file (.cff).
    intervals_of : callable
        Number of intervals for a number of channels and a number of samples.
    lenient : bool, default False
        Mend what can be mended without guessing at values.

    Returns
    -------
    Envelope
        The envelope.

    Raises
    ------
    RecordingError
        If a file is missing or contradicts itself, or there are more than MOST_SAMPLES samples.
    OSError
        If a file that exists cannot be read.
    """
    repairs = Repairs(lenient=lenient)
    opened = open_combined if path.suffix.casefold() == ".cff" else open_record
    configuration, data = opened(path, repairs)
    check_length(path, 0, configuration.sample_count, VALUES_BESIDE * MOST_SAMPLES)

    def table_of(configuration: Configuration, samples: int) -> _Table:
        channels = len(configuration.analog)
        starts = interval_starts(samples, intervals_of(channels, samples))
        return _Table(Extremes.empty(channels, starts), np.empty(samples))

    table = decode(data, configuration, repairs, table_of)
    extremes, samples = table.extremes, table.stamps.size
    base = time_base(data.path, table.stamps, configuration, repairs)
    roles = channel_roles([(c.name, c.phase, c.unit) for c in configuration.analog])
    for counts in (extremes.lowest, extremes.highest):
        scale_counts(path, data.path, configuration, roles, counts, "interval")
    timing = Recording(  # without channels: for the times alone
        samples=np.empty((0, samples)),
        sample_rate_hz=base.rate_hz,
        start_time_ns=configuration.start_time_ns,
        channels=(),
        trigger_index=trigger_index(path, configuration, base, samples, repairs),
        instants_s=base.instants_s,
    )
    return Envelope(
        channels=channels_of(configuration, roles),
        lowest=np.fmin(extremes.lowest, extremes.highest),  # a negative factor exchanges them
        highest=np.fmax(extremes.lowest, extremes.highest),
        times_s=timing.time_s[extremes.starts],
        start_time_ns=timing.first_time_ns,
        trigger_time_ns=timing.trigger_time_ns,
        sample_rate_hz=timing.sample_rate_hz,
        samples=samples,
    )


@dataclass(frozen=True, slots=True)
class _Table:
    """What is kept of the samples: extremes of the intervals, and all time stamps."""

    extremes: Extremes
    stamps: NDArray[np.float64]

    def put(
        self,
        first: int,
        counts: NDArray[np.float64],
        stamps: NDArray[np.float64],
        status: NDArray[np.uint8],  # noqa: ARG002 - states are not drawn
    ) -> None:
        self.stamps[first : first + stamps.size] = stamps
        self.extremes.put(first, counts)
