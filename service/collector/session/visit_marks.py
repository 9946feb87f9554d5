"""Which relays a gateway is busy with, written where its end as a process leaves it to be read.

One file a visited relay, of one octet: busy, or waiting between two requests. The kernel keeps what was
written however the process ends; a stop of the whole machine is no relay's fault, so nothing is synced.
"""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from urllib.parse import quote, unquote

BUSY, WAITING = b"1", b"0"


class Mark:
    """One relay's file, there while the relay is visited. Used by that relay's session alone."""

    def __init__(self, file: int) -> None:
        self._file = file

    @contextmanager
    def waiting(self) -> Iterator[None]:
        """For as long as nothing is asked of the relay."""
        os.pwrite(self._file, WAITING, 0)
        try:
            yield
        finally:
            os.pwrite(self._file, BUSY, 0)


class VisitMarks:
    """The marks of one gateway, in a directory of its own."""

    def __init__(self, directory: Path) -> None:
        self._directory = directory

    @contextmanager
    def mark(self, relay: str) -> Iterator[Mark]:
        """A visit: busy, unless told otherwise. Raises OSError."""
        self._directory.mkdir(parents=True, exist_ok=True)
        path = self._directory / quote(relay, safe="")
        file = os.open(path, os.O_RDWR | os.O_CREAT | os.O_TRUNC, 0o600)
        try:
            os.pwrite(file, BUSY, 0)
            yield Mark(file)
        finally:
            os.close(file)
            path.unlink(missing_ok=True)

    def suspects(self) -> frozenset[str]:
        """The relays the ended gateway was busy with; all it visited where it was waiting for each."""
        octets = {unquote(path.name): path.read_bytes() for path in self._paths()}
        return frozenset(relay for relay, octet in octets.items() if octet == BUSY) or frozenset(octets)

    def forget(self) -> None:
        """The gateway has ended, and what it was busy with is known."""
        for path in self._paths():
            path.unlink(missing_ok=True)

    def _paths(self) -> list[Path]:
        found = self._directory.iterdir() if self._directory.is_dir() else ()
        return [path for path in found if path.is_file()]


def visits_of(data_directory: Path, number: int) -> VisitMarks:
    """Of one of the gateways of an installation."""
    return VisitMarks(data_directory / "visiting" / str(number))
