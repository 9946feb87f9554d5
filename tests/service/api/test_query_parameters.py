"""What is wrong in a query is told, with what was meant: nothing is silently left out."""

import httpx
import pytest

from service.recording_store.store import RecordingStore
from service.storage import Repository
from testing.service.findings import findings_of
from testing.service.job_runner import RUNNER
from testing.service.plants import NOW_NS, fault

TREND = "/api/v1/motors/PUMP-A1/trend"


@pytest.mark.parametrize(
    ("address", "location", "words"),
    [
        (f"{TREND}?quantty=load_level", "query.quantty", "did you mean 'quantity'?"),
        (f"{TREND}?From=2026-01-31", "query.From", "did you mean 'from'?"),
        ("/api/v1/recordings?motr=PUMP-A1", "query.motr", "did you mean 'motor'?"),
        ("/api/v1/recordings?zzz=1", "query.zzz", "known: motor, state,"),
        ("/api/v1/motors/PUMP-A1?health=true", "query.health", "nor any other"),
        ("/api/v1/openapi.json?x=1", "query.x", "nor any other"),
        ("/api/v1/motors?limit=1&limit=2", "query.limit", "found it several times"),
        ("/api/v1/motors?%00%C3%A9=1", "query.\0\xe9", "there is no parameter '\\x00\\xe9'"),
    ],
)
def test_a_parameter_that_does_not_exist_is_refused(
    client: httpx.Client, address: str, location: str, words: str
) -> None:
    answer = client.get(address)
    assert (answer.status_code, answer.headers["content-type"]) == (422, "application/problem+json")
    [error] = answer.json()["errors"]
    assert words in error["message"]
    assert words in answer.json()["detail"]
    assert error["location"] == location


def test_a_parameter_that_does_not_exist_changes_nothing(
    client: httpx.Client, repository: Repository, store: RecordingStore
) -> None:
    added = repository.add_recording(store.store({"E.CFF": b"samples"}), motor="PUMP-A1", now_ns=NOW_NS)
    path = f"/api/v1/recordings/{added.recording.id}"
    assert client.delete(path, params={"reason": "a test", "dry_run": "true"}).status_code == 422
    assert client.get(path).status_code == 200


@pytest.mark.parametrize("path", ["recordings", "deletions", "event-reports", "alarms"])
def test_a_list_of_a_motor_that_there_is_not(client: httpx.Client, path: str) -> None:
    assert client.get(f"/api/v1/{path}", params={"motor": "PUMP-A1"}).json()["items"] == []
    answer = client.get(f"/api/v1/{path}", params={"motor": "PUMP-A9"})
    assert (answer.status_code, answer.headers["content-type"]) == (404, "application/problem+json")


@pytest.mark.parametrize(
    ("path", "words"),
    [
        ("motors/pump-a1", "there is no motor 'pump-a1'; did you mean 'PUMP-A1'?"),
        ("motors/PUMPA1/health", "there is no motor 'PUMPA1'; did you mean 'PUMP-A1'?"),
        ("recordings?motor=Fan-A2", "there is no motor 'Fan-A2'; did you mean 'FAN-A2'?"),
        ("alarms?ied=a1_sel710", "there is no relay 'a1_sel710'; did you mean 'A1_SEL710'?"),
        ("ieds/A1-SEL710", "there is no relay 'A1-SEL710'; did you mean 'A1_SEL710'?"),
        ("motors/nothing-like-it", "there is no motor 'nothing-like-it'"),
    ],
)
def test_the_nearest_name_is_told(client: httpx.Client, path: str, words: str) -> None:
    answer = client.get(f"/api/v1/{path}")
    assert (answer.status_code, answer.json()["detail"]) == (404, words)


@pytest.fixture
def recorded(repository: Repository, store: RecordingStore) -> str:
    """The id of a recording of PUMP-A1 made on 9 October 2025, at 08:53:20 UTC."""
    added = repository.add_recording(store.store({"E.CFF": b"samples"}), motor="PUMP-A1", now_ns=NOW_NS)
    claimed = repository.claim_job(now_ns=NOW_NS, runner=RUNNER)
    assert claimed is not None
    job = claimed.job.id
    repository.finish_job(job, findings_of(fault()), recorded_ns=NOW_NS, now_ns=NOW_NS + 1, runner=RUNNER)
    return added.recording.id


@pytest.mark.parametrize(
    ("window", "number"),
    [
        ({"from": "2025-10-09"}, 1),
        ({"from": "2025-10-10"}, 0),
        ({"to": "2025-10-10"}, 1),
        ({"to": "2025-10-09"}, 0),
        ({"from": "2025-10-09T10:53:20+02:00"}, 1),
        ({"from": "2025-10-09T10:53:21+02:00"}, 0),
    ],
)
@pytest.mark.usefixtures("recorded")
def test_a_date_alone_is_its_beginning(client: httpx.Client, window: dict[str, str], number: int) -> None:
    assert len(client.get(TREND, params=window).json()["items"]) == number


def test_a_plus_in_an_address_is_named(client: httpx.Client) -> None:
    answer = client.get(f"{TREND}?from=2025-10-09T10:53:20+02:00")
    assert answer.status_code == 422
    assert "write %2B" in answer.json()["detail"]
    assert client.get(f"{TREND}?from=2025-10-09T10:53:20%2B02:00").status_code == 200
    for wrong in ("yesterday", "2025-13-01", "2025-10-9", "2025-10-09 10:53"):
        answer = client.get(TREND, params={"from": wrong})
        assert answer.status_code == 422
        assert "%2B" not in answer.json()["detail"]


def test_a_download_is_named_by_motor_and_time(client: httpx.Client, recorded: str) -> None:
    answer = client.get(f"/api/v1/recordings/{recorded}/file")
    assert answer.headers["content-disposition"] == 'attachment; filename="PUMP-A1_2025-10-09T08-53-20Z.zip"'


def test_a_state_and_an_operation_are_not_asked_for_together(client: httpx.Client) -> None:
    answer = client.get("/api/v1/recordings?state=failed&operation=start")
    assert answer.status_code == 422
    assert "expected state or operation, found both" in answer.json()["detail"]
    for either in ("state=failed", "operation=start"):
        assert client.get(f"/api/v1/recordings?{either}").status_code == 200
