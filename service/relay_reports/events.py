"""Sequences of events (SER): starts, stops and trips become marks of the motor."""

from collections.abc import Mapping
from typing import Final

from core.relay_reports import read_sequence_of_events
from service.relay_reports.brought import LATER, BroughtReport
from service.relay_reports.errors import RefusedReportError
from service.relay_reports.kept import KeptEvents
from service.storage import Repository
from service.storage.records import RelayEvent
from service.storage.states import RelayEventKind

ELEMENTS: Final[Mapping[str, RelayEventKind]] = {
    "STARTING": RelayEventKind.START,
    "STOPPED": RelayEventKind.STOP,
    "TRIP": RelayEventKind.TRIP,
}
"""What it means that an element of the relay word is asserted."""
MOST_NAMED: Final = 50


def keep_events(repository: Repository, motor: str, brought: BroughtReport) -> KeptEvents:
    """Keep the starts, stops and trips of a report. Raises ReportError, RefusedReportError."""
    changes = read_sequence_of_events(brought.text, date_order=brought.date_order)
    told = [
        RelayEvent(ELEMENTS[change.element], brought.utc_ns(change.time_ns))
        for change in changes
        if change.asserted and change.element in ELEMENTS
    ]
    events = [event for event in told if not brought.is_ahead(event.time_ns)]
    if told and not events:
        raise RefusedReportError("", f"none of {len(told)} events can be kept: {LATER}")
    added = repository.add_relay_events(motor, events, by=brought.by, now_ns=brought.now_ns)
    others = sorted({change.element for change in changes} - set(ELEMENTS))
    return KeptEvents(
        added=added,
        known=len(set(events)) - added,
        ahead=len(told) - len(events),
        left_out=others[:MOST_NAMED],
    )
