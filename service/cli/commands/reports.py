"""Commands that have the service make reports."""

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Literal

import typer

from service.cli.commands.options import DEFAULT_URL, Json, Url

commands = typer.Typer()

report = typer.Typer(no_args_is_help=True, help="Write a report: PDF, or an Excel workbook.")
commands.add_typer(report, name="report")

Format = Annotated[
    Literal["pdf", "xlsx"] | None, typer.Option("--format", help="Without: that of FILE's name, else pdf.")
]
Output = Annotated[
    Path | None,
    typer.Option("--output", metavar="FILE", help="The file (default: standard output)."),
]
Overwrite = Annotated[bool, typer.Option("--overwrite", help="Replace a file that is there.")]
Until = Annotated[
    str | None, typer.Option(metavar="TIME", help="Nothing later is told; RFC 3339 (default: now).")
]
Sites = Annotated[
    list[str] | None, typer.Option("--site", metavar="SITE", help="Only this site; may be repeated.")
]


@report.command()
def fleet(
    period: Annotated[
        Literal["daily", "weekly"], typer.Option(help="The time before that is told.")
    ] = "daily",
    url: Url = DEFAULT_URL,
    until: Until = None,
    sites: Sites = None,
    wanted: Format = None,
    output: Output = None,
    *,
    overwrite: Overwrite = False,
    as_json: Json = False,
) -> None:
    """Write how all motors are, and what happened in the day or week before."""
    query = {"period": period, "until": until, "site": sites or None}
    _report(url, "fleet", "", query, wanted, output, overwrite, as_json)


@report.command()
def motor(
    name: Annotated[str, typer.Argument(metavar="MOTOR", help="The motor's name.")],
    url: Url = DEFAULT_URL,
    until: Until = None,
    wanted: Format = None,
    output: Output = None,
    *,
    overwrite: Overwrite = False,
    as_json: Json = False,
) -> None:
    """Write all of one motor, with its pictures."""
    _report(url, "motors", name, {"until": until}, wanted, output, overwrite, as_json)


@report.command()
def alarms(
    month: Annotated[
        str | None, typer.Option(metavar="YYYY-MM", help="The month (default: this one).")
    ] = None,
    url: Url = DEFAULT_URL,
    sites: Sites = None,
    wanted: Format = None,
    output: Output = None,
    *,
    overwrite: Overwrite = False,
    as_json: Json = False,
) -> None:
    """Write all calls of alarms in a month, and what became of each."""
    query = {"month": month, "site": sites or None}
    _report(url, "alarms", "", query, wanted, output, overwrite, as_json)


def _report(
    url: str,
    kind: Literal["fleet", "alarms", "motors"],
    motor: str,
    query: Mapping[str, str | list[str] | None],
    wanted: str | None,
    output: Path | None,
    overwrite: bool,
    as_json: bool,
) -> None:
    from service.cli.reports.files import Report, write_report

    write_report(
        url, Report(kind, motor), query, wanted=wanted, output=output, overwrite=overwrite, as_json=as_json
    )
