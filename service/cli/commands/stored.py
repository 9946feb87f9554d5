"""Commands on what a running service has kept: trends, recordings, their diagnoses and baselines."""

from pathlib import Path
from typing import Annotated, Literal

import typer

from core.diagnosis.methods import DEFAULT_METHOD, DEFAULT_MODEL, Method, Model
from core.operation import Operation
from core.quantities import TrendedName
from service.cli.commands.options import (
    DEFAULT_URL,
    Config,
    Csv,
    DefaultGroup,
    From,
    Json,
    To,
    Url,
    VerdictWait,
    finite_seconds,
)

commands = typer.Typer()

MotorName = Annotated[str, typer.Argument(metavar="MOTOR", help="The motor's name.")]
OneMotor = Annotated[str | None, typer.Argument(metavar="[MOTOR]", help="Only this motor's.")]
RecordingIds = Annotated[
    list[str], typer.Argument(metavar="RECORDING...", help="Ids, as mcc recordings shows them.")
]
Limit = Annotated[int, typer.Option("--limit", min=1, max=100_000, help="Show so many, the latest.")]
Reason = Annotated[str | None, typer.Option(metavar="TEXT", help="Why; it is kept.")]
OnBehalfOf = Annotated[
    str | None, typer.Option(metavar="NAME", help="Whom you do it for; shown beside your account.")
]
DateOrder = Literal["MDY", "YMD", "DMY"]
PowerUnit = Literal["W", "kW"]
State = Literal["announced", "fetched", "diagnosed", "rejected", "failed"]


@commands.command()
def trend(
    motor: MotorName,
    url: Url = DEFAULT_URL,
    quantity: Annotated[
        TrendedName,
        typer.Option(
            help="condition_level, change and those that end with _change are what is said of the motor "
            "from a recording on; the others what each recording says by itself."
        ),
    ] = "mu_f",
    from_: From = None,
    to: To = None,
    limit: Limit = 100,
    *,
    as_csv: Csv = False,
    as_json: Json = False,
) -> None:
    """Show one figure for each recording of a motor, oldest first."""
    from service.cli.trend import show_trend

    show_trend(url, motor, quantity, first=from_, end=to, limit=limit, as_csv=as_csv, as_json=as_json)


@commands.command()
def starts(
    motor: MotorName,
    url: Url = DEFAULT_URL,
    limit: Limit = 20,
    *,
    as_csv: Csv = False,
    as_json: Json = False,
) -> None:
    """Show the starts of a motor, oldest first, and why they are other than the first ones."""
    from service.cli.recordings.starts import show_starts

    show_starts(url, motor, limit=limit, as_csv=as_csv, as_json=as_json)


@commands.command()
def import_report(
    motor: MotorName,
    file: Annotated[
        Path, typer.Argument(metavar="FILE", help="A report of its relay as text: MSR, LDP, MOT or SER.")
    ],
    url: Url = DEFAULT_URL,
    date_order: Annotated[
        DateOrder, typer.Option(help="Order of the report's dates: the relay's setting DATE_F.")
    ] = "MDY",
    power_unit: Annotated[
        PowerUnit | None,
        typer.Option(help="Unit of P and Q in a load profile; without it they are left out."),
    ] = None,
    *,
    as_json: Json = False,
) -> None:
    """Give the service a text report of a motor's relay: starts, load, statistics or events."""
    from service.cli.relay_report import import_report as bring

    bring(url, motor, file, date_order=date_order, power_unit=power_unit, as_json=as_json)


@commands.command("relay-events")
def relay_events(
    motor: MotorName,
    url: Url = DEFAULT_URL,
    limit: Limit = 20,
    *,
    as_csv: Csv = False,
    as_json: Json = False,
) -> None:
    """Show starts, stops and trips of a motor that its relay's reports told, oldest first."""
    from service.cli.relay_events import show_relay_events

    show_relay_events(url, motor, limit=limit, as_csv=as_csv, as_json=as_json)


@commands.command()
def load(
    motor: MotorName,
    url: Url = DEFAULT_URL,
    days: Annotated[int, typer.Option(min=1, max=90, help="Of so many days; up to 2 by minutes.")] = 30,
    *,
    as_json: Json = False,
) -> None:
    """Show how a motor was loaded: hours by torque, hours beyond limits, and how hot it is."""
    from service.cli.load import show_load

    show_load(url, motor, days=days, as_json=as_json)


@commands.command()
def losses(motor: MotorName, url: Url = DEFAULT_URL, *, as_json: Json = False) -> None:
    """Show what a motor loses: efficiency by load, and what faults and supply cost a year."""
    from service.cli.losses import show_losses

    show_losses(url, motor, as_json=as_json)


@commands.command()
def drift(
    motor: MotorName,
    url: Url = DEFAULT_URL,
    *,
    as_json: Json = False,
) -> None:
    """Show a motor's resistances and inductances while it runs, and what has changed them."""
    from service.cli.drift import show_drift

    show_drift(url, motor, as_json=as_json)


recordings = typer.Typer(cls=DefaultGroup, help="List recordings that the service has, or download one.")
commands.add_typer(recordings, name="recordings")


@recordings.command("list")
def list_recordings(
    motor: OneMotor = None,
    url: Url = DEFAULT_URL,
    state: Annotated[State | None, typer.Option(help="Only those in this state.")] = None,
    operation: Annotated[
        Operation | None, typer.Option(help="Only those in which the motor does this.")
    ] = None,
    limit: Limit = 100,
    *,
    as_csv: Csv = False,
    as_json: Json = False,
) -> None:
    """List recordings, latest first."""
    from service.cli.recordings.stored import show_recordings

    show_recordings(url, motor, state, operation, limit=limit, as_csv=as_csv, as_json=as_json)


@recordings.command()
def download(
    recording: Annotated[
        str, typer.Argument(metavar="RECORDING", help="The recording's id, as mcc recordings shows it.")
    ],
    url: Url = DEFAULT_URL,
    output: Annotated[
        Path | None,
        typer.Option(metavar="PATH", help="File or folder (default: MOTOR_TIME.zip in this folder)."),
    ] = None,
    *,
    as_json: Json = False,
) -> None:
    """Save the files of a recording in a ZIP archive, as they came from the relay."""
    from service.cli.recordings.stored import download_recording

    download_recording(url, recording, output, as_json=as_json)


@commands.command()
def upload(
    motor: MotorName,
    files: Annotated[
        list[Path],
        typer.Argument(
            metavar="FILE...", help="One recording: .CFG and .DAT, or .CFF, or .CEV, or a table of samples."
        ),
    ],
    url: Url = DEFAULT_URL,
    wait: VerdictWait = 0.0,
    *,
    as_json: Json = False,
) -> None:
    """Give the service a recording of a motor; it is diagnosed as if its relay had made it."""
    from service.cli.recordings.upload import upload_recording

    upload_recording(url, motor, files, wait_s=wait, as_json=as_json)


@commands.command()
def rediagnose(
    recordings: Annotated[
        list[str] | None,
        typer.Argument(metavar="[RECORDING...]", help="Ids, as mcc recordings shows them."),
    ] = None,
    url: Url = DEFAULT_URL,
    method: Method = DEFAULT_METHOD,
    model: Model = DEFAULT_MODEL,
    wait: Annotated[
        float,
        typer.Option(
            metavar="SECONDS", min=0, callback=finite_seconds, help="Wait this long for the diagnoses."
        ),
    ] = 60.0,
    *,
    batch: Annotated[
        bool,
        typer.Option(
            "--batch",
            help="All recordings, in workers of this command; reads the database, not the API.",
        ),
    ] = False,
    scheduler: Annotated[
        str | None,
        typer.Option(
            metavar="ADDRESS", help="With --batch: on the workers of this Dask scheduler, tls://HOST:8786."
        ),
    ] = None,
    config: Config = None,
    motor: Annotated[
        list[str] | None,
        typer.Option(metavar="MOTOR", help="With --batch: only this motor's; several times for several."),
    ] = None,
    processes: Annotated[
        int | None,
        typer.Option(min=1, max=256, help="With --batch: so many (default: workers of the settings)."),
    ] = None,
    made_before: Annotated[
        str | None,
        typer.Option(metavar="TIME", help="With --batch: also those made before this time or date."),
    ] = None,
    as_csv: Csv = False,
    as_json: Json = False,
) -> None:
    """Diagnose stored recordings again, with the motor's parameters and baseline of today."""
    if batch:
        from service.cli.recordings.batch import rediagnose_archive

        if recordings or as_csv:
            raise typer.BadParameter("--batch: expected neither recordings nor --csv; choose by --motor")
        rediagnose_archive(
            config,
            scheduler,
            motor or [],
            method.value,
            model.value,
            processes=processes,
            made_before=made_before,
            as_json=as_json,
        )
        return
    from service.cli.recordings.rediagnose import rediagnose_recordings

    if not recordings:
        raise typer.BadParameter("expected the ids of recordings, or --batch for all of them")
    if scheduler or motor or processes or made_before or config:
        raise typer.BadParameter(
            "--scheduler, --config, --motor, --processes and --made-before are for --batch"
        )
    rediagnose_recordings(
        url, recordings, method.value, model.value, wait_s=wait, as_csv=as_csv, as_json=as_json
    )


baseline = typer.Typer(
    cls=DefaultGroup, help="Show, choose or drop the healthy recordings that a motor is compared with."
)
commands.add_typer(baseline, name="baseline")


@baseline.command("show")
def show_baseline(
    motor: MotorName, url: Url = DEFAULT_URL, *, as_csv: Csv = False, as_json: Json = False
) -> None:
    """Show the recordings of a motor's baseline, oldest first."""
    from service.cli.recordings.baseline import show_baseline

    show_baseline(url, motor, as_csv=as_csv, as_json=as_json)


@baseline.command("set")
def set_baseline(
    motor: MotorName,
    recordings: RecordingIds,
    url: Url = DEFAULT_URL,
    reason: Reason = None,
    on_behalf_of: OnBehalfOf = None,
    *,
    as_json: Json = False,
) -> None:
    """Choose at least three recordings known to be healthy; those in doubt need a reason."""
    from service.cli.recordings.baseline import set_baseline

    set_baseline(url, motor, recordings, reason=reason, on_behalf_of=on_behalf_of, as_json=as_json)


@baseline.command("drop")
def drop_baseline(
    motor: MotorName,
    url: Url = DEFAULT_URL,
    reason: Reason = None,
    on_behalf_of: OnBehalfOf = None,
    *,
    as_json: Json = False,
) -> None:
    """Have a motor compared with no baseline any more; its recordings stay."""
    from service.cli.recordings.baseline import drop_baseline

    drop_baseline(url, motor, reason=reason, on_behalf_of=on_behalf_of, as_json=as_json)
