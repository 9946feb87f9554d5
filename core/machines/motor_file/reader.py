"""MOTOR.toml: nameplate, parameters with their intervals, channels, limits and sensors of one motor."""

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from math import isnan, sqrt
from pathlib import Path

from core.error_words import nearest
from core.machines import plausibility
from core.machines.motor_file.error import MotorFileError
from core.machines.motor_file.heating import start_limits, thermal_element
from core.machines.motor_file.table import MotorTable
from core.machines.motor_file.unit_slips import likely_slip
from core.machines.parameters import (
    ChannelNames,
    Limits,
    MachineKind,
    MachineParameters,
    Motor,
    Nameplate,
    ParametersSource,
    StartLimits,
    ThermalElement,
    Transformers,
    WoundRotor,
)
from core.machines.sensors import SensorClass
from core.machines.typical import tolerances_of, typical_parameters
from core.quantity_text import plain

TABLES = (
    "nameplate",
    "parameters",
    "intervals",
    "channels",
    "limits",
    "sensors",
    "transformers",
    "thermal",
    "rotor_circuit",
)
OF_A_WOUND_ROTOR = ("rotor_voltage_V", "rotor_current_A", "rated_speed_rpm")
"""Keys of the nameplate that a cage does not have."""
BELONGS_TO_A_WOUND_ROTOR = 'nothing, or kind = "wound-rotor" under [nameplate]'

PARAMETERS = tuple(field.name for field in fields(MachineParameters))
DEFAULT_SENSORS = SensorClass()
FAULT_LEVELS = (0.0, 0.2)
"""To the upper end of the search. A higher limit would never be reached and would switch the alarm off."""


@dataclass(frozen=True, slots=True)
class Plate:
    """What is known of a motor before its start was recorded.

    Parameters
    ----------
    name : str
        Name of the motor.
    nameplate : Nameplate
        Rated values of the motor.
    parameters : MachineParameters or None
        Parameters of the machine, None where the file has none.
    channels : ChannelNames
        Names of the channels in the record.
    limits : Limits
        Limits of the motor's condition.
    sensors : SensorClass
        Class of the relay's channels with their transformers.
    transformers : Transformers, optional
        Ratios of the instrument transformers, where the recordings do not tell them right.
    source : ParametersSource
        Where the parameters come from; typical of the rating where the file has none.
    intervals : dict of str to tuple of float
        95 % intervals of parameters, by name.
    start_limits : StartLimits, optional
        What its starts may do to the motor.
    wound_rotor : WoundRotor or None, optional
        The rotor's winding; None of a motor with a cage.
    thermal : ThermalElement or None, optional
        Its relay's thermal element.
    """

    name: str
    nameplate: Nameplate
    parameters: MachineParameters | None
    channels: ChannelNames
    limits: Limits
    sensors: SensorClass
    transformers: Transformers = field(default_factory=Transformers)
    source: ParametersSource = ParametersSource.GIVEN
    intervals: dict[str, tuple[float, float]] = field(default_factory=dict)
    start_limits: StartLimits = field(default_factory=StartLimits)
    wound_rotor: WoundRotor | None = None
    thermal: ThermalElement | None = None

    @property
    def motor(self) -> Motor:
        """The motor, with typical parameters where the file has none."""
        parameters = self.parameters or typical_parameters(self.nameplate, self.wound_rotor).parameters
        return Motor(
            self.name,
            self.nameplate,
            parameters,
            self.channels,
            self.limits,
            self.sensors,
            self.transformers,
            self.source,
            tolerances_of(parameters, self.source, self.intervals),
            self.start_limits,
            self.wound_rotor,
            self.thermal,
        )


def read_motor(path: Path | str) -> Motor:
    """Read MOTOR.toml; the motor is named after the file.

    Parameters
    ----------
    path : pathlib.Path or str
        Path of the file.

    Returns
    -------
    Motor
        The motor, with parameters typical of its rating where the file has none.

    Raises
    ------
    MotorFileError
        If the file is missing or unreadable, a value is missing or impossible, or a key is unknown.
    """
    path = Path(path)
    return motor_from_table(_table_of(path), name=path.stem, source=path)


def read_plate(path: Path | str) -> Plate:
    """Read a MOTOR.toml as it is, without typical parameters in place of those that it leaves out.

    Parameters
    ----------
    path : pathlib.Path or str
        Path of the file.

    Returns
    -------
    Plate
        What the file says.

    Raises
    ------
    MotorFileError
        If the file is missing or unreadable, a value is missing or impossible, or a key is unknown.
    """
    path = Path(path)
    return plate_from_table(_table_of(path), name=path.stem, source=path)


def motor_from_table(
    table: Mapping[str, object], *, name: str, source: Path | str, typical: SensorClass = DEFAULT_SENSORS
) -> Motor:
    """Make a motor from the tables of its file.

    [nameplate] must be there; [parameters], [intervals], [channels], [limits], [sensors], [transformers] and
    [rotor_circuit] are optional. A motor without [parameters] has those that are typical of its rating.

    Parameters
    ----------
    table : mapping of str to object
        The tables, as tomllib reads them.
    name : str
        Name of the motor.
    source : pathlib.Path or str
        Where the tables come from, for messages.
    typical : SensorClass, optional
        Class of the motor's relay, for what [sensors] does not say.

    Returns
    -------
    Motor
        The motor.

    Raises
    ------
    MotorFileError
        If a value is missing or impossible, or a key is unknown.
    """
    return plate_from_table(table, name=name, source=source, typical=typical).motor


def _table_of(path: Path) -> dict[str, object]:
    try:
        return tomllib.loads(path.read_text("utf-8"))
    except OSError as error:
        raise MotorFileError(
            path, "file", expected="a readable TOML file", found=f"none ({error.strerror})"
        ) from error
    except (ValueError, RecursionError) as error:  # also of tables or numbers that Python has no room for
        raise MotorFileError(
            path, "file", expected="valid TOML in UTF-8", found=f"an error: {error}"
        ) from error


def plate_from_table(
    table: Mapping[str, object], *, name: str, source: Path | str, typical: SensorClass = DEFAULT_SENSORS
) -> Plate:
    """Read the tables of a motor's file as they are.

    Parameters
    ----------
    table : mapping of str to object
        The tables, as tomllib reads them.
    name : str
        Name of the motor.
    source : pathlib.Path or str
        Where the tables come from, for messages.
    typical : SensorClass, optional
        Class of the motor's relay, for what [sensors] does not say.

    Returns
    -------
    Plate
        What the file says.

    Raises
    ------
    MotorFileError
        If a value is missing or impossible, or a key is unknown.
    """
    errors: list[MotorFileError] = []
    plate = _plate(table, name, source, typical, errors)
    figures = [number for number, error in enumerate(errors) if _is_of_a_figure(error)]
    if figures:
        slip = likely_slip(table, lambda other: _has_plausible_figures(other, name, source, typical))
        errors[figures[0]] = errors[figures[0]].with_nearest(slip)
    if errors:
        raise errors[0].with_others(errors[1:])
    return plate


def _is_of_a_figure(error: MotorFileError) -> bool:
    return error.field.startswith(("[nameplate]", "[parameters]")) and error.nearest is None


def _has_plausible_figures(
    table: Mapping[str, object], name: str, source: Path | str, typical: SensorClass
) -> bool:
    errors: list[MotorFileError] = []
    _plate(table, name, source, typical, errors)
    return not any(map(_is_of_a_figure, errors))


def _plate(
    table: Mapping[str, object],
    name: str,
    source: Path | str,
    typical: SensorClass,
    errors: list[MotorFileError],
) -> Plate:
    """Return what the tables say. With errors it is good for nothing."""
    for unknown in sorted(set(table) - set(TABLES)):
        errors.append(
            MotorFileError(
                source,
                unknown,
                expected="one of the tables "
                f"{', '.join(f'[{each}]' for each in TABLES)} (docs/reference/motor-file.md)",
                found="an unknown key",
                nearest=nearest(unknown, TABLES),
            )
        )
    nameplate = MotorTable(table, "nameplate", source, errors)
    machine = MotorTable(table, "parameters", source, errors) if "parameters" in table else None
    intervals = MotorTable(table, "intervals", source, errors, optional=True)
    rotor_circuit = MotorTable(table, "rotor_circuit", source, errors, optional=True)
    limits = MotorTable(table, "limits", source, errors, optional=True)
    channels = MotorTable(table, "channels", source, errors, optional=True)
    sensors = MotorTable(table, "sensors", source, errors, optional=True)
    transformers = MotorTable(table, "transformers", source, errors, optional=True)
    thermal = MotorTable(table, "thermal", source, errors, optional=True)
    rated = _nameplate(nameplate)
    # The intervals say how far the parameters may be off; the models use the values alone.
    ends = {name: found for name in PARAMETERS if (found := intervals.interval(name)) is not None}
    plate = Plate(
        name=name,
        nameplate=rated,
        parameters=None if machine is None else _parameters(machine, rated),
        channels=ChannelNames(
            currents=channels.names("ia", "ib", "ic"),
            phase_voltages=channels.names("va", "vb", "vc"),
            line_voltages=channels.names("vab", "vbc", "vca"),
        ),
        limits=Limits(
            fault_level=limits.number(
                "fault_level",
                FAULT_LEVELS,
                f"a fraction of at most {FAULT_LEVELS[1]:g} (0.005 means 0.5 %)",
                default=Limits().fault_level,
            )
        ),
        sensors=_sensors(sensors, typical),
        transformers=Transformers(
            voltage_ratio=transformers.ratio("voltage_ratio"),
            current_ratio=transformers.ratio("current_ratio"),
        ),
        source=_source(machine, has_intervals=bool(ends)),
        intervals=ends,
        start_limits=start_limits(limits, rated),
        wound_rotor=_wound_rotor(nameplate, rotor_circuit, rated),
        thermal=thermal_element(thermal, rated),
    )
    optional = (intervals, rotor_circuit, limits, channels, sensors, transformers, thermal)
    for section in (nameplate, machine, *optional):
        if section is not None:
            section.end()
    return plate


def _nameplate(table: MotorTable) -> Nameplate:
    voltage_V = table.number("rated_voltage_V", plausibility.RATED_VOLTAGE_V, unit="V")
    if isnan(voltage_V):
        power_W = table.number("rated_power_W", plausibility.RATED_POWER_W, unit="W")
    else:
        power = plausibility.plausible_power(voltage_V)
        power_W = table.number("rated_power_W", (power.least, power.most), str(power))
    return Nameplate(
        rated_power_W=power_W,
        rated_voltage_V=voltage_V,
        rated_frequency_Hz=table.number("rated_frequency_Hz", plausibility.RATED_FREQUENCY_HZ, unit="Hz"),
        pole_pairs=table.count("pole_pairs", plausibility.MOST_POLE_PAIRS),
        connection=table.connection("connection"),
        rotor_slots=table.optional_count("rotor_slots", plausibility.MOST_ROTOR_SLOTS),
    )


def _wound_rotor(plate: MotorTable, circuit: MotorTable, rated: Nameplate) -> WoundRotor | None:
    """Return the rotor's winding; None of a cage, to which none of its keys belongs."""
    if plate.kind("kind") is MachineKind.CAGE:
        plate.refuse_all(OF_A_WOUND_ROTOR, BELONGS_TO_A_WOUND_ROTOR)
        circuit.refuse_all(("external_resistance_ohm",), BELONGS_TO_A_WOUND_ROTOR)
        return None
    voltage_V = plate.number("rotor_voltage_V", plausibility.ROTOR_VOLTAGE_V, unit="V")
    least, most = plausibility.ROTOR_POWER
    base_A = rated.rated_power_W / (sqrt(3.0) * voltage_V)
    synchronous_rpm = 60.0 * rated.rated_frequency_Hz / rated.pole_pairs
    slowest, fastest = plausibility.RATED_SPEED
    rotor = WoundRotor(
        open_circuit_voltage_V=voltage_V,
        rated_current_A=plate.number(
            "rotor_current_A",
            (least * base_A, most * base_A),
            f"{least:g} to {most:g} times rated_power_W / (sqrt(3) rotor_voltage_V) = {plain(base_A)} A",
        ),
        rated_speed_rpm=plate.optional_number(
            "rated_speed_rpm", (slowest * synchronous_rpm, fastest * synchronous_rpm), unit="rpm"
        ),
    )
    most_ohm = plausibility.EXTERNAL_RESISTANCE * rotor.standstill_impedance_ohm
    return replace(
        rotor, external_resistance_ohm=circuit.span("external_resistance_ohm", most_ohm, "ohm a phase")
    )


def _parameters(table: MotorTable, nameplate: Nameplate) -> MachineParameters:
    return MachineParameters(
        **{
            one.field: table.number(one.field, (one.least, one.most), str(one))
            for one in plausibility.plausible_parameters(nameplate)
        }
    )


def _source(table: MotorTable | None, *, has_intervals: bool) -> ParametersSource:
    """Return where the parameters come from: as the file says, else commissioned if it has intervals."""
    if table is None:
        return ParametersSource.TYPICAL
    usual = ParametersSource.COMMISSIONED if has_intervals else ParametersSource.GIVEN
    return table.source("source", usual)


def _sensors(table: MotorTable, typical: SensorClass) -> SensorClass:
    return SensorClass(
        **{
            one.field: table.number(
                one.field, (one.least, one.most), str(one), default=getattr(typical, one.field)
            )
            for one in plausibility.plausible_sensors()
        }
    )
