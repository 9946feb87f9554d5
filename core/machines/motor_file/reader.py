"""MOTOR.toml: nameplate, parameters with their intervals, channels, limits and sensors of one motor."""

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from pathlib import Path

from core.error_words import nearest
from core.machines import plausibility
from core.machines.deep_bars import DeepBars, LeakageSaturation
from core.machines.motor_file.deep_bars import deep_bars, leakage_saturation
from core.machines.motor_file.error import MotorFileError
from core.machines.motor_file.feeder import KEYS, cable, capacitors, neutral, transformers
from core.machines.motor_file.heating import start_limits, thermal_element
from core.machines.motor_file.nameplate import read_nameplate, wound_rotor
from core.machines.motor_file.table import MotorTable
from core.machines.motor_file.tables import table_scaling
from core.machines.motor_file.unit_slips import likely_slip
from core.machines.motor_file.winding import stator_winding
from core.machines.parameters import (
    Cable,
    Capacitors,
    ChannelNames,
    Limits,
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
from core.machines.stator_winding import StatorWinding
from core.machines.typical import tolerances_of, typical_parameters
from core.table_layout import TableScaling

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
    "winding",
    "deep_bars",
    "leakage_saturation",
    "tables",
    "capacitors",
    "cable",
)
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
    winding : StatorWinding or None, optional
        How its stator is wound; None where the file does not tell it.
    deep_bars : DeepBars or None, optional
        How its rotor changes from a small slip to a great one.
    leakage_saturation : LeakageSaturation or None, optional
        How its leakage falls at great currents.
    tables : TableScaling, optional
        How tables of samples become amperes and volts.
    capacitors : Capacitors or None, optional
        Power-factor capacitors that are measured with it.
    cable : Cable or None, optional
        Its cable.
    neutral : bool, default False
        Whether its star point is on the neutral.
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
    winding: StatorWinding | None = None
    deep_bars: DeepBars | None = None
    leakage_saturation: LeakageSaturation | None = None
    tables: TableScaling = field(default_factory=TableScaling)
    capacitors: Capacitors | None = None
    cable: Cable | None = None
    neutral: bool = False

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
            self.winding,
            self.deep_bars,
            self.leakage_saturation,
            self.tables,
            self.capacitors,
            self.cable,
            self.neutral,
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

    [nameplate] must be there; [parameters], [intervals], [channels], [limits], [sensors], [transformers],
    [thermal], [rotor_circuit], [winding], [deep_bars], [leakage_saturation], [tables], [capacitors], [cable],
    and the keys ct_position and neutral, are optional.
    A motor without [parameters] has those that are typical of its rating.

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
    for unknown in sorted(set(table) - {*TABLES, *KEYS}):
        errors.append(
            MotorFileError(
                source,
                unknown,
                expected="one of the tables "
                f"{', '.join(f'[{each}]' for each in TABLES)}, or of the keys {', '.join(KEYS)} "
                "(docs/reference/motor-file.md)",
                found="an unknown key",
                nearest=nearest(unknown, (*TABLES, *KEYS)),
            )
        )
    nameplate = MotorTable(table, "nameplate", source, errors)
    machine = MotorTable(table, "parameters", source, errors) if "parameters" in table else None
    intervals = MotorTable(table, "intervals", source, errors, optional=True)
    rotor_circuit = MotorTable(table, "rotor_circuit", source, errors, optional=True)
    limits = MotorTable(table, "limits", source, errors, optional=True)
    channels = MotorTable(table, "channels", source, errors, optional=True)
    sensors = MotorTable(table, "sensors", source, errors, optional=True)
    ratios = MotorTable(table, "transformers", source, errors, optional=True)
    thermal = MotorTable(table, "thermal", source, errors, optional=True)
    winding = MotorTable(table, "winding", source, errors, optional=True)
    bars = MotorTable(table, "deep_bars", source, errors, optional=True)
    saturation = MotorTable(table, "leakage_saturation", source, errors, optional=True)
    tables = MotorTable(table, "tables", source, errors, optional=True)
    bank = MotorTable(table, "capacitors", source, errors, optional=True)
    line = MotorTable(table, "cable", source, errors, optional=True)
    rated = read_nameplate(nameplate)
    has_pole_pairs = not any(error.field == "[nameplate] pole_pairs" for error in errors)
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
        transformers=transformers(ratios, table, rated.connection, source, errors),
        source=_source(machine, has_intervals=bool(ends)),
        intervals=ends,
        start_limits=start_limits(limits, rated),
        wound_rotor=wound_rotor(nameplate, rotor_circuit, rated),
        thermal=thermal_element(thermal, rated),
        winding=stator_winding(winding, rated.pole_pairs if has_pole_pairs else None),
        deep_bars=deep_bars(bars),
        leakage_saturation=leakage_saturation(saturation, rated),
        tables=table_scaling(tables),
        capacitors=capacitors(bank, rated),
        cable=cable(line, rated),
        neutral=neutral(table, rated.connection, source, errors),
    )
    optional = (intervals, rotor_circuit, limits, channels, sensors, ratios, thermal, winding, tables)
    for section in (nameplate, machine, *optional, bars, saturation, bank, line):
        if section is not None:
            section.end()
    return plate


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
