"""A triggered record that is hours off its trigger tells of a clock in another time zone."""

from dataclasses import replace

import pytest

from core.time_stamps import nanoseconds
from core.units import NANOSECONDS_PER_HOUR as HOUR_NS
from service.jobs.relay_time import TriggeredRecord, note_relay_time
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.records import RemoteRecord
from testing.service.findings import findings_of
from testing.service.job_runner import RUNNER
from testing.service.plants import healthy
from tests.service.fixtures import database_url, engine, repository, store

__all__ = ["database_url", "engine", "repository", "store"]

TRIGGERED_NS = nanoseconds("2026-07-01T12:00:00Z")
MINUTE_NS = 60 * 10**9


def record(
    minutes: float,
    *,
    time_zone: str | None = None,
    has_time_code: bool = False,
    before_minutes: float | None = None,
) -> TriggeredRecord:
    recorded_ns = TRIGGERED_NS + round(minutes * MINUTE_NS)
    before_ns = None if before_minutes is None else round(before_minutes * MINUTE_NS)
    return TriggeredRecord("R-1", time_zone, recorded_ns, TRIGGERED_NS, has_time_code, before_ns)


@pytest.mark.parametrize(
    ("minutes", "words"),
    [
        (120, "2 h ahead"),
        (120.2, "2 h ahead"),
        (330, "5 h 30 min ahead"),
        (345, "5 h 45 min ahead"),
        (-300, "5 h behind"),
        (14 * 60, "14 h ahead"),
    ],
)
def test_hours_off(minutes: float, words: str) -> None:
    wrong = record(minutes).wrong_zone()
    assert wrong is not None
    assert (
        f", {words}: the relay's clock runs in local time: set time_zone in the [[relay]] table of R-1"
        in wrong
    )
    assert "or the relay's clock to UTC" in wrong
    assert not record(minutes).is_right


@pytest.mark.parametrize("minutes", [0, 0.05, -0.9, 5, -7, 100 * 60, 22])
def test_a_clock_that_is_right_or_wrong_otherwise(minutes: float) -> None:
    assert record(minutes).wrong_zone() is None
    assert record(minutes).is_right == (abs(minutes) < 1)


def test_the_cure_where_a_zone_is_set_or_the_record_tells_one() -> None:
    set_wrong = record(-120, time_zone="Europe/Berlin").wrong_zone()
    assert set_wrong is not None
    assert "the motors file says that its clock runs in Europe/Berlin, and it does not" in set_wrong
    told_wrong = record(120, has_time_code=True).wrong_zone()
    assert told_wrong is not None
    assert "the record itself says how far its times are ahead of UTC, and is wrong" in told_wrong


@pytest.mark.parametrize(
    ("before_minutes", "raised"), [(None, True), (-720, True), (-719, True), (0, False), (-1440, False)]
)
def test_a_clock_that_was_corrected_since_the_record_before_raises_no_alarm(
    repository: Repository, before_minutes: float | None, raised: bool
) -> None:
    relay = repository.motor("PUMP-A1").ied
    off = replace(record(-720, before_minutes=before_minutes), relay=relay)
    note_relay_time(repository, off, TRIGGERED_NS)
    assert bool(repository.standing_alarms(relay)) == raised


def test_the_record_before_is_the_latest_that_the_service_triggered(
    repository: Repository, store: RecordingStore
) -> None:
    relay = repository.motor("PUMP-A1").ied
    assert repository.preceding_offset_ns(relay, 10 * HOUR_NS) is None
    for hours, off_hours in ((1, 5), (2, -12), (4, 7)):
        at_ns = hours * HOUR_NS
        request = repository.request_recording("PUMP-A1", now_ns=at_ns)
        repository.mark_triggered(request.id, now_ns=at_ns)
        repository.add_recording(
            store.store({f"E{hours}.CFF": b"samples %d" % hours}),
            motor="PUMP-A1",
            relay=relay,
            remote=RemoteRecord(f"E{hours}.CFF", 9, at_ns),
            recording_request_id=request.id,
            now_ns=at_ns,
        )
        claimed = repository.claim_job(now_ns=at_ns, runner=RUNNER)
        assert claimed is not None
        recorded_ns = at_ns + off_hours * HOUR_NS
        repository.finish_job(
            claimed.job.id, findings_of(healthy()), recorded_ns=recorded_ns, now_ns=at_ns, runner=RUNNER
        )
    assert repository.preceding_offset_ns(relay, 4 * HOUR_NS) == -12 * HOUR_NS
    assert repository.preceding_offset_ns("A2_SEL710", 4 * HOUR_NS) is None
