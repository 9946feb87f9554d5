"""The service's files are their owner's alone: what it writes, and what lies in its directories already."""

import os
import stat
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

import structlog
from structlog.typing import FilteringBoundLogger

log: FilteringBoundLogger = structlog.get_logger(__name__)

OTHERS = stat.S_IRWXG | stat.S_IRWXO
"""What nobody but the owner may do with a file."""


@contextmanager
def written_privately() -> Iterator[None]:
    """Let nobody else read or write what this process, and what it starts, writes in the block."""
    before = os.umask(OTHERS)
    try:
        yield
    finally:
        os.umask(before)


def close_to_others(directories: Iterable[Path]) -> None:
    """Close these directories and what lies in them to all but their owner, with a line in the log for each.

    What lies below a folder that was closed already is not looked at: nobody else gets there, and a million
    recordings would delay each start.
    """
    for directory in dict.fromkeys(directories):
        if not directory.is_dir():
            continue
        if directory.stat().st_mode & stat.S_ISVTX:
            log.warning("a directory is shared by all users and stays open to them", directory=str(directory))
            continue
        mended = list(_closed(directory))
        if mended:
            log.warning(
                "files were open to other users and are closed to them now",
                directory=str(directory),
                number=len(mended),
                first=str(mended[0]),
            )


def _closed(directory: Path) -> Iterator[Path]:
    """Close a directory and what lies in it, and yield what was open.

    The directory comes first: nobody exchanges a file meanwhile.
    """
    if _was_open(directory, directory.stat().st_mode):
        yield directory
    with os.scandir(directory) as entries:
        for entry in entries:
            mode = entry.stat(follow_symlinks=False).st_mode
            path = Path(entry.path)
            if stat.S_ISDIR(mode) and mode & OTHERS:
                yield from _closed(path)
            elif stat.S_ISREG(mode) and _was_open(path, mode):
                yield path


def _was_open(path: Path, mode: int) -> bool:
    """Close a file to others. Returns False where it was closed, or belongs to somebody who has to do it."""
    if not mode & OTHERS:
        return False
    try:
        path.chmod(stat.S_IMODE(mode) & ~OTHERS)
    except PermissionError as error:
        log.warning(
            "a file is open to other users, and only its owner can close it: chmod go= FILE",
            file=str(path),
            reason=error.strerror,
        )
        return False
    return True
