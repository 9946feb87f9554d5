"""Events that a command is given: TIME=KIND on the command line, or a file of them."""

import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from core.condition.events import Event, EventKind
from core.machines.motor_file.reader import read_motor
from core.machines.parameters import Motor
from core.time_stamps import nanoseconds, rfc3339
from service.cli.output import WRONG_USE, CommandError

KEYS = ("time", "kind", "reason", "motor")
MOST_OCTETS = 1_000_000


@dataclass(frozen=True, slots=True)
class GivenEvent:
    """An event, and the motor as it is from then on where its file changed."""

    event: Event
    motor: Motor | None = None

    def as_dict(self) -> dict[str, object]:
        """Return the event as a document."""
        return {
            "time": rfc3339(self.event.time_ns),
            "kind": str(self.event.kind),
            "reason": self.event.reason,
        }


def given_events(words: Sequence[str], file: Path | None) -> list[GivenEvent]:
    """Return the events of the command line and of a file, in the order of time.

    Raises CommandError (wrong use) for what is no event, MotorFileError and OSError for its files.
    """
    found = [_of_word(word) for word in words]
    if file is not None:
        found += _read(file)
    return sorted(found, key=lambda one: one.event.time_ns)


def _of_word(word: str) -> GivenEvent:
    """Return the event of TIME=KIND or TIME=KIND:REASON."""
    time, _, rest = word.partition("=")
    kind, _, reason = rest.partition(":")
    where = f"--event {word}"
    return _given(where, _event(where, time, kind, reason), None)


def _read(file: Path) -> list[GivenEvent]:
    if file.stat().st_size > MOST_OCTETS:
        raise _wrong(str(file), f"at most {MOST_OCTETS} octets", str(file.stat().st_size))
    try:
        document = tomllib.loads(file.read_text(encoding="utf-8"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, RecursionError) as error:
        raise _wrong(str(file), "a TOML file", str(error)) from None
    unknown = sorted(set(document) - {"event"})
    tables = document.get("event", [])
    if unknown or not isinstance(tables, list) or not all(isinstance(one, dict) for one in tables):
        raise _wrong(str(file), "tables [[event]] alone", unknown[0] if unknown else "something else")
    return [_from_table(file, number, table) for number, table in enumerate(tables, start=1)]


def _from_table(file: Path, number: int, table: Mapping[str, object]) -> GivenEvent:
    where = f"{file}, [[event]] {number}"
    unknown = sorted(set(table) - set(KEYS))
    if unknown:
        raise _wrong(where, f"keys {', '.join(KEYS)}", unknown[0])
    texts = {key: value for key, value in table.items() if key != "time"}
    for key, value in texts.items():
        if not isinstance(value, str):
            raise _wrong(f"{where}, {key}", "a text", type(value).__name__)
    time = table.get("time", "")
    if isinstance(time, datetime) and time.tzinfo is not None:
        time = time.astimezone(UTC).isoformat()
    event = _event(where, str(time), str(table.get("kind", "")), str(table.get("reason", "")))
    named = table.get("motor")
    return _given(where, event, None if named is None else read_motor(file.parent / str(named)))


def _given(where: str, event: Event, motor: Motor | None) -> GivenEvent:
    if motor is None and event.kind is EventKind.PARAMETERS_EDITED:
        expected = 'the motor as it is from then on (motor = "MOTOR.toml" in a file for --events)'
        raise _wrong(where, expected, "none")
    return GivenEvent(event, motor)


def _event(where: str, time: str, kind: str, reason: str) -> Event:
    try:
        time_ns = nanoseconds(time.strip())
    except ValueError:
        raise _wrong(where, "a time such as 2026-01-31T12:00:00Z", repr(time)) from None
    try:
        return Event(time_ns, EventKind(kind.strip()), reason.strip())
    except ValueError:
        raise _wrong(where, f"one of {', '.join(EventKind)}", repr(kind)) from None


def _wrong(where: str, expected: str, found: str) -> CommandError:
    return CommandError(
        f"{where}: expected {expected}, found {found}",
        details={"type": "EventUnusable", "expected": expected, "found": found},
        exit_code=WRONG_USE,
    )
