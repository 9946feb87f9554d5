"""A deletion that is undone leaves the recording as it was: files, times, what its relay lists."""

import pytest

from service.collector.records.ledger import RecordLedger
from service.collector.records.life import Life
from service.recording_store.folder import FolderStore
from service.retention.deletion import delete_recording, remove_discarded_folders, undo_deletion
from service.storage import NotFoundError, Repository
from service.storage.errors import DeletionStaysError
from service.storage.records import Actor, RecordingEntry
from service.storage.states import DeletedBy, RecordingState
from service.timing.undo_time import UNDO_NS
from testing.service.job_runner import RUNNER
from testing.service.plants import NOW_NS, SECOND_NS
from tests.service.retention.test_deletion import MOTOR, RELAY, diagnose, listed, pulled

ANNA = Actor("anna", "10.0.0.7")
LATER_NS = NOW_NS + UNDO_NS


def undo(
    repository: Repository, store: FolderStore, recording_id: str, now_ns: int = LATER_NS
) -> RecordingEntry:
    return undo_deletion(repository, store, recording_id, by=ANNA, now_ns=now_ns)


def test_it_is_there_again_as_it_was_and_is_diagnosed(repository: Repository, store: FolderStore) -> None:
    recording_id = pulled(repository, store)
    diagnose(repository)
    before, files = repository.recording(recording_id), repository.recording_files(recording_id)
    trend = repository.trend(MOTOR, "mu_f", limit=10).items
    delete_recording(repository, recording_id, "a slip", by=ANNA, now_ns=NOW_NS)
    (deletion,) = repository.deleted_by("anna", since_ns=NOW_NS, limit=10)
    assert deletion == repository.deletion(recording_id)
    assert repository.deleted_by("bert", since_ns=NOW_NS, limit=10) == ()
    remove_discarded_folders(repository, store, LATER_NS)
    entry = undo(repository, store, recording_id)
    assert entry == repository.recording(recording_id)
    assert (entry.state, entry.operation) == (RecordingState.FETCHED, None), "its diagnosis says it"
    again = (entry.digest, entry.ied, entry.source, entry.recorded_ns, entry.announced_ns, entry.fetched_ns)
    assert again == (
        before.digest,
        before.ied,
        before.source,
        before.recorded_ns,
        before.announced_ns,
        before.fetched_ns,
    )
    assert repository.recording_files(recording_id) == files
    assert repository.deletions(limit=10).items == ()
    assert repository.trend(MOTOR, "mu_f", limit=10).items == ()
    diagnose(repository)
    assert repository.recording(recording_id) == before
    assert repository.trend(MOTOR, "mu_f", limit=10).items == trend
    remove_discarded_folders(repository, store, LATER_NS + UNDO_NS)
    assert before.digest is not None
    assert {file.name for file in store.find(before.digest).files} == {file.name for file in files}
    assert repository.discarded_folders() == ()


def test_its_relay_is_not_asked_for_it_again(repository: Repository, store: FolderStore) -> None:
    recording_id = pulled(repository, store)
    delete_recording(repository, recording_id, "a slip", by=ANNA, now_ns=NOW_NS)
    record = listed("HR_1")
    ledger = RecordLedger(RELAY, MOTOR, repository)
    assert [state.life for state in ledger.follow([record])] == [Life.DELETED]
    undo(repository, store, recording_id)
    (state,) = RecordLedger(RELAY, MOTOR, repository).follow([record])
    assert (state.life, state.is_decided) == (Life.STORED, True)
    assert [entry.id for entry in repository.recordings(limit=10).items] == [recording_id]


def test_deleted_and_undone_again_and_again_it_can_be_deleted(
    repository: Repository, store: FolderStore
) -> None:
    recording_id = pulled(repository, store)
    for _ in range(2):
        delete_recording(repository, recording_id, "a slip", by=ANNA, now_ns=NOW_NS)
        undo(repository, store, recording_id)
    delete_recording(repository, recording_id, "for good", by=ANNA, now_ns=NOW_NS)
    remove_discarded_folders(repository, store, LATER_NS + SECOND_NS)
    assert list(store.root.glob("??/*")) == []


def test_one_whose_content_came_again_stays_deleted(repository: Repository, store: FolderStore) -> None:
    recording_id = pulled(repository, store)
    delete_recording(repository, recording_id, "a slip", by=ANNA, now_ns=NOW_NS)
    files = {"HR_1.CFG": b"config", "HR_1.DAT": b"samples"}
    again = repository.add_recording(store.store(files), motor=MOTOR, now_ns=NOW_NS).recording
    with pytest.raises(DeletionStaysError, match=f"its motor has it again, as recording {again.id}"):
        undo(repository, store, recording_id)
    assert [entry.id for entry in repository.recordings(limit=10).items] == [again.id]


def test_only_what_a_person_deleted_lately_is_undone_and_by_that_person(
    repository: Repository, store: FolderStore
) -> None:
    own, ruled = pulled(repository, store), pulled(repository, store, "HR_2", b"others")
    with pytest.raises(NotFoundError):
        undo(repository, store, own)
    delete_recording(repository, own, "a slip", by=ANNA, now_ns=NOW_NS)
    repository.delete_recording(ruled, "90 days", by=ANNA, now_ns=NOW_NS, deleted_by=DeletedBy.RETENTION)
    remove_discarded_folders(repository, store, NOW_NS)
    assert len(list(store.root.glob("??/*"))) == 1, "what a rule deleted goes at once"
    with pytest.raises(DeletionStaysError, match="a rule of retention deleted it"):
        undo(repository, store, ruled)
    with pytest.raises(DeletionStaysError, match="too long ago"):
        undo(repository, store, own, LATER_NS + 1)
    with pytest.raises(DeletionStaysError, match="only who deleted it"):
        undo_deletion(repository, store, own, by=Actor("bert", "here"), now_ns=NOW_NS)
    assert repository.claim_job(now_ns=2**62, runner=RUNNER) is None
    assert undo(repository, store, own).id == own


def test_it_leaves_an_entry_in_the_audit_trail(repository: Repository, store: FolderStore) -> None:
    recording_id = pulled(repository, store)
    delete_recording(repository, recording_id, "a slip", by=ANNA, now_ns=NOW_NS)
    undo(repository, store, recording_id)
    with repository.audit_trail() as trail:
        latest = list(trail.entries())[-1]
    assert (latest.action, latest.actor, latest.subject) == (
        "recording-deletion-undone",
        "anna",
        recording_id,
    )
