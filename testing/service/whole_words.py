"""Whether a table at some width shows whole words, numbers and times."""

import re
from io import StringIO

from rich.console import Console
from rich.table import Table

FRAME = re.compile("[│┌└├┐┘┤─┬┴┼━╇╡┃┏┓┡┩]")
TIME = re.compile(r"\d{4}-\d\d-\d\d \d\d:\d\d(?::\d\d)? (?:UTC|[+-]\d\d:\d\d)")
WITH_UNIT = re.compile(r"(?<!\S)[+-]?\d[\d.]* (?:%|dB|[kM]?[WVA]|ohm|Hz|s|h)(?!\S)")
INTERVAL = re.compile(r"\d(?: %)? \[-?\d\S*\]")
BREAKABLE = 40
"""Longer words may be broken."""


def drawn(table: Table, width: int) -> str:
    """Return a table as it is printed where there are so many columns."""
    console = Console(file=StringIO(), width=width, highlight=False)
    console.print(table)
    assert isinstance(console.file, StringIO)
    return console.file.getvalue()


def broken(narrow: str, wide: str) -> list[str]:
    """Return what a narrow table shows that is no whole word, time or figure of the same table unwrapped."""
    wide = FRAME.sub(" ", wide)
    words = set(wide.split())
    if any(len(word) > BREAKABLE for word in words):
        return []
    table = FRAME.sub(" ", narrow.split("(no room for: ")[0])
    found = [word for word in table.split() if word not in words]
    for pattern in (TIME, WITH_UNIT, INTERVAL):
        beginnings = {one.split(" ")[0] for one in pattern.findall(wide)}
        whole = [one.group().split(" ")[0] for one in pattern.finditer(table)]
        apart = [word for line in table.splitlines() if (word := line.rstrip().split(" ")[-1]) in beginnings]
        found += [word for word in apart if word not in words_alone(pattern, wide) and word not in whole]
    return found


def words_alone(pattern: re.Pattern[str], wide: str) -> set[str]:
    """Return the words that stand in a table beside what a pattern finds."""
    return set(pattern.sub(" ", wide).split())


def assert_whole(table: Table, *widths: int) -> None:
    """Require whole words at each width."""
    wide = drawn(table, 5000)
    for width in widths:
        narrow = drawn(table, width)
        assert broken(narrow, wide) == [], f"{width} columns:\n{narrow}"
        assert max(map(len, narrow.splitlines()), default=0) <= width
