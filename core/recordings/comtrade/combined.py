"""The COMTRADE combined file (.CFF) of the 2013 edition: CFG and DAT as sections of one file (chapter 9)."""

import mmap
import re
from dataclasses import replace
from pathlib import Path

from core.recordings.comtrade.wide_text import LOOKED_AT, single_bytes, warn_of_wide
from core.recordings.data_section import DataSection
from core.recordings.errors import RecordingError, quoted
from core.recordings.repairs import Repairs

_SECTION = re.compile(
    rb"(?:(?<![^\r\n])|(?<=\A\xef\xbb\xbf))"  # at the beginning of a line, behind a byte order mark, too
    rb"--- *file type: *([A-Za-z]+)(?: +([A-Za-z0-9]+))?(?: *: *([0-9]{1,12}))? *---[ \t]*(?:\r*\n|\r)"
)
_PADDING = b"\x1a\r\n"
_MOST_SECTIONS = 16
"""There are four kinds: CFG, INF, HDR and DAT, the last."""


def split_combined(path: Path, repairs: Repairs) -> tuple[bytes, DataSection, str]:
    """Find the sections of a combined file.

    A lenient reader takes the data there are where the heading names another size.

    Parameters
    ----------
    path : pathlib.Path
        Path of the file.
    repairs : Repairs
        Collects what was mended; of a strict reader nothing is.

    Returns
    -------
    configuration : bytes
        The configuration section.
    data : DataSection
        Place of the data.
    data_format : str
        Data format that the heading names, upper case.

    Raises
    ------
    RecordingError
        If a section is missing, given twice, or of another size than it says.
    OSError
        If the file cannot be read.
    """
    with path.open("rb") as file:
        encoding = warn_of_wide(path, file.read(LOOKED_AT), repairs)
        if encoding is None:
            if not path.stat().st_size:
                raise RecordingError(path, "sections", expected="a CFG and a DAT section", found="neither")
            with mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as content:
                return _sections(path, content, None, repairs)
    rewritten = single_bytes(path.read_bytes(), encoding)
    return _sections(path, rewritten, rewritten, repairs)


def _sections(
    path: Path, content: bytes | mmap.mmap, rewritten: bytes | None, repairs: Repairs
) -> tuple[bytes, DataSection, str]:
    size = len(content)
    configuration: bytes | None = None
    at = 0
    for _ in range(_MOST_SECTIONS):
        section = _SECTION.search(content, at)
        if section is None:
            break
        kind = section[1].upper()
        if kind == b"DAT":
            if configuration is None:
                raise RecordingError(path, "sections", expected="CFG before DAT", found="DAT first")
            data_format = _format(section)
            if rewritten is not None and data_format != "ASCII":
                raise RecordingError(
                    path,
                    "DAT section",
                    expected="ASCII, as the file was saved as a text",
                    found=f"{data_format}, which that has changed",
                )
            data = DataSection(path, section.end(), size - section.end(), rewritten)
            return configuration, _of_size(data, section, repairs), data_format
        following = _SECTION.search(content, section.end())
        at = following.start() if following else size
        if kind == b"CFG":
            if configuration is not None:
                raise RecordingError(path, "sections", expected="one CFG", found="two")
            configuration = content[section.end() : at]
    raise RecordingError(
        path, "sections", expected="a CFG and a DAT section", found="no DAT" if configuration else "neither"
    )


def _format(section: re.Match[bytes]) -> str:
    return (section[2] or b"").decode("ascii").upper()


def _of_size(data: DataSection, section: re.Match[bytes], repairs: Repairs) -> DataSection:
    """Return the data after its heading, the last section; binary data are as long as the heading says."""
    if section[3] is None:
        return data
    size = int(section[3])
    if data.size >= size and data.is_padding_after(size, _PADDING):
        return replace(data, size=size)
    heading = quoted(section[0].decode("ascii").strip())
    fault = RecordingError(
        data.path, "DAT section", expected=f"{size} bytes after {heading}", found=f"{data.size} bytes"
    )
    repairs.mend(fault, "read to the end of the file")
    return data
