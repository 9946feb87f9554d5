"""`mcc demo`: a simulated plant and a service that watches it, which both end with the command."""

import tempfile
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from itertools import count
from pathlib import Path

from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn
from rich.text import Text

from scl import SclError
from service.cli.demo.month import conditions_of, conditions_table, play_month, rotors_of
from service.cli.output import CommandError, as_json, failing_clearly, failure_document, progress, results
from service.client.rest_client import Document, ServiceClient, ServiceError
from service.demo.interruption import Interruption, interruptible
from service.demo.month import Month
from service.demo.open_alarms import open_alarms_of
from service.demo.plant import (
    DemoPlant,
    NotReadyError,
    plant_elsewhere,
    running_plant,
    wait_until_ready,
)
from service.demo.plays import MONTH_OF_CHANGES, STEADY
from service.demo.processes import ProgramError
from service.demo.results import DemoMotor, document, slowest, table
from service.demo.rounds import STATES, play_round
from service.demo.truth import TruthError, ask_simulator

ROUNDS = 2

NEXT_STEP = "alarms: mcc alarms list shows what to do, mcc alarms acknowledge ALARM says that you know"
REST_S = 60.0
"""A demo that runs until Ctrl-C pauses this long between two rounds."""


def demonstrate(*, once: bool, json_file: Path | None, data: Path | None, url: str | None) -> None:
    """Run the demo plant, or play on one that runs; with `once` two rounds of triggers, else until Ctrl-C.

    A plant that is started without `once` lives through a month first.

    Raises CommandError, and writes the same to `json_file`, where something did not work.
    """
    try:
        with (
            interruptible() as interruption,
            failing_clearly(SclError, ProgramError, NotReadyError, ServiceError, TruthError, OSError),
        ):
            if json_file is not None:
                json_file.write_bytes(b"")  # fail now, not in a minute, where it cannot be written
            started_s = time.monotonic()
            with (
                _plant(interruption, data, url, once=once) as plant,
                ServiceClient(plant.url, token=plant.token) as service,
            ):
                _run(plant, service, started_s, once=once, json_file=json_file)
    except KeyboardInterrupt as interrupt:
        failure = CommandError("interrupted", details={"type": "Interrupted"})
        _write_failure(failure, json_file)
        raise failure from interrupt
    except CommandError as error:
        _write_failure(error, json_file)
        raise


@contextmanager
def _plant(
    interruption: Interruption, data: Path | None, url: str | None, *, once: bool
) -> Iterator[DemoPlant]:
    """Start a plant, or use the one whose service answers at `url`."""
    if url is not None:
        yield plant_elsewhere(url, interruption.pause)
        return
    with _data_directory(data) as directory, ExitStack() as running:
        notes = [f"two factories, six relays and the service run (data and logs: {directory})"]
        if not once and any(directory.glob("*.sqlite")):
            notes.append(
                "the folder has records of an earlier demo: those of this month come to lie among them"
            )
        play = STEADY if once else MONTH_OF_CHANGES
        with progress().status("starting two factories, six relays and the service"):
            plant = running.enter_context(
                running_plant(directory, interruption.pause, notes.append, play=play)
            )
        if not once:
            _show_page(plant)  # the first line: it is what a newcomer looks for
        for line in notes:
            _report(line)
        yield plant


def _run(
    plant: DemoPlant, service: ServiceClient, started_s: float, *, once: bool, json_file: Path | None
) -> None:
    motors = _motors(plant, service)
    if once:
        _play(plant, service, motors, ROUNDS)
        _publish(motors, time.monotonic() - started_s, json_file)
        _require_diagnoses(motors)
        return
    console = progress()
    console.print(f"API: {plant.url}/api/v1/motors   end: Ctrl-C", soft_wrap=True)
    try:
        if plant.month is None:
            _play_rounds(plant, service, motors, started_s, json_file)
        else:
            _play_month(plant, plant.month, service, motors, json_file)
    except KeyboardInterrupt:
        console.print("ending")


def _play_month(
    plant: DemoPlant,
    month: Month,
    service: ServiceClient,
    motors: list[DemoMotor],
    json_file: Path | None,
) -> None:
    """Play the month, then rounds that add to it, and print the conditions that they lead to."""
    started_s = time.monotonic()
    minutes = month.leaps * month.leap_every_s / 60
    progress().print(
        f"{month.days:g} days of the plant pass in {minutes:.3g} minutes; a line tells what is new of a motor"
    )

    def publish(played: Sequence[DemoMotor], conditions: Mapping[str, Document]) -> None:
        if json_file is not None:
            shown = document(played, time.monotonic() - started_s, conditions)
            json_file.write_text(as_json(shown) + "\n", encoding="utf-8")

    played = play_month(plant, month, service, motors, publish)
    while True:
        conditions = conditions_of(service)
        alarms = open_alarms_of(service)
        results().print(conditions_table(played, conditions, rotors_of(service, played), alarms))
        if alarms:
            results().print(NEXT_STEP)
        _show_page(plant)
        publish(played, conditions)
        _rest(plant)
        for motor in played:
            motor.diagnoses.clear()
        _play(plant, service, played, 1)


def _play_rounds(
    plant: DemoPlant,
    service: ServiceClient,
    motors: Sequence[DemoMotor],
    started_s: float,
    json_file: Path | None,
) -> None:
    """Trigger every motor again and again, and print what is found in each recording."""
    for number in count(1):
        for motor in motors:
            motor.diagnoses.clear()
        _play(plant, service, motors, 1)
        _publish(motors, time.monotonic() - started_s, json_file, number)
        _rest(plant)
        started_s = time.monotonic()


def _motors(plant: DemoPlant, service: ServiceClient) -> list[DemoMotor]:
    """Return the service's motors with the simulator's truth, once both are up."""
    truths = ask_simulator(plant.scd, plant.scenario)
    for relay in wait_until_ready(plant, service):
        _report(f"{relay} does not answer yet; the others go on")
    return [
        DemoMotor(str(motor["name"]), str(motor["site"]), truths[str(motor["ied"])], str(motor["ied"]))
        for motor in service.list_motors()
    ]


def _play(plant: DemoPlant, service: ServiceClient, motors: Sequence[DemoMotor], rounds: int) -> None:
    bar = Progress(
        TextColumn("triggering, recording, diagnosing"),
        BarColumn(),
        TextColumn("{task.percentage:>3.0f} %"),
        TimeElapsedColumn(),
        console=progress(),
    )
    with bar:
        task = bar.add_task("diagnoses", total=rounds * len(motors) * len(STATES))
        for _ in range(rounds):
            play_round(service, motors, lambda steps: bar.advance(task, steps), plant.pause)


def _publish(motors: Sequence[DemoMotor], seconds: float, json_file: Path | None, number: int = 1) -> None:
    """Print and write the results. `seconds` include the start of the plant in the first round."""
    console = results()
    console.print(table(motors))
    longest_s = slowest(motors)
    words = "" if longest_s is None else f"; at most {longest_s:.2f} s from trigger to diagnosis"
    spent = f"{seconds:.1f} s in all" if number == 1 else f"round {number}: {seconds:.1f} s"
    console.print(Text(f"{spent}{words}"))
    if json_file is not None:
        json_file.write_text(as_json(document(motors, seconds)) + "\n", encoding="utf-8")


def _show_page(plant: DemoPlant) -> None:
    """Print a link to the page, which logs in once: another one where the last one was followed."""
    if plant.page is not None:
        results().print(Text(f"page: {plant.page()}"), soft_wrap=True)


def _report(line: str) -> None:
    progress().print(Text(line), soft_wrap=True)


def _write_failure(failure: CommandError, json_file: Path | None) -> None:
    """Write the failure to the results' file, unless the results are there already."""
    if json_file is not None and json_file.is_file() and not json_file.stat().st_size:
        json_file.write_text(as_json(failure_document(failure)) + "\n", encoding="utf-8")


def _require_diagnoses(motors: Sequence[DemoMotor]) -> None:
    without = [
        f"{motor.name} ({diagnosis.reason})"
        for motor in motors
        for diagnosis in motor.diagnoses
        if diagnosis.document is None
    ]
    if without:
        raise CommandError(f"no diagnosis of {', '.join(without)}")


def _rest(plant: DemoPlant) -> None:
    until_s = time.monotonic() + REST_S
    while time.monotonic() < until_s:
        plant.pause(1.0)


@contextmanager
def _data_directory(given: Path | None) -> Iterator[Path]:
    if given is not None:
        given.mkdir(parents=True, exist_ok=True)
        yield given.absolute()
        return
    with tempfile.TemporaryDirectory(prefix="mcc-demo-") as temporary:
        yield Path(temporary)
