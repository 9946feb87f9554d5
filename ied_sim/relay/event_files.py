"""The relay's folder of numbered event records, in which the oldest makes room for the newest."""

import os
import re
import threading
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from core.recordings import Recording
from core.recordings.cev.writer import EventSummary, write_cev
from core.recordings.comtrade.writer import write as write_comtrade
from core.units import NANOSECONDS_PER_SECOND
from ied_sim.profiles.profile import RecordFormat

FIRST_NUMBER = 10000
# The file that shows a record to be complete is the last to enter the folder and the first to leave it.
_SUFFIXES_IN_ORDER = (".DAT", ".HDR", ".CFG", ".CFF", ".CEV")


@dataclass(frozen=True, slots=True)
class _Written:
    """What a record was written from."""

    stem: str
    recording: Recording
    header: str
    summary: EventSummary
    utc_offset_min: int


class EventFiles:
    """Records in `folder`, at most `capacity` of them, named by `prefix` and number, each in all `formats`.

    Records are written under `staging`, which no client sees, and renamed when complete. All directories
    must be on one file system. Numbers go on after those found in the folders, so that a restarted relay uses
    none twice. `second` is a folder beside, made with its first record. With `keep_latest` the latest record
    can be replaced. Raises OSError where the directories cannot be made or read.
    """

    def __init__(
        self,
        folder: Path,
        staging: Path,
        *,
        capacity: int,
        prefix: str = "HR_",
        formats: Sequence[RecordFormat] = (RecordFormat("COMTRADE", 1999, "BINARY"),),
        second: Path | None = None,
        keep_latest: bool = False,
    ) -> None:
        self._folder = folder
        self._second = second
        self._keep_latest = keep_latest
        self._latest: _Written | None = None
        self._staging = staging
        self._capacity = capacity
        self._prefix = prefix
        self._formats = tuple(formats)
        self._name = re.compile(re.escape(prefix) + r"(\d{5,})\.(CFG|CFF|CEV)")
        self._stopping = threading.Event()
        self._folder.mkdir(parents=True, exist_ok=True)
        self._staging.mkdir(parents=True, exist_ok=True)
        self.last_number = max(self.numbers(), default=None)

    def numbers(self) -> list[int]:
        """Return the numbers of the complete records, oldest first."""
        names = (self._name.fullmatch(entry.name) for folder in self._folders() for entry in folder.iterdir())
        return sorted({int(name[1]) for name in names if name})

    def store(
        self,
        recording: Recording,
        header: str,
        summary: EventSummary,
        *,
        utc_offset_min: int = 0,
        grow_s: float = 0.0,
        in_second: bool = False,
    ) -> int:
        """Write one record completely, discard what is too old, and return the record's number.

        `utc_offset_min` is that of the clock of the recording's times, for formats that can tell it [min].
        With `grow_s` the largest of the record's files appears half at first and grows to its size in that
        time. With `in_second` the record appears in the second folder, if there is one.
        """
        number = FIRST_NUMBER if self.last_number is None else self.last_number + 1
        stem = f"{self._prefix}{number:05d}"
        record = _Written(stem, recording, header, summary, utc_offset_min)
        self._latest = record if self._keep_latest else None
        files = self._staged(record)
        growing = max(files, key=lambda file: file.stat().st_size) if grow_s else None
        rest = b"" if growing is None else _halve(growing)
        folder = self._second if in_second and self._second is not None else self._folder
        folder.mkdir(exist_ok=True)
        for file in files:
            file.rename(folder / file.name)
        self.last_number = number
        if growing is not None:
            _grow(folder / growing.name, rest, grow_s, self._stopping)
        for old in self.numbers()[: -self._capacity]:
            self._discard(old)
        return number

    def replace_latest(self, stem: str) -> bool:
        """Write another record over the latest, if that is called `stem`; return whether it is.

        It has the same sizes: the samples in reversed order, an hour later.
        """
        latest = self._latest
        if latest is None or latest.stem != stem or latest.recording.start_time_ns is None:
            return False
        other = replace(
            latest.recording,
            samples=latest.recording.samples[:, ::-1].copy(),
            start_time_ns=latest.recording.start_time_ns + 3600 * NANOSECONDS_PER_SECOND,
        )
        self._latest = replace(latest, recording=other)
        for file in self._staged(self._latest):
            place = next(
                (folder / file.name for folder in self._folders() if (folder / file.name).exists()), None
            )
            if place is None:
                file.unlink()
                continue
            # Listings tell whole seconds: a real relay takes longer than one for its next record.
            later_ns = place.stat().st_mtime_ns + 2 * NANOSECONDS_PER_SECOND
            os.utime(file, ns=(later_ns, later_ns))
            file.replace(place)
        return True

    def clear(self) -> None:
        """Discard all records. Numbers go on."""
        for number in self.numbers():
            self._discard(number)

    def stop(self) -> None:
        """Let no file grow any longer."""
        self._stopping.set()

    def _folders(self) -> list[Path]:
        return [folder for folder in (self._folder, self._second) if folder is not None and folder.is_dir()]

    def _staged(self, record: _Written) -> list[Path]:
        """Write the record under `staging` in all formats; return its files in their order."""
        for written in self._formats:
            self._write(written, record)
        files = [self._staging / f"{record.stem}{suffix}" for suffix in _SUFFIXES_IN_ORDER]
        return [file for file in files if file.exists()]

    def _write(self, written: RecordFormat, record: _Written) -> None:
        if written.kind == "CEV":
            write_cev(self._staging / f"{record.stem}.CEV", record.recording, record.summary)
            return
        suffix = ".CFF" if written.kind == "CFF" else ".CFG"
        write_comtrade(
            self._staging / f"{record.stem}{suffix}",
            record.recording,
            header_text=record.header,
            revision=written.revision,
            data_format=written.data_format,
            utc_offset_min=record.utc_offset_min,
        )

    def _discard(self, number: int) -> None:
        for suffix in reversed(_SUFFIXES_IN_ORDER):
            for folder in self._folders():
                (folder / f"{self._prefix}{number:05d}{suffix}").unlink(missing_ok=True)


def _halve(file: Path) -> bytes:
    """Cut a file to half and return what was cut off."""
    content = file.read_bytes()
    file.write_bytes(content[: len(content) // 2])
    return content[len(content) // 2 :]


def _grow(file: Path, rest: bytes, grow_s: float, stopping: threading.Event) -> None:
    parts = 20
    for k in range(parts):
        stopping.wait(grow_s / parts)
        if not file.exists():
            return
        with file.open("ab") as growing:
            growing.write(rest[k * len(rest) // parts : (k + 1) * len(rest) // parts])
