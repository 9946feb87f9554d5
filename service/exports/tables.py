"""Tables of an export: their columns with type, unit and meaning, the same in every format."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum
from math import isfinite
from typing import Any, Generic, TypeVar

from core.error_words import one_line

Record = TypeVar("Record")
Cell = str | int | float | None


class ColumnType(StrEnum):
    """What the cells of a column are; each may be empty."""

    TEXT = "text"
    NUMBER = "number"
    WHOLE = "whole number"
    TIME = "time"
    """UTC, nanoseconds since 1970."""


@dataclass(frozen=True, slots=True)
class Column(Generic[Record]):
    """A column.

    unit: "" where there is none, "1" for a ratio.  value: takes a record and returns its cell.
    """

    name: str
    type: ColumnType
    unit: str
    meaning: str
    value: Callable[[Record], Any]

    def cell(self, record: Record) -> Cell:
        """Return a record's cell: text on one line that every encoding takes, numbers that are numbers."""
        value = self.value(record)
        if value is None:
            return None
        if self.type is ColumnType.TEXT:
            return one_line(str(value))
        if self.type is ColumnType.NUMBER:
            return float(value) if isfinite(value) else None
        return int(value)


@dataclass(frozen=True, slots=True)
class Table(Generic[Record]):
    """A table. name: of the sheet, and at the beginning of a file's name."""

    name: str
    columns: tuple[Column[Record], ...]

    def rows(self, records: Sequence[Record]) -> Iterator[list[Cell]]:
        """Return the cells of each record."""
        columns = self.columns
        for record in records:
            yield [column.cell(record) for column in columns]


def text(name: str, meaning: str, value: Callable[[Record], Any]) -> Column[Record]:
    return Column(name, ColumnType.TEXT, "", meaning, value)


def number(name: str, unit: str, meaning: str, value: Callable[[Record], Any]) -> Column[Record]:
    return Column(name, ColumnType.NUMBER, unit, meaning, value)


def whole(name: str, unit: str, meaning: str, value: Callable[[Record], Any]) -> Column[Record]:
    return Column(name, ColumnType.WHOLE, unit, meaning, value)


def time(name: str, meaning: str, value: Callable[[Record], Any]) -> Column[Record]:
    return Column(name, ColumnType.TIME, "", meaning, value)
