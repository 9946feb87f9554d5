"""When motors and sites stop next, and whether a motor may run until then; on both databases."""

import time
from dataclasses import replace
from typing import Any

import httpx
import pytest

from core.condition.forecast.outcome import HORIZONS_DAYS, Forecast
from core.condition.kinds import State
from core.rotor.finding import RotorState
from core.time_stamps import rfc3339
from core.units import NANOSECONDS_PER_DAY
from service.api import ApiContext
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.records import SERVICE, StopOf
from testing.service.conditions import DRIFTING, FAULT, HEALTHY, tell
from testing.service.plants import two_motor_plant
from testing.service.rotor_and_supply import SOUND_ROTOR, SUPPLY, ExaminedRecordings

MOTOR = "/api/v1/motors/PUMP-A1"
SITE = "/api/v1/sites/FACTORY_A"
NONE = {"time": None, "of": None}


def in_days(days: float) -> str:
    return rfc3339(time.time_ns() + round(days * NANOSECONDS_PER_DAY))


def until_stop(client: httpx.Client) -> Any:
    return client.get(f"{MOTOR}/condition").json()["until_stop"]


def growing(repository: Repository) -> None:
    """A stator whose level has one chance in a hundred more a day to reach its limit."""
    now_ns = time.time_ns()
    chances = tuple(min(days / 100.0, 1.0) for days in HORIZONS_DAYS)
    level = replace(DRIFTING, as_of_ns=now_ns, forecast=Forecast(0.005, (5.0, 50.0, 95.0), 1e-5, chances))
    tell(repository, level, now_ns=now_ns)


def test_a_motor_has_the_earlier_of_its_own_stop_and_that_of_its_site(client: httpx.Client) -> None:
    assert client.get(f"{MOTOR}/planned-stop").json() == NONE
    later, sooner = in_days(30), in_days(10)
    assert client.put(f"{SITE}/planned-stop", json={"time": later}).json() == {"time": later, "of": "site"}
    assert client.get(f"{MOTOR}/planned-stop").json() == {"time": later, "of": "site"}
    assert client.put(f"{MOTOR}/planned-stop", json={"time": sooner}).json()["of"] == "motor"
    assert client.get(f"{MOTOR}/planned-stop").json() == {"time": sooner, "of": "motor"}
    assert client.get("/api/v1/motors/FAN-A2/planned-stop").json() == {"time": later, "of": "site"}
    assert client.delete(f"{MOTOR}/planned-stop").status_code == 204
    assert client.get(f"{MOTOR}/planned-stop").json() == {"time": later, "of": "site"}
    assert client.delete(f"{SITE}/planned-stop").status_code == 204
    assert client.get(f"{SITE}/planned-stop").json() == NONE


def test_a_plan_outlives_a_start_of_the_service_and_ends_with_its_time(
    client: httpx.Client, repository: Repository
) -> None:
    stop = client.put(f"{MOTOR}/planned-stop", json={"time": in_days(3)}).json()
    repository.sync_plant(two_motor_plant())
    assert client.get(f"{MOTOR}/planned-stop").json() == stop
    later_ns = time.time_ns() + 4 * NANOSECONDS_PER_DAY
    assert repository.planned_stop("PUMP-A1", now_ns=later_ns) is None


def test_a_stop_is_planned_ahead_of_something_that_is_there(client: httpx.Client) -> None:
    past = client.put(f"{MOTOR}/planned-stop", json={"time": "2020-01-01"})
    assert (past.status_code, "expected a time ahead" in past.text) == (422, True)
    assert client.put(f"{MOTOR}/planned-stop", json={}).status_code == 422
    assert client.put("/api/v1/motors/NO-SUCH/planned-stop", json={"time": in_days(1)}).status_code == 404
    assert client.put("/api/v1/sites/NO-SUCH/planned-stop", json={"time": in_days(1)}).status_code == 404
    assert client.get("/api/v1/sites/NO-SUCH/planned-stop").status_code == 404


def test_the_condition_says_how_likely_the_motor_holds(client: httpx.Client, repository: Repository) -> None:
    growing(repository)
    assert until_stop(client) is None
    client.put(f"{SITE}/planned-stop", json={"time": in_days(20)})
    said = until_stop(client)
    assert said["of"] == "site"
    assert said["probability"] == pytest.approx(0.8, abs=0.01)
    assert said["likely_until"] is not None
    assert [one["part"] for one in said["parts"]] == ["stator", "rotor"]
    assert "without the rotor: not assessed" in said["reasons"]


@pytest.mark.parametrize(
    ("condition", "probability", "why"),
    [
        (FAULT, 0.0, "beyond the limit already: stator"),
        (HEALTHY, None, "no part is seen to move towards its limit"),
        (DRIFTING, None, "stator: it is on watch, and how fast it grows is not known"),
        (replace(HEALTHY, state=State.UNKNOWN), None, "the stator is not assessed"),
    ],
)
def test_where_nothing_can_be_said_it_says_why(
    client: httpx.Client, repository: Repository, condition: Any, probability: float | None, why: str
) -> None:
    now_ns = time.time_ns()
    tell(repository, replace(condition, as_of_ns=now_ns), now_ns=now_ns)
    client.put(f"{MOTOR}/planned-stop", json={"time": in_days(20)})
    said = until_stop(client)
    assert (said["probability"], said["reasons"][0]) == (probability, why)


def test_old_records_and_none_say_nothing(client: httpx.Client, repository: Repository) -> None:
    client.put(f"{MOTOR}/planned-stop", json={"time": in_days(20)})
    assert until_stop(client)["reasons"] == ["the latest record is too old"]
    tell(repository, DRIFTING)
    assert until_stop(client)["probability"] is None


def test_a_rotor_that_gets_worse_counts(
    client: httpx.Client, context: ApiContext, repository: Repository, store: RecordingStore
) -> None:
    """Each day half a decibel more, from -48 dB on: the limit, -36 dB, is days away."""
    now_ns = time.time_ns()
    tell(repository, replace(HEALTHY, as_of_ns=now_ns), now_ns=now_ns)
    recorded = ExaminedRecordings(repository, store)
    for day in range(18):
        level_dB = -48.0 + (0.5 * day if day > 3 else 0.0)
        ends = (level_dB - 1.0, level_dB + 1.0)
        state = RotorState.WATCH if level_dB > -42.0 else RotorState.HEALTHY
        finding = replace(SOUND_ROTOR, state=state, severity_dB=level_dB, severity_dB_ci95=ends)
        recorded.add(finding, SUPPLY, at_ns=now_ns - (18 - day) * NANOSECONDS_PER_DAY)
    repository.settle_motor_condition("PUMP-A1", now_ns=now_ns)
    client.put(f"{MOTOR}/planned-stop", json={"time": in_days(1)})
    soon = until_stop(client)
    assert soon["reasons"][0] == "a fault that begins later cannot be forecast, and is not in it"
    client.put(f"{MOTOR}/planned-stop", json={"time": in_days(60)})
    late = until_stop(client)
    assert soon["probability"] > 0.8 > 0.3 > late["probability"]


def test_a_motor_that_left_the_plant_has_no_plan(repository: Repository, client: httpx.Client) -> None:
    plant = two_motor_plant()
    repository.sync_plant(replace(plant, motors=plant.motors[1:]))
    assert client.put(f"{MOTOR}/planned-stop", json={"time": in_days(1)}).status_code == 409
    repository.plan_stop(StopOf.MOTOR, "FAN-A2", None, by=SERVICE, now_ns=1)
