"""`mcc starts`: the starts of a motor, why they have changed, and those of a relay's report brought in."""

from collections.abc import Sequence
from itertools import islice
from pathlib import Path

from rich.text import Text

from core.error_words import one_line
from service.cli.output import CommandError, failing_clearly, print_document, results
from service.cli.rows import Column, print_rows, require_one_format
from service.client.rest_client import Document, ServiceClient, ServiceError, segment
from service.client.verdicts import percent, to_the_second

FIELDS = (
    "time", "source", "id", "recording_id", "is_from_rest", "is_reference", "acceleration_s",
    "peak_current_A", "running_current_A", "lowest_voltage_V", "i2t_A2s", "from_report",
    "share_of_hot_limit", "starts_within_hour", "starts_allowed", "load_torque_Nm", "load_torque_Nm_ci95",
    "rotor_state", "comparison",
)  # fmt: skip


TOLD = {
    "added": "a start that was not recorded",
    "joined": "joined with the recording of the same start",
    "known": "was there already",
}
"""What became of a start of a report."""


def show_starts(url: str, motor: str, *, limit: int, as_csv: bool, as_json: bool) -> None:
    """Print the latest starts of a motor, oldest first. Raises CommandError."""
    require_one_format(as_csv=as_csv, as_json=as_json)
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        found = service.items(f"/motors/{segment(motor)}/starts", limit=str(min(limit, 1000)))
        starts = list(islice(found, limit))[::-1]
    columns: dict[str, Column] = {
        "time": lambda one: to_the_second(one["time"]),
        "run-up s": lambda one: _figure(one["acceleration_s"]),
        "peak A": lambda one: _figure(one["peak_current_A"]),
        "lowest V": lambda one: _figure(one["lowest_voltage_V"]),
        "load N m": lambda one: _figure(one["load_torque_Nm"]),
        "heat %": lambda one: percent(one["share_of_hot_limit"]),
        "against the first starts": _told,
        "source": lambda one: str(one["source"]),
        "recording": lambda one: str(one["recording_id"] or "-"),
    }
    print_rows("starts", starts, FIELDS, columns, as_csv=as_csv, as_json=as_json, whole=("recording",))


def import_starts(url: str, motor: str, file: Path, date_order: str, *, as_json: bool) -> None:
    """Give a relay's motor start report to the service. Raises CommandError."""
    if not file.is_file():
        raise CommandError(f"{file}: expected a file", details={"type": "FileNotFound"})
    with failing_clearly(ServiceError, OSError), ServiceClient(url) as service:
        imported = service.import_starts(motor, file.read_bytes(), date_order=date_order)
    if as_json:
        print_document(imported)
        return
    lines = [f"{to_the_second(one['time'])}: {_outcome(one)}" for one in _listed(imported, "starts")]
    left_out = _listed(imported, "left_out")
    lines += [f"{to_the_second(one['time'])}: left out: {one['reason']}" for one in left_out]
    for line in lines or [f"{file.name}: the relay has no start in its report"]:
        results().print(Text(one_line(line)), soft_wrap=True)


def _listed(document: Document, name: str) -> Sequence[Document]:
    found = document[name]
    return found if isinstance(found, list) else []


def _outcome(start: Document) -> str:
    return f"{TOLD[str(start['outcome'])]} ({start['id']})"


def _figure(value: object) -> str:
    return f"{value:.3g}" if isinstance(value, int | float) else "-"


def _told(start: Document) -> str:
    if start["is_reference"]:
        return "reference"
    match start["comparison"]:
        case {"reasons": [*reasons], "state": str(state)}:
            return "; ".join(map(str, reasons)) or state.replace("-", " ")
        case _:
            return "-"
