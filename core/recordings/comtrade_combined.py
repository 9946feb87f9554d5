"""The COMTRADE combined file (.CFF) of the 2013 edition: CFG and DAT as sections of one file (chapter 9)."""

import re
from pathlib import Path

from core.recordings.comtrade_configuration import quoted
from core.recordings.errors import RecordingError

_SECTION = re.compile(
    rb"^--- *file type: *([A-Za-z]+)(?: +([A-Za-z0-9]+))?(?: *: *([0-9]{1,12}))? *---[ \t]*\r?\n", re.M
)


def split_combined(path: Path, content: bytes) -> tuple[bytes, bytes, str]:
    """Configuration section, data section and the data format its heading names, upper case.

    Raises RecordingError if a section is missing, given twice, or of another size than it says.
    """
    configuration: bytes | None = None
    at = 0
    while section := _SECTION.search(content, at):
        kind = section[1].upper()
        if kind == b"DAT":
            if configuration is None:
                raise RecordingError(path, "sections", expected="CFG before DAT", found="DAT first")
            return configuration, _data(path, content[section.end() :], section), _format(section)
        following = _SECTION.search(content, section.end())
        at = following.start() if following else len(content)
        if kind == b"CFG":
            if configuration is not None:
                raise RecordingError(path, "sections", expected="one CFG", found="two")
            configuration = content[section.end() : at]
    raise RecordingError(
        path, "sections", expected="a CFG and a DAT section", found="no DAT" if configuration else "neither"
    )


def _format(section: re.Match[bytes]) -> str:
    return (section[2] or b"").decode("ascii").upper()


def _data(path: Path, data: bytes, section: re.Match[bytes]) -> bytes:
    """The data after its heading, the last section; binary data are as long as the heading says."""
    if section[3] is None:
        return data
    size = int(section[3])
    if len(data) < size or data[size:].strip(b"\x1a\r\n"):
        heading = quoted(section[0].decode("ascii").strip())
        raise RecordingError(
            path, "DAT section", expected=f"{size} bytes after {heading}", found=f"{len(data)} bytes"
        )
    return data[:size]
