"""`mcc trigger`, `mcc motors`, `mcc health`: a running service, asked over its REST API."""

import time
from collections.abc import Mapping

from rich.table import Table
from rich.text import Text

from service.cli.output import CommandError, failing_clearly, print_document, progress, results
from service.rest_client import Document, ServiceClient, ServiceError, segment

ENDED = ("diagnosed", "failed")
POLL_PERIOD_S = 0.25


def trigger_motor(url: str, motor: str, *, wait_s: float, as_json: bool) -> None:
    """Ask for an event report; with `wait_s`, follow it to its end. Raises CommandError."""
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        report = service.request_event_report(motor)
        deadline_s = time.monotonic() + wait_s
        state = report["state"]
        while state not in ENDED and time.monotonic() < deadline_s:
            time.sleep(POLL_PERIOD_S)
            report = service.event_report(str(report["id"]))
            if report["state"] != state:
                state = report["state"]
                progress().print(f"{motor}: {state}")
    if state == "failed":
        raise CommandError(f"{motor}: {report['reason']}", details={"event_report": dict(report)})
    if wait_s and state != "diagnosed":
        raise CommandError(
            f"{motor}: still {state} after {wait_s:g} s", details={"event_report": dict(report)}
        )
    if as_json:
        print_document(report)
    else:
        results().print(Text(f"{motor}: event report {report['id']} {state}"))


def list_motors(url: str, *, as_json: bool) -> None:
    """Print the plant's motors. Raises CommandError."""
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        motors = list(service.items("/motors"))
    if as_json:
        print_document({"motors": motors})
        return
    table = Table()
    for heading in ("site", "motor", "description", "relay"):
        table.add_column(heading)
    for motor in motors:
        table.add_row(
            *(Text(str(motor.get(field) or "")) for field in ("site", "name", "description", "ied"))
        )
    results().print(table)


def show_health(url: str, motor: str, *, as_json: bool) -> None:
    """Print a motor's condition. Raises CommandError."""
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        health = service.get(f"/motors/{segment(motor)}/health")
    if as_json:
        print_document(health)
        return
    table = Table(title=Text(motor), title_justify="left", show_header=False)
    for name, value in _flat(health):
        table.add_row(name, Text(value))
    results().print(table)


def _flat(document: Document, above: str = "") -> list[tuple[str, str]]:
    """Fields of a document and of the documents in it, for people: names in words, nothing that is empty."""
    rows: list[tuple[str, str]] = []
    for name, value in document.items():
        label = f"{above} {name.replace('_', ' ')}".strip()
        if isinstance(value, Mapping):
            rows.extend(_flat(value, label))
        elif isinstance(value, list):
            rows.extend((label, str(item)) for item in value if not isinstance(item, Mapping))
        elif value is not None:
            rows.append((label, str(value)))
    return rows
