"""Arguments and options that several commands have."""

from pathlib import Path
from typing import Annotated

import typer

Json = Annotated[bool, typer.Option("--json", help="Print one JSON document on stdout, also on failure.")]
Url = Annotated[str, typer.Option("--url", envvar="MCC_URL", help="Address of the running service.")]
Config = Annotated[
    Path | None,
    typer.Option(metavar="FILE", help="Settings file (TOML); see docs/reference/settings.md."),
]

DEFAULT_URL = "http://127.0.0.1:8710"
