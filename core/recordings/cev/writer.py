"""Writer of SEL Compressed ASCII event reports (.CEV), as a relay makes them.

Values are written to as many decimals as full scale / 32767 needs, to seven digits where a channel has no
full scale; the date to milliseconds, all the format holds. Currents in A bear no unit, other channels theirs.
"""

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from math import ceil, isnan, log10
from pathlib import Path
from types import MappingProxyType

import numpy as np

from core.recordings.cev.compressed_ascii import checksum, closed
from core.recordings.cev.samples import UNUSED
from core.recordings.waveform import Channel, Recording
from core.units import NANOSECONDS_PER_MILLISECOND

NO_VALUE = "$$$$$$$"
DATE_LABELS = '"MONTH","DAY","YEAR","HOUR","MIN","SEC","MSEC"'

_STEPS = 32_767
_DIGITS_WITHOUT_FULL_SCALE = 7
_MOST_DECIMALS = 15
_LARGEST_FIGURE = 1e9
_EPOCH = datetime(1970, 1, 1, tzinfo=UTC)
_TEXT = re.compile(r"[ -!#-~]*")


@dataclass(frozen=True, slots=True)
class EventSummary:
    """What the report tells beside the samples.

    Parameters
    ----------
    samples_per_cycle : int
        Samples a cycle; the recording's rate over it is written as the frequency.
    digital_samples_per_cycle : int, default 4
        Lines a cycle with a relay word, the first of every so many; a divisor of the former.
    event : str, optional
        Type of the event.
    targets : str, default ''
        Targets of the relay's front.
    figures : mapping of str to float, optional
        Further numbers of the summary by label, such as the currents at the trigger; None for no value.
    settings : str or None, optional
        Text of the relay's settings; None leaves that part out.
    """

    samples_per_cycle: int
    digital_samples_per_cycle: int = 4
    event: str = "ER"
    targets: str = ""
    figures: Mapping[str, float | None] = field(default_factory=lambda: MappingProxyType({}))
    settings: str | None = None


def write_cev(path: Path, recording: Recording, summary: EventSummary) -> Path:
    """Write an event report, which appears complete.

    Parameters
    ----------
    path : pathlib.Path
        Path of the file.
    recording : Recording
        The recording.
    summary : EventSummary
        What the report tells beside the samples.

    Returns
    -------
    pathlib.Path
        The path written.

    Raises
    ------
    ValueError
        If the format cannot hold the recording.
    OSError
        If the file cannot be written.
    """
    content = cev_bytes(recording, summary)
    partial = path.with_name(path.name + ".part")
    partial.write_bytes(content)
    return partial.replace(path)


def cev_bytes(recording: Recording, summary: EventSummary) -> bytes:
    """Return the contents of an event report; the recording's device is its firmware identification.

    Parameters
    ----------
    recording : Recording
        The recording.
    summary : EventSummary
        What the report tells beside the samples.

    Returns
    -------
    bytes
        The contents.

    Raises
    ------
    ValueError
        If samples are not evenly spaced or infinite, or a text breaks the format.
    """
    per_cycle, per_word = summary.samples_per_cycle, summary.digital_samples_per_cycle
    channels, samples = recording.samples.shape
    if recording.instants_s is not None or channels == 0 or samples == 0:
        raise ValueError("an event report holds evenly spaced samples of at least one channel")
    if np.isinf(recording.samples).any():
        raise ValueError("an event report holds finite values, or none where one is missing")
    if not 1 <= per_word <= per_cycle or per_cycle % per_word:
        raise ValueError(f"{per_cycle} samples a cycle cannot have {per_word} relay words a cycle")
    trigger_index = recording.trigger_index or 0
    if not 0 <= trigger_index < samples:
        raise ValueError(f"trigger at sample {trigger_index} of a recording of {samples} samples")
    head = {
        "FREQ": _number(recording.sample_rate_hz / per_cycle),
        "SAM/CYC_A": str(per_cycle),
        "SAM/CYC_D": str(per_word),
        "NUM_OF_CYC": _number(samples / per_cycle),
        "EVENT": _text(summary.event),
        "TARGETS": _text(summary.targets),
    } | {label: NO_VALUE if value is None else _number(value) for label, value in summary.figures.items()}
    names = f",{_bit_names(recording.digitals.names)}" if recording.digitals else ""
    labels = ",".join(_text(_label(channel)) for channel in recording.channels)
    parts = [
        closed('"FID"'),
        closed(_text(f"FID={recording.device}")),
        closed(DATE_LABELS),
        closed(_date(recording.trigger_time_ns)),
        closed(",".join(map(_text, head))),
        closed(",".join(head.values())),
        closed(f'{labels},"TRIG"{names}'),
        *_sample_lines(recording, trigger_index, per_cycle // per_word),
    ]
    if summary.settings is not None:
        parts += [closed('"SETTINGS"'), _settings(summary.settings)]
    return b"".join(parts)


def _sample_lines(recording: Recording, trigger_index: int, word_every: int) -> Iterator[bytes]:
    decimals = [_decimals(channel) for channel in recording.channels]
    words = _words(recording)
    for n, values in enumerate(recording.samples.T.tolist()):
        fields = [
            NO_VALUE if isnan(value) else _value(value, places)
            for value, places in zip(values, decimals, strict=True)
        ]
        fields.append('">"' if n == trigger_index else "")
        if words is not None:
            fields.append(f'"{words[n]}"' if n % word_every == 0 else '""')
        yield closed(",".join(fields))


def _words(recording: Recording) -> list[str] | None:
    """Relay word of every sample: four bits a digit, the first state in the highest."""
    if recording.digitals is None:
        return None
    digits = -(-len(recording.digitals.names) // 4)
    packed = np.packbits(recording.digitals.unpacked(), axis=1)
    return [row.tobytes().hex().upper()[:digits] for row in packed]


def _decimals(channel: Channel) -> int | None:
    """Places behind the point that resolve full scale / 32767; None where there is no full scale."""
    if not channel.full_scale:
        return None
    return min(max(0, ceil(-log10(channel.full_scale / _STEPS))), _MOST_DECIMALS)


def _value(value: float, places: int | None) -> str:
    if places is None:
        return f"{value:.{_DIGITS_WITHOUT_FULL_SCALE}g}"
    return f"{value:.{places}f}"


def _number(value: float) -> str:
    """In plain digits: the reader of the head takes no exponents."""
    if not abs(value) < _LARGEST_FIGURE:
        raise ValueError(f"{value!r} is no number of an event summary")
    return f"{value:.12f}".rstrip("0").rstrip(".")


def _label(channel: Channel) -> str:
    if any(sign in channel.name + channel.unit for sign in "()"):
        raise ValueError(f"parentheses stand around the unit: they cannot be in {channel.name!r}")
    unit = "" if channel.unit == "A" and channel.name.startswith("I") else f"({channel.unit})"
    return f"{channel.name}{unit}"


def _bit_names(names: tuple[str, ...]) -> str:
    for name in names:
        if not name or " " in name or name == UNUSED:
            raise ValueError(
                f"{name!r} cannot be the name of a state in a relay word: no blanks, no asterisk"
            )
    return _text(" ".join(names))


def _text(text: str) -> str:
    """Return a field in quotes."""
    if not _TEXT.fullmatch(text) or text != text.strip():
        raise ValueError(f"{text!r} cannot be a field of an event report: printable ASCII without quotes")
    return f'"{text}"'


def _date(time_ns: int) -> str:
    moment = _EPOCH + timedelta(milliseconds=time_ns // NANOSECONDS_PER_MILLISECOND)
    numbers = (moment.month, moment.day, moment.year, moment.hour, moment.minute, moment.second)
    return ",".join(map(str, (*numbers, moment.microsecond // 1000)))


def _settings(text: str) -> bytes:
    """Return the text in quotes, its lines ended by CR LF, which count for the checksum."""
    lines = text.replace("\r\n", "\n").split("\n")
    if not all(_TEXT.fullmatch(line) for line in lines):
        raise ValueError("settings of an event report are printable ASCII without quotes")
    content = ('"' + "\r\n".join(lines) + '",').encode("ascii")
    return content + f'"{checksum(content)}"\r\n'.encode("ascii")
