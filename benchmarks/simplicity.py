"""How much there is to hold in the head: python -m benchmarks.simplicity.

Counts what is under version control, and what a record costs the database.
"""

import subprocess
from collections.abc import Callable, Iterable, Sequence
from inspect import getmembers, isfunction
from pathlib import Path
from statistics import median

from benchmarks.reporting import table
from benchmarks.storage.record_path import measure
from service.storage import Repository
from service.storage.models import Base

PAGE = Path("docs/evidence/simplicity.md")
PRODUCT = ("core", "scl", "mms", "ied_sim", "service")
RECORDS = 40
OWN_WORD = "told"
BEFORE = {
    "lines of the product": "156,000",
    "lines of service": "84,000",
    "lines of core/diagnosis and core/classification": "6,020",
    "files of service": "946",
    "median lines of a file of service": "73",
    "lines of tests": "90,000",
    "lines of benchmarks": "25,000",
    "words of documentation": "195,000",
    "tables of the database": "52",
    "migrations": "52",
    "methods of the repository": "297",
    f'"{OWN_WORD}" in the code of the product': "1,049",
    "statements of a record": "87",
}
"""Figures of before, as counted when these goals were set."""
GOALS = {
    "lines of the product": "125,000",
    "lines of service": "68,000",
    "lines of core/diagnosis and core/classification": "6,020",
    "lines of tests": "60,000",
    "lines of benchmarks": "12,000",
    "words of documentation": "90,000",
    "tables of the database": "36",
    "migrations": "1",
    "statements of a record": "25",
}
PREAMBLE = f"""# Simplicity

How much there is to hold in the head, counted by `python -m benchmarks.simplicity`. Lines are those of Python
files, blank ones and comments too. Statements are those of a small record on SQLite, from list to kept
condition ([how](../../benchmarks/storage/record_path.py)), over {RECORDS} records.

"""

CHANGES = """
What a change took, in files of code that were touched or made, counted by hand in the commits; tests, the
client and pages that are made do not count:

| change | before | took | goal |
| --- | --- | --- | --- |
| another trended figure of a finding that is there | 34 to 36 | 3: declared, kept, computed | 4 |
| the first figure of a new finding: the efficiency of a motor, with losses, words and page | | 17 | |
| a new kind of alarm: `inefficient` | 28 | 7 | 4 |
| a new finding over time: what losses cost | 43 | 14 | 12 |
"""


def figures() -> dict[str, int]:
    """Return each figure by its name."""
    service = _lines_of(_files("service/*.py"))
    *_, (_, statements, _) = measure(RECORDS)
    return {
        "lines of the product": sum(sum(_lines_of(_files(f"{room}/*.py"))) for room in PRODUCT),
        "lines of service": sum(service),
        "lines of core/diagnosis and core/classification": sum(
            _lines_of([*_files("core/diagnosis/*.py"), *_files("core/classification/*.py")])
        ),
        "files of service": len(service),
        "median lines of a file of service": round(median(service)),
        "lines of tests": sum(_lines_of([*_files("tests/*.py"), *_files("testing/*.py")])),
        "lines of benchmarks": sum(_lines_of(_files("benchmarks/*.py"))),
        "words of documentation": sum(_each(_files("*.md"), lambda text: len(text.split()))),
        "tables of the database": len(Base.metadata.tables),
        "migrations": len(_files("service/storage/migrations/versions/v*.py")),
        "methods of the repository": sum(
            not name.startswith("_") for name, _ in getmembers(Repository, isfunction)
        ),
        f'"{OWN_WORD}" in the code of the product': sum(
            sum(_each(_files(f"{room}/*.py"), lambda text: text.count(OWN_WORD))) for room in PRODUCT
        ),
        "statements of a record": round(float(statements)),
    }


def _files(pattern: str) -> Sequence[Path]:
    listed = subprocess.run(["git", "ls-files", pattern], capture_output=True, text=True, check=True).stdout  # noqa: S607
    return [Path(line) for line in listed.splitlines()]


def _lines_of(files: Iterable[Path]) -> list[int]:
    return _each(files, lambda text: text.count("\n"))


def _each(files: Iterable[Path], count: Callable[[str], int]) -> list[int]:
    return [count(path.read_text(encoding="utf-8")) for path in files]


def main() -> None:
    """Count, and write the page."""
    rows = [(name, BEFORE[name], f"{figure:,}", GOALS.get(name, "")) for name, figure in figures().items()]
    lines = table(("figure", "before", "now", "goal"), rows)
    PAGE.write_text(PREAMBLE + "\n".join(lines) + "\n" + CHANGES, encoding="utf-8")
    print("\n".join(lines))


if __name__ == "__main__":
    main()
