"""Many clients that do the same at the same time: one wins, the others get its answer, and none an error."""

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from threading import Barrier

import httpx

from service.recording_store.store import RecordingStore
from service.storage import Repository

KEYS = 40
NAMES = 20


def at_once(posts: Sequence[Callable[[], httpx.Response]]) -> list[httpx.Response]:
    """The answers to requests that are made together."""
    together = Barrier(len(posts))

    def begin(post: Callable[[], httpx.Response]) -> httpx.Response:
        together.wait(30)
        return post()

    with ThreadPoolExecutor(len(posts)) as pool:
        return list(pool.map(begin, posts, timeout=60))


def test_equal_keys_are_one_request(client: httpx.Client, repository: Repository) -> None:
    post = partial(
        client.post, "/api/v1/motors/PUMP-A1/event-reports", headers={"Idempotency-Key": "the same"}
    )
    answers = at_once([post] * KEYS)
    assert {answer.status_code for answer in answers} == {202}
    assert len({answer.text for answer in answers}) == 1
    assert len(repository.recording_requests(limit=100).items) == 1


def test_equal_content_under_many_names_is_one_recording(
    client: httpx.Client, repository: Repository, store: RecordingStore
) -> None:
    answers = at_once(
        [
            partial(
                client.post,
                "/api/v1/recordings",
                data={"motor": "PUMP-A1"},
                files={"files": (f"E{number}.CFF", b"the same samples")},
            )
            for number in range(NAMES)
        ]
    )
    codes = sorted(answer.status_code for answer in answers)
    assert codes == [200] * (NAMES - 1) + [201]
    assert len({answer.json()["id"] for answer in answers}) == 1
    assert len(repository.recordings(limit=100).items) == 1
    assert repository.counts().jobs == {"queued": 1}
