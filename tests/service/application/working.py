"""A host of workers as a process of its own."""

import signal
import subprocess
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from testing.service.processes import descendants, is_alive, service_environment
from testing.waiting import eventually


@contextmanager
def workers(directory: Path, settings: Mapping[str, str]) -> "Iterator[subprocess.Popen[bytes]]":
    """`mcc work` with log and data in a directory; it is killed at the end, and its workers end with it."""
    directory.mkdir(exist_ok=True)
    environment = service_environment(directory / "data", dict(settings))
    command = [sys.executable, "-m", "service.cli", "work"]
    with (
        (directory / "log").open("wb") as log,
        subprocess.Popen(command, env=environment, stderr=log) as process,
    ):
        try:
            yield process
        finally:
            below = descendants(process.pid)
            process.send_signal(signal.SIGCONT)
            process.kill()
            process.wait()
            assert eventually(lambda: not any(is_alive(one) for one in below), 20)
