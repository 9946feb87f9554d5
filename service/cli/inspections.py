"""`mcc inspections`: what people found, and how often the service was right."""

from collections.abc import Mapping, Sequence
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, cast

from rich.box import SIMPLE_HEAD
from rich.text import Text

from core.error_words import one_line
from core.terms import phrase
from service.audit.acting import who_of
from service.cli.output import READABLE_WIDTH, failing_clearly, print_document, results
from service.client.rest_client import Document, ServiceClient, ServiceError
from service.client.tables import FittedTable
from service.client.verdicts import local_time

if TYPE_CHECKING:
    from statorwatch_client.models import InspectionRequest

MOST = 1000
NOTHING = "(nothing)"
"""What stands for the kind of a finding that nobody had told."""


def add_inspection(
    url: str, motor: str, said: Mapping[str, str | None], pictures: Sequence[Path], *, as_json: bool
) -> None:
    """Tell what an inspection found, with pictures. Raises CommandError."""
    with failing_clearly(ServiceError, OSError), ServiceClient(url) as service:
        contents = [path.read_bytes() for path in pictures]
        wanted = {name: value for name, value in said.items() if value is not None}
        kept: Document = service.add_inspection(motor, cast("InspectionRequest", wanted))
        for content in contents:
            kept = service.add_inspection_picture(motor, str(kept["id"]), content)
    _print(kept, as_json=as_json)


def withdraw_inspection(url: str, motor: str, inspection: str, reason: str, *, as_json: bool) -> None:
    """Let an inspection count no more. Raises CommandError."""
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        kept = service.withdraw_inspection(motor, inspection, {"reason": reason})
    _print(kept, as_json=as_json)


def list_inspections(url: str, motor: str, *, as_json: bool) -> None:
    """Print what inspections found, latest first. Raises CommandError."""
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        found: list[Document] = list(islice(service.list_inspections(motor), MOST))
    if as_json:
        print_document({"inspections": found})
        return
    table = FittedTable(box=SIMPLE_HEAD, collapse_padding=True)
    table.kept = ("id",)
    for heading in ("time", "said", "found", "by"):
        table.add_column(heading)
    table.add_column("text", max_width=READABLE_WIDTH)
    table.add_column("id", no_wrap=True)
    for one in found:
        gone = "" if one["withdrawn_time"] is None else f" (withdrawn: {one['withdrawn_reason']})"
        table.add_row(
            local_time(one["time"]),
            Text(_kind(one)),
            Text(one_line(_outcome(one))),
            Text(one_line(who_of(one))),
            Text(one_line(f"{one['text']}{gone}")),
            str(one["id"]),
        )
    results().print(table)


def show_figures(url: str, *, as_json: bool) -> None:
    """Print how often inspections found what was said. Raises CommandError."""
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        found = service.get_inspection_figures()
    if as_json:
        print_document(found)
        return
    table = FittedTable(box=SIMPLE_HEAD, collapse_padding=True)
    for heading in ("year", "site", "said"):
        table.add_column(heading)
    for heading in ("confirmed", "other cause", "nothing found", "missed"):
        table.add_column(heading, justify="right")
    for one in found["counts"]:
        numbers = (one["confirmed"], one["other_cause"], one["nothing_found"], one["missed"])
        table.add_row(str(one["year"]), Text(one_line(one["site"])), _kind(one), *map(str, numbers))
    results().print(table)


def _kind(one: Document) -> str:
    return NOTHING if one["kind"] == "none" else phrase(str(one["kind"]))


def _outcome(one: Document) -> str:
    words = phrase(str(one["outcome"]))
    return words if one["cause"] is None else f"{words}: {one['cause']}"


def _print(kept: Document, *, as_json: bool) -> None:
    if as_json:
        print_document(kept)
        return
    state = "kept" if kept["withdrawn_time"] is None else "withdrawn"
    words = (
        f"{kept['motor']}: inspection of {local_time(kept['time'])} is {state}, {kept['pictures']} pictures"
    )
    results().print(Text(one_line(words)), soft_wrap=True)
