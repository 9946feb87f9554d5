"""The demo plant as it runs: the simulator and the service, each a process of its own, on loopback only."""

import os
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path

import scl
from service.client.rest_client import ServiceClient
from service.demo import MOTORS, SCENARIO
from service.demo.addresses import LOOPBACK, addressed_scd, free_port
from service.demo.processes import Program, ProgramError

START_LIMIT_S = 90.0
POLL_PERIOD_S = 0.1
SERVICE_PORT = 8710

ATTEMPTS = 3
"""To find ports nobody else takes between the choice and the start."""

PORT_TAKEN = ("cannot listen on", "expected a free port")
"""Last words of the simulator, of the service, that came too late to its port."""


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
def running_plant(
    data: Path, pause: Callable[[float], None], tell: Callable[[str], None]
) -> Iterator[DemoPlant]:
    """The demo plant while the block runs; afterwards every process has ended. Its data stays in `data`.

    pause: waits some seconds, and may raise to end the block. tell: takes a line for the person who waits.

    Raises SclError, ProgramError, NotReadyError, OSError.
    """
    data.mkdir(parents=True, exist_ok=True)
    with ExitStack() as programs:
        plant = _start(data, pause, programs)
        for line in _other_places(plant):
            tell(line)
        yield plant


def _start(data: Path, pause: Callable[[float], None], programs: ExitStack) -> DemoPlant:
    """Both programs, listening; with other ports where somebody was quicker to take the chosen ones."""
    for _ in range(ATTEMPTS - 1):
        try:
            return _start_once(data, pause, programs)
        except ProgramError as error:
            if not any(words in str(error) for words in PORT_TAKEN):
                raise
    return _start_once(data, pause, programs)


def _start_once(data: Path, pause: Callable[[float], None], programs: ExitStack) -> DemoPlant:
    scd = addressed_scd(scl.DEMO_PLANT_SCD, data)
    port = free_port(SERVICE_PORT)
    with ExitStack() as starting:
        simulator = starting.enter_context(Program("ied-sim", _simulator(scd, data), data / "ied-sim.log"))
        service = starting.enter_context(
            Program("mcc serve", _service(), data / "service.log", _environment(scd, data, port))
        )

        def pause_and_check(seconds: float) -> None:
            pause(seconds)
            simulator.check()
            service.check()

        # Their own word, because at a port that was lost somebody else's service would answer.
        deadline_s = time.monotonic() + START_LIMIT_S
        while not (simulator.has_said("\nready\n") and service.has_said("serving")):
            pause_and_check(POLL_PERIOD_S)
            if time.monotonic() > deadline_s:
                raise NotReadyError(f"not listening after {START_LIMIT_S:g} s; logs: {data}")
        programs.push(starting.pop_all())
    return DemoPlant(scd, SCENARIO, f"http://{LOOPBACK}:{port}", pause_and_check)


def _other_places(plant: DemoPlant) -> Iterator[str]:
    """Where the demo answers, as far as that is not where its documentation says."""
    if plant.url != f"http://{LOOPBACK}:{SERVICE_PORT}":
        yield (f"port {SERVICE_PORT} is taken; the API answers on {plant.url} (export MCC_URL={plant.url})")
    if plant.scd != scl.DEMO_PLANT_SCD:
        document = scl.read(plant.scd)
        ports = ", ".join(str(document.address(ied.name).port) for ied in document.ieds)
        yield f"a port of {plant.scd.name} is taken; the relays answer on ports {ports} (see {plant.scd})"


def plant_elsewhere(url: str, pause: Callable[[float], None]) -> DemoPlant:
    """A demo plant somebody else started, whose service answers at `url`."""
    return DemoPlant(scl.DEMO_PLANT_SCD, SCENARIO, url, pause)


def wait_until_ready(plant: DemoPlant, service: ServiceClient) -> list[str]:
    """Until the service and every relay answer. Returns the relays that do not, when it is late.

    Raises ProgramError, ServiceError, NotReadyError when the service is late.
    """
    deadline_s = time.monotonic() + START_LIMIT_S
    while True:
        plant.pause(POLL_PERIOD_S)
        if service.is_ready():
            down = [str(ied["name"]) for ied in service.items("/ieds") if ied["link_state"] != "up"]
            if not down or time.monotonic() > deadline_s:
                return down
        elif time.monotonic() > deadline_s:
            raise NotReadyError(f"{plant.url}: the service is not ready after {START_LIMIT_S:g} s")


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
