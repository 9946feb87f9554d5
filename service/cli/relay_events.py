"""`mcc relay-events`: starts, stops and trips of a motor, by its relay's sequences of events."""

from itertools import islice

from service.cli.output import failing_clearly
from service.cli.rows import Column, print_rows, require_one_format
from service.client.rest_client import ServiceClient, ServiceError
from service.client.verdicts import local_time

FIELDS = ("time", "kind")


def show_relay_events(url: str, motor: str, *, limit: int, as_csv: bool, as_json: bool) -> None:
    """Print the latest events of a motor, oldest first. Raises CommandError."""
    require_one_format(as_csv=as_csv, as_json=as_json)
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        found = service.list_relay_events(motor, limit=min(limit, 1000))
        events = list(islice(found, limit))[::-1]
    columns: dict[str, Column] = {
        "time": lambda one: local_time(one["time"]),
        "the relay tells": lambda one: str(one["kind"]),
    }
    print_rows("relay_events", events, FIELDS, columns, as_csv=as_csv, as_json=as_json)
