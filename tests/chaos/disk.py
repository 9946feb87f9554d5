"""A disk that can be filled and freed: a small file system of its own, or a limit on what may be written."""

import os
import resource
import subprocess
import sys
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Protocol

OWN_MOUNTS = "CHAOS_OWN_MOUNTS"
"""Set in the environment of a run that may mount what nobody else sees."""

BLOCK = b"\0" * 65_536


class Disk(Protocol):
    """What a service's data are kept on."""

    description: str

    def fill(self) -> None: ...
    def free(self) -> None: ...


class SmallDisk:
    """A tmpfs, filled with a ballast file to its last block."""

    def __init__(self, directory: Path, size_bytes: int) -> None:
        """Mounts it. Raises subprocess.CalledProcessError where that is not permitted."""
        self.description = f"tmpfs of {size_bytes // 1024**2} MiB, filled with a ballast file"
        self._ballast = directory / "ballast"
        directory.mkdir(parents=True, exist_ok=True)
        options = f"size={size_bytes}"
        subprocess.run(["mount", "-t", "tmpfs", "-o", options, "tmpfs", str(directory)], check=True)

    def fill(self) -> None:
        with self._ballast.open("ab", buffering=0) as ballast, suppress(OSError):
            while ballast.write(BLOCK):
                pass

    def free(self) -> None:
        self._ballast.unlink(missing_ok=True)


class WritingLimit:
    """Where nothing can be mounted: no file of the service's processes may grow (RLIMIT_FSIZE)."""

    description = "no mount permitted: writing refused to the service's processes by RLIMIT_FSIZE instead"

    def __init__(self, processes: Callable[[], list[int]]) -> None:
        self._processes = processes
        self._limited: dict[int, tuple[int, int]] = {}

    def fill(self) -> None:
        for process_id in self._processes():
            with suppress(ProcessLookupError):
                soft, hard = resource.prlimit(process_id, resource.RLIMIT_FSIZE)
                if soft != 0:
                    self._limited[process_id] = (soft, hard)
                    resource.prlimit(process_id, resource.RLIMIT_FSIZE, (0, hard))

    def free(self) -> None:
        for process_id, before in (self._inheritors() | self._limited).items():
            with suppress(ProcessLookupError):
                resource.prlimit(process_id, resource.RLIMIT_FSIZE, before)
        self._limited.clear()

    def _inheritors(self) -> dict[int, tuple[int, int]]:
        """What was started meanwhile has the limit of those that started it."""
        before = next(iter(self._limited.values()), None)
        return {} if before is None else dict.fromkeys(self._processes(), before)


def enter_own_mounts() -> None:
    """Begin this program again where its mounts are its own; return where that is not permitted."""
    if OWN_MOUNTS in os.environ:
        return
    as_root = [] if os.getuid() == 0 else ["--user", "--map-root-user"]
    unshare = ["unshare", "--mount", *as_root]
    trial = [*unshare, "mount", "-t", "tmpfs", "tmpfs", "/mnt"]
    try:
        permitted = subprocess.run(trial, capture_output=True, check=False).returncode == 0
    except FileNotFoundError:
        permitted = False
    if permitted:
        command = [*unshare, sys.executable, "-m", "tests.chaos", *sys.argv[1:]]
        os.execvpe(command[0], command, os.environ | {OWN_MOUNTS: "1"})  # noqa: S606
