"""`mcc alarms figures`: how many alarms a day, the most frequent, chattering and long-standing ones."""

from collections.abc import Mapping, Sequence

from rich.box import SIMPLE_HEAD
from rich.text import Text

from core.error_words import one_line
from service.cli.output import failing_clearly, print_document, results
from service.client.rest_client import Document, ServiceClient, ServiceError
from service.client.tables import FittedTable
from service.client.verdicts import local_time


def show_figures(url: str, *, days: int, as_json: bool) -> None:
    """Print the key figures of the alarms. Raises CommandError."""
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        figures: Document = service.get_alarm_figures(days=days)
    if as_json:
        print_document(figures)
        return
    console = results()
    since = local_time(figures["from_time"])
    console.print(Text(f"{figures['calls_per_day']:.1f} alarms a day since {since}"))
    states = figures["open"]
    if isinstance(states, dict) and states:
        console.print(Text("open: " + ", ".join(f"{number} {state}" for state, number in states.items())))
    busy = [day for day in _documents(figures["days"]) if day["calls"]]
    _print_table("alarms of each day with any", ("day", "alarms"), [[d["date"], d["calls"]] for d in busy])
    for title, key in (
        ("most frequent", "frequent"),
        ("chattering: three times within an hour, so often", "chattering"),
    ):
        rows = [[one["calls"], _where(one), one["kind"], one["subject"]] for one in _documents(figures[key])]
        _print_table(title, ("calls", "where", "what", "subject"), rows)
    long = [
        [local_time(one["raised_time"]), _where(one), one["kind"], one["state"], one["id"]]
        for one in _documents(figures["standing_long"])
    ]
    title = f"standing for longer than a day ({figures['standing_long_in_all']} in all)"
    _print_table(title, ("since", "where", "what", "state", "id"), long)


def _print_table(title: str, headings: Sequence[str], rows: Sequence[Sequence[object]]) -> None:
    if not rows:
        return
    table = FittedTable(title=Text(title), title_justify="left", box=SIMPLE_HEAD, collapse_padding=True)
    for heading in headings:
        table.add_column(heading, no_wrap=heading == "day")
    for row in rows:
        table.add_row(*(Text(one_line(str(cell))) for cell in row))
    results().print(table)


def _where(cause: Mapping[str, object]) -> object:
    return cause["motor"] or cause["ied"] or cause["site"] or "the service"


def _documents(found: object) -> list[Document]:
    return [one for one in found if isinstance(one, dict)] if isinstance(found, list) else []
