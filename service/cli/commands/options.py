"""Arguments, options and groups that several commands have."""

import os
from math import isfinite
from pathlib import Path
from typing import Annotated, Any

import typer

from service.cli.output import print_warning


def _warn_of_unknown_variables(url: str) -> str:
    """Print a warning for each variable that is named like a setting and is none, such as MCC_ULR."""
    if any(name.upper().startswith("MCC_") and name != "MCC_URL" for name in os.environ):
        from service.configuration.settings import Settings
        from service.configuration.settings_problems import unknown_variables

        for problem in unknown_variables(os.environ, Settings.model_fields):
            print_warning(str(problem))
    return url


def finite_seconds(wait: float) -> float:
    """Refuse `nan` and `inf`, which are numbers to the parser of options."""
    if not isfinite(wait):
        raise typer.BadParameter(f"expected a number of seconds, found {wait}")
    return wait


def _finite(number: float | None) -> float | None:
    if number is not None and not isfinite(number):
        raise typer.BadParameter(f"expected a number, found {number}")
    return number


def _scale(number: float | None) -> float | None:
    if number == 0.0:
        raise typer.BadParameter("expected a number other than zero")
    return _finite(number)


TableColumn = Annotated[
    list[str] | None,
    typer.Option(
        "--column",
        metavar="QUANTITY=NAME",
        help="A column of a table: ia, ib, ic, va, vb, vc or vab, vbc, vca, such as ia='Channel A'; for "
        "all three phases. Default: [channels] of the motor file, else by names and units.",
    ),
]
TableRate = Annotated[
    float | None,
    typer.Option(
        "--rate", metavar="HZ", min=1.0, callback=_finite, help="Sampling rate of a table that has no times."
    ),
]
CurrentScale = Annotated[
    float | None,
    typer.Option("--current-scale", metavar="A", callback=_scale, help="Amperes of one as a table has it."),
]
CurrentOffset = Annotated[
    float | None,
    typer.Option("--current-offset", metavar="A", callback=_finite, help="Amperes added to a table's."),
]
VoltageScale = Annotated[
    float | None,
    typer.Option("--voltage-scale", metavar="V", callback=_scale, help="Volts of one as a table has it."),
]
VoltageOffset = Annotated[
    float | None,
    typer.Option("--voltage-offset", metavar="V", callback=_finite, help="Volts added to a table's."),
]

VerdictWait = Annotated[
    float,
    typer.Option(
        "--wait",
        metavar="SECONDS",
        min=0,
        callback=finite_seconds,
        help="Wait this long for the diagnosis, and print its verdict.",
    ),
]
Csv = Annotated[bool, typer.Option("--csv", help="Print rows of comma-separated values with a heading.")]
From = Annotated[str | None, typer.Option("--from", metavar="TIME", help="First time or date.")]
To = Annotated[
    str | None, typer.Option("--to", metavar="TIME", help="First time or date not to be included.")
]
Json = Annotated[bool, typer.Option("--json", help="Print one JSON document on stdout, also on failure.")]
Url = Annotated[
    str,
    typer.Option(
        "--url",
        envvar="MCC_URL",
        callback=_warn_of_unknown_variables,
        help="Address of the running service.",
    ),
]
Config = Annotated[
    Path | None,
    typer.Option(metavar="FILE", help="Settings file (TOML); see docs/reference/settings.md."),
]

DEFAULT_URL = "http://127.0.0.1:8710"


class DefaultGroup(typer.core.TyperGroup):
    """A group of commands whose first one is run where none is named."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Read the words after the group's name."""
        if not args or (args[0] not in self.commands and args[0] != "--help"):
            args = [next(iter(self.commands)), *args]
        return super().parse_args(ctx, args)
