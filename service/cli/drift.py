"""`mcc drift`: the parameters of a motor, followed while it runs."""

from collections.abc import Iterator, Mapping
from typing import Any

from rich.box import SIMPLE_HEAD

from core.quantity_text import plain
from service.cli.output import facts_table, failing_clearly, print_document, results
from service.client.rest_client import ServiceClient, ServiceError
from service.client.tables import FittedTable

NOT_TOLD = "-"


def show_drift(url: str, motor: str, *, as_json: bool) -> None:
    """Print a motor's parameters, their changes, and what may have made them drift. Raises CommandError."""
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        found = service.get_tracked_parameters(motor)
    if as_json:
        print_document(found)
        return
    console = results()
    console.print(facts_table(_facts(found), title=motor))
    console.print(_parameters(found))
    for reason in _reasons(found):
        console.print(reason, soft_wrap=True)


def _facts(found: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    yield "parameters", found["state"]
    yield "records", str(found["records"])
    yield "what to do", found["advice"]
    if found["reasons"]:
        yield "why", "; ".join(found["reasons"])
    excess = found["winding_excess_K_ci95"]
    if excess is not None:
        yield "winding", f"{excess[0]:.0f} to {excess[1]:.0f} K hotter than its load explains"


def _parameters(found: Mapping[str, Any]) -> FittedTable:
    table = FittedTable(box=SIMPLE_HEAD, collapse_padding=True)
    table.add_column("parameter", no_wrap=True)
    for heading in ("file", "now", "change", "95 % interval"):
        table.add_column(heading, justify="right")
    table.add_column("state")
    for one in found["parameters"]:
        low, high = one["change_ci95"]
        table.add_row(
            _words(one),
            plain(one["reference"]),
            NOT_TOLD if one["value"] is None else plain(one["value"]),
            NOT_TOLD if one["change"] is None else f"{100 * one['change']:+.1f} %",
            f"{100 * low:+.1f} to {100 * high:+.1f} %",
            one["state"],
        )
    return table


def _reasons(found: Mapping[str, Any]) -> Iterator[str]:
    for one in found["parameters"]:
        for reason in one["reasons"]:
            yield f"{_words(one)}: {reason}"


def _words(parameter: Mapping[str, Any]) -> str:
    name, _, unit = parameter["name"].rpartition("_")
    return f"{name.replace('_', ' ')}, {unit}"
