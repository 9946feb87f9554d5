"""`mcc load`: how a motor was loaded, by what its relay meters."""

from collections.abc import Iterator, Mapping
from typing import Any

from rich.box import SIMPLE_HEAD

from core.quantity_text import plain
from service.cli.output import facts_table, failing_clearly, print_document, results
from service.client.rest_client import ServiceClient, ServiceError
from service.client.tables import FittedTable
from service.client.verdicts import local_time

NOT_TOLD = "-"


def show_load(url: str, motor: str, *, days: int, as_json: bool) -> None:
    """Print a motor's load profile, hours beyond limits, and how hot it is. Raises CommandError."""
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        load = service.get_load_profile(motor, days=days)
    if as_json:
        print_document(load)
        return
    console = results()
    console.print(facts_table(_facts(load), title=f"{motor}: load of {days} days"))
    for table in _tables(load):
        console.print(table)


def _facts(load: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    yield "running", _hours(load["running_hours"])
    yield "standing", _hours(load["standing_hours"])
    yield "not known", _hours(load["unknown_hours"])
    yield "duty", _percent(load["duty"])
    yield "mean load", _percent(load["mean_load"])
    yield "energy", NOT_TOLD if load["energy_kWh"] is None else f"{plain(load['energy_kWh'])} kWh"
    yield "starts", NOT_TOLD if load["starts"] is None else f"at least {load['starts']}"
    if load["relay_statistics"] is not None:
        yield from _relay(load["relay_statistics"])
    thermal = load["thermal"]
    if thermal is None:
        return
    yield (
        "winding",
        f"{_kelvin(thermal['winding_rise_K'])} above ambient, of a usual motor with such currents",
    )
    used = thermal["relay_capacity_used"]
    if used is not None:
        yield "relay's element 49", f"{100 * used[0]:.0f} to {100 * used[1]:.0f} % of what trips it"
    by_resistance = thermal["from_resistance_K_ci95"]
    if by_resistance is None:
        yield "by resistance", "; ".join(thermal["reasons"])
    else:
        reference = local_time(thermal["reference_time"])
        yield "by resistance", f"{_kelvin(by_resistance)} against the record of {reference}"


def _relay(told: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    until = local_time(told["time"])
    since = f"{local_time(told['since_time'])} to {until}" if told["since_time"] else f"up to {until}"
    yield "relay's statistics", since
    starts = NOT_TOLD if told["starts"] is None else str(told["starts"])
    counted = "" if told["counted_starts"] is None else f"; counted here: {told['counted_starts']}"
    yield "  starts", starts + counted
    hours = told["counted_running_hours"]
    beside = (
        "" if hours is None else f"; measured here: {_hours(hours)} of {_hours(told['known_hours'])} known"
    )
    yield "  running", _hours(told["running_hours"]) + beside
    trips = ", ".join(f"{cause} {number}" for cause, number in told["trips"].items() if number)
    yield "  trips", trips or "none"
    for remark in told["remarks"]:
        yield "  remark", remark


def _tables(load: Mapping[str, Any]) -> Iterator[FittedTable]:
    yield _classes(load)
    yield _limits(load)
    if any(one["records"] for one in load["record_limits"]):
        yield _record_limits(load)


def _classes(load: Mapping[str, Any]) -> FittedTable:
    table = FittedTable(box=SIMPLE_HEAD, collapse_padding=True)
    table.add_column("load", no_wrap=True)
    table.add_column("hours", justify="right")
    table.add_column("energy kWh", justify="right")
    for one in load["classes"]:
        low, high = one["from_level"], one["to_level"]
        ends = f"{100 * low:.0f} % and more" if high is None else f"{100 * low:.0f} to {100 * high:.0f} %"
        table.add_row(ends, plain(one["hours"]), plain(one["energy_kWh"]))
    return table


def _limits(load: Mapping[str, Any]) -> FittedTable:
    table = FittedTable(box=SIMPLE_HEAD, collapse_padding=True)
    table.add_column("beyond a limit")
    for heading in ("hours", "of known", "longest", "worst"):
        table.add_column(heading, justify="right")
    for one in load["limits"]:
        table.add_row(
            one["name"],
            *(plain(one[name]) for name in ("hours", "known_hours", "longest_hours")),
            _percent(one["worst"]),
        )
    return table


def _record_limits(load: Mapping[str, Any]) -> FittedTable:
    table = FittedTable(box=SIMPLE_HEAD, collapse_padding=True)
    table.add_column("records beyond a limit")
    for heading in ("records", "of", "share", "worst"):
        table.add_column(heading, justify="right")
    for one in load["record_limits"]:
        table.add_row(
            one["name"],
            str(one["beyond"]),
            str(one["records"]),
            _percent(one["share"]),
            NOT_TOLD if one["worst"] is None else f"{one['worst']:.4f}",
        )
    return table


def _hours(value: float | None) -> str:
    return NOT_TOLD if value is None else f"{plain(value)} h"


def _percent(share: float | None) -> str:
    return NOT_TOLD if share is None else f"{100 * share:.1f} %"


def _kelvin(ends: list[float] | None) -> str:
    return NOT_TOLD if ends is None else f"{ends[0]:.0f} to {ends[1]:.0f} K"
