"""Commands on what people found when they inspected motors."""

from pathlib import Path
from typing import Annotated, Literal

import typer

from core.condition.kinds import Kind
from service.cli.commands.options import DEFAULT_URL, Json, Url

commands = typer.Typer()
inspections = typer.Typer(
    no_args_is_help=True,
    help="Tell what inspections of motors found, and show how often the service was right.",
)
commands.add_typer(inspections, name="inspections")

MotorName = Annotated[str, typer.Argument(metavar="MOTOR", help="The motor's name.")]
Outcome = Literal["confirmed", "other-cause", "nothing-found"]


@inspections.command("add")
def add(
    motor: MotorName,
    outcome: Annotated[Outcome, typer.Argument(help="What was found beside what the service had said.")],
    text: Annotated[str, typer.Argument(metavar="TEXT", help="What was found, in words.")],
    url: Url = DEFAULT_URL,
    kind: Annotated[
        Kind | None,
        typer.Option(help="What the service had said (default: what it says now); none for nothing."),
    ] = None,
    cause: Annotated[str | None, typer.Option(metavar="TEXT", help="With other-cause: what it was.")] = None,
    alarm: Annotated[str | None, typer.Option(metavar="ID", help="The alarm that it was about.")] = None,
    time: Annotated[
        str | None, typer.Option(metavar="TIME", help="When, as 2026-01-31T12:00:00Z (default: now).")
    ] = None,
    picture: Annotated[
        list[Path] | None,
        typer.Option(metavar="FILE", help="A PNG or JPEG of at most 1 MiB; up to four times."),
    ] = None,
    on_behalf_of: Annotated[
        str | None, typer.Option(metavar="NAME", help="Whom you do it for; shown beside your account.")
    ] = None,
    *,
    as_json: Json = False,
) -> None:
    """Tell what an inspection of a motor found. It is counted; no judgement follows from it."""
    from service.cli.inspections import add_inspection

    said = {
        "outcome": outcome,
        "text": text,
        "kind": None if kind is None else kind.value,
        "cause": cause,
        "alarm_id": alarm,
        "time": time,
        "on_behalf_of": on_behalf_of,
    }
    add_inspection(url, motor, said, picture or [], as_json=as_json)


@inspections.command("list")
def list_(motor: MotorName, url: Url = DEFAULT_URL, *, as_json: Json = False) -> None:
    """Show what inspections of a motor found, latest first."""
    from service.cli.inspections import list_inspections

    list_inspections(url, motor, as_json=as_json)


@inspections.command("figures")
def figures(url: Url = DEFAULT_URL, *, as_json: Json = False) -> None:
    """Show how often inspections found what was said: by kind of finding, site and year."""
    from service.cli.inspections import show_figures

    show_figures(url, as_json=as_json)


@inspections.command("withdraw")
def withdraw(
    motor: MotorName,
    inspection: Annotated[str, typer.Argument(metavar="ID", help="The inspection's id.")],
    reason: Annotated[str, typer.Option(metavar="TEXT", help="Why it does not count; it is kept.")],
    url: Url = DEFAULT_URL,
    *,
    as_json: Json = False,
) -> None:
    """Let an inspection that was wrong count no more."""
    from service.cli.inspections import withdraw_inspection

    withdraw_inspection(url, motor, inspection, reason, as_json=as_json)
