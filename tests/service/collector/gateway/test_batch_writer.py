"""What is written for all relays together arrives once, also where the database is locked meanwhile."""

import sqlite3
import time
from contextlib import closing
from dataclasses import replace

import pytest
from structlog.testing import capture_logs

from service.collector.gateway import batch_writer
from service.collector.gateway.batch_writer import BatchWriter
from service.storage import Repository, connect
from service.storage.records import (
    ClockNote,
    ClockReading,
    LinkNote,
    LinkTraffic,
    RelayFindings,
    ReportPosition,
    Sample,
)
from service.storage.states import ClockQuality, LinkState
from testing.service.links import set_link_state
from testing.service.plants import NOW_NS, SECOND_NS, two_motor_plant
from testing.waiting import eventually
from tests.service.fixtures import database_url, engine

__all__ = ["database_url", "engine"]

RELAY, MOTOR = "A1_SEL710", "PUMP-A1"


@pytest.fixture
def repository(database_url: str) -> Repository:
    repository = Repository(connect(database_url, busy_timeout_s=0.2))
    repository.sync_plant(two_motor_plant())
    set_link_state(repository, RELAY, LinkState.UP, None, now_ns=NOW_NS, traffic=LinkTraffic(connections=1))
    return repository


def note(number: int, *, round_trip_s: float | None = 0.01) -> LinkNote:
    return LinkNote(
        RELAY,
        NOW_NS + number * SECOND_NS,
        LinkTraffic(received_bytes=100, reports=2, report_gaps=1),
        round_trip_s,
        day=7,
        day_bytes=100 * number,
    )


def test_notes_add_up_and_change_no_state(repository: Repository) -> None:
    repository.note_links([note(1), note(2, round_trip_s=None)])
    set_link_state(repository, RELAY, LinkState.DOWN, "refused", now_ns=NOW_NS + 3 * SECOND_NS)
    repository.note_links([note(2)])
    figures = repository.link_figures(RELAY)
    assert (figures.connections, figures.received_bytes, figures.reports, figures.report_gaps) == (
        1,
        300,
        6,
        3,
    )
    assert (figures.round_trip_s, figures.day, figures.day_bytes) == (0.01, 7, 200)
    ied = repository.relay(RELAY)
    assert (ied.link_state, ied.link_reason) == (LinkState.DOWN, "refused"), "a late note revives no link"
    assert ied.last_success_ns == NOW_NS + 2 * SECOND_NS
    repository.note_links([])


def test_a_note_that_waited_gives_no_bytes_of_the_day_back(repository: Repository) -> None:
    set_link_state(
        repository, RELAY, LinkState.DOWN, "cut", now_ns=NOW_NS, traffic=LinkTraffic(), day_bytes=(7, 500)
    )
    repository.note_links([note(2)])
    assert (repository.link_figures(RELAY).day, repository.link_figures(RELAY).day_bytes) == (7, 500)
    repository.note_links([note(6)])
    assert repository.link_figures(RELAY).day_bytes == 600
    repository.note_links([replace(note(1), day=8)])
    assert (repository.link_figures(RELAY).day, repository.link_figures(RELAY).day_bytes) == (8, 100)


def state_note(second: int, state: LinkState, reason: str | None = None) -> LinkNote:
    return LinkNote(
        RELAY,
        NOW_NS + second * SECOND_NS,
        LinkTraffic(connections=1),
        None,
        day=7,
        day_bytes=100,
        state=state,
        reason=reason,
    )


def test_states_of_a_link_are_noted_in_their_order(repository: Repository) -> None:
    repository.note_links(
        [state_note(1, LinkState.DOWN, "cut"), state_note(2, LinkState.UP), note(3)],
    )
    ied = repository.relay(RELAY)
    assert (ied.link_state, ied.link_reason) == (LinkState.UP, None)
    assert (ied.link_changed_ns, ied.last_success_ns) == (NOW_NS + 2 * SECOND_NS, NOW_NS + 3 * SECOND_NS)
    repository.note_links([state_note(4, LinkState.DOWN, "cut")])
    assert repository.relay(RELAY).link_reason == "cut"
    assert repository.link_figures(RELAY).connections == 4
    changes = repository.link_changes(RELAY, limit=10).items
    assert [change.reason for change in changes] == ["cut", None, "cut", None]


def test_the_latest_clock_and_place_in_the_reports_stay(repository: Repository) -> None:
    batches = BatchWriter(repository, period_s=0.05)
    for second, offset_ns in ((3, 30), (2, 20)):
        reading = ClockReading(offset_ns, 1, ClockQuality.SYNCHRONISED, NOW_NS + second * SECOND_NS)
        batches.add_clock(ClockNote(RELAY, reading))
    for entry_id in (b"12345678", b"23456789"):
        batches.add_position(ReportPosition(RELAY, entry_id, "LD/LLN0.BR.A01"))
    batches.start()
    batches.stop(10)
    assert repository.relay(RELAY).clock_offset_ns == 30
    assert repository.entry_id(RELAY, "LD/LLN0.BR.A01") == b"23456789"
    assert repository.entry_id(RELAY, "LD/LLN0.BR.B01") is None


def test_a_locked_database_costs_nothing_and_doubles_nothing(
    repository: Repository, database_url: str
) -> None:
    batches = BatchWriter(repository, period_s=0.05)
    batches.start()
    with closing(sqlite3.connect(database_url.removeprefix("sqlite:///"))) as other:
        other.execute("BEGIN IMMEDIATE")
        for number in range(5):
            batches.add_note(note(number))
            batches.add_sample(Sample(MOTOR, NOW_NS + number, {"ia_A": 1.0}))
        with capture_logs() as logs:
            assert eventually(lambda: any("does not answer" in entry["event"] for entry in logs))
        assert "the database does not answer" in (batches.problem() or "")
        assert repository.link_figures(RELAY).reports == 0
        other.rollback()
    assert eventually(lambda: repository.link_figures(RELAY).reports == 10)
    assert eventually(lambda: batches.problem() is None)
    batches.add_note(note(9))
    batches.stop(10)
    assert repository.link_figures(RELAY).received_bytes == 600, "what is left is written at the end"
    assert len(repository.measurements(MOTOR, 0, limit=100).items) == 5


def test_what_the_database_refuses_holds_up_nothing(repository: Repository) -> None:
    batches = BatchWriter(repository, period_s=0.05)
    batches.start()
    batches.add_sample(Sample("NO-SUCH-MOTOR", NOW_NS, {"ia_A": 1.0}))

    def good_ones_arrive() -> bool:
        batches.add_sample(Sample(MOTOR, time.time_ns(), {"ia_A": 1.0}))
        return bool(repository.measurements(MOTOR, 0, limit=100).items)

    assert eventually(lambda: "lost 1 items, the database refuses them" in (batches.problem() or ""))
    assert eventually(good_ones_arrive)
    assert eventually(lambda: batches.problem() is None)
    batches.stop(10)


def test_beside_refused_items_all_others_are_written_once(repository: Repository) -> None:
    """One value of a motor that is unknown cost all values of a second, of all relays of the gateway."""
    batches = BatchWriter(repository, period_s=0.05)
    for number in range(64):
        motor = "NO-SUCH-MOTOR" if number in (5, 6, 40) else MOTOR
        batches.add_sample(Sample(motor, NOW_NS + number, {"ia_A": 1.0}))
        batches.add_note(replace(note(number), ied="NO-SUCH-RELAY") if number == 63 else note(number))
    batches.start()
    assert eventually(lambda: "lost 3 items, the database refuses them" in (batches.problem() or ""))
    batches.stop(10)
    times = [one.time_ns - NOW_NS for one in repository.measurements(MOTOR, 0, limit=100).items]
    assert times == [number for number in range(64) if number not in (5, 6, 40)]
    assert repository.link_figures(RELAY).reports == 2 * 63


def test_the_latest_of_what_was_found_at_a_relay_stays(repository: Repository) -> None:
    batches = BatchWriter(repository, period_s=0.05)
    for number, relay in enumerate((RELAY, "NO-SUCH-RELAY", RELAY)):
        batches.add_findings(RelayFindings(relay, NOW_NS + number, {"asked": True}, []))
    batches.start()
    assert eventually(lambda: "lost 1 items, the database refuses them" in (batches.problem() or ""))
    batches.stop(10)
    found = repository.relay_findings(RELAY)
    assert found is not None
    assert found.found_ns == NOW_NS + 2


def test_what_is_dropped_is_told_with_its_number(
    repository: Repository, database_url: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(batch_writer, "MOST_UNWRITTEN", 10)
    batches = BatchWriter(repository, period_s=0.05)
    for number in range(25):
        batches.add_sample(Sample(MOTOR, NOW_NS + number, {"ia_A": 1.0}))
    with closing(sqlite3.connect(database_url.removeprefix("sqlite:///"))) as other:
        other.execute("BEGIN IMMEDIATE")
        with capture_logs() as logs:
            batches.start()
            assert eventually(lambda: "does not answer" in (batches.problem() or ""))
        (told,) = [entry for entry in logs if entry["event"].startswith("dropped")]
        assert (told["kind"], told["number"]) == ("measured values", 15)
        other.rollback()
    batches.stop(10)
    assert [one.time_ns - NOW_NS for one in repository.measurements(MOTOR, 0, limit=100).items] == [
        *range(15, 25)
    ]
