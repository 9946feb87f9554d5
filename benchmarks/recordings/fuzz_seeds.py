"""Sound records of every format, and what becomes of them: the material of fuzz_recordings."""

import random
import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from core.recordings import Channel, Digitals, Quantity, Recording
from core.recordings.cev.compressed_ascii import checksum
from core.recordings.cev.writer import EventSummary, cev_bytes
from core.recordings.comtrade.writer import (
    DataFormat,
    Revision,
    combined_bytes,
    configuration_text,
    data_bytes,
)

TOKENS = [
    b"0", b"-1", b"1", b"9" * 10, b"1e308", b"-1e308", b"1e-320", b"1e999", b"nan", b"inf", b"1_0", b"0x1",
    b"", b",", b"\r\n", b"\n", b"\r", b"\x1a", b"\x00", b"\xff", b"\x85", b" ", "٣".encode(), b'"', b'""',
    b">", b"99999", b"65535", b"4294967295", b"999999", b"999999A", b"999999D", b"ASCII", b"FLOAT32", b"1991",
    b"2013", b"S", b"kA", b"00/00/0000", b"31/12/2200", b"23:59:60", b"-5h30", b"$$$$$$$", b'"SETTINGS"',
    b'"TRIG"', b"*", b"\x02", b"\x03", b"=>", b"FFFF", b"--- file type: DAT ASCII ---\r\n",
]  # fmt: skip

LARGE_BYTES = 6000

SEPARATE: list[tuple[Revision, DataFormat]] = [
    (1991, "ASCII"), (1991, "BINARY"), (1999, "ASCII"), (1999, "BINARY"),
]  # fmt: skip
COMBINED: list[DataFormat] = ["ASCII", "BINARY", "BINARY32", "FLOAT32"]

Files = dict[str, bytes]
"""Contents of one record's files by suffix; the first is what the reader is given."""


@dataclass(frozen=True, slots=True)
class Seed:
    """A sound record: the kind it is counted under, and its files."""

    kind: str
    files: Files

    @property
    def weight(self) -> float:
        """Large records are tried seldom: most of what can be wrong is wrong in small ones, too."""
        share = 1.0 if sum(map(len, self.files.values())) < LARGE_BYTES else 0.02
        return 3 * share if ".cev" in self.files else share


def seeds(corpus: Path | None) -> list[Seed]:
    """Records of every edition and format, and those of a folder of files, if one is given."""
    return [*_written(), *(_found(corpus) if corpus else ())]


def _written() -> list[Seed]:
    even = _record(40)
    gap = replace(even, instants_s=np.concatenate([np.arange(20), np.arange(25, 45)]) / even.sample_rate_hz)
    made: list[Seed] = []
    for recording in (even, gap, _record(3), _record(1200)):
        for revision, data_format in SEPARATE:
            cfg = configuration_text(recording, revision=revision, data_format=data_format)
            dat = data_bytes(recording, revision=revision, data_format=data_format)
            made.append(Seed(f"COMTRADE {revision} {data_format}", {".cfg": cfg.encode(), ".dat": dat}))
        for data_format in COMBINED:
            content = combined_bytes(recording, data_format=data_format)
            made.append(Seed(f"COMTRADE CFF {data_format}", {".cff": content}))
    cfg = configuration_text(even).replace("\r\n1\r\n960.0,40\r\n", "\r\n2\r\n960.0,20\r\n480.0,40\r\n")
    cfg = cfg.replace(",0,-32767,32767,1,1,P", ",20.5,-32767,32767,400,5,S")
    made.append(Seed("COMTRADE 1999 BINARY", {".cfg": cfg.encode(), ".dat": data_bytes(even)}))
    for recording, per_word in ((even, 4), (_record(3), 16), (_record(1920), 8)):
        summary = EventSummary(16, per_word, figures={"IA": 1.5, "IB": None}, settings="FNOM := 60\nRID := A")
        made.append(Seed("CEV", {".cev": cev_bytes(recording, summary)}))
    return made


def _record(samples: int) -> Recording:
    states = 18 if samples > 1000 else 5
    rng = np.random.default_rng(samples)
    channels = (
        Channel("IA", Quantity.CURRENT, "a", "A", 200.0),
        Channel("IB", Quantity.CURRENT, "b", "A", 200.0),
        Channel("VAB", Quantity.LINE_VOLTAGE, "ab", "V", 700.0),
    )
    values = rng.uniform(-100, 100, (3, samples))
    values[1, samples // 2] = np.nan
    return Recording(
        samples=values,
        sample_rate_hz=960.0,
        start_time_ns=1_732_170_600_123_456_000,
        channels=channels,
        trigger_index=samples // 2,
        nominal_frequency_hz=60.0,
        station="PLANT",
        device="RELAY",
        digitals=Digitals.of(tuple(f"RB{k:02d}" for k in range(states)), rng.random((samples, states)) > 0.5),
    )


def _found(corpus: Path) -> list[Seed]:
    found: list[Seed] = []
    for path in sorted(corpus.rglob("*")):
        suffix = path.suffix.casefold()
        beside = [p for p in path.parent.glob(f"{path.stem}.*") if p.suffix.casefold() == ".dat"]
        if suffix in (".cff", ".cev"):
            found.append(Seed(f"corpus {suffix}", {suffix: path.read_bytes()}))
        elif suffix == ".cfg" and beside and beside[0].stat().st_size < 1 << 20:
            found.append(Seed("corpus .cfg", {".cfg": path.read_bytes(), ".dat": beside[0].read_bytes()}))
    return found


def mutant(seed: Seed, rng: random.Random) -> Files:
    """One to four changes in one of the record's files; half of the CEV files get sound checksums again."""
    suffix = rng.choice([".cfg", ".cfg", ".dat"]) if ".dat" in seed.files else next(iter(seed.files))
    content = seed.files[suffix]
    for _ in range(rng.choice([1, 1, 1, 2, 2, 3, 4])):
        content = rng.choice(_CHANGES)(content, rng)
    if suffix == ".cev" and rng.random() < 0.5:
        content = _with_checksums(content)
    return seed.files | {suffix: content}


def _flipped(content: bytes, rng: random.Random) -> bytes:
    if not content:
        return content
    k = rng.randrange(len(content))
    return content[:k] + bytes([content[k] ^ 1 << rng.randrange(8)]) + content[k + 1 :]


def _exchanged(content: bytes, rng: random.Random) -> bytes:
    k = rng.randint(0, len(content))
    return content[:k] + rng.choice(TOKENS) + content[k + rng.randint(0, 12) :]


def _field_exchanged(content: bytes, rng: random.Random) -> bytes:
    """Another value in a whole field, which gets past the checks of layout."""
    k = rng.randint(0, len(content))
    start = max(content.rfind(b",", 0, k), content.rfind(b"\n", 0, k)) + 1
    ends = [end for end in (content.find(b",", k), content.find(b"\r", k)) if end >= 0]
    end = min(ends, default=len(content))
    return content[:start] + rng.choice(TOKENS) + content[max(start, end) :]


def _truncated(content: bytes, rng: random.Random) -> bytes:
    return content[: rng.randint(0, len(content))]


def _repeated(content: bytes, rng: random.Random) -> bytes:
    start, end = sorted((rng.randint(0, len(content)), rng.randint(0, len(content))))
    piece = content[start : min(end, start + 2000)]
    return content[:end] + piece * rng.randint(1, 3) + content[end:]


def _removed(content: bytes, rng: random.Random) -> bytes:
    start, end = sorted((rng.randint(0, len(content)), rng.randint(0, len(content))))
    return content[:start] + content[end:]


def _lines_swapped(content: bytes, rng: random.Random) -> bytes:
    lines = content.split(b"\n")
    k, j = rng.randrange(len(lines)), rng.randrange(len(lines))
    lines[k], lines[j] = lines[j], lines[k]
    return b"\n".join(lines)


_CHANGES: list[Callable[[bytes, random.Random], bytes]] = [
    _flipped, _exchanged, _exchanged, _field_exchanged, _field_exchanged, _field_exchanged, _truncated,
    _repeated, _removed, _lines_swapped,
]  # fmt: skip

_CLOSED_LINE = re.compile(rb'^(.*,)"[0-9A-F]{4}"', re.M)


def _with_checksums(content: bytes) -> bytes:
    return _CLOSED_LINE.sub(lambda line: line[1] + b'"' + checksum(line[1]).encode("ascii") + b'"', content)
