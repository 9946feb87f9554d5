"""A motor's condition as a person reads it: state and advice first, then why, then its course."""

from collections.abc import Sequence
from itertools import groupby, pairwise

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table
from rich.text import Text

from core.condition.condition import Condition
from core.time_stamps import rfc3339
from service.cli.output import one_line, results
from service.client.verdicts import VERDICT_COLOURS, interval, percent, to_the_second

STATE_COLOURS = {**VERDICT_COLOURS, "unknown": "magenta"}
BARS = " ▁▂▃▄▅▆▇█"
PLAIN_BARS = " .:-=+*#%"
"""Where the terminal's encoding has no blocks."""

MOST_BARS = 60
MOST_SKIPPED = 10
MOST_ROWS = 20
LEAST_SHOWN = 5e-5
"""A level that percent shows as other than 0.00."""

INDENT = "  "


def print_condition(
    condition: Condition, course: Sequence[Condition], skipped: Sequence[tuple[str, str]]
) -> None:
    """Print a condition, its course record by record, and the records that were not used, with reasons."""
    console = results()
    _print_headline(console, condition)
    _print_figures(console, condition)
    console.print(Text("Why", style="bold"))
    for reason in condition.reasons:
        console.print(Text(f"{INDENT}- {one_line(reason)}"), soft_wrap=True)
    _print_course(console, course)
    _print_skipped(console, skipped)


def _print_headline(console: Console, condition: Condition) -> None:
    headline = Text(one_line(condition.motor), style="bold")
    headline.append(": ")
    headline.append(str(condition.state), style=STATE_COLOURS.get(str(condition.state), ""))
    what = _what(condition)
    headline.append(f", {what}" if what else "")
    headline.append(" (stale)" if condition.stale else "")
    console.print(headline, soft_wrap=True)
    console.print(Text(condition.advice), soft_wrap=True)
    console.print()


def _what(condition: Condition) -> str:
    if condition.kind == "none":
        return ""
    kinds = " or ".join(condition.candidates) if condition.candidates else str(condition.kind)
    return kinds.replace("-", " ") + (f", phase {condition.phase}" if condition.phase else "")


def _print_figures(console: Console, condition: Condition) -> None:
    table = Table(show_header=False, box=None, padding=(0, 2, 0, 0))
    if condition.mu_f is not None:
        table.add_row("level in all", _level(condition.mu_f, condition.mu_f_ci95))
    if condition.change_ci95 is not None and condition.change is not None:
        table.add_row("change", _level(condition.change, condition.change_ci95))
    if condition.since_ns is not None:
        table.add_row("since", _when(condition.since_ns))
    forecast = condition.forecast
    if forecast.growth_per_day is not None:
        table.add_row("growth", f"{percent(forecast.growth_per_day)} % a day")
    if forecast.days is not None:
        low, mid, high = forecast.days
        table.add_row(f"{percent(forecast.limit)} % in", f"{mid:.1f} days [{low:.1f}..{high:.1f}]")
    if condition.reference is not None:
        table.add_row("reference", _reference(condition))
    if condition.as_of_ns is not None:
        table.add_row("as of", _when(condition.as_of_ns))
    console.print(table)
    console.print()


def _reference(condition: Condition) -> str:
    reference = condition.reference
    if reference is None:
        return "-"
    words = f"{reference.records} records"
    if not reference.complete:
        return f"{words}, still being learnt"
    if reference.detectable is None:
        return words
    return f"{words}; would see a step of {percent(reference.detectable)} %"


def _print_course(console: Console, course: Sequence[Condition]) -> None:
    """Print the level over the records as a line of bars, and one row a state that lasted."""
    levels = [condition.mu_f or 0.0 for condition in course]
    console.print()
    top = max(levels, default=0.0)
    if top >= LEAST_SHOWN:
        bars = _bars(levels, top, BARS if _has_blocks(console) else PLAIN_BARS)
        console.print(Text(f"Level over {len(course)} records, 0 to {percent(top)} %"), soft_wrap=True)
        console.print(Text(f"{INDENT}|{bars}|"), soft_wrap=True)
    table = Table(box=SIMPLE_HEAD)
    for heading in ("from", "records", "state", "what", "level", "change"):
        table.add_column(heading)
    runs = [[*run] for _, run in groupby(course, key=lambda one: (one.state, one.kind, one.phase))]
    if len(runs) > MOST_ROWS:
        console.print(Text(f"The latest {MOST_ROWS} of {len(runs)} turns"), soft_wrap=True)
    for run in runs[-MOST_ROWS:]:
        first, last = run[0], run[-1]
        table.add_row(
            "-" if first.as_of_ns is None else _when(first.as_of_ns),
            str(len(run)),
            Text(str(last.state), style=STATE_COLOURS.get(str(last.state), "")),
            _what(last) or "-",
            f"{percent(last.mu_f)} %",
            "-" if last.change is None else f"{percent(last.change)} %",
        )
    console.print(table)


def _bars(levels: Sequence[float], top: float, blocks: str) -> str:
    """Return the levels as characters, the greatest of neighbours where there are too many."""
    shown = min(len(levels), MOST_BARS)
    edges = [len(levels) * k // shown for k in range(shown + 1)]
    greatest = [max(levels[a:b]) for a, b in pairwise(edges)]
    return "".join(blocks[round(level / top * (len(blocks) - 1))] for level in greatest)


def _has_blocks(console: Console) -> bool:
    return console.encoding.casefold().startswith("utf")


def _print_skipped(console: Console, skipped: Sequence[tuple[str, str]]) -> None:
    if not skipped:
        return
    console.print(Text(f"Not used: {len(skipped)} records", style="bold"))
    for name, reason in skipped[:MOST_SKIPPED]:
        console.print(Text(f"{INDENT}{one_line(name)}: {one_line(reason)}"), soft_wrap=True)
    if len(skipped) > MOST_SKIPPED:
        console.print(Text(f"{INDENT}and {len(skipped) - MOST_SKIPPED} more (--json lists all)"))


def _level(value: float, ci95: object) -> str:
    return f"{percent(value)} % [{interval(ci95)}]"


def _when(time_ns: int) -> str:
    return to_the_second(rfc3339(time_ns))
