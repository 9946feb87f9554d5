"""SEL Compressed ASCII event reports (.CEV): a strict reader, to a Recording in primary SI units.

Firmware identification, date, event summary, channel labels, one line a sample, settings; every line closed
by its checksum. Layout as in the instruction manuals of the SEL-351A, SEL-311L and SEL-387 (Compressed ASCII
Commands). What is decided here:

- The rate is SAM/CYC_A times the summary's FREQ: the relays sample in step with the line.
- The date is that of the trigger, taken as UTC: the relay's clock names no zone.
- The trigger is the line marked ">", or "*" where that (the largest current) has taken its place.
- Values are primary. A unit stands behind the label, "VA(kV)" or "VAkV"; without one, currents are in A and
  voltages in V. `$$$$$$$` and blanks are missing values.
- A relay word is written at SAM/CYC_D; between its lines the states hold. Positions named "*" carry none.
- An echoed command before the report and a prompt behind it are no part of it. Of a capture with several
  reports one is read, the first unless another is asked for; what stands behind the last is passed over.

A lenient reader believes lines with wrong checksums, takes the samples there are, and says so.
"""

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

import numpy as np

from core.recordings.cev.compressed_ascii import Row, checksum, is_row_next, rows
from core.recordings.cev.samples import CevSamples
from core.recordings.channel_roles import channel_roles
from core.recordings.code_pages import decode_text, wide_encoding
from core.recordings.errors import RecordingError, quoted
from core.recordings.length import check_length
from core.recordings.repairs import Repairs
from core.recordings.waveform import Channel, Recording
from core.units import NANOSECONDS_PER_MILLISECOND, NANOSECONDS_PER_SECOND, SECONDS_PER_DAY

MAX_BYTES = 32 << 20
MAX_HEAD_ROWS = 100

_EPOCH = datetime(1970, 1, 1, tzinfo=UTC)
_START = re.compile(rb'"FID"|"MONTH_?"')
_LONGEST_ECHO = 1000
_REAL = re.compile(r"[0-9]{1,9}(\.[0-9]{0,12})?", re.ASCII)
_INTEGER = re.compile(r"[0-9]{1,4}", re.ASCII)
_SETTINGS_BEGIN = re.compile(rb'\s*(?=")')
_SETTINGS_END = re.compile(rb'", *"([0-9A-Fa-f]{4})"')
_MOST_ENDS = 3
"""Places that are tried as the end of the settings; the text of a relay's has none inside."""
_BEFORE_A_REPORT = b"\r\n\x02"
_PROMPTS = b" \t\r\n\x02\x03\x1a=>"
_NOMINAL = re.compile(r"\b(?:FNOM|NFREQ)\s*:?=\s*(50|60)\b")


@dataclass(frozen=True, slots=True)
class EventReport:
    """All of one event report.

    Parameters
    ----------
    recording : Recording
        The samples.
    fid : str
        Firmware identification.
    summary : mapping of str to str
        Fields of the event summary as written, by label.
    settings : str
        Text of the relay's settings, "" where the report holds none.
    """

    recording: Recording
    fid: str
    summary: Mapping[str, str]
    settings: str


@dataclass(frozen=True, slots=True)
class _Field:
    """A value of the head, with the line it stands on."""

    row: Row
    text: str


def read_cev(
    path: Path, *, lenient: bool = False, most_values: int | None = None, report: int | None = None
) -> Recording:
    """Read the recording of an event report.

    Parameters
    ----------
    path : pathlib.Path
        Path of the file.
    lenient : bool, default False
        Mend what can be mended without guessing at values, and say so in the recording's repairs.
    most_values : int or None, optional
        Refuse a longer recording before it is held in memory: values of all channels and of VALUES_BESIDE
        more, which stand for times and states. None for any length.
    report : int or None, optional
        Which report of a capture with several, from 1. None for the first, with a warning if there are more.

    Returns
    -------
    Recording
        The recording.

    Raises
    ------
    RecordingError
        If the file contradicts itself; it names file, line and field.
    OSError
        If a file that exists cannot be read.
    """
    return read_event_report(path, lenient=lenient, most_values=most_values, report=report).recording


def read_event_report(
    path: Path, *, lenient: bool = False, most_values: int | None = None, report: int | None = None
) -> EventReport:
    """Read an event report.

    Parameters
    ----------
    path : pathlib.Path
        Path of the file.
    lenient : bool, default False
        Mend what can be mended without guessing at values, and say so in the recording's repairs.
    most_values : int or None, optional
        Refuse a longer recording before it is held in memory: values of all channels and of VALUES_BESIDE
        more, which stand for times and states. None for any length.
    report : int or None, optional
        Which report of a capture with several, from 1. None for the first, with a warning if there are more.

    Returns
    -------
    EventReport
        The recording with what the report tells beside it.

    Raises
    ------
    RecordingError
        If the file contradicts itself; it names file, line and field.
    OSError
        If a file that exists cannot be read.
    """
    repairs = Repairs(lenient=lenient)
    content = _content(path, repairs)
    begin, end = _extent(path, content, report, repairs)
    lines = rows(path, content, begin, end, repairs)
    head, labels = _head(path, lines)
    rate_hz, announced = _rate_and_count(head, labels)
    samples = CevSamples(labels)
    settings = ""
    for row in lines:
        if row.fields == ("SETTINGS",):
            settings = _settings(row, content, end, repairs)
            break
        check_length(path, len(samples.channels), samples.count + 1, most_values)
        samples.add(row)
        if samples.count == announced and not is_row_next(content, row.end, end):
            _tell_behind(path, content, row.end, end, repairs)
            break
    _check_count(path, samples.count, announced, repairs)
    recording = _recording(path, head, labels, samples, rate_hz, settings, repairs)
    date = {"FID", *_DATE}
    summary = {label: field.text for label, field in head.items() if label not in date}
    return EventReport(recording, recording.device, summary, settings)


def _extent(path: Path, content: bytes, report: int | None, repairs: Repairs) -> tuple[int, int]:
    """Return where the wanted report begins and where it ends at the latest."""
    first = _START.search(content[:_LONGEST_ECHO])
    if first is None:
        raise RecordingError(
            path, "line 1", expected='"FID" or "MONTH"', found=quoted(content[:60].decode("latin-1"))
        )
    again = re.compile(re.escape(first[0])).finditer(content, first.end())
    behind = (match.start() for match in again if content[match.start() - 1] in _BEFORE_A_REPORT)
    begins = [first.start(), *behind]
    if report is None and len(begins) > 1:
        repairs.warn(f"{path.name}: {len(begins)} event reports: the first is read")
    wanted = (report or 1) - 1
    if not 0 <= wanted < len(begins):
        raise RecordingError(
            path, "event report", expected=f"a number from 1 to {len(begins)}", found=str(report)
        )
    return begins[wanted], [*begins, len(content)][wanted + 1]


def _tell_behind(path: Path, content: bytes, start: int, end: int, repairs: Repairs) -> None:
    """Warn of words behind the last report; before another one, they are its echo."""
    words = b"" if end < len(content) else content[start:end].strip(_PROMPTS)
    if words:
        shown = quoted(words.split(b"\n")[0].decode("latin-1").strip())
        repairs.warn(f"{path.name}: what stands behind the event report is passed over: {shown}")


def _content(path: Path, repairs: Repairs) -> bytes:
    if not path.is_file():
        raise RecordingError(path, "file", expected="a file", found="none at this path")
    size = path.stat().st_size
    if size > MAX_BYTES:
        raise RecordingError(path, "size", expected=f"at most {MAX_BYTES} bytes", found=f"{size} bytes")
    content = path.read_bytes()
    encoding = wide_encoding(content)
    if encoding is None:
        return content
    repairs.warn(f"{path.name}: the text is {encoding[:6].upper()}: read as such")
    text = content.decode(encoding, errors="replace")
    return text.encode("latin-1", errors="replace")  # the checksums count bytes of one page


def _head(path: Path, lines: Iterator[Row]) -> tuple[dict[str, _Field], Row]:
    """Values of the head by their labels, and the line of channel labels that ends it."""
    head: dict[str, _Field] = {}
    for _, labels in zip(range(MAX_HEAD_ROWS), lines, strict=False):
        names = [label.strip("_ ").upper() for label in labels.fields]
        if "TRIG" in names:
            return head, labels
        values = next(lines, None)
        if values is None:
            break
        if len(values.fields) != len(names):
            raise values.refuse("", f"{len(names)} fields as line {labels.number}", str(len(values.fields)))
        head |= {
            name: _Field(values, text)
            for name, text in zip(names, values.fields, strict=True)
            if name not in head
        }
    raise RecordingError(path, "channel labels", expected='a line with "TRIG"', found="none")


def _recording(
    path: Path,
    head: Mapping[str, _Field],
    labels: Row,
    samples: CevSamples,
    rate_hz: float,
    settings: str,
    repairs: Repairs,
) -> Recording:
    trigger_index = _trigger_index(path, samples, repairs)
    before_trigger_ns = round((trigger_index or 0) / rate_hz * NANOSECONDS_PER_SECOND)
    values = samples.values()
    roles = channel_roles([(name, "", unit) for name, unit in samples.channels])
    values *= np.array([[role.scale] for role in roles])
    nominal = _NOMINAL.search(settings)
    return Recording(
        samples=values,
        sample_rate_hz=rate_hz,
        start_time_ns=_trigger_time_ns(head, labels) - before_trigger_ns,
        channels=tuple(
            Channel(name, role.quantity, role.phase, role.unit)
            for (name, _), role in zip(samples.channels, roles, strict=True)
        ),
        trigger_index=trigger_index,
        nominal_frequency_hz=float(nominal[1]) if nominal else None,
        device=head["FID"].text.removeprefix("FID=") if "FID" in head else "",
        digitals=samples.digitals(),
        repairs=repairs.notes,
        warnings=repairs.warnings,
        source=str(path),
    )


def _rate_and_count(head: Mapping[str, _Field], labels: Row) -> tuple[float, int]:
    """Return the sampling rate [Hz] and the number of samples that the summary tells."""
    frequency_hz = _number(head, labels, "FREQ", 1.0, 1000.0)
    per_cycle = _number(head, labels, "SAM/CYC_A", 1.0, 10_000.0)
    cycles = _number(head, labels, "NUM_OF_CYC", 1e-3, 1e6)
    return frequency_hz * per_cycle, round(per_cycle * cycles)


def _check_count(path: Path, found: int, announced: int, repairs: Repairs) -> None:
    if found == announced:
        return
    fault = RecordingError(
        path, "samples", expected=f"{announced}, as SAM/CYC_A and NUM_OF_CYC give", found=f"{found} lines"
    )
    if found == 0:
        raise fault
    repairs.mend(fault, f"{found} samples are read")


def _trigger_index(path: Path, samples: CevSamples, repairs: Repairs) -> int | None:
    marks = samples.trigger_marks
    if len(marks) == 1:
        return marks[0]
    fault = RecordingError(
        path, "TRIG", expected='one line marked ">", whose time is the date', found=f"{len(marks)} lines"
    )
    repairs.mend(fault, "the date is taken for that of the first sample")
    return None


def _field(head: Mapping[str, _Field], labels: Row, name: str) -> _Field:
    if name not in head:
        raise labels.refuse(f"before it, {name}", "a value", "no such label")
    return head[name]


def _number(head: Mapping[str, _Field], labels: Row, name: str, at_least: float, at_most: float) -> float:
    field = _field(head, labels, name)
    if not _REAL.fullmatch(field.text) or not at_least <= float(field.text) <= at_most:
        raise field.row.refuse(name, f"a number from {at_least:g} to {at_most:g}", quoted(field.text))
    return float(field.text)


_DATE = {"YEAR": 2200, "MONTH": 12, "DAY": 31, "HOUR": 23, "MIN": 59, "SEC": 59, "MSEC": 999}


def _trigger_time_ns(head: Mapping[str, _Field], labels: Row) -> int:
    """Return the report's date, taken as UTC [ns]; years of two digits are from 1970 on."""
    parts: dict[str, int] = {}
    for name, most in _DATE.items():
        field = _field(head, labels, name)
        if not _INTEGER.fullmatch(field.text) or int(field.text) > most:
            raise field.row.refuse(name, f"an integer from 0 to {most}", quoted(field.text))
        parts[name] = int(field.text)
    year = parts["YEAR"]
    if year < 100:
        year += 1900 if year >= 70 else 2000
    row = head["YEAR"].row
    if year < 1970:
        raise row.refuse("YEAR", "1970 to 2200", str(year))
    try:
        moment = datetime(
            year, parts["MONTH"], parts["DAY"], parts["HOUR"], parts["MIN"], parts["SEC"], tzinfo=UTC
        )
    except ValueError as error:
        raise row.refuse("date", "a date of the calendar", f"{error}") from None
    elapsed = moment - _EPOCH
    elapsed_s = elapsed.days * SECONDS_PER_DAY + elapsed.seconds
    return elapsed_s * NANOSECONDS_PER_SECOND + parts["MSEC"] * NANOSECONDS_PER_MILLISECOND


def _settings(row: Row, content: bytes, end: int, repairs: Repairs) -> str:
    """Return the quoted text behind "SETTINGS".

    Its checksum may count the line ends or not, and a transfer may have changed them: each is accepted. Where
    words follow, the text ends at the first checksum that is right, else at the last.
    """
    begin = _SETTINGS_BEGIN.match(content, row.end, end)
    first = row.end if begin is None else begin.end()
    final: re.Match[bytes] | None = None
    tried: list[re.Match[bytes]] = []
    for final in _SETTINGS_END.finditer(content, first + 1, end) if begin else ():
        if len(tried) < _MOST_ENDS:
            tried.append(final)
    if final is None:
        fault = row.refuse("settings", 'a text in quotes and its checksum such as ,"02E1"', "something else")
        repairs.mend(fault, "the settings are left out")
        return ""
    right = (one for one in tried if _is_right(content[first : one.start() + 2], one[1]))
    last = next(right, final)
    text = content[first : last.start() + 2]
    if not _is_right(text, last[1]):
        fault = row.refuse("settings, checksum", checksum(text), last[1].decode("ascii"))
        repairs.mend(fault, "the settings are read as they are")
    _tell_behind(row.path, content, last.end(), end, repairs)
    return decode_text(_with_plain_ends(text)[1:-2])


def _is_right(text: bytes, written: bytes) -> bool:
    lines = _with_plain_ends(text)
    counted = (
        text,
        lines.replace(b"\n", b""),
        *(lines.replace(b"\n", end) for end in (b"\r\n", b"\n", b"\r")),
    )
    return written.decode("ascii").upper() in map(checksum, counted)


def _with_plain_ends(text: bytes) -> bytes:
    return re.sub(rb"\r*\n|\r", b"\n", text)
