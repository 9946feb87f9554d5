"""`mcc trend`: one figure of a motor for each of its recordings."""

from collections import deque
from collections.abc import Callable, Iterator, Mapping
from typing import Final

from rich.text import Text

from core.rotor.finding import RotorState
from service.cli.output import failing_clearly
from service.cli.rows import Column, print_rows, require_one_format
from service.client.conditions import STATE_COLOURS, state_text
from service.client.rest_client import Document, ServiceClient, ServiceError
from service.client.rotor_and_supply import STATES
from service.client.verdicts import interval, load, local_time, percent, verdict_text

FIELDS = (
    "time", "value", "ci95", "scatter95", "detection_limit", "verdict", "state", "kind", "phase",
    "recording_id",
)  # fmt: skip
LIMITED_SWINGS: Final = ("gap_permeance_ripple", "swing_load_torque")
"""Of these, records tell from when on they would be seen."""
NORMAL_95: Final = 1.96
"""Half of a 95 % interval over the standard deviation."""
ROTOR_SEVERITY: Final = "rotor_severity_dB"
SHARES_OF_SUPPLY: Final = (
    "voltage_deviation", "voltage_unbalance_iec", "voltage_unbalance_nema", "thd_voltage",
    "current_unbalance", "thd_current",
)  # fmt: skip
"""Of what a recording shows of the supply these are told in percent."""
FIGURES_OF_SUPPLY: Final = {
    "frequency_hz": ".3f",
    "harmonic_voltage_factor": ".4f",
    "derating": ".3f",
    "active_power_W": ".4g",
    "power_factor": ".3f",
}
"""The others, and how they are written."""
SWINGS: Final = {
    "gap_permeance_ripple": ("eccentricity", "permeance_ripple"),
    "turn_load_torque": ("eccentricity", "load_torque"),
    "swing_load_torque": ("pulsation", "load_torque"),
    "swing_frequency_hz": ("pulsation", "frequency_hz"),
}
"""Of air gap and load: by the names that exports give them, the part and its figure."""
CHANGES: Final = {
    f"{parameter}_change": parameter
    for parameter in ("stator_resistance", "rotor_resistance", "magnetising_inductance", "leakage_inductance")
}
"""Changes of the parameters while the motor runs, by the names that exports give them."""
SHARES_OF_SWINGS: Final = tuple(name for name in SWINGS if not name.endswith("_hz"))
IN_PERCENT: Final = (
    "mu_f", "condition_level", "change", *SHARES_OF_SUPPLY, *CHANGES, *SHARES_OF_SWINGS,
)  # fmt: skip

LISTS: Final[Mapping[str, Callable[..., Iterator[Document]]]] = {
    "trend": ServiceClient.get_trend,
    "rotor": ServiceClient.list_rotor_trend,
    "parameters": ServiceClient.list_tracked_trend,
    "swings": ServiceClient.list_swing_trend,
    "supply": ServiceClient.list_supply_trend,
}
"""How a service is asked for each list of a motor's figures."""


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
    query: dict[str, str | None] = {"from_": first, "to": end}
    part, point_of = _source(quantity)
    if part == "trend":
        query["quantity"] = quantity
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        found = LISTS[part](service, motor, limit=1000, **query)
        points = [point_of(one) for one in deque(found, maxlen=limit)]
    print_rows("points", points, FIELDS, _columns(quantity), as_csv=as_csv, as_json=as_json)


def _source(quantity: str) -> tuple[str, Callable[[Document], Document]]:
    """Return which list of a motor tells a quantity, and what makes a point of its items."""
    if quantity == ROTOR_SEVERITY:
        return "rotor", _rotor_point
    if quantity in CHANGES:
        return "parameters", lambda one: _change_point(one, CHANGES[quantity])
    if quantity in SWINGS:
        return "swings", lambda one: _swing_point(one, quantity)
    if quantity in (*SHARES_OF_SUPPLY, *FIGURES_OF_SUPPLY):
        return "supply", lambda one: {
            **_place(one),
            "value": one[quantity],
            "reasons": one["reasons"],
        }
    return "trend", lambda one: one


def _rotor_point(one: Document) -> Document:
    return {
        **_place(one),
        "value": one["severity_dB"],
        "ci95": one["severity_dB_ci95"],
        "detection_limit": one["detection_limit_dB"],
        "state": one["state"],
        "reasons": one["reasons"],
    }


def _swing_point(one: Document, quantity: str) -> Document:
    """Return the point of a figure of air gap or load, with its interval where its deviation is told."""
    part, figure = SWINGS[quantity]
    found = one[part]
    figures = found if isinstance(found, Mapping) else {}
    point = {**_place(one), "value": figures.get(figure), "reasons": figures.get("reasons")}
    deviation = figures.get("standard_deviation" if figure == "permeance_ripple" else f"{figure}_deviation")
    value = point["value"]
    if isinstance(value, int | float) and isinstance(deviation, int | float):
        point["ci95"] = [max(0.0, value - NORMAL_95 * deviation), value + NORMAL_95 * deviation]
    if quantity in LIMITED_SWINGS:
        point["detection_limit"] = figures.get("detection_limit")
    return point


def _change_point(one: Document, parameter: str) -> Document:
    found = one[parameter]
    change = found if isinstance(found, Mapping) else {}
    return {**_place(one), "value": change.get("change"), "ci95": change.get("change_ci95")}


def _place(one: Document) -> dict[str, object]:
    return {"time": one["time"], "recording_id": one["recording_id"]}


def _columns(quantity: str) -> dict[str, Column]:
    columns: dict[str, Column] = {
        "time": lambda point: local_time(point["time"]),
        _heading(quantity): lambda point: _value(point, quantity),
    }
    if quantity in ("mu_f", *LIMITED_SWINGS):
        columns["detection limit %"] = lambda point: percent(point["detection_limit"])
    if quantity == ROTOR_SEVERITY:
        columns["detection limit dB"] = lambda point: _decibels(point["detection_limit"])
        columns["rotor"] = _rotor_state
    elif _source(quantity)[0] == "trend":
        columns["verdict"] = _said
    columns["recording"] = lambda point: str(point["recording_id"])
    return columns


def _heading(quantity: str) -> str:
    """Return a quantity with its unit. Long names are told in words, for a table wraps between these."""
    words = quantity if _source(quantity)[0] == "trend" else quantity.replace("_hz", " Hz").replace("_", " ")
    return f"{words} %" if quantity in IN_PERCENT else words


def _value(point: Document, quantity: str) -> str:
    value, ci95 = point["value"], point.get("ci95")
    if quantity == "load_level":
        return load(value, ci95)
    if quantity == ROTOR_SEVERITY:
        return _decibels(value) + (
            f" [{_decibels(ci95[0])}..{_decibels(ci95[1])}]" if isinstance(ci95, list) else ""
        )
    if quantity == "swing_frequency_hz":
        return f"{value:.3f}" if isinstance(value, int | float) else "-"
    if quantity in FIGURES_OF_SUPPLY:
        return format(value, FIGURES_OF_SUPPLY[quantity]) if isinstance(value, int | float) else "-"
    if quantity == "theta_f":
        return "-" if value is None else str(value)
    between = interval(ci95)
    return percent(value) + ("" if between == "-" else f" [{between}]")


def _decibels(value: object) -> str:
    return f"{value:.1f}" if isinstance(value, int | float) else "-"


def _rotor_state(point: Document) -> Text:
    state = RotorState(str(point["state"]))
    return Text(STATES[state], style=STATE_COLOURS.get(str(state), ""))


def _said(point: Document) -> Text:
    """Return the verdict of the recording, or the condition from it on."""
    if point["verdict"] is None:
        return state_text(point) if point.get("state") else Text("-")
    return verdict_text(str(point["verdict"]))
