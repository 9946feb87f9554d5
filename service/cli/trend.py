"""`mcc trend`: one figure of a motor for each of its recordings."""

from collections import deque

from rich.text import Text

from service.cli.output import failing_clearly
from service.cli.rows import Column, print_rows, require_one_format
from service.client.conditions import state_text
from service.client.rest_client import Document, ServiceClient, ServiceError, segment
from service.client.verdicts import interval, load, percent, to_the_second, verdict_text

FIELDS = (
    "time", "value", "ci95", "scatter95", "detection_limit", "verdict", "state", "kind", "phase",
    "recording_id",
)  # fmt: skip


def show_trend(
    url: str,
    motor: str,
    quantity: str,
    *,
    first: str | None,
    end: str | None,
    limit: int,
    as_csv: bool,
    as_json: bool,
) -> None:
    """Print the latest points of a trend, oldest first. Raises CommandError."""
    require_one_format(as_csv=as_csv, as_json=as_json)
    window = {name: time for name, time in (("from", first), ("to", end)) if time is not None}
    path = f"/motors/{segment(motor)}/trend"
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        found = service.items(path, quantity=quantity, limit="1000", **window)
        points = list(deque(found, maxlen=limit))
    columns: dict[str, Column] = {
        "time": lambda point: to_the_second(point["time"]),
        quantity if quantity in ("theta_f", "load_level") else f"{quantity} %": lambda point: _value(
            point, quantity
        ),
        "seen from %": lambda point: percent(point["detection_limit"]),
        "verdict": _said,
        "recording": lambda point: str(point["recording_id"]),
    }
    if quantity != "mu_f":
        del columns["seen from %"]
    print_rows("points", points, FIELDS, columns, as_csv=as_csv, as_json=as_json, whole=("recording",))


def _value(point: Document, quantity: str) -> str:
    value = point["value"]
    if quantity == "load_level":
        return load(value, point["ci95"])
    if quantity == "theta_f":
        return "-" if value is None else str(value)
    between = interval(point["ci95"])
    return percent(value) + ("" if between == "-" else f" [{between}]")


def _said(point: Document) -> Text:
    """Return the verdict of the recording, or the condition from it on."""
    if point["verdict"] is None:
        return state_text(point) if point.get("state") else Text("-")
    return verdict_text(str(point["verdict"]))
