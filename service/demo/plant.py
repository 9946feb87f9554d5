"""The running demo plant: simulator and service, each in its own process, on the loopback interface only."""

import os
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

import scl
from service.client.credentials import CredentialsError, forget, remember
from service.client.rest_client import ServiceClient
from service.configuration.settings import sqlite_url
from service.demo import SCENARIO
from service.demo.account import LoginLinks, demo_token
from service.demo.addresses import LOOPBACK, addressed_scd, free_port
from service.demo.month import Month, month_of
from service.demo.plays import STEADY, Play
from service.demo.processes import Program, ProgramError

START_LIMIT_S = 300.0
"""Of a service that is late: on a slow machine its workers alone compile for minutes at the first start."""
ANSWER_LIMIT_S = 5.0
"""A service that somebody else runs and that takes longer to answer at all is not there."""
POLL_PERIOD_S = 0.1
SERVICE_PORT = 8710

ATTEMPTS = 3
"""To start on ports that nobody else takes between the choice and the start."""

PORT_TAKEN = ("cannot listen on", "expected a free port")
"""What the simulator and the service log when somebody else took their port."""


class NotReadyError(RuntimeError):
    """The demo plant did not come up in time."""


@dataclass(frozen=True, slots=True)
class DemoPlant:
    """A running plant: its files, the service's address, and how to wait for it.

    pause: waits some seconds; raises ProgramError when a program of the plant has ended.
    answer_limit_s: how long nothing may listen at the address [s].
    month: the month that the plant lives through; None where its time is the real one.
    token: lets its client do what the demo shows; None where the environment has what it needs.
    page: returns a link to its page that logs in without a password; None where somebody else runs the plant.
    """

    scd: Path
    scenario: Path
    url: str
    pause: Callable[[float], None]
    answer_limit_s: float = START_LIMIT_S
    month: Month | None = None
    token: str | None = None
    page: Callable[[], str] | None = None


@contextmanager
def running_plant(
    data: Path,
    pause: Callable[[float], None],
    report: Callable[[str], None],
    *,
    play: Play = STEADY,
    choose_port: Callable[[int], int] = free_port,
) -> Iterator[DemoPlant]:
    """The demo plant while the block runs; afterwards every process has ended. Its data stays in `data`.

    pause: waits some seconds, and may raise to end the block.
    report: takes a line for the person who waits.
    play: what the demo plays.
    choose_port: returns the port of the service, given the usual one.

    Raises SclError, ProgramError, NotReadyError, OSError.
    """
    data.mkdir(parents=True, exist_ok=True)
    with ExitStack() as programs:
        plant = _start(data, play, pause, choose_port, programs)
        programs.callback(_forget, plant.url)
        try:
            remember(plant.url, token=plant.token)
        except CredentialsError as error:
            report(f"commands in other terminals may only look: {error}")
        for line in _other_addresses(plant):
            report(line)
        yield plant


def _start(
    data: Path,
    play: Play,
    pause: Callable[[float], None],
    choose_port: Callable[[int], int],
    programs: ExitStack,
) -> DemoPlant:
    """Start both programs, again on other ports where somebody else has taken the chosen ones."""
    for _ in range(ATTEMPTS - 1):
        try:
            return _start_once(data, play, pause, choose_port(SERVICE_PORT), programs)
        except ProgramError as error:
            if not any(words in str(error) for words in PORT_TAKEN):
                raise
    return _start_once(data, play, pause, choose_port(SERVICE_PORT), programs)


def _start_once(
    data: Path, play: Play, pause: Callable[[float], None], port: int, programs: ExitStack
) -> DemoPlant:
    scd = addressed_scd(scl.DEMO_PLANT_SCD, data)
    token = demo_token(sqlite_url(data))
    with ExitStack() as starting:
        command = _simulator(scd, play.scenario, data)
        simulator = starting.enter_context(Program("ied-sim", command, data / "ied-sim.log"))
        service = starting.enter_context(
            Program("mcc serve", _service(), data / "service.log", _environment(scd, play, data, port))
        )

        def pause_and_check(seconds: float) -> None:
            pause(seconds)
            simulator.check()
            service.check()

        # Ask their logs: at a port that was lost, the service of somebody else would answer.
        deadline_s = time.monotonic() + START_LIMIT_S
        while not (simulator.has_logged("\nready\n") and service.has_logged("serving")):
            pause_and_check(POLL_PERIOD_S)
            if time.monotonic() > deadline_s:
                raise NotReadyError(f"not listening after {START_LIMIT_S:g} s; logs: {data}")
        month = month_of(play.scenario, simulator.logged())
        programs.push(starting.pop_all())
    url = f"http://{LOOPBACK}:{port}"
    page = LoginLinks(sqlite_url(data), url).address
    return DemoPlant(scd, play.scenario, url, pause_and_check, month=month, token=token, page=page)


def _forget(url: str) -> None:
    """Keep no token of a service that has ended, as far as the file can be written."""
    with suppress(CredentialsError):
        forget(url)


def _other_addresses(plant: DemoPlant) -> Iterator[str]:
    """The addresses of the demo that are not those of its documentation."""
    if plant.url != f"http://{LOOPBACK}:{SERVICE_PORT}":
        yield (f"port {SERVICE_PORT} is taken; the API answers on {plant.url} (export MCC_URL={plant.url})")
    if plant.scd != scl.DEMO_PLANT_SCD:
        document = scl.read(plant.scd)
        ports = ", ".join(str(document.address(ied.name).port) for ied in document.ieds)
        yield f"a port of {plant.scd.name} is taken; the relays answer on ports {ports} (see {plant.scd})"


def plant_elsewhere(url: str, pause: Callable[[float], None]) -> DemoPlant:
    """Return a demo plant that somebody else started, whose service answers at `url`."""
    return DemoPlant(scl.DEMO_PLANT_SCD, SCENARIO, url, pause, ANSWER_LIMIT_S)


def wait_until_ready(plant: DemoPlant, service: ServiceClient) -> list[str]:
    """Wait until the service and every relay answer; return the relays that do not answer in time.

    Raises ProgramError, ServiceError, NotReadyError when the service is late or nothing listens there.
    """
    begun_s = time.monotonic()
    deadline_s = begun_s + START_LIMIT_S
    while True:
        plant.pause(POLL_PERIOD_S)
        if service.is_ready():
            down = [str(ied["name"]) for ied in service.list_ieds() if ied["link_state"] != "up"]
            if not down or time.monotonic() > deadline_s:
                return down
        elif time.monotonic() > begun_s + plant.answer_limit_s and not service.answers():
            raise NotReadyError(
                f"no service answers at {plant.url}; waited {plant.answer_limit_s:g} s; mcc demo starts one"
            )
        elif time.monotonic() > deadline_s:
            raise NotReadyError(
                f"{plant.url}: the service is not ready after {START_LIMIT_S:g} s; "
                f"{plant.url}/readyz tells which part is not"
            )


def _simulator(scd: Path, scenario: Path, data: Path) -> list[str]:
    command = [sys.executable, "-m", "ied_sim", "--scd", str(scd), "--scenario", str(scenario)]
    return [*command, "--files", str(data / "relays")]


def _service() -> list[str]:
    return [sys.executable, "-m", "service.cli", "serve"]


def _environment(scd: Path, play: Play, data: Path, port: int) -> dict[str, str]:
    """The settings of the demo's service. Other MCC_ variables of the environment are left out."""
    others = {name: value for name, value in os.environ.items() if not name.startswith("MCC_")}
    return others | {
        "MCC_DATA_DIRECTORY": str(data),
        "MCC_SCD": str(scd),
        "MCC_MOTORS": str(play.motors),
        "MCC_BIND_ADDRESS": LOOPBACK,
        "MCC_PORT": str(port),
        **play.settings,
    }
