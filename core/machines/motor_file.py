"""MOTOR.toml: nameplate, parameters with their intervals, channels, limits and sensors of one motor."""

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from math import inf
from pathlib import Path

from core.machines import plausibility
from core.machines.parameters import (
    ChannelNames,
    Connection,
    Limits,
    MachineParameters,
    Motor,
    Nameplate,
    ParametersSource,
    Transformers,
)
from core.machines.sensors import SensorClass
from core.machines.typical import tolerances_of, typical_parameters

TABLES = ("nameplate", "parameters", "intervals", "channels", "limits", "sensors", "transformers")
PARAMETERS = tuple(field.name for field in fields(MachineParameters))
DEFAULT_SENSORS = SensorClass()
FAULT_LEVELS = (0.0, 0.2)
"""To the upper end of the search. A higher limit would never be reached and would switch the alarm off."""

TRANSFORMER_RATIOS = (1e-4, 1e5)
"""Also of clip-on sensors whose volts or millivolts the recording calls amperes, and of kV called V."""

ROUNDING = 1e-6
"""A value may lie so far beyond its ends, relatively: files have seven digits of it."""

MOST_SHOWN = 60
"""Of a value that is refused, so many characters are shown."""


class MotorFileError(ValueError):
    """The error of a motor's table that cannot be used.

    It says which file, which field, what was expected and what was found.

    Parameters
    ----------
    source : pathlib.Path or str
        Name of the recording, for messages.
    field : str
        Field at fault.
    expected : str
        What was expected, in words.
    found : str
        What was found, in words.
    """

    def __init__(self, source: Path | str, field: str, *, expected: str, found: str) -> None:
        self.source = str(source)
        self.field = field
        self.expected = expected
        self.found = found
        super().__init__(f"{self.source}: {field}: expected {expected}, found {found}")


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

    @property
    def motor(self) -> Motor:
        """The motor, with typical parameters where the file has none."""
        parameters = self.parameters or typical_parameters(self.nameplate).parameters
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
    return _plate_from_table(_table_of(path), name=path.stem, source=path)


def motor_from_table(
    table: Mapping[str, object], *, name: str, source: Path | str, typical: SensorClass = DEFAULT_SENSORS
) -> Motor:
    """Make a motor from the tables of its file.

    [nameplate] must be there; [parameters], [intervals], [channels], [limits], [sensors] and [transformers]
    are optional. A motor without [parameters] has those that are typical of its rating.

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
    return _plate_from_table(table, name=name, source=source, typical=typical).motor


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


def _plate_from_table(
    table: Mapping[str, object], *, name: str, source: Path | str, typical: SensorClass = DEFAULT_SENSORS
) -> Plate:
    unknown = sorted(set(table) - set(TABLES))
    if unknown:
        raise MotorFileError(
            source,
            unknown[0],
            expected="one of the tables "
            f"{', '.join(f'[{table}]' for table in TABLES)} (docs/reference/motor-file.md)",
            found="an unknown key",
        )
    nameplate = _Table(table, "nameplate", source)
    machine = _Table(table, "parameters", source) if "parameters" in table else None
    intervals = _Table(table, "intervals", source, optional=True)
    limits = _Table(table, "limits", source, optional=True)
    channels = _Table(table, "channels", source, optional=True)
    sensors = _Table(table, "sensors", source, optional=True)
    transformers = _Table(table, "transformers", source, optional=True)
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
    )
    for section in (nameplate, machine, intervals, limits, channels, sensors, transformers):
        if section is not None:
            section.reject_unknown()
    return plate


def _nameplate(table: "_Table") -> Nameplate:
    voltage_V = table.number("rated_voltage_V", plausibility.RATED_VOLTAGE_V, unit="V")
    power = plausibility.plausible_power(voltage_V)
    return Nameplate(
        rated_power_W=table.number("rated_power_W", (power.least, power.most), str(power)),
        rated_voltage_V=voltage_V,
        rated_frequency_Hz=table.number("rated_frequency_Hz", plausibility.RATED_FREQUENCY_HZ, unit="Hz"),
        pole_pairs=table.count("pole_pairs", plausibility.MOST_POLE_PAIRS),
        connection=table.connection("connection"),
    )


def _parameters(table: "_Table", nameplate: Nameplate) -> MachineParameters:
    return MachineParameters(
        **{
            one.field: table.number(one.field, (one.least, one.most), str(one))
            for one in plausibility.plausible_parameters(nameplate)
        }
    )


def _source(table: "_Table | None", *, has_intervals: bool) -> ParametersSource:
    """Return where the parameters come from: as the file says, else commissioned if it has intervals."""
    if table is None:
        return ParametersSource.TYPICAL
    usual = ParametersSource.COMMISSIONED if has_intervals else ParametersSource.GIVEN
    return table.source("source", usual)


def _sensors(table: "_Table", typical: SensorClass) -> SensorClass:
    return SensorClass(
        **{
            one.field: table.number(
                one.field, (one.least, one.most), str(one), default=getattr(typical, one.field)
            )
            for one in plausibility.plausible_sensors()
        }
    )


class _Table:
    """One table of the file: typed access that names the field when it refuses."""

    def __init__(
        self, tables: Mapping[str, object], name: str, source: Path | str, *, optional: bool = False
    ) -> None:
        values = tables.get(name, {} if optional else None)
        if not isinstance(values, Mapping):
            found = "nothing" if values is None else type(values).__name__
            raise MotorFileError(source, f"[{name}]", expected="a table", found=found)
        self._values, self._name, self._source = values, name, source
        self._known: set[str] = set()

    def number(
        self,
        key: str,
        ends: tuple[float, float],
        expected: str = "",
        *,
        unit: str = "",
        default: float | None = None,
    ) -> float:
        """Return a number above zero between the ends, which belong to it. `expected`: those in words."""
        value = self._take(key, default)
        low, high = ends
        expected = expected or f"{low:g} to {high:g} {unit}"
        if isinstance(value, bool) or not isinstance(value, int | float) or not 0.0 < value < inf:
            raise self._error(key, f"a number above zero, {expected}", value)
        if not low * (1.0 - ROUNDING) <= value <= high * (1.0 + ROUNDING):
            raise self._error(key, expected, value)
        return float(value)

    def ratio(self, key: str) -> float | None:
        """Return a ratio of transformers, None where there is none."""
        if self._take(key, None) is None:
            return None
        expected = "primary over secondary value such as 60 for 6600:110, or 1 where the values are primary"
        return self.number(key, TRANSFORMER_RATIOS, expected)

    def interval(self, key: str) -> tuple[float, float] | None:
        value = self._take(key, None)
        if value is None:
            return None
        if (
            not isinstance(value, list)
            or len(value) != 2
            or any(isinstance(end, bool) or not isinstance(end, int | float) for end in value)
            or not 0.0 < value[0] <= value[1] < inf
        ):
            raise self._error(key, "[low, high], two numbers above zero", value)
        try:
            return float(value[0]), float(value[1])
        except OverflowError:
            raise self._error(key, "numbers that a computer can hold", value) from None

    def count(self, key: str, most: int) -> int:
        value = self._take(key, None)
        if isinstance(value, bool) or not isinstance(value, int) or not 1 <= value <= most:
            raise self._error(key, f"a whole number of 1 to {most}", value)
        return value

    def connection(self, key: str) -> Connection:
        value = self._take(key, Connection.STAR.value)
        try:
            return Connection(str(value))
        except ValueError:
            raise self._error(key, '"star" or "delta"', value) from None

    def source(self, key: str, default: ParametersSource) -> ParametersSource:
        value = self._take(key, default.value)
        try:
            return ParametersSource(str(value))
        except ValueError:
            raise self._error(key, f"one of {', '.join(ParametersSource)}", value) from None

    def names(self, *keys: str) -> tuple[str, str, str] | None:
        self._known.update(keys)
        given = [key for key in keys if key in self._values]
        if not given:
            return None
        first, second, third = (self._name_of(key) for key in keys)
        return first, second, third

    def reject_unknown(self) -> None:
        unknown = sorted(set(self._values) - self._known)
        if unknown:
            raise MotorFileError(
                self._source,
                f"[{self._name}] {unknown[0]}",
                expected=f"one of {', '.join(sorted(self._known))}",
                found="an unknown key",
            )

    def _name_of(self, key: str) -> str:
        value = self._take(key, None)
        if not isinstance(value, str) or not value:
            raise self._error(key, "a channel name", value)
        return value

    def _take(self, key: str, default: object) -> object:
        self._known.add(key)
        return self._values.get(key, default)

    def _error(self, key: str, expected: str, found: object) -> MotorFileError:
        shown = "nothing" if found is None else _shown(found)
        return MotorFileError(self._source, f"[{self._name}] {key}", expected=expected, found=shown)


def _shown(value: object) -> str:
    """Return a value for a message; TOML has integers of any length, of which Python prints only some."""
    try:
        text = repr(value)
    except ValueError:
        return "a number of thousands of digits"
    return text if len(text) <= MOST_SHOWN else f"{text[:MOST_SHOWN]}..."
