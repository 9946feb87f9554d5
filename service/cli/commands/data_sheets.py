"""The command that turns a motor's data sheet into parameters."""

from pathlib import Path
from typing import Annotated

import typer

from core.commissioning.data_sheet_forms import Unit, Values
from core.machines.stator_winding import WindingKind
from service.cli.commands.options import Json

commands = typer.Typer()

Figure = float | None


@commands.command()
def parameters(
    nameplate: Annotated[Path, typer.Option(metavar="MOTOR.toml", help="The motor: its nameplate table.")],
    output: Annotated[
        Path | None,
        typer.Option(
            metavar="MOTOR.toml", help="Where to write the motor with its parameters (default: on stdout)."
        ),
    ] = None,
    r1: Annotated[Figure, typer.Option("--r1", help="Resistance of the stator.")] = None,
    r2: Annotated[
        Figure, typer.Option("--r2", help="Resistance of the rotor, referred to the stator.")
    ] = None,
    x1: Annotated[Figure, typer.Option("--x1", help="Leakage reactance of the stator.")] = None,
    x2: Annotated[
        Figure, typer.Option("--x2", help="Leakage reactance of the rotor, referred (default: as --x1).")
    ] = None,
    xm: Annotated[Figure, typer.Option("--xm", help="Magnetising reactance.")] = None,
    unit: Annotated[Unit, typer.Option(help="Unit of these.")] = Unit.OHM,
    values: Annotated[
        Values | None,
        typer.Option(
            help="What ohms are those of: a phase of the equivalent star, a winding of the equivalent delta, "
            "or a winding as it is connected. Needed for a motor in delta."
        ),
    ] = None,
    base_va: Annotated[
        Figure,
        typer.Option("--base-VA", help="Apparent power that per unit is of (default: from --rated-current)."),
    ] = None,
    terminal_resistance: Annotated[
        Figure,
        typer.Option(metavar="OHM", help="Resistance measured between two line terminals, in place of --r1."),
    ] = None,
    temperature: Annotated[
        Figure,
        typer.Option(
            metavar="C", help="Temperature of the resistances, where they are cold ones, such as 20."
        ),
    ] = None,
    efficiency: Annotated[Figure, typer.Option(metavar="PERCENT", help="At rated load.")] = None,
    power_factor: Annotated[Figure, typer.Option(metavar="COSPHI", help="At rated load.")] = None,
    rated_current: Annotated[Figure, typer.Option(metavar="A", help="Of a line, rms.")] = None,
    rated_speed: Annotated[Figure, typer.Option(metavar="RPM", help="At rated load.")] = None,
    locked_rotor_current: Annotated[
        Figure, typer.Option(metavar="TIMES", help="Over the rated current (I_A/I_N, LRC).")
    ] = None,
    locked_rotor_torque: Annotated[
        Figure, typer.Option(metavar="TIMES", help="Over the rated torque (M_A/M_N, LRT).")
    ] = None,
    breakdown_torque: Annotated[
        Figure, typer.Option(metavar="TIMES", help="Over the rated torque (M_K/M_N, BDT).")
    ] = None,
    inertia: Annotated[
        Figure, typer.Option(metavar="KGM2", help="Of motor and load (default: typical of the rating).")
    ] = None,
    winding: Annotated[
        WindingKind | None,
        typer.Option(help="How the coils of the stator lie, from a winder's sheet. Needs --slots."),
    ] = None,
    slots: Annotated[int | None, typer.Option(metavar="NUMBER", help="Slots of the stator.")] = None,
    layers: Annotated[
        int | None,
        typer.Option(min=1, max=2, metavar="NUMBER", help="Coil sides in a slot, 1 or 2 (default: 2)."),
    ] = None,
    coil_pitch: Annotated[
        int | None,
        typer.Option(
            metavar="SLOTS", help="From side to side of a coil: 8 for a span of 1 to 9 (default: unknown)."
        ),
    ] = None,
    *,
    as_json: Json = False,
) -> None:
    """Turn a data sheet's impedances or a catalogue's figures into a motor's parameters, with intervals.

    A stator winding (--winding, --slots) may be given beside them, or alone: the parameters then stay.
    """
    from service.cli.plant.parameters import DataSheet, parameters_of_data_sheet
    from service.cli.plant.windings import WinderSheet

    sheet = DataSheet(
        r1=r1,
        r2=r2,
        x1=x1,
        x2=x2,
        xm=xm,
        unit=unit,
        values=values,
        base_VA=base_va,
        terminal_resistance_ohm=terminal_resistance,
        temperature_C=temperature,
        efficiency=None if efficiency is None else efficiency / 100.0,
        power_factor=power_factor,
        rated_current_A=rated_current,
        rated_speed_rpm=rated_speed,
        locked_rotor_current=locked_rotor_current,
        locked_rotor_torque=locked_rotor_torque,
        breakdown_torque=breakdown_torque,
        inertia_kgm2=inertia,
        winding=WinderSheet(winding, slots, layers, coil_pitch),
    )
    parameters_of_data_sheet(sheet, nameplate, output, as_json=as_json)
