"""The simulated relays as processes: a few relays each, killed and started again as relays' mains would."""

import signal
import subprocess
import sys
import time
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path
from threading import Lock, Timer

from scl import Address
from testing.waiting import eventually
from tests.chaos.plant import ChaosPlant

RELAYS_A_PROCESS = 10
START_LIMIT_S = 120.0
STOP_LIMIT_S = 30.0
STACKS_LIMIT_S = 5.0


class SimulatorProcess:
    """`ied-sim` for some relays, given with their addresses; their files outlive it.

    One that hangs writes the stacks of its threads to its log and is killed. `hangs` tells of it.
    """

    def __init__(self, command: Sequence[str], relays: Mapping[str, Address], log: Path) -> None:
        self.relays = dict(relays)
        self.hangs: list[str] = []
        self.serves_since_s: float | None = None
        """Since when it serves (monotonic clock), None while it does not."""
        self._command = list(command)
        self._log = log
        self._process: subprocess.Popen[str] | None = None
        self._lock = Lock()

    def start(self) -> None:
        """Start and wait until it serves. Raises RuntimeError with its last words."""
        with self._lock:
            self._start()

    def power_cycle(self, off_s: float) -> None:
        """SIGKILL, a while without mains, start again."""
        with self._lock:
            self._kill()
            time.sleep(off_s)
            self._start()

    def restart_hung(self, what: str) -> None:
        """Write down that it hangs, with stacks, and start it anew."""
        with self._lock:
            self._end_hung(what)
            self._start()

    def stop(self, limit_s: float = STOP_LIMIT_S) -> None:
        """SIGTERM, and an end as hung where that does not end it in time."""
        with self._lock:
            if self._process is None:
                return
            self.serves_since_s = None
            self._process.terminate()
            try:
                self._process.wait(limit_s)
            except subprocess.TimeoutExpired:
                self._end_hung(f"has not ended {limit_s:g} s after SIGTERM")
            else:
                self._kill()

    def _start(self) -> None:
        with self._log.open("a") as log:
            self._process = subprocess.Popen(self._command, stdout=subprocess.PIPE, stderr=log, text=True)
        assert self._process.stdout is not None
        late = Timer(START_LIMIT_S, self._process.kill)
        late.start()
        try:
            is_ready = any(line.strip() == "ready" for line in self._process.stdout)
        finally:
            late.cancel()
        if not is_ready:
            self._kill()
            raise RuntimeError(f"a simulator does not start: {self._log.read_text()[-2000:]}")
        self.serves_since_s = time.monotonic()

    def _end_hung(self, what: str) -> None:
        if self._process is None:
            return
        before = self._log.stat().st_size
        self._process.send_signal(signal.SIGUSR1)
        eventually(lambda: self._log.stat().st_size > before, STACKS_LIMIT_S)
        self._kill()
        self.hangs.append(f"the simulator of {', '.join(self.relays)} {what}: its stacks are in {self._log}")

    def _kill(self) -> None:
        process, self._process, self.serves_since_s = self._process, None, None
        if process is not None:
            process.kill()
            process.wait()
            assert process.stdout is not None
            process.stdout.close()


@contextmanager
def running_simulators(plant: ChaosPlant, directory: Path, files: Path) -> Iterator[list[SimulatorProcess]]:
    """All relays of the plant, served for as long as the block lasts."""
    simulators = [
        _simulator(plant, first, files, directory / f"ied-sim-{first}.log")
        for first in range(0, len(plant.relays), RELAYS_A_PROCESS)
    ]
    with ThreadPoolExecutor(len(simulators)) as working:
        try:
            list(working.map(SimulatorProcess.start, simulators))
            yield simulators
        finally:
            stop_all(simulators)


def stop_all(simulators: Sequence[SimulatorProcess]) -> None:
    """Stop all of them at once; those that have ended already stay so."""
    with ThreadPoolExecutor(len(simulators)) as working:
        list(working.map(SimulatorProcess.stop, simulators))


def _simulator(plant: ChaosPlant, first: int, files: Path, log: Path) -> SimulatorProcess:
    relays = {relay.name: relay.own for relay in plant.relays[first : first + RELAYS_A_PROCESS]}
    command = [sys.executable, "-m", "tests.chaos.simulator_with_stacks", "--scd", str(plant.simulator_scd)]
    command += ["--scenario", str(plant.scenario), "--files", str(files)]
    command += [word for relay in relays for word in ("--ied", relay)]
    return SimulatorProcess(command, relays, log)
