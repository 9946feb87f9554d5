"""Text files of a COMTRADE record that a program of Windows saved in UTF-16, or with a byte order mark."""

import codecs
from pathlib import Path

from core.recordings.code_pages import wide_encoding
from core.recordings.data_section import DataSection
from core.recordings.repairs import Repairs

LOOKED_AT = 64
"""Bytes at the beginning by which an encoding is told."""


def warn_of_wide(path: Path, content: bytes, repairs: Repairs) -> str | None:
    """Tell the encoding of a text that has more than one byte a letter, and warn of it.

    Parameters
    ----------
    path : pathlib.Path
        File of the text, for the warning.
    content : bytes
        The text, or its first bytes.
    repairs : Repairs
        Collects the warning.

    Returns
    -------
    str or None
        The encoding; None for a text of single bytes.
    """
    encoding = wide_encoding(content)
    if encoding is not None:
        repairs.warn(f"{path.name}: the text is {encoding[:6].upper()}: read as such")
    return encoding


def single_bytes(content: bytes, encoding: str) -> bytes:
    """Return a text with single bytes for all that is ASCII in it.

    Parameters
    ----------
    content : bytes
        The text.
    encoding : str
        Its encoding.

    Returns
    -------
    bytes
        The text in UTF-8.
    """
    return content.decode(encoding, errors="replace").removeprefix("\ufeff").encode("utf-8")


def ascii_text(data: DataSection, repairs: Repairs) -> DataSection:
    """Return the data of an ASCII file behind its byte order mark, in single bytes.

    Parameters
    ----------
    data : DataSection
        The file.
    repairs : Repairs
        Collects what departs from the standard.

    Returns
    -------
    DataSection
        The data.

    Raises
    ------
    OSError
        If the file cannot be read.
    """
    with data.opened() as file:
        begin = file.read(LOOKED_AT)
    encoding = warn_of_wide(data.path, begin, repairs)
    if encoding is not None:
        rewritten = single_bytes(data.content(), encoding)
        return DataSection(data.path, 0, len(rewritten), rewritten)
    mark = len(codecs.BOM_UTF8) if begin.startswith(codecs.BOM_UTF8) else 0
    return DataSection(data.path, data.offset + mark, data.size - mark)
