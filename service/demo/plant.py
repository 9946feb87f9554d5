"""The demo plant as it runs: the simulator and the service, each a process of its own, on loopback only."""

import os
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import scl
from service.demo import MOTORS, SCENARIO
from service.demo.addresses import LOOPBACK, addressed_scd, free_port
from service.demo.processes import Program
from service.rest_client import ServiceClient

START_LIMIT_S = 90.0
POLL_PERIOD_S = 0.1
SERVICE_PORT = 8710


class NotReadyError(RuntimeError):
    """The demo plant did not come up in time."""


@dataclass(frozen=True, slots=True)
class DemoPlant:
    """A running plant: its files, the service's address, and how to wait for it.

    pause: waits some seconds; raises ProgramError when a program of the plant has ended.
    """

    scd: Path
    scenario: Path
    url: str
    pause: Callable[[float], None]


@contextmanager
def running_plant(data: Path, pause: Callable[[float], None]) -> Iterator[DemoPlant]:
    """The demo plant while the block runs; afterwards every process has ended. Its data stays in `data`.

    pause: waits some seconds, and may raise to end the block.

    Raises SclError, ProgramError, NotReadyError, OSError.
    """
    data.mkdir(parents=True, exist_ok=True)
    scd = addressed_scd(scl.DEMO_PLANT_SCD, data)
    port = free_port(SERVICE_PORT)
    with (
        Program("ied-sim", _simulator(scd, data), data / "ied-sim.log") as simulator,
        Program("mcc serve", _service(), data / "service.log", _environment(scd, data, port)) as service,
    ):

        def pause_and_check(seconds: float) -> None:
            pause(seconds)
            simulator.check()
            service.check()

        yield DemoPlant(scd, SCENARIO, f"http://{LOOPBACK}:{port}", pause_and_check)


def wait_until_ready(plant: DemoPlant, service: ServiceClient) -> None:
    """Until the service and every relay answer. Raises ProgramError, NotReadyError, ServiceError."""
    deadline_s = time.monotonic() + START_LIMIT_S
    while True:
        plant.pause(POLL_PERIOD_S)
        if service.is_ready():
            down = [str(ied["name"]) for ied in service.items("/ieds") if ied["link_state"] != "up"]
            if not down:
                return
        else:
            down = ["the service"]
        if time.monotonic() > deadline_s:
            raise NotReadyError(f"not ready after {START_LIMIT_S:g} s: {', '.join(down)}")


def _simulator(scd: Path, data: Path) -> list[str]:
    command = [sys.executable, "-m", "ied_sim", "--scd", str(scd), "--scenario", str(SCENARIO)]
    return [*command, "--files", str(data / "relays")]


def _service() -> list[str]:
    return [sys.executable, "-m", "service.cli", "serve"]


def _environment(scd: Path, data: Path, port: int) -> dict[str, str]:
    """The service's settings for the demo; whatever else MCC_ variables say is not the demo's."""
    others = {name: value for name, value in os.environ.items() if not name.startswith("MCC_")}
    return others | {
        "MCC_DATA_DIRECTORY": str(data),
        "MCC_SCD": str(scd),
        "MCC_MOTORS": str(MOTORS),
        "MCC_BIND_ADDRESS": LOOPBACK,
        "MCC_PORT": str(port),
    }
