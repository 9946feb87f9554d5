"""What a report says, before it is a PDF or a workbook: blocks of facts, words, tables and pictures."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import StrEnum

Cell = str | int | float | None


class ColumnKind(StrEnum):
    """What the cells of a column are, and so how they are written; each may be empty."""

    TEXT = "text"
    SHARE = "share"
    """A share of one, written in percent."""
    NUMBER = "number"
    WHOLE = "whole"
    TIME = "time"
    """UTC, nanoseconds since 1970; written in the report's time zone."""


@dataclass(frozen=True, slots=True)
class Column:
    """A column with its heading. width: how much of the page it takes, beside the others."""

    heading: str
    kind: ColumnKind = ColumnKind.TEXT
    width: float = 1.0


@dataclass(frozen=True, slots=True)
class Table:
    """Rows of cells. name: of its sheet in a workbook.  left_out: how many further rows there would be.

    empty: what is said where there are no rows.
    """

    name: str
    columns: Sequence[Column]
    rows: Sequence[Sequence[Cell]]
    left_out: int = 0
    empty: str = "none"


@dataclass(frozen=True, slots=True)
class Facts:
    """Names with what they are."""

    facts: Sequence[tuple[str, str]]


@dataclass(frozen=True, slots=True)
class Words:
    """A sentence or some. tone: a motor's state, whose mark stands before it; "" without."""

    text: str
    tone: str = ""


@dataclass(frozen=True, slots=True)
class Picture:
    """A picture as SVG, with what it shows in words. width: a share of the page's."""

    svg: str
    words: str = ""
    width: float = 1.0


Content = Table | Facts | Words | Picture


@dataclass(frozen=True, slots=True)
class Block:
    """A part of a report under a heading."""

    heading: str
    contents: Sequence[Content]


@dataclass(frozen=True, slots=True)
class ReportDocument:
    """A report. subject: what it is of.  until_ns: nothing later than this is in it.

    time_zone: in which its times are written.
    """

    title: str
    subject: str
    until_ns: int
    time_zone: str
    blocks: Sequence[Block] = field(default_factory=tuple)
