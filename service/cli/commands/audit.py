"""Commands on the audit trail."""

from pathlib import Path
from typing import Annotated

import typer

from service.cli.commands.options import DEFAULT_URL, Csv, From, Json, To, Url

commands = typer.Typer()
audit = typer.Typer(
    no_args_is_help=True,
    help="Show who changed what, take it elsewhere, and verify that it is as it was written.",
)
commands.add_typer(audit, name="audit")

Directly = Annotated[
    Path | None,
    typer.Option("--config", metavar="FILE", help="Read the database of these settings, without a service."),
]


@audit.command("list")
def list_entries(
    url: Url = DEFAULT_URL,
    config: Directly = None,
    actor: Annotated[str | None, typer.Option(metavar="NAME", help="Only what this person did.")] = None,
    action: Annotated[
        str | None, typer.Option(metavar="ACTION", help="Only this, as recording-deleted.")
    ] = None,
    subject: Annotated[
        str | None, typer.Option(metavar="NAME", help="Only of this motor, relay, recording, user, ...")
    ] = None,
    from_: From = None,
    to: To = None,
    limit: Annotated[
        int, typer.Option("--limit", min=1, max=100_000, help="Show so many, the latest.")
    ] = 100,
    *,
    as_csv: Csv = False,
    as_json: Json = False,
) -> None:
    """Show who changed what, from where, and the values before and after, latest first."""
    from service.cli.audit.entries import show_entries

    chosen = {"actor": actor, "action": action, "subject": subject, "from": from_, "to": to}
    show_entries(url, config, chosen, limit=limit, as_csv=as_csv, as_json=as_json)


@audit.command()
def verify(
    file: Annotated[
        Path | None, typer.Argument(metavar="[FILE]", help="An export (default: what the service has).")
    ] = None,
    url: Url = DEFAULT_URL,
    config: Directly = None,
    anchor: Annotated[
        list[Path] | None,
        typer.Option(metavar="FILE", help="A file whose last line was an entry: an export or a kept anchor."),
    ] = None,
    write_anchor: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Add the last entry to this file, if all is well.")
    ] = None,
    *,
    as_json: Json = False,
) -> None:
    """Read the whole audit trail, and name the first entry that is not as it was written."""
    from service.cli.audit.verification import verify_trail

    verify_trail(url, config, file, anchors=anchor or [], write_anchor=write_anchor, as_json=as_json)


@audit.command()
def export(
    file: Annotated[
        Path | None,
        typer.Argument(metavar="[FILE]", help="Continued where it ends (default: standard output)."),
    ] = None,
    url: Url = DEFAULT_URL,
    config: Directly = None,
) -> None:
    """Write all entries of the audit trail, one a line of JSON, as they were hashed."""
    from service.cli.audit.export import export_trail

    export_trail(url, config, file)
