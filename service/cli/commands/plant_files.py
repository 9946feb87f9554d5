"""Commands on the files of a plant: its settings' data, and its SCL."""

from pathlib import Path
from typing import Annotated, Literal

import typer

from service.cli.commands.options import DEFAULT_URL, Config, Json, Url

commands = typer.Typer()


@commands.command()
def init(
    directory: Annotated[
        Path | None, typer.Argument(metavar="DIR", help="The folder of the new plant.")
    ] = None,
    sources: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="SOURCE...",
            help="A list of motors (CSV or Excel); or an SCD; or a CID, IID or ICD of each relay; or "
            "addresses (HOST or HOST:PORT), or a text file that lists them.",
        ),
    ] = None,
    *,
    template: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Write an empty list of motors (.csv or .xlsx), and stop."),
    ] = None,
    as_json: Json = False,
) -> None:
    """Write the files of a new plant to fill in: settings, and a motors file with its relays.

    Relays whose addresses are given are asked what they are. Nothing is written over, nothing is triggered.
    """
    from service.cli.plant.init import init_plant, write_template

    if template is not None and directory is None:
        write_template(template, as_json=as_json)
        return
    if directory is None or template is not None:
        raise typer.BadParameter("expected the folder of the new plant, or --template FILE alone")
    init_plant(directory, sources or [], as_json=as_json)


@commands.command()
def check(
    config: Config = None,
    *,
    connect: Annotated[
        bool, typer.Option("--connect", help="Also ask each relay what it offers: a line a relay.")
    ] = False,
    fail_on: Annotated[
        Literal["watch", "fault"] | None,
        typer.Option(
            help="Ask the running service instead: print the motors at this state or a worse one, and end "
            "with 1 if there are any, with 0 and no word if not; for cron.",
        ),
    ] = None,
    url: Url = DEFAULT_URL,
    as_json: Json = False,
) -> int:
    """Tell all that is wrong in the settings, the motors file and the SCL files of a plant, at once.

    Nothing is started, and no relay is triggered. The exit code is 1 where mcc serve would not start.
    """
    if fail_on is not None:
        if config is not None or connect:
            raise typer.BadParameter("--fail-on asks the running service: expected no --config or --connect")
        from service.cli.plant.conditions_check import check_conditions

        return check_conditions(url, fail_on, as_json=as_json)
    from service.cli.plant.check import check_plant

    return check_plant(config, connect=connect, as_json=as_json)


@commands.command()
def retention(
    config: Config = None,
    *,
    dry_run: Annotated[
        bool, typer.Option("--dry-run", help="Delete nothing: show what each rule would delete.")
    ] = False,
    each: Annotated[
        bool,
        typer.Option("--list", help="Show each recording that is old enough, and why it goes or stays."),
    ] = False,
    as_json: Json = False,
) -> None:
    """Delete the recordings and the like that the settings of retention call old, now instead of once a day.

    Measured values are left to the service, which averages them before it deletes them.
    """
    from service.cli.retention import apply_retention

    apply_retention(config, dry_run=dry_run, each=each, as_json=as_json)


@commands.command("import-scl")
def import_scl(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="An SCD, CID, IID or ICD file.")],
    *,
    as_json: Json = False,
) -> None:
    """Show what an SCL file describes: sites, motors, relays, report control blocks."""
    from service.cli.plant.scl_import import show_scl

    show_scl(file, as_json=as_json)
