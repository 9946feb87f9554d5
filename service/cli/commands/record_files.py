"""Commands that need recordings and a motor's file, and no service."""

from enum import StrEnum
from math import isfinite
from pathlib import Path
from typing import Annotated

import typer

from core.diagnosis.methods import DEFAULT_METHOD, DEFAULT_MODEL, Method, Model
from service.cli.commands.options import (
    DEFAULT_URL,
    CurrentOffset,
    CurrentScale,
    Json,
    TableColumn,
    TableRate,
    Url,
    VoltageOffset,
    VoltageScale,
)
from service.process.garbage_collection import collection_paused

commands = typer.Typer()


class Load(StrEnum):
    """How the load torque grows with speed."""

    AUTO = "auto"
    CONSTANT = "constant"
    LINEAR = "linear"
    QUADRATIC = "quadratic"


@commands.command()
def diagnose(
    record: Annotated[
        Path,
        typer.Argument(
            metavar="RECORD",
            help="COMTRADE (.CFG beside its .DAT, or .CFF), an SEL event report (.CEV), or a table of "
            "samples (.csv, .parquet, .mat, .h5, .tdms, .npy, .npz).",
        ),
    ],
    motor: Annotated[
        Path | None,
        typer.Option(
            metavar="MOTOR.toml", help="The motor (default: RECORD's name with .toml, or motor.toml)."
        ),
    ] = None,
    method: Method = DEFAULT_METHOD,
    model: Model = DEFAULT_MODEL,
    baseline: Annotated[
        list[Path] | None,
        typer.Option(
            metavar="RECORD",
            help="A recording of the same motor and relay known to be healthy; at least three, each with "
            "--baseline. What they show standing is taken off.",
        ),
    ] = None,
    column: TableColumn = None,
    rate: TableRate = None,
    current_scale: CurrentScale = None,
    current_offset: CurrentOffset = None,
    voltage_scale: VoltageScale = None,
    voltage_offset: VoltageOffset = None,
    *,
    currents_only: Annotated[
        bool,
        typer.Option(
            "--currents-only",
            help="Accept a recording without voltages; the verdict is at best a hint (watch).",
        ),
    ] = False,
    lenient: Annotated[
        bool,
        typer.Option("--lenient", help="Mend what can be mended in a faulty file, and say what was."),
    ] = False,
    report: Annotated[
        int | None,
        typer.Option(
            "--report", metavar="N", min=1, help="Which event report of a capture with several (default: 1)."
        ),
    ] = None,
    as_json: Json = False,
) -> None:
    """Tell from one recording whether a motor has shorted stator turns."""
    with collection_paused():
        from service.cli.recordings.diagnose import diagnose_recording
        from service.cli.recordings.given_columns import GivenColumns

        diagnose_recording(
            record,
            motor,
            method=method.value,
            model=model.value,
            baseline=baseline or [],
            currents_only=currents_only,
            lenient=lenient,
            report=report,
            as_json=as_json,
            given=GivenColumns(
                column or [], rate, current_scale, current_offset, voltage_scale, voltage_offset
            ),
        )


@commands.command()
def rotor(
    record: Annotated[
        Path,
        typer.Argument(
            metavar="RECORD",
            help="The current: a table of samples (.csv, .txt, .parquet, .mat, .h5, .tdms, .npy, .npz), "
            "COMTRADE, or an SEL event report.",
        ),
    ],
    speed_rpm: Annotated[
        float, typer.Option("--speed-rpm", metavar="RPM", min=1.0, help="Speed of the motor.")
    ],
    healthy: Annotated[
        Path | None,
        typer.Option(
            metavar="RECORD",
            help="A record of the same motor at this speed, known to be healthy, to compare with.",
        ),
    ] = None,
    column: Annotated[
        str | None,
        typer.Option(metavar="NAME", help="The current among several columns: its name, or 1, 2, 3 ..."),
    ] = None,
    rate: Annotated[
        float | None,
        typer.Option(
            metavar="HZ", min=1.0, help="Sampling rate (default: by the file's first column of times)."
        ),
    ] = None,
    frequency: Annotated[float, typer.Option(metavar="HZ", min=1.0, help="Rated frequency.")] = 50.0,
    pole_pairs: Annotated[
        int | None,
        typer.Option(metavar="NUMBER", min=1, help="Pole pairs (default: as many as the speed allows)."),
    ] = None,
    *,
    as_json: Json = False,
) -> None:
    """Look for broken rotor bars in the current of one phase, where nothing else was recorded.

    With all three currents and the voltages, and a motor file, mcc diagnose tells far more.
    """
    from service.cli.recordings.rotor import Source, examine_current

    examine_current(
        record,
        speed_rpm,
        Source(column, rate),
        frequency_hz=frequency,
        pole_pairs=pole_pairs,
        healthy=healthy,
        as_json=as_json,
    )


@commands.command()
def speed(
    records: Annotated[
        list[Path],
        typer.Argument(metavar="RECORD...", help="Recordings of one motor, in any order."),
    ],
    motor: Annotated[Path, typer.Option(metavar="MOTOR.toml", help="The motor.")],
    lines: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="Where number of bars and lines are kept that the recordings teach: read first where it is "
            "there, written at the end.",
        ),
    ] = None,
    *,
    lenient: Annotated[
        bool, typer.Option("--lenient", help="Mend what can be mended in faulty files.")
    ] = False,
    as_json: Json = False,
) -> None:
    """See the speed of a motor in its line currents, by the lines of its rotor's slots."""
    with collection_paused():
        from service.cli.recordings.speed import tell_speeds

        tell_speeds(records, motor, lines, lenient=lenient, as_json=as_json)


@commands.command()
def follow(
    records: Annotated[
        list[str],
        typer.Argument(
            metavar="RECORD...",
            help="Recordings of one motor in any order: files, folders (with all below), or patterns.",
        ),
    ],
    motor: Annotated[Path, typer.Option(metavar="MOTOR.toml", help="The motor.")],
    neighbour: Annotated[
        list[str] | None,
        typer.Option(
            metavar="MOTOR.toml=RECORDS",
            help="Another motor of the same bus, with its recordings: voltage channels are judged against "
            "each other. May be given repeatedly.",
        ),
    ] = None,
    event: Annotated[
        list[str] | None,
        typer.Option(
            metavar="TIME=KIND[:REASON]",
            help="What happened to the motor, such as 2026-01-31T12:00:00Z=rewound; may be given repeatedly.",
        ),
    ] = None,
    events: Annotated[
        Path | None, typer.Option(metavar="FILE", help=r"A file of events (TOML, tables [\[event]]).")
    ] = None,
    stale_after: Annotated[
        float,
        typer.Option(
            metavar="DAYS", min=0, help="The condition is stale after so long without a valid record."
        ),
    ] = 7.0,
    column: TableColumn = None,
    rate: TableRate = None,
    current_scale: CurrentScale = None,
    current_offset: CurrentOffset = None,
    voltage_scale: VoltageScale = None,
    voltage_offset: VoltageOffset = None,
    *,
    lenient: Annotated[
        bool, typer.Option("--lenient", help="Mend what can be mended in faulty files.")
    ] = False,
    as_json: Json = False,
) -> None:
    """Tell a motor's condition from its recordings over time: what has changed, since when, how it grows."""
    if not isfinite(stale_after):
        raise typer.BadParameter(f"--stale-after: expected a number of days, found {stale_after}")
    with collection_paused():
        from service.cli.conditions.follow import follow_records
        from service.cli.recordings.given_columns import GivenColumns

    follow_records(
        records,
        motor,
        neighbours=neighbour or [],
        events=event or [],
        events_file=events,
        stale_after_days=stale_after,
        lenient=lenient,
        as_json=as_json,
        given=GivenColumns(column or [], rate, current_scale, current_offset, voltage_scale, voltage_offset),
    )


@commands.command()
def commission(
    records: Annotated[
        list[Path] | None,
        typer.Argument(metavar="RECORD...", help="Recordings of the motor's starts, each from before it on."),
    ] = None,
    nameplate: Annotated[
        Path | None,
        typer.Option(
            metavar="MOTOR.toml", help="The motor: its nameplate table, and parameters if any are known."
        ),
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option(metavar="MOTOR.toml", help="Where to write the motor with what was found."),
    ] = None,
    from_service: Annotated[
        str | None,
        typer.Option(metavar="MOTOR", help="Use the latest starts of this motor that a service recorded."),
    ] = None,
    recording: Annotated[
        list[str] | None,
        typer.Option(
            metavar="ID", help="With --from-service: this recording instead; may be given repeatedly."
        ),
    ] = None,
    write: Annotated[
        Path | None,
        typer.Option(
            metavar="MOTORS.toml",
            help="With --from-service: the plant's motors file. What was found is written into the motor's "
            "table; all else stays, and the file as it was is kept beside it (.bak).",
        ),
    ] = None,
    load: Annotated[
        Load, typer.Option(help="How the load torque grows with speed; auto: as fits best.")
    ] = Load.AUTO,
    url: Url = DEFAULT_URL,
    *,
    despite_warnings: Annotated[
        bool,
        typer.Option(
            "--despite-warnings",
            help="With --from-service: write parameters that are unusual for a motor of this rating, too.",
        ),
    ] = False,
    lenient: Annotated[
        bool, typer.Option("--lenient", help="Mend what can be mended in faulty files, and say what was.")
    ] = False,
    as_json: Json = False,
) -> None:
    """Estimate a motor's parameters, with intervals, from recordings of its start.

    Either from files (RECORD... --nameplate MOTOR.toml --output MOTOR.toml), or from what a running service
    has recorded (--from-service MOTOR --write MOTORS.toml).
    """
    if from_service is not None:
        if records or nameplate is not None or output is not None or lenient:
            raise typer.BadParameter("--from-service takes no RECORD, --nameplate, --output or --lenient")
        if write is None:
            raise typer.BadParameter("--from-service needs --write MOTORS.toml, the plant's motors file")
        from service.cli.recordings.commission_from_service import commission_from_service

        commission_from_service(
            url,
            from_service,
            write,
            recordings=recording or [],
            load=load.value,
            despite_warnings=despite_warnings,
            as_json=as_json,
        )
        return
    if write is not None or recording or despite_warnings:
        raise typer.BadParameter("--write, --recording and --despite-warnings go with --from-service MOTOR")
    if not records or nameplate is None or output is None:
        raise typer.BadParameter(
            "expected RECORD... --nameplate MOTOR.toml --output MOTOR.toml, or --from-service MOTOR --write "
            "MOTORS.toml"
        )
    from service.cli.recordings.commission import commission_motor

    commission_motor(records, nameplate, output, load=load.value, lenient=lenient, as_json=as_json)
