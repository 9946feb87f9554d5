"""Writer of COMTRADE records: editions 1991, 1999 and 2013, every data format, and the combined file.

Like a relay's own memory, counts have 16 bits (32 in BINARY32): count = round((x - b) / a), clipped at full
scale, missing samples marked as the edition does. Values are written as primary ("P"), beside the
transformer's ratio where the channel has one.
Samples that are not evenly spaced are written with their time stamps as the only time base (0 rates).
"""

from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from math import inf, isnan
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from core.recordings.waveform import Channel, Recording

Revision = Literal[1991, 1999, 2013]
DataFormat = Literal["ASCII", "BINARY", "BINARY32", "FLOAT32"]

MAX_COUNT = 32_767

_FORMATS = {
    1991: ("ASCII", "BINARY"),
    1999: ("ASCII", "BINARY"),
    2013: ("ASCII", "BINARY", "BINARY32", "FLOAT32"),
}
_EPOCH = datetime(1970, 1, 1, tzinfo=UTC)


@dataclass(frozen=True, slots=True)
class _Scale:
    """value = step * count + offset; counts reach from `lowest` to `highest`."""

    step: float
    offset: float
    lowest: float
    highest: float


def write(
    path: Path,
    recording: Recording,
    *,
    header_text: str | None = None,
    revision: Revision = 1999,
    data_format: DataFormat = "BINARY",
    utc_offset_min: int = 0,
) -> Path:
    """Write a recording as COMTRADE, in separate files or in one combined file (2013).

    Every channel needs a full scale, which sets the quantisation (not in FLOAT32). Files appear complete and
    the configuration last: who sees it can read the record.

    Parameters
    ----------
    path : pathlib.Path
        Path with suffix .cfg or .cff, whose case the other suffixes follow, or without suffix (then .CFG).
    recording : Recording
        The recording.
    header_text : str or None, optional
        Text of the header file; None for no header file.
    revision : Revision, default 1999
        Edition of the standard.
    data_format : DataFormat, optional
        Format of the data file.
    utc_offset_min : int, default 0
        Offset of the clock that the recording's times are of [min]; only the 2013 edition can say so.

    Returns
    -------
    pathlib.Path
        The path to read from.

    Raises
    ------
    ValueError
        If the format cannot hold the recording.
    OSError
        If a file cannot be written.
    """
    combined = path.suffix.casefold() == ".cff"
    if combined and revision != 2013:
        raise ValueError("a combined file is of the 2013 edition")
    configuration = configuration_text(
        recording, revision=revision, data_format=data_format, utc_offset_min=utc_offset_min
    )
    if combined:
        _appear(path, _combined(configuration, recording, data_format, header_text or ""))
        return path
    if path.suffix.casefold() != ".cfg":
        path = path.with_name(path.name + ".CFG")
    data = data_bytes(recording, revision=revision, data_format=data_format)
    upper = path.suffix.isupper()
    contents = {} if header_text is None else {".hdr": header_text.encode("utf-8")}
    contents |= {".dat": data, ".cfg": configuration.encode("utf-8")}
    for suffix, content in contents.items():
        _appear(path.with_suffix(suffix.upper() if upper else suffix), content)
    return path


def _appear(file: Path, content: bytes) -> None:
    partial = file.with_name(file.name + ".part")
    partial.write_bytes(content)
    partial.replace(file)


def combined_bytes(recording: Recording, *, data_format: DataFormat, header_text: str = "") -> bytes:
    """Return the contents of a 2013 combined file.

    Parameters
    ----------
    recording : Recording
        The recording.
    data_format : DataFormat
        Format of the data file.
    header_text : str, default ''
        Text of the header section.

    Returns
    -------
    bytes
        The contents.

    Raises
    ------
    ValueError
        If the format cannot hold the recording.
    """
    configuration = configuration_text(recording, revision=2013, data_format=data_format)
    return _combined(configuration, recording, data_format, header_text)


def _combined(configuration: str, recording: Recording, data_format: DataFormat, header_text: str) -> bytes:
    data = data_bytes(recording, revision=2013, data_format=data_format)
    heading = data_format if data_format == "ASCII" else f"{data_format}: {len(data)}"
    head = (
        f"--- file type: CFG ---\r\n{configuration}--- file type: INF ---\r\n\r\n"
        f"--- file type: HDR ---\r\n{header_text}\r\n--- file type: DAT {heading} ---\r\n"
    )
    return head.encode("utf-8") + data


def configuration_text(
    recording: Recording,
    *,
    revision: Revision = 1999,
    data_format: DataFormat = "BINARY",
    utc_offset_min: int = 0,
) -> str:
    """Return the text of the configuration file.

    Times are cut to microseconds before 2013; without a trigger the first sample is named.

    Parameters
    ----------
    recording : Recording
        The recording.
    revision : Revision, default 1999
        Edition of the standard.
    data_format : DataFormat, optional
        Format of the data file.
    utc_offset_min : int, default 0
        Offset of the clock that the recording's times are of [min]; only the 2013 edition can say so.

    Returns
    -------
    str
        The text.

    Raises
    ------
    ValueError
        If the edition cannot hold the recording, or a channel has no full scale.
    """
    if revision not in _FORMATS:
        raise ValueError(f"there is no edition {revision} of COMTRADE, only {', '.join(map(str, _FORMATS))}")
    if data_format not in _FORMATS[revision]:
        raise ValueError(
            f"edition {revision} has no format {data_format}, only {', '.join(_FORMATS[revision])}"
        )
    count, sample_count = recording.samples.shape
    trigger_index = recording.trigger_index or 0
    if not 0 <= trigger_index < sample_count:
        raise ValueError(f"trigger at sample {trigger_index} of a recording of {sample_count} samples")
    names = recording.digitals.names if recording.digitals else ()
    frequency = recording.nominal_frequency_hz
    identification = f"{_field(recording.station)},{_field(recording.device)}"
    rate = "0" if recording.instants_s is not None else repr(float(recording.sample_rate_hz))
    lines = [
        identification if revision == 1991 else f"{identification},{revision}",
        f"{count + len(names)},{count}A,{len(names)}D",
        *(
            _channel_line(number, channel, revision, data_format)
            for number, channel in enumerate(recording.channels, 1)
        ),
        *(
            f"{number},{_field(name)},{'0' if revision == 1991 else ',,0'}"
            for number, name in enumerate(names, 1)
        ),
        "" if frequency is None else repr(float(frequency)),
        "0" if recording.instants_s is not None else "1",
        f"{rate},{sample_count}",
        _date_time(recording.first_time_ns, revision),
        _date_time(recording.trigger_time_ns, revision),
        data_format,
    ]
    if revision == 1999:
        lines.append("1")
    elif (
        revision == 2013
    ):  # times to nanoseconds make them the unit of the time stamps: 1000 of them are 1 us
        lines += ["1000", ",".join([_time_code(utc_offset_min)] * 2), "0,0"]
    return "\r\n".join(lines) + "\r\n"


def _time_code(utc_offset_min: int) -> str:
    """Hours, and minutes where there are any: "0", "-5h30" (IEEE C37.111-2013 clause 7.4.10)."""
    hours, minutes = divmod(abs(utc_offset_min), 60)
    sign = "-" if utc_offset_min < 0 else ""
    return f"{sign}{hours}h{minutes:02d}" if minutes else f"{sign}{hours}"


def data_bytes(
    recording: Recording, *, revision: Revision = 1999, data_format: DataFormat = "BINARY"
) -> bytes:
    """Return the contents of the data file: number, time stamp [us], values and states of each sample.

    Parameters
    ----------
    recording : Recording
        The recording.
    revision : Revision, default 1999
        Edition of the standard.
    data_format : DataFormat, optional
        Format of the data file.

    Returns
    -------
    bytes
        The contents.

    Raises
    ------
    ValueError
        If it would be empty or longer than the time stamps reach, or the format cannot hold the recording.
    """
    channels, samples = recording.samples.shape
    stamps = np.rint(recording.time_s * 1e6)
    if samples == 0 or stamps[-1] >= 0xFFFFFFFF:
        raise ValueError("a COMTRADE record holds at least one sample and at most 4294 s")
    if recording.instants_s is not None and not (np.diff(stamps) > 0).all():
        raise ValueError("samples less than a microsecond apart need the same distance throughout")
    counts = _counts(recording, revision, data_format)
    if data_format == "ASCII":
        return _ascii_lines(recording, stamps, counts, revision)
    words = -(-len(recording.digitals.names) // 16) if recording.digitals else 0
    analog_type = {"BINARY": "<i2", "BINARY32": "<i4", "FLOAT32": "<f4"}[data_format]
    missing = _missing(revision, data_format)
    row = [
        ("number", "<u4"),
        ("stamp", "<u4"),
        ("analog", analog_type, (channels,)),
        ("status", "u1", (2 * words,)),
    ]
    table = np.zeros(samples, dtype=row)
    table["number"] = np.arange(1, samples + 1)
    table["stamp"] = stamps
    table["analog"] = np.where(np.isnan(counts), missing, counts).T
    if recording.digitals:
        table["status"][:, : recording.digitals.packed.shape[1]] = recording.digitals.packed
    return table.tobytes()


def _ascii_lines(
    recording: Recording, stamps: NDArray[np.float64], counts: NDArray[np.float64], revision: Revision
) -> bytes:
    missing = "" if revision == 1991 else "99999"
    states = (
        recording.digitals.unpacked() if recording.digitals else np.zeros((stamps.size, 0), dtype=np.bool_)
    )
    lines = []
    for number, (stamp, values, bits) in enumerate(zip(stamps, counts.T, states, strict=True), 1):
        fields = (missing if isnan(value) else f"{value:.0f}" for value in values.tolist())
        lines.append(",".join([str(number), f"{stamp:.0f}", *fields, *("1" if bit else "0" for bit in bits)]))
    return ("\r\n".join(lines) + "\r\n").encode("ascii")


def _counts(recording: Recording, revision: Revision, data_format: DataFormat) -> NDArray[np.float64]:
    """Return counts, shape (channels, samples), NaN where missing; whole numbers except in FLOAT32."""
    if data_format == "FLOAT32":
        with np.errstate(over="ignore"):
            values = recording.samples.astype(np.float32).astype(np.float64)
        largest = float(np.finfo(np.float32).max)
        return np.clip(values, np.nextafter(-largest, 0.0), largest)  # the very lowest marks a missing one
    counts = np.empty(recording.samples.shape)
    for row, (channel, x) in enumerate(zip(recording.channels, recording.samples, strict=True)):
        scale = _scale(channel, revision, data_format)
        with np.errstate(over="ignore"):  # beyond full scale all are clipped alike
            counts[row] = np.clip(np.rint((x - scale.offset) / scale.step), scale.lowest, scale.highest)
    return counts


def _missing(revision: Revision, data_format: DataFormat) -> float:
    if data_format == "FLOAT32":
        return float("nan")
    if data_format == "BINARY32":
        return -0x80000000
    return -1 if revision == 1991 else -0x8000


def _scale(channel: Channel, revision: Revision, data_format: DataFormat) -> _Scale:
    full_scale = float(channel.full_scale or 0.0)
    if data_format == "FLOAT32":
        return _Scale(1.0, 0.0, -full_scale, full_scale)
    largest = 0x7FFFFFFF if data_format == "BINARY32" else MAX_COUNT
    if revision == 1991 and data_format == "BINARY":  # its mark of a missing sample is -1: no negative counts
        half = MAX_COUNT // 2
        scale = _Scale(full_scale / half, -full_scale, 0, 2 * half)
    else:
        scale = _Scale(full_scale / largest, 0.0, -largest, largest)
    if not 0 < scale.step < inf:
        raise ValueError(
            f"channel {channel.name!r} needs a full scale to be quantised, not {channel.full_scale}"
        )
    return scale


def _channel_line(number: int, channel: Channel, revision: Revision, data_format: DataFormat) -> str:
    phase = (channel.phase or "").upper()
    scale = _scale(channel, revision, data_format)
    line = (
        f"{number},{_field(channel.name)},{phase},,{_field(channel.unit)},"
        f"{scale.step!r},{_plain(scale.offset)},0,{_plain(scale.lowest)},{_plain(scale.highest)}"
    )
    ratio = 1.0 if channel.transformer_ratio is None else channel.transformer_ratio
    return line if revision == 1991 else f"{line},{_plain(ratio)},1,P"


def _plain(value: float) -> str:
    return f"{value:.0f}" if value == round(value) and abs(value) < 1e15 else repr(value)


def _field(text: str) -> str:
    if "," in text or not text.isprintable() or text != text.strip():
        raise ValueError(
            f"{text!r} cannot be a field of a COMTRADE file: no commas, line ends or outer blanks"
        )
    return text


def _date_time(time_ns: int, revision: Revision) -> str:
    microseconds, nanoseconds = divmod(time_ns, 1000)
    moment = _EPOCH + timedelta(microseconds=microseconds)
    if revision == 1991:
        if not 1970 <= moment.year < 2070:
            raise ValueError(f"two digits of 1991 do not tell the year {moment.year}")
        return moment.strftime("%m/%d/%y,%H:%M:%S.%f")
    return moment.strftime("%d/%m/%Y,%H:%M:%S.%f") + (f"{nanoseconds:03d}" if revision == 2013 else "")
