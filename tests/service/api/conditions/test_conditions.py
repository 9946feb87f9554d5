"""The condition of motors over time, by REST, on both databases."""

import time
from dataclasses import replace
from typing import Any, Protocol

import httpx
import pytest

from core.condition.observation import Observation
from core.condition.verdict.condition import Condition
from core.diagnosis.verdict import Diagnosis
from core.time_stamps import rfc3339
from core.units import NANOSECONDS_PER_DAY
from service.alarms.catalogue import CATALOGUE
from service.alarms.kinds import AlarmKind
from service.plant import Schedule
from service.recording_store.store import RecordingStore
from service.storage import Repository
from testing.service.conditions import DRIFTING, FAULT, HEALTHY, tell
from testing.service.findings import findings_of
from testing.service.job_runner import RUNNER
from testing.service.observations import HOUR_NS, observation
from testing.service.plants import NOW_NS, fault, healthy, two_motor_plant

MOTOR = "/api/v1/motors/PUMP-A1"
NOTE = {"kind": "maintenance", "text": "terminals cleaned", "on_behalf_of": "A. Miller"}
FIGURES = ("state", "kind", "candidates", "phase", "mu_f", "mu_f_ci95", "change", "change_ci95")


class Record(Protocol):
    """Add a diagnosed recording of PUMP-A1, so many hours after NOW_NS; return its id."""

    def __call__(self, hour: float, diagnosis: Diagnosis | None = None, /) -> str: ...


@pytest.fixture
def record(repository: Repository, store: RecordingStore) -> Record:
    """Add a diagnosed recording of PUMP-A1, so many hours after NOW_NS; returns its id."""

    def add(hour: float, diagnosis: Diagnosis | None = None, /) -> str:
        observed: Observation = observation(hour)
        stored = store.store({"E.CFF": b"record of hour %f" % hour})
        added = repository.add_recording(stored, motor="PUMP-A1", now_ns=NOW_NS)
        claimed = repository.claim_job(now_ns=NOW_NS, runner=RUNNER)
        assert claimed is not None
        assert repository.finish_job(
            claimed.job.id,
            findings_of(diagnosis or healthy(), observation=observed),
            recorded_ns=observed.time_ns,
            now_ns=NOW_NS,
            runner=RUNNER,
        )
        return added.recording.id

    return add


WHOLE = ("finding", "urgency", "causes", "parts", "until_stop")
"""Keys of the document that are of the whole motor, beside those of its stator."""


def told(condition: Condition) -> dict[str, Any]:
    """What the API says of the stator's condition whose latest record is from long ago."""
    return {**condition.as_dict(), "stale": True}


def of_stator(found: dict[str, Any]) -> dict[str, Any]:
    """What it says without the keys of the whole motor."""
    return {name: value for name, value in found.items() if name not in WHOLE}


def test_nothing_is_known_of_a_motor_before_its_first_record(client: httpx.Client) -> None:
    found = client.get(f"{MOTOR}/condition").json()
    known = {name: value for name, value in found.items() if value not in (None, [])}
    assert known.pop("advice").startswith("Have the motor recorded while it runs")
    assert known.pop("reasons") == ["no valid record of the motor has been judged yet"]
    assert {**known.pop("reference"), "records": 0, "complete": False} == {
        **dict.fromkeys(told(FAULT)["reference"]),
        "records": 0,
        "complete": False,
        "from_bus": False,
        "accepted": False,
    }
    assert known == {
        "motor": "PUMP-A1",
        "state": "unknown",
        "kind": "none",
        "forecast": {"limit": None, "days": None, "chances": None},
        "stale": True,
        "finding": "",
        "urgency": "none",
    }
    assert set(found) == {*told(FAULT), *WHOLE, "history"}
    assert client.get(f"{MOTOR}/condition/history").json() == {"items": [], "next_cursor": None}
    assert client.get(f"{MOTOR}/notes").json() == {"items": [], "next_cursor": None}


def test_a_condition_comes_with_what_was_said_from_the_latest_records_on(
    client: httpx.Client, repository: Repository, record: Record
) -> None:
    ids = [record(hour) for hour in range(3)]
    tell(repository, DRIFTING)
    found = client.get(f"{MOTOR}/condition").json()
    history = found.pop("history")
    assert of_stator(found) == told(DRIFTING)
    assert [point["record"] for point in history] == ids
    said = {name: found[name] for name in FIGURES}
    assert history[1] == {**said, "record": ids[1], "time": rfc3339(NOW_NS + HOUR_NS)}
    latest = client.get(f"{MOTOR}/condition", params={"history": 2}).json()["history"]
    assert latest == history[1:]
    assert client.get(f"{MOTOR}/condition", params={"history": 0}).json()["history"] == []
    assert client.get(f"{MOTOR}/condition", params={"history": 101}).status_code == 422


def test_a_condition_is_not_stale_for_the_time_in_which_its_motor_stood(
    client: httpx.Client, repository: Repository
) -> None:
    now_ns = time.time_ns()
    tell(repository, replace(HEALTHY, as_of_ns=now_ns - 30 * NANOSECONDS_PER_DAY, stale=True))
    assert client.get(f"{MOTOR}/condition").json()["stale"] is True
    due_ns = now_ns - NANOSECONDS_PER_DAY
    repository.skip_recording("PUMP-A1", "the motor stands", due_ns=due_ns, now_ns=due_ns)
    assert client.get(f"{MOTOR}/condition").json()["stale"] is False
    health = client.get(f"{MOTOR}/health").json()
    assert health["stood_time"] == rfc3339(due_ns)
    (skipped,) = client.get("/api/v1/event-reports").json()["items"]
    assert (skipped["state"], skipped["reason"]) == ("skipped", "the motor stands")


def test_a_condition_is_not_stale_while_its_latest_record_is_fresh(
    client: httpx.Client, repository: Repository
) -> None:
    now_ns = time.time_ns()
    tell(repository, replace(HEALTHY, as_of_ns=now_ns - NANOSECONDS_PER_DAY, stale=True))
    assert client.get(f"{MOTOR}/condition").json()["stale"] is False
    tell(repository, replace(HEALTHY, as_of_ns=now_ns - 8 * NANOSECONDS_PER_DAY), now_ns=NOW_NS + 1)
    assert client.get(f"{MOTOR}/condition").json()["stale"] is True


def test_the_history_says_what_changed_a_condition_latest_first(
    client: httpx.Client, repository: Repository
) -> None:
    for number, condition in enumerate((HEALTHY, DRIFTING, FAULT)):
        tell(repository, condition, now_ns=NOW_NS + number)
    url = f"{MOTOR}/condition/history"
    items = client.get(url).json()["items"]
    assert [(item["state"], item["time"]) for item in items] == [
        ("fault", rfc3339(NOW_NS + 2)),
        ("watch", rfc3339(NOW_NS + 1)),
        ("healthy", rfc3339(NOW_NS)),
    ]
    notes = client.get(f"{MOTOR}/notes").json()["items"]
    assert [item["note_id"] for item in items] == [note["id"] for note in notes]
    assert {item["recording_id"] for item in items} == {None}
    assert {name: items[0][name] for name in FIGURES} == {name: told(FAULT)[name] for name in FIGURES}
    assert [item["candidates"] for item in items] == [[], ["voltage-channel", "shorted-turns"], []]
    first = client.get(url, params={"limit": 2}).json()
    rest = client.get(url, params={"limit": 2, "cursor": first["next_cursor"]}).json()
    assert first["items"] + rest["items"] == items
    assert rest["next_cursor"] is None
    assert client.get("/api/v1/motors/FAN-A2/condition/history").json()["items"] == []


def test_health_leads_with_the_condition(
    client: httpx.Client, repository: Repository, record: Record
) -> None:
    recording_id = record(0)
    tell(repository, FAULT)
    health = client.get(f"{MOTOR}/health").json()
    assert list(health)[:4] == ["motor", "site", "ied", "condition"]
    assert of_stator(health["condition"]) == told(FAULT)
    assert health["condition"]["finding"] == "shorted turns in phase b"
    states = {one["part"]: one["state"] for one in health["condition"]["parts"]}
    assert states["stator"] == "fault"
    assert states["rotor"] == "unknown"
    assert (health["verdict"], health["phase"], health["recording_id"]) == ("healthy", None, recording_id)
    listed = client.get("/api/v1/motors", params={"health": "true"}).json()["items"]
    assert [one["health"]["condition"]["state"] for one in listed] == ["unknown", "fault"]
    assert listed[1]["health"] == health


def test_a_condition_that_is_milder_than_the_latest_record_says_why(
    client: httpx.Client, repository: Repository, record: Record
) -> None:
    record(0, healthy())
    tell(repository, HEALTHY)
    assert client.get(f"{MOTOR}/condition").json()["reasons"] == list(HEALTHY.reasons)
    record(1, fault())
    for found in (client.get(f"{MOTOR}/condition").json(), client.get(f"{MOTOR}/health").json()["condition"]):
        first, *others = found["reasons"]
        assert first.startswith("the latest record by itself says fault, ")
        assert others == list(HEALTHY.reasons)


def test_the_trend_of_the_condition_has_a_point_for_each_record(
    client: httpx.Client, repository: Repository, record: Record
) -> None:
    ids = [record(hour) for hour in range(3)]
    tell(repository, FAULT)
    url = f"{MOTOR}/trend"
    level = client.get(url, params={"quantity": "condition_level"}).json()["items"]
    assert level[1] == {
        "time": rfc3339(NOW_NS + HOUR_NS),
        "value": 0.0121,
        "ci95": [0.009, 0.0225],
        "scatter95": None,
        "detection_limit": None,
        "verdict": None,
        "recording_id": ids[1],
        "state": "fault",
        "kind": "shorted-turns",
        "phase": "b",
    }
    change = client.get(url, params={"quantity": "change", "to": level[2]["time"]}).json()["items"]
    assert [(point["value"], point["ci95"]) for point in change] == [(0.012, [0.009, 0.015])] * 2
    page = client.get(url, params={"quantity": "change", "limit": 1}).json()
    params = {"quantity": "change", "cursor": page["next_cursor"], "from": level[0]["time"]}
    rest = client.get(url, params=params).json()["items"]
    assert [point["recording_id"] for point in page["items"] + rest] == ids
    of_record = client.get(url).json()["items"][0]
    assert (of_record["verdict"], "state" in of_record) == ("healthy", False)


def test_an_alarm_says_what_to_do_about_a_motor(client: httpx.Client, repository: Repository) -> None:
    tell(repository, FAULT)
    (alarm,) = client.get("/api/v1/alarms", params={"motor": "PUMP-A1", "standing": "true"}).json()["items"]
    del alarm["id"]
    assert alarm == {
        "site": "FACTORY_A",
        "ied": "A1_SEL710",
        "motor": "PUMP-A1",
        "kind": "condition-fault",
        "subject": "shorted turns in phase b",
        "reason": "; ".join(FAULT.reasons),
        "advice": FAULT.advice,
        "priority": "critical",
        "state": "unacknowledged",
        "standing": True,
        "recording": None,
        "value": FAULT.mu_f,
        "seen_value": None,
        "raised_time": rfc3339(NOW_NS),
        "raises": 1,
        "cleared_time": None,
        "changed_time": rfc3339(NOW_NS),
        "changed_by": "statorwatch",
        "comment": None,
        "shelved_until": None,
        "shelved_above": None,
        "suppressed_because": None,
        "part_of": None,
        "cause": CATALOGUE[AlarmKind.CONDITION_FAULT].cause,
        "consequence": CATALOGUE[AlarmKind.CONDITION_FAULT].consequence,
        "links": {
            "motor": "/api/v1/motors/PUMP-A1",
            "ied": "/api/v1/ieds/A1_SEL710",
            "recording": None,
            "part_of": None,
        },
    }
    assert client.get("/api/v1/ieds/A1_SEL710").json()["alarms"] == []
    assert client.get("/api/v1/alarms", params={"motor": "FAN-A2"}).json()["items"] == []
    tell(repository, HEALTHY, now_ns=NOW_NS + 5)
    (over,) = client.get("/api/v1/alarms").json()["items"]
    assert over["cleared_time"] == rfc3339(NOW_NS + 5)


def test_the_metrics_have_the_conditions(client: httpx.Client, repository: Repository) -> None:
    tell(repository, FAULT)
    assert client.post(f"{MOTOR}/notes", json=NOTE).status_code == 201
    lines = set(client.get("/metrics").text.splitlines())
    motor = 'motor="PUMP-A1"'
    assert lines >= {
        'mcc_motors{state="healthy"} 0.0',
        'mcc_motors{state="fault"} 1.0',
        'mcc_motors{state="unknown"} 1.0',
        f'mcc_motor_state{{{motor},state="fault"}} 1.0',
        f'mcc_motor_state{{{motor},state="watch"}} 0.0',
        'mcc_motor_state{motor="FAN-A2",state="unknown"} 1.0',
        f"mcc_motor_fault_level_ratio{{{motor}}} 0.0121",
        f"mcc_motor_fault_level_change_ratio{{{motor}}} 0.012",
        f'mcc_motor_kind{{kind="shorted-turns",{motor}}} 1.0',
        f'mcc_motor_fault_level_bound_ratio{{bound="high",{motor}}} 0.0225',
        f'mcc_motor_forecast_days{{{motor},quantile="0.05"}} 12.0',
        f'mcc_motor_forecast_days{{{motor},quantile="0.5"}} 20.0',
        f'mcc_motor_forecast_days{{{motor},quantile="0.95"}} 41.0',
        f"mcc_motor_condition_timestamp_seconds{{{motor}}} 1.76e+09",
        f"mcc_motor_condition_stale{{{motor}}} 1.0",
        'mcc_alarms{kind="condition-fault"} 1.0',
        "mcc_motors_to_fold 1.0",
        "mcc_motors_set_aside 0.0",
    }
    assert not [line for line in lines if line.startswith("mcc_motor_fault_level") and "FAN-A2" in line]


def test_the_metrics_say_whether_a_condition_is_stale_by_the_motors_rule(
    client: httpx.Client, repository: Repository
) -> None:
    two_hours = replace(HEALTHY, as_of_ns=time.time_ns() - 2 * HOUR_NS)
    four_hours = replace(two_hours, motor="FAN-A2", as_of_ns=time.time_ns() - 4 * HOUR_NS)
    for condition in (two_hours, four_hours):
        tell(repository, condition)
    name = "mcc_motor_condition_stale"
    plant = two_motor_plant()
    for expression, stale in (("0 * * * *", 1.0), ("0 */6 * * *", 0.0)):
        schedule = Schedule.parse(expression)
        motors = tuple(replace(one, schedule=schedule) for one in plant.motors)
        repository.sync_plant(replace(plant, motors=motors))
        lines = client.get("/metrics").text.splitlines()
        assert f'{name}{{motor="PUMP-A1"}} 0.0' in lines
        assert f'{name}{{motor="FAN-A2"}} {stale}' in lines


def test_a_motor_that_is_not_there_is_not_found(client: httpx.Client) -> None:
    note = "notes/00000000-0000-0000-0000-000000000000"
    for path in ("condition", "condition/history", "notes", note, "reference"):
        url = f"/api/v1/motors/NOPE/{path}"
        wanted = {"reason": "tested", "on_behalf_of": "A. Miller"}
        answer = client.post(url, json=wanted) if path == "reference" else client.get(url)
        assert answer.status_code == 404
        assert answer.headers["content-type"] == "application/problem+json"
        assert "there is no motor 'NOPE'" in answer.json()["detail"]
