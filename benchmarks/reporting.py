"""Work over the cores, intervals of rates, and pages of evidence with their tables as files."""

import csv
import re
import sys
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter
from typing import TypeVar

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)
from scipy.stats import beta

Task = TypeVar("Task")
Result = TypeVar("Result")

CONFIDENCE = 0.95
PROGRESS_S = 10.0
MOST_AT_A_TIME = 8
"""Tasks handed to a process at once."""
FEWEST_TURNS = 64
"""Into so many handfuls a few long tasks are split, so that no process is left with the last of them."""
CELLS_ON_PAGE = 20
"""A larger table is a file beside the page."""
TOTAL = "all"
"""What a row that sums up others has in its first cell."""


@dataclass(frozen=True, slots=True)
class Section:
    """One subject's part of the page: its tables and remarks as Markdown, and the command that repeats it."""

    subject: str
    title: str
    command: str
    lines: tuple[str, ...]

    def text(self) -> str:
        body = "\n".join(self.lines)
        return (
            f"{_begin(self.subject)}\n## {self.title}\n\n`{self.command}`\n\n{body}\n{_end(self.subject)}\n"
        )


def spread(
    work: Callable[[Task], Result], tasks: Sequence[Task], label: str, pool: Executor
) -> Iterator[Result]:
    """Results of `work` in the order of the tasks; progress on stderr, as a bar on a terminal."""
    begun = said = perf_counter()
    chunk = max(1, min(MOST_AT_A_TIME, len(tasks) // FEWEST_TURNS))
    console = Console(stderr=True)
    columns = (
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        shown = bar.add_task(label, total=len(tasks))
        for done, result in enumerate(pool.map(work, tasks, chunksize=chunk), start=1):
            bar.update(shown, completed=done)
            now = perf_counter()
            if (now - said > PROGRESS_S and not console.is_terminal) or done == len(tasks):
                said = now
                print(f"{label}: {done} of {len(tasks)}, {now - begun:.0f} s", file=sys.stderr, flush=True)
            yield result


def rate_interval(count: int, of: int) -> tuple[float, float]:
    """Clopper and Pearson's 95 % interval of a rate of which `count` in `of` trials were seen."""
    tail = (1.0 - CONFIDENCE) / 2.0
    low = float(beta.ppf(tail, count, of - count + 1)) if count else 0.0
    high = float(beta.ppf(1.0 - tail, count + 1, of - count)) if count < of else 1.0
    return low, high


def rate_text(count: int, of: int) -> str:
    """A rate and its interval."""
    if of == 0:
        return "none"
    low, high = rate_interval(count, of)
    return f"{count} of {of} ({count / of:.2%}; {low:.2%} to {high:.2%})"


def table(header: Sequence[str], rows: Sequence[Sequence[str]]) -> list[str]:
    """A Markdown table."""
    lines = [header, ["---"] * len(header), *rows]
    return ["| " + " | ".join(line) + " |" for line in lines]


def with_tables_as_files(page: Path, name: str, lines: Sequence[str]) -> list[str]:
    """Return the lines with a link in place of each large table, which is written as CSV beside the page.

    page: that of the lines.  name: of the first file in its folder `data`; further ones are numbered. The
    rows that sum up a table stay on the page.
    """
    left: list[str] = []
    number = 0
    at = 0
    while at < len(lines):
        end = at
        while end < len(lines) and lines[end].startswith("|"):
            end += 1
        header, rows = _cells(lines[at]), [_cells(line) for line in lines[at + 2 : end]]
        if len(header) * len(rows) <= CELLS_ON_PAGE:
            end = max(end, at + 1)
            left += lines[at:end]
            at = end
            continue
        number += 1
        file = page.parent / "data" / (f"{name}.csv" if number == 1 else f"{name}-{number}.csv")
        _write_csv(file, header, rows)
        totals = _totals(rows)
        left += [*table(header, totals), ""] if totals else []
        left.append(f"[All {len(rows)} rows](data/{file.name})")
        at = end
    return left


def _cells(line: str) -> list[str]:
    """The cells of a row of a Markdown table."""
    return [cell.strip() for cell in re.split(r"(?<!\\)\|", line.strip().strip("|"))]


def _totals(rows: Sequence[Sequence[str]]) -> list[Sequence[str]]:
    """The rows that sum up others."""
    return [row for row in rows if row[0].strip("*") == TOTAL]


def _write_csv(path: Path, header: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
    """Write a table without its mark-up."""
    path.parent.mkdir(exist_ok=True)
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        for row in (header, *rows):
            writer.writerow([re.sub(r"\*\*|`", "", cell).replace("\\|", "|") for cell in row])


def mark(passed: bool) -> str:
    return "met" if passed else "**falls short**"


def write_sections(path: Path, preamble: str, order: Sequence[str], sections: Sequence[Section]) -> None:
    """Put sections into the page, each in its place; those not measured this time stay as they are."""
    old = path.read_text(encoding="utf-8") if path.exists() else ""
    new = {section.subject: section.text() for section in sections}
    named = [("", preamble.strip() + "\n")]
    for subject in order:
        begin, end = _begin(subject), _end(subject)
        if subject in new:
            named.append((subject, new[subject]))
        elif begin in old and end in old:
            named.append((subject, old[old.index(begin) : old.index(end)] + end + "\n"))
    text = [
        with_tables_as_files(path, f"{path.stem}-{subject}" if subject else path.stem, part.split("\n"))
        for subject, part in named
    ]
    path.write_text("\n".join("\n".join(lines) for lines in text), encoding="utf-8")


def _begin(subject: str) -> str:
    return f"<!-- {subject}: measured -->"


def _end(subject: str) -> str:
    return f"<!-- {subject}: end -->"
