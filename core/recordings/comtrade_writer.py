"""Writer of COMTRADE 1999 binary records, as a relay stores them.

16 bits a value, like the relay's own memory: count = round(x / a) with a = full scale / 32767, clipped at
full scale, NaN as the missing marker 0x8000. Values are written as primary ("P"), so the ratio is 1:1.
"""

from datetime import UTC, datetime, timedelta
from math import inf
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from core.recordings.waveform import Channel, Recording

MAX_COUNT = 32_767
MISSING = -0x8000

_EPOCH = datetime(1970, 1, 1, tzinfo=UTC)


def write(path: Path, recording: Recording, *, header_text: str | None = None) -> Path:
    """Write `path`.CFG and .DAT, and .HDR if a header text is given; return the configuration's path.

    path: with suffix .cfg or .CFG, whose case the other suffixes follow, or without (then upper case).
    Every channel needs a full scale, which sets the quantisation. Files appear complete and the
    configuration last: who sees it can read the record.
    Raises ValueError if the format cannot hold the recording; OSError from the file system.
    """
    if path.suffix.casefold() != ".cfg":
        path = path.with_name(path.name + ".CFG")
    configuration = configuration_text(recording).encode("utf-8")
    upper = path.suffix.isupper()
    contents = {} if header_text is None else {".hdr": header_text.encode("utf-8")}
    contents |= {".dat": data_bytes(recording), ".cfg": configuration}
    for suffix, content in contents.items():
        file = path.with_suffix(suffix.upper() if upper else suffix)
        partial = file.with_name(file.name + ".part")
        partial.write_bytes(content)
        partial.replace(file)
    return path


def configuration_text(recording: Recording) -> str:
    """Text of the 1999 configuration file.

    Times are cut to microseconds, all this edition holds; without a trigger the first sample is named.
    Raises ValueError if a name would break the format or a channel has no full scale.
    """
    count, sample_count = recording.samples.shape
    trigger_index = recording.trigger_index or 0
    if not 0 <= trigger_index < sample_count:
        raise ValueError(f"trigger at sample {trigger_index} of a recording of {sample_count} samples")
    frequency = recording.nominal_frequency_hz
    start_us = recording.start_time_ns // 1000
    trigger_us = start_us + round(trigger_index * 1e6 / recording.sample_rate_hz)
    lines = [
        f"{_field(recording.station)},{_field(recording.device)},1999",
        f"{count},{count}A,0D",
        *(_channel_line(number, channel) for number, channel in enumerate(recording.channels, 1)),
        "" if frequency is None else repr(float(frequency)),
        "1",
        f"{float(recording.sample_rate_hz)!r},{sample_count}",
        _date_time(start_us),
        _date_time(trigger_us),
        "BINARY",
        "1",
    ]
    return "\r\n".join(lines) + "\r\n"


def data_bytes(recording: Recording) -> bytes:
    """Contents of the 1999 BINARY data file: number, time stamp [us], one 16-bit count a channel."""
    channels, samples = recording.samples.shape
    stamps = np.rint(np.arange(samples) * (1e6 / recording.sample_rate_hz))
    if samples == 0 or stamps[-1] >= 0xFFFFFFFF:
        raise ValueError("a COMTRADE record holds at least one sample and at most 4294 s")
    table = np.empty(samples, dtype=[("number", "<u4"), ("stamp", "<u4"), ("analog", "<i2", (channels,))])
    table["number"] = np.arange(1, samples + 1)
    table["stamp"] = stamps
    table["analog"] = _counts(recording).T
    return table.tobytes()


def _counts(recording: Recording) -> NDArray[np.int16]:
    steps = np.array([_step(channel) for channel in recording.channels])
    with np.errstate(over="ignore"):  # beyond full scale all are clipped alike
        counts = np.clip(np.rint(recording.samples / steps[:, None]), -MAX_COUNT, MAX_COUNT)
    return np.where(np.isnan(counts), MISSING, counts).astype(np.int16)


def _step(channel: Channel) -> float:
    """What one count stands for [unit of the channel]."""
    step = float(channel.full_scale or 0.0) / MAX_COUNT
    if not 0 < step < inf:
        raise ValueError(
            f"channel {channel.name!r} needs a full scale to be quantised, not {channel.full_scale}"
        )
    return step


def _channel_line(number: int, channel: Channel) -> str:
    phase = (channel.phase or "").upper()
    return (
        f"{number},{_field(channel.name)},{phase},,{_field(channel.unit)},"
        f"{_step(channel)!r},0,0,{-MAX_COUNT},{MAX_COUNT},1,1,P"
    )


def _field(text: str) -> str:
    if "," in text or not text.isprintable() or text != text.strip():
        raise ValueError(
            f"{text!r} cannot be a field of a COMTRADE file: no commas, line ends or outer blanks"
        )
    return text


def _date_time(time_us: int) -> str:
    moment = _EPOCH + timedelta(microseconds=time_us)
    return moment.strftime("%d/%m/%Y,%H:%M:%S.%f")
