"""What a relay listed before it was triggered: none of it is the record that the trigger is to make."""

from dataclasses import dataclass

from service.collector.records.scan import Scan
from service.storage.records import RemoteRecord


@dataclass(frozen=True, slots=True)
class ListedBefore:
    """Records of before a trigger.

    decided: those that were stored or refused, as they were listed. One of the same name and of another size
    or time is a new record, because relays use names again.  open: names of those that were still being
    written, or could not be fetched; whatever they become, they are from before.
    """

    decided: frozenset[RemoteRecord] = frozenset()
    open: frozenset[str] = frozenset()

    def __contains__(self, record: RemoteRecord) -> bool:
        return record.name in self.open or record in self.decided


def listed_in(scan: Scan) -> ListedBefore:
    """Return what the scan right before a trigger saw."""
    undecided = {*scan.waiting, *scan.held_back, *scan.failing}
    return ListedBefore(scan.listed - undecided, frozenset(record.name for record in undecided))
