"""Commands on notifications: what was sent to whom, tests, and another attempt."""

from typing import Annotated, Literal

import typer

from service.cli.commands.options import DEFAULT_URL, DefaultGroup, Json, Url, finite_seconds

notify = typer.Typer(cls=DefaultGroup, help="Show what was sent to whom, and test the channels.")
commands = typer.Typer()
commands.add_typer(notify, name="notify")

State = Literal["queued", "sending", "sent", "dead", "withdrawn"]


@notify.command("list")
def list_notifications(
    url: Url = DEFAULT_URL,
    state: Annotated[State | None, typer.Option(help="Only those in this state; dead: given up.")] = None,
    channel: Annotated[
        str | None, typer.Option(metavar="NAME", help="Only those of this channel of the settings.")
    ] = None,
    alarm: Annotated[
        str | None, typer.Option(metavar="ID", help="Only those that told of this alarm.")
    ] = None,
    limit: Annotated[int, typer.Option("--limit", min=1, max=100_000, help="Show so many.")] = 50,
    *,
    as_json: Json = False,
) -> None:
    """Show the messages, latest first: what was sent to whom, what waits, and what was given up."""
    from service.cli.notifications.listing import list_notifications

    list_notifications(url, state=state, channel=channel, alarm=alarm, limit=limit, as_json=as_json)


@notify.command()
def channels(url: Url = DEFAULT_URL, *, as_json: Json = False) -> None:
    """Show the channels of the service's settings, and how many messages wait for each."""
    from service.cli.notifications.listing import list_channels

    list_channels(url, as_json=as_json)


@notify.command("test")
def send_test(
    names: Annotated[
        list[str] | None,
        typer.Argument(metavar="[CHANNEL]...", help="Channels of the settings (default: all)."),
    ] = None,
    url: Url = DEFAULT_URL,
    wait: Annotated[
        float,
        typer.Option(
            metavar="SECONDS", min=0, callback=finite_seconds, help="Wait this long for the answer."
        ),
    ] = 60.0,
    *,
    as_json: Json = False,
) -> int:
    """Send a test message to every receiver of channels. The exit code is 1 where one did not take it."""
    from service.cli.notifications.trial import send_tests

    return send_tests(url, names or [], wait_s=wait, as_json=as_json)


@notify.command()
def retry(
    ids: Annotated[
        list[str] | None, typer.Argument(metavar="[ID]...", help="Messages, as mcc notify list shows them.")
    ] = None,
    url: Url = DEFAULT_URL,
    *,
    every: Annotated[bool, typer.Option("--all", help="All messages that were given up.")] = False,
    as_json: Json = False,
) -> None:
    """Have messages tried again that were given up."""
    from service.cli.notifications.listing import retry_notifications

    retry_notifications(url, ids or [], every=every, as_json=as_json)
