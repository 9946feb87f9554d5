"""Has the service make a file of a table, and puts it where it is wanted: all of it, or nothing."""

import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from typing import BinaryIO
from uuid import uuid4

from rich.text import Text

from core.error_words import one_line
from service.cli.output import WRONG_USE, CommandError, failing_clearly, print_document, results
from service.client.rest_client import ServiceClient, ServiceError
from statorwatch_client import Download

FORMATS = ("csv", "xlsx", "parquet")
TABLES: dict[str, Callable[..., AbstractContextManager[Download]]] = {
    "trend": ServiceClient.export_trend,
    "measurements": ServiceClient.export_measurements,
    "recordings": ServiceClient.export_recordings,
    "starts": ServiceClient.export_starts,
    "alarms": ServiceClient.export_alarms,
    "inspections": ServiceClient.export_inspections,
}
"""How a service is asked for each table."""


def export_table(
    url: str,
    table: str,
    motors: Sequence[str],
    query: Mapping[str, str | None],
    *,
    wanted: str | None,
    output: Path | None,
    overwrite: bool,
    as_json: bool,
) -> None:
    """Write a table of these motors, or of all, to a file; without `output` to stdout.

    wanted: the format; None: that of the file's name, else CSV.  query: what narrows the table.
    Raises CommandError.
    """
    chosen = wanted or _format_of(output)
    if output is None:
        _require_readable(chosen, as_json=as_json)
    asked = {"from_" if name == "from" else name: value for name, value in query.items()}
    with (
        failing_clearly(ServiceError, OSError),
        ServiceClient(url) as service,
        written_file(output, overwrite=overwrite) as file,
        TABLES[table](service, motor=motors or None, format=chosen, **asked) as export,
    ):
        size_bytes = export.save(file)
    if output is None:
        return
    if as_json:
        print_document({"table": table, "file": str(output), "format": chosen, "size_bytes": size_bytes})
    else:
        results().print(Text(one_line(f"{output}: {size_bytes} bytes")), soft_wrap=True)


def _format_of(output: Path | None) -> str:
    suffix = "" if output is None else output.suffix.lower().removeprefix(".")
    return suffix if suffix in FORMATS else "csv"


def _require_readable(chosen: str, *, as_json: bool) -> None:
    """Raise CommandError where stdout is no place for the file."""
    if as_json:
        problem = "--json: expected --output FILE with it, for the file itself would go to stdout"
    elif chosen != "csv" and sys.stdout.isatty():
        problem = f"--format {chosen}: expected --output FILE, for a terminal cannot show it"
    else:
        return
    raise CommandError(problem, details={"type": "WrongUse"}, exit_code=WRONG_USE)


@contextmanager
def written_file(output: Path | None, *, overwrite: bool) -> Iterator[BinaryIO]:
    """Open the file that is to be written. It has its name once it is complete. Raises OSError."""
    if output is None:
        yield sys.stdout.buffer
        sys.stdout.buffer.flush()
        return
    if not overwrite and output.exists():
        raise FileExistsError(f"{output}: there is such a file; --overwrite replaces it")
    part = output.with_name(f".{output.name[:100]}.{uuid4().hex}.part")
    try:
        with part.open("xb") as file:
            yield file
        part.replace(output)
    finally:
        part.unlink(missing_ok=True)
