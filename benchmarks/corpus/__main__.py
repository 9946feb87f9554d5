"""Every COMTRADE, CEV and SCL file of a folder and below: how it is read, and what other readers say.

    python -m benchmarks.corpus FOLDER [--json]
    make corpus DIR=FOLDER

Tables in Markdown go to stdout, with --json one JSON document with every file. Each file has a minute and
2 GiB of memory, in a process of its own. The exit status is 1 where a reader crashed or met a limit.
"""

import argparse
import json
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

from benchmarks.corpus.kinds import files_of
from benchmarks.corpus.outcomes import Examined, Reading, Service
from benchmarks.corpus.page import document, markdown
from benchmarks.corpus.workers import MEMORY_BYTES, TIMEOUT_S, examine_all


def main() -> int:
    """Exit status 0, 1 where a reader crashed, 2 where there is no such folder."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter, prog="benchmarks.corpus"
    )
    parser.add_argument("folder", type=Path)
    parser.add_argument("--json", action="store_true", help="one JSON document instead of tables")
    parser.add_argument("--seconds", type=float, default=TIMEOUT_S, help="limit of a file")
    parser.add_argument("--megabytes", type=int, default=MEMORY_BYTES >> 20, help="limit of a file")
    options = parser.parse_args()
    folder: Path = options.folder
    if not folder.is_dir():
        print(f"{folder}: expected a folder, found none", file=sys.stderr)
        return 2
    found = files_of(folder)
    examining = examine_all(
        found.files, folder, timeout_s=options.seconds, memory_bytes=options.megabytes << 20
    )
    files = list(_shown(examining, len(found.files)))
    if options.json:
        print(json.dumps(document(str(folder), found, files), indent=1, ensure_ascii=False))
    else:
        print(markdown(found, files), end="")
    return 1 if any(_has_crashed(one) for one in files) else 0


def _has_crashed(one: Examined) -> bool:
    served = (each.service is Service.CRASHED for each in one.served)
    return one.outcome.reading is Reading.CRASHED or any(served)


def _shown(examining: Iterable[Examined], total: int) -> Iterator[Examined]:
    """The same, with a bar on stderr where that is a terminal."""
    console = Console(stderr=True)
    columns = (TextColumn("reading"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task("reading", total=total)
        for one in examining:
            bar.advance(task)
            yield one


if __name__ == "__main__":
    sys.exit(main())
