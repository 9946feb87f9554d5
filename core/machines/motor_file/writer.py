"""Writer of MOTOR.toml, with the 95 % intervals of what was estimated and remarks on what was not."""

import json
import tomllib
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path

from core.error_words import one_line
from core.machines.motor_file.deep_bars import change_lines
from core.machines.motor_file.error import MotorFileError
from core.machines.motor_file.feeder import feeder_lines
from core.machines.motor_file.reader import motor_from_table
from core.machines.motor_file.winding import winding_lines
from core.machines.parameters import (
    ChannelNames,
    CurrentPosition,
    Limits,
    MachineKind,
    Motor,
    ParametersSource,
    Transformers,
    WoundRotor,
)
from core.machines.sensors import SensorClass
from core.table_layout import TableScaling

Interval = tuple[float, float]


def write_motor(
    path: Path,
    motor: Motor,
    *,
    intervals: Mapping[str, Interval] | None = None,
    remarks: Mapping[str, str] | None = None,
    heading: str = "",
) -> Path:
    """Write a motor's file; it appears complete.

    Parameters
    ----------
    path : pathlib.Path
        Path of the file.
    motor : Motor
        Nameplate, parameters, channel names and limits of the motor.
    intervals : mapping of str to tuple of float or None, optional
        Lower and upper end of parameters, by name, for the table [intervals].
    remarks : mapping of str to str or None, optional
        Comments behind parameters, by name.
    heading : str, default ''
        Lines of comment at the top.

    Returns
    -------
    pathlib.Path
        The path written.

    Raises
    ------
    MotorFileError
        If the file cannot be written, or could not be read again: a figure is not plausible.
    """
    text = motor_text(motor, intervals=intervals or {}, remarks=remarks or {}, heading=heading)
    motor_from_table(tomllib.loads(text), name=motor.name, source=path)
    partial = path.with_name(path.name + ".part")
    try:
        partial.write_text(text, encoding="utf-8")
        return partial.replace(path)
    except OSError as error:
        raise MotorFileError(
            path, "file", expected="a file that can be written", found=error.strerror or str(error)
        ) from error


def motor_text(
    motor: Motor, *, intervals: Mapping[str, Interval], remarks: Mapping[str, str], heading: str
) -> str:
    """Return the text of a motor's file.

    Parameters
    ----------
    motor : Motor
        Nameplate, parameters, channel names and limits of the motor.
    intervals : mapping of str to tuple of float
        Lower and upper end of parameters, by name, for the table [intervals].
    remarks : mapping of str to str
        Comments behind parameters, by name.
    heading : str
        Lines of comment at the top.

    Returns
    -------
    str
        The text.
    """
    plate = motor.nameplate
    lines = [_comment(line) for line in heading.splitlines()]
    lines += ["neutral = true", ""] if motor.neutral else []
    lines += [
        "[nameplate]",
        f"rated_power_W = {_number(plate.rated_power_W)}",
        f"rated_voltage_V = {_number(plate.rated_voltage_V)}",
        f"rated_frequency_Hz = {_number(plate.rated_frequency_Hz)}",
        f"pole_pairs = {plate.pole_pairs}",
        f"connection = {_text(plate.connection.value)}",
        *([] if plate.rotor_bars is None else [f"rotor_bars = {plate.rotor_bars}"]),
        *([] if plate.rated_speed_rpm is None else [f"rated_speed_rpm = {_number(plate.rated_speed_rpm)}"]),
        *_wound_rotor(motor.wound_rotor),
        "",
        "[parameters]",
    ]
    if motor.parameters_source is not ParametersSource.GIVEN:
        lines.append(f"source = {_text(motor.parameters_source.value)}")
    for name, value in asdict(motor.parameters).items():
        remark = f"  {_comment(remarks[name])}" if name in remarks else ""
        lines.append(f"{name} = {_number(value)}{remark}")
    if intervals:
        lines += ["", "[intervals]  # 95 %, [low, high]"]
        lines += [f"{name} = [{_number(low)}, {_number(high)}]" for name, (low, high) in intervals.items()]
    lines += _rotor_circuit(motor.wound_rotor)
    lines += _channels(motor.channels)
    lines += _limits(motor)
    if motor.sensors != SensorClass():
        lines += ["", "[sensors]"]
        lines += [f"{name} = {_number(span)}" for name, span in asdict(motor.sensors).items()]
    lines += _transformers(motor.transformers)
    if motor.thermal is not None:
        settings = {name: value for name, value in asdict(motor.thermal).items() if value is not None}
        lines += ["", "[thermal]", *(f"{name} = {_number(value)}" for name, value in settings.items())]
    lines += winding_lines(motor.winding)
    lines += change_lines(motor.deep_bars, motor.leakage_saturation)
    lines += _tables(motor.tables)
    lines += feeder_lines(motor)
    return "\n".join(lines) + "\n"


def _wound_rotor(rotor: WoundRotor | None) -> list[str]:
    if rotor is None:
        return []
    return [
        f"kind = {_text(MachineKind.WOUND_ROTOR.value)}",
        f"rotor_voltage_V = {_number(rotor.open_circuit_voltage_V)}",
        f"rotor_current_A = {_number(rotor.rated_current_A)}",
    ]


def _rotor_circuit(rotor: WoundRotor | None) -> list[str]:
    if rotor is None or rotor.external_resistance_ohm == (0.0, 0.0):
        return []
    low, high = rotor.external_resistance_ohm
    value = _number(low) if low == high else f"[{_number(low)}, {_number(high)}]"
    return ["", "[rotor_circuit]", f"external_resistance_ohm = {value}"]


def _limits(motor: Motor) -> list[str]:
    lines = []
    if motor.limits != Limits():
        lines.append(f"fault_level = {_number(motor.limits.fault_level)}")
    known = {name: value for name, value in asdict(motor.start_limits).items() if value is not None}
    lines += [f"{name} = {_number(value)}" for name, value in known.items()]
    return ["", "[limits]", *lines] if lines else []


def _tables(scaling: TableScaling) -> list[str]:
    rate_hz = (
        [] if scaling.sample_rate_hz is None else [f"sample_rate_Hz = {_number(scaling.sample_rate_hz)}"]
    )
    numbers = {
        key: value
        for key in ("current_scale", "voltage_scale")
        if (value := getattr(scaling, key)) is not None
    }
    numbers |= {
        key: value for key in ("current_offset", "voltage_offset") if any(value := getattr(scaling, key))
    }
    lines = [f"{key} = [{', '.join(map(_number, value))}]" for key, value in numbers.items()]
    return ["", "[tables]", *rate_hz, *lines] if rate_hz or lines else []


def _transformers(transformers: Transformers) -> list[str]:
    ratios = {"voltage_ratio": transformers.voltage_ratio, "current_ratio": transformers.current_ratio}
    lines = [f"{name} = {_number(ratio)}" for name, ratio in ratios.items() if ratio is not None]
    if transformers.current_position is not CurrentPosition.LINE:
        lines.append(f"current_position = {_text(transformers.current_position)}")
    return ["", "[transformers]", *lines] if lines else []


def _channels(channels: ChannelNames) -> list[str]:
    sets = (
        (("ia", "ib", "ic"), channels.currents),
        (("va", "vb", "vc"), channels.phase_voltages),
        (("vab", "vbc", "vca"), channels.line_voltages),
    )
    lines = [
        f"{key} = {_text(name)}"
        for keys, names in sets
        if names
        for key, name in zip(keys, names, strict=True)
    ]
    return ["", "[channels]", *lines] if lines else []


def _number(value: float) -> str:
    return f"{value:.7g}"


def _text(text: str) -> str:
    """Return a basic string: JSON's escapes are TOML's, but for the character JSON leaves as it is."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _comment(text: str) -> str:
    return f"# {one_line(text)}".rstrip()
