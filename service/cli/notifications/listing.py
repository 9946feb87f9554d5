"""`mcc notify list`, `channels`, `retry`."""

from collections.abc import Mapping, Sequence
from itertools import islice
from typing import Any

from rich.text import Text

from service.cli.output import WRONG_USE, CommandError, failing_clearly, print_document, results
from service.cli.rows import Column, print_rows
from service.client.rest_client import Document, ServiceClient, ServiceError
from service.client.verdicts import local_time, local_times

STATE_COLOURS = {"sent": "green", "dead": "red", "queued": "yellow", "sending": "yellow"}


def list_notifications(
    url: str, *, state: str | None, channel: str | None, alarm: str | None, limit: int, as_json: bool
) -> None:
    """Print messages, latest first, and why those were not sent that were not. Raises CommandError."""
    given = {"state": state, "channel": channel, "alarm": alarm}
    chosen: dict[str, Any] = {name: word for name, word in given.items() if word is not None}
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        found = list(islice(service.list_notifications(limit=min(limit, 1000), **chosen), limit))
    if as_json:
        print_document({"notifications": found})
        return
    columns: Mapping[str, Column] = {
        "time": lambda row: local_time(row["created_time"], seconds=False),
        "state": _state,
        "about": _about,
        "to": _receiver,
        "id": lambda row: str(row["id"]),
    }
    print_rows("notifications", found, (), columns, as_csv=False, as_json=False, whole=("id",))
    for row in found:
        if row["error"]:
            words = f"{str(row['id'])[:8]}: {row['attempts']} attempts: {row['error']}"
            results().print(Text(local_times(words)), soft_wrap=True)


def list_channels(url: str, *, as_json: bool) -> None:
    """Print the channels of the settings, and what waits for them. Raises CommandError."""
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        found = list(service.list_channels())
    if as_json:
        print_document({"channels": found})
        return
    columns = {
        "channel": lambda row: str(row["name"]),
        "kind": lambda row: str(row["kind"]),
        "to": lambda row: ", ".join(_receivers(row)),
        "waiting": lambda row: str(row["waiting"]),
        "given up": lambda row: str(row["given_up"]),
    }
    print_rows("channels", found, (), columns, as_csv=False, as_json=False)


def retry_notifications(url: str, ids: Sequence[str], *, every: bool, as_json: bool) -> None:
    """Have messages tried again that were given up. Raises CommandError."""
    if bool(ids) == every:
        raise CommandError(
            "ID: expected ids of messages, or --all for all that were given up",
            details={"type": "WrongUse"},
            exit_code=WRONG_USE,
        )
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        if every:
            ids = [str(one["id"]) for one in service.list_notifications(state="dead", limit=1000)]
        retried = [service.retry_notification(one) for one in ids]
    if as_json:
        print_document({"notifications": retried})
        return
    number = f"{len(retried)} message{'' if len(retried) == 1 else 's'}"
    results().print(Text(f"{number} tried again; mcc notify list shows what comes of it"))


def _state(row: Document) -> Text:
    state = str(row["state"])
    return Text(state, style=STATE_COLOURS.get(state, ""))


def _about(row: Document) -> str:
    alarms, site = row["alarms"], row["site"]
    number = "" if alarms in (None, 1) or row["kind"] in ("test", "digest") else f" ({alarms})"
    where = "" if site is None else f", {site}"
    return f"{row['kind']}{number}{where}"


def _receiver(row: Document) -> str:
    return f"{row['channel']}: {row['recipient']}" if row["recipient"] else str(row["channel"])


def _receivers(row: Document) -> list[str]:
    found = row["receivers"]
    return [str(one) for one in found] if isinstance(found, list) else []
