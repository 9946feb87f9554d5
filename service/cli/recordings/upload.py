"""`mcc upload`: how a recording enters the service, and what comes of it."""

import time
from collections.abc import Mapping, Sequence
from pathlib import Path

from rich.text import Text

from core.error_words import one_line
from service.cli.output import CommandError, failing_clearly, print_document, results
from service.cli.remote import verdict_line, what_next
from service.client.rest_client import Document, ServiceClient, ServiceError

REFUSED = ("rejected", "failed")
ENDED = ("diagnosed", *REFUSED)
POLL_PERIOD_S = 0.25


def upload_recording(url: str, motor: str, files: Sequence[Path], *, wait_s: float, as_json: bool) -> None:
    """Give the files of one recording to the service and, for at most `wait_s`, wait for its verdict.

    Raises CommandError, also where there is no verdict although it was waited for.
    """
    missing = [str(file) for file in files if not file.is_file()]
    if missing:
        raise CommandError(f"{', '.join(missing)}: expected a file", details={"type": "FileNotFound"})
    with failing_clearly(ServiceError, OSError), ServiceClient(url) as service:
        recording, is_new = service.upload_recording(motor, {file.name: file.read_bytes() for file in files})
        deadline_s = time.monotonic() + wait_s
        while recording["state"] not in ENDED and time.monotonic() < deadline_s:
            time.sleep(POLL_PERIOD_S)
            recording = service.get_recording(recording["id"])
    name = f"{motor}: recording {recording['name']} ({recording['id']})"
    if wait_s:
        _require_verdict(name, recording, wait_s)
    if as_json:
        print_document(recording)
        return
    told = "is queued for its diagnosis" if is_new else f"was there already, {recording['state']}"
    because = f": {recording['reason']}" if recording["reason"] else ""
    results().print(Text(one_line(name if wait_s and is_new else f"{name} {told}{because}")), soft_wrap=True)
    diagnosis = recording["diagnosis"]
    if isinstance(diagnosis, Mapping):
        results().print(verdict_line(motor, diagnosis), soft_wrap=True)
    elif recording["state"] not in ENDED:
        results().print(Text(what_next("mcc upload", motor)), soft_wrap=True)


def _require_verdict(name: str, recording: Document, wait_s: float) -> None:
    """Raise CommandError where a recording was refused, or is not diagnosed yet."""
    state = recording["state"]
    if state == "diagnosed":
        return
    why = f"{state}: {recording['reason']}" if state in REFUSED else f"no verdict within {wait_s:g} s"
    raise CommandError(one_line(f"{name}: {why}"), details={"recording": dict(recording)})
