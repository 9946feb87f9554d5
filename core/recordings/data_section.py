"""Where a record's samples lie: a stretch of a file, read in pieces so that it is never in memory twice."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

_PIECE = 1 << 16


@dataclass(frozen=True, slots=True)
class DataSection:
    """`size` bytes of the file `path` from `offset` on."""

    path: Path
    offset: int
    size: int

    @contextmanager
    def opened(self) -> Iterator[BinaryIO]:
        """The file at the first byte of the section. Raises OSError."""
        with self.path.open("rb") as file:
            file.seek(self.offset)
            yield file

    def content(self) -> bytes:
        """All of it. Raises OSError."""
        with self.opened() as file:
            return file.read(self.size)

    def is_padding_after(self, start: int, padding: bytes) -> bool:
        """Whether the section holds nothing but bytes of `padding` from `start` on. Raises OSError."""
        with self.opened() as file:
            file.seek(start, 1)
            left = self.size - start
            while left > 0:
                piece = file.read(min(left, _PIECE))
                if not piece or piece.strip(padding):
                    return False
                left -= len(piece)
        return True
