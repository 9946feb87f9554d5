"""Whether there is room where the service writes."""

import errno
import os
from collections.abc import Iterable
from pathlib import Path
from tempfile import TemporaryFile

LEAST_ROOM_BYTES = 1 << 20

FULL = frozenset({errno.ENOSPC, errno.EDQUOT, errno.EFBIG})
"""What the system says of a full disk, of a used up quota, and of a process that may write no more."""


def is_disk_full(error: BaseException | None) -> bool:
    """Tell whether a full disk is at the bottom of an error."""
    while error is not None:
        if isinstance(error, OSError) and error.errno in FULL:
            return True
        error = error.__cause__
    return False


def disk_problem(directories: Iterable[Path]) -> str | None:
    """Return where LEAST_ROOM_BYTES cannot be written, and why; None where all is well."""
    problems = {directory: _problem(directory) for directory in directories}
    return "; ".join(f"{directory}: {found}" for directory, found in problems.items() if found) or None


def _problem(directory: Path) -> str | None:
    try:
        with TemporaryFile(dir=directory) as file:
            os.posix_fallocate(file.fileno(), 0, LEAST_ROOM_BYTES)
    except OSError as error:
        return error.strerror or str(error)
    return None
