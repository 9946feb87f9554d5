"""A motor's condition as a person reads it: state and advice first, then why, then its course."""

from collections.abc import Mapping, Sequence
from itertools import groupby, pairwise

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.text import Text

from core.error_words import one_line
from service.cli.output import facts_table, results
from service.client.conditions import cause, condition_lines, state_text
from service.client.tables import FittedTable
from service.client.verdicts import local_time, percent

Document = Mapping[str, object]

BARS = " ▁▂▃▄▅▆▇█"
PLAIN_BARS = " .:-=+*#%"
"""Where the terminal's encoding has no blocks."""

MOST_BARS = 60
MOST_SKIPPED = 10
MOST_TURNS = 20
SAID_FIRST = 2
"""Lines of a condition that are its state and its advice."""

LEAST_SHOWN = 5e-5
"""A level that percent shows as other than 0.00."""

INDENT = "  "


def print_condition(
    condition: Document, history: Sequence[Document], skipped: Sequence[tuple[str, str]]
) -> None:
    """Print a condition, its course record by record, and the records that were not used, with reasons."""
    console = results()
    console.print(
        Text(f"{one_line(str(condition['motor']))}: ", style="bold") + state_text(condition), soft_wrap=True
    )
    console.print(Text(str(condition["advice"])), soft_wrap=True)
    console.print()
    console.print(facts_table(condition_lines(condition)[SAID_FIRST:]))
    _print_course(console, history)
    _print_skipped(console, skipped)


def _print_course(console: Console, history: Sequence[Document]) -> None:
    """Print the level over the records as a line of bars, and a row for each turn of the condition."""
    levels = [_number(entry["mu_f"]) for entry in history]
    console.print()
    top = max(levels, default=0.0)
    if top >= LEAST_SHOWN:
        blocks = BARS if console.encoding.casefold().startswith("utf") else PLAIN_BARS
        console.print(Text(f"Level over {len(levels)} records, 0 to {percent(top)} %"), soft_wrap=True)
        console.print(Text(f"{INDENT}|{_bars(levels, top, blocks)}|"), soft_wrap=True)
    table = FittedTable(box=SIMPLE_HEAD)
    for heading in ("from", "records", "condition", "level", "change"):
        table.add_column(heading)
    turns = [[*turn] for _, turn in groupby(history, key=lambda entry: (entry["state"], cause(entry)))]
    if len(turns) > MOST_TURNS:
        console.print(Text(f"The latest {MOST_TURNS} of {len(turns)} turns"), soft_wrap=True)
    for turn in turns[-MOST_TURNS:]:
        latest = turn[-1]
        table.add_row(
            local_time(turn[0]["time"]),
            str(len(turn)),
            state_text(latest),
            f"{percent(latest['mu_f'])} %",
            "-" if latest["change"] is None else f"{percent(latest['change'])} %",
        )
    console.print(table)


def _bars(levels: Sequence[float], top: float, blocks: str) -> str:
    """Return the levels as characters, the greatest of neighbours where there are too many."""
    shown = min(len(levels), MOST_BARS)
    edges = [len(levels) * k // shown for k in range(shown + 1)]
    greatest = [max(levels[a:b]) for a, b in pairwise(edges)]
    return "".join(blocks[round(level / top * (len(blocks) - 1))] for level in greatest)


def _number(value: object) -> float:
    return float(value) if isinstance(value, int | float) else 0.0


def _print_skipped(console: Console, skipped: Sequence[tuple[str, str]]) -> None:
    if not skipped:
        return
    console.print(Text(f"Not used: {len(skipped)} records", style="bold"))
    for name, reason in skipped[:MOST_SKIPPED]:
        console.print(Text(f"{INDENT}{one_line(name)}: {one_line(reason)}"), soft_wrap=True)
    if len(skipped) > MOST_SKIPPED:
        console.print(Text(f"{INDENT}and {len(skipped) - MOST_SKIPPED} more (--json lists all)"))
