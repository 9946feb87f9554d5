from collections.abc import Iterator

import pytest
from rich.console import Console, ConsoleOptions, RenderResult

from service.client.tables import FittedTable
from testing.service.whole_words import assert_whole

CHECKED = (80, 120)


@pytest.fixture(autouse=True)
def _wide_tables(monkeypatch: pytest.MonkeyPatch) -> None:
    """Tables have room, so that what they say stands in one line; test_widths.py tries narrow ones."""
    monkeypatch.setenv("COLUMNS", "250")


@pytest.fixture(autouse=True)
def _whole_words(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Each table that a command prints in any test would have whole words at 80 and at 120 columns, too."""
    printed: list[FittedTable] = []
    render = FittedTable.__rich_console__

    def noted(table: FittedTable, console: Console, options: ConsoleOptions) -> RenderResult:
        printed.append(table)
        return render(table, console, options)

    with monkeypatch.context() as patched:
        patched.setattr(FittedTable, "__rich_console__", noted)
        yield
    for table in printed:
        assert_whole(table, *CHECKED)
