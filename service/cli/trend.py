"""`mcc trend`: one figure of a motor for each of its recordings."""

from collections import deque
from typing import Any, Final

from rich.text import Text

from core.quantities import BY_NAME, Quantity, Role, Subject, beside
from core.rotor.finding import RotorState
from service.cli.output import failing_clearly
from service.cli.rows import Column, print_rows, require_one_format
from service.client.conditions import STATE_COLOURS, state_text
from service.client.rest_client import Document, ServiceClient, ServiceError
from service.client.rotor_and_supply import STATES
from service.client.verdicts import local_time, percent, verdict_text

FIELDS: Final = (
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
    query: dict[str, Any] = {"quantity": quantity, "from_": first, "to": end}
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        points = service.get_trend(motor, limit=1000, **query)
        latest = list(deque(points, maxlen=limit))
    print_rows("points", latest, FIELDS, _columns(BY_NAME[quantity]), as_csv=as_csv, as_json=as_json)


def _columns(quantity: Quantity) -> dict[str, Column]:
    columns: dict[str, Column] = {
        "time": lambda point: local_time(point["time"]),
        _heading(quantity): lambda point: _with_interval(point, quantity),
    }
    if Role.DETECTION_LIMIT in beside(quantity.name):
        limit = f"detection limit{_unit(quantity)}"
        columns[limit] = lambda point: _words(point["detection_limit"], quantity)
    if quantity.subject is Subject.STATOR:
        columns["verdict"] = lambda point: verdict_text(str(point["verdict"]))
    elif quantity.subject is Subject.CONDITION:
        columns["stator"] = state_text
    elif quantity.subject is Subject.ROTOR:
        columns["rotor"] = _rotor_state
    columns["recording"] = lambda point: str(point["recording_id"])
    return columns


def _heading(quantity: Quantity) -> str:
    """Return a quantity with its unit. Long names are told in words, for a table wraps between these."""
    unit = _unit(quantity).removeprefix(" ")
    suffix = f"_{unit.lower() if unit == 'Hz' else unit}"
    name = quantity.name
    if quantity.subject not in (Subject.STATOR, Subject.CONDITION):
        name = name.removesuffix(suffix).replace("_", " ")
    return f"{name} {unit}".strip()


def _unit(quantity: Quantity) -> str:
    if quantity.is_in_percent:
        return " %"
    return "" if quantity.unit in ("", "1") else f" {quantity.unit}"


def _with_interval(point: Document, quantity: Quantity) -> str:
    ci95 = point.get("ci95")
    value = _words(point["value"], quantity)
    if not isinstance(ci95, list):
        return value
    return f"{value} [{'..'.join(_words(bound, quantity) for bound in ci95)}]"


def _words(value: object, quantity: Quantity) -> str:
    """Return a figure as people read it."""
    if not isinstance(value, int | float):
        return "-"
    return percent(value) if quantity.is_in_percent else format(value, quantity.written)


def _rotor_state(point: Document) -> Text:
    state = RotorState(str(point["state"]))
    return Text(STATES[state], style=STATE_COLOURS.get(str(state), ""))
