"""`mcc alarms`: what somebody has to look after."""

from itertools import islice

from service.cli.output import failing_clearly
from service.cli.rows import print_rows, require_one_format
from service.client.rest_client import ServiceClient, ServiceError
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
    columns = {
        "since": lambda alarm: to_the_second(alarm["raised_time"]),
        "until": lambda alarm: "-" if alarm["cleared_time"] is None else to_the_second(alarm["cleared_time"]),
        "at": lambda alarm: str(alarm["motor"] or alarm["ied"]),
        "alarm": lambda alarm: str(alarm["kind"]),
        "reason": lambda alarm: ": ".join(str(alarm[key]) for key in ("subject", "reason") if alarm[key]),
    }
    if not cleared:
        del columns["until"]
    print_rows("alarms", found, FIELDS, columns, as_csv=as_csv, as_json=as_json)
