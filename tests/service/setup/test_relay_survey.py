"""What relays answer when they are asked: clocks, credentials that cannot be used, relays that hang."""

import socket
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from ied_sim.misbehaviour import Kind, Misbehaviour
from scl import Address
from service.cli.plant.check import line_of
from service.configuration.relay_access import RelayAccess
from service.configuration.settings import Settings
from service.plant import Relay, acquisition_from_scl
from service.plant.overrides import Overrides
from service.setup.draft import relays_to_ask
from service.setup.relay_survey import RelaySurvey, survey
from testing.ports import LOOPBACK
from testing.relays.simulated import scenario_of, simulated

SETTINGS = Settings(connect_timeout_s=0.5, request_timeout_s=1.0)


@pytest.fixture
def mute() -> Iterator[Relay]:
    """A relay that takes connections and says nothing."""
    with socket.create_server((LOOPBACK, 0)) as server:
        (relay,) = relays_to_ask([Address(LOOPBACK, server.getsockname()[1])])
        yield relay


def test_relays_that_hang_hold_up_nobody_for_long(mute: Relay) -> None:
    relays = [replace(mute, name=f"R{number}") for number in range(12)]
    told: list[str] = []
    began_s = time.monotonic()
    answers = survey(relays, SETTINGS, lambda answer: told.append(answer.relay.name))
    assert time.monotonic() - began_s < 20
    assert [answer.relay.name for answer in answers] == [relay.name for relay in relays]
    assert sorted(told) == sorted(relay.name for relay in relays)
    assert all(answer.unreachable for answer in answers)


def test_a_password_that_cannot_be_read_is_told(mute: Relay, tmp_path: Path) -> None:
    access = RelayAccess(password_file=tmp_path / "missing")
    (answer,) = survey([mute], SETTINGS.model_copy(update={"relays": {mute.name: access}}))
    assert answer.unreachable is not None
    assert "missing" in answer.unreachable


@pytest.mark.parametrize(
    ("offset_s", "age_s", "said"),
    [
        (0.3, None, "its clock agrees with this one"),
        (-5.0, None, "its clock is 5.0 s behind this one"),
        (
            None,
            26.0,
            "agrees as far as can be seen (its latest time stamp is 26 s old and no value has changed",
        ),
        (None, 400.0, "its clock cannot be seen (its latest time stamp is 400 s old"),
        (None, 3610.0, "it may be behind this one; if it runs in local time, set time_zone)"),
        (None, -3600.0, "its clock is 3600.0 s ahead of this one: if it runs in local time, set time_zone"),
        (None, None, "it does not tell its clock"),
    ],
)
def test_what_can_be_seen_of_a_clock_is_told(
    mute: Relay, offset_s: float | None, age_s: float | None, said: str
) -> None:
    found = acquisition_from_scl(mute)
    answer = RelaySurvey(mute, acquisition=found, clock_offset_s=offset_s, stamp_age_s=age_s)
    assert said in line_of(answer)


def test_the_text_reports_of_a_relay_are_named(tmp_path: Path) -> None:
    with simulated(tmp_path, scenario_of("sel-710-ed2")) as served:
        (relay,) = relays_to_ask([served.address])
        (answer,) = survey([relay], SETTINGS)
        (unasked,) = survey([replace(relay, overrides=Overrides(reports_directory="none"))], SETTINGS)
    assert "; text reports CSER, CLDP, MSR, MOT; " in line_of(answer)
    assert "text reports" not in line_of(unasked)


@pytest.mark.campaign
def test_a_clock_that_is_hours_off_is_told(tmp_path: Path) -> None:
    ahead = Misbehaviour(Kind.CLOCK_OFFSET, 7200.0, at_s=0.0)
    with simulated(tmp_path, scenario_of("sel-710-ed2", ahead)) as served:
        (answer,) = survey(relays_to_ask([served.address]), SETTINGS, clock_s=4.0)
    assert "ahead of this one: if it runs in local time, set time_zone" in line_of(answer)
