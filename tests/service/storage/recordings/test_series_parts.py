"""The recordings of a series count once in their motor's condition, in whatever order they are diagnosed."""

from dataclasses import replace

import pytest

from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.records import RemoteRecord
from service.storage.repository.recordings.series import OF_A_SERIES
from testing.service.findings import findings_of
from testing.service.job_runner import RUNNER
from testing.service.observations import OBSERVATION
from testing.service.plants import NOW_NS, SECOND_NS, healthy

PUMP, RELAY = "PUMP-A1", "A1_SEL710"


def fetched(repository: Repository, store: RecordingStore, name: str, request: str | None = None) -> str:
    """A record of the pump's relay, for a request or not."""
    return repository.add_recording(
        store.store({f"{name}.CFF": name.encode()}),
        motor=PUMP,
        relay=RELAY,
        remote=RemoteRecord(f"{name}.CFF", len(name), NOW_NS),
        recording_request_id=request,
        now_ns=NOW_NS,
    ).recording.id


def diagnose(repository: Repository, times_ns: dict[str, int]) -> None:
    """All that waits is diagnosed, in the order of the times given here."""
    claimed = {}
    while (one := repository.claim_job(now_ns=NOW_NS, runner=RUNNER)) is not None:
        claimed[one.job.recording_id] = one.job.id
    for number, (recording, time_ns) in enumerate(times_ns.items()):
        repository.finish_job(
            claimed[recording],
            findings_of(
                healthy(), observation=replace(OBSERVATION, time_ns=time_ns, load_level=0.5 + 0.01 * number)
            ),
            recorded_ns=time_ns,
            now_ns=NOW_NS,
            runner=RUNNER,
        )


def counted(repository: Repository, recordings: list[str]) -> list[str]:
    return [one for one in recordings if repository.observation(one) is not None]


@pytest.mark.parametrize("order", [(0, 1, 2), (2, 1, 0), (1, 0, 2)])
def test_one_of_a_series_counts_and_others_are_left_out_with_the_reason(
    repository: Repository, store: RecordingStore, order: tuple[int, ...]
) -> None:
    request = repository.request_recording(PUMP, now_ns=NOW_NS, seconds=3.0)
    repository.mark_triggered(request.id, now_ns=NOW_NS, triggers=3)
    names = [
        fetched(repository, store, "P0", request.id),
        *(fetched(repository, store, f"P{k}") for k in (1, 2)),
    ]
    diagnose(repository, {names[k]: NOW_NS + k * SECOND_NS for k in order})
    (one,) = counted(repository, names)
    for name in names:
        assert repository.recording(name).reason == (None if name == one else OF_A_SERIES)


def test_recordings_that_are_no_series_all_count(repository: Repository, store: RecordingStore) -> None:
    names = [fetched(repository, store, f"P{k}") for k in range(3)]
    diagnose(repository, {name: NOW_NS + k * SECOND_NS for k, name in enumerate(names)})
    assert counted(repository, names) == names


def test_a_recording_after_a_series_counts(repository: Repository, store: RecordingStore) -> None:
    request = repository.request_recording(PUMP, now_ns=NOW_NS, seconds=3.0)
    repository.mark_triggered(request.id, now_ns=NOW_NS, triggers=3)
    part, later = fetched(repository, store, "P0", request.id), fetched(repository, store, "LATER")
    diagnose(repository, {part: NOW_NS, later: NOW_NS + 60 * SECOND_NS})
    assert counted(repository, [part, later]) == [part, later]
