"""The truth: what each relay has in its folder, read from the disk by nobody's code but this."""

import time
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from threading import Event, Thread
from types import TracebackType
from typing import Self

from tests.chaos.plant import ChaosPlant

LOOK_PERIOD_S = 0.3
COMTRADE = (".CFG", ".DAT", ".HDR", ".INF")
ENTRIES = (".CFG", ".CFF", ".CEV")
RecordKey = tuple[str, str]
"""Relay and name of a record, without suffix."""


@dataclass(frozen=True, slots=True)
class File:
    """Size [bytes] and SHA-256, hexadecimal."""

    size: int
    sha256: str


@dataclass(frozen=True, slots=True)
class RelayRecord:
    """A record in its relay's folder: its files by name, and when it was complete, UTC [ns]."""

    relay: str
    name: str
    files: Mapping[str, File]
    made_ns: int | None

    @property
    def is_whole(self) -> bool:
        """A relay that lost its mains while it wrote leaves half a record behind."""
        suffixes = {Path(name).suffix for name in self.files}
        return {".CFG", ".DAT"} <= suffixes or bool({".CFF", ".CEV"} & suffixes)

    def comtrade(self) -> dict[str, File]:
        return {name: file for name, file in self.files.items() if Path(name).suffix in COMTRADE}


class Ledger:
    """Watches the folders while the plant runs: when each record appeared, and whether one went."""

    def __init__(self, plant: ChaosPlant, files: Path) -> None:
        found = ((relay.name, relay.folder(files)) for relay in plant.relays)
        self._folders = {name: folder for name, folder in found if folder is not None}
        self._made_ns: dict[RecordKey, int] = {}
        self._versions: dict[RecordKey, set[tuple[int, int]]] = {}
        self._stopping = Event()
        self._thread = Thread(target=self._watch, name="ledger")

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._stopping.set()
        self._thread.join()

    def changed(self, key: RecordKey) -> bool:
        """Whether a record's files were listed with other sizes or times at another time."""
        return len(self._versions.get(key, ())) > 1

    def listed(self) -> set[RecordKey]:
        """Every record there is a file of now."""
        return {
            (relay, path.stem)
            for relay, folder in self._folders.items()
            for path in folder.iterdir()
            if path.suffix in (*ENTRIES, *COMTRADE)
        }

    def complete(self) -> set[RecordKey]:
        """Those of them that have the file that comes last."""
        return {key for key in self.listed() if key in self._made_ns}

    def discarded(self) -> set[RecordKey]:
        """Records that were complete once and are gone: the relay's own doing."""
        return set(self._made_ns) - self.listed()

    def records(self) -> list[RelayRecord]:
        """What is there now, every file read and hashed."""
        found: dict[RecordKey, dict[str, File]] = {}
        for relay, folder in self._folders.items():
            for path in sorted(folder.iterdir()):
                content = path.read_bytes()
                file = File(len(content), sha256(content).hexdigest())
                found.setdefault((relay, path.stem), {})[path.name] = file
        return [
            RelayRecord(relay, name, files, self._made_ns.get((relay, name)))
            for (relay, name), files in found.items()
        ]

    def look(self) -> None:
        """Note what is new."""
        for relay, folder in self._folders.items():
            if not folder.is_dir():
                continue
            for path in folder.iterdir():
                key = (relay, path.stem)
                with suppress(FileNotFoundError):
                    status = path.stat()
                    if path.suffix in ENTRIES:
                        # Change time, not modification time: the latter is what a relay's clock may falsify.
                        self._made_ns.setdefault(key, status.st_ctime_ns)
                        self._versions.setdefault(key, set()).add((status.st_size, status.st_mtime_ns))

    def _watch(self) -> None:
        while not self._stopping.wait(LOOK_PERIOD_S):
            began_s = time.monotonic()
            self.look()
            # A folder of many records takes long to look at: the machine is for others.
            self._stopping.wait(min(5.0, 4 * (time.monotonic() - began_s)))
