"""`mcc alarms`: what somebody has to look after."""

from itertools import islice

from rich.padding import Padding
from rich.text import Text

from core.error_words import one_line
from service.cli.output import failing_clearly, results
from service.cli.rows import print_rows, require_one_format
from service.client.rest_client import Document, ServiceClient, ServiceError
from service.client.verdicts import to_the_second

FIELDS = ("raised_time", "cleared_time", "ied", "motor", "kind", "subject", "reason", "advice", "id")


def show_alarms(
    url: str,
    motor: str | None,
    relay: str | None,
    *,
    cleared: bool,
    limit: int,
    as_csv: bool,
    as_json: bool,
) -> None:
    """Print alarms, latest first; without `cleared` those that stand. Raises CommandError."""
    require_one_format(as_csv=as_csv, as_json=as_json)
    chosen = {name: word for name, word in (("motor", motor), ("ied", relay)) if word is not None}
    if not cleared:
        chosen["standing"] = "true"
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        found = list(islice(service.items("/alarms", limit=str(min(limit, 1000)), **chosen), limit))
    if as_csv or as_json or not found:
        print_rows("alarms", found, FIELDS, {}, as_csv=as_csv, as_json=as_json)
        return
    for alarm in found:
        _print_alarm(alarm)


def _print_alarm(alarm: Document) -> None:
    """Print where and what an alarm is, since when, and below it why and what to do."""
    until = "" if alarm["cleared_time"] is None else f", until {to_the_second(alarm['cleared_time'])}"
    since = to_the_second(alarm["raised_time"])
    console = results()
    where = alarm["motor"] or alarm["ied"] or alarm["site"] or "the service"
    console.print(Text(one_line(f"{where}: {alarm['kind']}, since {since}{until}")))
    reason = ": ".join(str(alarm[key]) for key in ("subject", "reason") if alarm[key])
    for words in (reason, alarm.get("advice")):
        if words:
            console.print(Padding(Text(one_line(str(words)), overflow="fold"), (0, 0, 0, 4), expand=False))
