"""Reads the motors file: what it says of each motor, its relay, and the buses that motors share."""

import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import cast

from core.machines.motor_file import MotorFileError, motor_from_table
from core.machines.parameters import Motor
from core.machines.sensors import SensorClass
from service.plant.errors import PlantError
from service.plant.overrides import OverrideError, Overrides, overrides_from_table
from service.plant.schedule import Schedule

DEFAULT_SENSORS = SensorClass()


@dataclass(frozen=True, slots=True)
class MotorEntry:
    """What the file says of one motor and its relay.

    bus: the bus it names; None where it names none.
    """

    motor: Motor
    schedule: Schedule | None
    overrides: Overrides
    bus: str | None


@dataclass(frozen=True, slots=True)
class BusEntry:
    """What the file says of one bus."""

    schedule: Schedule | None
    common_voltage_transformer: bool


@dataclass(frozen=True, slots=True)
class MotorsFile:
    """Motors and buses by their names."""

    motors: Mapping[str, MotorEntry]
    buses: Mapping[str, BusEntry]


def read_motors_file(path: Path, typical: Mapping[str, SensorClass]) -> MotorsFile:
    """Read the file.

    typical: class of sensors that is typical of a motor's relay, by motor; the file's own wins.

    Raises PlantError.
    """
    document = _document(path)
    motors = document.pop("motor", None)
    buses = document.pop("bus", [])
    if document or not _are_tables(motors) or not _are_tables(buses):
        found = ", ".join(document) or ("none" if motors is None else "something else of these names")
        raise PlantError(
            path, "top level", expected="[[motor]] and [[bus]] tables and nothing else", found=found
        )
    entries: dict[str, MotorEntry] = {}
    for name, table in _named(motors, "motor", path):
        entries[name] = _motor_entry(table, name, path, typical.get(name, DEFAULT_SENSORS))
    return MotorsFile(
        entries, {name: _bus_entry(table, name, path) for name, table in _named(buses, "bus", path)}
    )


def _document(path: Path) -> dict[str, object]:
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError as error:
        raise PlantError(
            path, "file", expected="a TOML file with [[motor]] tables", found="no file"
        ) from error
    except OSError as error:
        raise PlantError(path, "file", expected="a readable file", found=str(error)) from error
    except (UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise PlantError(path, "file", expected="valid TOML in UTF-8", found=str(error)) from error


def _are_tables(value: object) -> bool:
    return isinstance(value, list) and all(isinstance(table, dict) for table in value)


def _named(tables: object, kind: str, path: Path) -> Iterator[tuple[str, dict[str, object]]]:
    """Yield each table with its name. Raises PlantError for a name that is missing or there twice."""
    seen: set[str] = set()
    for number, table in enumerate(cast(list[dict[str, object]], tables), start=1):
        name = table.pop("name", None)
        if not isinstance(name, str) or not name:
            raise PlantError(path, f"{kind} {number}: name", expected=f"the {kind}'s name", found=repr(name))
        if name in seen:
            raise PlantError(
                path, f"{kind} {number}: name", expected=f"each {kind} once", found=f"{name} again"
            )
        seen.add(name)
        yield name, table


def _motor_entry(table: dict[str, object], name: str, path: Path, typical: SensorClass) -> MotorEntry:
    schedule = _schedule(table, path, f"motor {name}")
    bus = table.pop("bus", None)
    if bus is not None and (not isinstance(bus, str) or not bus):
        raise PlantError(path, f"motor {name}: bus", expected="the name of a bus", found=repr(bus))
    try:
        overrides = overrides_from_table(table.pop("relay", {}))
        motor = motor_from_table(table, name=name, source=str(path), typical=typical)
    except (MotorFileError, OverrideError) as error:
        raise PlantError(
            path, f"motor {name}: {error.field}", expected=error.expected, found=error.found
        ) from error
    return MotorEntry(motor, schedule, overrides, bus)


def _bus_entry(table: dict[str, object], name: str, path: Path) -> BusEntry:
    schedule = _schedule(table, path, f"bus {name}")
    common = table.pop("common_voltage_transformer", False)
    if not isinstance(common, bool):
        raise PlantError(
            path,
            f"bus {name}: common_voltage_transformer",
            expected="true (all relays have their voltages from one transformer) or false",
            found=repr(common),
        )
    if table:
        raise PlantError(
            path,
            f"bus {name}: {next(iter(table))}",
            expected="one of name, schedule, common_voltage_transformer",
            found="an unknown key",
        )
    return BusEntry(schedule, common)


def _schedule(table: dict[str, object], path: Path, whose: str) -> Schedule | None:
    expression = table.pop("schedule", None)
    if expression is None:
        return None
    try:
        return Schedule.parse(expression if isinstance(expression, str) else "")
    except ValueError as error:
        raise PlantError(path, f"{whose}: schedule", expected=str(error), found=repr(expression)) from error
