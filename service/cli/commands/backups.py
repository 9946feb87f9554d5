"""Commands that back a service up, and put a back-up in place."""

from pathlib import Path
from typing import Annotated

import typer

from service.cli.commands.options import Config, Json

commands = typer.Typer()


@commands.command()
def backup(
    directory: Annotated[
        Path | None,
        typer.Argument(metavar="[DIRECTORY]", help="Where back-ups are kept (default: backup.directory)."),
    ] = None,
    config: Config = None,
    keep: Annotated[
        int | None, typer.Option(metavar="N", min=1, help="Remove the oldest back-ups beyond so many.")
    ] = None,
    *,
    verify: Annotated[
        bool, typer.Option("--verify", help="Make none: read the latest one again, or the one named.")
    ] = False,
    listed: Annotated[
        bool, typer.Option("--list", help="Make none: show which were made, and why others failed.")
    ] = False,
    as_json: Json = False,
) -> None:
    """Back up database, recordings and plant files while the service runs, and verify the back-up.

    Recordings that an earlier back-up has are not copied again.
    """
    from service.cli.backup.make import back_up
    from service.cli.backup.make import verify as verify_backup

    if listed:
        from service.cli.backup.listing import list_backups

        if verify or keep is not None or directory is not None:
            raise typer.BadParameter("--list: expected it alone, with --config and --json at most")
        list_backups(config, as_json=as_json)
        return
    if not verify:
        back_up(config, directory, keep=keep, as_json=as_json)
        return
    if keep is not None:
        raise typer.BadParameter("--keep is for a new back-up: leave out --keep or --verify")
    verify_backup(config, directory, as_json=as_json)


@commands.command()
def purge(
    config: Config = None,
    audit: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE", help="Export the audit trail into this file first, to be kept elsewhere."
        ),
    ] = None,
    *,
    without_audit: Annotated[
        bool, typer.Option("--without-audit", help="Let the audit trail go, too.")
    ] = False,
    backups: Annotated[bool, typer.Option("--backups", help="Delete the back-ups, too.")] = False,
    yes: Annotated[bool, typer.Option("--yes", help="Do not ask for the name of the directory.")] = False,
    as_json: Json = False,
) -> None:
    """Delete all that a service keeps of its plant, for good; the service has to be stopped."""
    from service.cli.backup.purge import purge as purge_plant

    if (audit is None) is not without_audit:
        raise typer.BadParameter("expected one of --audit FILE and --without-audit")
    purge_plant(config, audit=audit, backups=backups, is_confirmed=yes, as_json=as_json)


@commands.command()
def restore(
    backup: Annotated[
        Path, typer.Argument(metavar="BACKUP", help="A back-up, or a directory of them: its latest one.")
    ],
    config: Config = None,
    into: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Restore into this data directory instead of that of the settings."),
    ] = None,
    *,
    overwrite: Annotated[
        bool, typer.Option("--overwrite", help="Replace a database that is there already.")
    ] = False,
    as_json: Json = False,
) -> None:
    """Put a back-up in the place of a service's data, all of it or nothing; the service has to be stopped."""
    from service.cli.backup.restore import restore as restore_backup

    restore_backup(config, backup, into=into, overwrite=overwrite, as_json=as_json)
