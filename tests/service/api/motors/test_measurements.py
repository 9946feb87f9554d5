import httpx

from service.storage import Repository
from service.storage.records import Sample
from testing.service.plants import NOW_NS, SECOND_NS

URL = "/api/v1/motors/PUMP-A1/measurements"


def test_measured_values_over_time(client: httpx.Client, repository: Repository) -> None:
    values = {"ia_A": 7.5, "power_W": 800.0}
    repository.add_samples(Sample("PUMP-A1", NOW_NS + i * 10 * SECOND_NS, values) for i in range(12))
    repository.average_measurements(now_ns=NOW_NS + 600 * SECOND_NS)
    items = client.get(URL).json()["items"]
    assert len(items) == 12
    assert items[0]["time"] == "2025-10-09T08:53:20.000000000Z"
    assert (items[0]["ia_A"], items[0]["power_W"], items[0]["vab_V"], items[0]["samples"]) == (
        7.5,
        800,
        None,
        1,
    )
    window = {"from": items[2]["time"], "to": items[5]["time"]}
    assert client.get(URL, params=window).json()["items"] == items[2:5]
    first = client.get(URL, params={"limit": 7}).json()
    rest = client.get(URL, params={"limit": 7, "cursor": first["next_cursor"]}).json()
    assert first["items"] + rest["items"] == items
    minutes = client.get(URL, params={"step": 60}).json()["items"]
    assert [minute["samples"] for minute in minutes] == [4, 6, 2]
    assert {minute["ia_A"] for minute in minutes} == {7.5}
    assert client.get(URL, params={"step": 61}).status_code == 422
    assert client.get("/api/v1/motors/NOPE/measurements").status_code == 404
