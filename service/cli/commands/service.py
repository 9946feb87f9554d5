"""Commands that ask a running service, or tell it something."""

from typing import Annotated, Literal

import typer

from service.cli.commands.options import DEFAULT_URL, Json, Url, VerdictWait

commands = typer.Typer()

MotorName = Annotated[str, typer.Argument(metavar="MOTOR", help="The motor's name in the plant's files.")]
Time = Annotated[
    str | None,
    typer.Option(metavar="TIME", help="When it happened, as 2026-01-31T12:00:00Z (default: now)."),
]
NoteKind = Literal["note", "maintenance", "recorder-changed", "rewound", "reference-restarted"]
"""What a person may tell: all kinds of events but the one that only the motors file tells."""

OnBehalfOf = Annotated[
    str | None, typer.Option(metavar="NAME", help="Whom you do it for; shown beside your account.")
]


@commands.command()
def release(
    relay: Annotated[str, typer.Argument(metavar="RELAY", help="The relay's name in the plant's files.")],
    url: Url = DEFAULT_URL,
    *,
    as_json: Json = False,
) -> None:
    """Visit a relay again that was set aside for what it answered."""
    from service.cli.remote import release_relay

    release_relay(url, relay, as_json=as_json)


@commands.command()
def trigger(
    motor: MotorName,
    url: Url = DEFAULT_URL,
    wait: VerdictWait = 0.0,
    *,
    key: Annotated[
        str | None,
        typer.Option(metavar="TEXT", help="A word of your own: the same one again triggers nothing new."),
    ] = None,
    seconds: Annotated[
        float | None,
        typer.Option(
            min=1.0,
            max=30.0,
            metavar="SECONDS",
            help="Record so much, as a series of records that overlap and are joined.",
        ),
    ] = None,
    as_json: Json = False,
) -> None:
    """Request a recording of a motor from its relay."""
    from service.cli.remote import trigger_motor

    trigger_motor(url, motor, key=key, wait_s=wait, seconds=seconds, as_json=as_json)


@commands.command()
def motors(url: Url = DEFAULT_URL, *, as_json: Json = False) -> None:
    """Show the condition of every motor the service watches: state, cause, level, since when, as of when."""
    from service.cli.motors import list_motors

    list_motors(url, as_json=as_json)


@commands.command()
def health(motor: MotorName, url: Url = DEFAULT_URL, *, as_json: Json = False) -> None:
    """Show a motor's condition with what to do, and what its latest recording says by itself."""
    from service.cli.motors import show_health

    show_health(url, motor, as_json=as_json)


@commands.command()
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
    from service.cli.conditions.stored import show_condition

    show_condition(url, motor, history=history, as_json=as_json)


@commands.command("plan-stop")
def plan_stop(
    name: Annotated[str, typer.Argument(metavar="NAME", help="The motor, or with --site the site.")],
    time: Annotated[
        str | None,
        typer.Argument(metavar="[TIME]", help="When it stops, as 2026-12-24 or 2026-12-24T06:00:00Z."),
    ] = None,
    url: Url = DEFAULT_URL,
    *,
    site: Annotated[bool, typer.Option("--site", help="All motors of a site.")] = False,
    cancel: Annotated[bool, typer.Option("--cancel", help="Drop the plan.")] = False,
    as_json: Json = False,
) -> None:
    """Plan when a motor or a site stops next: its condition says whether it may run until then."""
    from service.cli.conditions.planned_stop import plan_stop

    if (time is None) != cancel:
        raise typer.BadParameter("expected either a TIME or --cancel")
    plan_stop(url, name, time, is_site=site, as_json=as_json)


@commands.command()
def note(
    motor: MotorName,
    text: Annotated[str, typer.Argument(metavar="TEXT", help="What happened, in words.")],
    url: Url = DEFAULT_URL,
    kind: Annotated[
        NoteKind,
        typer.Option(help="What it is: all but a note change what the condition follows from."),
    ] = "note",
    time: Time = None,
    on_behalf_of: OnBehalfOf = None,
    *,
    as_json: Json = False,
) -> None:
    """Tell what happened to a motor: maintenance, another winding, another relay, or just a note."""
    from service.cli.conditions.stored import add_note

    add_note(url, motor, text, kind=kind, time=time, on_behalf_of=on_behalf_of, as_json=as_json)


@commands.command()
def notes(motor: MotorName, url: Url = DEFAULT_URL, *, as_json: Json = False) -> None:
    """Show what people told of a motor, latest first."""
    from service.cli.conditions.stored import list_notes

    list_notes(url, motor, as_json=as_json)


@commands.command("withdraw-note")
def withdraw_note(
    motor: MotorName,
    note_id: Annotated[str, typer.Argument(metavar="ID", help="The note's id, as mcc notes shows it.")],
    reason: Annotated[str, typer.Option(metavar="TEXT", help="Why the note was wrong; it is kept.")],
    url: Url = DEFAULT_URL,
    on_behalf_of: OnBehalfOf = None,
    *,
    as_json: Json = False,
) -> None:
    """Let a note that was wrong count no more: the condition follows as if nobody had told it."""
    from service.cli.conditions.stored import withdraw_note

    withdraw_note(url, motor, note_id, reason, on_behalf_of=on_behalf_of, as_json=as_json)


@commands.command("restart-reference")
def restart_reference(
    motor: MotorName,
    reason: Annotated[
        str, typer.Option(metavar="TEXT", help="Why the motor counts as healthy as it is; it is kept.")
    ],
    url: Url = DEFAULT_URL,
    time: Time = None,
    on_behalf_of: OnBehalfOf = None,
    *,
    as_json: Json = False,
) -> None:
    """Take a motor for healthy as it is: what stands out of it from the first record on is learnt anew."""
    from service.cli.conditions.stored import restart_reference

    restart_reference(url, motor, reason, time=time, on_behalf_of=on_behalf_of, as_json=as_json)


@commands.command()
def relay(
    name: Annotated[str, typer.Argument(metavar="RELAY", help="The relay's name in the plant's files.")],
    url: Url = DEFAULT_URL,
    *,
    as_json: Json = False,
) -> None:
    """Show what is used of a relay, and where it is not what its SCL says."""
    from service.cli.relay import show_relay

    show_relay(url, name, as_json=as_json)


@commands.command()
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
    """Delete a recording with its files and diagnoses; it is not pulled from its relay again.

    You can undo that for ten minutes, on the page of the recordings.
    """
    from service.cli.remote import delete_recording

    delete_recording(url, recording, reason, as_json=as_json)
