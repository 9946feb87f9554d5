"""Commands that write tables of a running service to files."""

from pathlib import Path
from typing import Annotated, Literal

import typer

from service.cli.commands.options import DEFAULT_URL, From, Json, To, Url

commands = typer.Typer()

export = typer.Typer(
    no_args_is_help=True,
    help="Write a table for spreadsheets and programs: CSV, Excel or Parquet.",
)
commands.add_typer(export, name="export")

Motors = Annotated[
    list[str] | None, typer.Argument(metavar="[MOTOR]...", help="Only these motors (default: all).")
]
Format = Annotated[
    Literal["csv", "xlsx", "parquet"] | None,
    typer.Option("--format", help="Without: that of FILE's name, else csv."),
]
Output = Annotated[
    Path | None, typer.Option("--output", metavar="FILE", help="The file (default: standard output).")
]
Overwrite = Annotated[bool, typer.Option("--overwrite", help="Replace a file that is there.")]


@export.command()
def trend(
    motors: Motors = None,
    url: Url = DEFAULT_URL,
    wanted: Format = None,
    output: Output = None,
    from_: From = None,
    to: To = None,
    *,
    overwrite: Overwrite = False,
    as_json: Json = False,
) -> None:
    """Write what each recording says by itself, and what is said of its motor from it on."""
    _export("trend", url, motors, {"from": from_, "to": to}, wanted, output, overwrite, as_json)


@export.command()
def measurements(
    motors: Motors = None,
    url: Url = DEFAULT_URL,
    wanted: Format = None,
    output: Output = None,
    from_: From = None,
    to: To = None,
    step: Annotated[
        Literal["0", "60", "900"],
        typer.Option(help="0: as sampled; 60, 900: means of so many seconds, kept for longer."),
    ] = "0",
    *,
    overwrite: Overwrite = False,
    as_json: Json = False,
) -> None:
    """Write what the relays measure all the time: currents, voltages, power and frequency."""
    query = {"from": from_, "to": to, "step": step}
    _export("measurements", url, motors, query, wanted, output, overwrite, as_json)


def _add_whole(table: str, told: str) -> None:
    """Add the command for a table that is chosen by its motors alone. told: its help."""

    @export.command(table, help=told)
    def write(
        motors: Motors = None,
        url: Url = DEFAULT_URL,
        wanted: Format = None,
        output: Output = None,
        *,
        overwrite: Overwrite = False,
        as_json: Json = False,
    ) -> None:
        _export(table, url, motors, {}, wanted, output, overwrite, as_json)


_add_whole("recordings", "Write the recordings with their verdicts, latest first.")
_add_whole("starts", "Write the starts with their figures, latest first.")
_add_whole("alarms", "Write the alarms, latest first.")
_add_whole("inspections", "Write what inspections found, latest first.")


def _export(
    table: str,
    url: str,
    motors: list[str] | None,
    query: dict[str, str | None],
    wanted: str | None,
    output: Path | None,
    overwrite: bool,
    as_json: bool,
) -> None:
    from service.cli.exports.files import export_table

    export_table(
        url, table, motors or (), query, wanted=wanted, output=output, overwrite=overwrite, as_json=as_json
    )
