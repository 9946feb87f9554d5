"""MOTOR.toml: nameplate, parameters, channel names and limits of one motor."""

import tomllib
from collections.abc import Mapping
from math import inf, isfinite
from pathlib import Path

from core.machines.parameters import ChannelNames, Connection, Limits, MachineParameters, Motor, Nameplate

TABLES = ("nameplate", "parameters", "channels", "limits")
HIGHEST_FAULT_LIMIT = 0.2
"""The search looks no higher: a limit above it would switch the alarm off."""


class MotorFileError(ValueError):
    """A motor's table is not usable: which file, which field, what was expected, what was found."""

    def __init__(self, source: Path | str, field: str, *, expected: str, found: str) -> None:
        self.source = str(source)
        self.field = field
        self.expected = expected
        self.found = found
        super().__init__(f"{self.source}: {field}: expected {expected}, found {found}")


def read_motor(path: Path | str) -> Motor:
    """Read MOTOR.toml; the motor is named after the file.

    Raises MotorFileError for a missing or unreadable file, a missing or impossible value, an unknown key.
    """
    path = Path(path)
    try:
        table = tomllib.loads(path.read_text("utf-8"))
    except OSError as error:
        raise MotorFileError(
            path, "file", expected="a readable TOML file", found=f"none ({error.strerror})"
        ) from error
    except (UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise MotorFileError(
            path, "file", expected="valid TOML in UTF-8", found=f"an error: {error}"
        ) from error
    return motor_from_table(table, name=path.stem, source=path)


def motor_from_table(table: Mapping[str, object], *, name: str, source: Path | str) -> Motor:
    """A motor from the tables [nameplate], [parameters] and optionally [channels], [limits]."""
    unknown = sorted(set(table) - set(TABLES))
    if unknown:
        raise MotorFileError(
            source,
            unknown[0],
            expected=f"one of the tables {', '.join(f'[{table}]' for table in TABLES)} (docs/motor-file.md)",
            found="an unknown key",
        )
    nameplate = _Table(table, "nameplate", source)
    machine = _Table(table, "parameters", source)
    limits = _Table(table, "limits", source, optional=True)
    channels = _Table(table, "channels", source, optional=True)
    motor = Motor(
        name=name,
        nameplate=Nameplate(
            rated_power_W=nameplate.positive("rated_power_W"),
            rated_voltage_V=nameplate.positive("rated_voltage_V"),
            rated_frequency_Hz=nameplate.positive("rated_frequency_Hz"),
            pole_pairs=nameplate.count("pole_pairs"),
            connection=nameplate.connection("connection"),
        ),
        parameters=MachineParameters(
            stator_resistance_ohm=machine.positive("stator_resistance_ohm"),
            rotor_resistance_ohm=machine.positive("rotor_resistance_ohm"),
            stator_leakage_H=machine.positive("stator_leakage_H"),
            rotor_leakage_H=machine.positive("rotor_leakage_H"),
            stator_self_inductance_H=machine.positive("stator_self_inductance_H"),
            inertia_kgm2=machine.positive("inertia_kgm2"),
        ),
        channels=ChannelNames(
            currents=channels.names("ia", "ib", "ic"),
            phase_voltages=channels.names("va", "vb", "vc"),
            line_voltages=channels.names("vab", "vbc", "vca"),
        ),
        limits=Limits(
            fault_level=limits.positive("fault_level", default=Limits().fault_level, most=HIGHEST_FAULT_LIMIT)
        ),
    )
    for section in (nameplate, machine, limits, channels):
        section.reject_unknown()
    return motor


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

    def positive(self, key: str, *, default: float | None = None, most: float = inf) -> float:
        value = self._take(key, default)
        if isinstance(value, bool) or not isinstance(value, int | float) or not isfinite(value) or value <= 0:
            raise self._error(key, "a number above zero", value)
        if value > most:
            raise self._error(key, f"a fraction of at most {most:g} (0.005 means 0.5 %)", value)
        return float(value)

    def count(self, key: str) -> int:
        value = self._take(key, None)
        if isinstance(value, bool) or not isinstance(value, int) or value < 1:
            raise self._error(key, "a whole number of at least 1", value)
        return value

    def connection(self, key: str) -> Connection:
        value = self._take(key, Connection.STAR.value)
        try:
            return Connection(str(value))
        except ValueError:
            raise self._error(key, '"star" or "delta"', value) from None

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
        shown = "nothing" if found is None else repr(found)
        return MotorFileError(self._source, f"[{self._name}] {key}", expected=expected, found=shown)
