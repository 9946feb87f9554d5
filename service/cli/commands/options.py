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
