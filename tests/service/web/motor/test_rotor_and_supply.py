"""Rotor and supply on the page of a motor."""

import json
from dataclasses import replace
from typing import Any

import httpx
import pytest
from lxml import html

from core.rotor.finding import RotorState
from core.rotor.start_finding import StartSideband
from core.starts.examined import ExaminedStart
from service.recording_store.store import RecordingStore
from service.storage import Repository
from testing.service.rotor_and_supply import (
    BROKEN_ROTOR,
    ECCENTRIC_ROTOR,
    SHORT_RECORD,
    SOUND_ROTOR,
    SUPPLY,
    SWINGING_LOAD,
    ExaminedRecordings,
)
from testing.service.starts import START, RecordedStarts
from tests.service.web.motor.recorded import MOTOR, know
from tests.service.web.pages import addresses, page, words

HERE = f"/motors/{MOTOR}/rotor?days=all"
SUPPLY_TAB = f"/motors/{MOTOR}/supply?days=all"
LIGHTLY_LOADED = replace(SOUND_ROTOR, load_bin=3, load_level=0.35, severity_dB=-66.0)


@pytest.fixture
def recorded(repository: Repository, store: RecordingStore) -> ExaminedRecordings:
    know(repository)
    return ExaminedRecordings(repository, store)


def chart(document: html.HtmlElement, key: str) -> Any:
    (found,) = document.cssselect(f"#{key}-data")
    return json.loads(found.text_content())


def test_what_no_record_tells_is_said(client: httpx.Client, recorded: ExaminedRecordings) -> None:
    document = page(client.get(HERE))
    assert words(document, "#rotor .sentence") == ["not assessed No record tells of the rotor yet."]
    assert not document.cssselect("#rotor-severity-data")
    document = page(client.get(SUPPLY_TAB))
    assert "No record shows the supply yet." in " ".join(words(document, "#supply"))
    assert not document.cssselect("#supply-data")


def test_a_broken_cage_is_told_in_words_with_how_sure_that_is(
    client: httpx.Client, recorded: ExaminedRecordings
) -> None:
    for finding in (SOUND_ROTOR, SOUND_ROTOR, SOUND_ROTOR, BROKEN_ROTOR, BROKEN_ROTOR):
        latest = recorded.add(finding)
    recorded.add(SHORT_RECORD)
    document = page(client.get(HERE))
    assert words(document, "#rotor .sentence") == [
        "fault The cage is uneven, as with broken bars or a broken end ring: its asymmetry is "
        "-29.0 dB [-31.0..-27.5], +21.0 dB against the first records at the same load."
    ]
    told = " ".join(words(document, "#rotor"))
    assert "What to do: Have the cage inspected at the next planned stop" in told
    assert "-35.5 dB below, -41.0 dB above the supply's line, at a slip of 3.10 %" in told
    assert "never how many bars are broken" in told
    assert "1 of the latest 6 records cannot tell" in told
    assert document.cssselect(f'#rotor a[href="/recordings/{latest}"]')


def test_one_record_alone_is_not_believed(client: httpx.Client, recorded: ExaminedRecordings) -> None:
    recorded.add(SOUND_ROTOR)
    recorded.add(BROKEN_ROTOR)
    document = page(client.get(HERE))
    assert document.cssselect("#rotor .card.watch")
    assert "one record alone is not believed" in " ".join(words(document, "#rotor li"))


def test_severity_is_drawn_by_load_with_what_would_be_seen(
    client: httpx.Client, recorded: ExaminedRecordings
) -> None:
    recorded.add(SOUND_ROTOR)
    recorded.add(LIGHTLY_LOADED)
    recorded.add(BROKEN_ROTOR)
    document = page(client.get(HERE))
    drawn = {one["label"]: one["values"] for one in chart(document, "rotor-severity")["series"]}
    assert drawn["at 30 to 40 % load"] == [None, -66.0, None]
    assert drawn["at 60 to 70 % load"] == [-68.0, None, -29.0]
    assert drawn["detection limit"] == [-52.0] * 3
    assert [one["y"] for one in chart(document, "rotor-severity")["limits"]] == [-42.0, -36.0]
    assert drawn[RotorState.FAULT] == [None, None, -29.0]
    sidebands = {one["label"]: one["values"] for one in chart(document, "rotor-sidebands")["series"]}
    assert sidebands["lower, (1 - 2s) f"] == [-71.5, -71.5, -35.5]


def test_the_supply_is_told_and_drawn(client: httpx.Client, recorded: ExaminedRecordings) -> None:
    recorded.add(None, SUPPLY)
    document = page(client.get(SUPPLY_TAB))
    assert "derating 1.00" in " ".join(words(document, "#supply"))
    drawn = {one["label"]: one["values"] for one in chart(document, "supply")["series"]}
    assert drawn["unbalance of the voltages (NEMA)"] == [0.68]
    assert drawn["voltage beside the rated one"] == [-0.27]


def test_records_of_before_the_time_shown_are_a_link_away(
    client: httpx.Client, recorded: ExaminedRecordings
) -> None:
    recorded.add(SOUND_ROTOR, SUPPLY)
    for whole in (HERE, SUPPLY_TAB):
        document = page(client.get(whole.partition("?")[0]))
        assert "No recording of this time tells of it" in document.text_content()
        assert whole in addresses(document, "main p a")


def test_the_start_is_told_beside_the_running_motor(
    client: httpx.Client, recorded: ExaminedRecordings, repository: Repository, store: RecordingStore
) -> None:
    recorded.add(BROKEN_ROTOR)
    sound = StartSideband(RotorState.HEALTHY, None, None, -45.0, 12, ("none",))
    start = RecordedStarts(repository, store).add(ExaminedStart(START, sideband=sound), MOTOR)
    document = page(client.get(HERE))
    assert "they do not agree: running, it says fault" in " ".join(words(document, "#rotor p"))
    assert document.cssselect(f'#rotor a[href="/recordings/{start}"]')


def test_air_gap_and_load_are_told_where_they_stand_out(
    client: httpx.Client, recorded: ExaminedRecordings
) -> None:
    assert "No record tells of the air gap" in " ".join(words(page(client.get(HERE)), "#swings"))
    quiet = replace(ECCENTRIC_ROTOR, permeance_ripple=0.001)
    still = replace(SWINGING_LOAD, load_torque=0.001)
    recorded.add(SOUND_ROTOR, eccentricity=quiet, pulsation=still)
    assert "Neither the air gap nor the load stands out" in " ".join(words(page(client.get(HERE)), "#swings"))
    recorded.add(SOUND_ROTOR, eccentricity=ECCENTRIC_ROTOR, pulsation=SWINGING_LOAD)
    document = page(client.get(HERE))
    told = " ".join(words(document, "#swings"))
    assert "air gap: permeance ripples by 5.25 % (+-0.39 %) once a turn; 0.75 % would be told" in told
    assert "load: torque swings by 6.25 % of the rated one at 4.12 Hz" in told
    drawn = chart(document, "swings")
    assert drawn["series"][0]["values"] == [0.1, 5.25]
    assert drawn["series"][3]["values"] == [0.1, 6.25]
