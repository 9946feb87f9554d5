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
    """The files of a folder.

    parts: files that belong to one of those that are read. orphans: parts of nothing. others: files of no
    kind. unreadable: folders that could not be listed.
    """

    files: tuple[tuple[Path, Kind], ...]
    parts: int
    orphans: tuple[Path, ...]
    others: int
    unreadable: tuple[str, ...]


def files_of(folder: Path) -> Found:
    """Find the files of all kinds in a folder and below. Links to folders are not followed."""
    by_suffix = {suffix: kind for kind in KINDS for suffix in kind.suffixes}
    part_suffixes = {suffix for kind in KINDS for suffix in kind.parts}
    files: list[tuple[Path, Kind]] = []
    parts: list[Path] = []
    unreadable: list[str] = []
    others = 0
    for path in _regular_files(folder, unreadable):
        suffix = path.suffix.casefold()
        if suffix in by_suffix:
            files.append((path, by_suffix[suffix]))
        elif suffix in part_suffixes:
            parts.append(path)
        else:
            others += 1
    records = {_record_of(path) for path, kind in files if kind.parts}
    orphans = tuple(sorted(path for path in parts if _record_of(path) not in records))
    files.sort(key=lambda one: str(one[0]))
    return Found(tuple(files), len(parts) - len(orphans), orphans, others, tuple(unreadable))


def _record_of(path: Path) -> tuple[Path, str]:
    """What the files of one record have in common, in any case of the letters."""
    return path.parent, path.stem.casefold()


def _regular_files(folder: Path, unreadable: list[str]) -> Iterator[Path]:
    for where, _, names in walk(folder, onerror=lambda error: unreadable.append(str(error))):
        for name in names:
            path = Path(where, name)
            if path.is_file():  # a pipe or a device would be waited for
                yield path
