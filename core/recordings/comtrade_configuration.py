"""The COMTRADE configuration file (.CFG): IEEE Std C37.111-1991, -1999 and -2013 (IEC 60255-24).

Every field that bears on the samples is checked; a field that does not fit is a RecordingError.
Clauses are those of C37.111-1999, chapter 5; differences of the other editions are named where they occur.
"""

import re
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from core.recordings.comtrade_lines import Line, Lines, quoted
from core.recordings.errors import RecordingError
from core.recordings.repairs import Repairs
from core.units import NANOSECONDS_PER_SECOND, SECONDS_PER_DAY

REVISIONS = {"1991": 1991, "1997": 1999, "1999": 1999, "2001": 1999, "2013": 2013}
"""Revision year in the file -> edition whose layout holds. IEC 60255-24:2001 is the 1999 edition;
Schneider's Sepam relays write 1997, the draft of it."""

DATA_FORMATS = ("ASCII", "BINARY", "BINARY32", "FLOAT32")

MAX_CHANNELS = 20_000
"""The standard allows 999 999; no recorder comes near, and a file of so many would take seconds to refuse."""
MAX_SAMPLES = 9_999_999_999
MAX_RATES = 999
MOST_RATIO = 1e12

_EPOCH = datetime(1970, 1, 1, tzinfo=UTC)
_YEAR = re.compile(r"199[1-9]|20[0-9]{2}", re.ASCII)
_DATE = re.compile(r"([0-9]{1,2})/([0-9]{1,2})/([0-9]{4}|[0-9]{2})", re.ASCII)
_TIME = re.compile(r"([0-9]{1,2}):([0-9]{1,2}):([0-9]{1,2})(?:\.([0-9]{1,9}))?", re.ASCII)
_UTC_OFFSET = re.compile(r"([+-]?)([0-9]{1,2})(?:h([0-9]{1,2}))?", re.ASCII)
_CONTROL = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f]")


@dataclass(frozen=True, slots=True)
class AnalogChannel:
    """One analogue channel line (5.3.3): value = gain * count + offset, in `unit`.

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
    start_time_ns, trigger_time_ns : int
        UTC [ns since 1970]. The editions of 1991 and 1999 know no time zone: their times are taken as UTC.
    data_format : str
        Format of the data file.
    time_stamp_unit_s : float
        Time that one step of the data file's time stamps stands for [s].
    """

    revision: int
    station: str
    device: str
    analog: tuple[AnalogChannel, ...]
    status_names: tuple[str, ...]
    nominal_frequency_hz: float | None
    rates: tuple[tuple[float, int], ...]
    sample_count: int
    start_time_ns: int
    trigger_time_ns: int
    data_format: str
    time_stamp_unit_s: float


def parse_configuration(path: Path, text: str, repairs: Repairs) -> Configuration:
    """Check and read the text of a configuration file.

    A lenient reader takes any revision year for the edition of its time and does not mind how channels are
    numbered.

    Parameters
    ----------
    path : pathlib.Path
        Name of the file, for messages.
    text : str
        Its text.
    repairs : Repairs
        Collects what was mended; of a strict reader nothing is.

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
    station, device, revision = _identification(lines.next("station, device and revision"), repairs)
    analog_count, status_count = _channel_counts(lines.next("channel counts"), len(lines))
    analog = tuple(
        _analog_channel(lines.next(f"analogue channel {k}"), k, revision, repairs)
        for k in range(1, analog_count + 1)
    )
    status_names = tuple(
        _status_channel(lines.next(f"status channel {k}"), k, revision, repairs)
        for k in range(1, status_count + 1)
    )
    nominal_frequency_hz = _nominal_frequency(lines.next("line frequency"))
    rates, sample_count = _rates(lines)
    start_ns, start_digits = _date_time(lines.next("time of the first sample"), revision)
    trigger_ns, trigger_digits = _date_time(lines.next("time of the trigger"), revision)
    data_format = _data_format(lines.next("data format"))
    time_multiplier, utc_offset_ns = 1.0, 0
    if revision >= 1999:
        line = lines.next("time multiplier")
        line.has_fields(1)
        time_multiplier = line.positive(0, "", 1e-9, 1e9)
    if revision >= 2013:
        utc_offset_ns = _utc_offset(lines.next("time code and local code"))
        _check_time_quality(lines.next("time quality and leap second"))
    for line in lines.remaining():
        if any(line.fields):
            raise line.refuse("", f"nothing more in a file of revision {revision}", line.quoted())
    # 2013, 7.4.9: nanoseconds if the file's times are written to more than six decimals.
    time_base_s = 1e-9 if max(start_digits, trigger_digits) > 6 else 1e-6
    return Configuration(
        revision=revision,
        station=station,
        device=device,
        analog=analog,
        status_names=status_names,
        nominal_frequency_hz=nominal_frequency_hz,
        rates=rates,
        sample_count=sample_count,
        start_time_ns=start_ns - utc_offset_ns,
        trigger_time_ns=trigger_ns - utc_offset_ns,
        data_format=data_format,
        time_stamp_unit_s=time_multiplier * time_base_s,
    )


def _identification(line: Line, repairs: Repairs) -> tuple[str, str, int]:
    line.has_fields(2, 3)
    station, device = line.fields[:2]
    if len(line.fields) == 2:  # 1991 has no revision year
        return station, device, 1991
    year = line.fields[2]
    if year in REVISIONS:
        return station, device, REVISIONS[year]
    fault = line.refuse("revision", f"one of {', '.join(REVISIONS)}", quoted(year))
    if not _YEAR.fullmatch(year):
        raise fault
    edition = max(edition for edition in REVISIONS.values() if edition <= int(year))
    repairs.mend(fault, f"read as the edition of {edition}")
    return station, device, edition


def _channel_counts(line: Line, line_count: int) -> tuple[int, int]:
    line.has_fields(3)
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
    line.has_fields(10 if revision == 1991 else 13)
    _check_index(line, number, repairs)
    gain = line.real(5, "multiplier a")
    if gain == 0:
        raise line.refuse("multiplier a", "a number other than 0", quoted(line.fields[5]))
    minimum, maximum = line.real(8, "minimum"), line.real(9, "maximum")
    if minimum > maximum:
        raise line.refuse("minimum", f"at most the maximum, {maximum:g}", f"{minimum:g}")
    return AnalogChannel(
        name=line.fields[1],
        phase=line.fields[2],
        unit=line.fields[4],
        gain=gain,
        offset=line.real(6, "offset b"),
        skew_us=line.real(7, "skew") if line.fields[7] else 0.0,
        minimum=minimum,
        maximum=maximum,
        to_primary=1.0 if revision == 1991 else _to_primary(line),
        ratio=None if revision == 1991 else _written_ratio(line),
    )


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
        line.has_fields(3 if revision == 1991 else 5)
        if line.fields[-1] not in ("0", "1", ""):
            raise line.refuse("normal state", "0 or 1", quoted(line.fields[-1]))
    except RecordingError as fault:
        repairs.mend(fault, "of such a line only the name is read")
    _check_index(line, number, repairs)
    return line.fields[1] if len(line.fields) > 1 else ""


def _nominal_frequency(line: Line) -> float | None:
    """Line frequency [Hz]; None where the field is empty or 0, as it is not critical (5.3.5)."""
    line.has_fields(1)
    if line.fields[0] == "" or line.real(0, "") == 0:
        return None
    return line.positive(0, "", 1e-3, 1e6)


def _rates(lines: Lines) -> tuple[tuple[tuple[float, int], ...], int]:
    """Rates with their last samples, and the number of samples (5.3.6)."""
    line = lines.next("number of sampling rates")
    line.has_fields(1)
    count = line.integer(0, "", 0, MAX_RATES)
    rates: list[tuple[float, int]] = []
    for k in range(1, max(count, 1) + 1):
        line = lines.next(
            "sampling rate and last sample" if count < 2 else f"sampling rate {k} and last sample"
        )
        line.has_fields(2)
        samples = line.integer(1, "last sample", rates[-1][1] + 1 if rates else 1, MAX_SAMPLES)
        if count == 0:
            if line.real(0, "sampling rate [Hz]") != 0:
                raise line.refuse(
                    "sampling rate [Hz]", "0, as the file announces 0 rates", quoted(line.fields[0])
                )
            return (), samples
        rates.append((line.positive(0, "sampling rate [Hz]", 1e-3, 1e9), samples))
    return tuple(rates), rates[-1][1]


def _date_time(line: Line, revision: int) -> tuple[int, int]:
    """Nanoseconds since 1970 in the file's own time zone, and the number of decimals written."""
    line.has_fields(2)
    date, time = _DATE.fullmatch(line.fields[0]), _TIME.fullmatch(line.fields[1])
    layout = "mm/dd/yy" if revision == 1991 else "dd/mm/yyyy"
    if date is None or time is None or (revision >= 1999 and len(date[3]) != 4):
        raise line.refuse("", f"{layout},hh:mm:ss.ssssss", line.quoted())
    day, month = (date[2], date[1]) if revision == 1991 else (date[1], date[2])
    year = int(date[3])
    if len(date[3]) == 2:  # two digits of a format born in 1991; its files reach into this century
        year += 1900 if year >= 70 else 2000
    if not 1970 <= year <= 2200:
        raise line.refuse("year", "1970 to 2200", str(year))
    try:
        moment = datetime(year, int(month), int(day), int(time[1]), int(time[2]), int(time[3]), tzinfo=UTC)
    except ValueError as error:
        raise line.refuse(
            "", f"a date and time, {layout},hh:mm:ss.ssssss", f"{line.quoted()} ({error})"
        ) from None
    elapsed = moment - _EPOCH
    fraction = time[4] or ""
    elapsed_s = elapsed.days * SECONDS_PER_DAY + elapsed.seconds
    ns = elapsed_s * NANOSECONDS_PER_SECOND + int(fraction.ljust(9, "0"))
    return ns, len(fraction)


def _data_format(line: Line) -> str:
    line.has_fields(1)
    data_format = line.fields[0].upper()
    if data_format not in DATA_FORMATS:
        raise line.refuse("", f"one of {', '.join(DATA_FORMATS)}", quoted(line.fields[0]))
    return data_format


def _utc_offset(line: Line) -> int:
    """Return how far the times are ahead of UTC [ns]; "-5h30" is 5.5 hours behind (2013, 7.4.11)."""
    line.has_fields(2)
    offset = _UTC_OFFSET.fullmatch(line.fields[0])
    if offset is None or int(offset[2]) > 14 or int(offset[3] or 0) > 59:
        raise line.refuse("time code", "hours ahead of UTC such as 0, +1 or -5h30", quoted(line.fields[0]))
    if line.fields[1] not in ("x", "X") and not _UTC_OFFSET.fullmatch(line.fields[1]):
        raise line.refuse(
            "local code", "hours ahead of UTC such as 0, +1 or -5h30, or x", quoted(line.fields[1])
        )
    minutes = int(offset[2]) * 60 + int(offset[3] or 0)
    return (-minutes if offset[1] == "-" else minutes) * 60 * NANOSECONDS_PER_SECOND


def _check_time_quality(line: Line) -> None:
    line.has_fields(2)
    if not re.fullmatch(r"[0-9A-Fa-f]", line.fields[0], re.ASCII):
        raise line.refuse("time quality", "a hexadecimal digit", quoted(line.fields[0]))
    line.integer(1, "leap second", 0, 3)
