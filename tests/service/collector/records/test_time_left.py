"""Between the triggers of a series records are fetched as far as they come before the next one."""

from mms import Client
from service.collector.records.directory import RecordDirectory
from service.collector.records.scan import Scan
from tests.service.collector.records.test_memory import client, directory
from tests.service.collector.scripted_relay import ScriptedRelay

__all__ = ["client", "directory"]

OPENING_S = 0.3
"""The relay takes so long to open a file."""


def test_what_would_probably_take_longer_is_left_for_a_later_scan(
    relay: ScriptedRelay, client: Client, directory: RecordDirectory
) -> None:
    def scan(within_s: float) -> Scan:
        return directory.scan(client, lambda _record: None, expected=False, within_s=within_s)

    def names(found: Scan) -> list[str]:
        return [record.name for record in found.waiting]

    relay.opening_s = OPENING_S
    relay.write_record("HR_10001")
    unknown = scan(60.0)
    assert (unknown.taken, names(unknown)) == ((), ["HR_10001"]), "nobody knows how long it takes"
    assert scan(float("inf")).taken == ("HR_10001",)
    relay.write_record("HR_10002")
    assert names(scan(OPENING_S)) == ["HR_10002"]
    assert scan(60.0).taken == ("HR_10002",)
