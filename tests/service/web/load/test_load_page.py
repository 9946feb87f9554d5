"""The page of a motor's load."""

import time
from dataclasses import replace

import httpx

from core.relay_reports import read_motor_statistics
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.records import Actor
from testing.service.metered_days import meter_a_day
from testing.service.rotor_and_supply import LOSSES, SOUND_ROTOR, SUPPLY, ExaminedRecordings
from tests.core.relay_reports.examples import MOT
from tests.service.web.pages import addresses, page, words

HERE = "/motors/PUMP-A1/load"


def test_the_page_shows_profile_limits_and_heat(client: httpx.Client, repository: Repository) -> None:
    meter_a_day(repository)

    document = page(client.get(HERE))

    facts = words(document, ".facts.dense dd")
    assert facts[:2] == ["15 h", "6 h"]
    assert facts[-1] == "at least 1"
    assert "voltage below 90 %1 h21 h1 h88.0 %" in words(document, "section tbody tr")
    assert "K above ambient" in words(document, "#heat-title ~ dl dd")[0]
    assert "no two records" in words(document, "#heat-title ~ dl dd")[-1]
    assert addresses(document, ".spans a")[:3] == [f"{HERE}?days={days}" for days in (1, 7, 30)]
    assert words(document, "figure svg title")


def test_records_beyond_limits_are_said_to_be_records(
    client: httpx.Client, repository: Repository, store: RecordingStore
) -> None:
    meter_a_day(repository)
    assert not page(client.get(HERE)).cssselect("#record-limits-title")
    ExaminedRecordings(repository, store).add(
        None, replace(SUPPLY, harmonic_voltage_factor=0.025), at_ns=time.time_ns() - 1_000_000_000
    )

    document = page(client.get(HERE))

    rows = words(document, "#record-limits-title ~ div tbody tr")
    assert "HVF above 0.0211100 %0.0250" in rows


def test_the_relay_s_statistics_stand_beside_the_service_s_counts(
    client: httpx.Client, repository: Repository
) -> None:
    meter_a_day(repository)
    assert not page(client.get(HERE)).cssselect("#relay-title")
    told = read_motor_statistics(MOT)
    repository.add_relay_statistics("PUMP-A1", told, by=Actor("ada", "tests"), now_ns=1)
    document = page(client.get(HERE))
    facts = words(document, "section[aria-labelledby=relay-title] dd")
    assert facts[0] == "17 0 counted here"
    assert facts[-2:] == ["1", "0"]
    assert "the service has measured nothing in that time" in words(document, "#relay-title ~ p")[-1]


def test_a_motor_that_no_service_knows_yet_and_one_that_is_not_there(client: httpx.Client) -> None:
    assert "has not read the motors file" in words(page(client.get("/motors/FAN-A2/load")), "main")[0]
    assert client.get("/motors/NOPE/load").status_code == 404


def test_losses_stand_with_what_they_cost(
    client: httpx.Client, repository: Repository, store: RecordingStore
) -> None:
    meter_a_day(repository)
    assert "No record tells the losses yet" in " ".join(words(page(client.get(HERE)), "#losses p"))
    recorded = ExaminedRecordings(repository, store)
    for _ in range(2):
        recorded.add(SOUND_ROTOR, SUPPLY, losses=LOSSES)

    document = page(client.get(HERE))

    rows = words(document, "#losses tbody tr")
    assert rows[0].startswith("shorted turns12.5 W")
    assert rows[-1] == "60 to 70 %81.5 %77.5 to 84.8 %2"
    assert "as metered in the last 30 days" in " ".join(words(document, "#losses dd"))
