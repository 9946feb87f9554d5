"""A table of any width shows every character, whatever its columns."""

import re
from io import StringIO

from hypothesis import given, settings
from hypothesis import strategies as st
from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.text import Text

from service.client.tables import FittedTable

CELLS = st.lists(st.text("abc de-", max_size=45), min_size=1, max_size=7)


@given(cells=CELLS, whole=st.sets(st.integers(0, 6)), width=st.integers(50, 130), framed=st.booleans())
@settings(max_examples=150, deadline=None, derandomize=True)
def test_nothing_is_cut_off(cells: list[str], whole: set[int], width: int, framed: bool) -> None:
    table = FittedTable() if framed else FittedTable(box=SIMPLE_HEAD, collapse_padding=True)
    for number in range(len(cells)):
        table.add_column(f"H{number}", no_wrap=number in whole, max_width=20 if number == 1 else None)
    table.add_row(*map(Text, cells))
    console = Console(file=StringIO(), width=width)
    console.print(table)
    assert isinstance(console.file, StringIO)
    shown = console.file.getvalue()
    assert max(map(len, shown.splitlines())) <= width
    for letter in "abcde-":
        assert shown.count(letter) == sum(cell.count(letter) for cell in cells), (letter, shown)
    assert re.findall(r"H\d", shown) == [f"H{number}" for number in range(len(cells))]
