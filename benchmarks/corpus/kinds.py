"""The kinds of files that a corpus run reads, each from a module of its own."""

from collections.abc import Iterator
from dataclasses import dataclass
from os import walk
from pathlib import Path

from benchmarks.corpus.comtrade_files import COMTRADE
from benchmarks.corpus.event_reports import EVENT_REPORT
from benchmarks.corpus.outcomes import Kind
from benchmarks.corpus.scl_files import SCL

KINDS: tuple[Kind, ...] = (COMTRADE, EVENT_REPORT, SCL)


@dataclass(frozen=True, slots=True)
class Found:
    """The files of a folder. parts: files beside those that are read. others: files of no kind.

    unreadable: folders that could not be listed.
    """

    files: tuple[tuple[Path, Kind], ...]
    parts: int
    others: int
    unreadable: tuple[str, ...]


def files_of(folder: Path) -> Found:
    """Find the files of all kinds in a folder and below. Links to folders are not followed."""
    by_suffix = {suffix: kind for kind in KINDS for suffix in kind.suffixes}
    part_suffixes = {suffix for kind in KINDS for suffix in kind.parts}
    files: list[tuple[Path, Kind]] = []
    unreadable: list[str] = []
    parts = others = 0
    for path in _regular_files(folder, unreadable):
        suffix = path.suffix.casefold()
        if suffix in by_suffix:
            files.append((path, by_suffix[suffix]))
        elif suffix in part_suffixes:
            parts += 1
        else:
            others += 1
    return Found(tuple(sorted(files, key=lambda one: str(one[0]))), parts, others, tuple(unreadable))


def _regular_files(folder: Path, unreadable: list[str]) -> Iterator[Path]:
    for where, _, names in walk(folder, onerror=lambda error: unreadable.append(str(error))):
        for name in names:
            path = Path(where, name)
            if path.is_file():  # a pipe or a device would be waited for
                yield path
