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

import numpy as np
from numpy.typing import NDArray

from core.recordings.channel_roles import ChannelRole, channel_roles
from core.recordings.code_pages import decode_text
from core.recordings.comtrade_ascii import decode_ascii
from core.recordings.comtrade_combined import split_combined
from core.recordings.comtrade_configuration import AnalogChannel, Configuration, parse_configuration
from core.recordings.comtrade_data import SampleTable, decode_binary
from core.recordings.comtrade_time import TimeBase, time_base
from core.recordings.comtrade_writer import configuration_text, data_bytes, write
from core.recordings.data_section import DataSection
from core.recordings.errors import RecordingError
from core.recordings.repairs import Repairs
from core.recordings.skew import even_stretches, without_skew
from core.recordings.waveform import Channel, Digitals, Quantity, Recording
from core.units import NANOSECONDS_PER_SECOND

__all__ = ["configuration_text", "data_bytes", "read_combined_comtrade", "read_comtrade", "write"]

MAX_CONFIGURATION_BYTES = 4 << 20
MAX_DATA_BYTES = 1 << 30
MAX_STRETCHES = 1000
"""Stretches of a record sampled unevenly beyond which skew is not removed piece by piece."""


def read_comtrade(path: Path, *, lenient: bool = False) -> Recording:
    """Read a COMTRADE record from its configuration file and the data file beside it.

    Parameters
    ----------
    path : pathlib.Path
        Configuration file; the data file has its name and the suffix .dat in any case.
    lenient : bool, default False
        Mend what can be mended without guessing at values, and say so in the recording's repairs.

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
    _check_file(path, MAX_CONFIGURATION_BYTES)
    configuration = parse_configuration(path, decode_text(path.read_bytes()), repairs)
    data_path = _data_file(path)
    size = _check_file(data_path, MAX_DATA_BYTES)
    return _recording(path, configuration, DataSection(data_path, 0, size), repairs)


def read_combined_comtrade(path: Path, *, lenient: bool = False) -> Recording:
    """Read a COMTRADE 2013 combined file (.cff), which holds configuration and data.

    Parameters
    ----------
    path : pathlib.Path
        Path of the file.
    lenient : bool, default False
        Mend what can be mended without guessing at values, and say so in the recording's repairs.

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
    _check_file(path, MAX_DATA_BYTES)
    cfg, data, data_format = split_combined(path, repairs)
    if len(cfg) > MAX_CONFIGURATION_BYTES:
        raise RecordingError(
            path,
            "CFG section",
            expected=f"at most {MAX_CONFIGURATION_BYTES} bytes",
            found=f"{len(cfg)} bytes",
        )
    configuration = parse_configuration(path, decode_text(cfg), repairs)
    if data_format != configuration.data_format:
        raise RecordingError(
            path, "DAT section", expected=f"format {configuration.data_format}", found=repr(data_format)
        )
    return _recording(path, configuration, data, repairs)


def _check_file(path: Path, limit: int) -> int:
    """Size [bytes] of a file that is there and no larger than `limit`."""
    if not path.is_file():
        raise RecordingError(path, "file", expected="a file", found="none at this path")
    size = path.stat().st_size
    if size > limit:
        raise RecordingError(path, "size", expected=f"at most {limit} bytes", found=f"{size} bytes")
    return size


def _data_file(path: Path) -> Path:
    """Return the .dat of a .cfg: spelt in the same case, or the only one that differs in case."""
    suffix = "DAT" if path.suffix.isupper() else "dat"
    beside = path.with_suffix(f".{suffix}")
    if beside.is_file():
        return beside
    found = [
        file
        for file in path.parent.iterdir()
        if file.stem.casefold() == path.stem.casefold() and file.suffix.casefold() == ".dat"
    ]
    if len(found) != 1:
        names = ", ".join(sorted(file.name for file in found)) or "none"
        raise RecordingError(path, "data file", expected=f"one {beside.name} in the same folder", found=names)
    return found[0]


def _recording(path: Path, configuration: Configuration, data: DataSection, repairs: Repairs) -> Recording:
    decode = decode_ascii if configuration.data_format == "ASCII" else decode_binary
    table = decode(data, configuration, repairs)
    _check_counts(data.path, table)
    base = time_base(data.path, table.stamps, configuration, repairs)
    roles = channel_roles([(c.name, c.phase, c.unit) for c in configuration.analog])
    samples = _scaled(path, configuration, roles, table)
    _remove_skew(path, configuration, roles, samples, base, repairs)
    return Recording(
        samples=samples,
        sample_rate_hz=base.rate_hz,
        start_time_ns=configuration.start_time_ns,
        channels=tuple(
            Channel(c.name, role.quantity, role.phase, role.unit, _full_scale(c, role.scale))
            for c, role in zip(configuration.analog, roles, strict=True)
        ),
        trigger_index=_trigger_index(path, configuration, base, samples.shape[1], repairs),
        nominal_frequency_hz=configuration.nominal_frequency_hz,
        station=configuration.station,
        device=configuration.device,
        digitals=Digitals(configuration.status_names, table.status) if configuration.status_names else None,
        instants_s=base.instants_s,
        repairs=repairs.notes,
        source=str(path),
    )


def _check_counts(path: Path, table: SampleTable) -> None:
    for channel, counts in enumerate(table.counts, 1):
        infinite = np.isinf(counts)
        if infinite.any():
            sample = int(np.argmax(infinite))
            raise RecordingError(
                path,
                f"sample {sample + 1}, analogue channel {channel}",
                expected="a finite value",
                found=str(counts[sample]),
            )


def _scaled(
    path: Path, configuration: Configuration, roles: tuple[ChannelRole, ...], table: SampleTable
) -> NDArray[np.float64]:
    """Turn the counts into primary SI values, in place: a long record is not held twice."""
    for channel, role, values in zip(configuration.analog, roles, table.counts, strict=True):
        scale = role.scale * channel.to_primary
        with np.errstate(over="ignore", invalid="ignore"):
            values *= scale * channel.gain
            values += scale * channel.offset
        finite = np.isfinite([scale * channel.gain, scale * channel.offset]).all()
        if not finite or np.isinf(values).any():
            raise RecordingError(
                path,
                f"channel {channel.name!r}",
                expected="finite values",
                found="values too large for a number",
            )
    return table.counts


def _full_scale(channel: AnalogChannel, unit_scale: float) -> float | None:
    """Largest magnitude within the file's minimum and maximum counts; None if these say nothing."""
    if channel.minimum == channel.maximum:
        return None
    ends = (channel.gain * count + channel.offset for count in (channel.minimum, channel.maximum))
    full_scale = max(abs(end) for end in ends) * channel.to_primary * unit_scale
    return full_scale if np.isfinite(full_scale) else None


def _remove_skew(
    path: Path,
    configuration: Configuration,
    roles: tuple[ChannelRole, ...],
    samples: NDArray[np.float64],
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


def _trigger_index(
    path: Path, configuration: Configuration, base: TimeBase, samples: int, repairs: Repairs
) -> int | None:
    """Return the sample next to the trigger."""
    elapsed_s = (configuration.trigger_time_ns - configuration.start_time_ns) / NANOSECONDS_PER_SECOND
    if base.instants_s is None:
        index, duration_s = round(elapsed_s * base.rate_hz), samples / base.rate_hz
        within = 0 <= index < samples
    else:
        index, duration_s = int(np.argmin(np.abs(base.instants_s - elapsed_s))), float(base.instants_s[-1])
        within = 0 <= elapsed_s <= duration_s + 0.5 / base.rate_hz
    if within:
        return index
    fault = RecordingError(
        path,
        "time of the trigger",
        expected=f"within the record, 0 to {duration_s:.6g} s after its first sample",
        found=f"{elapsed_s:.6f} s after it",
    )
    repairs.mend(fault, "the trigger is left out")
    return None
