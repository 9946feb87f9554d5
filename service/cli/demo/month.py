"""`mcc demo` without --once: a month of the plant in minutes, and what becomes of each motor's condition."""

import time
from collections.abc import Callable, Mapping, Sequence
from datetime import UTC, datetime

from rich.box import SIMPLE_HEAD
from rich.progress import BarColumn, Progress, TextColumn
from rich.text import Text

from mms import MmsError
from service.cli.output import progress, results
from service.client.conditions import condition_of, state_text
from service.client.rest_client import Document, ServiceClient
from service.client.rotor_conditions import rotor_of, rotor_text
from service.client.tables import FittedTable
from service.client.verdicts import level
from service.demo.month import Month
from service.demo.open_alarms import OpenAlarms, alarm_text
from service.demo.operator import restart
from service.demo.plant import DemoPlant
from service.demo.results import DemoMotor, condition_text
from service.demo.rounds import play_round
from service.demo.truth import Truth, ask_course

AFTER_LEAP_S = 0.3
"""A round begins so long after a leap of the plant's clock, which other processes show a little later."""

RESTARTS = (2, 8, 14)
"""After these rounds a motor is started anew: the page of its starts has one within the first minute."""

Truths = Mapping[str, Truth]


class ConditionLog:
    """Prints a line whenever something else is said of a motor."""

    def __init__(self) -> None:
        self._said: dict[str, str] = {}

    def tell(self, day: float, motors: Sequence[DemoMotor], conditions: Mapping[str, Document]) -> None:
        """Print what has changed by that day."""
        for motor in motors:
            condition = conditions[motor.name]
            said = state_text(condition)
            is_new = motor.name not in self._said
            if self._said.get(motor.name) == said.plain or (is_new and condition["state"] == "unknown"):
                continue  # of a motor whose first record is not judged yet nothing is said
            self._said[motor.name] = said.plain
            line = Text(f"day {day:4.1f}  {motor.name:<15}")
            line.append_text(said)
            if condition["mu_f"] is not None:
                line.append(f"  {level(condition['mu_f'], condition['mu_f_ci95'])}")
            line.append(f"  (in truth: {condition_text(motor.truth)})", style="dim")
            results().print(line, soft_wrap=True)


def play_month(
    plant: DemoPlant,
    month: Month,
    service: ServiceClient,
    motors: Sequence[DemoMotor],
    publish: Callable[[Sequence[DemoMotor], Mapping[str, Document]], None],
) -> list[DemoMotor]:
    """Trigger every motor after each leap of the plant's clock; return the motors as they are at the end.

    publish: takes the motors with their truth and their conditions after each round.
    Raises ServiceError, TruthError, ProgramError, KeyboardInterrupt.
    """
    moments_s = month.moments_s()
    truths = ask_course(plant.scd, plant.scenario, moments_s)
    said = ConditionLog()
    bar = Progress(TextColumn("day {task.completed:.1f} of {task.total:g}"), BarColumn(), console=progress())
    with bar:
        task = bar.add_task("month", total=month.days)
        leap = min(month.leap_at(datetime.now(UTC)) + 1, month.leaps)  # a slow start may have taken all of it
        _pause_until(month, leap, plant.pause)
        rounds = 0
        while True:
            played = [DemoMotor(one.name, one.site, truths[leap][one.ied], one.ied) for one in motors]
            play_round(service, played, lambda _: None, plant.pause)
            rounds += 1
            if rounds in RESTARTS:
                _restart(plant)
            following = max(leap, month.leap_at(datetime.now(UTC))) + 1
            # Until the next leap the service has time to judge the motors by these records.
            _pause_until(month, following, plant.pause)
            conditions = conditions_of(service)
            day = moments_s[leap] / 86_400
            bar.update(task, completed=day)
            said.tell(day, played, conditions)
            publish(played, conditions)
            if leap >= month.leaps:
                return played
            leap = min(following, month.leaps)


def _restart(plant: DemoPlant) -> None:
    try:
        restart(plant.scd, plant.pause)
    except MmsError as error:
        progress().print(Text(f"a motor was not started anew: {error}"), soft_wrap=True)


def conditions_of(service: ServiceClient) -> dict[str, Document]:
    """Return each motor's condition by its name. Raises ServiceError."""
    return {
        str(health["motor"]): condition_of(health)
        for motor in service.list_motors(health=True, limit=1000)
        if isinstance(health := motor["health"], Mapping)
    }


def rotors_of(service: ServiceClient, motors: Sequence[DemoMotor]) -> dict[str, Document]:
    """Return the condition of each motor's rotor by the motor's name. Raises ServiceError."""
    return {motor.name: rotor_of(service, motor.name) for motor in motors}


def conditions_table(
    motors: Sequence[DemoMotor],
    conditions: Mapping[str, Document],
    rotors: Mapping[str, Document],
    alarms: OpenAlarms,
) -> FittedTable:
    """Return a table of every motor's condition and rotor beside its truth, with its open alarms."""
    shown = FittedTable(
        title="Conditions and truth", title_justify="left", box=SIMPLE_HEAD, collapse_padding=True
    )
    for heading in ("motor", "truth", "condition", "level", "since", "rotor", "alarm"):
        shown.add_column(heading, no_wrap=heading == "motor")
    for motor in motors:
        condition = conditions[motor.name]
        since = condition["since"]
        shown.add_row(
            Text(motor.name),
            Text(condition_text(motor.truth)),
            state_text(condition),
            Text(level(condition["mu_f"], condition["mu_f_ci95"])),
            Text("-" if since is None else str(since)[:16].replace("T", " ")),
            rotor_text(rotors[motor.name]),
            Text(alarm_text(alarms.get(motor.name, ()))),
        )
    return shown


def _pause_until(month: Month, leap: int, pause: Callable[[float], None]) -> None:
    """Wait until shortly after a leap; afterwards it is not waited for."""
    end_s = time.monotonic() + month.until_leap_s(leap, datetime.now(UTC)) + AFTER_LEAP_S
    while (rest_s := end_s - time.monotonic()) > 0:
        pause(min(1.0, rest_s))
