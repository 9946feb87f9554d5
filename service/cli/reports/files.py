"""Has the service make a report, and puts it where it is wanted: all of it, or nothing."""

import sys
from collections.abc import Sequence
from pathlib import Path

from rich.text import Text

from core.error_words import one_line
from service.cli.exports.files import written_file
from service.cli.output import WRONG_USE, CommandError, failing_clearly, print_document, results
from service.client.rest_client import ServiceClient, ServiceError

FORMATS = ("pdf", "xlsx")


def write_report(
    url: str,
    path: str,
    query: Sequence[tuple[str, str | None]],
    *,
    wanted: str | None,
    output: Path | None,
    overwrite: bool,
    as_json: bool,
) -> None:
    """Write a report to a file; without `output` to stdout.

    path: of the report below /reports.  query: what is asked for; None where the service chooses.
    wanted: the format; None: that of the file's name, else PDF. Raises CommandError.
    """
    chosen = wanted or _format_of(output)
    if output is None and (as_json or sys.stdout.isatty()):
        why = "the file itself would go to stdout" if as_json else "a terminal cannot show it"
        problem = f"expected --output FILE, for {why}"
        raise CommandError(problem, details={"type": "WrongUse"}, exit_code=WRONG_USE)
    words = [(name, value) for name, value in query if value is not None]
    with (
        failing_clearly(ServiceError, OSError),
        ServiceClient(url) as service,
        written_file(output, overwrite=overwrite) as file,
    ):
        size_bytes = service.save(f"/reports/{path}", [*words, ("format", chosen)], file)
    if output is None:
        return
    if as_json:
        print_document({"report": path, "file": str(output), "format": chosen, "size_bytes": size_bytes})
    else:
        results().print(Text(one_line(f"{output}: {size_bytes} bytes")), soft_wrap=True)


def _format_of(output: Path | None) -> str:
    suffix = "" if output is None else output.suffix.lower().removeprefix(".")
    return suffix if suffix in FORMATS else FORMATS[0]
