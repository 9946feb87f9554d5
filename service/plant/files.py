"""Reads the plant from its files.

The SCD says which relay protects which motor, at which address, and what it offers. The motors file gives
the nameplate and the equivalent circuit of each motor. It may also bind motors to relays, and describe relays
that no SCD has. Either may say on which bus a motor is. The motors file wins.
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from ipaddress import ip_address
from pathlib import Path

import scl
from core.error_words import nearest
from core.machines.motor_file.error import MotorFileError
from core.machines.motor_file.reader import TABLES, motor_from_table
from core.machines.parameters import Motor
from core.machines.plausibility import unusual_rating
from core.machines.typical import atypical
from service.configuration.problems import Problem, Problems
from service.configuration.relay_access import PASSWORD_VARIABLE, RelayAccess, named_in_environment
from service.configuration.settings import Settings
from service.plant.binding import Binding, bindings
from service.plant.errors import PlantError
from service.plant.model import Bus, Plant, PlantMotor, Relay, Site
from service.plant.motors_file import BusEntry, MotorEntry, MotorsFile, read_motors_file
from service.plant.relay_entry import Reading, RelayEntry
from service.plant.relays import omissions, read_own_scl, relay_of_ied, relay_without_scl, scl_problem
from service.plant.sensor_classes import typical_sensors

NOTHING_TOLD = BusEntry(schedule=None, common_voltage_transformer=False)


def read_plant(settings: Settings, problems: Problems | None = None) -> Plant:
    """Read the files that the settings name. Raises PlantError, with every problem of them.

    problems: gets the warnings.
    """
    problems = Problems() if problems is None else problems
    plant = examine_plant(settings, problems)
    if plant is None or problems:
        raise PlantError(problems)
    return plant


def examine_plant(settings: Settings, problems: Problems) -> Plant | None:
    """Read as much of the plant as can be read, and add what is wrong to the problems.

    None: nothing can be read.
    """
    if settings.motors is None:
        expected = (
            "the path of the plant's motors file (TOML), in the settings that --config FILE names or as "
            "MCC_MOTORS in the environment"
        )
        problems.add(Problem("settings", "motors", expected, "nothing"))
        return None
    plant = _plant(settings.scd, settings.motors, settings.subnetwork, problems)
    if plant is None:
        return None
    _known_in_settings(settings, plant, problems)
    return replace(plant, relays=tuple(_at_its_port(relay, settings.relays) for relay in plant.relays))


def plant_of_files(scd_path: Path | None, motors_path: Path, subnetwork: str | None = None) -> Plant:
    """Read the plant.

    subnetwork: relays get the addresses that they have on it; their first address if None.

    Raises PlantError, with every problem.
    """
    problems = Problems()
    plant = _plant(scd_path, motors_path, subnetwork, problems)
    if plant is None or problems:
        raise PlantError(problems)
    return plant


def _known_in_settings(settings: Settings, plant: Plant, problems: Problems) -> None:
    """Tell of relays that the settings or the environment name, and the plant does not have."""
    names = sorted(relay.name for relay in plant.relays)
    for source, named in (("settings", settings.relays), ("environment", named_in_environment())):
        for unknown in sorted(set(named) - set(names)):
            field = f"relays.{unknown}" if source == "settings" else f"{PASSWORD_VARIABLE}{unknown}"
            where = settings.motors if settings.scd is None else settings.scd
            problems.add(
                Problem(
                    source,
                    field,
                    f"a relay of {where} ({', '.join(names)})",
                    "another name",
                    nearest(unknown, names),
                )
            )


def _at_its_port(relay: Relay, access: Mapping[str, RelayAccess]) -> Relay:
    """Return the relay, at its port for TLS if the settings give one."""
    tls = access.get(relay.name, RelayAccess()).tls
    return relay if tls is None or tls.port is None else replace(relay, port=tls.port)


def _plant(
    scd_path: Path | None, motors_path: Path, subnetwork: str | None, problems: Problems
) -> Plant | None:
    told = configuration = None
    with problems.collected():
        told = read_motors_file(motors_path, problems)
    try:
        configuration = None if scd_path is None else scl.read(scd_path)
        if configuration is not None:
            problems.warnings.extend(omissions(configuration))
        if configuration is not None and subnetwork is not None:
            configuration = configuration.seen_from(subnetwork)
    except scl.SclError as error:
        problems.add(scl_problem(error))
    if told is None:
        return None
    if scd_path is None and not _describes_relays(told, problems):
        return None
    if scd_path is not None and configuration is None:
        _motors((), told, {}, problems)
        return None
    bound = bindings(configuration, told, problems)
    relays = _relays(bound, configuration, told, subnetwork, problems)
    _one_relay_an_address(relays.values(), configuration, told, problems)
    motors = _motors(bound, told, relays, problems)
    sites: dict[str, Site] = {}
    for one in bound:
        sites.setdefault(one.site, Site(one.site, one.site_description))
    return Plant(
        sites=tuple(sites.values()),
        relays=tuple(relays.values()),
        motors=motors,
        buses=_buses({motor.name: motor.bus for motor in motors}, told, problems),
    )


def _describes_relays(told: MotorsFile, problems: Problems) -> bool:
    """Tell whether the motors file does without an SCD."""
    if told.relays or not told.motors:
        return True
    problems.add(
        Problem(
            "settings",
            "scd",
            f"the path of the plant's SCD file, or [[relay]] tables in {told.path.name}",
            "nothing",
        )
    )
    return False


def _relays(
    bound: Iterable[Binding],
    configuration: scl.Scl | None,
    told: MotorsFile,
    subnetwork: str | None,
    problems: Problems,
) -> dict[str, Relay]:
    """Return the relays of the motors that some file describes."""
    ieds = {} if configuration is None else {ied.name: ied for ied in configuration.ieds}
    relays: dict[str, Relay] = {}
    for one in bound:
        motor, entry = told.motors.get(one.motor), _entry(one.relay, told)
        if motor is None or one.relay in relays:
            continue
        with problems.collected():
            if configuration is not None and one.relay in ieds:
                relay = relay_of_ied(
                    configuration, ieds[one.relay], one.site, entry, motor.overrides, problems
                )
            elif entry.scl is not None:
                own = read_own_scl(entry, told, subnetwork)
                problems.warnings.extend(omissions(own.configuration))
                relay = relay_of_ied(
                    own.configuration,
                    own.ied,
                    one.site,
                    entry,
                    motor.overrides,
                    problems,
                    knows_names=not own.is_icd,
                )
            elif one.relay in told.relays:
                relay = relay_without_scl(entry, one.site, told, motor.overrides)
            else:
                continue
            relays[one.relay] = relay
    return relays


def _entry(relay: str, told: MotorsFile) -> RelayEntry:
    return told.relays.get(relay, RelayEntry(relay))


def _motors(
    bound: Iterable[Binding], told: MotorsFile, relays: Mapping[str, Relay], problems: Problems
) -> tuple[PlantMotor, ...]:
    """Return the motors that have a relay. The data of all are read, for what is wrong in them."""
    binding_of = {one.motor: one for one in bound}
    data: dict[str, Motor] = {}
    for entry in told.motors.values():
        relay = relays.get(binding_of[entry.name].relay) if entry.name in binding_of else None
        typical = typical_sensors(relay.manufacturer, relay.type) if relay else typical_sensors("", "")
        try:
            data[entry.name] = motor_from_table(
                entry.data, name=entry.name, source=str(told.path), typical=typical
            )
        except MotorFileError as error:
            problems.extend(_in_motor(each, entry, told) for each in (error, *error.others))
        else:
            problems.warnings.extend(_unusual(data[entry.name], told))
            if relay is not None and _entry(relay.name, told).reading is Reading.LENIENT:
                data[entry.name] = replace(data[entry.name], reads_leniently=True)
    return tuple(
        _plant_motor(one, told.motors[name], data[name]) for name, one in binding_of.items() if name in data
    )


def _unusual(motor: Motor, told: MotorsFile) -> Iterator[str]:
    """Yield what is odd about a motor's data and may be right all the same, with its line.

    Parameters that fit a rating are checked against it already, so its power is asked about only without.
    """
    if motor.is_typical:
        for key, words in unusual_rating(motor.nameplate):
            yield f"{told.place('motor', motor.name, 'nameplate', key)}: motor {motor.name}: {words}"
    for words in atypical(motor):
        yield f"{told.place('motor', motor.name, 'parameters')}: motor {motor.name}: {words}"


def _plant_motor(one: Binding, entry: MotorEntry, motor: Motor) -> PlantMotor:
    description = one.motor_description if entry.description is None else entry.description
    return PlantMotor(
        motor,
        description,
        one.site,
        one.relay,
        entry.schedule,
        entry.bus or one.bus,
        entry.long_record_days,
        entry.long_record_s,
    )


def _in_motor(error: MotorFileError, entry: MotorEntry, told: MotorsFile) -> Problem:
    """Return what is wrong in the data of a motor."""
    table, bracket, key = error.field.removeprefix("[").partition("]")
    path = (table, key.strip()) if bracket else (error.field,)
    expected, meant = error.expected, error.nearest
    if not bracket:
        tables = ", ".join(f"[motor.{each}]" for each in TABLES)
        expected = f"one of {', '.join(entry.keys)}, {tables}"
        meant = nearest(error.field, [*entry.keys, *TABLES])
    problem = told.problem("motor", entry.name, *path, expected=expected, found=error.found, nearest=meant)
    return replace(problem, field=f"motor {entry.name}: {error.field}")


def _buses(bus_of: Mapping[str, str | None], told: MotorsFile, problems: Problems) -> tuple[Bus, ...]:
    """Return the buses in the order of their first motors."""
    buses: dict[str, list[str]] = {}
    for motor, bus in bus_of.items():
        if bus is not None:
            buses.setdefault(bus, []).append(motor)
    named = {entry.bus for entry in told.motors.values()}
    for unknown in sorted(told.buses.keys() - buses.keys() - named):
        known = ", ".join(sorted(buses)) or "none is known"
        problems.add(
            told.problem(
                "bus",
                unknown,
                expected=f"a bus of the SCD, or one that a motor names ({known})",
                found="a bus without motors",
                nearest=nearest(unknown, buses),
            )
        )
    entries = {name: told.buses.get(name, NOTHING_TOLD) for name in buses}
    return tuple(
        Bus(name, tuple(motors), entries[name].schedule, entries[name].common_voltage_transformer)
        for name, motors in buses.items()
    )


def _canonical(host: str) -> str:
    """Return one spelling of a host: ::1 is 0:0:0:0:0:0:0:1, PUMPS.PLANT is pumps.plant."""
    try:
        return str(ip_address(host))
    except ValueError:
        return host.lower()


def _one_relay_an_address(
    relays: Iterable[Relay], configuration: scl.Scl | None, told: MotorsFile, problems: Problems
) -> None:
    sharing: dict[str, list[str]] = {}
    for relay in relays:
        address = str(scl.Address(_canonical(relay.host), relay.port))
        sharing.setdefault(address, []).append(relay.name)
    for address, names in sharing.items():
        if len(names) > 1:
            path = told.path
            if configuration is not None and not told.relays.keys() & set(names):
                path = configuration.path
            problems.add(
                Problem(
                    str(path),
                    f"relays {' and '.join(names)}",
                    "an address for each relay (host and port, or P elements IP and MMS-Port of its SCL)",
                    f"{address} for {len(names)} of them",
                )
            )
