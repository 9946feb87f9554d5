"""Tables that fit the width there is: they wrap where they have to, and cut nothing off."""

from rich.console import Console, ConsoleOptions, RenderResult
from rich.measure import Measurement
from rich.table import Column, Table

LEAST_WIDTH = 2
"""Columns that wrap keep so many characters, where those marked `no_wrap` are to stay whole."""

WORD_WIDTH = 12
"""They keep their longest word up to so many characters before others stay whole."""

UNLIMITED = 10_000


class FittedTable(Table):
    """A table that wraps its columns as its width needs it, those marked `no_wrap` last of all.

    A table of rich cuts such columns off where there is no room for them.
    """

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        """Render the table within the width of the options."""
        wide = options.update(width=UNLIMITED)
        found = [(_measured(column, console, wide), column) for column in self.columns]
        whole = self.__rich_measure__(console, wide).maximum
        alone = sum(min(measured.maximum, column.max_width or UNLIMITED) for measured, column in found)
        room = options.max_width - (whole - alone)
        found.sort(key=lambda each: (not each[1].no_wrap, each[0].maximum))
        for number, (measured, column) in enumerate(found, start=1):
            word = LEAST_WIDTH if column.no_wrap else WORD_WIDTH
            rest = sum(min(other.minimum, word) for other, _ in found[number:])
            most = room - rest if column.max_width is None else min(room - rest, column.max_width)
            column.overflow = "fold"
            column.no_wrap = measured.maximum <= most
            room -= measured.maximum if column.no_wrap else min(measured.minimum, word)
        yield from super().__rich_console__(console, options)


def _measured(column: Column, console: Console, options: ConsoleOptions) -> Measurement:
    """Return how wide a column is at its longest word, and where nothing wraps."""
    cells = [Measurement.get(console, options, cell) for cell in (column.header, *column.cells)]
    return Measurement(max(cell.minimum for cell in cells), max(cell.maximum for cell in cells))
