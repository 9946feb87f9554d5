"""What recordings show of rotor, air gap, load and supply: kept with the diagnosis, replaced, listed."""

from dataclasses import replace

import pytest

from core.rotor.swing_findings import EccentricityFinding
from service.recording_store.store import RecordingStore
from service.storage import NotFoundError, Repository
from service.storage.records import Actor
from service.storage.states import DeletedBy
from testing.service.plants import NOW_NS, SECOND_NS, undiagnosable
from testing.service.rotor_and_supply import (
    BROKEN_ROTOR,
    ECCENTRIC_ROTOR,
    SHORT_RECORD,
    SOUND_ROTOR,
    SUPPLY,
    SWINGING_LOAD,
    ExaminedRecordings,
)

PERSON = Actor("ada", "tests")
AT_REST = replace(
    SUPPLY,
    derating=None,
    line_currents_A=None,
    current_unbalance=None,
    thd_current=None,
    current_harmonics=(),
    active_power_W=None,
    power_factor=None,
    reasons=("no current flows",),
)


@pytest.fixture
def recorded(repository: Repository, store: RecordingStore) -> ExaminedRecordings:
    return ExaminedRecordings(repository, store)


def test_what_records_show_is_listed_as_it_was_found_oldest_first(recorded: ExaminedRecordings) -> None:
    first, second = recorded.add(SOUND_ROTOR, SUPPLY), recorded.add(SHORT_RECORD, AT_REST)
    recorded.add(BROKEN_ROTOR, SUPPLY, motor="FAN-A2")
    repository = recorded.repository

    rotor = repository.rotor_trend("PUMP-A1", limit=10).items
    supply = repository.supply_trend("PUMP-A1", limit=10).items
    assert [(one.recording_id, one.finding) for one in rotor] == [
        (first, SOUND_ROTOR), (second, SHORT_RECORD),
    ]  # fmt: skip
    assert [(one.recording_id, one.figures) for one in supply] == [(first, SUPPLY), (second, AT_REST)]
    assert [one.time_ns - NOW_NS for one in rotor] == [SECOND_NS, 2 * SECOND_NS]
    assert [one.time_ns - NOW_NS for one in supply] == [SECOND_NS, 2 * SECOND_NS]
    assert repository.latest_rotor_findings("PUMP-A1", limit=1) == rotor[1:]
    assert repository.latest_supply("PUMP-A1", limit=1) == supply[1:]


def test_trends_come_in_pages_and_pieces_of_time(recorded: ExaminedRecordings) -> None:
    ids = [recorded.add(SOUND_ROTOR, SUPPLY) for _ in range(3)]
    repository = recorded.repository
    for trend in (repository.rotor_trend, repository.supply_trend):
        first = trend("PUMP-A1", limit=2)
        second = trend("PUMP-A1", limit=2, after=first.next)
        assert [one.recording_id for one in (*first.items, *second.items)] == ids
        assert second.next is None
        piece = trend("PUMP-A1", limit=9, from_ns=NOW_NS + 2 * SECOND_NS, to_ns=NOW_NS + 3 * SECOND_NS)
        assert [one.recording_id for one in piece.items] == [ids[1]]


def test_the_document_of_the_diagnosis_has_both(recorded: ExaminedRecordings) -> None:
    diagnosis = recorded.repository.current_diagnosis(recorded.add(BROKEN_ROTOR, SUPPLY))
    assert diagnosis is not None
    assert diagnosis.document["rotor"] == BROKEN_ROTOR.as_dict()
    assert diagnosis.document["supply"] == SUPPLY.as_dict()


def test_another_diagnosis_replaces_what_was_found(recorded: ExaminedRecordings) -> None:
    recording = recorded.add(SOUND_ROTOR)
    recorded.repository.request_diagnosis(recording, now_ns=NOW_NS + 10 * SECOND_NS)
    recorded.diagnose(BROKEN_ROTOR, SUPPLY, NOW_NS + SECOND_NS)

    (rotor,) = recorded.repository.rotor_trend("PUMP-A1", limit=10).items
    (supply,) = recorded.repository.supply_trend("PUMP-A1", limit=10).items
    assert (rotor.finding, supply.figures) == (BROKEN_ROTOR, SUPPLY)


def test_a_record_of_an_impossible_time_is_in_no_trend(recorded: ExaminedRecordings) -> None:
    recorded.add(SOUND_ROTOR, SUPPLY, left_out="its time lies in the future")
    assert recorded.repository.rotor_trend("PUMP-A1", limit=10).items == ()
    assert recorded.repository.supply_trend("PUMP-A1", limit=10).items == ()


def test_a_record_that_was_refused_tells_nothing_of_the_rotor(recorded: ExaminedRecordings) -> None:
    recorded.add(SHORT_RECORD, AT_REST, diagnosis=undiagnosable())
    assert recorded.repository.rotor_trend("PUMP-A1", limit=10).items == ()
    (entry,) = recorded.repository.supply_trend("PUMP-A1", limit=10).items
    assert entry.figures == AT_REST


def test_a_person_deletes_both_with_the_recording_and_a_rule_does_not(recorded: ExaminedRecordings) -> None:
    repository = recorded.repository
    wrong, old = recorded.add(SOUND_ROTOR, SUPPLY), recorded.add(SOUND_ROTOR, SUPPLY)
    repository.delete_recording(wrong, "another motor's", by=PERSON, now_ns=NOW_NS)
    repository.delete_recording(old, "a rule", now_ns=NOW_NS, deleted_by=DeletedBy.RETENTION)
    for trend in (repository.rotor_trend, repository.supply_trend):
        assert [one.recording_id for one in trend("PUMP-A1", limit=10).items] == [old]


def test_there_is_no_such_motor(repository: Repository) -> None:
    for trend in (repository.rotor_trend, repository.supply_trend):
        with pytest.raises(NotFoundError, match="PUMP-A1"):
            trend("PUMP-A", limit=10)


def test_what_records_show_of_air_gap_and_load_is_a_trend(recorded: ExaminedRecordings) -> None:
    untold = EccentricityFinding.untold("the record holds 3.1 turns of the shaft: too few")
    first = recorded.add(SOUND_ROTOR, eccentricity=ECCENTRIC_ROTOR, pulsation=SWINGING_LOAD)
    second = recorded.add(SHORT_RECORD, eccentricity=untold, pulsation=SWINGING_LOAD)
    recorded.add(SOUND_ROTOR, eccentricity=untold, pulsation=SWINGING_LOAD, left_out="its time lies ahead")
    recorded.add(SOUND_ROTOR, eccentricity=untold, pulsation=SWINGING_LOAD, diagnosis=undiagnosable())
    repository = recorded.repository
    trend = repository.swing_trend("PUMP-A1", limit=10).items
    assert [(one.recording_id, one.eccentricity, one.pulsation) for one in trend] == [
        (first, ECCENTRIC_ROTOR, SWINGING_LOAD),
        (second, untold, SWINGING_LOAD),
    ]
    assert repository.latest_swings("PUMP-A1", limit=1) == trend[1:]
    page = repository.swing_trend("PUMP-A1", limit=1)
    assert repository.swing_trend("PUMP-A1", limit=1, after=page.next).items == trend[1:]


def test_another_diagnosis_or_a_person_takes_what_was_found_of_air_gap_and_load(
    recorded: ExaminedRecordings,
) -> None:
    repository = recorded.repository
    found = {"eccentricity": ECCENTRIC_ROTOR, "pulsation": SWINGING_LOAD}
    again = recorded.add(SOUND_ROTOR, eccentricity=ECCENTRIC_ROTOR, pulsation=SWINGING_LOAD)
    wrong = recorded.add(SOUND_ROTOR, eccentricity=ECCENTRIC_ROTOR, pulsation=SWINGING_LOAD)
    old = recorded.add(SOUND_ROTOR, eccentricity=ECCENTRIC_ROTOR, pulsation=SWINGING_LOAD)
    recorded.diagnose_again(again, SOUND_ROTOR)
    repository.delete_recording(wrong, "another motor's", by=PERSON, now_ns=NOW_NS)
    repository.delete_recording(old, "a rule", now_ns=NOW_NS, deleted_by=DeletedBy.RETENTION)
    now, kept = repository.swing_trend("PUMP-A1", limit=10).items
    assert (now.recording_id, now.eccentricity.permeance_ripple) == (again, None)
    assert (kept.recording_id, {"eccentricity": kept.eccentricity, "pulsation": kept.pulsation}) == (
        old,
        found,
    )
