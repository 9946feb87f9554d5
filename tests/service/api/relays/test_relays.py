import httpx

from service.storage import Repository
from service.storage.records import LinkTraffic, RelayFindings
from service.storage.states import AlarmKind, LinkState
from service.timing.backoff import Backoff
from testing.service.links import set_link_state
from testing.service.plants import NOW_NS, SECOND_NS

FIRST = "2025-10-09T08:53:20.000000000Z"
NAME = "A1_SEL710"
URL = f"/api/v1/ieds/{NAME}"


def test_relays_are_listed(client: httpx.Client) -> None:
    assert [ied["name"] for ied in client.get("/api/v1/ieds").json()["items"]] == [NAME, "A2_SEL710"]


def test_a_relay_tells_its_link(client: httpx.Client, repository: Repository) -> None:
    set_link_state(repository, NAME, LinkState.DOWN, "connection refused", now_ns=NOW_NS)
    ied = client.get(URL).json()
    assert (ied["link_state"], ied["link_reason"]) == ("down", "connection refused")
    assert (ied["link_changed_time"], ied["last_success_time"]) == (FIRST, None)
    assert ied["figures"] == {
        "round_trip_s": None,
        "connections": 0,
        "received_bytes": 0,
        "reports": 0,
        "report_gaps": 0,
    }


ACQUISITION = {
    "asked": True,
    "trigger": f"{NAME}CON/RBGGIO1.SPCSO01",
    "trigger_action": "set-reset",
    "control_model": "direct-with-normal-security",
    "record_made": f"{NAME}PRO/FLTRDRE1.RcdMade",
    "record_number": None,
    "records_told_by": "polling",
    "report_control": None,
    "events_directory": "COMTRADE",
    "text_reports": ["CSER", "MSR"],
    "overridden": ["report_control"],
    "remarks": [],
}


def test_a_relay_tells_what_is_used_of_it(client: httpx.Client, repository: Repository) -> None:
    before = client.get(URL).json()
    assert (before["acquisition"], before["differences"], before["ignored_files"]) == (None, [], [])
    missing = {"kind": "logical-node", "expected": "A1_SEL710PRO/FLTRDRE1", "found": None}
    ignored = {"name": "NOTES.TXT", "reason": "no file of a recording"}
    for times in (3, 1):
        findings = RelayFindings(NAME, NOW_NS, ACQUISITION, [missing] * times, [ignored], 7)
        repository.note_findings(findings)
        assert repository.relay_findings(NAME) == findings
    after = client.get(URL).json()
    assert after["acquisition"] == {**ACQUISITION, "found_time": FIRST}
    assert after["differences"] == [missing]
    assert (after["ignored_files"], after["ignored_files_in_all"]) == ([ignored], 7)


def test_a_relay_tells_the_history_of_its_link(client: httpx.Client, repository: Repository) -> None:
    for second in range(30):
        state, reason = (LinkState.DOWN, "refused") if second % 2 else (LinkState.UP, None)
        set_link_state(repository, NAME, state, reason, now_ns=NOW_NS + second * SECOND_NS)
        set_link_state(repository, NAME, state, reason, now_ns=NOW_NS + second * SECOND_NS + 1)
    repository.reset_links(now_ns=NOW_NS + 60 * SECOND_NS, reason="the collector ended")
    everything = client.get(f"{URL}/link-changes").json()["items"]
    assert len(everything) == 31, "only changes count"
    assert everything[0]["reason"] == "the collector ended"
    assert everything[-1] == {"time": FIRST, "state": "up", "reason": None}
    assert client.get(URL).json()["changes"] == everything[:20]
    page = client.get(f"{URL}/link-changes", params={"limit": 30}).json()
    rest = client.get(f"{URL}/link-changes", params={"cursor": page["next_cursor"]}).json()
    assert page["items"] + rest["items"] == everything
    assert client.get("/api/v1/ieds/NOPE/link-changes").status_code == 404
    assert client.get("/api/v1/ieds/NOPE").status_code == 404


def test_what_went_over_a_link_adds_up(client: httpx.Client, repository: Repository) -> None:
    for reports in (1, 2):
        set_link_state(
            repository,
            NAME,
            LinkState.UP,
            None,
            now_ns=NOW_NS,
            traffic=LinkTraffic(connections=1, received_bytes=500, reports=reports, report_gaps=1),
            round_trip_s=0.003 * reports,
        )
    figures = client.get(URL).json()["figures"]
    assert (figures["connections"], figures["received_bytes"], figures["reports"]) == (2, 1000, 3)
    assert (figures["report_gaps"], figures["round_trip_s"]) == (2, 0.006)
    metrics = client.get("/metrics").text.splitlines()
    assert f'mcc_link_up{{ied="{NAME}"}} 1.0' in metrics
    assert 'mcc_link_up{ied="A2_SEL710"} 0.0' in metrics
    assert f'mcc_link_received_bytes_total{{ied="{NAME}"}} 1000.0' in metrics
    assert f'mcc_link_round_trip_seconds{{ied="{NAME}"}} 0.006' in metrics
    (success,) = [line for line in metrics if line.startswith("mcc_link_last_success_timestamp_seconds{")]
    assert float(success.split()[-1]) == NOW_NS / SECOND_NS


def test_alarms(client: httpx.Client, repository: Repository) -> None:
    first = repository.raise_alarm(NAME, AlarmKind.FILE_REFUSED, "'../X.CFG'", "outside", now_ns=NOW_NS)
    repository.raise_alarm(NAME, AlarmKind.DAILY_LIMIT, "", "too much", now_ns=NOW_NS + 1)
    again = repository.raise_alarm(NAME, AlarmKind.DAILY_LIMIT, "", "far too much", now_ns=NOW_NS + 2)
    assert again.raised_ns == NOW_NS + 1
    assert 'mcc_alarms{kind="daily-limit"} 1.0' in client.get("/metrics").text
    repository.clear_alarms(NAME, [first.id], now_ns=NOW_NS + SECOND_NS)
    listed = client.get("/api/v1/alarms").json()["items"]
    assert [alarm["kind"] for alarm in listed] == ["daily-limit", "file-refused"]
    assert listed[0]["reason"] == "far too much"
    assert listed[1]["cleared_time"] == "2025-10-09T08:53:21.000000000Z"
    standing = client.get("/api/v1/alarms", params={"standing": "true"}).json()["items"]
    assert standing == listed[:1] == client.get(URL).json()["alarms"]
    assert client.get("/api/v1/alarms", params={"standing": "false"}).json()["items"] == listed[1:]
    assert client.get("/api/v1/alarms", params={"ied": "A2_SEL710"}).json()["items"] == []
    assert 'mcc_alarms{kind="file-refused"} 0.0' in client.get("/metrics").text


def test_a_relay_set_aside_tells_why_and_is_released(client: httpx.Client, repository: Repository) -> None:
    assert client.get(URL).json()["quarantine"] is None
    repository.set_aside(NAME, "it lied", backoff=Backoff(60.0, 86_400.0), now_ns=NOW_NS)
    ied = client.get(URL).json()
    assert ied["quarantine"] == {
        "reason": "it lied",
        "times": 1,
        "since_time": FIRST,
        "until_time": "2025-10-09T08:54:20.000000000Z",
    }
    assert (ied["link_state"], ied["link_reason"]) == (
        "quarantined",
        "set aside until 2025-10-09T08:54:20Z: it lied",
    )
    assert [alarm["kind"] for alarm in ied["alarms"]] == ["quarantined"]
    assert client.delete(f"{URL}/quarantine").status_code == 204
    ied = client.get(URL).json()
    assert (ied["quarantine"], ied["link_state"], ied["alarms"]) == (None, "unknown", [])
    assert client.delete(f"{URL}/quarantine").status_code == 204
    assert client.delete("/api/v1/ieds/NOPE/quarantine").status_code == 404
