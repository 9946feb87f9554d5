"""`mcc losses`: what a motor loses, and what of it faults and supply cost a year."""

from collections.abc import Iterator, Mapping
from typing import Any

from rich.box import SIMPLE_HEAD

from core.quantity_text import plain, with_unit
from service.cli.output import facts_table, failing_clearly, print_document, results
from service.client.rest_client import ServiceClient, ServiceError
from service.client.tables import FittedTable

NOT_TOLD = "-"


def show_losses(url: str, motor: str, *, as_json: bool) -> None:
    """Print a motor's efficiency by load, and what adds to its losses. Raises CommandError."""
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        losses = service.get_losses(motor)
    if as_json:
        print_document(losses)
        return
    console = results()
    console.print(facts_table(_facts(losses), title=f"{motor}: losses"))
    if losses["efficiencies"]:
        console.print(_efficiencies(losses))
    if losses["causes"]:
        console.print(_causes(losses))


def _facts(losses: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    yield "records", str(losses["records"])
    total_W = losses["losses_W"]
    yield "losses", "not assessed: no record tells them" if total_W is None else with_unit(total_W, "W")
    known = "taken as running all the time: no hours are metered" if losses["duty"] is None else "as metered"
    yield "hours a year", f"{plain(losses['running_hours_per_year'])} h, {known}"
    if losses["records"] and not losses["causes"]:
        yield "added by", "nothing: no fault, and a good supply"


def _efficiencies(losses: Mapping[str, Any]) -> FittedTable:
    table = FittedTable(box=SIMPLE_HEAD, collapse_padding=True)
    table.add_column("shaft power", no_wrap=True)
    for heading in ("efficiency %", "95 % interval", "records"):
        table.add_column(heading, justify="right")
    for one in losses["efficiencies"]:
        low, high = one["efficiency_ci95"]
        at = 10 * one["load_class"]
        table.add_row(
            f"{at} to {at + 10} %",
            f"{100 * one['efficiency']:.1f}",
            f"{100 * low:.1f} to {100 * high:.1f}",
            str(one["records"]),
        )
    return table


def _causes(losses: Mapping[str, Any]) -> FittedTable:
    table = FittedTable(box=SIMPLE_HEAD, collapse_padding=True)
    table.add_column("added by")
    money = f"{losses['currency']} a year".strip()
    for heading in ("W", "kWh a year", money, "growth W a year"):
        table.add_column(heading, justify="right")
    for one in losses["causes"]:
        cost, growth, ends = one["cost_per_year"], one["growth_W_per_year"], one["growth_W_per_year_ci95"]
        table.add_row(
            one["cause"],
            plain(one["loss_W"]),
            plain(one["energy_kWh_per_year"]),
            NOT_TOLD if cost is None else plain(cost),
            NOT_TOLD if growth is None else f"{plain(growth)} [{plain(ends[0])}..{plain(ends[1])}]",
        )
    return table
