"""Reads the plant from its two files.

The SCD says which relay protects which motor, at which address, and what it offers. The motors file gives the
nameplate and the equivalent circuit of each motor. Both must name the same motors.
"""

import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import scl
from core.machines.motor_file import MotorFileError, motor_from_table
from core.machines.parameters import Motor
from service.configuration.relay_access import PASSWORD_VARIABLE, RelayAccess, named_in_environment
from service.configuration.settings import Settings, SettingsError
from service.plant.errors import PlantError
from service.plant.metering import measurands_from_scl
from service.plant.model import Plant, PlantMotor, Relay, Site
from service.plant.offer import offer_from_scl
from service.plant.overrides import OverrideError, Overrides, overrides_from_table
from service.plant.recognition import recognise
from service.plant.schedule import Schedule


def read_plant(settings: Settings) -> Plant:
    """Read the two files that the settings name. Raises PlantError, or SettingsError where one is not set."""
    plant = plant_of_files(
        _given(settings.scd, "scd", "the path of the plant's SCD file"),
        _given(settings.motors, "motors", "the path of the plant's motors file (TOML)"),
        settings.subnetwork,
    )
    names = {relay.name for relay in plant.relays}
    for source, named in (("settings", settings.relays), ("environment", named_in_environment())):
        for unknown in sorted(set(named) - names):
            field = f"relays.{unknown}" if source == "settings" else f"{PASSWORD_VARIABLE}{unknown}"
            expected = f"a relay of {settings.scd} ({', '.join(sorted(names))})"
            raise SettingsError(source, field, expected=expected, found="another name")
    return replace(plant, relays=tuple(_at_its_port(relay, settings.relays) for relay in plant.relays))


def _at_its_port(relay: Relay, access: Mapping[str, RelayAccess]) -> Relay:
    """Return the relay, at its port for TLS if the settings give one."""
    tls = access.get(relay.name, RelayAccess()).tls
    return relay if tls is None or tls.port is None else replace(relay, port=tls.port)


def plant_of_files(scd_path: Path, motors_path: Path, subnetwork: str | None = None) -> Plant:
    """Read the plant.

    subnetwork: relays get the addresses that they have on it; their first address if None.

    Raises PlantError.
    """
    try:
        configuration = scl.read(scd_path)
        if subnetwork is not None:
            configuration = configuration.seen_from(subnetwork)
        return _plant(configuration, _motors(motors_path), motors_path)
    except scl.SclError as error:
        line = "" if error.line is None else f"line {error.line}: "
        raise PlantError(
            error.path, f"{line}{error.element or 'file'}", expected=error.expected, found=error.found
        ) from error


def _given(path: Path | None, name: str, expected: str) -> Path:
    if path is None:
        raise SettingsError("settings", name, expected=expected, found="nothing")
    return path


@dataclass(frozen=True, slots=True)
class _Entry:
    """What the motors file says of one motor and its relay."""

    motor: Motor
    schedule: Schedule | None
    overrides: Overrides


def _motors(path: Path) -> dict[str, _Entry]:
    """Return what the motors file says of each motor, by its name."""
    try:
        document = tomllib.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError as error:
        raise PlantError(
            path, "file", expected="a TOML file with [[motor]] tables", found="no file"
        ) from error
    except OSError as error:
        raise PlantError(path, "file", expected="a readable file", found=str(error)) from error
    except (UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise PlantError(path, "file", expected="valid TOML in UTF-8", found=str(error)) from error
    tables = document.pop("motor", None)
    if document or not isinstance(tables, list):
        found = ", ".join(document) or "none"
        raise PlantError(path, "top level", expected="[[motor]] tables and nothing else", found=found)
    entries: dict[str, _Entry] = {}
    for number, table in enumerate(tables, start=1):
        name = table.pop("name", None)
        if not isinstance(name, str) or not name:
            raise PlantError(path, f"motor {number}: name", expected="the motor's name", found=repr(name))
        if name in entries:
            raise PlantError(path, f"motor {number}: name", expected="each motor once", found=f"{name} again")
        expression = table.pop("schedule", None)
        schedule = None if expression is None else _schedule(expression, path, name)
        try:
            overrides = overrides_from_table(table.pop("relay", {}))
            motor = motor_from_table(table, name=name, source=str(path))
        except (MotorFileError, OverrideError) as error:
            raise PlantError(
                path, f"motor {name}: {error.field}", expected=error.expected, found=error.found
            ) from error
        entries[name] = _Entry(motor, schedule, overrides)
    return entries


def _schedule(expression: object, path: Path, motor: str) -> Schedule:
    try:
        return Schedule.parse(expression if isinstance(expression, str) else "")
    except ValueError as error:
        raise PlantError(
            path, f"motor {motor}: schedule", expected=str(error), found=repr(expression)
        ) from error


def _plant(configuration: scl.Scl, entries: dict[str, _Entry], motors_path: Path) -> Plant:
    path = configuration.path
    feeders = configuration.feeders()
    if not feeders:
        raise PlantError(
            path,
            "<Substation>",
            expected='motors (ConductingEquipment type="MOT" with an LNode of their relay)',
            found="none",
        )
    _once(path, "motor", (feeder.motor for feeder in feeders))
    _once(path, "relay", (feeder.ied for feeder in feeders))
    _one_relay_an_address(configuration, [feeder.ied for feeder in feeders])
    names = {feeder.motor for feeder in feeders}
    for missing in sorted(names - entries.keys()):
        raise PlantError(
            motors_path,
            f"motor {missing}",
            expected=f"its [[motor]] table, as {path.name} has it",
            found="none",
        )
    for unknown in sorted(entries.keys() - names):
        known = ", ".join(sorted(names))
        raise PlantError(
            motors_path,
            f"motor {unknown}",
            expected=f"a motor of {path.name} ({known})",
            found="another name",
        )
    sites = {feeder.site: Site(feeder.site, feeder.site_description) for feeder in feeders}
    return Plant(
        sites=tuple(sites.values()),
        relays=tuple(_relay(configuration, feeder, entries[feeder.motor].overrides) for feeder in feeders),
        motors=tuple(
            PlantMotor(
                entries[feeder.motor].motor,
                feeder.motor_description,
                feeder.site,
                feeder.ied,
                entries[feeder.motor].schedule,
            )
            for feeder in feeders
        ),
    )


def _once(path: Path, kind: str, names: Iterable[str]) -> None:
    seen: set[str] = set()
    for name in names:
        if name in seen:
            raise PlantError(
                path, f"{kind} {name}", expected="one motor for one relay", found=f"{name} twice"
            )
        seen.add(name)


def _one_relay_an_address(configuration: scl.Scl, relays: Iterable[str]) -> None:
    for address, sharing in configuration.shared_addresses(relays).items():
        raise PlantError(
            configuration.path,
            f"relays {' and '.join(sharing)}",
            expected="an address for each relay (P elements IP and MMS-Port)",
            found=f"{address} for {len(sharing)} of them",
        )


def _relay(configuration: scl.Scl, feeder: scl.MotorFeeder, overrides: Overrides) -> Relay:
    """Return the relay with what its SCL offers and what the motors file says of it."""
    ied = configuration.ied(feeder.ied)
    address = configuration.address(feeder.ied)
    points = recognise(ied)
    return Relay(
        name=ied.name,
        site=feeder.site,
        host=address.host,
        port=address.port,
        manufacturer=ied.manufacturer,
        type=ied.type,
        trigger_control=points.trigger,
        record_made=points.record_made,
        fault_number=points.record_number,
        report_control=points.report_control,
        metering_data_set=points.metering_data_set,
        measurands=measurands_from_scl(ied),
        expected=offer_from_scl(ied),
        overrides=overrides,
    )
