"""A deleted recording is gone from everywhere but the list of deletions, and does not come back by itself."""

from pathlib import Path
from threading import Event, Thread

import pytest

from core.diagnosis.verdict import Verdict
from service.collector.records.ledger import RecordLedger
from service.collector.records.life import Life, RecordState
from service.collector.records.listing import ListedRecord
from service.plant import Plant
from service.recording_store.folder import FolderStore
from service.retention.deletion import (
    delete_recording,
    remove_discarded_folder_if_possible,
    remove_discarded_folders,
)
from service.storage import NotFoundError, Repository
from service.storage.errors import FolderGoneError, RecordingInUseError
from service.storage.records import SERVICE, RecordingEntry, RemoteRecord
from service.storage.states import DeletedBy, RecordingRequestState, RecordingState
from service.timing.undo_time import UNDO_NS
from testing.service.findings import findings_of
from testing.service.job_runner import RUNNER
from testing.service.plants import NOW_NS, SECOND_NS, fault, two_motor_plant
from tests.service.collector.records.test_listing import Entry, understood

AFTER_NS = NOW_NS + UNDO_NS + SECOND_NS
"""When no deletion of these tests can be undone any more."""
RELAY, MOTOR = "A1_SEL710", "PUMP-A1"
REMOTE = RemoteRecord("HR_1", 30, NOW_NS)


def pulled(
    repository: Repository, store: FolderStore, name: str = "HR_1", content: bytes = b"samples"
) -> str:
    stored = store.store({f"{name}.CFG": b"config", f"{name}.DAT": content})
    remote = RemoteRecord(name, REMOTE.size_bytes, REMOTE.modified_ns)
    added = repository.add_recording(stored, motor=MOTOR, relay=RELAY, remote=remote, now_ns=NOW_NS)
    return added.recording.id


def diagnose(repository: Repository, recorded_ns: int = NOW_NS) -> None:
    claimed = repository.claim_job(now_ns=2**62, runner=RUNNER)
    assert claimed is not None
    repository.finish_job(
        claimed.job.id, findings_of(fault()), recorded_ns=recorded_ns, now_ns=NOW_NS, runner=RUNNER
    )


def folders(store: FolderStore) -> set[str]:
    """The digests of all folders of the store, also of those that are half removed."""
    return {path.name for path in store.root.glob("*/*") if path.parent.name not in ("incoming",)}


def listed(name: str, modified_ns: int = NOW_NS) -> ListedRecord:
    entries = [Entry(f"{name}.CFG", 10, modified_ns), Entry(f"{name}.DAT", 20, modified_ns)]
    return understood(entries).records[0]


def life(state: RecordState) -> Life:
    return state.life


def test_all_of_it_goes_and_the_trend_and_the_health_follow(
    repository: Repository, store: FolderStore
) -> None:
    first = pulled(repository, store)
    diagnose(repository)
    request = repository.request_recording(MOTOR, now_ns=NOW_NS)
    stored = store.store({"HR_2.CFG": b"config", "HR_2.DAT": b"others"})
    second = repository.add_recording(
        stored,
        motor=MOTOR,
        relay=RELAY,
        remote=RemoteRecord("HR_2", 30, NOW_NS),
        recording_request_id=request.id,
        now_ns=NOW_NS + SECOND_NS,
    ).recording
    diagnose(repository, NOW_NS + SECOND_NS)
    deletion = delete_recording(repository, second.id, "of another motor", now_ns=NOW_NS + 5)
    assert (deletion.id, deletion.name, deletion.digest) == (second.id, "HR_2", stored.digest)
    assert (deletion.reason, deletion.deleted_ns, deletion.deleted_by) == (
        "of another motor",
        NOW_NS + 5,
        DeletedBy.PERSON,
    )
    assert (deletion.state, deletion.verdict) == (RecordingState.DIAGNOSED, Verdict.FAULT)
    assert repository.deletions(limit=10).items == (deletion,)
    assert repository.deletion(second.id) == deletion
    assert [entry.id for entry in repository.recordings(limit=10).items] == [first]
    assert [point.recording_id for point in repository.trend(MOTOR, "mu_f", limit=10).items] == [first]
    health = repository.health(MOTOR)
    assert health.last_recording is not None
    assert health.diagnosis is not None
    assert {health.last_recording.id, health.diagnosis.recording_id} == {first}
    ended = repository.recording_request(request.id)
    assert (ended.state, ended.recording_id) == (RecordingRequestState.DIAGNOSED, None)
    assert ended.reason == f"recording {second.id} was deleted: of another motor"
    remove_discarded_folders(repository, store, AFTER_NS)
    assert folders(store) == {repository.recording(first).digest}
    for ask in (repository.recording, repository.deletion):
        with pytest.raises(NotFoundError):
            ask("nope")
    with pytest.raises(NotFoundError):
        delete_recording(repository, second.id, "again", now_ns=NOW_NS)
    delete_recording(repository, first, "too", now_ns=NOW_NS)
    empty = repository.health(MOTOR)
    assert (empty.diagnosis, empty.last_recording) == (None, None)


def test_a_request_that_waited_for_the_diagnosis_fails_with_the_reason(
    repository: Repository, store: FolderStore
) -> None:
    request = repository.request_recording(MOTOR, now_ns=NOW_NS)
    stored = store.store({"U.CFF": b"samples"})
    added = repository.add_recording(
        stored, motor=MOTOR, recording_request_id=request.id, now_ns=NOW_NS
    ).recording
    delete_recording(repository, added.id, "a test", now_ns=NOW_NS)
    ended = repository.recording_request(request.id)
    assert (ended.state, ended.reason) == (
        RecordingRequestState.FAILED,
        f"recording {added.id} was deleted: a test",
    )
    assert repository.claim_job(now_ns=2**62, runner=RUNNER) is None, "its queued job is gone"


def test_what_is_in_use_is_not_deleted(repository: Repository, store: FolderStore) -> None:
    announced = repository.announce_recording(RELAY, MOTOR, REMOTE, now_ns=NOW_NS)
    with pytest.raises(RecordingInUseError, match="is announced, and its relay still has its files"):
        repository.delete_recording(announced.id, "x", now_ns=NOW_NS)
    ids = [pulled(repository, store, f"HR_{number}") for number in (3, 4, 5)]
    running = repository.claim_job(now_ns=2**62, runner=RUNNER)
    assert running is not None
    with pytest.raises(RecordingInUseError, match=rf"diagnosis {running.job.id} of it is running"):
        repository.delete_recording(running.job.recording_id, "x", now_ns=NOW_NS)
    repository.release_job(running.job.id, runner=RUNNER)
    for _ in ids:
        diagnose(repository)
    repository.set_baseline(
        MOTOR, ids, reason="new winding", by=SERVICE, on_behalf_of="A. Fitter", now_ns=NOW_NS
    )
    with pytest.raises(RecordingInUseError, match=r"part of the baseline of motor PUMP-A1; replace"):
        repository.delete_recording(ids[0], "x", now_ns=NOW_NS)
    repository.delete_baseline(MOTOR, by=SERVICE, now_ns=NOW_NS)
    repository.delete_recording(ids[0], "x", now_ns=NOW_NS)


def test_files_that_another_recording_has_too_stay(repository: Repository, store: FolderStore) -> None:
    both = [
        repository.add_recording(store.store({"U.CFF": b"samples"}), motor=motor, now_ns=NOW_NS).recording
        for motor in (MOTOR, "FAN-A2")
    ]
    delete_recording(repository, both[0].id, "wrong motor", now_ns=NOW_NS)
    remove_discarded_folders(repository, store, AFTER_NS)
    assert folders(store) == {both[1].digest}
    delete_recording(repository, both[1].id, "too", now_ns=NOW_NS)
    remove_discarded_folders(repository, store, AFTER_NS)
    assert folders(store) == set()


def test_an_announced_record_of_a_relay_that_left_the_plant_is_deleted(
    repository: Repository, store: FolderStore
) -> None:
    announced = repository.announce_recording(RELAY, MOTOR, REMOTE, now_ns=NOW_NS)
    repository.register_gateway("ours", host="here", process_id=1, now_ns=NOW_NS)
    repository.share_relays("ours", [RELAY], most=9, problem=None)
    repository.sync_plant(Plant(sites=(), relays=(), motors=()))
    with pytest.raises(RecordingInUseError, match="is announced"):
        delete_recording(repository, announced.id, "its relay is gone", now_ns=NOW_NS)
    repository.give_back_relays("ours", [RELAY])
    deletion = delete_recording(repository, announced.id, "its relay is gone", now_ns=NOW_NS)
    assert (deletion.state, deletion.size_bytes, deletion.digest) == (RecordingState.ANNOUNCED, 0, None)
    assert repository.recordings(limit=10).items == ()
    repository.sync_plant(two_motor_plant())
    (state,) = RecordLedger(RELAY, MOTOR, repository).follow([listed("HR_1")])
    assert life(state) is Life.REFUSED, "it is not pulled, also when the relay comes back"


def test_files_are_removed_by_the_background_when_nobody_may_undo_it_any_more(
    repository: Repository, store: FolderStore
) -> None:
    """Thousands of folders may be waiting: they are its work, not that of one request."""
    ids = [pulled(repository, store, name, name.encode()) for name in ("HR_1", "HR_2", "HR_3")]
    digests = [repository.recording(recording_id).digest for recording_id in ids]
    for recording_id in ids[:2]:
        repository.delete_recording(recording_id, "a test", now_ns=NOW_NS)
    assert digests[1] is not None
    store.set_aside(digests[1])
    delete_recording(repository, ids[2], "a test", now_ns=NOW_NS)
    assert set(repository.discarded_folders()) == set(digests)
    remove_discarded_folders(repository, store, NOW_NS + UNDO_NS)
    assert {path.name for path in store.root.glob("??/*")} == {digests[0], digests[2]}
    assert set(repository.discarded_folders()) == set(digests)
    stopping = Event()
    stopping.set()
    remove_discarded_folders(repository, store, AFTER_NS, stopping)
    assert len(repository.discarded_folders()) == 3, "the service stops"
    remove_discarded_folders(repository, store, AFTER_NS)
    assert repository.discarded_folders() == ()
    assert folders(store) == set()


def test_its_relay_is_not_asked_for_it_again(repository: Repository, store: FolderStore) -> None:
    recording_id = pulled(repository, store)
    ledger = RecordLedger(RELAY, MOTOR, repository)
    record = listed("HR_1")
    assert [state.life for state in ledger.follow([record])] == [Life.STORED]
    delete_recording(repository, recording_id, "a test", now_ns=NOW_NS)
    assert [state.life for state in ledger.follow([record])] == [Life.STORED], "as it has been"
    again = RecordLedger(RELAY, MOTOR, repository)
    (state,) = again.follow([record])
    assert (state.life, state.is_decided) == (Life.DELETED, True)


def test_a_record_whose_time_changed_stays_deleted(repository: Repository, store: FolderStore) -> None:
    """The relay's clock was set: all that it has is listed under other times, and pulled once more."""
    recording_id = pulled(repository, store)
    delete_recording(repository, recording_id, "a test", now_ns=NOW_NS)
    ledger = RecordLedger(RELAY, MOTOR, repository)
    record = listed("HR_1", NOW_NS + 3600 * SECOND_NS)
    (state,) = ledger.follow([record])
    assert life(state) is Life.LISTED
    request = repository.request_recording(MOTOR, now_ns=NOW_NS)
    ledger.announce(state)
    ledger.keep(state, store.store({"HR_1.CFG": b"config", "HR_1.DAT": b"samples"}), request.id)
    assert life(state) is Life.DELETED
    assert repository.recordings(limit=10).items == ()
    ended = repository.recording_request(request.id)
    assert ended.reason == "the relay's record was deleted here: a test"
    remove_discarded_folders(repository, store, AFTER_NS)
    assert folders(store) == set()
    (state,) = RecordLedger(RELAY, MOTOR, repository).follow([record])
    assert life(state) is Life.DELETED, "under this time too"


def test_a_new_record_that_looks_like_a_deleted_one_is_pulled(
    repository: Repository, store: FolderStore
) -> None:
    """Where the relay gives no times."""
    remote = RemoteRecord("HR_1", 30, 0)
    first = repository.add_recording(
        store.store({"HR_1.CFG": b"config", "HR_1.DAT": b"samples"}),
        motor=MOTOR,
        relay=RELAY,
        remote=remote,
        now_ns=NOW_NS,
    ).recording
    delete_recording(repository, first.id, "a test", now_ns=NOW_NS)
    ledger = RecordLedger(RELAY, MOTOR, repository)
    (state,) = ledger.follow([listed("HR_1", 0)])
    assert life(state) is Life.DELETED
    ledger.pull_untimed_again()
    ledger.keep(state, store.store({"HR_1.CFG": b"config", "HR_1.DAT": b"samples"}), None)
    assert life(state) is Life.DELETED
    ledger.pull_untimed_again()
    ledger.keep(state, store.store({"HR_1.CFG": b"config", "HR_1.DAT": b"others!"}), None)
    assert life(state) is Life.STORED
    assert len(repository.recordings(limit=10).items) == 1
    assert repository.deleted_remote_records(RELAY, [remote]) == {}
    (state,) = RecordLedger(RELAY, MOTOR, repository).follow([listed("HR_1", 0)])
    assert life(state) is Life.STORED


def test_a_deleted_recording_can_be_uploaded_again(repository: Repository, store: FolderStore) -> None:
    recording_id = pulled(repository, store)
    delete_recording(repository, recording_id, "a test", now_ns=NOW_NS)
    again = repository.add_recording(
        store.store({"FETCHED.CFG": b"config", "FETCHED.DAT": b"samples"}), motor=MOTOR, now_ns=NOW_NS
    )
    assert again.created
    assert again.recording.id != recording_id
    (state,) = RecordLedger(RELAY, MOTOR, repository).follow([listed("HR_1")])
    assert life(state) is Life.DELETED
    assert [deletion.id for deletion in repository.deletions(limit=10).items] == [recording_id]


def test_a_folder_removed_before_its_row_is_added_is_noticed(
    repository: Repository, store: FolderStore
) -> None:
    recording_id = pulled(repository, store)
    stored = store.store({"HR_1.CFG": b"config", "HR_1.DAT": b"samples"})
    delete_recording(repository, recording_id, "a test", now_ns=NOW_NS)
    remove_discarded_folders(repository, store, AFTER_NS)
    with pytest.raises(FolderGoneError, match="store them again"):
        repository.add_recording(stored, motor=MOTOR, now_ns=NOW_NS)
    stored = store.store({"HR_1.CFG": b"config", "HR_1.DAT": b"samples"})
    assert repository.add_recording(stored, motor=MOTOR, now_ns=NOW_NS).created


def test_uploads_and_deletions_of_the_same_content_lose_no_file(
    repository: Repository, store: FolderStore
) -> None:
    """Whoever comes first: every recording has its folder, and no folder is without one in the end."""
    content = {"HR_1.CFG": b"config", "HR_1.DAT": b"samples"}
    ended = Event()

    def delete_all() -> None:
        while not ended.is_set():
            for entry in repository.recordings(limit=10).items:
                delete_recording(repository, entry.id, "a test", now_ns=NOW_NS)

    deleting = Thread(target=delete_all)
    deleting.start()
    seen: list[RecordingEntry] = []
    for number in range(20):
        try:
            added = repository.add_recording(store.store(content), motor=MOTOR, now_ns=NOW_NS + number)
        except (FolderGoneError, FileNotFoundError):
            continue
        seen.append(added.recording)
    ended.set()
    deleting.join()
    remove_discarded_folders(repository, store, AFTER_NS)
    assert seen
    left = {entry.digest for entry in repository.recordings(limit=10).items}
    assert folders(store) == left


def test_a_known_record_uploaded_with_another_header_leaves_no_folder(
    repository: Repository, store: FolderStore
) -> None:
    known = {"U.CFG": b"config", "U.DAT": b"samples"}
    first = repository.add_recording(store.store(known), motor=MOTOR, now_ns=NOW_NS).recording
    for number in range(3):
        stored = store.store({**known, "U.HDR": bytes([number])})
        assert not repository.add_recording(stored, motor=MOTOR, now_ns=NOW_NS).created
    remove_discarded_folders(repository, store, AFTER_NS)
    assert folders(store) == {first.digest}


def test_a_folder_that_cannot_be_removed_is_removed_later(
    repository: Repository, store: FolderStore, tmp_path: Path
) -> None:
    recording_id = pulled(repository, store)
    in_the_way = store.root / "deleted"
    in_the_way.write_text("a file where a folder is expected")
    delete_recording(repository, recording_id, "a test", now_ns=NOW_NS)
    (digest,) = repository.discarded_folders()
    remove_discarded_folder_if_possible(repository, store, digest, AFTER_NS)
    assert repository.discarded_folders() == (digest,)
    in_the_way.unlink()
    remove_discarded_folders(repository, store, AFTER_NS)
    assert repository.discarded_folders() == ()
    assert folders(store) == set()
