"""`mcc parameters`: writes a motor's file from its data sheet, without recordings and without a service."""

import sys
import tomllib
from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields, replace
from math import sqrt
from pathlib import Path
from shutil import copy2

from rich.text import Text

from core.commissioning.catalogue import Compared, circuit_from_catalogue, figures_of
from core.commissioning.catalogue_data import FIGURES, CatalogueData, check_figures
from core.commissioning.circuit_doubts import circuit_doubts
from core.commissioning.data_sheet import (
    COPPER_C,
    check_inertia,
    intervals_of_data_sheet,
    ohm_per_unit,
    positive,
    warmed,
    winding_parameters,
    winding_resistance_ohm,
)
from core.commissioning.data_sheet_forms import Impedances, Reading, Unit, Values
from core.commissioning.errors import CommissioningError
from core.machines.motor_file.error import MotorFileError
from core.machines.motor_file.reader import motor_from_table, read_plate
from core.machines.motor_file.writer import motor_text, write_motor
from core.machines.parameters import MachineParameters, Motor, Nameplate, ParametersSource, WoundRotor
from core.quantity_text import plain
from service.cli.output import WRONG_USE, failing_clearly, print_document, print_warning, results
from service.cli.plant.windings import WinderSheet, winding_lines, winding_of_sheet
from service.cli.recordings.commission import check_output
from service.client.tables import FittedTable

Interval = tuple[float, float]

UNITS: Mapping[str, tuple[float, str]] = {
    "efficiency": (100.0, "%"),
    "power_factor": (1.0, ""),
    "rated_current_A": (1.0, "A"),
    "rated_speed_rpm": (1.0, "rpm"),
    "locked_rotor_current": (1.0, "times"),
    "locked_rotor_torque": (1.0, "times"),
    "breakdown_torque": (1.0, "times"),
    "stator_resistance_ohm": (1.0, "ohm"),
}
"""Unit in which a figure of a catalogue is shown, with the factor to it."""

NOTHING_COMPARED: tuple[Compared, ...] = ()

FAR = 2.5
FAR_OF_IMPEDANCES = 4.0
"""Standard deviations beyond which a figure is doubted; impedances are rounded, and cold or warm."""


@dataclass(frozen=True, slots=True)
class DataSheet:
    """What a data sheet says, as the command line has it; None where it says nothing."""

    r1: float | None
    r2: float | None
    x1: float | None
    x2: float | None
    xm: float | None
    unit: Unit
    values: Values | None
    base_VA: float | None
    terminal_resistance_ohm: float | None
    temperature_C: float | None
    efficiency: float | None
    power_factor: float | None
    rated_current_A: float | None
    rated_speed_rpm: float | None
    locked_rotor_current: float | None
    locked_rotor_torque: float | None
    breakdown_torque: float | None
    inertia_kgm2: float | None
    winding: WinderSheet

    @property
    def tells_winding_alone(self) -> bool:
        """Whether it says how the stator is wound, and has no figure from which parameters follow."""
        settings = ("unit", "values", "winding")
        return not self.winding.is_empty and all(
            getattr(self, one.name) is None for one in fields(self) if one.name not in settings
        )

    @property
    def has_impedances(self) -> bool:
        """Whether it gives a reactance or the rotor's resistance; or the stator's, and no catalogue's figure.

        The rated current may be there for the base of per unit alone.
        """
        figures = (
            self.efficiency,
            self.power_factor,
            self.rated_speed_rpm,
            self.locked_rotor_current,
            self.locked_rotor_torque,
            self.breakdown_torque,
        )
        stator = (self.r1, self.terminal_resistance_ohm)
        return any(one is not None for one in (self.r2, self.x1, self.x2, self.xm)) or (
            all(one is None for one in figures) and any(one is not None for one in stator)
        )


def parameters_of_data_sheet(
    sheet: DataSheet, nameplate: Path, output: Path | None, *, as_json: bool
) -> None:
    """Turn a data sheet into parameters; write the motor's file or print it, and print what was found.

    A sheet that tells the winding alone leaves the parameters as they are.

    Raises CommandError, and writes nothing, where something is missing or impossible, or a file cannot be
    used or written.
    """
    if output is not None:
        check_output(output, nameplate, ())
    with failing_clearly(CommissioningError, exit_code=WRONG_USE), failing_clearly(MotorFileError, OSError):
        plate = read_plate(nameplate)
        motor = replace(plate.motor, winding=winding_of_sheet(sheet.winding, plate))
        intervals, compared, warnings = plate.intervals, NOTHING_COMPARED, []
        if sheet.tells_winding_alone:
            heading = "Stator winding by `mcc parameters`; the parameters are as they were"
        else:
            parameters, intervals, compared = _found(sheet, plate.nameplate, plate.wound_rotor)
            motor = replace(motor, parameters=parameters, parameters_source=ParametersSource.DATA_SHEET)
            warnings = _warnings(compared, from_impedances=sheet.has_impedances)
            if not sheet.has_impedances:
                warnings += circuit_doubts(parameters, compared, plate.nameplate)
            heading = _heading(compared, warnings, from_impedances=sheet.has_impedances)
        text = motor_text(motor, intervals=intervals, remarks={}, heading=heading)
        motor_from_table(tomllib.loads(text), name=motor.name, source=output or nameplate)
        backup = None if output is None else _kept(output, nameplate)
        if output is not None:
            write_motor(output, motor, intervals=intervals, heading=heading)
    if as_json:
        print_document(_document(motor, intervals, compared, warnings, output=output, backup=backup))
    elif output is None:
        sys.stdout.write(text)
        for warning in warnings:
            print_warning(warning)
    else:
        results().print(_table(output, motor.parameters, intervals, compared))
        results().print(Text(winding_lines(motor)))
        for warning in warnings:
            results().print(Text(f"WARNING: {warning}"))
        if backup is not None:
            results().print(Text(f"{output} as it was: {backup}"), soft_wrap=True)


def _kept(output: Path, nameplate: Path) -> Path | None:
    """Keep a file that is there beside it, and return its name; None where there is none.

    Raises CommandError, and keeps all as it is, where that would replace the file of the nameplate.
    """
    if not output.exists():
        return None
    backup = output.with_name(f"{output.name}.bak")
    check_output(backup, nameplate, ())
    copy2(output, backup)
    return backup


def _found(
    sheet: DataSheet, nameplate: Nameplate, wound_rotor: WoundRotor | None
) -> tuple[MachineParameters, dict[str, Interval], tuple[Compared, ...]]:
    """Return parameters, intervals, and the catalogue's figures beside the circuit's."""
    if sheet.inertia_kgm2 is not None:
        check_inertia(sheet.inertia_kgm2, nameplate)
    data = CatalogueData(
        efficiency=sheet.efficiency,
        power_factor=sheet.power_factor,
        rated_current_A=sheet.rated_current_A,
        rated_speed_rpm=sheet.rated_speed_rpm,
        locked_rotor_current=sheet.locked_rotor_current,
        locked_rotor_torque=sheet.locked_rotor_torque,
        breakdown_torque=sheet.breakdown_torque,
    )
    check_figures(data, nameplate, fewest=0)
    reading = Reading(sheet.unit, sheet.values, _base_VA(sheet, nameplate), sheet.temperature_C)
    if not sheet.has_impedances:
        resistance = _winding_resistance(sheet, nameplate, reading)
        data = replace(data, stator_resistance_ohm=resistance)
        found = circuit_from_catalogue(data, nameplate, wound_rotor, inertia_kgm2=sheet.inertia_kgm2)
        return found.parameters, found.intervals, found.compared
    impedances = _impedances(sheet, nameplate, reading)
    machine = winding_parameters(impedances, nameplate, reading, inertia_kgm2=sheet.inertia_kgm2)
    known = sheet.inertia_kgm2 is not None
    intervals = intervals_of_data_sheet(machine, inertia_is_known=known, nameplate=nameplate)
    return machine, intervals, figures_of(machine, data, nameplate, wound_rotor)


def _base_VA(sheet: DataSheet, nameplate: Nameplate) -> float | None:
    if sheet.base_VA is not None or sheet.rated_current_A is None:
        return sheet.base_VA
    return sqrt(3.0) * nameplate.rated_voltage_V * sheet.rated_current_A


def _winding_resistance(sheet: DataSheet, nameplate: Nameplate, reading: Reading) -> float | None:
    """Return the stator's resistance of a winding at work, where the data sheet has one."""
    _check_resistance(sheet)
    warm = warmed(COPPER_C, sheet.temperature_C)
    if sheet.terminal_resistance_ohm is not None:
        return winding_resistance_ohm(sheet.terminal_resistance_ohm, nameplate.connection) * warm
    return None if sheet.r1 is None else sheet.r1 * ohm_per_unit(nameplate, reading) * warm


def _impedances(sheet: DataSheet, nameplate: Nameplate, reading: Reading) -> Impedances:
    """Return the impedances; the stator's resistance between terminals is put into the unit of the others."""
    _check_resistance(sheet)
    r1 = sheet.r1
    if sheet.terminal_resistance_ohm is not None:
        winding = winding_resistance_ohm(sheet.terminal_resistance_ohm, nameplate.connection)
        r1 = winding / ohm_per_unit(nameplate, reading)
    x2 = sheet.x1 if sheet.x2 is None else sheet.x2
    given = {"r1": r1, "r2": sheet.r2, "x1": sheet.x1, "xm": sheet.xm}
    missing = [f"--{name}" for name, value in given.items() if value is None]
    if missing or r1 is None or sheet.r2 is None or sheet.x1 is None or x2 is None or sheet.xm is None:
        raise CommissioningError(
            "data sheet",
            "impedances",
            expected="--r1 (or --terminal-resistance), --r2, --x1 and --xm; or figures of a catalogue alone",
            found=f"no {', '.join(missing)}",
        )
    return Impedances(r1, sheet.r2, sheet.x1, x2, sheet.xm)


def _check_resistance(sheet: DataSheet) -> None:
    """Raise CommissioningError where the stator's resistance is given twice, or is none."""
    if sheet.r1 is not None and sheet.terminal_resistance_ohm is not None:
        raise CommissioningError(
            "data sheet", "stator resistance", expected="--r1 or --terminal-resistance", found="both"
        )
    for name, value in (("--r1", sheet.r1), ("--terminal-resistance", sheet.terminal_resistance_ohm)):
        if value is not None:
            positive(name, value)


def _warnings(compared: tuple[Compared, ...], *, from_impedances: bool) -> list[str]:
    """Return which figures are far from the circuit's."""
    far = FAR_OF_IMPEDANCES if from_impedances else FAR
    return [
        f"{FIGURES[one.name]}: the data sheet says {_figure(one, one.given)}, its circuit "
        f"{_figure(one, one.computed)}: check nameplate, unit, base and which values these are"
        for one in compared
        if one.deviations is not None and abs(one.deviations) > far
    ]


def _figure(one: Compared, value: float | None) -> str:
    if value is None:
        return "-"
    factor, unit = UNITS[one.name]
    return f"{plain(value * factor, 4)} {unit}".strip()


def _heading(compared: tuple[Compared, ...], warnings: list[str], *, from_impedances: bool) -> str:
    source = "impedances of the data sheet" if from_impedances else "figures of a catalogue (least squares)"
    lines = [f"By `mcc parameters` from {source}; commission the motor when a start is recorded"]
    lines += [
        f"{FIGURES[one.name]}: {_figure(one, one.computed)} by this circuit"
        + ("" if one.given is None else f", {_figure(one, one.given)} given")
        for one in compared
    ]
    return "\n".join(lines + [f"WARNING: {warning}" for warning in warnings])


def _document(
    motor: Motor,
    intervals: Mapping[str, Interval],
    compared: tuple[Compared, ...],
    warnings: list[str],
    *,
    output: Path | None,
    backup: Path | None,
) -> dict[str, object]:
    return {
        "parameters": {
            name: {"value": value, "ci95": list(intervals[name]) if name in intervals else None}
            for name, value in asdict(motor.parameters).items()
        },
        "winding": None if motor.winding is None else asdict(motor.winding),
        "magnetising_inductance_H": motor.parameters.magnetising_inductance_H,
        "parameters_source": str(motor.parameters_source),
        "figures": [asdict(one) for one in compared],
        "warnings": warnings,
        "output": None if output is None else str(output),
        "backup": None if backup is None else str(backup),
    }


def _table(
    output: Path,
    parameters: MachineParameters,
    intervals: Mapping[str, Interval],
    compared: tuple[Compared, ...],
) -> FittedTable:
    table = FittedTable(title=Text(f"written: {output.name}"), title_justify="left")
    for heading in ("quantity", "value", "interval, or given", "off by"):
        table.add_column(heading)
    for name, value in asdict(parameters).items():
        ends = " .. ".join(plain(end, 4) for end in intervals.get(name, ()))
        table.add_row(name, plain(value, 5), ends, "")
    table.add_section()
    for one in compared:
        off = "" if one.deviations is None else f"{one.deviations:+.1f} sd"
        table.add_row(FIGURES[one.name], _figure(one, one.computed), _figure(one, one.given), off)
    return table
