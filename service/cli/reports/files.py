"""Has the service make a report, and puts it where it is wanted: all of it, or nothing."""

import sys
from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Literal

from rich.text import Text

from core.error_words import one_line
from service.cli.exports.files import written_file
from service.cli.output import WRONG_USE, CommandError, failing_clearly, print_document, results
from service.client.rest_client import ServiceClient, ServiceError, segment
from statorwatch_client import Download

FORMATS = ("pdf", "xlsx")


@dataclass(frozen=True)
class Report:
    """A report: of the fleet, of the alarms, or of one motor."""

    kind: Literal["fleet", "alarms", "motors"]
    motor: str = ""

    @property
    def name(self) -> str:
        """Return what it is called below /reports."""
        return f"motors/{segment(self.motor)}" if self.kind == "motors" else self.kind

    def asked_of(self, service: ServiceClient) -> Callable[..., AbstractContextManager[Download]]:
        """Return what asks a service for it."""
        if self.kind == "motors":
            return partial(service.get_motor_report, self.motor)
        return service.get_fleet_report if self.kind == "fleet" else service.get_alarms_report


def write_report(
    url: str,
    report: Report,
    query: Mapping[str, str | Sequence[str] | None],
    *,
    wanted: str | None,
    output: Path | None,
    overwrite: bool,
    as_json: bool,
) -> None:
    """Write a report to a file; without `output` to stdout.

    query: what is asked for besides; None where the service chooses.
    wanted: the format; None: that of the file's name, else PDF. Raises CommandError.
    """
    chosen = wanted or _format_of(output)
    if output is None and (as_json or sys.stdout.isatty()):
        why = "the file itself would go to stdout" if as_json else "a terminal cannot show it"
        problem = f"expected --output FILE, for {why}"
        raise CommandError(problem, details={"type": "WrongUse"}, exit_code=WRONG_USE)
    with (
        failing_clearly(ServiceError, OSError),
        ServiceClient(url) as service,
        written_file(output, overwrite=overwrite) as file,
        report.asked_of(service)(**query, format=chosen) as answer,
    ):
        size_bytes = answer.save(file)
    if output is None:
        return
    if as_json:
        print_document(
            {"report": report.name, "file": str(output), "format": chosen, "size_bytes": size_bytes}
        )
    else:
        results().print(Text(one_line(f"{output}: {size_bytes} bytes")), soft_wrap=True)


def _format_of(output: Path | None) -> str:
    suffix = "" if output is None else output.suffix.lower().removeprefix(".")
    return suffix if suffix in FORMATS else FORMATS[0]
