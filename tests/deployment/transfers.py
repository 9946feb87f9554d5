"""What the collector brought from relays, by its log: once each, or the same again.

The API cannot tell, because the database keeps a record that is pulled twice once.
"""

import json
from collections import Counter
from collections.abc import Collection
from dataclasses import dataclass

FIRST, AGAIN = "record stored", "record known already"


@dataclass(frozen=True, slots=True)
class Transfer:
    """One record of a relay, pulled whole."""

    relay: str
    record: str
    recording: str
    is_first: bool


def transfers(log: str) -> list[Transfer]:
    """Those in a service's log; compose commands print a name before each line, or lines between."""
    found = []
    for line in log.splitlines():
        try:
            event = json.loads(line[line.index("{") :])
        except ValueError:
            continue
        if event.get("event") in (FIRST, AGAIN):
            found.append(
                Transfer(event["relay"], event["record"], event["recording"], event["event"] == FIRST)
            )
    return found


def require_once_each(found: Collection[Transfer], recordings: Collection[str]) -> None:
    """Every recording was pulled, and none twice. AssertionError names those that were not, or were."""
    again = [transfer for transfer in found if not transfer.is_first]
    assert not again, f"pulled again: {again}"
    times = Counter(transfer.recording for transfer in found)
    wrong = {recording: times[recording] for recording in recordings if times[recording] != 1}
    assert not wrong, f"times pulled, expected once: {wrong}"
