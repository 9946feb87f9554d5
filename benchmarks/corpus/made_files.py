"""Writes recordings as relays and recorders write them, sound, beside the standard, and damaged.

    python -m benchmarks.corpus.made_files FOLDER

Each is named after what it is; `make corpus DIR=FOLDER` tells how it is read.
"""

import argparse
import re
import struct
import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from core.recordings import Channel, Digitals, Quantity, Recording
from core.recordings.cev.writer import EventSummary, cev_bytes
from core.recordings.comtrade.writer import (
    DataFormat,
    Revision,
    combined_bytes,
    configuration_text,
    data_bytes,
)

Files = dict[str, bytes]
"""Contents of one record's files by suffix."""
Edit = Callable[[list[str]], list[str]]
"""Changes the lines of a configuration."""

SAMPLES, RATE_HZ = 800, 4000.0
STATES = ("START", "TRIP")
FIRST_CHANNEL, CHANNELS = 2, 7
FREQUENCY = FIRST_CHANNEL + CHANNELS + len(STATES)
"""Line of the configuration with the line frequency, from 0; those behind it follow."""
RATES, LAST_SAMPLE, START, TRIGGER, FORMAT, MULTIPLIER = range(FREQUENCY + 1, FREQUENCY + 7)
EDITIONS: tuple[tuple[Revision, tuple[DataFormat, ...]], ...] = (
    (1991, ("ASCII", "BINARY")),
    (1999, ("ASCII", "BINARY")),
    (2013, ("ASCII", "BINARY", "BINARY32", "FLOAT32")),
)


def main() -> int:
    """Write the files; exit status 0."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("folder", type=Path)
    folder: Path = parser.parse_args().folder
    print(f"{write(folder)} recordings in {folder}", file=sys.stderr)
    return 0


def write(folder: Path) -> int:
    """Write all recordings into folders below and return how many there are."""
    count = 0
    for name, files in _all():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        for suffix, content in files.items():
            path.with_name(path.name + suffix).write_bytes(content)
        count += 1
    return count


def recording(samples: int = SAMPLES, rate_hz: float = RATE_HZ) -> Recording:
    """Three currents, three voltages and a spare input, with two states."""
    angle = 2 * np.pi * (50 * np.arange(samples) / rate_hz - np.array([[0], [1], [2]]) / 3)
    currents = [Channel(f"I{p.upper()}", Quantity.CURRENT, p, "A", 400.0) for p in "abc"]
    voltages = [Channel(f"V{p.upper()}", Quantity.PHASE_VOLTAGE, p, "V", 8000.0) for p in "abc"]
    states = np.zeros((samples, len(STATES)), dtype=np.bool_)
    states[samples // 4 :, 0] = True
    return Recording(
        samples=np.vstack([80 * np.sin(angle - 0.5), 2694 * np.sin(angle), np.zeros((1, samples))]),
        sample_rate_hz=rate_hz,
        start_time_ns=1_732_170_600_250_000_000,
        channels=(*currents, *voltages, Channel("SPARE", Quantity.CURRENT, None, "A", 1.0)),
        trigger_index=samples // 4,
        nominal_frequency_hz=50.0,
        station="PLANT",
        device="RELAY",
        digitals=Digitals.of(STATES, states),
    )


def _all() -> Iterator[tuple[str, Files]]:
    record = recording()
    for revision, formats in EDITIONS:
        for data_format in formats:
            yield f"sound/{revision} {data_format}", _pair(record, revision, data_format)
    for data_format in EDITIONS[-1][1]:
        yield f"sound/combined {data_format}", {".cff": combined_bytes(record, data_format=data_format)}
    yield "sound/1999 header and information", {
        **_pair(record), ".HDR": b"event summary\r\n", ".INF": b"[Public Record_Information]\r\n",
    }  # fmt: skip
    report = cev_bytes(replace(record, sample_rate_hz=1600.0), EventSummary(32, settings="FNOM := 50"))
    yield "sound/event report", {".CEV": report}
    for name, edit in BESIDE_THE_STANDARD.items():
        yield f"beside the standard/{name}", _edited(record, edit)
    text = _pair(record, 1999, "ASCII")
    doubled = text[".DAT"].replace(b"\r\n", b"\r\n\r\n")
    yield "beside the standard/blank lines", {**text, ".DAT": doubled}
    yield from _saved(record, text, report)
    for name, edit in OF_2013.items():
        yield f"beside the standard/{name}", _edited(record, edit, 2013)
    for name, (stamps, decimals) in STAMPS.items():
        yield f"beside the standard/{name}", _stamped(stamps, decimals)
    for name, edit in CONTRADICTIONS.items():
        yield f"contradictions/{name}", _edited(record, edit)
    yield from _damaged(record, report)


def _saved(record: Recording, text: Files, report: bytes) -> Iterator[tuple[str, Files]]:
    """Files that editors, shells and terminals saved in their own forms."""
    pair, folder = _pair(record), "beside the standard"
    yield f"{folder}/line end behind binary data", {**pair, ".DAT": pair[".DAT"] + b"\r\n"}
    commas = text[".DAT"].replace(b"\r\n", b",\r\n")
    yield f"{folder}/ASCII lines that end in a comma", {**text, ".DAT": commas}
    wide = {suffix: content.decode().encode("utf-16") for suffix, content in text.items()}
    yield f"{folder}/UTF-16", wide
    yield (
        f"{folder}/UTF-16 of the configuration alone",
        {**pair, ".CFG": pair[".CFG"].decode().encode("utf-16")},
    )
    combined = combined_bytes(record, data_format="BINARY")
    yield f"{folder}/combined file with a byte order mark", {".cff": b"\xef\xbb\xbf" + combined}
    yield f"{folder}/event report in UTF-16", {".CEV": report.decode("latin-1").encode("utf-16")}
    yield f"{folder}/two event reports", {".CEV": report + report}
    yield f"{folder}/words behind an event report", {".CEV": report + b"\r\n=>>\r\nMOTOR 1\r\n"}
    stamps = np.arange(SAMPLES) * 250 + 1_000_000
    stamps[400:] -= 100_000
    stamps[600:] += 17_000_000
    content = bytearray(pair[".DAT"])
    for k, stamp in enumerate(stamps.tolist()):
        struct.pack_into("<I", content, k * (len(content) // SAMPLES) + 4, stamp)
    yield f"{folder}/a step back and a gap", {**pair, ".DAT": bytes(content)}
    files = _pair(record, 1991)
    yield f"{folder}/1991 with counts of -1", {**files, ".DAT": _with_minus_ones(files[".DAT"])}


def _with_minus_ones(data: bytes) -> bytes:
    """The data with the count -1 in the first channel of every tenth sample."""
    content, row = bytearray(data), len(data) // SAMPLES
    for k in range(0, SAMPLES, 10):
        struct.pack_into("<h", content, k * row + 8, -1)
    return bytes(content)


def _pair(record: Recording, revision: Revision = 1999, data_format: DataFormat = "BINARY") -> Files:
    text = configuration_text(record, revision=revision, data_format=data_format)
    return {
        ".CFG": text.encode(),
        ".DAT": data_bytes(record, revision=revision, data_format=data_format),
    }


def _edited(record: Recording, edit: Edit, revision: Revision = 1999) -> Files:
    files = _pair(record, revision)
    lines = files[".CFG"].decode().rstrip().split("\r\n")
    return {**files, ".CFG": "\r\n".join([*edit(lines), ""]).encode("utf-8")}


def _line(number: int, text: str) -> Edit:
    return lambda lines: [*lines[:number], text, *lines[number + 1 :]]


def _fields(numbers: range, changes: Mapping[int, str]) -> Edit:
    """Change fields, by their positions, of some lines."""

    def edit(lines: list[str]) -> list[str]:
        changed = list(lines)
        for number in numbers:
            fields = changed[number].split(",")
            for position, text in changes.items():
                fields[position] = text
            changed[number] = ",".join(fields)
        return changed

    return edit


def _rates(*rates: str) -> Edit:
    return lambda lines: [*lines[:RATES], str(len(rates)), *rates, *lines[START:]]


def _dates(start: str, trigger: str) -> Edit:
    return lambda lines: [*lines[:START], start, trigger, *lines[FORMAT:]]


def _as_ryb(line: str) -> str:
    """The line of a channel with the phases' letters of India."""
    for old, new in (("A", "R"), ("B", "Y"), ("C", "B")):
        for kind in "IV":
            if f",{kind}{old},{old}," in line:
                return line.replace(f",{kind}{old},{old},", f",{kind}{new},{new},")
    return line


_SPARE = range(FIRST_CHANNEL + CHANNELS - 1, FIRST_CHANNEL + CHANNELS)
_CURRENTS = range(FIRST_CHANNEL, FIRST_CHANNEL + 3)
_ALL = range(FIRST_CHANNEL, FIRST_CHANNEL + CHANNELS)
_WHOLE = f"{RATE_HZ:g},{SAMPLES}"

BESIDE_THE_STANDARD: dict[str, Edit] = {
    "constant spare channel": _fields(_SPARE, {5: "0", 6: "0"}),
    "constant spare channel without a ratio": _fields(_SPARE, {5: "0", 6: "0", 10: "0", 11: "0", 12: "S"}),
    "constant channel of 24": _fields(_SPARE, {5: "0.0000", 6: "24"}),
    "revision 2000": _fields(range(1), {2: "2000"}),
    "revision 1998": _fields(range(1), {2: "1998"}),
    "revision 0": _fields(range(1), {2: "0"}),
    "revision blank": _fields(range(1), {2: ""}),
    "revision 2024": _fields(range(1), {2: "2024"}),
    "rate without samples at the end": _rates(_WHOLE, f"1000,{SAMPLES}"),
    "rate of 0 without samples at the end": _rates(_WHOLE, f"0,{SAMPLES}"),
    "rate and last sample of 0": _rates(_WHOLE, "0,0"),
    "date with spaces": _line(START, "21/11/2024, 6:30: 0.250000"),
    "date and time in one field": _line(START, "21/11/2024 06:30:00.250000"),
    "day that there is not": _line(START, "31/02/2024,06:30:00.250000"),
    "date of zeros": _line(START, "00/00/0000,00:00:00.000000"),
    "blank date": _line(START, "  /  /    ,  :  :  "),
    "trigger that is no time": _line(TRIGGER, "32/11/2024,06:30:00.250000"),
    "no time multiplier": lambda lines: lines[:MULTIPLIER],
    "secondary values": _fields(_CURRENTS, {10: "100", 11: "5", 12: "S"}),
    "kilovolts": _fields(range(FIRST_CHANNEL + 3, FIRST_CHANNEL + 6), {4: "kV"}),
    "names in Latin-1 and Cyrillic": _fields(_CURRENTS, {1: "Ток фаза"}),
    "channel numbers that skip": _fields(_ALL, {0: "9"}),
    "trigger before the record": _line(TRIGGER, "20/11/2024,06:30:00.250000"),
    "skew of a fifth of a sample": _fields(_CURRENTS, {7: "50"}),
    "comma in the station's name": _line(0, "PUMP HOUSE, MCC 7,RELAY,1999"),
    "comma in a channel's name": _fields(range(FIRST_CHANNEL, FIRST_CHANNEL + 1), {1: "IA, pump 7"}),
    "comma in quotes": _fields(range(FIRST_CHANNEL, FIRST_CHANNEL + 1), {1: '"IA, pump 7"'}),
    "commas at the ends of lines": lambda lines: [lines[0], *(f"{line}," for line in lines[1:])],
    "year first": _dates("2024-11-21,06:30:00.250000", "2024-11-21,06:30:00.300000"),
    "month first": _dates("11/21/2024,06:30:00.250000", "11/21/2024,06:30:00.300000"),
    "year of two digits": _dates("21/11/24,06:30:00.250000", "21/11/24,06:30:00.300000"),
    "counts of samples for each rate": _rates(f"{RATE_HZ:g},300", f"{RATE_HZ:g},500"),
    "phases R, Y, B": lambda lines: [_as_ryb(line) for line in lines],
}  # fmt: skip

OF_2013: dict[str, Edit] = {
    "2013 without its last lines": lambda lines: lines[: MULTIPLIER + 1],
    "2013 without time quality": lambda lines: lines[: MULTIPLIER + 2],
    "2013 with a time code that is none": _line(MULTIPLIER + 1, "CET,CET"),
    "2013 half an hour off": _line(MULTIPLIER + 1, "-5h30,-5h30"),
    "2013 with +5h": _line(MULTIPLIER + 1, "+5h,+5h"),
}

_NS = 250_000
STAMPS: dict[str, tuple[Callable[[int], int], int]] = {
    "nanoseconds that start again": (lambda k: k * _NS % (1 << 32), 9),
    "nanoseconds that start again, with a gap": (
        lambda k: (k + 5000 * (k > 15_000)) * _NS % (1 << 32), 9,
    ),
    "microseconds of 16 bits": (lambda k: k * 250 % (1 << 16), 6),
}  # fmt: skip

CONTRADICTIONS: dict[str, Edit] = {
    "multiplier that is no number": _fields(_SPARE, {5: "nan"}),
    "secondary values of no ratio": _fields(_CURRENTS, {10: "0", 12: "S"}),
    "a rate of 0": _rates(f"0,{SAMPLES}"),
    "counts that do not add up": _line(1, "10,7A,2D"),
    "one channel too many": _line(1, "10,8A,2D"),
    "a limit above the other": _fields(_SPARE, {8: "1", 9: "-1"}),
    "another data format": _line(FORMAT, "BINARY64"),
    "another rate than the time stamps": _rates(f"{RATE_HZ / 2:g},{SAMPLES}"),
}


def _stamped(stamp: Callable[[int], int], decimals: int) -> Files:
    """A record of 8 s whose time stamps are those, to so many decimals of a second."""
    record = recording(32_000)
    files = _pair(record)
    content = bytearray(files[".DAT"])
    row = len(content) // 32_000
    for k in range(32_000):
        struct.pack_into("<I", content, k * row + 4, stamp(k))
    text = re.sub(r"(:\d\d\.)(\d{6})\b", lambda m: m[1] + m[2].ljust(decimals, "0"), files[".CFG"].decode())
    return {".CFG": text.encode(), ".DAT": bytes(content)}


def _damaged(record: Recording, report: bytes) -> Iterator[tuple[str, Files]]:
    sound, text = _pair(record), _pair(record, 1999, "ASCII")
    yield "damaged/data cut off", {**sound, ".DAT": sound[".DAT"][:-1005]}
    yield "damaged/bytes too many", {**sound, ".DAT": sound[".DAT"] + b"\x00" * 9}
    yield "damaged/lines cut off", {**text, ".DAT": text[".DAT"][:20_000]}
    yield "damaged/configuration cut off", {**sound, ".CFG": sound[".CFG"][:200]}
    yield "damaged/no data", {".CFG": sound[".CFG"]}
    yield "damaged/no configuration", {".DAT": sound[".DAT"]}
    yield "damaged/empty", {".CFG": b"", ".DAT": b""}
    yield "damaged/no recording at all", {".CFG": b"[settings]\nname = value\n", ".DAT": b"\x00" * 100}
    yield "damaged/zeros", {".CFG": b"\x00" * 5000, ".DAT": b"\x00" * 5000}
    huge = _edited(record, _rates(f"{RATE_HZ:g},9999999999"))
    yield "damaged/ten thousand million samples", huge
    combined = combined_bytes(record, data_format="FLOAT32")
    yield "damaged/combined file cut off", {".cff": combined[:-1000]}
    yield "damaged/event report cut off", {".CEV": report[: len(report) // 2]}
    yield "damaged/event report with a flipped digit", {".CEV": report.replace(b"1", b"7", 1)}


if __name__ == "__main__":
    sys.exit(main())
