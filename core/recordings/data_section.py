"""Where a record's samples lie: a stretch of a file, read in pieces so that it is never in memory twice."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path
from typing import BinaryIO

_PIECE = 1 << 16


@dataclass(frozen=True, slots=True)
class DataSection:
    """A part of a file.

    Parameters
    ----------
    path : pathlib.Path
        The file.
    offset : int
        First byte of the part.
    size : int
        Number of bytes.
    rewritten : bytes or None, optional
        The whole file in letters of one byte, where it had wider ones; None for the file as it is.
    """

    path: Path
    offset: int
    size: int
    rewritten: bytes | None = field(default=None, repr=False)

    @contextmanager
    def opened(self) -> Iterator[BinaryIO]:
        """Open the file at the first byte of the section.

        Yields
        ------
        BinaryIO
            The open file.

        Raises
        ------
        OSError
            If the file cannot be read.
        """
        with self.path.open("rb") if self.rewritten is None else BytesIO(self.rewritten) as file:
            file.seek(self.offset)
            yield file

    def content(self) -> bytes:
        """Read all of the section.

        Returns
        -------
        bytes
            The bytes.

        Raises
        ------
        OSError
            If the file cannot be read.
        """
        with self.opened() as file:
            return file.read(self.size)

    def is_padding_after(self, start: int, padding: bytes) -> bool:
        """Return whether the section holds nothing but padding from some byte on.

        Parameters
        ----------
        start : int
            First byte that is looked at.
        padding : bytes
            Bytes that count as padding.

        Returns
        -------
        bool
            Whether there is nothing else.

        Raises
        ------
        OSError
            If the file cannot be read.
        """
        with self.opened() as file:
            file.seek(start, 1)
            left = self.size - start
            while left > 0:
                piece = file.read(min(left, _PIECE))
                if not piece or piece.strip(padding):
                    return False
                left -= len(piece)
        return True
