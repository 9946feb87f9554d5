"""The command line of a benchmark whose subjects are the sections of one page of evidence."""

import argparse
import os
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor, ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from benchmarks.reporting import Section, write_sections


class Subject(Protocol):
    """Measures one subject; with `quick`, on few cases."""

    def __call__(self, pool: Executor, *, quick: bool) -> list[Section]: ...


@dataclass(frozen=True, slots=True)
class PageOfSubjects:
    """A page of evidence and what is measured for it.

    measured: of recordings in a folder, which are never part of the project; nothing without `--data`.
    order: of the sections, where a subject makes others than one of its name.
    """

    path: Path
    preamble: str
    subjects: Mapping[str, Subject]
    measured: Callable[[Path, Executor], list[Section]] | None = None
    order: Sequence[str] | None = None

    def measure(self, description: str | None) -> None:
        """Measure what the command line asks for, and put it into the page unless it is quick."""
        parser = argparse.ArgumentParser(description=description)
        parser.add_argument("--quick", action="store_true", help="few cases, printed and not written")
        parser.add_argument("--subject", choices=self.subjects, action="append", help="only this one")
        parser.add_argument("--workers", type=int, default=os.cpu_count() or 1)
        if self.measured is not None:
            parser.add_argument("--data", type=Path, help="folder of measured recordings: these alone")
        options = parser.parse_args()
        folder: Path | None = None if self.measured is None else options.data
        sections: list[Section] = []
        with ProcessPoolExecutor(options.workers) as pool:
            if self.measured is not None and folder is not None:
                sections += self.measured(folder, pool)
            for name in options.subject or (self.subjects if folder is None else ()):
                sections += self.subjects[name](pool, quick=options.quick)
        if options.quick:
            print("\n".join(section.text() for section in sections))
        else:
            write_sections(self.path, self.preamble, self.order or [*self.subjects, "measured"], sections)
