"""`mcc follow`: the condition of one motor over its records, without a service."""

import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

from core.condition.errors import ObservationError
from core.condition.following.follower import Follower
from core.condition.verdict.condition import Condition
from core.condition.verdict.judging import condition_of
from core.error_words import one_line
from core.machines.motor_file.error import MotorFileError
from core.machines.motor_file.reader import read_motor
from core.machines.parameters import Motor
from core.motor_condition.condition import MotorCondition, motor_condition
from core.motor_condition.judging import rotor_part, supply_part, voltages_agree
from core.motor_condition.supply import supply_condition
from core.recordings.reading import SUFFIXES
from core.rotor.trend import condition_of_findings
from core.time_stamps import rfc3339
from core.units import NANOSECONDS_PER_DAY
from service.cli.conditions.followed_bus import Bus, Member, bus_of, read_neighbours
from service.cli.conditions.followed_records import Seen, find_records, observe_all
from service.cli.conditions.given_events import GivenEvent, given_events
from service.cli.conditions.view import print_condition
from service.cli.output import CommandError, failing_clearly, print_document, print_warning, progress
from service.cli.recordings.given_columns import NOTHING_GIVEN, GivenColumns, with_given_columns
from service.client.verdicts import local_time


@dataclass(frozen=True, slots=True)
class Step:
    """One record that was used, and the condition after it."""

    seen: Seen
    condition: Condition

    def as_dict(self) -> dict[str, object]:
        """Return the step as an entry of the history."""
        condition = self.condition
        return {
            "record": _name(self.seen.path),
            "time": _time(self.seen),
            "state": str(condition.state),
            "kind": str(condition.kind),
            "candidates": [str(kind) for kind in condition.candidates],
            "phase": condition.phase,
            "mu_f": condition.mu_f,
            "change": condition.change,
        }


@dataclass(frozen=True, slots=True)
class Followed:
    """All that came of the records: the condition at the end, the steps to it, and what was not used."""

    condition: MotorCondition
    steps: tuple[Step, ...]
    skipped: tuple[Seen, ...]


def follow_records(
    records: Sequence[str],
    motor_file: Path,
    *,
    neighbours: Sequence[str],
    events: Sequence[str],
    events_file: Path | None,
    stale_after_days: float,
    lenient: bool,
    as_json: bool,
    given: GivenColumns = NOTHING_GIVEN,
) -> None:
    """Read the records, fold them in the order of time, and print the motor's condition.

    A record that cannot be used is named with the reason; it only ages the condition.

    given: what the command line says of a table's columns.
    neighbours: MOTOR.toml=RECORDS of other motors of the bus.

    Raises CommandError where the motor's file or an event cannot be used, or none of the records.
    """
    with failing_clearly(MotorFileError, OSError):
        motor = with_given_columns(read_motor(motor_file), given)
        happened = given_events(events, events_file)

        def observe(paths: Sequence[Path], of: Motor) -> Sequence[Seen]:
            with _bar(of.name) as advance:
                return observe_all(paths, of, lenient=lenient, advance=advance)

        own = Member(motor, observe(find_records(records), motor))
        bus = bus_of(own, read_neighbours(neighbours, motor, observe))
    followed = follow(own, bus, happened, round(stale_after_days * NANOSECONDS_PER_DAY))
    if not followed.steps:
        raise _none_usable(records, followed.skipped)
    if followed.condition.stator.as_of_ns is None:
        latest = local_time(_time(followed.steps[-1].seen))
        print_warning(
            f"there is no record after the latest event, only until {latest}: the condition is unknown"
        )
    if as_json:
        print_document(_document(motor_file, followed, happened, bus))
    else:
        skipped = [(_name(one.path), one.refusal) for one in followed.skipped]
        history = [step.as_dict() for step in followed.steps]
        print_condition(followed.condition.as_dict(), history, skipped)


def follow(own: Member, bus: Bus, events: Sequence[GivenEvent], stale_after_ns: int) -> Followed:
    """Fold records and events in their order of time.

    The age of the condition is counted until the latest record, whether that is of use or not: the same
    records give the same answer on any day.
    """
    follower = Follower(own.motor)
    times_ns = [one.time_ns for one in own.seen if one.time_ns is not None]
    now_ns = max(times_ns, default=0)
    waiting = list(events)
    steps: list[Step] = []
    skipped: list[Seen] = []
    for one in own.seen:
        if one.observation is None:
            skipped.append(one)
            continue
        while waiting and waiting[0].event.time_ns <= one.observation.time_ns:
            _apply(follower, waiting.pop(0))
        try:
            follower.fold(one.observation, bus.records.neighbours(one.observation.time_ns))
        except ObservationError as error:
            skipped.append(one.refused(str(error)))
            continue
        steps.append(Step(one, _brief(follower, bus, one.observation.time_ns)))
    for event in waiting:
        _apply(follower, event)
    condition = condition_of(
        follower.motor,
        follower.assessment(bus.standings),
        now_ns,
        stale_after_ns,
        ended_by=follower.ended_by,
    )
    return Followed(_whole(condition, own.motor, steps), tuple(steps), tuple(skipped))


def _whole(stator: Condition, motor: Motor, steps: Sequence[Step]) -> MotorCondition:
    """Return the condition of the motor: of its stator, of its rotor and of its supply."""
    seen = [step.seen for step in steps]
    rotors = [(one.time_ns or 0, one.rotor) for one in seen if one.rotor is not None]
    supply = supply_condition(
        [one.supply for one in seen if one.supply is not None],
        motor.nameplate.rated_frequency_Hz,
        voltages_agree=voltages_agree(stator),
    )
    return motor_condition(stator, (rotor_part(condition_of_findings(rotors)), supply_part(supply)))


def _brief(follower: Follower, bus: Bus, now_ns: int) -> Condition:
    """Return the condition after a record. A forecast, which takes long, is made at the end only."""
    assessment = follower.assessment(bus.standings)
    brief = None if assessment is None else replace(assessment, levels=())
    return condition_of(follower.motor, brief, now_ns)


def _apply(follower: Follower, given: GivenEvent) -> None:
    # The file of an edited motor may have another name; it is the same motor.
    name = follower.motor.name
    follower.apply(given.event, None if given.motor is None else replace(given.motor, name=name))


def _document(
    motor_file: Path, followed: Followed, events: Sequence[GivenEvent], bus: Bus
) -> dict[str, object]:
    return {
        **followed.condition.as_dict(),
        "motor_file": _name(motor_file),
        "bus": [one.as_dict() for one in bus.others],
        "events": [one.as_dict() for one in events],
        "history": [step.as_dict() for step in followed.steps],
        "skipped": _skipped(followed.skipped),
    }


def _skipped(records: Sequence[Seen]) -> list[dict[str, object]]:
    return [
        {
            "record": _name(one.path),
            "time": _time(one),
            "reason": one_line(one.refusal),
            "operation": None if one.operation is None else str(one.operation),
        }
        for one in records
    ]


def _none_usable(given: Sequence[str], skipped: Sequence[Seen]) -> CommandError:
    if not skipped:
        what = f"no recordings in {', '.join(given)}: expected {', '.join(SUFFIXES)} files"
    else:
        first = skipped[0]
        what = f"none of {len(skipped)} records can be used; the first, {_name(first.path)}: {first.refusal}"
    details = {"type": "NoUsableRecord", "skipped": _skipped(skipped)}
    return CommandError(one_line(what), details=details)


def _name(path: Path) -> str:
    """Return a path as text that any encoding of a terminal takes."""
    return one_line(os.fsencode(path).decode("utf-8", errors="replace"))


def _time(seen: Seen) -> str | None:
    return None if seen.time_ns is None else rfc3339(seen.time_ns)


@contextmanager
def _bar(motor: str) -> Iterator[Callable[[int, int], None]]:
    """Show a progress bar on stderr, if that is a terminal."""
    console = progress()
    columns = (TextColumn("{task.description}", markup=False), BarColumn(), MofNCompleteColumn())
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task(f"records of {one_line(motor)}", total=None)
        yield lambda done, of: bar.update(task, completed=done, total=of)
