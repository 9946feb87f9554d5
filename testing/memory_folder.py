"""A folder whose files lie in memory, where the system has one."""

import os
from pathlib import Path

_SHARED_MEMORY = Path("/dev/shm")  # noqa: S108 - folders in it are made by tempfile


def memory_folder() -> Path | None:
    """Return the folder, for `tempfile`, where a disk would set the pace; None for the usual one."""
    return _SHARED_MEMORY if os.access(_SHARED_MEMORY, os.W_OK) else None
