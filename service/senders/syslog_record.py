"""A record of syslog as octets (RFC 5424)."""

import re
import socket
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Final, Literal

from core.error_words import one_line
from core.time_stamps import SECONDS_END, rfc3339

SEVERITIES: Final = {"critical": 2, "high": 3, "medium": 4, "low": 5, "info": 6}
"""Severities of syslog for what is urgent to the service: crit, err, warning, notice, info."""

LARGEST_BYTES: Final = 2048
"""Every receiver should take so much (RFC 5424, 6.1); what is beyond is cut off."""

ENTERPRISE: Final = "32473"
"""The number of enterprises without one of their own (RFC 5612), in the names of structured data."""

_NAME = re.compile(r"[^!-~]|[=\]\"]")


@dataclass(frozen=True, slots=True)
class SyslogRecord:
    """A record. message_id: what kind of record it is.  data: its structured data, by name."""

    time_ns: int
    facility: int
    severity: int
    message_id: str
    text: str
    data: Mapping[str, str] = field(default_factory=dict)
    app: str = "statorwatch"

    def octets(self, host: str | None = None) -> bytes:
        """Return the record. host: this machine's name by default."""
        stamp = rfc3339(self.time_ns)
        stamp = f"{stamp[:SECONDS_END]}{stamp[SECONDS_END : SECONDS_END + 7]}Z"  # six digits at most
        header = " ".join(
            (
                f"<{self.facility * 8 + self.severity}>1",
                stamp,
                _word(host or socket.gethostname(), 255),
                _word(self.app, 48),
                "-",
                _word(self.message_id, 32),
            )
        )
        whole = (
            f"{header} {_structured(self.data)} ".encode() + b"\xef\xbb\xbf" + one_line(self.text).encode()
        )
        # What a cut may leave of a character at the end is not UTF-8.
        return whole[:LARGEST_BYTES].decode("utf-8", "ignore").encode()


def _structured(data: Mapping[str, str]) -> str:
    if not data:
        return "-"
    found = " ".join(f'{_word(name, 32)}="{_escaped(value)}"' for name, value in data.items())
    return f"[statorwatch@{ENTERPRISE} {found}]"


LONGEST_VALUE: Final = 100


def _escaped(value: str) -> str:
    return re.sub(r'(["\\\]])', r"\\\1", one_line(value)[:LONGEST_VALUE])


def _word(text: str, longest: int) -> str:
    """Return a word of the header: visible ASCII, or a dash for none."""
    return _NAME.sub("_", text)[:longest] or "-"


Framing = Literal["octet-counting", "newline"]


def framed(record: bytes, framing: Framing) -> bytes:
    """Return a record as it goes through a stream (RFC 6587; RFC 5425 knows the first alone)."""
    return record + b"\n" if framing == "newline" else f"{len(record)} ".encode() + record
