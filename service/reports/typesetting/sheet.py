"""What a report says as data for its typst program: texts as they are printed, widths as numbers."""

import re
from collections.abc import Iterator, Mapping, Sequence
from itertools import groupby

from core.error_words import one_line
from core.time_words import clock
from service.reports.document import (
    Cell,
    Column,
    ColumnKind,
    Content,
    Facts,
    Picture,
    ReportDocument,
    Table,
    Words,
)

MOST_ROWS = 2500
"""Of a table on paper; a workbook has the others."""

MOST_CHARACTERS = 400
"""Of a cell or a sentence's name; the texts of relays and people may be as long as they like."""

LANDSCAPE_COLUMNS = 8
"""A table with more columns than this needs the long side of the page."""

BREAK = "\u200b"
"""A line may break here, and nothing is seen of it."""

LONG_WORD = re.compile(r"\S{17,}")
PIECE = 12
MINUTES_END = len("2026-11-23 10:41")
NUMERIC = (ColumnKind.SHARE, ColumnKind.NUMBER, ColumnKind.WHOLE)


def sheet(report: ReportDocument) -> Mapping[str, object]:
    """Return the data; all texts in it are on one line, of a bearable length, and can be broken."""
    tables = [one for block in report.blocks for one in block.contents if isinstance(one, Table)]
    until = clock(report.until_ns, report.time_zone)
    return {
        "title": _text(report.title),
        "subject": _text(report.subject),
        "foot": _text(f"StatorWatch. Data until {until}. Times in {report.time_zone}."),
        "landscape": any(len(one.columns) > LANDSCAPE_COLUMNS for one in tables),
        "parts": [
            {"heading": _text(block.heading), "lines": list(_lines(block.contents, report.time_zone))}
            for block in report.blocks
        ],
    }


def _lines(contents: Sequence[Content], zone: str) -> Iterator[Mapping[str, object]]:
    """Return what stands below each other; pictures that follow each other share a line where they fit."""
    for is_picture, together in groupby(contents, key=lambda one: isinstance(one, Picture)):
        if is_picture:
            yield from _picture_lines([one for one in together if isinstance(one, Picture)])
            continue
        for one in together:
            if isinstance(one, Table):
                yield _table(one, zone)
            elif isinstance(one, Facts):
                yield {"kind": "facts", "facts": [[_text(name), _text(words)] for name, words in one.facts]}
            elif isinstance(one, Words):
                yield {"kind": "words", "text": _text(one.text, 4 * MOST_CHARACTERS), "tone": one.tone}


def _picture_lines(pictures: Sequence[Picture]) -> Iterator[Mapping[str, object]]:
    line: list[Picture] = []
    for one in [*pictures, None]:
        if line and (one is None or sum(each.width for each in line) + one.width > 1.01):
            yield {
                "kind": "pictures",
                "rest": max(1.0 - sum(each.width for each in line), 0.0),
                "pictures": [
                    {"svg": each.svg, "words": _text(each.words), "alt": each.words, "width": each.width}
                    for each in line
                ],
            }
            line = []
        if one is not None:
            line.append(one)


def _table(table: Table, zone: str) -> Mapping[str, object]:
    shown = table.rows[:MOST_ROWS]
    on_paper = len(table.rows) - len(shown)
    notes = []
    if on_paper:
        notes.append(f"{on_paper} further rows: the Excel workbook of this report has them.")
    if table.left_out:
        notes.append(f"{table.left_out} further ones are left out.")
    return {
        "kind": "table",
        "headings": [column.heading for column in table.columns],
        "widths": [column.width for column in table.columns],
        "numeric": [column.kind in NUMERIC for column in table.columns],
        "rows": [
            [_cell(cell, column, zone) for cell, column in zip(row, table.columns, strict=True)]
            for row in shown
        ],
        "empty": table.empty,
        "note": " ".join(notes),
    }


def _cell(cell: Cell, column: Column, zone: str) -> str:
    if cell is None:
        return ""
    if column.kind is ColumnKind.TIME:
        return clock(int(cell), zone)[:MINUTES_END]
    if column.kind is ColumnKind.SHARE:
        return f"{100 * float(cell):.2f} %"
    if column.kind is ColumnKind.NUMBER:
        return f"{float(cell):.4g}"
    return _text(str(cell))


def _text(text: str, most: int = MOST_CHARACTERS) -> str:
    shown = one_line(text)
    shown = shown if len(shown) <= most else f"{shown[: most - 6]} [cut]"
    return LONG_WORD.sub(lambda word: _breakable(word.group()), shown)


def _breakable(word: str) -> str:
    """Return a word that may be broken, behind its punctuation or anywhere where it has none."""
    parts = re.findall(rf"[^-_./:,;]{{1,{PIECE}}}[-_./:,;]*|[-_./:,;]{{1,{PIECE}}}", word)
    return BREAK.join(parts)
