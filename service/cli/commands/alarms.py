"""Commands on alarms: what to act on first, what happened, and what people do about it."""

from typing import Annotated, Literal

import typer

from service.cli.commands.options import DEFAULT_URL, Csv, DefaultGroup, Json, Url

alarms = typer.Typer(cls=DefaultGroup, help="Show what to act on first, and acknowledge or shelve it.")
commands = typer.Typer()
commands.add_typer(alarms, name="alarms")

State = Literal[
    "unacknowledged", "acknowledged", "returned-unacknowledged", "shelved", "suppressed", "out-of-service"
]
AlarmId = Annotated[
    str, typer.Argument(metavar="ALARM", help="The alarm's id, or how it begins, as mcc alarms shows it.")
]
AlarmIds = Annotated[
    list[str] | None,
    typer.Argument(metavar="[ALARM]...", help="Ids, or how they begin, as mcc alarms shows them."),
]
Comment = Annotated[str | None, typer.Option(metavar="TEXT", help="Why; it is kept.")]


@alarms.command("list")
def list_alarms(
    motor: Annotated[str | None, typer.Argument(metavar="[MOTOR]", help="Only this motor's.")] = None,
    url: Url = DEFAULT_URL,
    site: Annotated[str | None, typer.Option(metavar="SITE", help="Only this site's.")] = None,
    relay: Annotated[
        str | None, typer.Option(metavar="RELAY", help="Only this relay's and its motors'.")
    ] = None,
    state: Annotated[State | None, typer.Option(help="Only those in this state.")] = None,
    part_of: Annotated[
        str | None, typer.Option(metavar="ALARM", help="Only those that this alarm tells in one line.")
    ] = None,
    limit: Annotated[int, typer.Option("--limit", min=1, max=100_000, help="Show so many.")] = 100,
    *,
    over: Annotated[
        bool, typer.Option("--all", help="Also those that are over; the latest at the top.")
    ] = False,
    as_csv: Csv = False,
    as_json: Json = False,
) -> None:
    """Show the alarms that are not over: what to act on first at the top, with what to do."""
    from service.cli.alarms.listing import Chosen, show_alarms

    chosen = Chosen(motor=motor, site=site, relay=relay, state=state, over=over, part_of=part_of)
    show_alarms(url, chosen, limit=limit, as_csv=as_csv, as_json=as_json)


@alarms.command()
def show(alarm: AlarmId, url: Url = DEFAULT_URL, *, as_json: Json = False) -> None:
    """Show one alarm and all that happened to it."""
    from service.cli.alarms.listing import show_alarm

    show_alarm(url, alarm, as_json=as_json)


@alarms.command()
def acknowledge(
    alarms: AlarmIds = None,
    url: Url = DEFAULT_URL,
    motor: Annotated[
        str | None, typer.Option(metavar="MOTOR", help="All of this motor that nobody acknowledged.")
    ] = None,
    comment: Comment = None,
    *,
    as_json: Json = False,
) -> None:
    """Take notice of alarms. One whose cause is gone is over then."""
    from service.cli.alarms.acting import acknowledge_alarms

    acknowledge_alarms(url, alarms or [], motor=motor, comment=comment, as_json=as_json)


@alarms.command()
def shelve(
    alarm: AlarmId,
    url: Url = DEFAULT_URL,
    until: Annotated[
        str | None, typer.Option(metavar="TIME", help="Until then, as 2026-01-31T12:00:00Z, or a date.")
    ] = None,
    lasting: Annotated[
        str | None, typer.Option("--for", metavar="TIME", help="For so long: 30min, 8h, 3d.")
    ] = None,
    growth: Annotated[
        str | None,
        typer.Option(
            metavar="AMOUNT", help="Until its value has grown by so much: 0.005, or 0.5% for the same."
        ),
    ] = None,
    comment: Comment = None,
    *,
    as_json: Json = False,
) -> None:
    """Set an alarm aside until a time, until it grows, or what comes first."""
    from service.cli.alarms.acting import ShelvingEnd, shelve_alarm

    shelve_alarm(url, alarm, ShelvingEnd(until, lasting, growth), comment=comment, as_json=as_json)


@alarms.command()
def unshelve(
    alarm: AlarmId, url: Url = DEFAULT_URL, comment: Comment = None, *, as_json: Json = False
) -> None:
    """End the shelving of an alarm: it calls again if its cause stands."""
    from service.cli.alarms.acting import unshelve_alarm

    unshelve_alarm(url, alarm, comment=comment, as_json=as_json)


@alarms.command("out-of-service")
def out_of_service(
    alarm: AlarmId, url: Url = DEFAULT_URL, comment: Comment = None, *, as_json: Json = False
) -> None:
    """Set an alarm aside until somebody puts it back in service."""
    from service.cli.alarms.acting import take_out_of_service

    take_out_of_service(url, alarm, comment=comment, as_json=as_json)


@alarms.command("back-in-service")
def back_in_service(
    alarm: AlarmId, url: Url = DEFAULT_URL, comment: Comment = None, *, as_json: Json = False
) -> None:
    """Put an alarm back in service: it calls again if its cause stands."""
    from service.cli.alarms.acting import put_back_in_service

    put_back_in_service(url, alarm, comment=comment, as_json=as_json)


@alarms.command()
def figures(
    url: Url = DEFAULT_URL,
    days: Annotated[int, typer.Option(min=1, max=366, help="So many days of UTC, with today.")] = 30,
    *,
    as_json: Json = False,
) -> None:
    """Show how many alarms a day there were, the most frequent, chattering and long-standing ones."""
    from service.cli.alarms.figures import show_figures

    show_figures(url, days=days, as_json=as_json)
