"""Reads the plant from its two files.

The SCD says which relay protects which motor, at which address, and what it offers. The motors file gives the
nameplate and the equivalent circuit of each motor. Both must name the same motors. Either may say on which
bus a motor is; the motors file wins.
"""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path

import scl
from core.machines.sensors import SensorClass
from service.configuration.relay_access import PASSWORD_VARIABLE, RelayAccess, named_in_environment
from service.configuration.settings import Settings, SettingsError
from service.plant.errors import PlantError
from service.plant.metering import measurands_from_scl
from service.plant.model import Bus, Plant, PlantMotor, Relay, Site
from service.plant.motors_file import BusEntry, read_motors_file
from service.plant.offer import offer_from_scl
from service.plant.overrides import Overrides
from service.plant.recognition import recognise
from service.plant.sensor_classes import typical_sensors


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
        return _plant(configuration, motors_path)
    except scl.SclError as error:
        line = "" if error.line is None else f"line {error.line}: "
        raise PlantError(
            error.path, f"{line}{error.element or 'file'}", expected=error.expected, found=error.found
        ) from error


def _given(path: Path | None, name: str, expected: str) -> Path:
    if path is None:
        raise SettingsError("settings", name, expected=expected, found="nothing")
    return path


def _plant(configuration: scl.Scl, motors_path: Path) -> Plant:
    path = configuration.path
    feeders = configuration.feeders()
    told = read_motors_file(motors_path, _typical_sensors(configuration, feeders))
    entries = told.motors
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
    bus_of = {feeder.motor: entries[feeder.motor].bus or feeder.bus for feeder in feeders}
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
                bus_of[feeder.motor],
            )
            for feeder in feeders
        ),
        buses=_buses(bus_of, told.buses, motors_path),
    )


def _typical_sensors(configuration: scl.Scl, feeders: Iterable[scl.MotorFeeder]) -> dict[str, SensorClass]:
    """Return the class of sensors that is typical of each motor's relay."""
    relays = {feeder.motor: configuration.ied(feeder.ied) for feeder in feeders}
    return {motor: typical_sensors(relay.manufacturer, relay.type) for motor, relay in relays.items()}


def _buses(
    bus_of: Mapping[str, str | None], told: Mapping[str, BusEntry], motors_path: Path
) -> tuple[Bus, ...]:
    """Return the buses in the order of their first motors. Raises PlantError for a bus without motors."""
    buses: dict[str, list[str]] = {}
    for motor, bus in bus_of.items():
        if bus is not None:
            buses.setdefault(bus, []).append(motor)
    for unknown in sorted(told.keys() - buses.keys()):
        known = ", ".join(sorted(buses)) or "none is known"
        raise PlantError(
            motors_path,
            f"bus {unknown}",
            expected=f"a bus of the SCD, or one that a motor names ({known})",
            found="a bus without motors",
        )
    nothing_told = BusEntry(schedule=None, common_voltage_transformer=False)
    entries = {name: told.get(name, nothing_told) for name in buses}
    return tuple(
        Bus(name, tuple(motors), entries[name].schedule, entries[name].common_voltage_transformer)
        for name, motors in buses.items()
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
