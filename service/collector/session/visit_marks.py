"""Which relays a gateway is busy with, kept in files that outlive its process.

Each visited relay has one file of one octet: busy, or idle between two requests. The kernel keeps what was
written however the process ends. A stop of the whole machine is no relay's fault, so nothing is synced.
"""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from urllib.parse import quote, unquote

BUSY, IDLE = b"1", b"0"


class VisitMark:
    """The file of one relay, there while the relay is visited. Used by that relay's session alone."""

    def __init__(self, file: int) -> None:
        self._file = file

    @contextmanager
    def idle(self) -> Iterator[None]:
        """Mark that nothing is asked of the relay for as long as the block lasts."""
        os.pwrite(self._file, IDLE, 0)
        try:
            yield
        finally:
            os.pwrite(self._file, BUSY, 0)


class VisitMarks:
    """The marks of one gateway, in a directory of its own.

    The sessions of the gateway write them; its parent process reads them when the gateway has ended.
    """

    def __init__(self, directory: Path) -> None:
        self._directory = directory

    @classmethod
    def of_gateway(cls, data_directory: Path, number: int) -> "VisitMarks":
        """Return the marks of one of the gateways of an installation."""
        return cls(data_directory / "visiting" / str(number))

    @contextmanager
    def mark(self, relay: str) -> Iterator[VisitMark]:
        """Mark a relay as visited, and busy, for as long as the block lasts. Raises OSError."""
        self._directory.mkdir(parents=True, exist_ok=True)
        path = self._directory / quote(relay, safe="")
        file = os.open(path, os.O_RDWR | os.O_CREAT | os.O_TRUNC, 0o600)
        try:
            os.pwrite(file, BUSY, 0)
            yield VisitMark(file)
        finally:
            os.close(file)
            path.unlink(missing_ok=True)

    def suspects(self) -> frozenset[str]:
        """Return the relays the ended gateway was busy with, or all it visited where it was busy with none.

        Raises OSError.
        """
        octets = {unquote(path.name): path.read_bytes() for path in self._paths()}
        return frozenset(relay for relay, octet in octets.items() if octet == BUSY) or frozenset(octets)

    def clear(self) -> None:
        """Remove all marks: the gateway has ended, and what it was busy with is known. Raises OSError."""
        for path in self._paths():
            path.unlink(missing_ok=True)

    def _paths(self) -> list[Path]:
        found = self._directory.iterdir() if self._directory.is_dir() else ()
        return [path for path in found if path.is_file()]
