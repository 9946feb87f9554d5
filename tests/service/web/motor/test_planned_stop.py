"""The planned stop at the head of a motor's page."""

import time
from dataclasses import replace

import httpx
import pytest

from core.condition.forecast.outcome import HORIZONS_DAYS, Forecast
from core.time_stamps import rfc3339
from core.units import NANOSECONDS_PER_DAY
from service.client.credentials import bearer
from service.client.until_stop import answer_of
from service.storage import Repository
from service.storage.records import SERVICE, Role, StopOf
from testing.service.accounts import token_of
from testing.service.conditions import DRIFTING, tell
from tests.service.web.motor.recorded import MOTOR, know
from tests.service.web.pages import addresses, page, words

HERE = f"/motors/{MOTOR}"
FORM = "form[action$='/planned-stop']"


def in_days(days: float) -> str:
    """A time as a browser's field has it."""
    return rfc3339(time.time_ns() + round(days * NANOSECONDS_PER_DAY))[:16]


def test_a_stop_is_planned_shown_with_its_answer_and_dropped(
    client: httpx.Client, repository: Repository
) -> None:
    know(repository)
    now_ns = time.time_ns()
    chances = tuple(min(days / 100.0, 1.0) for days in HORIZONS_DAYS)
    tell(
        repository,
        replace(DRIFTING, as_of_ns=now_ns, forecast=Forecast(0.005, (5.0, 50.0, 95.0), 1e-5, chances)),
        now_ns=now_ns,
    )
    before = page(client.get(HERE))
    assert words(before, "#planned-stop") == []
    assert addresses(before, FORM) == [f"{HERE}/planned-stop"]

    answer = client.post(f"{HERE}/planned-stop", data={"time": in_days(20), "of": "site"})
    assert answer.headers["location"] == f"{HERE}?done=stop-planned"
    document = page(client.get(HERE))
    (line,) = words(document, "#planned-stop")
    assert line.startswith("Planned stop 2")
    assert "(site FACTORY_A): 80 % likely that no part passes its limit before" in line
    assert any(one.startswith("90 % likely until") for one in words(document, "#stop li"))
    assert words(page(client.get("/motors/FAN-A2")), "#planned-stop"), "it is a motor of the site"

    client.post(f"{HERE}/planned-stop/cancellation", data={"of": "site"})
    assert words(page(client.get(HERE)), "#planned-stop") == []


def test_who_may_only_look_plans_nothing(client: httpx.Client, repository: Repository) -> None:
    know(repository)
    repository.plan_stop(
        StopOf.MOTOR,
        MOTOR,
        time.time_ns() + NANOSECONDS_PER_DAY,
        by=SERVICE,
        now_ns=time.time_ns(),
    )
    viewer = bearer(token_of(repository, Role.VIEWER, name="vera"))
    document = page(client.get(HERE, headers=viewer))
    (line,) = words(document, "#planned-stop")
    assert "not assessed: the latest record is too old" in line
    assert addresses(document, "form[action*='planned-stop']") == []
    assert client.post(f"{HERE}/planned-stop", data={"time": in_days(1)}, headers=viewer).status_code == 403


@pytest.mark.parametrize(
    ("probability", "words_"),
    [
        (0.999, "more than 99 % likely that no part passes its limit before"),
        (0.8, "80 % likely that no part passes its limit before"),
        (0.0, "less than 1 % likely that no part passes its limit before"),
        (None, "not assessed: a fault"),
    ],
)
def test_no_forecast_is_told_as_certain(probability: float | None, words_: str) -> None:
    assert answer_of(probability, ["a fault"]) == words_
    assert answer_of(0.0, ["beyond the limit already: rotor"]) == "no: beyond the limit already: rotor"
