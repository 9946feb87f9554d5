"""The open alarms of each motor of a plant, as the demo shows them beside the conditions."""

from collections.abc import Mapping, Sequence

from service.client.rest_client import Document, ServiceClient

NONE = "-"

OpenAlarms = Mapping[str, Sequence[Document]]
"""By motor, what to act on first at the top."""


def open_alarms_of(service: ServiceClient) -> OpenAlarms:
    """Return the alarms that are not over, of each motor that has some. Raises ServiceError."""
    found: dict[str, list[Document]] = {}
    for alarm in service.list_open_alarms(limit=1000):
        if isinstance(alarm["motor"], str):
            found.setdefault(alarm["motor"], []).append(alarm)
    return found


def alarm_text(alarms: Sequence[Document]) -> str:
    """Return the alarms of a motor in words: "critical, unacknowledged"; of several the first one."""
    if not alarms:
        return NONE
    first = alarms[0]
    more = f" (+{len(alarms) - 1})" if len(alarms) > 1 else ""
    return f"{first['priority']}, {first['state']}{more}"
