"""`mcc import-report`: what a text report of a motor's relay tells, brought to the service."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, Final

from rich.text import Text

from core.error_words import one_line
from service.cli.output import CommandError, failing_clearly, print_document, results
from service.client.rest_client import ServiceClient, ServiceError
from service.client.verdicts import local_time

TOLD: Final = {
    "added": "a start that was not recorded",
    "joined": "joined with the recording of the same start",
    "known": "was there already",
}
"""What became of a start of a report."""


def import_report(
    url: str, motor: str, file: Path, *, date_order: str, power_unit: str | None, as_json: bool
) -> None:
    """Give a text report of a relay to the service. Raises CommandError."""
    if not file.is_file():
        raise CommandError(f"{file}: expected a file", details={"type": "FileNotFound"})
    query: dict[str, Any] = {"date_order": date_order, "power_unit": power_unit}
    with failing_clearly(ServiceError, OSError), ServiceClient(url) as service:
        found = service.import_report(motor, file.read_bytes(), **query)
    if as_json:
        print_document(found)
        return
    for line in _lines(found, file.name):
        results().print(Text(one_line(line)), soft_wrap=True)


def _lines(found: Mapping[str, Any], name: str) -> Iterator[str]:
    if found["motor_starts"] is not None:
        yield from _starts(found["motor_starts"], name)
    if found["load_profile"] is not None:
        yield from _load(found["load_profile"])
    if found["motor_statistics"] is not None:
        told = found["motor_statistics"]
        what = "kept; mcc load shows them" if told["added"] else "were there already"
        yield f"statistics of {local_time(told['time'])}: {what}"
    if found["events"] is not None:
        yield from _events(found["events"])


def _starts(found: Mapping[str, Any], name: str) -> Iterator[str]:
    for one in found["starts"]:
        yield f"{local_time(one['time'])}: {TOLD[one['outcome']]} ({one['id']})"
    for one in found["left_out"]:
        yield f"{local_time(one['time'])}: left out: {one['reason']}"
    if not found["starts"] and not found["left_out"]:
        yield f"{name}: the relay has no start in its report"


def _load(found: Mapping[str, Any]) -> Iterator[str]:
    yield f"rows of load that were not known: {found['added']}"
    if found["known"]:
        yield f"rows of quarters of an hour that are known already: {found['known']}"
    if found["not_over"]:
        yield f"rows of a quarter of an hour that is not over, or ahead of the time: {found['not_over']}"
    for one in found["left_out"]:
        yield f"column {one['column']}: left out: {one['reason']}"


def _events(found: Mapping[str, Any]) -> Iterator[str]:
    yield f"starts, stops and trips that were not known: {found['added']}"
    if found["known"]:
        yield f"known already: {found['known']}"
    if found["ahead"]:
        yield f"ahead of the time, left out: {found['ahead']}"
    if found["left_out"]:
        yield f"other elements, left out: {', '.join(found['left_out'])}"
