"""The simulated relays as processes: a few relays each, killed and started again as relays' mains would."""

import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, contextmanager
from pathlib import Path
from threading import Lock

from tests.chaos.plant import ChaosPlant

RELAYS_A_PROCESS = 10


class SimulatorProcess:
    """`ied-sim` for some of the relays; their files outlive it."""

    def __init__(self, plant: ChaosPlant, relays: Sequence[str], files: Path, log: Path) -> None:
        self.relays = tuple(relays)
        self._log = log
        self._command = [sys.executable, "-m", "ied_sim", "--scd", str(plant.simulator_scd)]
        self._command += ["--scenario", str(plant.scenario), "--files", str(files)]
        self._command += [word for relay in relays for word in ("--ied", relay)]
        self._process: subprocess.Popen[str] | None = None
        self._lock = Lock()

    def start(self) -> None:
        """Start and wait until it serves. Raises RuntimeError with its last words."""
        with self._lock, self._log.open("a") as log:
            self._process = subprocess.Popen(self._command, stdout=subprocess.PIPE, stderr=log, text=True)
            assert self._process.stdout is not None
            if not any(line.strip() == "ready" for line in self._process.stdout):
                raise RuntimeError(f"a simulator does not start: {self._log.read_text()[-2000:]}")

    def power_cycle(self, off_s: float) -> None:
        """SIGKILL, a while without mains, start again."""
        self._end(kill=True)
        time.sleep(off_s)
        self.start()

    def stop(self) -> None:
        self._end(kill=False)

    def _end(self, *, kill: bool) -> None:
        with self._lock:
            process = self._process
            if process is None:
                return
            process.kill() if kill else process.terminate()
            process.wait(30)
            if process.stdout is not None:
                process.stdout.close()


@contextmanager
def running_simulators(plant: ChaosPlant, directory: Path, files: Path) -> Iterator[list[SimulatorProcess]]:
    """All relays of the plant, served for as long as the block lasts."""
    names = [relay.name for relay in plant.relays]
    simulators = [
        SimulatorProcess(
            plant, names[first : first + RELAYS_A_PROCESS], files, directory / f"ied-sim-{first}.log"
        )
        for first in range(0, len(names), RELAYS_A_PROCESS)
    ]
    with ExitStack() as running, ThreadPoolExecutor(len(simulators)) as starting:
        for simulator in simulators:
            running.callback(simulator.stop)
        list(starting.map(SimulatorProcess.start, simulators))
        yield simulators
