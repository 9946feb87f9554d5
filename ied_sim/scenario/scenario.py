"""The scenario: which motor stands behind each relay, in what condition, on what supply, under what load.

It is one TOML file, explained in docs/reference/scenario.md.
"""

from collections.abc import Mapping
from math import inf
from pathlib import Path

from pydantic import ValidationError

from core.machines.motor_file.error import MotorFileError
from core.machines.motor_file.reader import motor_from_table
from core.machines.parameters import MachineParameters, Motor, Nameplate
from ied_sim.errors import ScenarioError
from ied_sim.motor.cage import Cage, cage_loops
from ied_sim.motor.coils import coils_of
from ied_sim.motor.contactor import Contactor
from ied_sim.motor.fault import FaultCourse
from ied_sim.motor.feeder import Feeder
from ied_sim.motor.plant import HIGHEST_STEP_RATE_HZ, RATE_PER_STEP, MotorPlant
from ied_sim.motor.saturation import LINEAR_IRON
from ied_sim.motor.slip_rings import SlipRings
from ied_sim.motor.slots import SlotWinding
from ied_sim.motor.supply import Supply
from ied_sim.motor.windings import highest_fault_resistance
from ied_sim.profiles.profile import DEFAULT, Profile, Record, Triggers, read_profile
from ied_sim.relay.configuration import Access, RelayConfiguration
from ied_sim.relay.event_recorder import RecorderSettings
from ied_sim.relay.plant_clock import REAL_TIME, ClockSettings
from ied_sim.scenario.motor_tables import RotorTable, SensorsTable
from ied_sim.scenario.supply_tables import BusTable, SupplyTable
from ied_sim.scenario.tables import FileTable, LoadTable, MotorTable, RecorderTable, TriggersTable
from ied_sim.toml_tables import first_error, read_table
from mms import CredentialFileError


def read_scenario(path: Path, profile: str = DEFAULT) -> dict[str, RelayConfiguration]:
    """Return the configuration of each relay by its IED; `profile` is for those that name none.

    Raises ScenarioError, ProfileError.
    """
    file = _file(path)
    buses = _buses(path, file)
    scenarios: dict[str, RelayConfiguration] = {}
    for motor in file.motor:
        if motor.ied in scenarios:
            raise ScenarioError(
                path, f"[motor {motor.ied}] ied", expected="each IED once", found="a second motor"
            )
        scenarios[motor.ied] = _relay_scenario(path, motor, buses, profile)
    return scenarios


def read_clock(path: Path) -> ClockSettings:
    """Return how the plant's time runs. Raises ScenarioError."""
    clock = _file(path).clock
    return REAL_TIME if clock is None else clock.settings()


def _file(path: Path) -> FileTable:
    table = read_table(path, ScenarioError)
    try:
        return FileTable.model_validate(table)
    except ValidationError as error:
        raise first_error(path, _place(table, error), error, ScenarioError) from error


def _buses(path: Path, file: FileTable) -> dict[str, BusTable]:
    """Return the buses by name."""
    buses: dict[str, BusTable] = {}
    for bus in file.bus:
        if bus.name in buses:
            raise ScenarioError(
                path, f"[bus {bus.name}] name", expected="each bus once", found="a second one"
            )
        buses[bus.name] = bus
    return buses


def healthy_reference(ied: str, profile: str = DEFAULT) -> RelayConfiguration:
    """Make the configuration of a relay that no scenario names.

    It protects a healthy 800 W motor (thesis Table 3.2) at half load. Raises ProfileError where there is no
    such profile.
    """
    motor = _reference_motor(ied)
    kind = read_profile(profile)
    return RelayConfiguration(
        MotorPlant(
            motor=motor,
            supply=SupplyTable().busbar(motor.nameplate, "abc", name=ied, seed=0),
            load=LoadTable().load(),
            sensors=SensorsTable(noise=0.002).sensors(motor),
            contactor=Contactor(),
        ),
        profile=kind,
        recorder=_recorder(kind.record, RecorderTable(), motor.nameplate.rated_frequency_Hz),
        triggers=kind.triggers,
    )


def _reference_motor(name: str) -> Motor:
    return Motor(
        name=name,
        nameplate=Nameplate(rated_power_W=800, rated_voltage_V=380, rated_frequency_Hz=50, pole_pairs=2),
        parameters=MachineParameters(
            stator_resistance_ohm=8.4,
            rotor_resistance_ohm=8.2,
            stator_leakage_H=0.0328,
            rotor_leakage_H=0.0328,
            stator_self_inductance_H=0.4377,
            inertia_kgm2=0.0229,
        ),
    )


def _motor(path: Path, section: MotorTable) -> Motor:
    """Return the motor of the tables nameplate and parameters; the reference motor where neither is given."""
    if section.nameplate is None and section.parameters is None:
        return _reference_motor(section.ied)
    if section.parameters is None:
        raise ScenarioError(
            path,
            f"[motor {section.ied}] [parameters]",
            expected="a table: the machine as it truly is",
            found="nothing",
        )
    table = {"nameplate": section.nameplate, "parameters": section.parameters}
    given = {name: part for name, part in table.items() if part is not None}
    try:
        return motor_from_table(given, name=section.ied, source=path)
    except MotorFileError as error:
        raise ScenarioError(
            path, f"[motor {section.ied}] {error.field}", expected=error.expected, found=error.found
        ) from error


def _supply(path: Path, section: MotorTable, motor: Motor, buses: Mapping[str, BusTable]) -> Supply:
    """Return the supply of the motor's bus, or its own."""
    sequence = section.supply.sequence
    if section.bus is None:
        return section.supply.busbar(motor.nameplate, sequence, name=section.ied, seed=section.seed)
    if section.bus not in buses:
        raise ScenarioError(
            path,
            f"[motor {section.ied}] bus",
            expected=f"the name of a [[bus]] ({', '.join(buses) or 'there is none'})",
            found=section.bus,
        )
    bus = buses[section.bus]
    return bus.busbar(motor.nameplate, sequence, name=bus.name, seed=bus.seed)


def _relay_scenario(
    path: Path, section: MotorTable, buses: Mapping[str, BusTable], profile_name: str
) -> RelayConfiguration:
    motor = _motor(path, section)
    cage = _cage(path, section, motor)
    winding = _winding(path, section, motor, cage)
    profile = _profile(path, section, profile_name)
    return RelayConfiguration(
        plant=MotorPlant(
            motor=motor,
            supply=_supply(path, section, motor, buses),
            load=section.load.load(),
            sensors=section.sensors.sensors(motor),
            fault=_fault(path, section, motor, winding),
            winding=winding,
            seed=section.seed,
            warming=None if section.warming is None else section.warming.warming(),
            broken_bars=section.cage.course(cage),
            cage=cage,
            eccentricity=section.eccentricity.eccentricity(),
            slip_rings=_slip_rings(path, section, motor),
            contactor=Contactor(
                open_at_first=section.stopped, opens_s=inf if section.stop is None else section.stop.time_s
            ),
            joint=None if section.joint is None else section.joint.course(),
            feeder=_feeder(path, section, motor),
            main_saturation=LINEAR_IRON if section.saturation is None else section.saturation.saturation(),
        ),
        profile=profile,
        recorder=_recorder(profile.record, section.recorder, motor.nameplate.rated_frequency_Hz),
        triggers=_triggers(profile.triggers, section.triggers),
        protection=section.protection.settings(),
        misbehaviour=tuple(each.misbehaviour() for each in section.misbehaviour),
        load_profile_s=section.recorder.load_profile_s,
        time_zone=section.recorder.time_zone,
        access=_access(path, section),
    )


def _feeder(path: Path, section: MotorTable, motor: Motor) -> Feeder:
    """Return what else lies behind the relay's transformers."""
    try:
        return section.feeder.feeder(motor)
    except ValueError as error:
        raise ScenarioError(
            path,
            f"[motor {section.ied}] feeder",
            expected="one that the motor's connection allows",
            found=str(error),
        ) from error


def _winding(path: Path, section: MotorTable, motor: Motor, cage: Cage) -> SlotWinding | None:
    """Return the winding by slots; it must be one of the motor's poles and leakage."""
    if section.winding is None:
        return None
    winding = section.winding.winding()
    try:
        coils_of(motor, winding, cage)
    except ValueError as error:
        raise ScenarioError(
            path, f"[motor {section.ied}] winding", expected="one that the motor can have", found=str(error)
        ) from error
    return winding


def _fault(path: Path, section: MotorTable, motor: Motor, winding: SlotWinding | None) -> FaultCourse | None:
    """Return the fault's development."""
    if section.fault is None:
        return None
    where = f"[motor {section.ied}] fault"
    try:
        course = section.fault.course(motor.parameters.stator_resistance_ohm, winding)
    except ValueError as error:
        raise ScenarioError(
            path, f"{where}.coil", expected="a coil of the phase", found=str(error)
        ) from error
    highest_ohm = highest_fault_resistance(motor.parameters, HIGHEST_STEP_RATE_HZ * RATE_PER_STEP)
    if course.coil is None and course.resistance_ohm > highest_ohm:
        raise ScenarioError(
            path,
            f"{where}.resistance_ohm",
            expected=f"at most {highest_ohm:.3g}, above which the shorted loop is too fast to simulate",
            found=f"{course.resistance_ohm:g}",
        )
    return course


def _cage(path: Path, section: MotorTable, motor: Motor) -> Cage:
    """Return the cage; its bars must be enough for the motor where some are broken."""
    nameplate = motor.nameplate
    try:
        cage = section.cage.cage(nameplate.rotor_bars)
        if "cage" in section.model_fields_set:
            cage_loops(motor.parameters, nameplate.pole_pairs, cage, 0.0)
    except ValueError as error:
        raise ScenarioError(
            path,
            f"[motor {section.ied}] cage",
            expected="bars, places and broken bars that fit each other and the motor",
            found=str(error),
        ) from error
    return cage


def _slip_rings(path: Path, section: MotorTable, motor: Motor) -> SlipRings | None:
    """Return the slip rings of a wound rotor, which has no cage; shorted ones where nothing is said."""
    where = f"[motor {section.ied}]"
    if section.rotor is None and motor.wound_rotor is None:
        return None
    if motor.wound_rotor is not None and "cage" in section.model_fields_set:
        raise ScenarioError(
            path, f"{where} cage", expected="nothing: the motor has a wound rotor", found="a table"
        )
    try:
        return (section.rotor or RotorTable()).slip_rings(motor)
    except ValueError as error:
        raise ScenarioError(
            path, f"{where} rotor", expected="slip rings of a wound rotor", found=str(error)
        ) from error


def _access(path: Path, section: MotorTable) -> Access:
    try:
        return section.access.access(path.parent)
    except CredentialFileError as error:
        raise ScenarioError(
            path,
            f"[motor {section.ied}] access: {error.path}",
            expected=error.expected,
            found=error.found,
        ) from error


def _profile(path: Path, section: MotorTable, default: str) -> Profile:
    """Return the motor's relay profile, with the record formats of the scenario where it names some."""
    profile = (
        read_profile(default)
        if section.profile is None
        else read_profile(section.profile, beside=path.parent)
    )
    if section.recorder.formats is None:
        return profile
    try:
        record = Record.model_validate(profile.record.model_dump() | {"formats": section.recorder.formats})
    except ValidationError as error:
        place = f"[motor {section.ied}] recorder.formats"
        raise first_error(path, place, error, ScenarioError) from error
    return profile.model_copy(update={"record": record})


def _recorder(record: Record, section: RecorderTable, frequency_Hz: float) -> RecorderSettings:
    """Return the profile's record at this line frequency, with what the scenario puts in its place."""
    per_cycle = record.samples_per_cycle
    rate_Hz = record.sample_rate_Hz if per_cycle is None else per_cycle * frequency_Hz
    before_s = record.pre_trigger_cycles / frequency_Hz
    after_s = (record.cycles - record.pre_trigger_cycles) / frequency_Hz
    return RecorderSettings(
        sample_rate_hz=section.sample_rate_Hz or rate_Hz or 0.0,
        pre_trigger_s=before_s if section.pre_trigger_s is None else section.pre_trigger_s,
        post_trigger_s=section.post_trigger_s or after_s,
        capacity=section.capacity or record.capacity,
    )


def _triggers(of_profile: Triggers, section: TriggersTable) -> Triggers:
    given = {key: value for key, value in section.model_dump().items() if value is not None}
    return of_profile.model_copy(update=given)


def _place(table: Mapping[str, object], error: ValidationError) -> str:
    """Return where the first error is: a motor is called by its IED, a bus by its name, where it has one."""
    location = list(error.errors()[0]["loc"])
    if len(location) < 2 or not isinstance(location[1], int):
        return ".".join(str(part) for part in location)
    kind = str(location[0])
    rows = table.get(kind)
    row = rows[location[1]] if isinstance(rows, list) else None
    name = row.get("ied" if kind == "motor" else "name") if isinstance(row, dict) else None
    field = ".".join(str(part) for part in location[2:])
    return f"[{kind} {name if isinstance(name, str) else location[1] + 1}] {field}".rstrip()
