"""A table of any width keeps words, figures and times whole, and says which columns it leaves out."""

import re
import time

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rich.box import SIMPLE_HEAD
from rich.text import Text

from service.client.tables import FittedTable
from testing.service.whole_words import assert_whole, broken, drawn

FACTS = st.sampled_from(
    ["0.62 % [0.31..0.93]", "-31.2 dB", "2026-01-31 12:00:00 UTC", "2026-07-01 14:00 +02:00", "7.5 kW"]
)
WORDS = st.text("abcde-", min_size=1, max_size=15)
CELLS = st.lists(st.lists(WORDS | FACTS, min_size=1, max_size=9).map(" ".join), min_size=1, max_size=9)


@given(cells=CELLS, whole=st.sets(st.integers(0, 8)), width=st.integers(60, 130), framed=st.booleans())
@settings(max_examples=150, deadline=None, derandomize=True)
def test_no_word_is_broken_and_columns_left_out_are_named(
    cells: list[str], whole: set[int], width: int, framed: bool
) -> None:
    table = FittedTable() if framed else FittedTable(box=SIMPLE_HEAD, collapse_padding=True)
    for number, cell in enumerate(cells):
        is_whole = number in whole and len(cell) < 40
        table.add_column(f"H{number}", no_wrap=is_whole, max_width=30 if number == 1 else None)
    table.add_row(*map(Text, cells))
    assert_whole(table, width)
    assert re.findall(r"H\d", drawn(table, width)) == [f"H{number}" for number in range(len(cells))]


def test_the_last_columns_are_left_out_first_but_ids_are_kept() -> None:
    table = FittedTable(box=SIMPLE_HEAD, collapse_padding=True)
    table.kept = ("id",)
    for heading in ("motor", "state", "name", "id"):
        table.add_column(heading)
    table.add_row("PUMP-A1", "diagnosed", "LONG-NAME-OF-A-RECORDING", "7d53316d-51dd-432a-b4f8-11287214d82f")
    assert "no room for: name;" in drawn(table, 80)
    assert "no room for: state, name;" in drawn(table, 50)
    assert "no room for: state, name, id;" in drawn(table, 40)
    assert "no room for" not in drawn(table, 120)


def test_a_word_wider_than_the_table_is_broken_and_nothing_of_it_is_lost() -> None:
    table = FittedTable(show_header=False)
    table.add_column(no_wrap=True)
    table.add_column()
    table.add_row("reason", "x" * 200)
    shown = drawn(table, 60)
    assert shown.count("x") == 200
    assert max(map(len, shown.splitlines())) <= 60


def test_times_within_sentences_are_those_of_this_machine(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TZ", "UTC-01:00")
    time.tzset()
    table = FittedTable()
    table.add_column("why")
    table.add_row("down since 2026-01-31T12:00:00Z")
    table.add_row(Text("down since 2026-01-31T12:00:00Z"))
    shown = drawn(table, 100)
    monkeypatch.undo()
    time.tzset()
    assert shown.count("2026-01-31 13:00:00 +01:00") == 2


@pytest.mark.parametrize(
    ("narrow", "found"),
    [("unacknowl\nedged", ["unacknowl", "edged"]), ("2026-01-31\n12:00 UTC unacknowledged", ["2026-01-31"]),
     ("2026-01-31 12:00 UTC\nunacknowledged", []), ("7.5\nkW", ["7.5"]), ("7.5 kW", [])],
)  # fmt: skip
def test_the_check_itself_finds_what_is_broken(narrow: str, found: list[str]) -> None:
    assert broken(narrow, "2026-01-31 12:00 UTC unacknowledged 7.5 kW") == found
