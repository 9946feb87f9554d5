"""A simulator that hangs is named with its stacks, and does not end the run."""

import sys
from pathlib import Path

from scl import Address
from testing.ports import LOOPBACK
from testing.relays.serving import mute_server
from testing.waiting import wait_until
from tests.chaos.hang_watch import HangWatch
from tests.chaos.simulators import SimulatorProcess

HANGING = """
import faulthandler, signal, threading
faulthandler.register(signal.SIGUSR1, all_threads=True)
signal.signal(signal.SIGTERM, signal.SIG_IGN)

def waits_for_ever():
    threading.Lock().acquire()
    threading.Event().wait()

print("ready", flush=True)
waits_for_ever()
"""


def test_a_simulator_that_does_not_end_is_named_with_its_stacks(tmp_path: Path) -> None:
    simulator = _hanging(tmp_path, 1)
    simulator.start()
    simulator.stop(0.1)
    (told,) = simulator.hangs
    assert "the simulator of R1 has not ended 0.1 s after SIGTERM: its stacks are in" in told
    assert "in waits_for_ever" in (tmp_path / "log").read_text()


def test_a_relay_that_answers_nothing_is_noticed_while_the_run_goes_on(tmp_path: Path) -> None:
    noted: list[str] = []
    with mute_server() as port:
        simulator = _hanging(tmp_path, port)
        simulator.start()
        with HangWatch([simulator], noted.append, period_s=0.05, answer_limit_s=0.05, limit_s=0.2):
            wait_until(lambda: simulator.hangs, "the hang to be noticed")
        simulator.stop(0.1)
    assert noted[0].startswith("a simulator hangs: R1 has not answered for ")
    assert "in waits_for_ever" in (tmp_path / "log").read_text()


def _hanging(directory: Path, port: int) -> SimulatorProcess:
    return SimulatorProcess(
        [sys.executable, "-c", HANGING], {"R1": Address(LOOPBACK, port)}, directory / "log"
    )
