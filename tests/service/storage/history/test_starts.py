"""What recorded starts show: kept with the diagnosis, replaced by another one, deleted by people alone."""

from dataclasses import replace

import pytest

from core.machines.parameters import Motor
from core.starts.examining import examine_start
from service.recording_store.store import RecordingStore
from service.storage import NotFoundError, Repository
from service.storage.records import Actor
from service.storage.states import DeletedBy
from testing.machines.motors import LARGE, MEDIUM
from testing.machines.starts import StartRecord
from testing.service.plants import NOW_NS, SECOND_NS
from testing.service.starts import START, RecordedStarts

PERSON = Actor("ada", "tests")


@pytest.fixture
def recorded(repository: Repository, store: RecordingStore) -> RecordedStarts:
    return RecordedStarts(repository, store)


def test_starts_are_listed_as_they_were_measured_latest_first(recorded: RecordedStarts) -> None:
    silent = replace(
        START, lowest_voltage_V=None, acceleration_s=None, curve=replace(START.curve, voltage_V=None)
    )
    first, second = recorded.add(START), recorded.add(silent)
    recorded.add(START, motor="FAN-A2")

    entries = recorded.repository.starts("PUMP-A1", limit=10).items

    assert [(entry.recording_id, entry.start) for entry in entries] == [(second, silent), (first, START)]
    assert entries[0].time_ns == NOW_NS + 2 * SECOND_NS
    assert [entry.motor for entry in recorded.repository.starts(limit=10).items] == [
        "FAN-A2", "PUMP-A1", "PUMP-A1",
    ]  # fmt: skip


def test_lists_come_in_pages(recorded: RecordedStarts) -> None:
    ids = [recorded.add(START) for _ in range(3)]
    first = recorded.repository.starts("PUMP-A1", limit=2)
    second = recorded.repository.starts("PUMP-A1", limit=2, after=first.next)
    assert [entry.recording_id for entry in (*first.items, *second.items)] == ids[::-1]
    assert second.next is None


def test_another_diagnosis_replaces_what_was_measured(recorded: RecordedStarts) -> None:
    recording = recorded.add(START)
    slower = replace(START, acceleration_s=2.0)
    recorded.repository.request_diagnosis(recording, now_ns=NOW_NS + 10 * SECOND_NS)
    recorded.diagnose(slower, NOW_NS + SECOND_NS)

    (entry,) = recorded.repository.starts("PUMP-A1", limit=10).items
    assert entry.start == slower


def test_the_reference_is_the_first_whole_starts_from_a_time_on(recorded: RecordedStarts) -> None:
    recorded.add(replace(START, is_from_rest=False, acceleration_s=None))
    recorded.add(replace(START, acceleration_s=None))
    third, fourth = recorded.add(START), recorded.add(START)

    def first_from(second: int) -> list[str]:
        entries = recorded.repository.first_whole_starts("PUMP-A1", from_ns=NOW_NS + second * SECOND_NS)
        return [entry.recording_id for entry in entries]

    both = [third, fourth]
    assert [first_from(second) for second in (0, 3, 4, 5)] == [both, both, [fourth], []]


@pytest.mark.parametrize("motor", [MEDIUM, LARGE], ids=lambda motor: motor.name)
def test_what_the_model_tells_is_kept_as_it_was(recorded: RecordedStarts, motor: Motor) -> None:
    examined = examine_start(StartRecord(snr_db=45.0).of(motor), motor)
    recording_id = recorded.add(examined)

    assert recorded.repository.start("PUMP-A1", recording_id).examined == examined
    with pytest.raises(NotFoundError, match="start"):
        recorded.repository.start("FAN-A2", recording_id)


def test_starts_between_two_times_are_counted(recorded: RecordedStarts) -> None:
    for _ in range(3):
        recorded.add(START)
    times = recorded.repository.times_of_starts("PUMP-A1", from_ns=NOW_NS, to_ns=NOW_NS + 2 * SECOND_NS)
    assert times == [NOW_NS + SECOND_NS, NOW_NS + 2 * SECOND_NS]


def test_figures_that_are_no_numbers_are_not_kept(recorded: RecordedStarts) -> None:
    recorded.add(replace(START, i2t_A2s=float("inf")))
    assert recorded.repository.starts("PUMP-A1", limit=10).items == ()


def test_a_person_deletes_a_start_with_its_recording_and_a_rule_does_not(
    recorded: RecordedStarts, repository: Repository
) -> None:
    wrong, old = recorded.add(START), recorded.add(START)
    repository.delete_recording(wrong, "another motor's", by=PERSON, now_ns=NOW_NS)
    repository.delete_recording(old, "a rule", now_ns=NOW_NS, deleted_by=DeletedBy.RETENTION)
    assert [entry.recording_id for entry in repository.starts("PUMP-A1", limit=10).items] == [old]


def test_there_is_no_such_motor(repository: Repository) -> None:
    with pytest.raises(NotFoundError, match="PUMP-A1"):
        repository.starts("PUMP-A", limit=10)
