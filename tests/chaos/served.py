"""The service of a run: kept running as a service manager would, and its processes by what they do."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from threading import Event, Thread
from typing import IO

from service.client.rest_client import ServiceClient
from testing.service.accounts import log_in_before_start
from testing.service.processes import descendants, is_alive, service_environment, workers_of
from testing.waiting import eventually
from tests.chaos.history import History

RESTART_AFTER_S = 0.5
START_LIMIT_S = 300.0
STOP_LIMIT_S = 30.0


class ServedService:
    """`mcc serve`, started again whenever it has ended."""

    def __init__(
        self, data: Path, log: Path, settings: Mapping[str, str], port: int, history: History
    ) -> None:
        self.url = f"http://127.0.0.1:{port}"
        self.data = data
        self.log = log
        self.clock_offset = log.with_name("clock-offset")
        self.unwanted_ends: list[str] = []
        self._history = history
        clock = str(Path(__file__).parent / "shifted_clock")
        self._environment = service_environment(data, {"MCC_PORT": str(port), **settings}) | {
            "PYTHONPATH": os.pathsep.join(filter(None, (clock, os.environ.get("PYTHONPATH")))),
            "CHAOS_CLOCK_OFFSET": str(self.clock_offset),
        }
        self._process: subprocess.Popen[bytes] | None = None
        self._was_ready = False
        self._excused = False
        self._stopping = Event()
        self._thread = Thread(target=self._keep, name="service-keeper")

    def start(self) -> None:
        """Start, and wait until it is ready. Raises RuntimeError with its last words."""
        log_in_before_start(self._environment, self.url)
        self._thread.start()
        if not self.wait_until_ready(START_LIMIT_S):
            raise RuntimeError(f"the service does not get ready: {self.last_words()}")

    def wait_until_ready(self, within_s: float) -> bool:
        with ServiceClient(self.url) as client:
            return eventually(client.is_ready, within_s)

    def stop(self) -> int | None:
        """SIGTERM, and SIGKILL when that is not heeded; the exit code."""
        self._stopping.set()
        process = self._process
        code = None
        if process is not None:
            below = descendants(process.pid)
            process.terminate()
            with suppress(subprocess.TimeoutExpired):
                code = process.wait(STOP_LIMIT_S)
            for process_id in [process.pid, *below]:
                if is_alive(process_id):
                    with suppress(ProcessLookupError):
                        os.kill(process_id, signal.SIGKILL)
        self._thread.join()
        return code

    @property
    def process_id(self) -> int | None:
        process = self._process
        return process.pid if process is not None and process.poll() is None else None

    def gateways(self) -> list[int]:
        return self._below("service.collector")

    def workers(self) -> list[int]:
        main = self.process_id
        return [] if main is None else sorted(filter(is_alive, workers_of(main)))

    def all_processes(self) -> list[int]:
        main = self.process_id
        return [] if main is None else [main, *(one for one in descendants(main) if is_alive(one))]

    def kill(self) -> None:
        """SIGKILL of the service alone: what it started has to notice by itself."""
        process_id = self.process_id
        if process_id is not None:
            self._excused = True
            with suppress(ProcessLookupError):
                os.kill(process_id, signal.SIGKILL)

    def last_words(self) -> str:
        return self.log.read_text(encoding="utf-8", errors="replace")[-3000:] if self.log.exists() else ""

    def _below(self, words: str) -> list[int]:
        found = []
        for process_id in self.all_processes()[1:]:
            with suppress(OSError):
                if words.encode() in Path(f"/proc/{process_id}/cmdline").read_bytes():
                    found.append(process_id)
        return sorted(found)

    def _keep(self) -> None:
        while not self._stopping.is_set():
            process = subprocess.Popen(
                [sys.executable, "-m", "service.cli", "serve"],
                env=self._environment,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
            )
            Thread(target=self._write_log, args=(process.stdout,), daemon=True).start()
            self._was_ready, self._excused, self._process = False, False, process
            while process.poll() is None:
                self._note_ready()
                time.sleep(0.2)
            if self._stopping.is_set():
                return
            self._history.note(f"the service ended with {process.returncode} and is started again")
            if self._was_ready and not self._excused:
                self.unwanted_ends.append(f"exit code {process.returncode}: {self.last_words()[-500:]}")
            self._stopping.wait(RESTART_AFTER_S)

    def _write_log(self, lines: IO[bytes]) -> None:
        """For the service, as a journal would: it may be kept from writing files."""
        with lines, self.log.open("ab") as log:
            for line in lines:
                log.write(line)
                log.flush()

    def _note_ready(self) -> None:
        """Ready once is enough: from then on it must not end by itself."""
        if not self._was_ready:
            with ServiceClient(self.url) as client:
                self._was_ready = client.is_ready()


@contextmanager
def running(service: ServedService) -> Iterator[ServedService]:
    """The service for as long as the block lasts."""
    try:
        service.start()
        yield service
    finally:
        service.stop()


def handles_of(process_ids: list[int]) -> tuple[int, int]:
    """Open files and threads of some processes together."""
    files = threads = 0
    for process_id in process_ids:
        with suppress(OSError):
            files += len(list(Path(f"/proc/{process_id}/fd").iterdir()))
            threads += len(list(Path(f"/proc/{process_id}/task").iterdir()))
    return files, threads
