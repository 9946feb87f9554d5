"""Sound recordings changed in one place each, as relays, converters and editors do: read as an independent
reader finds them, or refused.

    python -m benchmarks.corpus.mutations

Changes that mean nothing (line ends, encodings, commas in names) must leave values, times and states alone.
Changes of a field must be refused, or read as PyPI's comtrade reads the changed file, or with a warning where
that cannot. Event reports have no other reader: of a changed field, all other values must be as before.
"""

import sys
import tempfile
import traceback
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from benchmarks.corpus.comtrade_peer import compared
from benchmarks.corpus.made_files import EDITIONS, FIRST_CHANNEL, Files, recording
from benchmarks.corpus.outcomes import Agreement
from core.recordings import Recording, RecordingError, read
from core.recordings.cev.compressed_ascii import checksum
from core.recordings.cev.writer import EventSummary, cev_bytes
from core.recordings.comtrade.writer import combined_bytes, configuration_text, data_bytes

LINE_ENDS = {"CR LF": b"\r\n", "LF": b"\n", "CR": b"\r", "CR CR LF": b"\r\r\n"}
ENCODINGS = {
    "UTF-8 with a mark": "utf-8-sig",
    "UTF-16": "utf-16",
    "UTF-16 LE": "utf-16-le",
    "UTF-16 BE": "utf-16-be",
    "UTF-32": "utf-32",
}
FIELDS = ("", "0", "1", "-1", "2.5", "99999", "x", "1e400", '"7"', "7,7", " 7 ")
"""What each field of each line is changed to."""
BEHIND = (b"\r\n", b"\n", b"\x1a", b"\x1a\r\n")


@dataclass(frozen=True, slots=True)
class Mutant:
    """A changed record.

    name: what was changed. files: contents by suffix, the entry first. sound: the record before the change,
    where it means nothing; None where another reader of the changed file decides. beside: the record before
    the change of one value, where there is no other reader.
    """

    name: str
    files: Files
    sound: Files | None
    beside: Files | None = None


@dataclass(frozen=True, slots=True)
class Verdict:
    """What became of a mutant. outcome: "read", "warned", "refused", "wrong" or "crashed"."""

    outcome: str
    note: str = ""


def mutants() -> Iterator[Mutant]:
    """Yield all mutants."""
    record = recording(samples=80)
    for revision, formats in EDITIONS:
        for data_format in formats:
            text = configuration_text(record, revision=revision, data_format=data_format).encode()
            data = data_bytes(record, revision=revision, data_format=data_format)
            files = {".CFG": text, ".DAT": data}
            name = f"{revision} {data_format}"
            yield from _unmeant(name, files, is_text=data_format == "ASCII")
            if data_format == "BINARY":
                yield from _fields(name, files)
    for data_format in EDITIONS[-1][1]:
        combined = {".cff": combined_bytes(record, data_format=data_format)}
        yield from _whole(f"combined {data_format}", combined, is_text=data_format == "ASCII")
    report = cev_bytes(replace(record, sample_rate_hz=1600.0), EventSummary(32, settings="FNOM := 50"))
    yield from _whole("event report", {".CEV": report}, is_text=True)
    yield from _reports({".CEV": report})


def _unmeant(name: str, files: Files, *, is_text: bool) -> Iterator[Mutant]:
    """Changes of line ends, encodings, names and what stands behind the data."""
    parts = {".CFG": [".CFG"], "both files": [".CFG", ".DAT"]} if is_text else {".CFG": [".CFG"]}
    for what, suffixes in parts.items():
        for end_name, end in LINE_ENDS.items():
            yield _changed(f"{name}, {what}, {end_name}", files, suffixes, _with_ends(end))
        for encoding_name, encoding in ENCODINGS.items():
            yield _changed(f"{name}, {what}, {encoding_name}", files, suffixes, _encoded(encoding))
    for behind in BEHIND:
        change = _followed_by(behind)
        yield _changed(f"{name}, data, {behind!r} behind", files, [".DAT"], change)
        yield _changed(f"{name}, configuration, {behind!r} behind", files, [".CFG"], change)
    lines = files[".CFG"].decode().rstrip("\r\n").split("\r\n")
    for number, written, changed in _names(lines):
        text = "\r\n".join([*lines[:number], changed, *lines[number + 1 :], ""]).encode()
        yield Mutant(f"{name}, line {number + 1}, {written}", {**files, ".CFG": text}, files)
    if is_text:
        yield _changed(f"{name}, commas behind", files, [".DAT"], lambda c: c.replace(b"\r\n", b",\r\n"))


def _names(lines: list[str]) -> Iterator[tuple[int, str, str]]:
    """Lines with a comma or quotes in a name, and with commas behind them."""
    named = {0: 0, FIRST_CHANNEL: 1, FIRST_CHANNEL + 7: 1}
    for number, position in named.items():
        fields = lines[number].split(",")
        for name in ("A, B", '"A, B"', '"A"'):
            changed = ",".join([*fields[:position], name, *fields[position + 1 :]])
            yield number, f"name {name}", changed
    for number in range(len(lines)):
        if number not in (0,):
            yield number, "a comma behind", lines[number] + ","


def _fields(name: str, files: Files) -> Iterator[Mutant]:
    """Every field of the lines that differ in kind, changed to something else."""
    lines = files[".CFG"].decode().rstrip("\r\n").split("\r\n")
    kinds = (0, 1, FIRST_CHANNEL, FIRST_CHANNEL + 7, *range(FIRST_CHANNEL + 9, len(lines)))
    for number in kinds:
        fields = lines[number].split(",")
        for position in range(len(fields)):
            for text in FIELDS:
                changed = ",".join([*fields[:position], text, *fields[position + 1 :]])
                content = "\r\n".join([*lines[:number], changed, *lines[number + 1 :], ""]).encode()
                what = f"{name}, line {number + 1}, field {position + 1}: {text!r}"
                yield Mutant(what, {**files, ".CFG": content}, None)


def _whole(name: str, files: Files, *, is_text: bool) -> Iterator[Mutant]:
    (suffix,) = files
    for end_name, end in LINE_ENDS.items() if is_text else ():
        yield _changed(f"{name}, {end_name}", files, [suffix], _with_ends(end))
    for encoding_name, encoding in ENCODINGS.items() if is_text else ():
        yield _changed(f"{name}, {encoding_name}", files, [suffix], _encoded(encoding))
    for behind in BEHIND:
        yield _changed(f"{name}, {behind!r} behind", files, [suffix], _followed_by(behind))


def _reports(files: Files) -> Iterator[Mutant]:
    """An event report with words around it, beside another, and with one field changed."""
    content = files[".CEV"]
    for name, changed in {
        "words behind": content + b"\r\n=>>\r\nMOTOR 1 Date: 01/05/26\r\n=>>QUIT\r\n",
        "an echo before": b"=>CEV\r\n" + content,
        "another behind": content + content.replace(b"1", b"2"),
    }.items():
        yield Mutant(f"event report, {name}", {".CEV": changed}, files)
    lines = content.split(b"\r\n")
    for number in range(3, 12):
        fields = lines[number].rsplit(b",", 1)[0].split(b",")
        for position in range(len(fields)):
            for text in (b"", b"x", b"1e999", b'"'):
                row = b",".join([*fields[:position], text, *fields[position + 1 :]]) + b","
                closed = row + b'"' + checksum(row).encode() + b'"'
                changed = b"\r\n".join([*lines[:number], closed, *lines[number + 1 :]])
                what = f"event report, line {number + 1}, field {position + 1}: {text!r}"
                yield Mutant(what, {".CEV": changed}, None, beside=files)


def _changed(name: str, files: Files, suffixes: list[str], change: Callable[[bytes], bytes]) -> Mutant:
    return Mutant(name, {**files, **{suffix: change(files[suffix]) for suffix in suffixes}}, files)


def _with_ends(end: bytes) -> Callable[[bytes], bytes]:
    return lambda content: content.replace(b"\r\n", end)


def _encoded(encoding: str) -> Callable[[bytes], bytes]:
    return lambda content: content.decode("latin-1").encode(encoding)


def _followed_by(behind: bytes) -> Callable[[bytes], bytes]:
    return lambda content: content + behind


def judged(mutant: Mutant, folder: Path) -> Verdict:
    """Read a mutant and compare it."""
    path = _written(mutant.files, folder, "MUTANT")
    try:
        found = read(path)
    except RecordingError as refusal:
        return Verdict("refused", str(refusal))
    except Exception:  # noqa: BLE001 - whatever else a reader raises is the defect looked for
        return Verdict("crashed", traceback.format_exc())
    outcome = "warned" if found.warnings else "read"
    if mutant.sound is not None:
        same = _same(found, read(_written(mutant.sound, folder, "SOUND")))
        return Verdict(outcome) if same else Verdict("wrong", "other values, times or states")
    if path.suffix == ".CEV":
        sound = read(_written(mutant.beside or mutant.files, folder, "SOUND"))
        changed = np.count_nonzero(~np.isclose(found.samples, sound.samples, rtol=1e-12, equal_nan=True))
        return Verdict(outcome) if changed <= 1 else Verdict("wrong", f"{changed} values changed")
    comparison = compared(found, path)
    if comparison.agreement is Agreement.PEER_FAILS and outcome == "read":
        return Verdict("wrong", f"read without a warning; comtrade: {comparison.notes[0]}")
    other_times = any(
        note.startswith("times of samples")
        or (note.startswith("starts") and not found.has_time_code and ", there 00" not in note)
        for note in comparison.notes
    )
    if comparison.agreement is Agreement.DIFFERS or (other_times and outcome == "read"):
        return Verdict("wrong", "; ".join(comparison.notes))
    return Verdict(outcome)


def _written(files: Mapping[str, bytes], folder: Path, stem: str) -> Path:
    for suffix, content in files.items():
        (folder / f"{stem}{suffix}").write_bytes(content)
    return folder / f"{stem}{next(iter(files))}"


def _same(found: Recording, sound: Recording) -> bool:
    states = [None if one.digitals is None else one.digitals.packed.tobytes() for one in (found, sound)]
    return (
        np.array_equal(found.samples, sound.samples, equal_nan=True)
        and np.array_equal(found.time_s, sound.time_s)
        and states[0] == states[1]
        and (found.start_time_ns, found.trigger_index) == (sound.start_time_ns, sound.trigger_index)
        and [one.unit for one in found.channels] == [one.unit for one in sound.channels]
    )


def main() -> int:
    """Judge all mutants and print how many became what; exit status 1 where one is wrong or crashed."""
    outcomes: Counter[str] = Counter()
    bad: list[str] = []
    with tempfile.TemporaryDirectory() as folder:
        for mutant in mutants():
            verdict = judged(mutant, Path(folder))
            outcomes[verdict.outcome] += 1
            if verdict.outcome in ("wrong", "crashed"):
                bad.append(f"{mutant.name}: {verdict.outcome}: {verdict.note}")
            elif mutant.sound is not None and verdict.outcome == "refused":
                outcomes["refused, though it means nothing"] += 1
                bad.append(f"{mutant.name}: {verdict.note}")
    print(f"{sum(outcomes[one] for one in ('read', 'warned', 'refused', 'wrong', 'crashed'))} mutants")
    for outcome, count in outcomes.most_common():
        print(f"{count:6} {outcome}")
    print("\n".join(bad))
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
