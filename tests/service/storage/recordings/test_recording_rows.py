import pytest

from core.units import NANOSECONDS_PER_DAY
from service.recording_store.recording import StoredRecording
from service.recording_store.store import RecordingStore
from service.storage import NotFoundError, Repository
from service.storage.records import ClockNote, ClockReading, RecordingEntry, RemoteRecord
from service.storage.states import ClockQuality, RecordingRequestState, RecordingState
from testing.service.findings import findings_of
from testing.service.job_runner import RUNNER
from testing.service.plants import NOW_NS, SECOND_NS, fault

REMOTE = RemoteRecord("C_0001", 11, NOW_NS)
TOUCHED = RemoteRecord(REMOTE.name, REMOTE.size_bytes, REMOTE.modified_ns + 5)


def known(repository: Repository) -> set[RemoteRecord]:
    """Those of both that came to an end."""
    recordings = repository.remote_recordings("A1_SEL710", [REMOTE, TOUCHED])
    return {remote for remote, entry in recordings.items() if entry.state is not RecordingState.ANNOUNCED}


def refused_ones(repository: Repository) -> set[RemoteRecord]:
    """Those of the known ones that never came into the store."""
    recordings = repository.remote_recordings("A1_SEL710", known(repository))
    return {remote for remote, entry in recordings.items() if entry.digest is None}


def record(store: RecordingStore, content: bytes = b"samples") -> StoredRecording:
    return store.store({"C_0001.CFG": b"config", "C_0001.DAT": content})


def test_a_pulled_record_is_stored_and_queued_with_its_recording_request(
    repository: Repository, store: RecordingStore
) -> None:
    request = repository.request_recording("PUMP-A1", now_ns=NOW_NS)
    repository.mark_triggered(request.id, now_ns=NOW_NS)
    announced = repository.announce_recording("A1_SEL710", "PUMP-A1", REMOTE, now_ns=NOW_NS)
    assert announced.state is RecordingState.ANNOUNCED
    assert not known(repository)

    stored = record(store)
    added = repository.add_recording(
        stored,
        motor="PUMP-A1",
        relay="A1_SEL710",
        remote=REMOTE,
        recording_request_id=request.id,
        now_ns=NOW_NS + 1,
    )
    assert added.created
    assert (added.recording.id, added.recording.state) == (announced.id, RecordingState.FETCHED)
    assert known(repository) == {REMOTE}
    assert not refused_ones(repository)
    assert repository.recording_request(request.id).state is RecordingRequestState.FETCHED
    assert repository.recording_request(request.id).recording_id == announced.id
    files = [(f.name, f.size_bytes, f.sha256) for f in repository.recording_files(announced.id)]
    assert files == [(f.name, f.size_bytes, f.sha256) for f in stored.files]
    claimed = repository.claim_job(now_ns=NOW_NS + 1, runner=RUNNER)
    assert claimed is not None
    assert (claimed.motor, claimed.digest) == ("PUMP-A1", stored.digest)


def test_pulled_twice_stored_once(repository: Repository, store: RecordingStore) -> None:
    first, again = (
        repository.add_recording(
            record(store), motor="PUMP-A1", relay="A1_SEL710", remote=REMOTE, now_ns=NOW_NS + i
        )
        for i in range(2)
    )
    assert (first.created, again.created) == (True, False)
    assert first.recording == again.recording
    assert len(repository.jobs(first.recording.id, limit=10).items) == 1


def test_the_same_content_under_another_time_stamp_is_the_same_recording(
    repository: Repository, store: RecordingStore
) -> None:
    first = repository.add_recording(
        record(store), motor="PUMP-A1", relay="A1_SEL710", remote=REMOTE, now_ns=NOW_NS
    )
    repository.announce_recording("A1_SEL710", "PUMP-A1", TOUCHED, now_ns=NOW_NS)
    again = repository.add_recording(
        record(store), motor="PUMP-A1", relay="A1_SEL710", remote=TOUCHED, now_ns=NOW_NS
    )
    assert again.recording.id == first.recording.id
    assert known(repository) == {REMOTE, TOUCHED}
    assert len(repository.recordings(limit=10).items) == 1, "the announcement it replaced is gone"


def test_other_content_under_the_same_listing_is_another_recording(
    repository: Repository, store: RecordingStore
) -> None:
    ids = {
        repository.add_recording(
            record(store, content), motor="PUMP-A1", relay="A1_SEL710", remote=REMOTE, now_ns=NOW_NS
        ).recording.id
        for content in (b"samples", b"SAMPLES")
    }
    assert len(ids) == 2


def test_a_recording_diagnosed_before_ends_a_request_that_gets_it(
    repository: Repository, store: RecordingStore
) -> None:
    repository.add_recording(record(store), motor="PUMP-A1", now_ns=NOW_NS)
    claimed = repository.claim_job(now_ns=NOW_NS, runner=RUNNER)
    assert claimed is not None
    repository.finish_job(
        claimed.job.id, findings_of(fault()), recorded_ns=NOW_NS, now_ns=NOW_NS, runner=RUNNER
    )
    request = repository.request_recording("PUMP-A1", now_ns=NOW_NS)
    repository.add_recording(
        record(store),
        motor="PUMP-A1",
        relay="A1_SEL710",
        remote=REMOTE,
        recording_request_id=request.id,
        now_ns=NOW_NS,
    )
    assert repository.recording_request(request.id).state is RecordingRequestState.DIAGNOSED


def test_a_record_listed_under_a_new_time_is_not_the_one_a_trigger_made(
    repository: Repository, store: RecordingStore
) -> None:
    repository.add_recording(record(store), motor="PUMP-A1", relay="A1_SEL710", remote=REMOTE, now_ns=NOW_NS)
    request = repository.request_recording("PUMP-A1", now_ns=NOW_NS)
    repository.mark_triggered(request.id, now_ns=NOW_NS)
    repository.add_recording(
        record(store),
        motor="PUMP-A1",
        relay="A1_SEL710",
        remote=TOUCHED,
        recording_request_id=request.id,
        now_ns=NOW_NS,
    )
    assert repository.recording_request(request.id).state is RecordingRequestState.TRIGGERED
    assert known(repository) == {REMOTE, TOUCHED}


def test_a_refused_record_is_not_pulled_again(repository: Repository) -> None:
    request = repository.request_recording("PUMP-A1", now_ns=NOW_NS)
    assert repository.note_failed_pull("A1_SEL710", "PUMP-A1", REMOTE, "timeout", now_ns=NOW_NS) == 1
    assert repository.note_failed_pull("A1_SEL710", "PUMP-A1", REMOTE, "timeout", now_ns=NOW_NS) == 2
    assert not known(repository)
    refused = repository.reject_remote_record(
        "A1_SEL710", "PUMP-A1", REMOTE, "larger than 64 MB", recording_request_id=request.id, now_ns=NOW_NS
    )
    assert (refused.state, refused.reason) == (RecordingState.REJECTED, "larger than 64 MB")
    assert known(repository) == {REMOTE}
    assert refused_ones(repository) == {REMOTE}
    assert repository.recording_request(request.id).reason == "larger than 64 MB"
    rejected = repository.recordings(limit=10, state=RecordingState.REJECTED)
    assert [r.id for r in rejected.items] == [refused.id]


def test_records_are_known_by_name_size_and_time(repository: Repository) -> None:
    many = [RemoteRecord(f"C_{number:04}", 11, NOW_NS + number) for number in range(1200)]
    seen = many[::100]
    for remote in seen:
        repository.announce_recording("A1_SEL710", "PUMP-A1", remote, now_ns=NOW_NS)
    found = repository.remote_recordings("A1_SEL710", many)
    assert {remote: entry.name for remote, entry in found.items()} == {each: each.name for each in seen}
    others = [RemoteRecord(each.name, 12, each.modified_ns) for each in seen]
    assert repository.remote_recordings("A1_SEL710", others) == {}
    assert repository.remote_recordings("A2_SEL710", seen) == {}
    assert repository.remote_recordings("A1_SEL710", []) == {}


def test_an_upload_is_one_recording_a_motor(repository: Repository, store: RecordingStore) -> None:
    added = [
        repository.add_recording(record(store), motor=motor, now_ns=NOW_NS)
        for motor in ("PUMP-A1", "PUMP-A1", "FAN-A2")
    ]
    assert [a.created for a in added] == [True, False, True]
    assert added[0].recording.source == "upload"
    assert repository.recordings(limit=10, motor="FAN-A2").items == (added[2].recording,)


# On site, a relay's own software gives a record's files names of its own and no header.
PULLED = {"C_0001.CFG": b"config", "C_0001.DAT": b"samples", "C_0001.HDR": b"summary"}
ON_SITE = {"WEEK 47.CFG": b"config", "WEEK 47.DAT": b"samples"}


def test_an_upload_of_what_was_pulled_is_known(repository: Repository, store: RecordingStore) -> None:
    pulled = repository.add_recording(
        store.store(PULLED), motor="PUMP-A1", relay="A1_SEL710", remote=REMOTE, now_ns=NOW_NS
    )
    uploaded = repository.add_recording(store.store(ON_SITE), motor="PUMP-A1", now_ns=NOW_NS + 1)
    assert (uploaded.created, uploaded.recording) == (False, pulled.recording)
    assert len(repository.jobs(pulled.recording.id, limit=10).items) == 1
    elsewhere = repository.add_recording(store.store(ON_SITE), motor="FAN-A2", now_ns=NOW_NS + 1)
    assert elsewhere.created, "of another motor"


def test_a_pull_of_what_was_uploaded_is_known(repository: Repository, store: RecordingStore) -> None:
    uploaded = repository.add_recording(store.store(ON_SITE), motor="PUMP-A1", now_ns=NOW_NS)
    repository.announce_recording("A1_SEL710", "PUMP-A1", REMOTE, now_ns=NOW_NS + 1)
    pulled = repository.add_recording(
        store.store(PULLED), motor="PUMP-A1", relay="A1_SEL710", remote=REMOTE, now_ns=NOW_NS + 2
    )
    assert (pulled.created, pulled.recording) == (False, uploaded.recording)
    assert repository.recordings(limit=10).items == (uploaded.recording,), "the announcement is gone"
    assert known(repository) == {REMOTE}, "it is not pulled again"


@pytest.mark.parametrize("other", [{"C_0001.DAT": b"SAMPLES"}, {"C_0001.CFG": b"CONFIG"}])
def test_an_upload_that_shares_one_file_with_another_recording(
    repository: Repository, store: RecordingStore, other: dict[str, bytes]
) -> None:
    added = [
        repository.add_recording(store.store(files), motor="PUMP-A1", now_ns=NOW_NS)
        for files in (PULLED, PULLED | other, ON_SITE)
    ]
    assert [a.created for a in added] == [True, True, False]
    assert added[2].recording == added[0].recording


def test_two_records_a_relay_lists_are_two_whatever_they_hold(
    repository: Repository, store: RecordingStore
) -> None:
    second = {f"C_0002{name[6:]}": content for name, content in PULLED.items()}
    for name, files in (("C_0001", PULLED), ("C_0002", second)):
        remote = RemoteRecord(name, 11, NOW_NS)
        repository.add_recording(
            store.store(files), motor="PUMP-A1", relay="A1_SEL710", remote=remote, now_ns=NOW_NS
        )
    assert len(repository.recordings(limit=10).items) == 2


def test_nothing_is_added_when_a_part_fails(repository: Repository, store: RecordingStore) -> None:
    with pytest.raises(NotFoundError, match="there is no event report 'nope'"):
        repository.add_recording(record(store), motor="PUMP-A1", recording_request_id="nope", now_ns=NOW_NS)
    assert repository.recordings(limit=10).items == ()
    assert repository.claim_job(now_ns=NOW_NS, runner=RUNNER) is None
    with pytest.raises(NotFoundError, match="there is no motor 'X'"):
        repository.add_recording(record(store), motor="X", now_ns=NOW_NS)
    with pytest.raises(ValueError, match="relay and remote"):
        repository.add_recording(record(store), motor="PUMP-A1", remote=REMOTE, now_ns=NOW_NS)


OFFSET_NS = 5 * NANOSECONDS_PER_DAY


def stored_with_a_clock(
    repository: Repository, store: RecordingStore, measured_ns: int, announced_ns: int = NOW_NS
) -> RecordingEntry:
    reading = ClockReading(OFFSET_NS, 7, ClockQuality.SYNCHRONISED, measured_ns)
    repository.note_clocks([ClockNote("A1_SEL710", reading)])
    repository.announce_recording("A1_SEL710", "PUMP-A1", REMOTE, now_ns=announced_ns)
    added = repository.add_recording(
        record(store), motor="PUMP-A1", relay="A1_SEL710", remote=REMOTE, now_ns=NOW_NS
    )
    return added.recording


@pytest.mark.parametrize(
    ("measured_s", "announced_s", "given"),
    [(0, 0, True), (-3600, 0, True), (-3601, 0, False), (3601, 0, False), (0, -3601, False)],
)
def test_a_recording_is_given_a_clock_reading_of_its_hour(
    repository: Repository, store: RecordingStore, measured_s: int, announced_s: int, given: bool
) -> None:
    found = stored_with_a_clock(
        repository, store, NOW_NS + measured_s * SECOND_NS, NOW_NS + announced_s * SECOND_NS
    )
    expected = (OFFSET_NS, 7, ClockQuality.SYNCHRONISED, NOW_NS + measured_s * SECOND_NS)
    clock = (
        found.clock_offset_ns,
        found.clock_uncertainty_ns,
        found.clock_quality,
        found.clock_measured_ns,
    )
    assert clock == (expected if given else (None, None, None, None))


@pytest.mark.parametrize(
    ("made_s", "kept"),
    [(0, True), (-14 * 3600, True), (14 * 3600, True), (-86_400, False), (-30 * 86_400, False)],
)
def test_a_record_of_another_day_loses_the_reading(
    repository: Repository, store: RecordingStore, made_s: int, kept: bool
) -> None:
    """It waited in a relay that could not be reached; its times may be local ones."""
    stored = stored_with_a_clock(repository, store, NOW_NS)
    claimed = repository.claim_job(now_ns=NOW_NS, runner=RUNNER)
    assert claimed is not None
    by_the_relay_s_clock_ns = NOW_NS + OFFSET_NS + made_s * SECOND_NS
    repository.finish_job(
        claimed.job.id,
        findings_of(fault()),
        recorded_ns=by_the_relay_s_clock_ns,
        now_ns=NOW_NS,
        runner=RUNNER,
    )
    found = repository.recording(stored.id)
    assert (found.clock_offset_ns, found.clock_quality) == (
        (OFFSET_NS, ClockQuality.SYNCHRONISED) if kept else (None, None)
    )


def test_a_reason_of_any_text_is_kept_as_far_as_it_can_be(repository: Repository) -> None:
    """The names in it come from a relay. PostgreSQL holds no NUL, and UTF-8 no half of a surrogate pair."""
    remote = RemoteRecord("HR_1", 7, NOW_NS)
    strange = "HR\0\ud800_1: expected a .DAT file"
    repository.note_failed_pull("A1_SEL710", "PUMP-A1", remote, strange, now_ns=NOW_NS)
    entry = repository.reject_remote_record("A1_SEL710", "PUMP-A1", remote, strange * 1000, now_ns=NOW_NS)
    assert entry.reason is not None
    assert entry.reason.startswith("HR\ufffd\ufffd_1: expected a .DAT file")
    assert len(entry.reason) < 5000
