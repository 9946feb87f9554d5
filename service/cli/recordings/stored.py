"""`mcc recordings`, `mcc upload`: what recordings the service has, and how one leaves and enters it."""

from collections.abc import Sequence
from itertools import islice
from pathlib import Path

from rich.text import Text

from service.cli.output import CommandError, failing_clearly, one_line, print_document, results
from service.cli.rows import print_rows, require_one_format
from service.client.rest_client import Document, ServiceClient, ServiceError
from service.client.verdicts import to_the_second

FIELDS = (
    "recorded_time", "motor", "ied", "source", "name", "state", "operation", "operation_remark", "reason",
    "size_bytes",
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
    chosen = {name: word for name, word in filters if word is not None}
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        found = list(islice(service.items("/recordings", limit=str(min(limit, 1000)), **chosen), limit))
    columns = {
        "recorded": lambda one: to_the_second(one["recorded_time"] or one["announced_time"]),
        "motor": lambda one: str(one["motor"]),
        "name": lambda one: str(one["name"]),
        "state": _state,
        "id": lambda one: str(one["id"]),
    }
    print_rows("recordings", found, FIELDS, columns, as_csv=as_csv, as_json=as_json)


def download_recording(url: str, recording: str, output: Path | None, *, as_json: bool) -> None:
    """Save a recording's archive; an existing file is left alone. Raises CommandError."""
    with failing_clearly(ServiceError, OSError), ServiceClient(url) as service:
        name, content = service.download(recording)
        path = Path(name) if output is None else output / name if output.is_dir() else output
        with path.open("xb") as file:
            file.write(content)
    if as_json:
        print_document({"recording_id": recording, "file": str(path), "size_bytes": len(content)})
        return
    results().print(Text(one_line(f"{path}: {len(content)} bytes")), soft_wrap=True)


def upload_recording(url: str, motor: str, files: Sequence[Path], *, as_json: bool) -> None:
    """Give the files of one recording to the service. Raises CommandError."""
    missing = [str(file) for file in files if not file.is_file()]
    if missing:
        raise CommandError(f"{', '.join(missing)}: expected a file", details={"type": "FileNotFound"})
    with failing_clearly(ServiceError, OSError), ServiceClient(url) as service:
        added, is_new = service.upload(motor, {file.name: file.read_bytes() for file in files})
    if as_json:
        print_document(added)
        return
    told = "is queued for its diagnosis" if is_new else f"was there already, {added['state']}"
    words = one_line(f"{motor}: recording {added['name']} ({added['id']}) {told}")
    results().print(Text(words), soft_wrap=True)


def _state(recording: Document) -> str:
    """Return the state, with what the motor does where it does not run, and why nothing came of it."""
    does = recording.get("operation")
    words = str(recording["state"]) + (f" ({does})" if does not in (None, "running") else "")
    return f"{words}: {recording['reason']}" if recording["reason"] else words
