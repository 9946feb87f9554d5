"""`mcc recordings`: what recordings the service has, and how one leaves it."""

from itertools import islice
from pathlib import Path
from typing import Any

from rich.text import Text

from core.error_words import one_line
from service.cli.output import failing_clearly, print_document, results
from service.cli.rows import Column, print_rows, require_one_format
from service.client.rest_client import Document, ServiceClient, ServiceError, segment
from service.client.verdicts import local_time, local_times, verdict_text

FIELDS = (
    "recorded_time", "motor", "ied", "source", "name", "state", "operation", "operation_remark", "verdict",
    "reason", "copy_of", "size_bytes",
    "announced_time", "fetched_time", "id",
)  # fmt: skip


def show_recordings(
    url: str,
    motor: str | None,
    state: str | None,
    operation: str | None = None,
    *,
    limit: int,
    as_csv: bool,
    as_json: bool,
) -> None:
    """Print recordings, latest first. Raises CommandError."""
    require_one_format(as_csv=as_csv, as_json=as_json)
    filters = (("motor", motor), ("state", state), ("operation", operation))
    chosen: dict[str, Any] = {name: word for name, word in filters if word is not None}
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        found = list(islice(service.list_recordings(limit=min(limit, 1000), **chosen), limit))
    columns: dict[str, Column] = {
        "recorded": lambda one: local_time(one["recorded_time"] or one["announced_time"]),
        "motor": lambda one: str(one["motor"]),
        "state": _state,
        "name": lambda one: str(one["name"]),
        "id": lambda one: str(one["id"]),
    }
    if motor is not None:
        del columns["motor"]
    print_rows("recordings", found, FIELDS, columns, as_csv=as_csv, as_json=as_json, whole=("id",))
    if not as_csv and not as_json:
        for one in found:
            if one["reason"]:
                words = local_times(f"{one['motor']}, {one['name']}: {one['state']}: {one['reason']}")
                results().print(Text(words), soft_wrap=True)


def download_recording(url: str, recording: str, output: Path | None, *, as_json: bool) -> None:
    """Save a recording's archive; an existing file is left alone. Raises CommandError."""
    with (
        failing_clearly(ServiceError, OSError),
        ServiceClient(url) as service,
        service.download_recording(recording) as archive,
    ):
        name = archive.name or f"{segment(recording)}.zip"
        path = Path(name) if output is None else output / name if output.is_dir() else output
        with path.open("xb") as file:
            size_bytes = archive.save(file)
    if as_json:
        print_document({"recording_id": recording, "file": str(path), "size_bytes": size_bytes})
        return
    results().print(Text(one_line(f"{path}: {size_bytes} bytes")), soft_wrap=True)


def _state(recording: Document) -> Text:
    """Return the state, with the verdict, or with what the motor does where it does not run."""
    state, does, verdict = recording["state"], recording.get("operation"), recording.get("verdict")
    if does not in (None, "running"):
        return Text(f"{state} ({does})")
    return Text(f"{state}: ").append_text(verdict_text(str(verdict))) if verdict else Text(str(state))
