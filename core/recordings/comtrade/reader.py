"""COMTRADE event records: a strict reader of .CFG + .DAT and of .CFF, to a Recording in primary SI units.

What is decided here, where the standard leaves a choice:

- Values are PRIMARY: those a relay recorded as secondary ("S") are multiplied by its transformer ratio.
  1991 files do not say; their values are taken in the unit as written. kA, kV, mA, mV become A and V.
- Text is UTF-8, else of the code page its letters speak for (code_pages). A wrong guess misspells a name.
- 1991 and 1999 have no time zone: times are UTC. 2013's time code is honoured.
- Several rates and gaps in the time stamps are kept: the Recording then has the time of every sample
  (resampling brings a rate that merely follows the line to even spacing).
- Currents and voltages that were sampled one after another (skew) are interpolated to the time stamps'
  instants: 10 us are 0.2 degrees, which would pass for an unbalance.
- Missing samples are NaN (marked by 0x8000 or 99999 in 1999, by 0xFFFF or a blank in 1991, by 0x80000000,
  NaN or the most negative float in the formats of 2013).
- A trigger outside the record is refused.

Nothing is repaired in silence: a file that contradicts itself is a RecordingError that says where, or, where
the caller asks for a lenient reader, a Recording that says what was mended.
"""

from pathlib import Path

from numpy import float64
from numpy.typing import NDArray

from core.recordings.channel_roles import ChannelRole, channel_roles
from core.recordings.comtrade.channels import channels_of, scale_counts
from core.recordings.comtrade.configuration import Configuration
from core.recordings.comtrade.data import SampleTable
from core.recordings.comtrade.files import decode, open_combined, open_record
from core.recordings.comtrade.time_axis import TimeBase, time_base, trigger_index
from core.recordings.data_section import DataSection
from core.recordings.errors import RecordingError
from core.recordings.length import check_length
from core.recordings.repairs import Repairs
from core.recordings.skew import even_stretches, without_skew
from core.recordings.waveform import Digitals, Quantity, Recording

MAX_STRETCHES = 1000
"""Stretches of a record sampled unevenly beyond which skew is not removed piece by piece."""


def read_comtrade(path: Path, *, lenient: bool = False, most_values: int | None = None) -> Recording:
    """Read a COMTRADE record from its configuration file and the data file beside it.

    Parameters
    ----------
    path : pathlib.Path
        Configuration file; the data file has its name and the suffix .dat in any case.
    lenient : bool, default False
        Mend what can be mended without guessing at values, and say so in the recording's repairs.
    most_values : int or None, optional
        Refuse a longer recording before it is held in memory: values of all channels and of VALUES_BESIDE
        more, which stand for times and states. None for any length.

    Returns
    -------
    Recording
        The recording.

    Raises
    ------
    RecordingError
        If a file is missing or contradicts itself; it names the file and the field.
    OSError
        If a file that exists cannot be read.
    """
    repairs = Repairs(lenient=lenient)
    return _recording(path, *open_record(path, repairs), repairs, most_values)


def read_combined_comtrade(path: Path, *, lenient: bool = False, most_values: int | None = None) -> Recording:
    """Read a COMTRADE 2013 combined file (.cff), which holds configuration and data.

    Parameters
    ----------
    path : pathlib.Path
        Path of the file.
    lenient : bool, default False
        Mend what can be mended without guessing at values, and say so in the recording's repairs.
    most_values : int or None, optional
        Refuse a longer recording before it is held in memory: values of all channels and of VALUES_BESIDE
        more, which stand for times and states. None for any length.

    Returns
    -------
    Recording
        The recording.

    Raises
    ------
    RecordingError
        If the file is missing or contradicts itself; it names the file and the field.
    OSError
        If a file that exists cannot be read.
    """
    repairs = Repairs(lenient=lenient)
    return _recording(path, *open_combined(path, repairs), repairs, most_values)


def _recording(
    path: Path, configuration: Configuration, data: DataSection, repairs: Repairs, most_values: int | None
) -> Recording:
    check_length(path, len(configuration.analog), configuration.sample_count, most_values)
    table = decode(data, configuration, repairs, SampleTable.empty)
    base = time_base(data.path, table.stamps, configuration, repairs)
    roles = channel_roles([(c.name, c.phase, c.unit) for c in configuration.analog])
    samples = scale_counts(path, data.path, configuration, roles, table.counts)
    _remove_skew(path, configuration, roles, samples, base, repairs)
    return Recording(
        samples=samples,
        sample_rate_hz=base.rate_hz,
        start_time_ns=configuration.start_time_ns,
        has_time_code=configuration.has_time_code,
        channels=channels_of(configuration, roles),
        trigger_index=trigger_index(path, configuration, base, samples.shape[1], repairs),
        nominal_frequency_hz=configuration.nominal_frequency_hz,
        station=configuration.station,
        device=configuration.device,
        digitals=Digitals(configuration.status_names, table.status) if configuration.status_names else None,
        instants_s=base.instants_s,
        repairs=repairs.notes,
        warnings=repairs.warnings,
        source=str(path),
    )


def _remove_skew(
    path: Path,
    configuration: Configuration,
    roles: tuple[ChannelRole, ...],
    samples: NDArray[float64],
    base: TimeBase,
    repairs: Repairs,
) -> None:
    """Bring currents and voltages to the instants of the time stamps, in place."""
    skewed = [
        (row, channel)
        for row, (channel, role) in enumerate(zip(configuration.analog, roles, strict=True))
        if channel.skew_us != 0 and role.quantity is not Quantity.OTHER
    ]
    if not skewed:
        return
    stretches = [(slice(None), 1 / base.rate_hz)]
    if base.instants_s is not None:
        stretches = list(even_stretches(base.instants_s))
    for row, channel in skewed:
        shortest_us = 1e6 * min((period for _, period in stretches), default=1 / base.rate_hz)
        if not abs(channel.skew_us) < shortest_us or len(stretches) > MAX_STRETCHES:
            fault = RecordingError(
                path,
                f"channel {channel.name!r}, skew",
                expected=f"less than a sample period, {shortest_us:.6g} us, on evenly spaced samples",
                found=f"{channel.skew_us:g} us",
            )
            repairs.mend(fault, "the channel is left as recorded")
            continue
        for stretch, period_s in stretches:
            samples[row, stretch] = without_skew(samples[row, stretch], channel.skew_us * 1e-6 / period_s)
