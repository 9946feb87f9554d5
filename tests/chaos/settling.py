"""Waiting until the service has caught up with the plant, for as long as it gets any further."""

import time
from collections.abc import Callable

from service.client.rest_client import ServiceClient, ServiceError
from tests.chaos import account
from tests.chaos.ledger import Ledger
from tests.chaos.plant import ChaosPlant
from tests.chaos.triggers import Triggers

PATIENCE_S = 60.0
"""Without any progress; longer than any time limit among the suite's settings."""

PERIOD_S = 1.0


def open_matters(client: ServiceClient, plant: ChaosPlant, ledger: Ledger, triggers: Triggers) -> list[str]:
    """What is not done yet, one line each. Raises ServiceError."""
    rows = account.rows(client)
    fetched = {(row.relay, row.name) for row in rows if row.is_fetched}
    ended = fetched | {(row.relay, row.name) for row in rows if row.state == "rejected"}
    return [
        *(f"trigger {key} has no answer" for key in triggers.unanswered),
        *links_not_up(client, plant),
        *(f"record {key[0]} {key[1]} is not there" for key in sorted(ledger.complete() - fetched)),
        *(f"half a record {key[0]} {key[1]} is not there" for key in sorted(ledger.listed() - ended)),
        *(
            f"recording {row.relay} {row.name} is {row.state}"
            for row in rows
            if row.state not in account.SETTLED
        ),
        *(
            f"recording request {request.id} of {request.relay} is {request.state}"
            for request in account.requests(client)
            if request.state not in account.ENDED
        ),
    ]


def links_not_up(client: ServiceClient, plant: ChaosPlant) -> list[str]:
    """One line for each relay with files whose link is not up. Raises ServiceError."""
    links = account.links(client)
    offering = [relay.name for relay in plant.relays if relay.profile.files is not None]
    return [f"link of {name} is {' '.join(links[name])}" for name in offering if links[name][0] != "up"]


def settle(
    client: ServiceClient,
    plant: ChaosPlant,
    ledger: Ledger,
    triggers: Triggers,
    tell: Callable[[str], None],
) -> list[str]:
    """Wait until nothing is open, twice in a row. Returns what still is when nothing moves any more."""
    before: list[str] | None = None
    moved_s = time.monotonic()
    while True:
        began_s = time.monotonic()
        ledger.look()
        try:
            matters = open_matters(client, plant, ledger, triggers)
        except ServiceError as error:
            matters = [str(error)]
        if not matters and before == []:
            return []
        if matters != before:
            moved_s = time.monotonic()
        elif time.monotonic() - moved_s > PATIENCE_S:
            return matters
        before = matters
        tell(f"open: {len(matters)}" + (f", such as: {matters[0]}" if matters else ""))
        time.sleep(max(PERIOD_S, 2 * (time.monotonic() - began_s)))  # the machine is for the service
