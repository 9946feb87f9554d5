"""Reads the motors file: what it says of each motor, of relays, and of the buses that motors share."""

import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from core.error_words import nearest, shown
from service.configuration.problems import Problem, Problems
from service.configuration.toml_lines import TomlLines
from service.plant.errors import plant_error
from service.plant.overrides import AS_RECOGNISED, OverrideError, Overrides, overrides_from_table
from service.plant.relay_entry import RelayEntry, relay_entry
from service.plant.schedule import Schedule
from service.plant.tables import PlantTable, is_text

TABLES = ("motor", "relay", "bus")
MOST_DAYS = 365.0
LEAST_S, MOST_S = 1.0, 30.0
"""Of long records: days from one to the next, and their length."""


@dataclass(frozen=True, slots=True)
class MotorEntry:
    """What the file says of one motor and its relay.

    data: the tables of its nameplate, parameters and the like.
    description: in words; None where the file has none.
    relay: name of its relay; None where it names none.
    long_record_days, long_record_s: None where the settings decide.
    bus: the bus it names; None where it names none.
    is_sound: whether all of this could be read.
    keys: that the table may have beside those of its data.
    """

    name: str
    data: Mapping[str, object]
    description: str | None
    relay: str | None
    schedule: Schedule | None
    overrides: Overrides
    bus: str | None
    long_record_days: float | None
    long_record_s: float | None
    is_sound: bool
    keys: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class BusEntry:
    """What the file says of one bus."""

    schedule: Schedule | None
    common_voltage_transformer: bool


@dataclass(frozen=True, slots=True)
class MotorsFile:
    """Motors, relays and buses by their names.

    tables: where each table is in the file, by kind and name.
    """

    path: Path
    motors: Mapping[str, MotorEntry]
    relays: Mapping[str, RelayEntry]
    buses: Mapping[str, BusEntry]
    lines: TomlLines
    tables: Mapping[tuple[str, str], int]

    def problem(
        self, kind: str, name: str, *key: str, expected: str, found: str, nearest: str | None = None
    ) -> Problem:
        """Return what is wrong with a key of a motor, relay or bus, or with all of its table."""
        field = ": ".join((f"{kind} {name}", *key[-1:]))
        return Problem(str(self.path), field, expected, found, nearest, self._line(kind, name, *key))

    def place(self, kind: str, name: str, *key: str) -> str:
        """Return where a key of a motor, relay or bus is: the file, and the line if it is known."""
        line = self._line(kind, name, *key)
        return str(self.path) if line is None else f"{self.path}: line {line}"

    def _line(self, kind: str, name: str, *key: str) -> int | None:
        number = self.tables.get((kind, name))
        return None if number is None else self.lines.line(kind, number, *key)


def read_motors_file(path: Path, problems: Problems) -> MotorsFile:
    """Read the file; what is wrong in its tables is added to the problems.

    Raises PlantError where the file cannot be read at all.
    """
    text = _text(path)
    document, lines = _document(path, text), TomlLines(text)
    for unknown in [name for name in document if name not in TABLES]:
        problems.add(
            Problem(
                str(path),
                "top level",
                "[[motor]], [[relay]] and [[bus]] tables and nothing else",
                unknown,
                nearest(unknown, TABLES),
                lines.line(unknown),
            )
        )
    entries: dict[str, dict[str, PlantTable]] = {kind: {} for kind in TABLES}
    numbers: dict[tuple[str, str], int] = {}
    for kind in TABLES:
        for number, name, values in _tables(document, kind, path, lines, problems):
            numbers[kind, name] = number
            line = partial(lines.line, kind, number)
            entries[kind][name] = PlantTable(values, f"{kind} {name}", path, problems, line)
    if not entries["motor"] and not problems:
        problems.add(Problem(str(path), "top level", "a [[motor]] table for each motor", "none"))
    return MotorsFile(
        path,
        {name: _motor_entry(table, name) for name, table in entries["motor"].items()},
        {name: relay_entry(table, name) for name, table in entries["relay"].items()},
        {name: _bus_entry(table) for name, table in entries["bus"].items()},
        lines,
        numbers,
    )


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8")
    except FileNotFoundError as error:
        raise plant_error(
            path, "file", expected="a TOML file with [[motor]] tables", found="no file"
        ) from error
    except OSError as error:
        raise plant_error(path, "file", expected="a readable file", found=str(error)) from error
    except UnicodeDecodeError as error:
        raise plant_error(path, "file", expected="valid TOML in UTF-8", found=str(error)) from error


def _document(path: Path, text: str) -> dict[str, object]:
    try:
        return tomllib.loads(text)
    except (ValueError, RecursionError) as error:  # also of tables or numbers that Python has no room for
        raise plant_error(path, "file", expected="valid TOML in UTF-8", found=str(error)) from error


def _tables(
    document: Mapping[str, object], kind: str, path: Path, lines: TomlLines, problems: Problems
) -> Iterator[tuple[int, str, dict[str, object]]]:
    """Yield each table of a kind with its number and name, the first of each name."""
    given = document.get(kind, [])
    if not isinstance(given, list):
        expected = f"[[{kind}]] tables, with two brackets"
        problems.add(Problem(str(path), kind, expected, shown(given), line=lines.line(kind)))
        return
    seen: set[str] = set()
    for number, values in enumerate(given):
        field, line = f"{kind} {number + 1}: name", lines.line(kind, number, "name")
        name = values.pop("name", None) if isinstance(values, dict) else None
        if not isinstance(name, str) or not is_text(name):
            problems.add(Problem(str(path), field, f"the {kind}'s name", repr(name), line=line))
        elif name in seen:
            problems.add(Problem(str(path), field, f"each {kind} once", f"{name} again", line=line))
        else:
            seen.add(name)
            yield number, name, values


def _motor_entry(table: PlantTable, name: str) -> MotorEntry:
    if "/" in name:
        table.refuse("name", "a name without '/', which parts addresses of the REST API", name)
    description = table.text("description", "what the motor drives, in words")
    schedule = table.schedule()
    bus = table.text("bus", "the name of a bus")
    long_record_days = table.number(
        "long_record_days", 0.0, MOST_DAYS, "days from one long record to the next"
    )
    long_record_s = table.number("long_record_s", LEAST_S, MOST_S, "length of a long record [s]")
    relay, overrides = _relay_of_motor(table)
    return MotorEntry(
        name,
        data=table.rest(),
        description=description,
        relay=relay,
        schedule=schedule,
        overrides=overrides,
        bus=bus,
        long_record_days=long_record_days,
        long_record_s=long_record_s,
        is_sound=table.is_sound,
        keys=table.keys,
    )


def _relay_of_motor(table: PlantTable) -> tuple[str | None, Overrides]:
    """Read `relay = "NAME"` or the table [motor.relay], which has a name or not."""
    value = table.take("relay")
    if value is None:
        return None, AS_RECOGNISED
    decided: dict[str, object] = {"name": value} if isinstance(value, str) else {}
    if isinstance(value, dict):
        decided = dict(value)
    elif not decided:
        table.refuse("relay", "the name of a relay, or a table", value)
    name = decided.pop("name", None)
    if name is not None and not (isinstance(name, str) and is_text(name)):
        table.refuse("relay.name", "the name of a relay", name)
        name = None
    try:
        return name, overrides_from_table(decided)
    except OverrideError as error:
        table.tell(error.field, expected=error.expected, found=error.found, nearest=error.nearest)
        return name, AS_RECOGNISED


def _bus_entry(table: PlantTable) -> BusEntry:
    entry = BusEntry(
        table.schedule(),
        table.flag(
            "common_voltage_transformer",
            "true (all relays have their voltages from one transformer) or false",
        ),
    )
    table.end()
    return entry
