"""Tables that fit the width there is: they wrap between words, show fewer columns, and break no word."""

import re
from collections.abc import Collection, Sequence
from dataclasses import dataclass

from rich.console import Console, ConsoleOptions, RenderableType, RenderResult
from rich.measure import Measurement
from rich.segment import Segment
from rich.table import Column, Table
from rich.text import Text

from core.time_words import with_clock_times

LONGEST_WORD = 40
"""What is longer, such as a path or an address, may be broken."""

UNLIMITED = 10_000

TOGETHER = "\ue000"
"""A character of no meaning, which stands for a blank between two words of one line."""

UNITS = "%|dB|[kMG]?[WVA]|[mk]?ohm|Hz|[mu]?s|h|min|K|rpm|[kMG]i?B|days?"
_OF_ONE_LINE = re.compile(
    r"(?<=\d{4}-\d\d-\d\d) (?=\d\d:\d\d)"  # a date and its time
    r"|(?<=\d\d:\d\d) (?=UTC|[+-]\d\d:\d\d)"  # a time and its zone
    rf"|(?<=\d) (?=(?:{UNITS})(?![\w/]))"  # a number and its unit
    r"|(?<=[\d%]) (?=\[-?\d)"  # a value and its interval
)


@dataclass(slots=True)
class _Fitted:
    """A column with its cells.  least, most: its width at its longest word, and where nothing wraps."""

    column: Column
    cells: Sequence[RenderableType]
    least: int
    most: int
    width: int = 0


class FittedTable(Table):
    """A table that keeps each word, number, time and interval in one line; times are this machine's.

    Columns wrap between words, those marked `no_wrap` last of all. Where there is no room for each column's
    longest word, columns are left out, the last ones first, and a line below the table names them. The first
    column always stays, and those in `kept`, such as ids that people copy, as long as they can.
    """

    kept: Collection[str] = ()

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        """Render the table within the width of the options."""
        wide = options.update(width=UNLIMITED)
        columns = [_measured(column, console, wide) for column in self.columns]
        left_out: list[_Fitted] = []
        while self._room(columns, console, options) < 0 and len(columns) > 1 and self.show_header:
            others = [one for one in columns[1:] if str(one.column.header) not in self.kept]
            left_out.append((others or columns)[-1])
            columns.remove(left_out[-1])
        _fit(columns, self._room(columns, console, options))
        for line in console.render(self._of(columns), options):
            yield Segment(line.text.replace(TOGETHER, " "), line.style, line.control)
        if left_out:
            headings = [str(column.header) for column in self.columns]
            names = sorted((str(one.column.header) for one in left_out), key=headings.index)
            words = ", ".join(" ".join(name.split()) for name in names)
            yield Text(f"(no room for: {words}; a wider terminal or COLUMNS=160 shows more)", style="dim")

    def _room(self, columns: Sequence[_Fitted], console: Console, options: ConsoleOptions) -> int:
        """Return how much wider than their longest words columns may be; negative where these do not fit."""
        for one in columns:
            one.width = one.least
        whole = console.measure(self._of(columns), options=options.update(width=UNLIMITED)).maximum
        return options.max_width - whole

    def _of(self, columns: Sequence[_Fitted]) -> Table:
        """Return the table of some columns, each as wide as it is to be."""
        table = Table(
            title=self.title,
            title_justify=self.title_justify,
            caption=self.caption,
            caption_justify=self.caption_justify,
            box=self.box,
            show_header=self.show_header,
            # rich miscounts the width of a column where padding collapses
            padding=(0, 1, 0, 0) if self.collapse_padding else self.padding,
        )
        for one in columns:
            table.add_column(
                one.column.header, justify=one.column.justify, width=max(one.width, 1), overflow="fold"
            )
        for number, row in enumerate(self.rows):
            cells = (one.cells[number] for one in columns)
            table.add_row(*cells, style=row.style, end_section=row.end_section)
        return table


def _fit(columns: Sequence[_Fitted], room: int) -> None:
    """Give columns that stay whole what they need, then narrow ones; the others share the rest."""
    if room < 0:  # a word is wider than there is room for
        widest = max(columns, key=lambda one: one.least)
        widest.width = max(widest.least + room, 1)
        return
    wrapped = []
    for one in sorted(columns, key=lambda one: (not one.column.no_wrap, one.most)):
        wanted = min(one.most, one.column.max_width or UNLIMITED) - one.least
        if wanted > room:
            wrapped.append((one, wanted))
        elif wanted > 0:
            one.width += wanted
            room -= wanted
    for left, (one, wanted) in zip(range(len(wrapped), 0, -1), wrapped, strict=True):
        share = min(wanted, room // left)
        one.width += share
        room -= share


def _measured(column: Column, console: Console, options: ConsoleOptions) -> _Fitted:
    cells = [_in_one_line(cell) for cell in column.cells]
    found = [Measurement.get(console, options, cell) for cell in (column.header, *cells)]
    least = max(one.minimum for one in found)
    most = max(one.maximum for one in found)
    return _Fitted(column, cells, most if column.no_wrap else min(least, LONGEST_WORD), most)


def _in_one_line(cell: RenderableType) -> RenderableType:
    """Return a cell with local times, and whose times, intervals and numbers with their units do not wrap."""
    words = cell.plain if isinstance(cell, Text) else cell
    if not isinstance(words, str):
        return cell
    written = _OF_ONE_LINE.sub(TOGETHER, with_clock_times(words, None))
    if not isinstance(cell, Text):
        return written
    text = cell.copy()
    text.plain = written  # parts of other colours are of states, before any time
    return text
