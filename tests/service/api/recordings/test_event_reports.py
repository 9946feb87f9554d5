import httpx

from service.plant import Plant
from service.storage import Repository
from testing.service.plants import NOW_NS

POST = "/api/v1/motors/PUMP-A1/event-reports"


def test_a_report_is_accepted_and_can_be_followed(client: httpx.Client, repository: Repository) -> None:
    accepted = client.post(POST)
    assert accepted.status_code == 202
    report = accepted.json()
    assert (report["state"], report["motor"], report["ied"]) == ("requested", "PUMP-A1", "A1_SEL710")
    location = accepted.headers["location"]
    assert location == f"/api/v1/event-reports/{report['id']}"
    assert client.get(location).json() == report

    repository.fail_recording_request(report["id"], "relay A1_SEL710 is down", now_ns=NOW_NS)
    failed = client.get(location).json()
    assert (failed["state"], failed["reason"]) == ("failed", "relay A1_SEL710 is down")
    assert failed["failed_time"] == "2025-10-09T08:53:20.000000000Z"


def test_the_same_key_asks_once(client: httpx.Client) -> None:
    ids = [client.post(POST, headers={"Idempotency-Key": key}).json()["id"] for key in "aab"]
    assert ids[0] == ids[1] != ids[2]
    listed = client.get("/api/v1/event-reports", params={"motor": "PUMP-A1"}).json()["items"]
    assert {report["id"] for report in listed} == set(ids)


def test_unknown_names(client: httpx.Client) -> None:
    assert client.post("/api/v1/motors/NOPE/event-reports").json()["detail"] == "there is no motor 'NOPE'"
    unknown = client.get("/api/v1/event-reports/00000000-0000-0000-0000-000000000000")
    assert unknown.status_code == 404


def test_a_motor_that_left_the_plant_is_refused(client: httpx.Client, repository: Repository) -> None:
    before = client.post(POST, headers={"Idempotency-Key": "a"}).json()
    repository.sync_plant(Plant(sites=(), relays=(), motors=()))
    refused = client.post(POST)
    assert refused.status_code == 409
    assert refused.headers["content-type"] == "application/problem+json"
    assert refused.json()["detail"].startswith(
        "motor PUMP-A1 is out of service: it is not in the plant's files"
    )
    assert client.post(POST, headers={"Idempotency-Key": "a"}).json() == before, "no new wish"
    assert repository.schedule_recording("PUMP-A1", due_ns=NOW_NS, now_ns=NOW_NS) is None
    assert len(client.get("/api/v1/event-reports").json()["items"]) == 1


def test_a_series_is_asked_for_by_its_seconds(client: httpx.Client, repository: Repository) -> None:
    report = client.post(POST, json={"seconds": 10}).json()
    assert (report["seconds"], report["joined_recording_id"], report["joined_remark"]) == (10.0, None, None)
    assert repository.recording_request(report["id"]).seconds == 10.0
    assert client.post(POST).json()["seconds"] is None
    assert client.post(POST, json={"seconds": None}).json()["seconds"] is None


def test_a_series_that_no_relay_could_make_is_refused(client: httpx.Client) -> None:
    for seconds in (0.5, 3600, "ten"):
        assert client.post(POST, json={"seconds": seconds}).status_code == 422
