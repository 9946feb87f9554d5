"""`mcc baseline`: the healthy recordings that a motor is compared with."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from rich.text import Text

from core.error_words import one_line
from service.audit.acting import who_of
from service.cli.output import failing_clearly, print_document, results
from service.cli.rows import print_rows, require_one_format
from service.client.rest_client import Document, ServiceClient, ServiceError
from service.client.verdicts import local_time

if TYPE_CHECKING:
    from statorwatch_client.models import BaselineRequest

FIELDS = ("recorded_time", "motor", "ied", "name", "doubt", "id")


def show_baseline(url: str, motor: str, *, as_csv: bool, as_json: bool) -> None:
    """Print a motor's baseline. Raises CommandError."""
    require_one_format(as_csv=as_csv, as_json=as_json)
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        baseline = service.get_baseline(motor)
    if as_json:
        print_document(baseline)
        return
    doubts = {doubt["recording_id"]: doubt["doubt"] for doubt in _items(baseline, "doubts")}
    rows = [{**one, "doubt": doubts.get(one["id"])} for one in _items(baseline, "recordings")]
    columns = {
        "recorded": lambda one: local_time(one["recorded_time"]),
        "name": lambda one: str(one["name"]),
        "in doubt for": lambda one: str(one["doubt"] or "-"),
        "id": lambda one: str(one["id"]),
    }
    print_rows("baseline", rows, FIELDS, columns, as_csv=as_csv, as_json=False, whole=("id",))
    if not as_csv and rows:
        why = f": {baseline['reason']} ({who_of(baseline)})" if baseline["reason"] else ""
        chosen = one_line(f"chosen {local_time(baseline['chosen_time'])}{why}")
        results().print(Text(chosen), soft_wrap=True)


def set_baseline(
    url: str,
    motor: str,
    recordings: Sequence[str],
    *,
    reason: str | None,
    on_behalf_of: str | None,
    as_json: bool,
) -> None:
    """Replace a motor's baseline. Raises CommandError."""
    wanted: BaselineRequest = {"recording_ids": list(recordings)}
    if reason is not None:
        wanted["reason"] = reason
    if on_behalf_of is not None:
        wanted["on_behalf_of"] = on_behalf_of
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        baseline = service.set_baseline(motor, wanted)
    if as_json:
        print_document(baseline)
        return
    number = len(_items(baseline, "recordings"))
    words = f"{motor}: {number} recordings are its baseline, for diagnoses from now on"
    results().print(Text(one_line(words)), soft_wrap=True)


def drop_baseline(
    url: str, motor: str, *, reason: str | None, on_behalf_of: str | None, as_json: bool
) -> None:
    """Forget a motor's baseline. Raises CommandError."""
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        service.drop_baseline(motor, reason=reason, on_behalf_of=on_behalf_of)
    if as_json:
        print_document({"motor": motor, "recordings": []})
        return
    results().print(Text(one_line(f"{motor}: has no baseline any more")), soft_wrap=True)


def _items(document: Document, name: str) -> list[Mapping[str, object]]:
    items = document[name]
    return [each for each in items if isinstance(each, dict)] if isinstance(items, list) else []
