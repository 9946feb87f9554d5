"""COMTRADE event records: a strict reader of .CFG + .DAT and of .CFF, to a Recording in primary SI units.

What is decided here, where the standard leaves a choice:

- Values are PRIMARY: those a relay recorded as secondary ("S") are multiplied by its transformer ratio.
  1991 files do not say; their values are taken in the unit as written. kA, kV, mA, mV become A and V.
- Text is UTF-8, else Latin-1. A name written in a third code page is misspelt, never misread as a number.
- 1991 and 1999 have no time zone: times are UTC. 2013's time code is honoured.
- A record of several sampling rates is refused: the Recording has one time base.
- Currents and voltages that were sampled one after another (skew) are interpolated to the time stamps'
  instants: 10 us are 0.2 degrees, which would pass for an unbalance.
- Missing samples are NaN (marked by 0x8000 or 99999 in 1999, by 0xFFFF or a blank in 1991, by 0x80000000,
  NaN or the most negative float in the formats of 2013).
- A trigger outside the record is refused.

Nothing is repaired: a file that contradicts itself is a RecordingError that says where.
"""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from core.recordings.channel_roles import ChannelRole, channel_roles
from core.recordings.comtrade_combined import split_combined
from core.recordings.comtrade_configuration import AnalogChannel, Configuration, parse_configuration
from core.recordings.comtrade_data import decode_data
from core.recordings.comtrade_writer import configuration_text, data_bytes, write
from core.recordings.errors import RecordingError
from core.recordings.skew import without_skew
from core.recordings.waveform import Channel, Quantity, Recording

__all__ = ["configuration_text", "data_bytes", "read_combined_comtrade", "read_comtrade", "write"]

MAX_CONFIGURATION_BYTES = 16 << 20
MAX_DATA_BYTES = 1 << 30


def read_comtrade(path: Path) -> Recording:
    """Read the record whose configuration file is `path`; its data file lies beside it (.dat in any case).

    Raises RecordingError with the file and field at fault; OSError if a file that exists cannot be read.
    """
    configuration = parse_configuration(path, _decode(_read_bytes(path, MAX_CONFIGURATION_BYTES)))
    data_path = _data_file(path)
    counts, rate_hz = decode_data(data_path, _read_bytes(data_path, MAX_DATA_BYTES), configuration)
    return _recording(path, configuration, counts, rate_hz)


def read_combined_comtrade(path: Path) -> Recording:
    """Read a 2013 combined file (.cff), which holds configuration and data; errors as `read_comtrade`."""
    cfg, dat, data_format = split_combined(path, _read_bytes(path, MAX_DATA_BYTES))
    configuration = parse_configuration(path, _decode(cfg))
    if data_format != configuration.data_format:
        raise RecordingError(
            path, "DAT section", expected=f"format {configuration.data_format}", found=repr(data_format)
        )
    counts, rate_hz = decode_data(path, dat, configuration)
    return _recording(path, configuration, counts, rate_hz)


def _read_bytes(path: Path, limit: int) -> bytes:
    if not path.is_file():
        raise RecordingError(path, "file", expected="a file", found="none at this path")
    size = path.stat().st_size
    if size > limit:
        raise RecordingError(path, "size", expected=f"at most {limit} bytes", found=f"{size} bytes")
    return path.read_bytes()


def _decode(content: bytes) -> str:
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:
        return content.decode("latin-1")


def _data_file(path: Path) -> Path:
    """The .dat of a .cfg: spelt in the same case, or the only one that differs in case."""
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


def _recording(
    path: Path, configuration: Configuration, counts: NDArray[np.float64], rate_hz: float
) -> Recording:
    roles = channel_roles([(c.name, c.phase, c.unit) for c in configuration.analog])
    scales = np.array(
        [role.scale * c.to_primary for role, c in zip(roles, configuration.analog, strict=True)]
    )
    with np.errstate(over="ignore", invalid="ignore"):
        gains = scales * np.array([c.gain for c in configuration.analog])
        offsets = scales * np.array([c.offset for c in configuration.analog])
        samples = counts * gains[:, None] + offsets[:, None]
    overflown = np.flatnonzero((~np.isfinite(samples) & ~np.isnan(counts)).any(axis=1))
    if overflown.size:
        name = configuration.analog[overflown[0]].name
        raise RecordingError(
            path, f"channel {name!r}", expected="finite values", found="values too large for a number"
        )
    _remove_skew(path, configuration, roles, samples, rate_hz)
    return Recording(
        samples=samples,
        sample_rate_hz=rate_hz,
        start_time_ns=configuration.start_time_ns,
        channels=tuple(
            Channel(c.name, role.quantity, role.phase, role.unit, _full_scale(c, role.scale))
            for c, role in zip(configuration.analog, roles, strict=True)
        ),
        trigger_index=_trigger_index(path, configuration, rate_hz),
        nominal_frequency_hz=configuration.nominal_frequency_hz,
        station=configuration.station,
        device=configuration.device,
        source=str(path),
    )


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
    rate_hz: float,
) -> None:
    """Bring currents and voltages to the instants of the time stamps, in place."""
    for row, (channel, role) in enumerate(zip(configuration.analog, roles, strict=True)):
        skew = channel.skew_us * 1e-6 * rate_hz
        if skew == 0 or role.quantity is Quantity.OTHER:
            continue
        if not abs(skew) < 1:
            raise RecordingError(
                path,
                f"channel {channel.name!r}, skew",
                expected=f"less than a sample period, {1e6 / rate_hz:.6g} us",
                found=f"{channel.skew_us:g} us",
            )
        samples[row] = without_skew(samples[row], skew)


def _trigger_index(path: Path, configuration: Configuration, rate_hz: float) -> int:
    elapsed_s = (configuration.trigger_time_ns - configuration.start_time_ns) / 1e9
    index = round(elapsed_s * rate_hz)
    if not 0 <= index < configuration.sample_count:
        duration_s = configuration.sample_count / rate_hz
        raise RecordingError(
            path,
            "time of the trigger",
            expected=f"within the record, 0 to {duration_s:.6g} s after its first sample",
            found=f"{elapsed_s:.6f} s after it",
        )
    return index
