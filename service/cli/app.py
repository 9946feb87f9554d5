"""The commands of `mcc` and their options. Each imports its module when it runs, so that `--help` is fast."""

import sys
from collections.abc import Sequence
from enum import StrEnum
from importlib.metadata import version
from math import isfinite
from pathlib import Path
from typing import Annotated, Literal

import typer

from core.diagnosis.methods import DEFAULT_METHOD, DEFAULT_MODEL, Method, Model
from service.cli.output import DONE, FAILED, WRONG_USE, CommandError, one_line, print_failure
from service.process.garbage_collection import collection_paused

app = typer.Typer(
    name="mcc",
    help="Stator condition of every induction motor in a plant, from the relays it already has.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)

Json = Annotated[bool, typer.Option("--json", help="Print one JSON document on stdout, also on failure.")]
Url = Annotated[str, typer.Option("--url", envvar="MCC_URL", help="Address of the running service.")]
MotorName = Annotated[str, typer.Argument(metavar="MOTOR", help="The motor's name in the plant's SCD.")]

Time = Annotated[
    str | None,
    typer.Option(metavar="TIME", help="When it happened, as 2026-01-31T12:00:00Z (default: now)."),
]
NoteKind = Literal["note", "maintenance", "recorder-changed", "rewound", "reference-restarted"]
"""What a person may tell: all kinds of events but the one that only the motors file tells."""

By = Annotated[str | None, typer.Option(metavar="NAME", help="Who says so (default: who is logged in).")]

INTERRUPTED = 130
"""Typer ends with this exit code after Ctrl-C."""

DEFAULT_URL = "http://127.0.0.1:8710"


class Load(StrEnum):
    """How the load torque grows with speed."""

    AUTO = "auto"
    CONSTANT = "constant"
    LINEAR = "linear"
    QUADRATIC = "quadratic"


def _print_version(wanted: bool) -> None:
    if wanted:
        sys.stdout.write(f"mcc {version('statorwatch')}\n")
        raise typer.Exit


@app.callback()
def options(
    *,
    _version: Annotated[
        bool,
        typer.Option("--version", callback=_print_version, is_eager=True, help="Print the version and stop."),
    ] = False,
) -> None:
    """Read the options that come before a command."""


@app.command()
def demo(
    *,
    once: Annotated[
        bool, typer.Option("--once", help="Trigger every motor twice, print the diagnoses, stop; no month.")
    ] = False,
    json_file: Annotated[
        Path | None, typer.Option("--json", metavar="FILE", help="Write the results to FILE.")
    ] = None,
    data: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Keep the data here (default: a temporary folder).")
    ] = None,
    url: Annotated[
        str | None,
        typer.Option(help="Start nothing: play on the demo plant whose service answers here."),
    ] = None,
) -> None:
    """Run a simulated plant of two factories and the service that watches it: a month in five minutes.

    Afterwards the plant's time is the real one, until Ctrl-C.
    """
    from service.cli.demonstrate import demonstrate

    if url is not None and data is not None:
        raise typer.BadParameter("--data is for a plant this command starts: leave out --data or --url")
    demonstrate(once=once, json_file=json_file, data=data, url=url)


@app.command("demo-status")
def demo_status(url: Url = DEFAULT_URL, *, as_json: Json = False) -> None:
    """Show each motor's condition beside the truth at its latest record, where a demo plant runs."""
    from service.cli.demo_status import show_demo

    show_demo(url, as_json=as_json)


@app.command()
def serve(
    config: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Settings file (TOML); see docs/reference/settings.md."),
    ] = None,
) -> None:
    """Run the service: API, collectors and diagnosis workers. Ends on SIGTERM or Ctrl-C."""
    from service.cli.run_service import run_service

    run_service(config)


@app.command()
def collect(
    config: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Settings file (TOML); see docs/reference/settings.md."),
    ] = None,
) -> None:
    """Run gateways alone, which share the relays of a service on another host. Ends on SIGTERM or Ctrl-C."""
    from service.cli.run_service import run_gateways

    run_gateways(config)


@app.command()
def diagnose(
    record: Annotated[
        Path,
        typer.Argument(
            metavar="RECORD", help="COMTRADE (.CFG beside its .DAT, or .CFF) or an SEL event report (.CEV)."
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
    as_json: Json = False,
) -> None:
    """Tell from one recording whether a motor has shorted stator turns."""
    with collection_paused():
        from service.cli.diagnose import diagnose_recording

        diagnose_recording(
            record,
            motor,
            method=method.value,
            model=model.value,
            baseline=baseline or [],
            currents_only=currents_only,
            lenient=lenient,
            as_json=as_json,
        )


@app.command()
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
        from service.cli.follow import follow_records

    follow_records(
        records,
        motor,
        neighbours=neighbour or [],
        events=event or [],
        events_file=events,
        stale_after_days=stale_after,
        lenient=lenient,
        as_json=as_json,
    )


@app.command()
def commission(
    records: Annotated[
        list[Path],
        typer.Argument(metavar="RECORD...", help="Recordings of the motor's starts, each from before it on."),
    ],
    nameplate: Annotated[
        Path,
        typer.Option(
            metavar="MOTOR.toml", help="The motor: its nameplate table, and parameters if any are known."
        ),
    ],
    output: Annotated[
        Path, typer.Option(metavar="MOTOR.toml", help="Where to write the motor with what was found.")
    ],
    load: Annotated[
        Load, typer.Option(help="How the load torque grows with speed; auto: as fits best.")
    ] = Load.AUTO,
    *,
    as_json: Json = False,
) -> None:
    """Estimate a motor's parameters, with intervals, from recordings of its start."""
    from service.cli.commission import commission_motor

    commission_motor(records, nameplate, output, load=load.value, as_json=as_json)


@app.command()
def release(
    relay: Annotated[str, typer.Argument(metavar="RELAY", help="The relay's name in the plant's SCD.")],
    url: Url = DEFAULT_URL,
    *,
    as_json: Json = False,
) -> None:
    """Visit a relay again that was set aside for what it answered."""
    from service.cli.remote import release_relay

    release_relay(url, relay, as_json=as_json)


@app.command()
def trigger(
    motor: MotorName,
    url: Url = DEFAULT_URL,
    wait: Annotated[
        float,
        typer.Option(
            metavar="SECONDS", min=0, help="Wait this long for the diagnosis, and print its verdict."
        ),
    ] = 0.0,
    *,
    key: Annotated[
        str | None,
        typer.Option(metavar="TEXT", help="A word of your own: the same one again triggers nothing new."),
    ] = None,
    as_json: Json = False,
) -> None:
    """Request a recording of a motor from its relay."""
    from service.cli.remote import trigger_motor

    if not isfinite(wait):
        raise typer.BadParameter(f"--wait: expected a number of seconds, found {wait}")
    trigger_motor(url, motor, key=key, wait_s=wait, as_json=as_json)


@app.command()
def motors(url: Url = DEFAULT_URL, *, as_json: Json = False) -> None:
    """Show the condition of every motor the service watches: state, cause, level, since when, as of when."""
    from service.cli.motors import list_motors

    list_motors(url, as_json=as_json)


@app.command()
def health(motor: MotorName, url: Url = DEFAULT_URL, *, as_json: Json = False) -> None:
    """Show a motor's condition with what to do, and what its latest recording says by itself."""
    from service.cli.motors import show_health

    show_health(url, motor, as_json=as_json)


@app.command()
def condition(
    motor: MotorName,
    url: Url = DEFAULT_URL,
    *,
    history: Annotated[
        bool, typer.Option("--history", help="Also when it changed, and what changed it.")
    ] = False,
    as_json: Json = False,
) -> None:
    """Show a motor's condition over time: state, cause, level, forecast, what to do and why."""
    from service.cli.conditions import show_condition

    show_condition(url, motor, history=history, as_json=as_json)


@app.command()
def note(
    motor: MotorName,
    text: Annotated[str, typer.Argument(metavar="TEXT", help="What happened, in words.")],
    url: Url = DEFAULT_URL,
    kind: Annotated[
        NoteKind,
        typer.Option(help="What it is: all but a note change what the condition follows from."),
    ] = "note",
    time: Time = None,
    by: By = None,
    *,
    as_json: Json = False,
) -> None:
    """Tell what happened to a motor: maintenance, another winding, another relay, or just a note."""
    from service.cli.conditions import add_note

    add_note(url, motor, text, kind=kind, time=time, by=by, as_json=as_json)


@app.command()
def notes(motor: MotorName, url: Url = DEFAULT_URL, *, as_json: Json = False) -> None:
    """Show what people told of a motor, latest first."""
    from service.cli.conditions import list_notes

    list_notes(url, motor, as_json=as_json)


@app.command("withdraw-note")
def withdraw_note(
    motor: MotorName,
    note_id: Annotated[str, typer.Argument(metavar="ID", help="The note's id, as mcc notes shows it.")],
    reason: Annotated[str, typer.Option(metavar="TEXT", help="Why the note was wrong; it is kept.")],
    url: Url = DEFAULT_URL,
    by: By = None,
    *,
    as_json: Json = False,
) -> None:
    """Let a note that was wrong count no more: the condition follows as if nobody had told it."""
    from service.cli.conditions import withdraw_note

    withdraw_note(url, motor, note_id, reason, by=by, as_json=as_json)


@app.command("restart-reference")
def restart_reference(
    motor: MotorName,
    reason: Annotated[
        str, typer.Option(metavar="TEXT", help="Why the motor counts as healthy as it is; it is kept.")
    ],
    url: Url = DEFAULT_URL,
    time: Time = None,
    by: By = None,
    *,
    as_json: Json = False,
) -> None:
    """Take a motor for healthy as it is: what stands out of it from the first record on is learnt anew."""
    from service.cli.conditions import restart_reference

    restart_reference(url, motor, reason, time=time, by=by, as_json=as_json)


@app.command()
def relay(
    name: Annotated[str, typer.Argument(metavar="RELAY", help="The relay's name in the plant's SCD.")],
    url: Url = DEFAULT_URL,
    *,
    as_json: Json = False,
) -> None:
    """Show what is used of a relay, and where it is not what its SCL says."""
    from service.cli.relay import show_relay

    show_relay(url, name, as_json=as_json)


@app.command()
def delete(
    recording: Annotated[
        str, typer.Argument(metavar="RECORDING", help="The recording's id, as GET /recordings lists it.")
    ],
    reason: Annotated[
        str, typer.Option(metavar="TEXT", help="Why, in words; the service keeps it with the time.")
    ],
    url: Url = DEFAULT_URL,
    *,
    as_json: Json = False,
) -> None:
    """Delete a recording with its files and diagnoses, for good; it is not pulled from its relay again."""
    from service.cli.remote import delete_recording

    delete_recording(url, recording, reason, as_json=as_json)


@app.command()
def retention(
    config: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Settings file (TOML); see docs/reference/settings.md."),
    ] = None,
    *,
    dry_run: Annotated[
        bool, typer.Option("--dry-run", help="Delete nothing: show what each rule would delete.")
    ] = False,
    as_json: Json = False,
) -> None:
    """Delete the recordings and the like that the settings of retention call old, now instead of once a day.

    Measured values are left to the service, which averages them before it deletes them.
    """
    from service.cli.retention import apply_retention

    apply_retention(config, dry_run=dry_run, as_json=as_json)


@app.command("import-scl")
def import_scl(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="An SCD, CID, IID or ICD file.")],
    *,
    as_json: Json = False,
) -> None:
    """Show what an SCL file describes: sites, motors, relays, report control blocks."""
    from service.cli.scl_import import show_scl

    show_scl(file, as_json=as_json)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command. Returns 0 done, 1 failed, 2 wrong use."""
    words = list(sys.argv[1:] if arguments is None else arguments)
    # The demo's --json names a file, which the command writes itself.
    in_json = "--json" in words and words[0] != "demo"
    try:
        outcome = app(words, prog_name="mcc", standalone_mode=False)
    except CommandError as error:
        print_failure(error, in_json=in_json)
        return error.exit_code
    except typer.TyperException as error:
        message = one_line(error.format_message()) or "expected a command"
        failure = CommandError(f"{message} (mcc --help tells the way)", details={"type": "WrongUse"})
        print_failure(failure, in_json=in_json)
        return WRONG_USE
    if outcome == INTERRUPTED:
        print_failure(CommandError("interrupted", details={"type": "Interrupted"}), in_json=in_json)
        return FAILED
    return outcome if isinstance(outcome, int) else DONE
