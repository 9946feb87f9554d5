"""The COMTRADE configuration file (.CFG): IEEE Std C37.111-1991, -1999 and -2013 (IEC 60255-24).

Every field that bears on the samples is checked; a field that does not fit is a RecordingError.
Clauses are those of C37.111-1999, chapter 5; differences of the other editions are named where they occur.
"""

import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from core.recordings.comtrade.dates import record_times
from core.recordings.comtrade.editions import (
    FIELDS_OF_1991,
    FIELDS_SINCE_1999,
    edition_by_layout,
    read_identification,
)
from core.recordings.comtrade.lines import Line, Lines
from core.recordings.comtrade.rates import rate_lines, settled_rates
from core.recordings.comtrade.time_codes import utc_offset_ns
from core.recordings.errors import RecordingError, quoted
from core.recordings.repairs import Repairs

DATA_FORMATS = ("ASCII", "BINARY", "BINARY32", "FLOAT32")

MAX_CHANNELS = 20_000
"""The standard allows 999 999; no recorder comes near, and a file of so many would take seconds to refuse."""
MOST_RATIO = 1e12
MOST_NAMED = 12
"""Constant channels that are named; a recorder may have hundreds of spare inputs."""

MICROSECOND_S, NANOSECOND_S = 1e-6, 1e-9
"""What time stamps count: the latter in files whose dates have more than six decimals (2013, 7.4.9)."""

_NUMBER = re.compile(r"[-+]?[0-9.]+([eE][-+]?[0-9]+)?", re.ASCII)
_CONTROL = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f]")


@dataclass(frozen=True, slots=True)
class AnalogChannel:
    """One analogue channel line (5.3.3): value = gain * count + offset, in `unit`; constant where gain is 0.

    Parameters
    ----------
    name : str
        Name of the channel.
    phase : str
        Phase as written.
    unit : str
        Unit as written.
    gain : float
        Factor of the counts.
    offset : float
        Value of the count 0.
    skew_us : float
        Delay of the channel's samples within the sampling period [us].
    minimum, maximum : float
        Range of the counts.
    to_primary : float
        Transformer ratio if the values are secondary ("S"), 1 if they are primary ("P"). The 1991 edition has
        neither: its values are taken in the unit as written.
    ratio : float or None
        Transformer ratio as written; None where there is none, or it is 1 or no ratio.
    """

    name: str
    phase: str
    unit: str
    gain: float
    offset: float
    skew_us: float
    minimum: float
    maximum: float
    to_primary: float
    ratio: float | None


@dataclass(frozen=True, slots=True)
class Configuration:
    """A checked configuration file.

    Parameters
    ----------
    revision : int
        Year of the edition.
    station : str
        Name of the station.
    device : str
        Name of the recorder.
    analog : tuple of AnalogChannel
        The analogue channels.
    status_names : tuple of str
        Names of the status channels.
    nominal_frequency_hz : float or None
        Line frequency as written [Hz], None if there is none.
    rates : tuple of (float, int)
        Sampling rates [Hz], each with the number of the last sample taken at it, in ascending order; empty
        where the samples' own time stamps are the only time base.
    sample_count : int
        Number of samples.
    start_time_ns, trigger_time_ns : int or None
        UTC [ns since 1970]. The editions of 1991 and 1999 know no time zone: their times are taken as UTC.
        None where a lenient reader found no time.
    has_time_code : bool
        Whether the file tells how far its times are ahead of UTC (2013, 7.4.11).
    data_format : str
        Format of the data file.
    time_multiplier : float
        Factor of the data file's time stamps.
    time_base_s : float
        What they count: microseconds or nanoseconds [s].
    """

    revision: int
    station: str
    device: str
    analog: tuple[AnalogChannel, ...]
    status_names: tuple[str, ...]
    nominal_frequency_hz: float | None
    rates: tuple[tuple[float, int], ...]
    sample_count: int
    start_time_ns: int | None
    trigger_time_ns: int | None
    has_time_code: bool
    data_format: str
    time_multiplier: float
    time_base_s: float

    @property
    def time_stamp_unit_s(self) -> float:
        """Time that one step of the data file's time stamps stands for [s]."""
        return self.time_multiplier * self.time_base_s

    @property
    def layout(self) -> "Layout":
        """What a sample looks like in the data."""
        return Layout(len(self.analog), len(self.status_names), self.data_format)


@dataclass(frozen=True, slots=True)
class Layout:
    """What a sample looks like in the data.

    Parameters
    ----------
    analog, status : int
        Number of analogue and of status channels.
    data_format : str
        Format of the data file.
    """

    analog: int
    status: int
    data_format: str


def parse_configuration(
    path: Path, text: str, repairs: Repairs, samples_held: Callable[[Layout], int]
) -> Configuration:
    """Check and read the text of a configuration file.

    A lenient reader takes any revision year for the edition of its time, tells the edition from the layout
    where there is no year, and does not mind how channels are numbered.

    Parameters
    ----------
    path : pathlib.Path
        Name of the file, for messages.
    text : str
        Its text.
    repairs : Repairs
        Collects what was mended; of a strict reader nothing is.
    samples_held : callable
        Number of samples that the data hold in a layout; called where there are several sampling rates.

    Returns
    -------
    Configuration
        The checked configuration.

    Raises
    ------
    RecordingError
        If the text is at fault; it names line and field.
    """
    text = text.rstrip("\x1a\r\n\t ")
    if control := _CONTROL.search(text):
        raise RecordingError(path, "text", expected="no control characters", found=repr(control.group()))
    lines = Lines(path, text)
    station, device, edition = read_identification(lines, repairs)
    analog_count, status_count = _channel_counts(
        lines.next("channel counts").of(3, repairs=repairs), len(lines)
    )
    revision = edition or edition_by_layout(lines.ahead())
    analog = tuple(
        _analog_channel(lines.next(f"analogue channel {k}"), k, revision, repairs)
        for k in range(1, analog_count + 1)
    )
    status_names = tuple(
        _status_channel(lines.next(f"status channel {k}"), k, revision, repairs)
        for k in range(1, status_count + 1)
    )
    nominal_frequency_hz = _nominal_frequency(lines.next("line frequency").of(1, repairs=repairs))
    written_rates = rate_lines(lines, repairs)
    start, trigger = record_times(
        lines.next("time of the first sample"), lines.next("time of the trigger"), revision, repairs
    )
    data_format = _data_format(lines.next("data format").of(1, repairs=repairs))
    time_multiplier = (
        1.0 if revision == 1991 else _time_multiplier(lines, repairs, needed=written_rates.announced == 0)
    )
    if edition is None and revision == 1999 and lines.ahead():
        revision = 2013  # nothing else has lines behind the time multiplier
    has_time_code = (revision >= 2013 and bool(lines.ahead())) or (start.is_utc and trigger.is_utc)
    ahead_ns = utc_offset_ns(lines, repairs) if revision >= 2013 else 0
    for line in lines.remaining():
        if any(line.fields):
            raise line.refuse("", f"nothing more in a file of revision {revision}", line.quoted())
    _tell_constants(path, analog, repairs)
    rates, sample_count = settled_rates(
        written_rates, lambda: samples_held(Layout(analog_count, status_count, data_format)), repairs
    )
    return Configuration(
        revision=revision,
        station=station,
        device=device,
        analog=analog,
        status_names=status_names,
        nominal_frequency_hz=nominal_frequency_hz,
        rates=rates,
        sample_count=sample_count,
        start_time_ns=None if start.ns is None or ahead_ns is None else start.ns - ahead_ns,
        trigger_time_ns=None if trigger.ns is None or ahead_ns is None else trigger.ns - ahead_ns,
        has_time_code=has_time_code,
        data_format=data_format,
        time_multiplier=time_multiplier,
        time_base_s=NANOSECOND_S if max(start.decimals, trigger.decimals) > 6 else MICROSECOND_S,
    )


def _channel_counts(line: Line, line_count: int) -> tuple[int, int]:
    total = line.integer(0, "total", 1, MAX_CHANNELS)
    counts = []
    for index, letter, field in ((1, "A", "analogue channels"), (2, "D", "status channels")):
        text = line.fields[index]
        if not re.fullmatch(rf"[0-9]{{1,6}}{letter}", text, re.ASCII | re.IGNORECASE):
            raise line.refuse(field, f"a count followed by {letter}", quoted(text))
        counts.append(int(text[:-1]))
    analog, status = counts
    if analog + status != total:
        raise line.refuse("total", f"{analog} + {status} = {analog + status} channels", str(total))
    if analog == 0:
        raise line.refuse("analogue channels", "at least one", "none")
    if total > line_count:
        raise line.refuse("total", f"at most the file's {line_count} lines", str(total))
    return analog, status


def _check_index(line: Line, number: int, repairs: Repairs) -> None:
    try:
        line.integer(0, "index", number, number)
    except RecordingError as fault:
        repairs.mend(fault, "channels are counted in the order of their lines")


def _analog_channel(line: Line, number: int, revision: int, repairs: Repairs) -> AnalogChannel:
    line = line.of(FIELDS_OF_1991 if revision == 1991 else FIELDS_SINCE_1999, repairs=repairs, name=1)
    _check_index(line, number, repairs)
    if "," in line.fields[1]:
        _check_behind_commas(line, revision)
    gain, offset = line.real(5, "multiplier a"), line.real(6, "offset b")
    if gain == 0:
        return _constant(line, revision, offset)
    minimum, maximum = line.real(8, "minimum"), line.real(9, "maximum")
    if minimum > maximum:
        raise line.refuse("minimum", f"at most the maximum, {maximum:g}", f"{minimum:g}")
    return AnalogChannel(
        name=line.fields[1],
        phase=line.fields[2],
        unit=line.fields[4],
        gain=gain,
        offset=offset,
        skew_us=line.real(7, "skew") if line.fields[7] else 0.0,
        minimum=minimum,
        maximum=maximum,
        to_primary=1.0 if revision == 1991 else _to_primary(line),
        ratio=None if revision == 1991 else _written_ratio(line),
    )


def _check_behind_commas(line: Line, revision: int) -> None:
    """Refuse a line whose further field is no part of the name: the numbers would be in other places."""
    for index, field in enumerate(("multiplier a", "offset b", "skew", "minimum", "maximum"), 5):
        if line.fields[index] or field != "skew":
            line.real(index, field)
    if _NUMBER.fullmatch(line.fields[4]):
        raise line.refuse("unit", "no number", quoted(line.fields[4]))
    if revision >= 1999:
        _to_primary(line)


def _constant(line: Line, revision: int, value: float) -> AnalogChannel:
    """Return a channel whose multiplier is 0: it has the value b whatever its counts, limits and skew are.

    The ratio only counts for a value other than 0.
    """
    return AnalogChannel(
        name=line.fields[1],
        phase=line.fields[2],
        unit=line.fields[4],
        gain=0.0,
        offset=value,
        skew_us=0.0,
        minimum=0.0,
        maximum=0.0,
        to_primary=1.0 if revision == 1991 or value == 0 else _to_primary(line),
        ratio=None,
    )


def _tell_constants(path: Path, analog: tuple[AnalogChannel, ...], repairs: Repairs) -> None:
    constants = [channel for channel in analog if channel.gain == 0]
    if constants:
        shown = ", ".join(f"{quoted(c.name)} ({c.offset:g} {c.unit})".strip() for c in constants[:MOST_NAMED])
        rest = len(constants) - MOST_NAMED
        more = f" and {rest} more" if rest > 0 else ""
        repairs.warn(f"{path.name}: constant: {shown}{more}: the multiplier a is 0, so that the value is b")


def _to_primary(line: Line) -> float:
    """Return the factor that makes the channel's values primary ones (5.3.3.11 to 5.3.3.13)."""
    primary, secondary = line.real(10, "primary ratio"), line.real(11, "secondary ratio")
    scaling = line.fields[12].upper()
    if scaling not in ("P", "S"):
        raise line.refuse("PS", "P or S", quoted(line.fields[12]))
    if scaling == "P":
        return 1.0
    if primary <= 0 or secondary <= 0:
        raise line.refuse(
            "transformer ratio",
            "two positive numbers, as the values are secondary",
            f"{primary:g}:{secondary:g}",
        )
    ratio = primary / secondary
    if not 0 < ratio < MOST_RATIO:
        raise line.refuse("transformer ratio", "a ratio below 1e12", f"{ratio:g}")
    return ratio


def _written_ratio(line: Line) -> float | None:
    primary, secondary = line.real(10, "primary ratio"), line.real(11, "secondary ratio")
    if primary <= 0 or secondary <= 0:
        return None
    ratio = primary / secondary
    return ratio if 0 < ratio < MOST_RATIO and ratio != 1 else None


def _status_channel(line: Line, number: int, revision: int, repairs: Repairs) -> str:
    try:
        line = line.of(3 if revision == 1991 else 5, repairs=repairs, name=1)
        if line.fields[-1] not in ("0", "1", ""):
            raise line.refuse("normal state", "0 or 1", quoted(line.fields[-1]))
    except RecordingError as fault:
        repairs.mend(fault, "of such a line only the name is read")
    _check_index(line, number, repairs)
    return line.fields[1] if len(line.fields) > 1 else ""


def _nominal_frequency(line: Line) -> float | None:
    """Line frequency [Hz]; None where the field is empty or 0, as it is not critical (5.3.5)."""
    if line.fields[0] == "" or line.real(0, "") == 0:
        return None
    return line.positive(0, "", 1e-3, 1e6)


def _time_multiplier(lines: Lines, repairs: Repairs, *, needed: bool) -> float:
    """Return the factor of the time stamps; 1 where a lenient reader misses it and does not need it."""
    try:
        line = lines.next("time multiplier")
    except RecordingError as fault:
        if needed:
            raise
        repairs.mend(fault, "taken as 1")
        return 1.0
    return line.of(1, repairs=repairs).positive(0, "", 1e-9, 1e9)


def _data_format(line: Line) -> str:
    data_format = line.fields[0].upper()
    if data_format not in DATA_FORMATS:
        raise line.refuse("", f"one of {', '.join(DATA_FORMATS)}", quoted(line.fields[0]))
    return data_format
