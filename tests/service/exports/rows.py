"""A small table with a column of each type."""

from dataclasses import dataclass
from operator import attrgetter

from service.exports.tables import Table, number, text, time, whole


@dataclass(frozen=True, slots=True)
class Row:
    time_ns: int | None = 1_760_000_000_123_456_789
    words: str | None = "PUMP-A1"
    level: float | None = 0.0121
    size: int | None = 7


TABLE: Table[Row] = Table(
    "rows",
    (
        time("time", "when it was", attrgetter("time_ns")),
        text("words", "what is said", attrgetter("words")),
        number("level", "1", "how much it is", attrgetter("level")),
        whole("size_bytes", "byte", "how long it is", attrgetter("size")),
    ),
)

EMPTY = Row(None, None, None, None)

HOSTILE = (
    "=1+1",
    "+1",
    "-1",
    "@SUM(A1)",
    "\t=1+1",
    "\r=1+1",
    "\n=1+1",
    " =1+1",
    "'=1+1",
    '"=1+1',
    "\u00a0=1+1",
    "\uff1d1+1",
    "=cmd|' /C calc'!A0",
    '=HYPERLINK("http://127.0.0.1/","x")',
    "a;=1+1;b",
    'a,"=1+1"',
    "nul\0inside",
    "bell\x07 escape\x1b[31m",
    "half a character \ud800",
    "other order \u202e",
    "_x0041_",
    "</t></is></c><c t='s'><f>1</f>",
    "x" * 40_000,
)
"""Texts that a relay, a file or a person may have written."""
